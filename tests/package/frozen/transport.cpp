// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A user-defined transport: a window before the instrument.
#include <iostream>
#include <memory>
#include <span>

#include <pulsecast/pulsecast.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

struct Window : DirectLight {
  double passed = 0.9;
  TransportResult trace(const Scene<TriangleMesh<>>& map, const TransportInput& light, Workspace& w,
                        std::span<Reflection> found) const noexcept {
    TransportResult result = DirectLight::trace(map, light, w, found);
    for (Reflection& reflection : found.first(result.reflections)) reflection.power *= passed * passed;
    result.energy = result.energy.times(passed);
    result.energy.received *= passed;  // on the way back
    result.energy.sent = light.energy();
    result.energy.absorbed += (1 - passed) * light.energy();
    return result;
  }
};

int main() {
  const MeshData wall{.vertices = {{-4, 9, 0}, {4, 11, 0}, {4, 11, 5}, {-4, 9, 5}},
                      .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(wall)}});
  const Scanner scanner{.pulses = 20'000, .laser = {.peak_power = 20, .divergence = 1_mrad}};
  const Platform platform{Tripod{}, Mount{.lever_arm = {0, 0, 1.7}},
                          Deflector{OscillatingMirror{.half_angle = 40_deg}, scanner}};
  const auto scan = [&](const auto& transport) {
    Cloud cloud;
    const EnergyLedger energy =
        run(Survey{platform, RingFootprint{2}, scene, transport, Receiver{.range_max = 100}, FullWaveform{}}, {}, cloud)
            .energy;
    double amplitude = 0;
    for (const Echo& echo : cloud.echoes) amplitude += echo.amplitude;
    std::cout << cloud.size() << std::hexfloat << ' ' << amplitude << ' ' << energy.sent << ' ' << energy.scattered
              << ' ' << energy.absorbed << ' ' << energy.missed << ' ' << energy.received << '\n';
  };
  scan(DirectLight{});
  scan(Window{});
}
