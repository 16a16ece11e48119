// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <pulsecast/base/lanes.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/geometry/bundle.hpp>

namespace pulsecast {

namespace detail {
/// The number next to r that is greater; r is not infinite. What std::nextafter gives, without a call.
template <std::floating_point Real>
[[nodiscard]] Real next_above(Real r) noexcept {
  using Bits = std::conditional_t<sizeof(Real) == 4, std::int32_t, std::int64_t>;
  if (r == 0) return std::numeric_limits<Real>::denorm_min();
  return std::bit_cast<Real>(static_cast<Bits>(std::bit_cast<Bits>(r) + (r > 0 ? 1 : -1)));
}
}  // namespace detail

/// The nearest number of type Real that is not less.
template <std::floating_point Real>
[[nodiscard]] Real round_up(double value) noexcept {
  const Real r = static_cast<Real>(value);
  return static_cast<double>(r) < value ? detail::next_above(r) : r;
}

/// The nearest number of type Real that is not greater.
template <std::floating_point Real>
[[nodiscard]] Real round_down(double value) noexcept {
  return -round_up<Real>(-value);
}

/// A box of type Real, in coordinates relative to the centre of an accelerator; never smaller than the box that it stands for.
template <std::floating_point Real>
struct BoundingBox {
  Real min[3], max[3];  ///< [m]

  static BoundingBox around(const Box& box, const Vec3& centre) noexcept {
    constexpr double growing = 1 + 2 * std::numeric_limits<double>::epsilon(), shrinking = 2 - growing;
    BoundingBox b;
    for (int k = 0; k < 3; ++k) {
      // the subtraction itself rounds, by at most half an ulp of its result; a factor leaves an empty box empty
      const double low = box.min[k] - centre[k], high = box.max[k] - centre[k];
      b.min[k] = round_down<Real>(low * (low > 0 ? shrinking : growing));
      b.max[k] = round_up<Real>(high * (high > 0 ? growing : shrinking));
    }
    return b;
  }
};

/// Eight boxes, wall by wall. A place that is not taken holds the box that nothing is inside of.
template <std::floating_point Real>
struct EightBoxes {
  alignas(8 * sizeof(Real)) Real min[3][8], max[3][8];  ///< [m]

  EightBoxes() noexcept {
    constexpr Real most = std::numeric_limits<Real>::max();
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t place = 0; place < 8; ++place) min[k][place] = most, max[k][place] = -most;
  }

  void put(std::size_t place, const BoundingBox<Real>& box) noexcept {
    for (std::size_t k = 0; k < 3; ++k) min[k][place] = box.min[k], max[k][place] = box.max[k];
  }
};

/// A whole bundle against boxes and planes, by interval arithmetic. An answer may be too cautious, never too bold: where any ray
/// of the bundle meets a primitive in double precision, no box around that primitive is passed over, and the range is inside its span.
/// Rays that are not numbers are left out; if none is left, every span is empty.
template <std::floating_point Real>
class BundleInterval {
 public:
  struct Span {
    Real entry, exit;
    [[nodiscard]] bool empty() const noexcept { return !(entry <= exit); }
  };

  /// `bounds` is what the accelerator holds, `centre` what its boxes are relative to.
  BundleInterval(const RayBundle& rays, const Box& bounds, const Vec3& centre) noexcept : near_(round_down<Real>(rays.near)) {
    // Primitive tests round in double relative to the coordinates in play: a hit may lie this far outside of its box.
    const double scale = std::max(max_norm(rays.origin), std::max(max_norm(bounds.min), max_norm(bounds.max)));
    const double slack = 64 * std::numeric_limits<double>::epsilon() * scale;
    const RayBundle::Column* columns[3] = {&rays.x, &rays.y, &rays.z};
    if (!finite(rays.origin)) near_ = infinity;
    for (int k = 0; k < 3; ++k) {
      double low = std::numeric_limits<double>::infinity(), high = -low;  // comparisons that NaN never passes
      for (std::size_t j = 0; j < rays.size; ++j) {
        const double d = (*columns[k])[j];
        low = d < low ? d : low, high = d > high ? d : high;
      }
      if (!(low <= high)) near_ = infinity;
      const double o = rays.origin[k] - centre[k];
      const double margin = slack + std::fabs(o) * static_cast<double>(std::numeric_limits<Real>::epsilon());  // of rounding to Real
      Axis& axis = axes_[k];
      axis.origin_low = static_cast<Real>(o - margin), axis.origin_high = static_cast<Real>(o + margin);
      if (low > 0)
        axis.sense = 1, axis.per_min = slowness(high, 1 - tolerance), axis.per_max = slowness(low, 1 + tolerance);
      else if (high < 0)
        axis.sense = -1, axis.per_min = -slowness(-high, 1 + tolerance), axis.per_max = -slowness(-low, 1 - tolerance);
      else
        axis.sense = 0, axis.per_min = high > 0 ? slowness(high, 1 - tolerance) : infinity,
        axis.per_max = low < 0 ? -slowness(-low, 1 - tolerance) : -infinity;
    }
  }

  /// The stretch of range over which any ray may be inside the box; empty if none can be.
  [[nodiscard]] Span inside(const BoundingBox<Real>& box) const noexcept {
    Span span{near_, std::numeric_limits<Real>::max()};
    for (int k = 0; k < 3; ++k) {
      keep_above(span, axes_[k], box.min[k]);
      keep_below(span, axes_[k], box.max[k]);
    }
    return span;
  }

  /// The boxes that any ray may be inside of at a range of at most `limit`, a bit each, and where it may enter them.
  [[nodiscard]] unsigned inside(const EightBoxes<Real>& boxes, Real limit, std::array<Real, 8>& entries) const noexcept {
    const Pack<Real> zero = {};
    unsigned met = 0;
    for (std::size_t first = 0; first < 8; first += pack_count<Real>) {
      Pack<Real> entry = zero + near_, exit = zero + std::min(limit, std::numeric_limits<Real>::max());
      for (std::size_t k = 0; k < 3; ++k) {
        const Axis& axis = axes_[k];
        const Pack<Real> from_min = (load<Pack<Real>>(boxes.min[k][first]) - axis.origin_high) * axis.per_min;
        const Pack<Real> from_max = (load<Pack<Real>>(boxes.max[k][first]) - axis.origin_low) * axis.per_max;
        if (axis.sense > 0) {
          entry = from_min > entry ? from_min : entry, exit = from_max < exit ? from_max : exit;
        } else if (axis.sense < 0) {
          entry = from_max > entry ? from_max : entry, exit = from_min < exit ? from_min : exit;
        } else {
          entry = from_min > entry ? from_min : entry;
          entry = from_max > entry ? from_max : entry;
        }
      }
      store(entry, entries[first]);
      met |= bits(entry <= exit) << first;
    }
    return met;
  }

  /// The part of a stretch over which any ray may be at or above the plane at `position` along axis k.
  [[nodiscard]] Span above(Span span, int k, Real position) const noexcept {
    keep_above(span, axes_[k], position);
    return span;
  }

  /// The part of a stretch over which any ray may be at or below the plane at `position` along axis k.
  [[nodiscard]] Span below(Span span, int k, Real position) const noexcept {
    keep_below(span, axes_[k], position);
    return span;
  }

 private:
  /// `sense` is +1 or -1 if all rays go that way along the axis, else 0. The other two turn the distance from the origin to a plane into
  /// range: `per_min` where the inside is above the plane, `per_max` where it is below. Where all rays go one way, one of them is what the
  /// fastest ray needs to enter and the other what the slowest needs to leave; where they do not, a box is entered from either side by
  /// those that go up or down, and may be left late by one that stays.
  struct Axis {
    Real origin_low, origin_high, per_min, per_max;
    int sense;
  };

  static constexpr Real infinity = std::numeric_limits<Real>::infinity();
  static constexpr double tolerance = 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());

  /// Range per metre along an axis, finite.
  static Real slowness(double speed, double factor) noexcept {
    return static_cast<Real>(std::min(factor / speed, static_cast<double>(std::numeric_limits<Real>::max())));
  }

  // A distance behind the origin gives a range before 0: as entry it says nothing, as exit that the box lies behind. Zero times infinity is
  // no number and passes no comparison.
  static void keep_above(Span& span, const Axis& a, Real low) noexcept {
    const Real range = (low - a.origin_high) * a.per_min;
    if (a.sense >= 0)
      span.entry = range > span.entry ? range : span.entry;
    else
      span.exit = range < span.exit ? range : span.exit;
  }

  static void keep_below(Span& span, const Axis& a, Real high) noexcept {
    const Real range = (high - a.origin_low) * a.per_max;
    if (a.sense <= 0)
      span.entry = range > span.entry ? range : span.entry;
    else
      span.exit = range < span.exit ? range : span.exit;
  }

  Real near_;
  Axis axes_[3];
};

}  // namespace pulsecast
