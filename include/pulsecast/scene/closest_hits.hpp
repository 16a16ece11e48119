// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_CLOSEST_HITS_HPP
#define PULSECAST_SCENE_CLOSEST_HITS_HPP

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Result of `map.closest_hit(ray)`: optional, a `RayHit` of a scene, a `Hit` of a `RayTarget`.
template <class Target>
requires(RayTarget<Target> || SceneQueries<Target>) using ClosestHitOf =
    decltype(std::declval<const Target&>().closest_hit(std::declval<const Ray&>()));

namespace detail {
/// Scene that also finds the closest hits of a bundle, those of its rays. They depend on the rays'
/// key unless `deterministic()`, on the tick if `time_dependent`.
template <class S>
concept TracesBundles = requires(const S scene, const RayBundle& rays, ClosestHits& hits) {
  scene.closest(rays, hits);
  scene.deterministic();
  S::time_dependent;
};

/// Cell of a unit vector on the faces of a cube: 0.05 wide at the centre of a face.
[[nodiscard]] inline std::uint32_t direction_cell(const Vec3& d) noexcept {
  constexpr double per_half = 20;  // bench/batch.cpp: 25 makes bundles too small; 12, too wide
  const Vec3 size{std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)};
  const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  const double per = per_half / size[axis];
  const auto cell = [&](int k) noexcept {
    return static_cast<std::uint32_t>(static_cast<int>(d[k % 3] * per + per_half));
  };
  const auto face = static_cast<std::uint32_t>(axis) << 1U | (d[axis] < 0 ? 1U : 0U);
  return face << 19U | cell(axis + 1) << 6U | cell(axis + 2);
}

/// Closest hits of rays of one origin and the same limits, some of which are named by `numbers`.
template <TracesBundles Scene>
void trace_bundle(const Scene& scene, std::span<const Ray> rays, std::span<const std::uint64_t> numbers,
                  std::span<std::optional<RayHit>> hits) noexcept {
  const auto number = [&](std::size_t j) { return static_cast<std::size_t>(numbers[j] & 0xFFFF); };
  RayBundle bundle = bundle_of(rays[number(0)]);
  bundle.size = numbers.size();
  for (std::size_t j = 0; j < bundle.size; ++j) bundle.set_direction(j, rays[number(j)].direction);
  bundle.pad();
  ClosestHits nearest(bundle);
  scene.closest(bundle, nearest);
  for (std::size_t j = 0; j < bundle.size; ++j) {
    std::optional<RayHit>& hit = hits[number(j)] = std::nullopt;
    if (nearest.met(j)) hit = RayHit{nearest.range[j], nearest.part_of(j), nearest.primitive_of(j)};
  }
}
}  // namespace detail

/// Closest hit of each ray, as `map.closest_hit` gives it. Of up to 512 consecutive rays with one
/// origin, `near` and `far` (and tick, for a moving scene), those of about one direction are traced
/// together, in whatever order they come. Directions are unit vectors. Allocates nothing.
template <class Target>
void closest_hits(const Target& target, std::span<const Ray> rays, std::span<ClosestHitOf<Target>> hits) noexcept {
  std::size_t first = 0;
  if constexpr (SceneQueries<Target> && detail::TracesBundles<Target>) {
    constexpr std::size_t least = 4, most = 32;  // rays of a bundle; two or three cost less alone
    std::array<std::uint64_t, 512> order;        // cell and number
    while (target.deterministic() && first < rays.size()) {
      const Ray& one = rays[first];
      std::size_t count = 0;
      for (; count < order.size() && first + count < rays.size(); ++count) {
        const Ray& ray = rays[first + count];
        const bool like = ray.origin == one.origin && ray.near == one.near && ray.far == one.far;
        const bool together = like && (!Target::time_dependent || ray.tick == one.tick);
        if (!together || !(std::fabs(dot(ray.direction, ray.direction) - 1) < 1e-6)) break;
        order[count] = std::uint64_t{detail::direction_cell(ray.direction)} << 16U | count;
      }
      const auto cell = [&](std::size_t k) noexcept { return order[k] >> 16U; };
      std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
      for (std::size_t from = 0, to = 0; from < count; from = to) {
        while (to < count && to - from < most && cell(to) == cell(from)) ++to;
        if (to - from >= least) {
          const auto alike = std::span(order).subspan(from, to - from);
          detail::trace_bundle(target, rays.subspan(first), alike, hits.subspan(first));
        } else {
          for (std::size_t k = from; k < to; ++k) {
            const std::size_t number = first + (order[k] & 0xFFFF);
            hits[number] = target.closest_hit(rays[number]);
          }
        }
      }
      first += count;
      if (count == 0) {  // a ray of NaN
        hits[first] = target.closest_hit(rays[first]);
        ++first;
      }
    }
  }
  for (; first < rays.size(); ++first) hits[first] = target.closest_hit(rays[first]);
}

}  // namespace PULSECAST_NAMESPACE

#endif
