// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_FIND_HITS_HPP
#define PULSECAST_SCENE_FIND_HITS_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/geometry/detail/ray_sheaf.hpp>
#include <pulsecast/material/material.hpp>

namespace PULSECAST_NAMESPACE {

/// Nearest hit in a target of each ray of a bundle, one per ray; of infinite range for a miss.
template <Target Target>
void find_hits(const Target& target, const RayBundle& rays, std::span<Hit> hits) noexcept {
  if constexpr (BundleTarget<Target>)
    target.closest(rays, hits);
  else
    for (std::size_t j = 0; j < rays.size; ++j) hits[j] = target.closest_hit(rays.ray(j)).value_or(Hit{});
  if constexpr (!VisitsMaterials<Target>)  // a map of the user's may leave it open
    for (Hit& hit : hits.first(rays.size))
      if (std::isnan(hit.scattered_share))
        hit.scattered_share = hit.backscatter < hit.cos_incidence ? hit.backscatter / hit.cos_incidence : 1;
}

/// Asks the law of a material for light of a wavelength [m], at hits whose cosine is set.
[[gnu::always_inline]] inline void scatter_at(const Material& material, double wavelength,
                                              const std::optional<Vec2>& texture, std::span<Hit> hits) noexcept {
  const SurfaceLaw& law = material.law;
  const double reflectance = material.reflectance_at(wavelength, texture);
  if (law.model()) [[unlikely]]
    return law.model()->scatter_at(hits, {wavelength, reflectance, material.index()});
  const double share = std::min(reflectance, 1.0);
  for (Hit& hit : hits) {
    hit.backscatter = reflectance * (law.cosine_share() * hit.cos_incidence + law.even_share());
    hit.scattered_share = share;
  }
}

namespace detail {
template <class T>
concept Bounded = requires(const T& map) {
  map.bounds();
};
template <class T>
concept FindsGround = requires(const T& map) {
  map.ground_height(Vec2{}, 0.0);
};

/// Target that finds the hits of pulses of one ray together, those of a bundle of one each. It names itself: a type
/// that inherits it may replace its `closest` of bundles alone.
template <class T>
concept TracesSheaves = VisitsMaterials<T> && std::same_as<typename T::TracesSheaves, T> &&
    requires(const T target, const RaySheaf& rays, double wavelength, std::span<Hit> hits) {
  { target.closest(rays, wavelength, hits) }
  noexcept;
};

template <class Target, class Visitor>
void visit_materials(const Target& target, const Visitor& visit) {
  static_assert(members_checked<Target, tag::VisitsMaterials>);
  if constexpr (VisitsMaterials<Target>) target.visit_materials(visit);
}
template <Target Target>
[[nodiscard]] bool misses_cone(const Target& target, const RayCone& cone) noexcept {
  static_assert(members_checked<Target, tag::MissesCones>);
  if constexpr (MissesCones<Target>) return target.misses_cone(cone);
  return false;
}
}  // namespace detail

}  // namespace PULSECAST_NAMESPACE

#endif
