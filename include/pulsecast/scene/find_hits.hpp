// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_FIND_HITS_HPP
#define PULSECAST_SCENE_FIND_HITS_HPP

#include <cstddef>
#include <span>

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Nearest hit in a target of each ray of a bundle. Sets one hit per ray, of infinite range for a miss.
template <Target Target>
void find_hits(const Target& target, const RayBundle& rays, std::span<Hit> hits) noexcept {
  if constexpr (BundleTarget<Target>)
    target.closest(rays, hits);
  else
    for (std::size_t j = 0; j < rays.size; ++j) hits[j] = target.closest_hit(rays.ray(j)).value_or(Hit{});
}

namespace detail {
/// True only if a target that `MissesCones` says so of a cone of rays.
template <Target Target>
[[nodiscard]] bool misses_cone(const Target& target, const RayCone& cone) noexcept {
  static_assert(members_checked<Target, tag::MissesCones>);
  if constexpr (MissesCones<Target>) return target.misses_cone(cone);
  return false;
}
}  // namespace detail

}  // namespace PULSECAST_NAMESPACE

#endif
