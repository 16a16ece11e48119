// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/concepts.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/transport/transport_input.hpp>

/// Pulses through a transport alone, without a detector.
namespace pulsecast::support {

/// What a transport makes of one pulse.
struct Traced {
  TransportResult result;
  std::vector<Reflection> reflections;
  std::vector<ContinuousReturn> continuous;

  /// The reflections of one kind.
  [[nodiscard]] std::vector<Reflection> of(ReflectionKind kind) const {
    std::vector<Reflection> all;
    for (const Reflection& r : reflections)
      if (r.kind == kind) all.push_back(r);
    return all;
  }
  /// Power of the continuous returns of a kind between two ranges [m], and their mean range.
  struct Continuous {
    double power = 0;  ///< [W]
    double mean = 0;   ///< [m]
  };
  [[nodiscard]] Continuous between(double from, double to, ReflectionKind kind) const {
    Continuous sum;
    for (const ContinuousReturn& r : continuous) {
      const double begin = std::max(from, r.begin), end = std::min(to, r.end);
      if (r.kind != kind || !(begin < end)) continue;
      const auto density = [&](double range) {
        return r.at_begin + (range - r.begin) / (r.end - r.begin) * (r.at_end - r.at_begin);
      };
      const double a = density(begin), b = density(end), power = 0.5 * (a + b) * (end - begin);
      sum.power += power;
      sum.mean += power * (begin + (end - begin) * (a + 2 * b) / (3 * (a + b)));
    }
    sum.mean /= sum.power;
    return sum;
  }
  /// Difference between the energy sent and the terms of the ledger, by the energy sent.
  [[nodiscard]] double imbalance() const {
    const EnergyLedger& e = result.energy;
    return (e.missed + e.out_of_range + e.absorbed + e.scattered + e.cut) / e.sent - 1;
  }
};

/// Power of all reflections together [W].
[[nodiscard]] inline double power_of(const std::vector<Reflection>& reflections) {
  double sum = 0;
  for (const Reflection& r : reflections) sum += r.power;
  return sum;
}

/// Settings of such pulses.
struct Lamp {
  Laser laser{.divergence = 0};
  Receiver receiver{.visibility = std::numeric_limits<double>::infinity()};
  Tick tick{};
  std::uint64_t seed = 7;
  PulseIndex index = 0;
};

/// Pose of a beam from one point towards another.
[[nodiscard]] inline Pose<frame::Beam, frame::World> from_to(const Vec3& from, const Vec3& to) {
  const Vec3 d = normalize(to - from);
  const Vec3 axis = cross(axis::forward, d);
  const double sine = length(axis), cosine = dot(axis::forward, d);
  const Rotation turn = sine > 0     ? rotation_about(axis / sine, std::atan2(sine, cosine))
                        : cosine > 0 ? no_rotation
                                     : rotation_about(axis::up, pi);
  return {turn, from};
}

/// One pulse through a transport, with a workspace of it.
template <bool with_velocity = false, class Light, class Map, class Pattern>
[[nodiscard]] Traced traced(const Light& transport, const Map& map, const Pose<frame::Beam, frame::World>& pose,
                            const Pattern& footprint, const Lamp& lamp, typename Light::Workspace& w) {
  const Emitter emitter{.laser = lamp.laser};
  const SubrayDirections beam(footprint, emitter);
  const LinkBudget budget(lamp.receiver, lamp.laser);
  Pulse<frame::World> pulse;
  pulse.pose = pose;
  pulse.tick = lamp.tick;
  WhiteTarget white;
  Traced all;
  all.reflections.resize(transport.reflections(footprint.size()));
  const TransportInput light{pulse,  lamp.index, lamp.seed,           emitter, beam, footprint.size(),
                             budget, white,      lamp.receiver.gate()};
  if constexpr (with_velocity)
    all.result = transport.template trace<true>(map, light, w, all.reflections);
  else
    all.result = transport.trace(map, light, w, all.reflections);
  all.reflections.resize(all.result.reflections);
  all.continuous.assign(all.result.continuous.begin(), all.result.continuous.end());
  all.result.continuous = all.continuous;
  return all;
}
/// As above, with a workspace of its own.
template <bool with_velocity = false, class Light, class Map, class Pattern>
[[nodiscard]] Traced traced(const Light& transport, const Map& map, const Pose<frame::Beam, frame::World>& pose,
                            const Pattern& footprint, const Lamp& lamp = {}) {
  auto w = transport.workspace(footprint.size());
  return traced<with_velocity>(transport, map, pose, footprint, lamp, w);
}

using LightScene = Scene<TriangleMesh<>>;

/// A plane rectangle about a point, between two half sides [m].
[[nodiscard]] inline LightScene::Part rectangle(const Vec3& centre, const Vec3& right, const Vec3& up,
                                                Material material, ObjectId object = 0) {
  const MeshData mesh{.vertices = {centre - right - up, centre + right - up, centre + right + up, centre - right + up},
                      .triangles = {{0, 1, 2}, {0, 2, 3}}};
  return {.geometry = std::make_shared<const TriangleMesh<>>(mesh),
          .materials = material_table({std::move(material)}),
          .object = object};
}

/// A material that scatters nothing and passes light on.
[[nodiscard]] inline Material clean(const SmoothInterface& smooth) { return {.reflectance = 0, .smooth = smooth}; }

}  // namespace pulsecast::support
