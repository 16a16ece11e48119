// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_RUN_BATCH_HPP
#define PULSECAST_SCENE_RUN_BATCH_HPP

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <pulsecast/base/frame.hpp>
#include <pulsecast/base/parallel.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/geometry/ray.hpp>

namespace pulsecast {

/// World that gives the range of a ray's closest hit, as `Scene` and `MovingScene` do.
template <class World>
concept GivesRanges = requires(const World world, const Ray& ray) {
  { world.closest_hit(ray)->range }
  noexcept->std::convertible_to<double>;
};

/// Rays of a sensor in its own frame, one for each slot of a source: from the pulse's origin along its direction, at its tick. A blocked
/// slot has a ray whose `far` is 0, which meets nothing.
template <InstrumentSource Sensor>
[[nodiscard]] std::vector<Ray> sensor_rays(const Sensor& sensor) {
  std::vector<Ray> rays(static_cast<std::size_t>(sensor.size()));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (const auto pulse = sensor.pulse(i))
      rays[i] = {.origin = pulse->pose.position, .direction = pulse->pose.direction(axis::forward), .tick = pulse->tick};
    else
      rays[i].far = 0;
  }
  return rays;
}

/// Ranges that equal sensors at many poses measure in one world [m], without echoes, noise or energy: for learning and planning. The range
/// of ray j at pose p is `ranges[p * rays.size() + j]`, in single precision (6e-8 relative); infinite without a hit. `rays` are in the
/// sensor's frame. A ray's `pulse` is replaced by that index: together with its `seed`, it is the key of leaves that are met at random.
/// The ranges do not depend on the number of threads. Allocates nothing.
/// @throws SettingError if `ranges` has another size, or for a pose that is not rigid
template <GivesRanges World>
void run_batch(const World& world, std::span<const Pose<frame::Instrument, frame::World>> poses, std::span<const Ray> rays,
               std::span<float> ranges, const Workers& workers = {}) {
  const double asked = static_cast<double>(poses.size()) * static_cast<double>(rays.size());
  require_within("run_batch: ranges (number)", static_cast<double>(ranges.size()), asked, asked, "");
  for (std::size_t p = 0; p < poses.size(); ++p)
    if (!poses[p].rigid())
      throw SettingError("run_batch: pose " + std::to_string(p) + " (length of its quaternion)", length(poses[p].rotation), "",
                         "1, with a finite position");
  constexpr std::size_t block = 4096;  // rays of a task: a fraction of a millisecond
  const std::size_t blocks = (ranges.size() + block - 1) / block;
  for_each_index(blocks, workers, [&](std::size_t b) {
    const std::size_t end = std::min(ranges.size(), (b + 1) * block);
    for (std::size_t k = b * block; k < end;) {
      const std::size_t p = k / rays.size();
      const Matrix3 turn = matrix_of(poses[p].rotation);
      for (const Ray& in_sensor : rays.subspan(k % rays.size(), std::min(end - k, (p + 1) * rays.size() - k))) {
        Ray ray = in_sensor;
        ray.origin = turn * in_sensor.origin + poses[p].position;
        ray.direction = turn * in_sensor.direction;
        ray.pulse = k;
        const auto hit = world.closest_hit(ray);
        ranges[k++] = hit ? static_cast<float>(hit->range) : std::numeric_limits<float>::infinity();
      }
    }
  });
}

}  // namespace pulsecast

#endif
