// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_MOTION_HPP
#define PULSECAST_HELIOS_DETAIL_MOTION_HPP

#include <map>

#include <pulsecast/helios/settings.hpp>
#include <pulsecast/scene/moving_scene.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Proper or improper rigid motion: each point p goes to `position + sign * rotation * p`.
struct MotionStep {
  Pose<frame::World, frame::World> move{};
  double sign = 1;
  int mirrors = 0;  ///< number of reflections in it

  [[nodiscard]] MotionStep after(const MotionStep& first) const {
    const auto& [rotation, position] = first.move;
    return {{move.rotation * rotation, move.position + sign * (move.rotation * position)},
            sign * first.sign,
            mirrors + first.mirrors};
  }

  /// Pose without the rounding errors of reflections that cancel.
  [[nodiscard]] Pose<frame::World, frame::World> settled() const {
    const auto& [rotation, position] = move;
    const bool turns = mirrors == 0 || length(Vec3{rotation.x, rotation.y, rotation.z}) > 1e-14;
    return {turns ? rotation : no_rotation, position};
  }
};

/// Converts a motion. Coordinates are relative to the scene's centre, unless `shift_factor` is 1.
[[nodiscard]] inline MotionStep motion_step(const MotionSettings& m, const Vec3& scene_centre) {
  MotionStep out;
  Vec3 centre = m.about_itself ? Vec3{} : (1 - m.shift_factor) * scene_centre, shift{};
  const auto about = [&](const std::optional<Vec3>& point) {
    if (!m.about_itself) centre += point.value_or(Vec3{});
  };
  if (const auto* t = std::get_if<TranslationMotion>(&m.kind)) {
    shift = t->by;
  } else if (const auto* r = std::get_if<RotationMotion>(&m.kind)) {
    about(r->center);
    out.move.rotation = rotation_about(r->axis, r->angle);
    shift = r->glide.value_or(0) * r->axis;
  } else if (const auto* f = std::get_if<ReflectionMotion>(&m.kind)) {
    out = {{rotation_about(f->normal, pi), {}}, -1, 1};  // half a turn and a point reflection
    shift = f->shift.value_or(Vec3{});
  } else if (const auto* s = std::get_if<RotoreflectionMotion>(&m.kind)) {
    about(s->center);
    out = {{rotation_about(s->axis, s->angle + pi), {}}, -1, 1};
  }
  out.move.position = centre - out.sign * (out.move.rotation * centre) + shift;
  return out;
}

/// Composition of the motions of a sequence, in their order.
struct MotionSteps {
  std::optional<MotionStep> all{};  ///< motions in the frame of the scene
  std::optional<MotionStep> own{};  ///< motions of a part about itself
};

[[nodiscard]] inline MotionSteps motion_steps(const MotionSequenceSettings& sequence, const Vec3& scene_centre) {
  MotionSteps out;
  for (const MotionSettings& m : sequence.motions) {
    std::optional<MotionStep>& steps = m.about_itself ? out.own : out.all;
    steps = motion_step(m, scene_centre).after(steps.value_or(MotionStep{}));
  }
  return out;
}

/// Expectation that a sequence fails, for a message; empty if the motion is possible.
[[nodiscard]] inline std::string motion_problem(const MotionSequenceSettings& sequence) {
  const MotionSteps steps = motion_steps(sequence, {});
  for (const auto& s : {steps.all, steps.own})
    if (s && s->sign < 0) return "an even number of reflections, since an odd number is no rigid motion";
  const Rotation turn = steps.all.value_or(MotionStep{}).settled().rotation;
  if (steps.own && turn != no_rotation && std::isfinite(length(turn)))  // else reported
    return "rotations about a point or about its own centre, not both in one sequence";
  return "";
}

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

/// Motion of a part, with a step in each `step` [s]. @throws SettingError with part and sequence
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
    const auto next = std::ranges::find(part.motions, *s->next, &MotionSequenceSettings::id);
    if (next == part.motions.end()) break;
    if (const auto back = seen.find(next->id); back != seen.end()) {
      again = back->second;
      break;
    }
    s = &*next;
  }
  return std::make_shared<const PartMotion>(sequences, again);
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
