// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_DETAIL_MOTION_SWEEP_HPP
#define PULSECAST_SCENE_DETAIL_MOTION_SWEEP_HPP

#include <pulsecast/scene/detail/motion_timeline.hpp>
#include <pulsecast/scene/part.hpp>

/// Boxes around all that a body passes on its timeline.
namespace PULSECAST_NAMESPACE::detail {

[[nodiscard]] inline Box around(const Vec3& a, const Vec3& b) noexcept { return {min(a, b), max(a, b)}; }
[[nodiscard]] inline Box grown(const Box& b, double by) noexcept { return {b.min - Vec3(by), b.max + Vec3(by)}; }

/// Greatest deviation of a point from uniform straight motion while it turns by an angle [rad] at
/// this distance from an axis in such motion; in its unit. Source: error of linear interpolation,
/// |f''| h^2 / 8 (Davis 1975, Interpolation and Approximation, ch. 3).
[[nodiscard]] inline double bulge(double distance, double angle) noexcept { return distance * angle * angle / 8; }

/// Angle beyond which a turning point is bounded by its whole sphere [rad]; for the size of boxes.
inline constexpr double wide_turn = 2;

[[nodiscard]] inline Box moved(const Box& box, const Screw& by) noexcept {
  Box out;
  for (const Vec3& p : corners(box)) out.extend(by.point(p));
  return out;
}

/// Box around a box after `first` to `last` repetitions of a rigid motion.
[[nodiscard]] inline Box repeated_box(const Box& box, const Screw& once, std::int64_t first,
                                      std::int64_t last) noexcept {
  Box out = moved(box, repeated(once, first));
  out.extend(moved(box, repeated(once, last)));
  const RotationParts turn(once.turn);
  if (turn.angle == 0 || first == last) return out;
  // about the axis of the screw, see `steady_motion`
  const Vec3 along = dot(once.shift, turn.axis) * turn.axis, across = once.shift - along;
  const Vec3 centre = 0.5 * (across + cross(turn.axis, across) / std::tan(turn.angle / 2));
  double radius = 0;
  for (const Vec3& p : corners(box)) radius = std::max(radius, length(p - centre));
  const double angle = turn.angle * static_cast<double>(last - first);
  if (angle <= wide_turn) return grown(out, bulge(radius, angle));
  const auto at = [&](std::int64_t n) noexcept { return centre + static_cast<double>(n) * along; };
  return grown(around(at(first), at(last)), radius);
}

/// Box of a body as placed, in any attitude.
struct SweptBody {
  Vec3 start;         ///< own centre, relative to the reference [m]
  Vec3 offset;        ///< from the own centre to the middle of the box [m]
  Rotation rotation;  ///< unit
  Vec3 half;          ///< half sides [m]

  /// Radius of a ball about the own centre that holds the body [m].
  [[nodiscard]] double radius() const noexcept { return length(offset) + length(half); }
  /// Greatest distance of a corner from a point, by the offset of the middle, and these axes [m].
  [[nodiscard]] double corner_distance(const Vec3& middle, const Matrix3& axes) const noexcept {
    double mixed = 0;  // the corner in the octant of `middle`
    for (int k = 0; k < 3; ++k) mixed += std::fabs(dot(middle, axes[k])) * half[k];
    return std::sqrt(dot(middle, middle) + dot(half, half) + 2 * mixed);
  }
};

struct SweptState {
  Vec3 middle;  ///< relative to the reference [m]
  Matrix3 axes;

  SweptState(const SweptBody& body, const BodyState& state) noexcept
      : middle(state.centre + state.attitude * body.offset), axes(matrix_of(state.attitude * body.rotation)) {}
  [[nodiscard]] Box box(const SweptBody& body) const noexcept {
    const Vec3 reach = reach_of(axes, body.half);
    return {middle - reach, middle + reach};
  }
};

/// Extends a box by the path of a body that turns otherwise than it orbits, as of a ball.
inline void extend_by_ball(Box& box, const SweptBody& body, const MotionPlace& place, const Tick& end,
                           double span) noexcept {
  const MotionPiece& piece = *place.piece;
  const Vec3 first = state_at(place, body.start).centre;
  const Vec3 middle = piece.centre + piece.velocity * place.time.seconds();
  const double angle = std::fabs(piece.orbit.angular_rate) * span, radius = length(first - middle);
  const bool wide = angle > wide_turn;
  const Vec3 last = state_at({place.before, place.piece, end}, body.start).centre;
  const Box way = wide ? around(middle, middle + piece.velocity * span) : around(first, last);
  box.extend(grown(way, body.radius() + (wide ? radius : bulge(radius, angle))));
}

/// Extends a box by the path of a body, from a place in a piece to its time `end`, `span` later.
inline void extend_by_piece(Box& box, const SweptBody& body, const MotionPlace& place, const Tick& end,
                            double span) noexcept {
  const MotionPiece& piece = *place.piece;
  if (piece.spins) return extend_by_ball(box, body, place, end, span);
  const BodyState state = state_at(place, body.start);
  const SweptState first(body, state);
  const Vec3 way = piece.velocity * span;
  const double angle = std::fabs(piece.attitude.angular_rate) * span;
  Box ends = first.box(body);
  if (angle == 0) {
    box.extend(ends);
    return box.extend(Box{ends.min + way, ends.max + way});
  }
  const Vec3 axis_point = piece.centre + piece.velocity * place.time.seconds();
  const Vec3 centre = piece.about_itself ? state.centre : axis_point;
  const double radius = body.corner_distance(first.middle - centre, first.axes);
  if (angle > wide_turn) return box.extend(grown(around(centre, centre + way), radius));
  ends.extend(SweptState(body, state_at({place.before, place.piece, end}, body.start)).box(body));
  box.extend(grown(ends, bulge(radius, angle)));
}

/// Extends a box by passes `first` to `last` of a run, for an own centre in `own` at the start.
inline void extend_by_run(Box& box, const MotionTimeline& motion, const Box& own, const MotionRun& run,
                          std::int64_t first, std::int64_t last, double end) noexcept {
  const Box before = repeated_box(moved(own, run.before.path), run.pass.path, first, last);
  for (std::size_t k = run.first; k < run.end; ++k) {
    const MotionPiece& piece = motion.pieces[k];
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
    for (const Vec3& p : corners(at_start)) radius = std::max(radius, length(p - piece.centre));
    const Box axis = around(piece.centre, piece.centre + way);
    box.extend(piece.orbit.angular_rate == 0 ? ends : grown(axis, radius));
  }
}

/// Box of all positions of the body's own centre between two times, from whole runs and cycles.
[[nodiscard]] inline Box rough_path_box(const MotionTimeline& motion, const Vec3& start, const Tick& from,
                                        const Tick& to) noexcept {
  Box box, own;
  own.extend(start);
  const double end = to.seconds();
  const bool cycles = motion.cycle_first < motion.runs.size();
  if (!cycles || from < motion.cycle_start)
    for (std::size_t i = 0; i < motion.cycle_first; ++i) {
      const MotionRun& run = motion.runs[i];
      if (to < run.start || (i + 1 < motion.cycle_first && motion.runs[i + 1].start < from)) continue;
      const auto pass = [&](const Tick& time) noexcept {
        return run.times > 1 ? std::min(Periods(time, run.pass_duration).whole, run.times - 1) : 0;
      };
      const Tick early = run.start < from ? since(run.start, from) : Tick{};
      extend_by_run(box, motion, own, run, pass(early), pass(since(run.start, to)), end);
    }
  if (cycles && !(to < motion.cycle_start)) {
    const Tick early = motion.cycle_start < from ? since(motion.cycle_start, from) : Tick{};
    const std::int64_t first = Periods(early, motion.cycle_duration).whole;
    const std::int64_t last = Periods(since(motion.cycle_start, to), motion.cycle_duration).whole;
    const Box at_start = moved(own, motion.cycle_before.path);
    const Box before = repeated_box(at_start, motion.cycle.path, first, last);
    for (std::size_t i = motion.cycle_first; i < motion.runs.size(); ++i)
      extend_by_run(box, motion, before, motion.runs[i], 0, motion.runs[i].times - 1, end);
  }
  return box;
}

/// Box that holds all points, relative to the reference [m], that a body passes between two times.
[[nodiscard]] inline Box swept_box(const MotionTimeline& motion, const SweptBody& body, const Tick& from,
                                   const Tick& to) noexcept {
  constexpr int max_pieces = 32;  // pieces bounded one by one; affects only the size of the box
  Box box;
  Tick tick = std::max(from, Tick{});
  int pieces = 0;
  for (; pieces < max_pieces; ++pieces) {
    const MotionPlace place = motion.place_of(tick);
    const double rest = std::max(0.0, since(tick, to).seconds());
    const double span = std::min(rest, std::max(0.0, place.piece->duration - place.time.seconds()));
    const Tick end = place.time + Tick::of_seconds(span);
    extend_by_piece(box, body, place, end, span);
    if (!(span < rest)) break;
    tick = tick + Tick::of_seconds(std::max(span, 1e-12));
  }
  if (pieces == max_pieces) box.extend(grown(rough_path_box(motion, body.start, tick, to), body.radius()));
  return box;
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
