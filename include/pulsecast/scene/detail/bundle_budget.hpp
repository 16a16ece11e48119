// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_DETAIL_BUNDLE_BUDGET_HPP
#define PULSECAST_SCENE_DETAIL_BUNDLE_BUDGET_HPP

#include <cstddef>
#include <limits>
#include <span>

#include <pulsecast/geometry/bundle.hpp>
#include <pulsecast/geometry/single_ray.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Count of the primitives that a bundle tests. A bundle meets all primitives between its rays: where they are many, as the leaves in a
/// broad beam, single rays are faster, and the bundle gives up.
struct BundleBudget {
  std::size_t most;        ///< tests that cost about as much as single rays
  std::size_t tested = 0;  ///< primitives so far

  /// Budget of a bundle of so many rays: without a limit for one.
  explicit BundleBudget(std::size_t rays) noexcept : most(rays == 1 ? std::numeric_limits<std::size_t>::max() : 256) {}

  [[nodiscard]] bool spent() const noexcept { return tested > most; }  ///< true once the bundle has given up
};

/// Leaf test within a budget.
template <class Test>
struct BudgetedTest {
  const Test& test;      ///< leaf test
  BundleBudget& budget;  ///< of the bundle

  void operator()(std::span<const PrimitiveIndex> primitives) const noexcept {
    budget.tested += primitives.size();
    if (!budget.spent()) test(primitives);
  }
  void prefetch(std::span<const PrimitiveIndex> primitives) const noexcept { test.prefetch(primitives); }
};

/// Limit of a search within a budget: nothing, once it is spent.
template <class Hits>
struct BudgetedLimit {
  const Hits& nearest;         ///< hits so far
  const BundleBudget& budget;  ///< of the bundle

  template <class Rays>
  [[nodiscard]] double limit(const Rays& rays) const noexcept {
    return budget.spent() ? -std::numeric_limits<double>::infinity() : nearest.limit(rays);
  }
  [[nodiscard]] double limit_of(std::size_t j) const noexcept { return nearest.limit_of(j); }  ///< as in `ClosestHits`
};

/// Closest hits of a shape by each ray of a bundle alone; the hits are the same.
template <class Shape, class Rays, HitsOf<Rays> Hits>
void closest_one_by_one(const Shape& shape, const Rays& rays, Hits& nearest) noexcept {
  for (std::size_t j = 0; j < rays.size; ++j) {
    BundleOfOne one(rays.ray(j));
    one.direction_length = rays.direction_length;
    ClosestHit hit(nearest.limit_of(j));
    hit.part = nearest.part;
    shape.closest(one, hit);
    if (hit.met(0)) nearest.offer(j, hit.range, hit.primitive_of(0));
  }
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
