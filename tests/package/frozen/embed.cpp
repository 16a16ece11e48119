// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <iostream>
#include <memory>

#include <pulsecast/pulsecast.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

int main() {
  // the scene: a white wall, 8 m wide and 5 m high, 10 m to the north
  const MeshData wall{.vertices = {{-4, 10, 0}, {4, 10, 0}, {4, 10, 5}, {-4, 10, 5}},
                      .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const auto plaster = material_table({{.name = "plaster", .reflectance = 0.8}});
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(wall), .materials = plaster}});

  // the instrument: a mirror sweeps a laser beam up and down, a head turns both once around, on a tripod
  const Scanner laser{.pulse_rate = 100_kHz, .pulses = 1'000'000};
  const Deflector sweeping{PolygonMirror{.line_rate = 100_Hz}, laser};
  const Deflector turning{RotatingHead{.angular_rate = 36_deg}, sweeping};
  const Platform platform{Tripod{.position = {0, 0, 0}}, Mount{.lever_arm = {0, 0, 1.7}}, turning};

  // the survey: from the number of a pulse to its echoes
  const Survey survey{platform, LatticeFootprint{19}, scene, Receiver{}, FullWaveform{}};
  Cloud cloud;
  run(survey, {}, cloud);
  std::cout << cloud.size() << " points\n";
}
