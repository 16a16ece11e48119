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
  const std::size_t asked = poses.size() * rays.size();
  require_within("run_batch: ranges (number)", ranges.size(), asked, asked, "");
  for (std::size_t p = 0; p < poses.size(); ++p)
    if (!poses[p].rigid())
      throw SettingError("run_batch: pose " + std::to_string(p) + " (length of its quaternion)",
                         length(poses[p].rotation), "", "1, with a finite position");
  constexpr std::size_t block = 512;  // rays of a task: a tenth of a millisecond
  for_each_index((ranges.size() + block - 1) / block, workers, [&](std::size_t b) {
    std::array<Ray, block> asked_rays;
    std::array<ClosestHitOf<Target>, block> hits;
    const std::size_t first = b * block, count = std::min(ranges.size() - first, block);
    for (std::size_t k = first; k < first + count;) {
      const std::size_t p = k / rays.size();
      const Matrix3 turn = matrix_of(poses[p].rotation);
      for (const Ray& in_sensor :
           rays.subspan(k % rays.size(), std::min(first + count - k, (p + 1) * rays.size() - k))) {
        Ray& ray = asked_rays[k - first] = in_sensor;
        ray.origin = turn * in_sensor.origin + poses[p].position;
        ray.direction = turn * in_sensor.direction;
        ray.pulse = k++;
      }
    }
    closest_hits<Target>(target, std::span(asked_rays).first(count), hits);
    for (std::size_t j = 0; j < count; ++j)
      ranges[first + j] = static_cast<float>(hits[j] ? hits[j]->range : detail::infinity);
  });
}

}  // namespace PULSECAST_NAMESPACE

#endif
