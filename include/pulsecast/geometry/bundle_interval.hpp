// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include <pulsecast/base/lanes.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/geometry/bundle.hpp>

namespace pulsecast {

/// The nearest number of type Real that is not greater.
template <std::floating_point Real>
[[nodiscard]] Real round_down(double value) noexcept {
  const Real r = static_cast<Real>(value);
  return static_cast<double>(r) > value ? std::nextafter(r, -std::numeric_limits<Real>::infinity()) : r;
}

/// The nearest number of type Real that is not less.
template <std::floating_point Real>
[[nodiscard]] Real round_up(double value) noexcept {
  const Real r = static_cast<Real>(value);
  return static_cast<double>(r) < value ? std::nextafter(r, std::numeric_limits<Real>::infinity()) : r;
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
      axis.sense = low > 0 ? 1 : high < 0 ? -1 : 0;
      const double most = std::max(std::fabs(low), std::fabs(high)), least = std::min(std::fabs(low), std::fabs(high));
      axis.slowness_low = slowness(most, 1 - tolerance), axis.slowness_high = slowness(least, 1 + tolerance);
      if (axis.sense == 0) {  // rays go both ways, or not at all
        axis.slowness_low = high > 0 ? slowness(high, 1 - tolerance) : infinity;
        axis.slowness_high = low < 0 ? slowness(-low, 1 - tolerance) : infinity;
        all_one_way_ = false;
      }
      sign_[k] = static_cast<Real>(axis.sense);
      entry_offset_[k] = axis.sense > 0 ? -axis.origin_high : axis.origin_low;
      exit_offset_[k] = axis.sense > 0 ? -axis.origin_low : axis.origin_high;
      slowness_low_[k] = axis.slowness_low, slowness_high_[k] = axis.slowness_high;
    }
    // the fourth lane neither enters late nor leaves early
    sign_[3] = entry_offset_[3] = slowness_low_[3] = 0, exit_offset_[3] = std::numeric_limits<Real>::max(), slowness_high_[3] = 1;
  }

  /// The stretch of range over which any ray may be inside the box; empty if none can be.
  [[nodiscard]] Span inside(const BoundingBox<Real>& box) const noexcept {
    return all_one_way_ ? inside_one_way(box) : inside_any_way(box);
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
  /// `sense` is +1 or -1 if all rays go that way along the axis, else 0. Slowness is range per metre along the axis; where the sense is 0,
  /// `slowness_low` is the least of the rays that go up and `slowness_high` the least of those that go down.
  struct Axis {
    Real origin_low, origin_high, slowness_low, slowness_high;
    int sense;
  };

  /// All three axes at once.
  [[nodiscard]] Span inside_one_way(const BoundingBox<Real>& box) const noexcept {
    Lane low, from_low_z;
    fill(low, box.min[0]), fill(from_low_z, box.min[2]);  // a box is six numbers in a row
    const Lane high = __builtin_shufflevector(from_low_z, from_low_z, 1, 2, 3, 3);
    const Lane zero = {};
    const Lane first = sign_ < zero ? high : low, last = sign_ < zero ? low : high;
    const Lane to_entry = sign_ * first + entry_offset_, to_exit = sign_ * last + exit_offset_;
    const Lane entry = to_entry * (to_entry > zero ? slowness_low_ : slowness_high_);
    const Lane exit = to_exit * (to_exit > zero ? slowness_high_ : slowness_low_);
    // the latest entry and the earliest exit, by halves
    const Lane entry_2 = __builtin_shufflevector(entry, entry, 2, 3, 0, 1), exit_2 = __builtin_shufflevector(exit, exit, 2, 3, 0, 1);
    const Lane late = entry > entry_2 ? entry : entry_2, early = exit < exit_2 ? exit : exit_2;
    const Real entered = late[0] > late[1] ? late[0] : late[1];
    return {entered > near_ ? entered : near_, early[0] < early[1] ? early[0] : early[1]};
  }

  [[nodiscard]] Span inside_any_way(const BoundingBox<Real>& box) const noexcept {
    Span span{near_, std::numeric_limits<Real>::max()};
    for (int k = 0; k < 3; ++k) {
      keep_above(span, axes_[k], box.min[k]);
      keep_below(span, axes_[k], box.max[k]);
    }
    return span;
  }

  static constexpr Real infinity = std::numeric_limits<Real>::infinity();
  static constexpr double tolerance = 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());

  /// Finite, so that times zero it is zero.
  static Real slowness(double speed, double factor) noexcept {
    return static_cast<Real>(std::min(factor / speed, static_cast<double>(std::numeric_limits<Real>::max())));
  }

  static Real lower(Real distance, const Axis& a) noexcept { return distance * (distance > 0 ? a.slowness_low : a.slowness_high); }
  static Real upper(Real distance, const Axis& a) noexcept { return distance * (distance > 0 ? a.slowness_high : a.slowness_low); }

  static void keep_above(Span& span, const Axis& a, Real low) noexcept {
    if (a.sense > 0)
      span.entry = std::max(span.entry, lower(low - a.origin_high, a));
    else if (a.sense < 0)
      span.exit = std::min(span.exit, upper(a.origin_high - low, a));
    else if (low > a.origin_high)
      span.entry = std::max(span.entry, (low - a.origin_high) * a.slowness_low);
  }

  static void keep_below(Span& span, const Axis& a, Real high) noexcept {
    if (a.sense > 0)
      span.exit = std::min(span.exit, upper(high - a.origin_low, a));
    else if (a.sense < 0)
      span.entry = std::max(span.entry, lower(a.origin_low - high, a));
    else if (high < a.origin_low)
      span.entry = std::max(span.entry, (a.origin_low - high) * a.slowness_high);
  }

  using Lane = Four<Real>;

  Real near_;
  bool all_one_way_ = true;  ///< along every axis, none of them zero
  Axis axes_[3];
  Lane sign_, entry_offset_, exit_offset_, slowness_low_, slowness_high_;  ///< as `axes_`, by axis; offsets turn planes into distances
};

}  // namespace pulsecast
