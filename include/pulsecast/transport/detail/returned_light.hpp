// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_RETURNED_LIGHT_HPP
#define PULSECAST_TRANSPORT_DETAIL_RETURNED_LIGHT_HPP

#include <pulsecast/geometry/single_ray.hpp>
#include <pulsecast/transport/transport_input.hpp>

/// Light that the hits of a bundle send back, for all transports.
namespace PULSECAST_NAMESPACE::detail {

/// Gives a bundle the names of a pulse's rays and their exit.
[[gnu::always_inline]] inline void set_origin(const TransportInput& light, BundleOrigin& rays) noexcept {
  rays.origin = light.pulse.origin();
  rays.wavelength = light.emitter.laser.wavelength;
  rays.tick = light.pulse.tick;
  rays.seed = light.seed;
  rays.pulse = light.index;
}

/// Sets the directions of a bundle, whose size is set, from those of subrays `first` on.
[[gnu::always_inline]] inline void set_directions(const TransportInput& light, const Matrix3& world_from_beam,
                                                  std::size_t first, RayBundle& rays) noexcept {
  if (!light.beam.from_a_point()) rays.origin = light.pulse.origin() + world_from_beam * light.beam.exits[first];
  light.beam.to_world(world_from_beam, first, rays);
}

/// Takes away what the receiver does not see of the power of a bundle [W].
[[gnu::noinline]] inline void keep_in_view(const LinkBudget& budget, std::span<const Hit> hits,
                                           RayBundle::Column& power) noexcept {
  for (std::size_t j = 0; j < hits.size(); ++j) power[j] *= budget.overlap_at(hits[j].range);
}

/// Power received from the hits of rays with shares of the energy; no gate; not for misses [W].
[[gnu::always_inline]] inline void received_power(const TransportInput& light, const double* shares, std::size_t size,
                                                  std::span<const Hit> hits, RayBundle::Column& power) noexcept {
  if (size == 1) {
    power[0] = shares[0] * hits[0].backscatter * light.white_target.power(light.budget, hits[0].range);
    return;
  }
  for (std::size_t j = 0; j < size; j += simd::lane_count) {
    const simd::Doubles range = simd::generate([&](std::size_t lane) { return hits[j + lane].range; });
    const simd::Doubles backscatter = simd::generate([&](std::size_t lane) { return hits[j + lane].backscatter; });
    simd::store(light.budget.power_in_view(simd::load<simd::Doubles>(shares[j]), backscatter, range), power[j]);
  }
  if (!light.budget.sees_all()) [[unlikely]]
    keep_in_view(light.budget, hits.first(size), power);
}

/// Sets a reflection from a hit, without a velocity.
inline void set_reflection(Reflection& reflection, const Hit& hit, double power) noexcept {
  reflection.range = hit.range;
  reflection.power = power;
  reflection.object = hit.object;
  reflection.classification = hit.classification;
  reflection.kind = ReflectionKind::surface;
  reflection.cos_incidence = hit.cos_incidence;
}

/// Records the subrays from `first` on: their first hits, and what returns from there.
inline void record_subrays(const TransportInput& light, std::size_t first, std::span<const Hit> hits,
                           const RayBundle::Column& power) noexcept {
  const SubrayDirections& beam = light.beam;
  for (std::size_t j = 0; j < hits.size(); ++j) {
    const Hit& hit = hits[j];
    SubrayRecord& subray = light.record[first + j];
    subray = {hit, 0, Vec3{}};
    if (!hit.met()) continue;
    const Vec3 exit = beam.from_a_point() ? Vec3{} : beam.exits[first + j];
    const Vec3 direction{beam.x[first + j], beam.y[first + j], beam.z[first + j]};
    subray.point = light.reported().point(exit + hit.range * direction);
    if (light.gate.contains(hit.range) && power[j] > 0) subray.power = power[j];
  }
}

/// Velocity of the surface that a ray hits, along the ray [m/s].
template <class Target>
[[nodiscard]] double radial_velocity(const Target& target, const Ray& ray) noexcept {
  static_assert(SceneQueries<Target>,
                "the detector reads velocities, which this map does not give: it needs SceneQueries, as Scene");
  if constexpr (SceneQueries<Target>)
    if (const std::optional<RayHit> hit = target.closest_hit(ray))
      return dot(target.surface(*hit, ray).velocity, ray.direction);
  return 0;
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
