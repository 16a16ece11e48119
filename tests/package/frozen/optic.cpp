// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A user-defined optic: a mirror that nods, and is covered on its way back.
#include <cmath>
#include <iostream>
#include <memory>

#include <pulsecast/pulsecast.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

struct NoddingMirror {
  using refinements = pulsecast::refines<tag::Gated, tag::ForeseesOpening, tag::Validated>;
  double rate = 10;            // [Hz]
  double half_angle = 20_deg;  // [rad]

  Pose<frame::Beam, frame::Instrument> at(Tick t) const noexcept {
    return aimed_at(0, -half_angle * (4 * t.phase(rate) - 1));
  }
  bool open(Tick t) const noexcept { return t.phase(rate) < 0.5; }
  Tick next_open(Tick t) const noexcept {
    return open(t) ? t : t + Tick::of_seconds(0.99 * (1 - t.phase(rate)) / rate);
  }
  void validate() const { require_within("NoddingMirror::half_angle", half_angle, 0, pi / 2, "rad"); }
};
static_assert(Optic<NoddingMirror>);

int main() {
  const MeshData ground{.vertices = {{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 1}},
                        .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(ground)}});
  const Deflector nodding{NoddingMirror{.rate = 5}, Scanner{.pulse_rate = 10_kHz, .pulses = 10'000}};
  const Platform platform{Tripod{}, Mount{.lever_arm = {0, 0, 1.7}}, nodding};
  const Survey survey{platform, LatticeFootprint{7}, scene, Receiver{}, FullWaveform{}, 3};
  Cloud cloud;
  const RunSummary summary = run(survey, {.threads = 2}, cloud);
  double x = 0, y = 0, z = 0, amplitude = 0;
  for (const Vec3& point : cloud.points) {
    x += point.x;
    y += point.y;
    z += point.z;
  }
  for (const Echo& echo : cloud.echoes) amplitude += echo.amplitude;
  std::cout << cloud.size() << " points, " << summary.count(Fate::blocked) << " blocked\n"
            << std::hexfloat << x << ' ' << y << ' ' << z << ' ' << amplitude << '\n';
  try {
    Deflector{NoddingMirror{.half_angle = 4}, Scanner{}};
  } catch (const SettingError& error) {
    std::cout << error.what() << '\n';
  }
}
