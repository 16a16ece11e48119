// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>

#include "scenes.hpp"

/// The surveys of the benchmarks: where the pulses of `scenes.hpp` come from instruments.
namespace bench {

using Mesh = TriangleMesh<>;

/// An airplane over the hills, 1,250 m above them; lines of 910 m.
[[nodiscard]] inline auto airplane(PulseIndex pulses) {
  const Laser laser{.wavelength = 1550_nm, .peak_power = 5000_W, .pulse_length = 4_ns, .divergence = 0.25_mrad};
  return Platform{StraightLine{.from = {0, -450, 1250}, .to = {0, 450, 1250}, .speed = 60},
                  Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
                  Deflector{OscillatingMirror{.cycle_rate = 50_Hz, .half_angle = 20_deg},
                            Scanner{.pulse_rate = 100_kHz, .pulses = pulses, .laser = laser}}};
}

/// A tripod 12 m from the tree, which stands at the origin: lines from below the horizon up, in slow steps across the
/// crown.
[[nodiscard]] inline auto tripod(PulseIndex pulses) {
  const Laser laser{.wavelength = 1550_nm, .peak_power = 10_W, .pulse_length = 4_ns, .divergence = 0.3_mrad};
  const Scanner scanner{.pulse_rate = 100_kHz, .pulses = pulses, .laser = laser};
  const RotatingHead head{.angular_rate = 40_deg / scanner.duration().seconds()};
  return Platform{
      Tripod{.position = {12, 0, 0}}, Mount{.lever_arm = {0, 0, 1.7}, .boresight = rotation_about(axis::up, 70_deg)},
      Deflector{head, Deflector{PolygonMirror{.line_rate = 100_Hz, .sweep = 45_deg, .angle_min = -10_deg}, scanner}}};
}

/// A car in the street, with a scanner that turns across.
[[nodiscard]] inline auto car(PulseIndex pulses) {
  const Laser laser{.wavelength = 905_nm, .peak_power = 75_W, .pulse_length = 5_ns, .divergence = 0.3_mrad};
  return Platform{StraightLine{.from = street::on({2, -70}), .to = street::on({2, 70}), .speed = 10},
                  Mount{.lever_arm = {0, 0, 2.3}, .boresight = rotation_about(axis::up, 45_deg)},
                  Deflector{PolygonMirror{.line_rate = 100_Hz, .sweep = 180_deg},
                            Scanner{.pulse_rate = 100_kHz, .pulses = pulses, .laser = laser}}};
}

/// A scene of one mesh, with a single material.
[[nodiscard]] inline Scene<Mesh> scene_of(MeshData mesh) {
  mesh.materials.clear();
  return Scene<Mesh>({{.geometry = std::make_shared<const Mesh>(std::move(mesh))}});
}

/// The town of the street with another material for its windows.
[[nodiscard]] inline Scene<Mesh> town_with(const Material& windows) {
  const auto town = street::scene(1);
  std::vector<Scene<Mesh>::Part> parts(town.parts().begin(), town.parts().end());
  for (auto& part : parts) {
    std::vector<Material> materials = *part.materials;
    if (materials.size() > street::glass) materials[street::glass] = windows;
    part.materials = material_table(std::move(materials));
  }
  return Scene<Mesh>(std::move(parts));
}

/// Sink that keeps the results of a run as one batch.
struct Recording {
  std::vector<Shot> shots;
  std::vector<Echo> echoes;
  std::vector<float> samples;
  double sample_interval = 0;

  void operator()(const EchoBatch& batch) {
    for (Shot shot : batch.shots) {
      shot.first_echo += static_cast<std::uint32_t>(echoes.size());
      shot.first_sample += samples.size();
      shots.push_back(shot);
    }
    echoes.insert(echoes.end(), batch.echoes.begin(), batch.echoes.end());
    samples.insert(samples.end(), batch.samples.begin(), batch.samples.end());
    sample_interval = batch.sample_interval;
  }

  [[nodiscard]] EchoBatch batch() const noexcept { return {shots, echoes, samples, sample_interval}; }
};

}  // namespace bench
