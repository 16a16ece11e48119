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

  std::array<SingleRayPacket, capacity> rays;  ///< `size` are set
  std::array<double, capacity> far;            ///< hits of each ray are not beyond [m]
  std::size_t size = 0;                        ///< rays in use

  static constexpr double near = 0;  ///< at most that of each ray [m]
  Vec3 origin{};                     ///< centre of the box around their origins [m]
  Vec3 origin_reach{};               ///< half its sides [m]
  Vec3 low, high;                    ///< minimum and maximum of the directions

  RaySheaf() noexcept {}  // leaves the rays unset

  void push_back(const SingleRayPacket& ray, double limit) noexcept {
    rays[size] = ray;
    far[size++] = limit;
  }

  /// Finds what encloses the rays. False if they are not worth tracing together: few, far apart, or
  /// not finite.
  [[nodiscard]] bool enclose() noexcept {
    constexpr double most_apart = 0.1;  // of origins [m] and unit directions: wider sheaves open too many nodes
    if (size < 3) return false;
    Vec3 first = rays[0].origin, last = first, sum{};
    low = high = rays[0].toward;
    for (const SingleRayPacket& ray : std::span(rays).first(size)) {
      first = min(first, ray.origin);
      last = max(last, ray.origin);
      low = min(low, ray.toward);
      high = max(high, ray.toward);
      sum += ray.origin + ray.toward;
    }
    origin = 0.5 * (first + last);
    origin_reach = (1 + 0x1p-50) * max(last - origin, origin - first);
    return finite(sum) &&
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
