// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_RUN_BATCH_HPP
#define PULSECAST_SCENE_RUN_BATCH_HPP

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/scene/closest_hits.hpp>

namespace PULSECAST_NAMESPACE {

/// Rays of a sensor in its own frame, one for each slot of a source: from the pulse's origin along
/// its direction, at its tick. That of a blocked slot has a `far` of 0: it meets nothing.
template <InstrumentSource Sensor>
[[nodiscard]] std::vector<Ray> sensor_rays(const Sensor& sensor) {
  std::vector<Ray> rays(static_cast<std::size_t>(sensor.size()));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (const auto pulse = sensor.pulse(i))
      rays[i] = {
          .origin = pulse->pose.position, .direction = pulse->pose.direction(axis::forward), .tick = pulse->tick};
    else
      rays[i].far = 0;
  }
  return rays;
}

namespace detail {
/// Ranges as of the public `run_batch`, at pose p in the map `target_at(p)`.
template <class Target>
void run_batch(const auto& target_at, std::span<const Pose<frame::Instrument, frame::World>> poses,
               std::span<const Ray> rays, std::span<float> ranges, const Workers& workers) {
  const std::size_t asked = poses.size() * rays.size();
  require_within("run_batch: ranges (number)", ranges.size(), asked, asked, "");
  for (std::size_t p = 0; p < poses.size(); ++p)
    if (!poses[p].rigid())
      throw SettingError("run_batch: pose " + std::to_string(p) + " (length of its quaternion)",
                         length(poses[p].rotation), "", "1, with a finite position");
  constexpr std::size_t block = 512;  // rays of a task: a tenth of a millisecond
  for_each_index((ranges.size() + block - 1) / block, workers, [&](std::size_t b) {
    alignas(Ray) std::array<std::byte, block * sizeof(Ray)> memory;  // of rays that are not set twice
    Ray* const in_world = reinterpret_cast<Ray*>(memory.data());
    std::array<ClosestHitOf<Target>, block> hits;
    const std::size_t end = std::min(ranges.size(), (b + 1) * block);
    for (std::size_t first = b * block, p = first / rays.size(); first < end; ++p) {
      const Matrix3 turn = matrix_of(poses[p].rotation);
      const std::size_t count = std::min(end, (p + 1) * rays.size()) - first;
      for (std::size_t j = 0; j < count; ++j) {
        Ray& ray = *std::construct_at(in_world + j, rays[first + j - p * rays.size()]);
        ray.origin = turn * ray.origin + poses[p].position;
        ray.direction = turn * ray.direction;
        ray.pulse = first + j;
      }
      closest_hits<Target>(target_at(p), std::span<const Ray>(in_world, count), hits);
      for (std::size_t j = 0; j < count; ++j)
        ranges[first + j] = static_cast<float>(hits[j] ? hits[j]->range : infinity);
      first += count;
    }
  });
}
}  // namespace detail

/// Ranges that equal sensors at many poses measure in one map [m], without echoes, noise or energy:
/// for learning and planning. The range of ray j at pose p is `ranges[p * rays.size() + j]`, in
/// single precision (6e-8 relative); infinite without a hit. `rays` are in the sensor's frame;
/// their `pulse` becomes that index, with `seed` the key of leaves met at random. The ranges do not
/// depend on the number of threads. Allocates nothing.
/// @throws SettingError if `ranges` has another size, or for a pose that is not rigid
template <class Target>
requires(RayTarget<Target> ||
         SceneQueries<Target>) void run_batch(const Target& target,
                                              std::span<const Pose<frame::Instrument, frame::World>> poses,
                                              std::span<const Ray> rays, std::span<float> ranges,
                                              const Workers& workers = {}) {
  const auto target_at = [&](std::size_t) noexcept -> const Target& { return target; };
  detail::run_batch<Target>(target_at, poses, rays, ranges, workers);
}

/// As above, in several maps: that at pose p is `targets[target_of[p]]`. Scenes made by
/// `with_placements`, `with_parts` or `without` share their geometry, and so do those that a
/// `Layered` refers to. @throws SettingError as above, for another number of indices than poses, or
/// an index beyond the maps
template <class Target>
requires(RayTarget<Target> ||
         SceneQueries<Target>) void run_batch(std::span<const Target> targets, std::span<const std::uint32_t> target_of,
                                              std::span<const Pose<frame::Instrument, frame::World>> poses,
                                              std::span<const Ray> rays, std::span<float> ranges,
                                              const Workers& workers = {}) {
  require_within("run_batch: indices of targets (number)", target_of.size(), poses.size(), poses.size(), "");
  for (std::size_t p = 0; p < poses.size(); ++p)
    if (target_of[p] >= targets.size())
      throw SettingError("run_batch: index of the target of pose " + std::to_string(p), target_of[p], "",
                         "less than the number of targets, " + std::to_string(targets.size()));
  const auto target_at = [&](std::size_t p) noexcept -> const Target& { return targets[target_of[p]]; };
  detail::run_batch<Target>(target_at, poses, rays, ranges, workers);
}

}  // namespace PULSECAST_NAMESPACE

#endif
