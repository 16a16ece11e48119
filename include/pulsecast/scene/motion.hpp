// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_MOTION_HPP
#define PULSECAST_SCENE_MOTION_HPP

#include <pulsecast/scene/detail/motion_sweep.hpp>

namespace PULSECAST_NAMESPACE {

/// Rigid motion at constant rates in the world: a velocity, and a rotation about an axis through a
/// centre that moves along: a helix if the velocity is along the axis; rest if both are zero.
struct SteadyMotion {
  Vec3 velocity{};                     ///< [m/s]
  Vec3 axis = axis::up;                ///< direction, of any non-zero length
  double angular_rate = 0;             ///< right-handed about the axis [rad/s]
  std::optional<Vec3> centre{};        ///< point of the axis at the start, in the world; empty: own centre [m]
  std::optional<Vec3> spin{};          ///< angular velocity, if not the orbit's: 0 for a Ferris wheel's cabin [rad/s]
  double duration = detail::infinity;  ///< at least 1e-6 [s]

  void validate() const {
    require_finite("SteadyMotion::velocity (length)", length(velocity), "m/s");
    require_positive("SteadyMotion::axis (length)", length(axis), "");
    require_finite("SteadyMotion::angular_rate", angular_rate, "rad/s");
    if (centre) require_finite("SteadyMotion::centre (length)", length(*centre), "m");
    if (spin) require_finite("SteadyMotion::spin (length)", length(*spin), "rad/s");
    if (!(duration >= 1e-6)) throw SettingError("SteadyMotion::duration", duration, "s", "at least 1e-6");
  }
};

/// Motions in succession, repeated `times` times. Each begins at the end of the one before.
struct MotionSequence {
  std::vector<SteadyMotion> motions{};  ///< motions in succession; at least one
  std::uint64_t times = 1;              ///< number of repetitions, from 1 to 1e15
};

/// Behaviour of a body after the last of its timed poses.
enum class AfterLastPose : std::uint8_t {
  rest,         ///< stays at the last pose
  start_again,  ///< jumps to its pose at the start of the survey and repeats from there
};

/// Displacement of a body: rotation about a point near it, to lose no digits, then a shift.
struct Displacement {
  Rotation rotation = no_rotation;  ///< unit quaternion
  Vec3 about{};                     ///< [m]
  Vec3 shift{};                     ///< [m]

  /// Displaced point [m].
  [[nodiscard]] Vec3 point(const Vec3& p) const noexcept { return about + shift + rotation * (p - about); }
};

/// Steady motion that takes every point p of the world to `position + rotation * p` in `seconds`
/// [s]: a screw, the shorter way around. Source: Chasles 1830; its centre: Bottema & Roth 1979,
/// Theoretical Kinematics, ch. III.
/// @throws SettingError unless `seconds` is positive, the position [m] finite and the rotation unit
[[nodiscard]] inline SteadyMotion steady_motion(const Pose<frame::World, frame::World>& step, double seconds) {
  require_positive("steady_motion (seconds)", seconds, "s");
  require_rotation("steady_motion (rotation)", step.rotation);
  require_finite("steady_motion (position, length)", length(step.position), "m");
  const detail::RotationParts turn(step.rotation);  // accepts any norm
  if (turn.angle == 0) return {.velocity = step.position / seconds};
  const Vec3 along = dot(step.position, turn.axis) * turn.axis, across = step.position - along;
  return {.velocity = along / seconds,
          .axis = turn.axis,
          .angular_rate = turn.angle / seconds,
          .centre = 0.5 * (across + cross(turn.axis, across) / std::tan(turn.angle / 2))};
}

/// Motion of a part: rigid, in closed form over time, on top of its placement. Times count from the
/// start of the survey; before, it is as placed. Its own centre, of its box, moves along.
class PartMotion {
 public:
  /// Follows one motion, then rests at its end. @throws SettingError for values out of range
  explicit PartMotion(const SteadyMotion& motion) : PartMotion(std::vector<MotionSequence>{{.motions = {motion}}}) {}

  /// Follows sequences in succession, then rests; or repeats them for ever from index `again_from`
  /// on. Only the very last motion may be infinite. @throws SettingError for values out of range
  explicit PartMotion(const std::vector<MotionSequence>& sequences,
                      std::optional<std::size_t> again_from = std::nullopt) {
    if (sequences.empty()) throw SettingError("PartMotion::sequences (number)", 0, "", "at least 1");
    if (again_from)
      require_within("PartMotion::again_from", static_cast<double>(*again_from), 0,
                     static_cast<double>(sequences.size()) - 1, "");
    for (std::size_t i = sequences.size(); i-- > 0;)
      for (const SteadyMotion& m : sequences[i].motions)
        if (m.centre) reference_ = *m.centre;
    SoFar so_far;
    for (std::size_t i = 0; i < sequences.size(); ++i) {
      if (again_from == i) begin_cycle(so_far);
      const bool last = i + 1 == sequences.size() && !again_from;
      add(sequences[i], "PartMotion::sequences[" + std::to_string(i) + "]", last, so_far);
    }
    again_from ? end_cycle(so_far.time, so_far.change) : end(so_far);
  }

  /// Interpolates timed poses: linear positions, and rotation at a constant rate about one axis,
  /// the shorter way. Before the first the body rests there. A pose applies on top of the
  /// placement: rotation about the world's origin, then a shift by `position`.
  /// @throws SettingError for values out of range, or times that do not ascend
  explicit PartMotion(const std::vector<TimedPose>& poses, AfterLastPose after = AfterLastPose::rest)
      : from_origin_(true) {
    if (poses.empty()) throw SettingError("PartMotion::poses (number)", 0, "", "at least 1");
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::string field = "PartMotion::poses[" + std::to_string(i) + "]";
      const auto& [time, position, rotation] = poses[i];
      require_within(field + ".time", time, 0, 1e15, "s");
      if (i > 0 && !(time > poses[i - 1].time))
        throw SettingError(field + ".time", time, "s",
                           "greater than that of the previous pose, " + text::to_text(poses[i - 1].time));
      require_finite(field + ".position (length)", length(position), "m");
      require_rotation(field + ".rotation", rotation);
    }
    const bool again = after == AfterLastPose::start_again;
    const TimedPose &first = poses.front(), &last = poses.back();
    if (again) require_within("PartMotion::poses (time of the last)", last.time, 1e-6, 1e15, "s");
    if (first.time > 0) add_way({0, first.position, first.rotation}, first);
    for (std::size_t i = 1; i < poses.size(); ++i) add_way(poses[i - 1], poses[i]);
    const Tick time = Tick::of_seconds(last.time);
    const Change change{normalize(last.rotation), {no_rotation, last.position}};
    again ? end_cycle(time, {}) : end({time, change});  // each cycle begins with no change
  }

  explicit PartMotion(DeserializeTag) {}
  template <class Archive>
  void archive(Archive& a) {
    detail::MotionTimeline& t = timeline_;
    a(t.runs, t.pieces, t.cycle_first, t.cycle_start, t.cycle_before, t.cycle, t.cycle_duration, reference_,
      from_origin_);
  }
  [[nodiscard]] bool is_consistent() const noexcept { return timeline_.is_consistent(); }

  [[nodiscard]] std::size_t memory() const noexcept { return sizeof(*this) + timeline_.heap_bytes(); }

  /// Displacement at a time of a body with its own centre placed at `own_centre` [m].
  [[nodiscard]] Displacement at(const Tick& tick, const Vec3& own_centre) const noexcept {
    const Vec3 centre = from_origin_ ? Vec3{} : own_centre, start = centre - reference_;
    const detail::BodyState state = state_at(timeline_.place_of(tick), start);
    return {state.attitude, centre, state.centre - start};
  }

  /// Velocity at a time of a point of the body [m/s], which is at `point` in the world at that time
  /// [m]. Zero before the start; at a change of motion that of the later one.
  [[nodiscard]] Vec3 velocity(const Tick& tick, const Vec3& own_centre, const Vec3& point) const noexcept {
    if (tick < Tick{}) return {};
    const Vec3 start = (from_origin_ ? Vec3{} : own_centre) - reference_;
    const detail::MotionPlace place = timeline_.place_of(tick);
    const Vec3 centre = detail::state_at(place, start).centre;
    const detail::Turning& turning = place.piece->attitude;
    const Vec3 by_turning = turning.angular_rate * cross(turning.axis, point - reference_ - centre);
    return detail::velocity_at(place, centre) + by_turning;
  }

  /// Box that holds all points passed by a box between two times [m], of a part. Tight for small
  /// rotations and few changes of motion, loose otherwise. Empty for an empty box.
  [[nodiscard]] Box swept(const Box& box, const Placement& placement, const Tick& from, const Tick& to) const noexcept {
    if (box.empty()) return {};
    const Vec3 middle = placement.point(box.centre()), centre = from_origin_ ? Vec3{} : middle;
    const detail::SweptBody body{centre - reference_, middle - centre, placement.rotation,
                                 0.5 * placement.scale * box.size()};
    Box swept = detail::swept_box(timeline_, body, from, to);
    swept.min = swept.min + reference_;
    swept.max = swept.max + reference_;
    const double reach = max_norm(swept.min) + max_norm(swept.max);
    return detail::grown(swept, 1e-12 * reach + 1e-7 * body.radius());  // above rounding
  }

 private:
  using Change = detail::Change;

  /// State of the construction, since the start or since that of the cycle.
  struct SoFar {
    Tick time{};
    Change change{};
    bool endless = false;
  };

  void begin_cycle(SoFar& so_far) {
    timeline_.cycle_first = timeline_.runs.size();
    timeline_.cycle_start = so_far.time;
    timeline_.cycle_before = so_far.change;
    so_far = {};
  }

  void add(const MotionSequence& sequence, const std::string& field, bool last, SoFar& so_far) {
    if (sequence.motions.empty()) throw SettingError(field + ".motions (number)", 0, "", "at least 1");
    require_within(field + ".times", sequence.times, 1, 1e15, "");
    const auto times = static_cast<std::int64_t>(sequence.times);
    detail::MotionRun run{so_far.change, so_far.time, {}, 0, times, timeline_.pieces.size(), 0};
    for (std::size_t k = 0; k < sequence.motions.size(); ++k) {
      const SteadyMotion& m = sequence.motions[k];
      m.validate();
      const bool may_be_infinite = last && k + 1 == sequence.motions.size() && sequence.times == 1;
      const std::string name = field + ".motions[" + std::to_string(k) + "].duration";
      if (!may_be_infinite) require_within(name, m.duration, 1e-6, 1e15, "s");
      const detail::Turning orbit{normalize(m.axis), m.angular_rate};
      detail::Turning attitude = m.spin ? detail::Turning{} : orbit;
      if (m.spin && length(*m.spin) > 0) attitude = {normalize(*m.spin), length(*m.spin)};
      timeline_.pieces.push_back({.before = run.pass,
                                  .velocity = m.velocity,
                                  .orbit = orbit,
                                  .centre = m.centre ? *m.centre - reference_ : Vec3{},
                                  .about_itself = !m.centre,
                                  .spins = m.centre && m.spin,
                                  .attitude = attitude,
                                  .start = run.pass_duration,
                                  .duration = m.duration});
      run.pass_duration += m.duration;
      if (!std::isfinite(m.duration)) continue;
      run.pass = detail::then(run.pass, change(timeline_.pieces.back(), Tick::of_seconds(m.duration)));
    }
    run.pass = rounded(run.pass);
    run.end = timeline_.pieces.size();
    timeline_.runs.push_back(run);
    if (!std::isfinite(run.pass_duration)) return void(so_far.endless = true);
    const double duration = run.pass_duration * static_cast<double>(run.times);
    require_within(field + " (duration)", duration, 0, 1e15, "s");
    so_far.time = so_far.time + Tick::of_seconds(duration);
    so_far.change = rounded(detail::then(so_far.change, detail::repeated(run.pass, run.times)));
  }

  static Change rounded(const Change& c) noexcept {
    return {detail::unless_rounding(c.attitude), {detail::unless_rounding(c.path.turn), c.path.shift}};
  }

  /// Adds a piece known from its two poses alone, so that errors do not accumulate.
  void add_way(const TimedPose& from, const TimedPose& to) {
    if (timeline_.runs.empty()) timeline_.runs.push_back({{}, {}, {}, 0, 1, 0, 0});
    detail::MotionRun& run = timeline_.runs.back();
    const double duration = to.time - from.time;
    const Rotation a = normalize(from.rotation);
    const detail::RotationParts turn(normalize(to.rotation) * conjugate(a));
    timeline_.pieces.push_back({.before = {a, {no_rotation, from.position}},
                                .velocity = (to.position - from.position) / duration,
                                .attitude = {turn.axis, turn.angle / duration},
                                .start = run.pass_duration,
                                .duration = duration});
    run.pass_duration = to.time;
    run.end = timeline_.pieces.size();
  }

  void end_cycle(const Tick& duration, const Change& change) {
    timeline_.cycle_duration = duration.seconds();
    timeline_.cycle = change;
    timeline_.shrink_to_fit();
  }

  void end(const SoFar& so_far) {
    if (!so_far.endless) {
      const std::size_t rest = timeline_.pieces.size();
      timeline_.pieces.emplace_back();
      timeline_.runs.push_back({so_far.change, so_far.time, {}, detail::infinity, 1, rest, rest + 1});
    }
    timeline_.cycle_first = timeline_.runs.size();
    timeline_.shrink_to_fit();
  }

  detail::MotionTimeline timeline_;
  Vec3 reference_{};          ///< origin of the paths, near the motion [m]
  bool from_origin_ = false;  ///< true for timed poses, about the world's origin
};

}  // namespace PULSECAST_NAMESPACE

#endif
