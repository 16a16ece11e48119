// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <pulsecast/base/frame.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/base/tick.hpp>
#include <pulsecast/base/unit_rotation.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/scene/part.hpp>
#include <pulsecast/scene/screw.hpp>

namespace pulsecast {

/// Rigid motion at constant rates in the world: a velocity, and a rotation about an axis through a centre that moves along. A helix if the
/// velocity is along the axis; rest if both are zero.
struct SteadyMotion {
  Vec3 velocity{};               ///< [m/s]
  Vec3 axis = axis::up;          ///< direction, of any non-zero length
  double rate = 0;               ///< right-handed about the axis [rad/s]
  std::optional<Vec3> centre{};  ///< point of the axis in the world at the motion's start [m]; empty for the body's own centre
  std::optional<Vec3> spin{};    ///< angular velocity in the world, if not the orbit's: zero for a Ferris wheel's cabin [rad/s]
  double duration = std::numeric_limits<double>::infinity();  ///< at least 1e-6 [s]

  void validate() const {
    require_finite("SteadyMotion::velocity (length)", length(velocity), "m/s");
    require_positive("SteadyMotion::axis (length)", length(axis), "");
    require_finite("SteadyMotion::rate", rate, "rad/s");
    if (centre) require_finite("SteadyMotion::centre (length)", length(*centre), "m");
    if (spin) require_finite("SteadyMotion::spin (length)", length(*spin), "rad/s");
    if (!(duration >= 1e-6)) throw SettingError("SteadyMotion::duration", duration, "s", "at least 1e-6");
  }
};

/// Motions in succession, all of them repeated `times` times. Each begins at the end of the one before.
struct MotionSequence {
  std::vector<SteadyMotion> motions{};  ///< motions in succession; at least one
  std::uint64_t times = 1;              ///< number of repetitions, from 1 to 1e15
};

/// Behaviour of a body after the last of its timed poses.
enum class AfterLastPose : std::uint8_t {
  rest,         ///< stays at the last pose
  start_again,  ///< jumps to its pose at the start of the survey and repeats from there
};

/// Displacement of a body: rotation about a point, then a shift. The point is near the body, so that no digits are lost far from the
/// world's origin.
struct Displacement {
  Rotation rotation = no_rotation;  ///< unit quaternion
  Vec3 about{};                     ///< [m]
  Vec3 shift{};                     ///< [m]

  /// Displaced point [m].
  [[nodiscard]] Vec3 point(const Vec3& p) const noexcept { return about + shift + rotation * (p - about); }
};

namespace detail {

/// Accumulated change of a body: its rotation, and the rigid motion of its own centre. The two differ after rotation about its own centre.
struct Change {
  Rotation attitude = no_rotation;
  Screw path{};
};

[[nodiscard]] inline Change then(const Change& first, const Change& second) noexcept {
  if (first.attitude == no_rotation && first.path.turn == no_rotation && first.path.shift == Vec3{}) return second;
  return {normalize(second.attitude * first.attitude), then(first.path, second.path)};
}

[[nodiscard]] inline Change repeated(const Change& once, std::int64_t n) noexcept {
  return {repeated(Screw{once.attitude, {}}, n).turn, repeated(once.path, n)};
}

[[nodiscard]] inline Box grown(const Box& b, double by) noexcept { return {b.min - Vec3(by), b.max + Vec3(by)}; }

/// Greatest deviation of a point from uniform straight motion, while it turns by an angle [rad] at this distance from an axis in uniform
/// straight motion; in the unit of the distance.
/// Source: the error of linear interpolation, |f''| h^2 / 8 (Davis 1975, Interpolation and Approximation, ch. 3).
[[nodiscard]] inline double bulge(double distance, double angle) noexcept { return distance * angle * angle / 8; }

/// Angle beyond which the bound of a turning point is its whole sphere [rad]; affects only the size of boxes.
inline constexpr double wide_turn = 2;

}  // namespace detail

/// Steady motion that takes every point p of the world to `position + rotation * p` in `seconds` [s]: a screw, the shorter way around.
/// Source: Chasles 1830; the centre of a plane displacement, Bottema & Roth 1979, Theoretical Kinematics, ch. III.
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
          .rate = turn.angle / seconds,
          .centre = 0.5 * (across + cross(turn.axis, across) / std::tan(turn.angle / 2))};
}

/// Motion of a part of a scene: rigid, in closed form over time, on top of the part's placement. Times count from the start of the survey;
/// before it, the part is as placed. "Its own centre" is the centre of its box as placed, and moves along.
class PartMotion {
 public:
  /// Follows one motion, then rests at its end. @throws SettingError for values out of range
  explicit PartMotion(const SteadyMotion& motion) : PartMotion(std::vector<MotionSequence>{{.motions = {motion}}}) {}

  /// Follows sequences in succession, then rests; or repeats them for ever from index `again_from` on. Only the very last motion may be
  /// infinite. @throws SettingError for values out of range
  explicit PartMotion(const std::vector<MotionSequence>& sequences, std::optional<std::size_t> again_from = std::nullopt) {
    if (sequences.empty()) throw SettingError("PartMotion::sequences (number)", 0, "", "at least 1");
    if (again_from)
      require_within("PartMotion::again_from", static_cast<double>(*again_from), 0, static_cast<double>(sequences.size()) - 1, "");
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

  /// Interpolates timed poses: linear positions, and rotation at a constant rate about one axis, the shorter way. Before the first pose the
  /// body rests there. A pose applies on top of the placement: rotation about the world's origin, then a shift by `position`.
  /// @throws SettingError for values out of range, or times that do not ascend
  explicit PartMotion(const std::vector<TimedPose>& poses, AfterLastPose after = AfterLastPose::rest) : from_origin_(true) {
    if (poses.empty()) throw SettingError("PartMotion::poses (number)", 0, "", "at least 1");
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::string field = "PartMotion::poses[" + std::to_string(i) + "]";
      require_within(field + ".time", poses[i].time, 0, 1e15, "s");
      if (i > 0 && !(poses[i].time > poses[i - 1].time))
        throw SettingError(field + ".time", poses[i].time, "s",
                           "greater than that of the previous pose, " + detail::to_text(poses[i - 1].time));
      require_finite(field + ".position (length)", length(poses[i].position), "m");
      require_rotation(field + ".rotation", poses[i].rotation);
    }
    const bool again = after == AfterLastPose::start_again;
    if (again) require_within("PartMotion::poses (time of the last)", poses.back().time, 1e-6, 1e15, "s");
    if (poses.front().time > 0) add_way({0, poses.front().position, poses.front().rotation}, poses.front());
    for (std::size_t i = 1; i < poses.size(); ++i) add_way(poses[i - 1], poses[i]);
    const Tick time = Tick::of_seconds(poses.back().time);
    const Change last{normalize(poses.back().rotation), {no_rotation, poses.back().position}};
    again ? end_cycle(time, {}) : end({time, last});  // each cycle begins with no change
  }

  explicit PartMotion(DeserializeTag) {}
  template <class Archive>
  void archive(Archive& a) {
    a(runs_, pieces_, cycle_first_, cycle_start_, cycle_before_, cycle_, cycle_duration_, reference_, from_origin_);
  }
  [[nodiscard]] bool is_consistent() const noexcept {
    const auto has_pieces = [this](const Run& run) { return run.first < run.end && run.end <= pieces_.size() && run.times > 0; };
    return !runs_.empty() && cycle_first_ <= runs_.size() && std::all_of(runs_.begin(), runs_.end(), has_pieces);
  }

  /// Memory held [byte].
  [[nodiscard]] std::size_t memory() const noexcept {
    return sizeof(*this) + runs_.capacity() * sizeof(Run) + pieces_.capacity() * sizeof(Piece);
  }

  /// Displacement at a time of a body with its own centre placed at `own_centre` [m].
  [[nodiscard]] Displacement at(const Tick& tick, const Vec3& own_centre) const noexcept {
    const Vec3 centre = from_origin_ ? Vec3{} : own_centre, start = centre - reference_;
    const State state = state_at(place_of(tick), start);
    return {state.attitude, centre, state.centre - start};
  }

  /// Box that holds all points passed by the hull of the given points, as placed [m], between two times. Tight for small rotations and few
  /// changes of motion in this time, loose otherwise.
  [[nodiscard]] Box swept(std::span<const Vec3> points, const Vec3& own_centre, const Tick& from, const Tick& to) const noexcept {
    const Vec3 centre = from_origin_ ? Vec3{} : own_centre, start = centre - reference_;
    Box box;
    Tick tick = std::max(from, Tick{});
    int pieces = 0;
    for (; pieces < max_pieces; ++pieces) {
      const Place place = place_of(tick);
      const double rest = std::max(0.0, detail::since(tick, to).seconds());
      const double span = std::min(rest, std::max(0.0, place.piece->duration - place.time.seconds()));
      const Tick end = place.time + Tick::of_seconds(span);
      extend_by(box, points, centre, start, place, end, span);
      if (!(span < rest)) break;
      tick = tick + Tick::of_seconds(std::max(span, 1e-12));
    }
    double radius = 0;
    for (const Vec3& p : points) radius = std::max(radius, length(p - centre));
    if (pieces == max_pieces) box.extend(detail::grown(roughly(start, tick, to), radius));
    box.min = box.min + reference_, box.max = box.max + reference_;
    return detail::grown(box, 1e-12 * (max_norm(box.min) + max_norm(box.max)) + 1e-7 * radius);  // above rounding
  }

 private:
  static constexpr int max_pieces = 32;  ///< pieces bounded one by one in `swept`; affects only the size of the box

  using Change = detail::Change;
  using Screw = detail::Screw;

  /// Rotation at a constant rate.
  struct Turning {
    Vec3 axis = axis::up;  ///< unit
    double rate = 0;       ///< [rad/s]

    [[nodiscard]] Rotation until(const Tick& time) const noexcept {
      return rate == 0 ? no_rotation : rotation_about(axis, 2 * pi * time.phase(rate / (2 * pi)));
    }
  };

  /// Steady motion, or interpolation between two poses, in a run.
  struct Piece {
    Change before;             ///< since the start of the run
    Vec3 velocity{};           ///< [m/s]
    Turning orbit{};           ///< rotation of its own centre, unless about itself
    Vec3 centre{};             ///< centre of the orbit, relative to the reference [m]
    bool about_itself = true;  ///< true for rotation about its own centre, which moves straight
    bool spins = false;        ///< true for an attitude other than the orbit's
    Turning attitude{};
    double start = 0;                                           ///< since the start of the run [s]
    double duration = std::numeric_limits<double>::infinity();  ///< [s]
  };

  /// Pieces repeated `times` times.
  struct Run {
    Change before;           ///< since the start, or since that of the cycle
    Tick start;              ///< since the start, or since that of the cycle
    Change pass;             ///< change in one pass
    double pass_duration;    ///< [s]
    std::int64_t times;      ///< at least 1
    std::size_t first, end;  ///< its pieces
  };

  /// Piece at a time.
  struct Place {
    Change before;
    const Piece* piece;
    Tick time;  ///< since the start of the piece
  };

  struct State {
    Rotation attitude;
    Vec3 centre;  ///< relative to the reference [m]
  };

  /// State of the construction, since the start or since that of the cycle.
  struct SoFar {
    Tick time{};
    Change change{};
    bool endless = false;
  };

  void begin_cycle(SoFar& so_far) {
    cycle_first_ = runs_.size(), cycle_start_ = so_far.time, cycle_before_ = so_far.change;
    so_far = {};
  }

  void add(const MotionSequence& sequence, const std::string& field, bool last, SoFar& so_far) {
    if (sequence.motions.empty()) throw SettingError(field + ".motions (number)", 0, "", "at least 1");
    require_within(field + ".times", static_cast<double>(sequence.times), 1, 1e15, "");
    Run run{so_far.change, so_far.time, {}, 0, static_cast<std::int64_t>(sequence.times), pieces_.size(), 0};
    for (std::size_t k = 0; k < sequence.motions.size(); ++k) {
      const SteadyMotion& m = sequence.motions[k];
      m.validate();
      const bool may_be_infinite = last && k + 1 == sequence.motions.size() && sequence.times == 1;
      if (!may_be_infinite) require_within(field + ".motions[" + std::to_string(k) + "].duration", m.duration, 1e-6, 1e15, "s");
      const Turning orbit{normalize(m.axis), m.rate};
      Turning attitude = orbit;
      if (m.spin) attitude = length(*m.spin) > 0 ? Turning{normalize(*m.spin), length(*m.spin)} : Turning{};
      pieces_.push_back({.before = run.pass,
                         .velocity = m.velocity,
                         .orbit = orbit,
                         .centre = m.centre ? *m.centre - reference_ : Vec3{},
                         .about_itself = !m.centre,
                         .spins = m.centre && m.spin,
                         .attitude = attitude,
                         .start = run.pass_duration,
                         .duration = m.duration});
      run.pass_duration += m.duration;
      if (std::isfinite(m.duration)) run.pass = detail::then(run.pass, change(pieces_.back(), Tick::of_seconds(m.duration)));
    }
    run.pass = rounded(run.pass);
    run.end = pieces_.size();
    runs_.push_back(run);
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
    if (runs_.empty()) runs_.push_back({{}, {}, {}, 0, 1, 0, 0});
    Run& run = runs_.back();
    const double duration = to.time - from.time;
    const Rotation a = normalize(from.rotation);
    const detail::RotationParts turn(normalize(to.rotation) * conjugate(a));
    pieces_.push_back({.before = {a, {no_rotation, from.position}},
                       .velocity = (to.position - from.position) / duration,
                       .attitude = {turn.axis, turn.angle / duration},
                       .start = run.pass_duration,
                       .duration = duration});
    run.pass_duration = to.time;
    run.end = pieces_.size();
  }

  void end_cycle(const Tick& duration, const Change& change) {
    cycle_duration_ = duration.seconds(), cycle_ = change;
    runs_.shrink_to_fit(), pieces_.shrink_to_fit();
  }

  /// Appends a rest to a finite motion.
  void end(const SoFar& so_far) {
    if (!so_far.endless) {
      pieces_.emplace_back();
      runs_.push_back({so_far.change, so_far.time, {}, pieces_.back().duration, 1, pieces_.size() - 1, pieces_.size()});
    }
    cycle_first_ = runs_.size();
    runs_.shrink_to_fit(), pieces_.shrink_to_fit();
  }

  /// Change from the start of a piece to a time in it.
  static Change change(const Piece& p, const Tick& time) noexcept {
    const Vec3 way = p.velocity * static_cast<double>(time.second) + p.velocity * time.fraction;
    const Rotation attitude = p.attitude.until(time);
    if (p.about_itself) return {attitude, {no_rotation, way}};
    const Rotation orbit = p.spins ? p.orbit.until(time) : attitude;
    return {attitude, {orbit, p.centre - orbit * p.centre + way}};
  }

  static State state_at(const Place& place, const Vec3& start) noexcept {
    const Change all = detail::then(place.before, change(*place.piece, place.time));
    return {all.attitude, all.path.point(start)};
  }

  Place place_of(const Tick& tick) const noexcept {
    Tick time = tick < Tick{} ? Tick{} : tick;
    Change before;
    auto first = runs_.begin(), end = runs_.begin() + static_cast<std::ptrdiff_t>(cycle_first_);
    if (cycle_first_ < runs_.size() && !(time < cycle_start_)) {
      const detail::Periods cycles(detail::since(cycle_start_, time), cycle_duration_);
      before = detail::then(cycle_before_, detail::repeated(cycle_, cycles.whole));
      time = cycles.rest, first = end, end = runs_.end();
    }
    const Run& run = *(std::upper_bound(first + 1, end, time, [](const Tick& t, const Run& r) { return t < r.start; }) - 1);
    time = detail::since(run.start, time);
    before = detail::then(before, run.before);
    if (run.times > 1) {
      detail::Periods passes(time, run.pass_duration);
      if (passes.whole >= run.times) passes.whole = run.times - 1, passes.rest = Tick::of_seconds(run.pass_duration);
      before = detail::then(before, detail::repeated(run.pass, passes.whole));
      time = passes.rest;
    }
    const auto begin = pieces_.begin();
    const auto from = begin + static_cast<std::ptrdiff_t>(run.first), to = begin + static_cast<std::ptrdiff_t>(run.end);
    const double seconds = time.seconds();
    const Piece& piece = *(std::upper_bound(from + 1, to, seconds, [](double t, const Piece& p) { return t < p.start; }) - 1);
    return {detail::then(before, piece.before), &piece, piece.start > 0 ? detail::since(Tick::of_seconds(piece.start), time) : time};
  }

  /// Extends a box by the paths of the points, from a place in a piece to its time `end`, `span` seconds later.
  static void extend_by(Box& box, std::span<const Vec3> points, const Vec3& centre, const Vec3& start, const Place& place, const Tick& end,
                        double span) noexcept {
    const State a = state_at(place, start), b = state_at({place.before, place.piece, end}, start);
    const Piece& piece = *place.piece;
    const Vec3 middle = piece.about_itself ? a.centre : piece.centre + piece.velocity * place.time.seconds();
    const double angle = std::fabs(piece.spins ? piece.orbit.rate : piece.attitude.rate) * span;
    double radius = 0, own_radius = 0;  // radius about the middle; and about the body's own centre
    Box ends;
    const auto extend_ends = [&](const Vec3& first, const Vec3& last) {
      radius = std::max(radius, length(first - middle));
      ends.extend(first), ends.extend(last);
    };
    if (piece.spins) extend_ends(a.centre, b.centre);
    for (const Vec3& p : points)
      if (piece.spins)
        own_radius = std::max(own_radius, length(p - centre));
      else
        extend_ends(a.centre + a.attitude * (p - centre), b.centre + b.attitude * (p - centre));
    if (angle > detail::wide_turn) {
      ends = Box{};
      ends.extend(middle), ends.extend(middle + piece.velocity * span);
    }
    box.extend(detail::grown(ends, own_radius + (angle > detail::wide_turn ? radius : detail::bulge(radius, angle))));
  }

  /// Box of all positions of the body's own centre between two times, from whole runs and cycles.
  Box roughly(const Vec3& start, const Tick& from, const Tick& to) const noexcept {
    Box box, own;
    own.extend(start);
    const double end = to.seconds();
    const bool cycles = cycle_first_ < runs_.size();
    if (!cycles || from < cycle_start_)
      for (std::size_t i = 0; i < cycle_first_; ++i) {
        if (to < runs_[i].start || (i + 1 < cycle_first_ && runs_[i + 1].start < from)) continue;
        const std::int64_t whole =
            runs_[i].times > 1 ? detail::Periods(detail::since(runs_[i].start, to), runs_[i].pass_duration).whole : 0;
        const Tick early = runs_[i].start < from ? detail::since(runs_[i].start, from) : Tick{};
        const std::int64_t first = runs_[i].times > 1 ? detail::Periods(early, runs_[i].pass_duration).whole : 0;
        extend_by_run(box, own, runs_[i], std::min(first, runs_[i].times - 1), std::min(whole, runs_[i].times - 1), end);
      }
    if (cycles && !(to < cycle_start_)) {
      const Tick early = cycle_start_ < from ? detail::since(cycle_start_, from) : Tick{};
      const std::int64_t first = detail::Periods(early, cycle_duration_).whole;
      const std::int64_t last = detail::Periods(detail::since(cycle_start_, to), cycle_duration_).whole;
      const Box before = repeated_box(moved(own, cycle_before_.path), cycle_.path, first, last);
      for (std::size_t i = cycle_first_; i < runs_.size(); ++i) extend_by_run(box, before, runs_[i], 0, runs_[i].times - 1, end);
    }
    return box;
  }

  /// Extends a box by passes `first` to `last` of a run, for a body whose own centre is in `own` at the start or at that of a cycle.
  void extend_by_run(Box& box, const Box& own, const Run& run, std::int64_t first, std::int64_t last, double end) const noexcept {
    const Box before = repeated_box(moved(own, run.before.path), run.pass.path, first, last);
    for (std::size_t k = run.first; k < run.end; ++k) {
      const Piece& piece = pieces_[k];
      const Box at_start = moved(before, piece.before.path);
      const double span = std::min(piece.duration, std::max(0.0, end));
      const Vec3 way = piece.velocity * span;
      Box ends = at_start;
      ends.extend(Box{at_start.min + way, at_start.max + way});
      if (piece.about_itself) {
        box.extend(ends);
        continue;
      }
      double radius = 0;
      for (const Vec3& p : detail::corners(at_start)) radius = std::max(radius, length(p - piece.centre));
      Box axis;
      axis.extend(piece.centre), axis.extend(piece.centre + way);
      box.extend(piece.orbit.rate == 0 ? ends : detail::grown(axis, radius));
    }
  }

  static Box moved(const Box& box, const Screw& by) noexcept {
    Box out;
    for (const Vec3& p : detail::corners(box)) out.extend(by.point(p));
    return out;
  }

  /// Box around a box after `first` to `last` repetitions of a rigid motion.
  static Box repeated_box(const Box& box, const Screw& once, std::int64_t first, std::int64_t last) noexcept {
    Box out = moved(box, detail::repeated(once, first));
    out.extend(moved(box, detail::repeated(once, last)));
    const detail::RotationParts turn(once.turn);
    if (turn.angle == 0 || first == last) return out;
    // about the axis of the screw, see `steady_motion`
    const Vec3 along = dot(once.shift, turn.axis) * turn.axis, across = once.shift - along;
    const Vec3 centre = 0.5 * (across + cross(turn.axis, across) / std::tan(turn.angle / 2));
    double radius = 0;
    for (const Vec3& p : detail::corners(box)) radius = std::max(radius, length(p - centre));
    const double angle = turn.angle * static_cast<double>(last - first);
    if (angle <= detail::wide_turn) return detail::grown(out, detail::bulge(radius, angle));
    Box axis;
    axis.extend(centre + static_cast<double>(first) * along), axis.extend(centre + static_cast<double>(last) * along);
    return detail::grown(axis, radius);
  }

  std::vector<Run> runs_;        ///< the cycle's last
  std::vector<Piece> pieces_;    ///< pieces of all runs
  std::size_t cycle_first_ = 0;  ///< first run of the cycle; the number of runs without a cycle
  Tick cycle_start_{};
  Change cycle_before_{}, cycle_{};  ///< change until the cycle's start, and in one cycle
  double cycle_duration_ = 0;        ///< [s]
  Vec3 reference_{};                 ///< origin of the paths: near the motion, so that no digits are lost [m]
  bool from_origin_ = false;         ///< true for timed poses: rotation about the world's origin, not the body's own centre
};

}  // namespace pulsecast
