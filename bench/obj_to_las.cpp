// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Typical first program: an OBJ file is scanned from a tripod into a LAS file. `include_cost.sh` compiles it. Usage:
// obj_to_las OBJ LAS
#include <memory>
#include <utility>

#include <pulsecast/io/las.hpp>
#include <pulsecast/io/obj.hpp>
#include <pulsecast/pulsecast.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

int main(int count, char** words) {
  if (count != 3) return 2;
  io::ObjModel model = io::read_obj(words[1]);
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(std::move(model.mesh)),
                                      .materials = material_table(std::move(model.materials))}});
  const Deflector sweeping{PolygonMirror{.line_rate = 100_Hz}, Scanner{.pulse_rate = 100_kHz, .pulses = 1'000'000}};
  const Platform platform{Tripod{.position = {0, 0, 0}}, Mount{.lever_arm = {0, 0, 1.7}},
                          Deflector{RotatingHead{.angular_rate = 36_deg}, sweeping}};
  const Survey survey{platform, LatticeFootprint{19}, scene, Receiver{}, FullWaveform{}};
  io::LasWriter las(words[2]);
  run(survey, {}, las);
  las.close();
}
