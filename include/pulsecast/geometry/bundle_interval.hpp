// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_BUNDLE_INTERVAL_HPP
#define PULSECAST_GEOMETRY_BUNDLE_INTERVAL_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include <pulsecast/base/simd.hpp>
#include <pulsecast/geometry/bounding_box.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/geometry/bundle.hpp>

namespace pulsecast {

/// Conservative test of a whole bundle against boxes and planes, by interval arithmetic. If any ray meets a primitive in double precision,
/// the bundle meets every box around that primitive, and the range is inside the box's span.
/// NaN rays are left out; if none is left, every span is empty.
template <std::floating_point Real>
class BundleInterval {
 public:
  /// Interval of range.
  struct Span {
    Real entry, exit;                                                       ///< ends of the interval [m]
    [[nodiscard]] bool empty() const noexcept { return !(entry <= exit); }  ///< true if no range is inside
  };

  /// `bounds` of the accelerator; its boxes are relative to `centre`.
  template <class Rays>
  BundleInterval(const Rays& rays, const Box& bounds, const Vec3& centre) noexcept : near_(round_down<Real>(rays.near)) {
    // Primitive tests round in double relative to the largest coordinates: a hit may lie this far outside its box.
    const double scale = std::max(max_norm(rays.origin), std::max(max_norm(bounds.min), max_norm(bounds.max)));
    const double slack = 64 * std::numeric_limits<double>::epsilon() * scale;
    if (!finite(rays.origin)) near_ = infinity;
    for (int k = 0; k < 3; ++k) {
      const double low = rays.least_along(k), high = rays.most_along(k);
      if (!(low <= high)) near_ = infinity;
      const double o = rays.origin[k] - centre[k];
      // rounding to Real; a wall is at most three half extents away from the origin of a grid, see `inside`
      const double extent = 0.5 * (bounds.max[k] - bounds.min[k]);
      const double margin = slack + (4 * std::fabs(o) + 8 * extent) * static_cast<double>(std::numeric_limits<Real>::epsilon());
      const Real origin_low = static_cast<Real>(o - margin), origin_high = static_cast<Real>(o + margin);
      if (low > 0)
        axes_[k] = {origin_low, origin_high, slowness(high, 1 - tolerance), slowness(low, 1 + tolerance), 1};
      else if (high < 0)
        axes_[k] = {origin_low, origin_high, -slowness(-high, 1 + tolerance), -slowness(-low, 1 - tolerance), -1};
      else
        axes_[k] = {origin_low, origin_high, high > 0 ? slowness(high, 1 - tolerance) : infinity,
                    low < 0 ? -slowness(-low, 1 - tolerance) : -infinity, 0};
    }
  }

  /// Largest range at which any ray can still find a closer hit.
  template <class Rays, class Hits>
  [[nodiscard]] Real limit(const Rays& rays, const Hits& nearest) const noexcept {
    return round_up<Real>(nearest.limit(rays));
  }

  /// Interval of range over which any ray may be inside the box; empty if none can be.
  [[nodiscard]] Span inside(const BoundingBox<Real>& box) const noexcept {
    Span span{near_, std::numeric_limits<Real>::max()};
    for (int k = 0; k < 3; ++k) {
      keep_above(span, axes_[k], box.min[k]);
      keep_below(span, axes_[k], box.max[k]);
    }
    return span;
  }

  /// Bit mask of the boxes that any ray may be inside of at a range up to `limit`, and their entry ranges.
  [[nodiscard]] unsigned inside(const Box8<Real>& boxes, Real limit, std::array<Real, 8>& entries) const noexcept {
    return inside(limit, entries, [&](std::size_t k, std::size_t first) noexcept -> Walls {
      const Axis& axis = axes_[k];
      return {(simd::load<simd::Packet<Real>>(boxes.min[k][first]) - axis.origin_high) * axis.per_min,
              (simd::load<simd::Packet<Real>>(boxes.max[k][first]) - axis.origin_low) * axis.per_max};
    });
  }
  /// Bit mask and entry ranges, as above.
  [[nodiscard]] unsigned inside(const QuantizedBox8<Real>& boxes, Real limit, std::array<Real, 8>& entries) const noexcept {
    // two roundings of a wall's distance from the origin, as the steps of its grid are powers of two
    Real to_low[3], to_high[3], steps[3];
    for (std::size_t k = 0; k < 3; ++k) {
      to_low[k] = boxes.origin[k] - axes_[k].origin_high;
      to_high[k] = boxes.origin[k] - axes_[k].origin_low;
      steps[k] = boxes.step(k);
    }
    const unsigned met = inside(limit, entries, [&](std::size_t k, std::size_t first) noexcept -> Walls {
      return {(simd::packet_from<Real>(boxes.walls[k][0][first]) * steps[k] + to_low[k]) * axes_[k].per_min,
              (simd::packet_from<Real>(boxes.walls[k][1][first]) * steps[k] + to_high[k]) * axes_[k].per_max};
    });
    return met & ((1U << boxes.count) - 1);
  }

  /// Part of an interval over which any ray may be at or above the plane at `position` along axis k.
  [[nodiscard]] Span above(Span span, int k, Real position) const noexcept {
    keep_above(span, axes_[k], position);
    return span;
  }

  /// Part of an interval over which any ray may be at or below the plane at `position` along axis k.
  [[nodiscard]] Span below(Span span, int k, Real position) const noexcept {
    keep_below(span, axes_[k], position);
    return span;
  }

 private:
  /// Direction of the bundle along an axis: `sense` is +1 or -1 if all rays go that way, else 0. The factors turn the distance from the
  /// origin to a plane into range: `per_min` for an inside above the plane, `per_max` for one below it. If all rays go one way, one factor
  /// is the fastest ray's to enter, the other the slowest ray's to leave. Otherwise both bound the entry, by the fastest ray each way; the
  /// exit is unbounded, as a ray may stay inside.
  struct Axis {
    Real origin_low, origin_high, per_min, per_max;
    int sense;
  };

  /// Ranges to the lower and upper walls of boxes; NaN where a ray on a wall stays on it.
  struct Walls {
    simd::Packet<Real> low, high;
  };

  template <class WallsOf>
  [[nodiscard]] unsigned inside(Real limit, std::array<Real, 8>& entries, const WallsOf& walls_of) const noexcept {
    unsigned met = 0;
    for (std::size_t first = 0; first < 8; first += simd::packet_size<Real>) {
      simd::Packet<Real> entry = simd::Packet<Real>{} + near_,
                         exit = simd::Packet<Real>{} + std::min(limit, std::numeric_limits<Real>::max());
      for (std::size_t k = 0; k < 3; ++k) {
        const Walls walls = walls_of(k, first);
        if (axes_[k].sense > 0) {  // NaN fails every comparison
          entry = simd::max(walls.low, entry);
          exit = simd::min(walls.high, exit);
        } else if (axes_[k].sense < 0) {
          entry = simd::max(walls.high, entry);
          exit = simd::min(walls.low, exit);
        } else
          entry = simd::max(walls.high, simd::max(walls.low, entry));
      }
      simd::store(entry, entries[first]);
      met |= simd::bits(entry <= exit) << first;
    }
    return met;
  }

  static constexpr Real infinity = std::numeric_limits<Real>::infinity();
  static constexpr double tolerance = 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());

  /// Range per metre along an axis, finite.
  static Real slowness(double speed, double factor) noexcept {
    return static_cast<Real>(std::min(factor / speed, static_cast<double>(std::numeric_limits<Real>::max())));
  }

  // A plane behind the origin gives a negative range: as entry it has no effect, as exit it puts the box behind. Zero times infinity is NaN
  // and fails every comparison.
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

/// Conservative test of a single ray against eight boxes, in half the time of a `BundleInterval`: the entry wall on each axis is known.
template <std::floating_point Real>
class RayInterval {
 public:
  /// Of the only ray of a bundle. `bounds` of the accelerator; its boxes are relative to `centre`.
  template <class Rays>
  RayInterval(const Rays& ray, const Box& bounds, const Vec3& centre) noexcept {
    using Axes = simd::Vec4<double>;
    const auto axes = [](const Vec3& v) noexcept { return Axes(v.x, v.y, v.z); };
    const Axes direction = axes(ray.direction(0)), origin = axes(ray.origin), low = axes(bounds.min), high = axes(bounds.max);
    const Axes o = origin - axes(centre);
    // margin as for a bundle, for the same reasons
    const Axes farthest = simd::max(simd::max(magnitude(low), magnitude(high)), magnitude(origin));
    const double slack = 64 * std::numeric_limits<double>::epsilon() * std::max(std::max(farthest[0], farthest[1]), farthest[2]);
    const Axes margin = Axes(slack) + (magnitude(o) + (high - low)) * Axes(4 * static_cast<double>(std::numeric_limits<Real>::epsilon()));
    const Axes outwards = margin * sense(direction);
    const Axes slowness = sense(direction) / simd::max(magnitude(direction), Axes(min_speed * ray.direction_length));
    put(0, o + outwards, slowness * Axes(1 - tolerance));
    put(1, o - outwards, slowness * Axes(1 + tolerance));
    for (std::size_t k = 0; k < 3; ++k) upper_[k] = direction[k] < 0 ? 1 : 0;
    const Axes both = o + direction;
    const bool is_valid = std::isfinite(both[0] + both[1] + both[2]);  // infinity and NaN survive sums; an invalid ray misses
    near_ = is_valid ? static_cast<Real>(ray.near * (1 - tolerance)) : std::numeric_limits<Real>::infinity();
  }

  /// Largest range at which the ray can still find a closer hit.
  template <class Rays, class Hits>
  [[nodiscard]] Real limit(const Rays&, const Hits& nearest) const noexcept {
    return static_cast<Real>(std::min(nearest.limit_of(0) * (1 + tolerance), double{std::numeric_limits<Real>::max()}));
  }

  /// Bit mask of the boxes that the ray may be inside of at a range up to `limit`, and their entry ranges.
  [[nodiscard]] unsigned inside(const QuantizedBox8<Real>& boxes, Real limit, std::array<Real, 8>& entries) const noexcept {
    Real steps[3];
    for (std::size_t k = 0; k < 3; ++k) steps[k] = boxes.step(k);
    unsigned met = 0;
    for (std::size_t first = 0; first < 8; first += simd::packet_size<Real>) {
      // The range to a wall is linear in its number. The wall's position errs by two roundings of the distance to the origin, plus four and
      // a half of half the bounds.
      const auto ranges = [&](std::size_t k, std::size_t side) noexcept -> simd::Packet<Real> {
        const Real per = per_[side][k], start = boxes.origin[k] * per + start_[side][k];
        return simd::packet_from<Real>(boxes.walls[k][upper_[k] ^ side][first]) * (steps[k] * per) + start;
      };
      simd::Packet<Real> entry = near_ - simd::Packet<Real>{}, exit = limit - simd::Packet<Real>{};
      for (std::size_t k = 0; k < 3; ++k) {  // NaN fails every comparison
        entry = simd::max(ranges(k, 0), entry);
        exit = simd::min(ranges(k, 1), exit);
      }
      simd::store(entry, entries[first]);
      met |= simd::bits(entry <= exit) << first;
    }
    return met & ((1U << boxes.count) - 1);
  }

 private:
  static constexpr double tolerance = 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  /// Least speed along an axis, relative to the direction's length. Slower rays count as this fast: from the margin on, they leave a box so
  /// late that no hit lies beyond.
  static constexpr double min_speed = 1e-18;

  void put(std::size_t side, const simd::Vec4<double>& from, const simd::Vec4<double>& slowness) noexcept {
    per_[side] = slowness.template as<Real>();
    start_[side] = (simd::Vec4<double>(0) - from).template as<Real>() * per_[side];
  }

  /// Linear map from a wall's coordinate along each axis to range, for entry and for exit.
  simd::Vec4<Real> per_[2], start_[2];
  Real near_;
  std::size_t upper_[3];  ///< 1 where boxes are entered through their upper walls
};

}  // namespace pulsecast

#endif
