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

/// Rays of one origin and the same limits in groups of about one direction, each in ascending order.
class DirectionGroups {
 public:
  static constexpr std::size_t capacity = 512;  ///< greatest number of rays
  static constexpr std::size_t most = 32;       ///< greatest number of rays of a group
  using Group = std::array<std::uint16_t, most>;

  void push_back(const Vec3& direction) noexcept { cells_[size_++] = direction_cell(direction); }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  /// To be called once all rays are there.
  void link() noexcept {
    chains_.fill(none);
    for (std::size_t k = size_; k-- > 0;) {
      std::uint16_t& first = chains_[cells_[k] * 0x9E3779B1U >> 22U];  // golden ratio: Knuth 1998, 6.4
      next_[k] = std::exchange(first, static_cast<std::uint16_t>(k));
    }
  }

  /// Takes ray k and those after it that are like it. Returns their number, 0 if it is taken.
  [[nodiscard]] std::size_t take(std::size_t k, Group& group) noexcept {
    const std::uint32_t cell = cells_[k];
    std::size_t count = 0;
    for (std::size_t j = k; cell != taken && j != none && count < most; j = next_[j]) {
      if (cells_[j] != cell) continue;
      cells_[j] = taken;
      group[count++] = static_cast<std::uint16_t>(j);
    }
    return count;
  }

 private:
  static constexpr std::uint16_t none = 0xFFFF;
  static constexpr std::uint32_t taken = 0xFFFFFFFF;

  std::array<std::uint32_t, capacity> cells_;
  std::array<std::uint16_t, capacity> next_;  ///< next ray in a chain
  std::array<std::uint16_t, 1024> chains_;    ///< first ray of each hash of cells
  std::size_t size_ = 0;
};

/// Closest hits of rays of one origin and the same limits, some of which are named by `numbers`.
template <TracesBundles Scene>
void trace_bundle(const Scene& scene, std::span<const Ray> rays, std::span<const std::uint16_t> numbers,
                  std::span<std::optional<RayHit>> hits) noexcept {
  RayBundle bundle = bundle_of(rays[numbers[0]]);
  bundle.size = numbers.size();
  for (std::size_t j = 0; j < bundle.size; ++j) bundle.set_direction(j, rays[numbers[j]].direction);
  bundle.pad();
  ClosestHits nearest(bundle);
  scene.closest(bundle, nearest);
  for (std::size_t j = 0; j < bundle.size; ++j) {
    std::optional<RayHit>& hit = hits[numbers[j]] = std::nullopt;
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
    constexpr std::size_t least = 6;  // rays of a bundle; fewer cost less alone
    while (target.deterministic() && first < rays.size()) {
      const Ray& one = rays[first];
      detail::DirectionGroups groups;
      for (const Ray& ray : rays.subspan(first, std::min(groups.capacity, rays.size() - first))) {
        const bool like = ray.origin == one.origin && ray.near == one.near && ray.far == one.far;
        const bool together = like && (!Target::time_dependent || ray.tick == one.tick);
        if (!together || !(std::fabs(dot(ray.direction, ray.direction) - 1) < 1e-6)) break;
        groups.push_back(ray.direction);
      }
      const std::size_t end = first + std::max<std::size_t>(groups.size(), 1);  // 0 for a ray of NaN
      if (groups.size() < least) {
        for (; first < end; ++first) hits[first] = target.closest_hit(rays[first]);
        continue;
      }
      groups.link();
      detail::DirectionGroups::Group group;
      for (std::size_t k = 0; first + k < end; ++k) {
        const auto alike = std::span(group).first(groups.take(k, group));
        if (alike.size() >= least)
          detail::trace_bundle(target, rays.subspan(first), alike, hits.subspan(first));
        else
          for (const std::size_t j : alike) hits[first + j] = target.closest_hit(rays[first + j]);
      }
      first = end;
    }
  }
  for (; first < rays.size(); ++first) hits[first] = target.closest_hit(rays[first]);
}

}  // namespace PULSECAST_NAMESPACE

#endif
