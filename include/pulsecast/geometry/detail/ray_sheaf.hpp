// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_DETAIL_RAY_SHEAF_HPP
#define PULSECAST_GEOMETRY_DETAIL_RAY_SHEAF_HPP

#include <pulsecast/geometry/single_ray.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Rays of several pulses, of nearby origins and about one direction, as successive ones of one
/// laser. They traverse a tree together, each tests triangles for itself: its hit is its own, to
/// the last bit. Each keeps its tick and its key.
struct RaySheaf {
  static constexpr std::size_t capacity = 8;  ///< greatest number of rays

  union {
    std::array<SingleRayPacket, capacity> rays;  ///< `size` are set; in a union, as its members would be initialized
  };
  std::array<double, capacity> far;  ///< hits of each ray are not beyond [m]
  std::size_t size = 0;              ///< rays in use
  bool together = false;             ///< true if they are worth tracing together, as `enclose` found

  static constexpr double near = 0;  ///< at most that of each ray [m]
  Vec3 origin{};                     ///< centre of the box around their origins [m]
  Vec3 origin_reach{};               ///< half its sides [m]
  Vec3 low, high;                    ///< minimum and maximum of the directions

  RaySheaf() noexcept {}  // leaves the rays unset

  [[gnu::always_inline]] void push_back(const SingleRayPacket& ray, double limit) noexcept {
    std::construct_at(&rays[size], ray);
    far[size++] = limit;
  }

  /// Finds what encloses the rays. False if they are not worth tracing together: few, far apart, or
  /// not finite.
  bool enclose() noexcept {
    constexpr double most_apart = 0.1;  // of origins [m] and unit directions: wider sheaves open too many nodes
    together = false;
    if (size < 3) return false;
    using Axes = simd::Vec4<double>;
    const auto axes = [](const Vec3& v) noexcept { return Axes(v.x, v.y, v.z); };
    const auto vector = [](const Axes& v) noexcept { return Vec3(v[0], v[1], v[2]); };
    Axes nearest = axes(rays[0].origin), farthest = nearest, least = axes(rays[0].toward), most = least, sum(0);
    for (const SingleRayPacket& ray : std::span(rays).first(size)) {
      const Axes from = axes(ray.origin), along = axes(ray.toward);
      nearest = simd::min(nearest, from);
      farthest = simd::max(farthest, from);
      least = simd::min(least, along);
      most = simd::max(most, along);
      sum = sum + (from + along);
    }
    const Vec3 first = vector(nearest), last = vector(farthest);
    low = vector(least);
    high = vector(most);
    origin = 0.5 * (first + last);
    origin_reach = (1 + 0x1p-50) * max(last - origin, origin - first);
    return together = finite(vector(sum)) &&
                      std::max(max_norm(last - first), max_norm(high - low)) <= most_apart * rays[0].direction_length;
  }

  [[nodiscard]] double direction_min(int k) const noexcept { return low[k]; }
  [[nodiscard]] double direction_max(int k) const noexcept { return high[k]; }
};

/// Closest hits of the rays of a sheaf.
struct SheafHits {
  std::array<ClosestHit, RaySheaf::capacity> of;  ///< of each ray
  std::uint64_t part = 0;                         ///< part under test, in the upper half

  explicit SheafHits(const RaySheaf& rays) noexcept
      : of([&]<std::size_t... j>(std::index_sequence<j...>) {
          return std::array{ClosestHit(j < rays.size ? rays.far[j] : -infinity)...};
        }(std::make_index_sequence<RaySheaf::capacity>())) {}

  [[nodiscard]] double limit(const RaySheaf&) const noexcept {
    double last = -infinity;
    for (const ClosestHit& hit : of) last = hit.range[0] > last ? hit.range[0] : last;
    return last;
  }
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
