// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// User-defined detectors: one by itself, and one around another.
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>

#include <pulsecast/detector/adaptor.hpp>
#include <pulsecast/pulsecast.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

/// Reports the strongest reflection.
struct StrongestHit {
  using Workspace = std::array<Echo, 1>;
  Workspace workspace(std::size_t) const { return {}; }
  Detection detect(const DetectorInput& input, Workspace& w) const noexcept {
    const auto weaker = [](const Reflection& a, const Reflection& b) { return a.power < b.power; };
    const auto most = std::max_element(input.reflections.begin(), input.reflections.end(), weaker);
    if (most == input.reflections.end()) return {};
    w[0] = {.range = most->range, .amplitude = most->power, .object = most->object};
    return {w, {}, 0};
  }
};
static_assert(Detector<StrongestHit>);

/// Reports the last echo alone.
struct LastEcho : DetectorAdaptor<FullWaveform<>> {
  Detection detect(const DetectorInput& input, FullWaveform<>::Workspace& workspace) const noexcept {
    Detection all = inner.detect(input, workspace);
    if (all.echoes.empty()) return all;
    all.echoes = all.echoes.last(1);
    all.echoes[0].number = 1;
    return all;
  }
};
static_assert(Detector<LastEcho>);

int main() {
  const MeshData board{.vertices = {{-1, 0, -3}, {1, 0, -3}, {1, 0, 3}, {-1, 0, 3}},
                       .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const auto mesh = std::make_shared<const TriangleMesh<>>(board);
  const auto dark = material_table({{.name = "dark", .reflectance = 0.1}});
  const Scene<TriangleMesh<>> scene(
      {{.geometry = mesh, .materials = dark, .placement = {.translation = {0, 10, 0}}, .object = 1},
       {.geometry = mesh, .placement = {.scale = 4, .translation = {0, 14, 0}}, .object = 2}});
  const Scanner scanner{.pulses = 5'000, .laser = {.divergence = 20_mrad}};
  const Platform platform{Tripod{}, Mount{}, Deflector{OscillatingMirror{.half_angle = 30_deg}, scanner}};
  const auto scan = [&](const auto& detector) {
    Cloud cloud;
    run(Survey{platform, RingFootprint{3}, scene, Receiver{}, detector}, {}, cloud);
    double range = 0, amplitude = 0;
    for (const Echo& echo : cloud.echoes) {
      range += echo.range;
      amplitude += echo.amplitude;
    }
    std::cout << cloud.size() << ' ' << std::ranges::count(cloud.echoes, 2u, &Echo::object) << std::hexfloat << ' '
              << range << ' ' << amplitude << '\n';
  };
  scan(StrongestHit{});
  scan(LastEcho{FullWaveform{}});
}
