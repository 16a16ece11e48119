// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_DETAIL_BUNDLE_INTERVAL_HPP
#define PULSECAST_GEOMETRY_DETAIL_BUNDLE_INTERVAL_HPP

#include <pulsecast/geometry/detail/bounding_box.hpp>
#include <pulsecast/geometry/detail/ray_sheaf.hpp>

namespace PULSECAST_NAMESPACE {

/// Conservative test of a whole bundle against boxes and planes, by interval arithmetic. If any ray
/// hits a primitive in double precision, the bundle hits every box around it, and the range is
/// inside the box's span. NaN rays are left out; if none is left, every span is empty.
template <std::floating_point Real>
class BundleInterval {
 public:
  using Entries = std::array<Real, 8>;  ///< entry ranges of boxes [m]

  struct Span {
    Real entry, exit;  ///< ends of the interval [m]
    [[nodiscard]] bool empty() const noexcept { return !(entry <= exit); }
  };

  /// `bounds` of the accelerator; its boxes are relative to `centre`.
  BundleInterval(const auto& rays, const Box& bounds, const Vec3& centre) noexcept
      : near_(round_down<Real>(rays.near)) {
    // primitive tests round by the largest coordinates: a hit may lie this far outside its box
    const double scale = std::max(max_norm(rays.origin), std::max(max_norm(bounds.min), max_norm(bounds.max)));
    const double slack = 64 * std::numeric_limits<double>::epsilon() * scale;
    if (!finite(rays.origin)) near_ = infinity;
    for (int k = 0; k < 3; ++k) {
      const double low = rays.direction_min(k), high = rays.direction_max(k);
      if (!(low <= high)) near_ = infinity;
      const double o = rays.origin[k] - centre[k];
      // rounding to Real, of the origin and of walls
      const double extent = 0.5 * (bounds.max[k] - bounds.min[k]);
      const double reach = reach_of(rays, k),
                   margin = reach + slack + (4 * (std::fabs(o) + reach) + 8 * extent) * epsilon;
      const Real from = static_cast<Real>(o - margin), to = static_cast<Real>(o + margin);
      if (low > 0)
        axes_[k] = {from, to, slowness(high, 1 - tolerance), slowness(low, 1 + tolerance), 1};
      else if (high < 0)
        axes_[k] = {from, to, -slowness(-high, 1 + tolerance), -slowness(-low, 1 - tolerance), -1};
      else
        axes_[k] = {from, to, high > 0 ? slowness(high, 1 - tolerance) : infinity,
                    low < 0 ? -slowness(-low, 1 - tolerance) : -infinity, 0};
    }
  }

  [[nodiscard]] Real limit(const auto& rays, const auto& nearest) const noexcept {
    return round_up<Real>(nearest.limit(rays));
  }

  /// Interval of range over which any ray may be inside the box; empty if none can be.
  [[nodiscard]] Span inside(const BoundingBox<Real>& box) const noexcept {
    Span span{near_, most};
    for (int k = 0; k < 3; ++k) {
      keep_above(span, axes_[k], box.min[k]);
      keep_below(span, axes_[k], box.max[k]);
    }
    return span;
  }

  /// Bit mask of the boxes that any ray may be inside of up to `limit`, and their entry ranges.
  [[nodiscard]] unsigned inside(const Box8<Real>& boxes, Real limit, Entries& entries) const noexcept {
    return inside(limit, entries, [&](std::size_t k, std::size_t first) noexcept -> Walls {
      const Axis& axis = axes_[k];
      return {(simd::load<simd::Packet<Real>>(boxes.min[k][first]) - axis.origin_high) * axis.per_min,
              (simd::load<simd::Packet<Real>>(boxes.max[k][first]) - axis.origin_low) * axis.per_max};
    });
  }

  /// Part of an interval in which any ray may be at or above, or below, a plane on axis k.
  [[nodiscard]] Span above(Span span, int k, Real position) const noexcept {
    keep_above(span, axes_[k], position);
    return span;
  }

  [[nodiscard]] Span below(Span span, int k, Real position) const noexcept {
    keep_below(span, axes_[k], position);
    return span;
  }

 private:
  /// Direction of the bundle along an axis: `sense` is +1 or -1 if all rays go that way, else 0.
  /// The factors turn the distance from the origin to a plane into range: `per_min` for an inside
  /// above the plane, `per_max` below it. If all rays go one way, one is the fastest's to enter,
  /// the other the slowest's to leave. Otherwise both bound the entry; no exit.
  struct Axis {
    Real origin_low, origin_high, per_min, per_max;
    int sense;
  };

  /// Ranges to the lower and upper walls of boxes; NaN where a ray on a wall stays on it.
  struct Walls {
    simd::Packet<Real> low, high;
  };

  [[nodiscard]] unsigned inside(Real limit, Entries& entries, const auto& walls_of) const noexcept {
    unsigned met = 0;
    for (std::size_t first = 0; first < 8; first += simd::packet_size<Real>) {
      simd::Packet<Real> entry = simd::Packet<Real>{} + near_;
      simd::Packet<Real> exit = simd::Packet<Real>{} + std::min(limit, most);
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

  static constexpr Real infinity = std::numeric_limits<Real>::infinity(), most = std::numeric_limits<Real>::max();
  static constexpr double epsilon = static_cast<double>(std::numeric_limits<Real>::epsilon()), tolerance = 8 * epsilon;
  /// Range per metre along an axis, finite.
  static Real slowness(double speed, double factor) noexcept {
    return static_cast<Real>(std::min(factor / speed, static_cast<double>(most)));
  }

  // A plane behind the origin has a negative range: as entry it has no effect, as exit it puts the
  // box behind the origin. Zero times infinity is NaN and fails every comparison.
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

  /// Distance to which rays may start from the origin of all, along an axis: of a sheaf [m].
  template <class Rays>
  static double reach_of([[maybe_unused]] const Rays& rays, [[maybe_unused]] int k) noexcept {
    if constexpr (std::is_same_v<Rays, detail::RaySheaf>) return rays.origin_reach[k];
    return 0;
  }

  Real near_;
  Axis axes_[3];
};

/// Conservative test of a single ray against eight boxes, in half the time of a `BundleInterval`:
/// the entry wall on each axis is known, and the walls of an axis share one factor. A hit box has a
/// `Key`: its entry range as an integer, in the same order, with three zero bits for a tag.
template <std::floating_point Real>
class RayInterval {
 public:
  using Key = std::conditional_t<sizeof(Real) == 4, std::int32_t, std::int64_t>;  ///< of a hit box
  using Keys = std::array<Key, 8>;                                                ///< keys by slot

  /// Greatest tagged key of a box that is entered at a range up to `limit` [m].
  [[nodiscard]] static Key last_key(Real limit) noexcept { return std::bit_cast<Key>(limit) | 7; }

  /// Of the only ray of a bundle. `bounds` of the accelerator; its boxes are relative to `centre`.
  RayInterval(const auto& ray, const Box& bounds, const Vec3& centre) noexcept {
    using Axes = simd::Vec4<Real>;
    const auto axes = [](const Vec3& v) noexcept { return simd::Vec4<double>(v.x, v.y, v.z); };
    const auto middle = axes(centre), from_middle = axes(ray.origin) - middle, toward = axes(ray.direction(0));
    const Axes o = from_middle.template as<Real>(), direction = toward.template as<Real>();
    const Axes distance = magnitude(o) + (axes(bounds.max) - axes(bounds.min)).template as<Real>();
    // margin of primitive tests, as for a bundle, and of the roundings of `clip`
    const Axes farthest = distance + magnitude(middle.template as<Real>());
    const Real scale = std::max(std::max(farthest[0], farthest[1]), farthest[2]);
    const Axes margin = Axes(static_cast<Real>(64 * std::numeric_limits<double>::epsilon()) * scale) +
                        distance * Axes(static_cast<Real>(tolerance));
    const Axes least(static_cast<Real>(min_speed * ray.direction_length));
    const Axes slowness = Axes(1) / simd::max(magnitude(direction), least), per = with_sign(slowness, direction);
    const Axes start = o * per, start_in = margin * slowness + start, start_out = margin * slowness - start;
    simd::store(per, maps_.per[0]);
    const WallBytes& walls = walls_by_signs[signs(direction) & 7];
#pragma GCC unroll 3
    for (std::size_t k = 0; k < 3; ++k) {
      maps_.walls.entry[k] = walls.entry[k];
      maps_.walls.exit[k] = walls.exit[k];
      maps_.start_in[k] = start_in[k] - Packet{};
      maps_.start_out[k] = start_out[k] - Packet{};
    }
    const auto both = from_middle + toward;
    const double valid = 0 * (both[0] + both[1] + both[2]);  // NaN for infinity and NaN: such rays miss
    maps_.near = (static_cast<Real>(ray.near * (1 - tolerance) + valid) + Real{0}) - Packet{};  // no -0
  }

  [[nodiscard]] Real limit(const auto&, const auto& nearest) const noexcept {
    return std::min(static_cast<Real>(nearest.limit_of(0) * (1 + tolerance)), max_limit);
  }

  /// Copy for a loop without calls, by members: the compiler keeps it in registers, where copies
  /// that live across a call are read from the stack at each node.
  [[nodiscard, gnu::always_inline]] RayInterval loaded() const noexcept {
    const RayInterval* from = this;
    asm("" : "+r"(from));
    RayInterval copy;
#pragma GCC unroll 3
    for (std::size_t k = 0; k < 3; ++k) {
      copy.maps_.start_in[k] = from->maps_.start_in[k];
      copy.maps_.start_out[k] = from->maps_.start_out[k];
      copy.maps_.per[k] = from->maps_.per[k];
      copy.maps_.walls.entry[k] = from->maps_.walls.entry[k];
      copy.maps_.walls.exit[k] = from->maps_.walls.exit[k];
    }
    copy.maps_.near = from->maps_.near;
    return copy;
  }

  /// Bit mask of the boxes that the ray may be inside of at a range up to `limit`, and their keys.
  // always inlined into the traversal
  [[nodiscard, gnu::always_inline]] unsigned inside(const Box8<Real>& boxes, Real limit, Keys& keys) const noexcept {
    unsigned met = 0;
    for (std::size_t first = 0; first < 8; first += lanes) {
      Packet entry = maps_.near, exit = limit - Packet{};
      clip(0, boxes, first, maps_, entry, exit);
      clip(1, boxes, first, maps_, entry, exit);
      clip(2, boxes, first, maps_, entry, exit);
      simd::store(KeyPacket(entry) & ~Key{7}, keys[first]);
      met |= simd::bits(entry <= exit) << first;
    }
    return met;
  }

 private:
  RayInterval() noexcept {}  // leaves the maps unset

  using Packet = simd::Packet<Real>;
  static constexpr std::size_t lanes = simd::packet_size<Real>;
  using KeyPacket = simd::Vec<Key, lanes>;

  static constexpr double tolerance = 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  /// Greatest limit: a box that is infinitely far is not hit.
  static constexpr Real max_limit = std::numeric_limits<Real>::max();
  /// Least speed along an axis, relative to the direction's length. Slower rays count as this fast:
  /// from the margin on, they leave a box so late that no hit lies beyond.
  static constexpr double min_speed = 1e-18;
  static constexpr std::size_t wall_bytes = sizeof(Box8<Real>::min[0]);

  /// Bytes of the walls where boxes are entered and left, by axis.
  struct WallBytes {
    std::array<std::size_t, 3> entry, exit;
  };
  /// By the sign bits of a direction.
  static constexpr std::array<WallBytes, 8> walls_by_signs = [] {
    std::array<WallBytes, 8> all{};
    for (std::size_t signs = 0; signs < 8; ++signs)
      for (std::size_t k = 0; k < 3; ++k) {
        all[signs].entry[k] = (k + 3 * (signs >> k & 1)) * wall_bytes;
        all[signs].exit[k] = (2 * k + 3) * wall_bytes - all[signs].entry[k];
      }
    return all;
  }();

  /// Linear maps from a wall's coordinate on each axis to range, with margins: entry, exit.
  struct Maps {
    Packet start_in[3], start_out[3], near;
    Real per[4];
    WallBytes walls;
  };

  /// Cuts the intervals of consecutive boxes down to what lies between their walls on axis k. A
  /// wall's range errs by seven roundings, as if the wall were moved by half an epsilon of its
  /// greatest distance for each: the margins, of 16, let no entry be late, and no exit early.
  [[gnu::always_inline]] void clip(std::size_t k, const Box8<Real>& boxes, std::size_t first, const Maps& maps,
                                   Packet& entry, Packet& exit) const noexcept {
    const char* const walls = reinterpret_cast<const char*>(&boxes.min[0][first]);
    const auto wall = [&](std::size_t byte) noexcept { return simd::load<Packet>(walls[byte]); };
    // NaN fails every comparison
    entry = simd::max(Packet(wall(maps.walls.entry[k]) * maps.per[k] - maps.start_in[k]), entry);
    exit = simd::min(Packet(wall(maps.walls.exit[k]) * maps.per[k] + maps.start_out[k]), exit);
  }

  Maps maps_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
