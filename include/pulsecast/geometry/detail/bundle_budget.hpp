// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_DETAIL_BUNDLE_BUDGET_HPP
#define PULSECAST_GEOMETRY_DETAIL_BUNDLE_BUDGET_HPP

#include <pulsecast/geometry/single_ray.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Limit of the search of an accelerator by a bundle, which reads it after each leaf. A bundle
/// tests all primitives between its rays. Where they are many, as leaves in a broad beam, it gives
/// up, as its limit then excludes all boxes: single rays are faster.
template <class Hits>
struct BudgetedLimit {
  static constexpr int most = 48;  ///< leaves: as many cost more than single rays where triangles are small

  const Hits& nearest;    ///< hits so far
  mutable int asked = 0;  ///< number of reads of the limit

  [[nodiscard]] double limit(const auto& rays) const noexcept {
    return ++asked > most ? -infinity : nearest.limit(rays);
  }
  [[nodiscard]] double limit_of(std::size_t j) const noexcept { return nearest.limit_of(j); }

  [[nodiscard]] bool spent() const noexcept { return asked > most; }  ///< true after giving up
};

/// Closest hits of each ray of a bundle alone; the hits are the same. `search(ray, hit)` offers
/// those of a `SingleRayPacket` to a `ClosestHit`.
template <class Rays, HitsOf<Rays> Hits, class Search>
void closest_one_by_one(const Rays& rays, Hits& nearest, const Search& search) noexcept {
  for (std::size_t j = 0; j < rays.size; ++j) {
    SingleRayPacket one(rays.ray(j));
    one.direction_length = rays.direction_length;
    ClosestHit hit(nearest.limit_of(j));
    hit.part = nearest.part;
    search(one, hit);
    if (!hit.met(0)) continue;
    nearest.part = std::uint64_t{hit.part_of(0)} << 32;
    nearest.offer(j, hit.range[0], hit.primitive_of(0));
  }
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
