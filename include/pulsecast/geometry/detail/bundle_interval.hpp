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
    using Axes = simd::Vec4<double>;
    const auto axes = [](const Vec3& v) noexcept { return Axes(v.x, v.y, v.z); };
    const Axes direction = axes(ray.direction(0)), origin = axes(ray.origin);
    const Axes low = axes(bounds.min), high = axes(bounds.max), o = origin - axes(centre);
    // margin as for a bundle, for the same reasons
    const Axes farthest = simd::max(simd::max(magnitude(low), magnitude(high)), magnitude(origin));
    const double scale = std::max(std::max(farthest[0], farthest[1]), farthest[2]);
    const Axes slack(64 * std::numeric_limits<double>::epsilon() * scale);
    const Axes margin = slack + (magnitude(o) + (high - low)) * Axes(tolerance / 2);
    const Axes outwards = margin * sense(direction), least(min_speed * ray.direction_length);
    const Axes slowness = sense(direction) / simd::max(magnitude(direction), least);
    const auto per = (slowness * Axes(1 - tolerance)).template as<Real>();
    simd::store(per, maps_.per[0]);
    simd::store((Axes(0) - (o + outwards)).template as<Real>() * per, maps_.start[0][0]);
    simd::store((outwards - o).template as<Real>() * per, maps_.start[1][0]);
    for (std::size_t k = 0; k < 3; ++k)
      maps_.entry_wall[k] = k * wall_bytes + (std::signbit(direction[k]) ? 3 * wall_bytes : 0);
    const Axes both = o + direction;
    const bool is_valid = std::isfinite(both[0] + both[1] + both[2]);  // infinity and NaN miss
    maps_.near = is_valid ? static_cast<Real>(ray.near * (1 - tolerance)) + Real{0}
                          : std::numeric_limits<Real>::infinity();  // no -0
  }

  [[nodiscard]] Real limit(const auto&, const auto& nearest) const noexcept {
    return static_cast<Real>(std::min(nearest.limit_of(0) * (1 + tolerance), max_limit));
  }

  /// Bit mask of the boxes that the ray may be inside of at a range up to `limit`, and their keys.
  // always inlined into the traversal, which saves 20 instructions a node
  [[nodiscard, gnu::always_inline]] unsigned inside(const Box8<Real>& boxes, Real limit, Keys& keys) const noexcept {
    const Maps* maps = &maps_;
    asm("" : "+r"(maps));  // numbers for all lanes are loaded here: there are too few registers to keep them
    unsigned met = 0;
    for (std::size_t first = 0; first < 8; first += lanes) {
      Packet entry = maps->near - Packet{}, exit = limit - Packet{};
      clip(0, boxes, first, *maps, entry, exit);
      clip(1, boxes, first, *maps, entry, exit);
      clip(2, boxes, first, *maps, entry, exit);
      simd::store(KeyPacket(entry) & ~Key{7}, keys[first]);
      met |= simd::bits(entry <= exit * static_cast<Real>(1 + 3 * tolerance)) << first;
    }
    return met;
  }

 private:
  using Packet = simd::Packet<Real>;
  static constexpr std::size_t lanes = simd::packet_size<Real>;
  using KeyPacket = simd::Vec<Key, lanes>;

  static constexpr double tolerance = 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  /// Greatest limit; finite with the tolerance, so that a box that is infinitely far is not hit.
  static constexpr double max_limit = (1 - 4 * tolerance) * std::numeric_limits<Real>::max();
  /// Least speed along an axis, relative to the direction's length. Slower rays count as this fast:
  /// from the margin on, they leave a box so late that no hit lies beyond.
  static constexpr double min_speed = 1e-18;
  static constexpr std::size_t wall_bytes = sizeof(Box8<Real>::min[0]);

  /// Linear maps from a wall's coordinate on each axis to range, with margins: entry, exit.
  struct Maps {
    alignas(4 * sizeof(Real)) Real per[4], start[2][4];
    Real near;
    std::size_t entry_wall[3];  ///< byte of the walls where boxes are entered
  };

  /// Cuts the intervals of consecutive boxes down to what lies between their walls on axis k. A
  /// wall's position errs by two roundings of the distance to the origin, plus two of half the
  /// bounds; the range, by two. `per` is too small, so that the entry is not late.
  [[gnu::always_inline]] void clip(std::size_t k, const Box8<Real>& boxes, std::size_t first, const Maps& maps,
                                   Packet& entry, Packet& exit) const noexcept {
    const char* const walls = reinterpret_cast<const char*>(&boxes.min[0][first]);
    const auto range_of = [&](std::size_t byte, std::size_t side) noexcept -> Packet {
      return simd::load<Packet>(walls[byte]) * maps.per[k] + maps.start[side][k];
    };
    // NaN fails every comparison
    entry = simd::max(range_of(maps.entry_wall[k], 0), entry);
    exit = simd::min(range_of(3 * wall_bytes + 2 * k * wall_bytes - maps.entry_wall[k], 1), exit);
  }

  Maps maps_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
