// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <pulsecast/base/error.hpp>
#include <pulsecast/geometry/bundle_interval.hpp>

/// What the builds by the surface-area heuristic share: the cost of a node is that of the tests which a ray that meets it must expect,
/// and a ray that meets a box meets a part of it in proportion to the part's surface.
/// Source: Goldsmith & Salmon 1987; MacDonald & Booth 1990. In bins: Wald 2007; Shevtsov, Soupikov & Kapustin 2007.
namespace pulsecast::detail {

/// Cost of testing a primitive, where a step of the traversal costs 1. Only speed depends on it.
inline constexpr double test_cost = 2;

/// No leaf lies deeper, so a traversal may keep its way back in as many places.
inline constexpr std::size_t deepest = 64;

/// Coordinates beyond are refused, so that sums and areas of any Real stay finite [m].
inline constexpr double farthest = 1e18;

template <std::floating_point Real>
[[nodiscard]] constexpr BoundingBox<Real> no_box() noexcept {
  constexpr Real most = std::numeric_limits<Real>::max();
  return {{most, most, most}, {-most, -most, -most}};
}

template <std::floating_point Real>
void extend(BoundingBox<Real>& box, const BoundingBox<Real>& by) noexcept {
  for (int k = 0; k < 3; ++k) {
    box.min[k] = by.min[k] < box.min[k] ? by.min[k] : box.min[k];
    box.max[k] = by.max[k] > box.max[k] ? by.max[k] : box.max[k];
  }
}

/// Half of the surface [m^2].
template <std::floating_point Real>
[[nodiscard]] double half_area(const BoundingBox<Real>& box) noexcept {
  const double x = static_cast<double>(box.max[0]) - static_cast<double>(box.min[0]);
  const double y = static_cast<double>(box.max[1]) - static_cast<double>(box.min[1]);
  const double z = static_cast<double>(box.max[2]) - static_cast<double>(box.min[2]);
  return x * y + y * z + z * x;
}

/// Equal slices of an interval, the places where a build considers to split.
template <std::floating_point Real, int Count>
class Slices {
 public:
  Slices(Real low, Real high) noexcept : low_(low), width_((high - low) / Count), per_width_(Count / (high - low)) {}

  /// Whether the interval is long enough to be sliced.
  [[nodiscard]] bool valid() const noexcept { return width_ > 0 && per_width_ <= std::numeric_limits<Real>::max(); }

  /// The slice that holds x, or the one next to it.
  [[nodiscard]] std::size_t of(Real x) const noexcept {
    const Real s = (x - low_) * per_width_;
    return static_cast<std::size_t>(s > 0 ? (s < Count - 1 ? s : Count - 1) : 0);
  }

  /// Where slice i begins.
  [[nodiscard]] Real edge(std::size_t i) const noexcept { return low_ + static_cast<Real>(i) * width_; }

 private:
  Real low_, width_, per_width_;
};

/// A primitive as a build handles it.
template <std::floating_point Real>
struct Boxed {
  BoundingBox<Real> box;
  PrimitiveIndex primitive;
};

/// The primitives that can be met at all, in coordinates relative to the centre of their bounds.
template <std::floating_point Real>
struct BuildInput {
  Box bounds;
  Vec3 centre{};
  std::vector<Boxed<Real>> primitives;

  explicit BuildInput(std::span<const Box> boxes) {
    constexpr std::size_t most = std::numeric_limits<PrimitiveIndex>::max() - 1;  // one more would be taken for `Nearest::none`
    if (boxes.size() > most)
      throw SettingError("Accelerator::boxes", static_cast<double>(boxes.size()), "", "at most 4294967294 in number");
    std::size_t met = 0;
    for (const Box& box : boxes) {
      if (box.empty()) continue;
      const double extent = std::fmax(max_norm(box.min), max_norm(box.max));
      if (!(extent <= farthest)) throw SettingError("Accelerator::boxes", extent, "m", "within 1e18 m of the origin");
      bounds.extend(box), ++met;
    }
    if (met == 0) return;
    centre = bounds.centre();
    primitives.reserve(met);
    for (std::size_t i = 0; i < boxes.size(); ++i)
      if (!boxes[i].empty()) primitives.push_back({BoundingBox<Real>::around(boxes[i], centre), static_cast<PrimitiveIndex>(i)});
  }
};

/// The levels that halving needs until every part is one.
[[nodiscard]] inline std::size_t levels_of_halving(std::size_t parts) noexcept { return parts < 2 ? 0 : std::bit_width(parts - 1); }

}  // namespace pulsecast::detail
