// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_PART_MOTION_HPP
#define PULSECAST_HELIOS_DETAIL_PART_MOTION_HPP

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/base/error.hpp>
#include <pulsecast/helios/detail/motion.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/scene/moving_scene.hpp>

namespace PULSECAST_NAMESPACE::helios::detail {

/// Motion at constant rates that equals all motions of a sequence, once per `step` [s].
[[nodiscard]] inline SteadyMotion steady_of(const PartSettings& part, const MotionSequenceSettings& sequence,
                                            const Vec3& scene_centre, double step) {
  if (const std::string problem = motion_problem(sequence); !problem.empty())
    throw SettingError("part '" + part.id + "', dmotion '" + sequence.id + "': motions (number)",
                       static_cast<double>(sequence.motions.size()), "", problem);
  const MotionSteps steps = motion_steps(sequence, scene_centre);
  const auto all = steps.all.value_or(MotionStep{}).settled();
  if (!steps.own) return steady_motion(all, step);
  const auto own = steps.own->settled();
  const SteadyMotion turn = steady_motion({own.rotation, {}}, step);
  return {.velocity = (own.position + all.position) / step, .axis = turn.axis, .angular_rate = turn.angular_rate};
}

/// Motion of a part that has at least one sequence, with a step in each `step` [s]. Throws a `SettingError` with part
/// and sequence.
[[nodiscard]] inline std::shared_ptr<const PartMotion> part_motion(const PartSettings& part, const Vec3& scene_centre,
                                                                   double step) {
  std::vector<MotionSequence> sequences;
  std::optional<std::size_t> again;
  std::map<std::string, std::size_t> seen;
  for (const MotionSequenceSettings* s = &part.motions.front(); s != nullptr;) {
    seen.emplace(s->id, sequences.size());
    SteadyMotion steady = steady_of(part, *s, scene_centre, step);
    if (s->loop > 0) steady.duration = step * s->loop;
    sequences.push_back({.motions = {steady}});
    if (s->loop == 0 || !s->next) break;
    const auto next =
        std::find_if(part.motions.begin(), part.motions.end(), [&](const auto& m) { return m.id == *s->next; });
    if (next == part.motions.end()) break;
    if (const auto back = seen.find(next->id); back != seen.end()) {
      again = back->second;
      break;
    }
    s = &*next;
  }
  return std::make_shared<const PartMotion>(sequences, again);
}

}  // namespace PULSECAST_NAMESPACE::helios::detail

#endif
