// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_WATER_SURFACE_HPP
#define PULSECAST_SHAPE_WATER_SURFACE_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/geometry/single_ray.hpp>
#include <pulsecast/shape/wave_field.hpp>

namespace PULSECAST_NAMESPACE {

/// Rectangle of still water.
struct WaterArea {
  Vec2 min{};        ///< south-western corner [m], within 1e9 m of the origin
  Vec2 max{};        ///< north-eastern corner [m], within 1e9 m of the origin
  double level = 0;  ///< mean level [m], within 1e9 m of the origin

  void validate() const {
    const double most = 1e9;
    for (int k = 0; k < 2; ++k) {
      require_within("WaterArea::min", min[k], -most, most, "m");
      require_within("WaterArea::max", max[k], min[k], most, "m");
    }
    require_within("WaterArea::level", level, -most, most, "m");
  }
};

/// Surface of water with the waves that it has when a pulse leaves; two-sided. Without waves it is
/// a plane. Hits lie within 1e-10 m of the surface along the ray, and a rounding of its
/// coordinates; one that dips into a crest, or leaves the water in a trough, for less may miss
/// both. Primitives number places along a ray: shares of 2^32 of its way between the bounds of the
/// waves. Search: along steps that a bound of slope and curvature proves to be free of hits; of
/// short waves it is their height, until the ray is near them. Source: Kalra & Barr 1989,
/// Guaranteed ray intersections with implicit surfaces (bounds of the first derivative).
class WaterSurface {
 public:
  using refinements = refines<tag::DeterministicGeometry, tag::TimeDependentGeometry>;
  static constexpr bool deterministic = true;   ///< as DeterministicGeometry describes
  static constexpr bool time_dependent = true;  ///< as TimeDependentGeometry describes

  /// @throws SettingError as `WaterArea::validate`
  explicit WaterSurface(const WaterArea& area, WaveField waves = {}) : waves_(std::move(waves)), level_(area.level) {
    area.validate();
    bounds_ = {{area.min.x, area.min.y, level_ - waves_.highest()},
               {area.max.x, area.max.y, level_ + waves_.highest()}};
  }

  [[nodiscard]] const WaveField& waves() const noexcept { return waves_; }  ///< about the mean level
  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  [[nodiscard]] std::size_t memory() const noexcept { return waves_.memory(); }
  [[nodiscard]] std::size_t material_count() const noexcept { return 1; }

  template <class Rays, HitsOf<Rays> Hits>
  void closest(const Rays& rays, Hits& nearest) const noexcept {
    bool prepared = false;
    detail::WavePhases phases;
    for (std::size_t j = 0; j < rays.size; ++j) {
      const Vec3 direction = rays.direction(j);
      const Span span = span_of(rays.origin, direction);
      if (!(span.begin <= span.end) || !(span.end > rays.near)) continue;
      if (!(span.begin <= nearest.limit_of(j))) continue;
      // true while more hits are of use
      const auto offer = [&](double at) noexcept {
        if (!(at > rays.near)) return true;
        nearest.offer(j, at, span.share_of(at));
        return std::is_same_v<Hits, AllHits> && at <= nearest.limit_of(j);
      };
      if (waves_.empty()) {
        offer(span.begin);
        continue;
      }
      if (!prepared) waves_.set_phases({rays.origin.x, rays.origin.y}, rays.tick, phases);
      prepared = true;
      const detail::WaveProfile profile(waves_, phases, {direction.x, direction.y});
      const Line line{rays.origin.z - level_, direction.z};
      if (std::fabs(line.climb) > (1 + 1e-9) * profile.steepest(profile.groups())) {
        const double at = only_root(profile, line);
        if (at >= span.begin && at <= span.end) offer(at);
      } else {
        find_roots(profile, line, span, nearest.limit_of(j), offer);
      }
    }
  }

  /// The normal is upwards. `i` is the primitive that the ray's hit was offered with.
  [[nodiscard]] SurfaceInteraction surface(PrimitiveIndex i, const auto& rays, std::size_t j) const noexcept {
    if (waves_.empty()) return {axis::up, 0};
    const Vec3 direction = rays.direction(j);
    const double at = span_of(rays.origin, direction).at_share(i);
    const Vec3 place = rays.origin + at * direction;
    const Vec2 slope = waves_.slope({place.x, place.y}, rays.tick);
    return {normalize(Vec3{-slope.x, -slope.y, 1}), 0};
  }

 private:
  static constexpr double tolerance = 0x1p-35;  ///< of a hit's range [m]

  /// Interval of range in which a ray is between the walls and the bounds of the waves [m].
  struct Span {
    double begin, end;

    [[nodiscard]] PrimitiveIndex share_of(double at) const noexcept {
      const double share = end > begin ? (at - begin) / (end - begin) * most_share : 0;
      return static_cast<PrimitiveIndex>(std::clamp(share, 0.0, most_share));
    }
    [[nodiscard]] double at_share(PrimitiveIndex i) const noexcept { return begin + (end - begin) * (i / most_share); }

   private:
    static constexpr double most_share = 4294967295.0;
  };

  /// Height of a ray above the mean level: start + climb t [m].
  struct Line {
    double start, climb;
    [[nodiscard]] double at(double t) const noexcept { return start + climb * t; }
  };

  /// Span of a ray of any ends; empty for one that is not finite.
  [[nodiscard]] Span span_of(const Vec3& origin, const Vec3& direction) const noexcept {
    constexpr Span none{1, 0};
    Span span{0, std::numeric_limits<double>::max()};
    if (!finite(origin) || !finite(direction)) return none;
    for (const int k : {2, 0, 1}) {
      const double to_min = bounds_.min[k] - origin[k], to_max = bounds_.max[k] - origin[k];
      if (direction[k] == 0) {
        if (!(to_min <= 0 && to_max >= 0)) return none;
        continue;
      }
      const double a = to_min / direction[k], b = to_max / direction[k];
      span.begin = std::max(span.begin, std::min(a, b));
      span.end = std::min(span.end, std::max(a, b));
    }
    return span;
  }

  /// Range at which a ray steeper than all waves hits them, even before its origin: bounded Newton.
  [[nodiscard]] double only_root(const detail::WaveProfile& profile, const Line& line) const noexcept {
    const std::size_t all = profile.groups();
    const double sense = line.climb < 0 ? -1 : 1, speed = std::fabs(line.climb);
    const double half = waves_.highest() / speed, least = speed - profile.steepest(all);
    double t = -line.start / line.climb, low = t - half, high = t + half;
    double slack = 0.125 * waves_.highest();
    for (int step = 0;; ++step) {
      const double z = line.at(t);
      const auto sample = profile.at(t, z, slack);
      const double above = z - sample.height, newton = -above / (line.climb - sample.rate);
      const bool near = profile.curviest(all) * newton * newton <= 2 * tolerance * least;
      if (sample.groups == all && (near || step == 64)) return t + newton;
      if (std::fabs(above) > sample.rest) (above * sense < 0 ? low : high) = t;
      const double next = t + newton;
      t = next > low && next < high && step < 16 ? next : 0.5 * (low + high);
      slack = step < 16 ? 0.0625 * std::fabs(above) : 0;
    }
  }

  /// Offers each place where a ray passes the surface, in order, to the end of its span or a limit.
  void find_roots(const detail::WaveProfile& profile, const Line& line, const Span& span, double limit,
                  const auto& offer) const noexcept {
    double t = span.begin, side = 0;
    while (true) {
      const double z = line.at(t);
      const auto sample = profile.at(t, z, 0);
      if (side == 0) side = z - sample.height > 0 ? 1 : -1;
      const double least = std::max(tolerance, 4 * std::numeric_limits<double>::epsilon() * t);
      double above = side * (z - sample.height), step = 0;
      if (above <= 0 && t > span.begin) {
        if (!offer(t)) return;
        side = -side;
      } else {
        above -= sample.rest;
        const double rate = side * (line.climb - sample.rate), curved = profile.curviest(sample.groups);
        const double root = std::sqrt(rate * rate + 2 * curved * above);
        const double by_slope = above / (profile.steepest(sample.groups) - side * line.climb);
        const double by_curve = rate < 0 ? 2 * above / (root - rate) : (rate + root) / curved;
        step = std::max(by_slope, by_curve);
      }
      if (t >= span.end || t > limit) return;
      t = std::min(t + std::max(step, least), span.end);
    }
  }

  WaveField waves_;
  double level_;
  Box bounds_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
