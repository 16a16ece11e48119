// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_DETAIL_MOTION_TIMELINE_HPP
#define PULSECAST_SCENE_DETAIL_MOTION_TIMELINE_HPP

#include <algorithm>
#include <vector>

#include <pulsecast/base/frame.hpp>
#include <pulsecast/base/unit_rotation.hpp>
#include <pulsecast/scene/detail/screw.hpp>

/// Motion of a body as a list of steady pieces, in closed form over time.
namespace PULSECAST_NAMESPACE::detail {

/// Accumulated change of a body: its rotation, and the rigid motion of its own centre. The two
/// differ after rotation about its own centre.
struct Change {
  Rotation attitude = no_rotation;
  Screw path{};
};

[[nodiscard]] inline Change then(const Change& first, const Change& second) noexcept {
  const auto& [turn, shift] = first.path;
  if (first.attitude == no_rotation && turn == no_rotation && shift == Vec3{}) return second;
  return {normalize(second.attitude * first.attitude), then(first.path, second.path)};
}

[[nodiscard]] inline Change repeated(const Change& once, std::int64_t n) noexcept {
  return {repeated(Screw{once.attitude, {}}, n).turn, repeated(once.path, n)};
}

struct Turning {
  Vec3 axis = axis::up;     ///< unit
  double angular_rate = 0;  ///< [rad/s]

  [[nodiscard]] Rotation until(const Tick& time) const noexcept {
    if (angular_rate == 0) return no_rotation;
    return rotation_about(axis, 2 * pi * time.phase(angular_rate / (2 * pi)));
  }
};

/// Steady motion, or interpolation between two poses, in a run.
struct MotionPiece {
  Change before;             ///< since the start of the run
  Vec3 velocity{};           ///< [m/s]
  Turning orbit{};           ///< rotation of its own centre, unless about itself
  Vec3 centre{};             ///< centre of the orbit, relative to the reference [m]
  bool about_itself = true;  ///< true for rotation about its own centre, which moves straight
  bool spins = false;        ///< true for an attitude other than the orbit's
  Turning attitude{};
  double start = 0;            ///< since the start of the run [s]
  double duration = infinity;  ///< [s]
};

struct MotionRun {
  Change before;           ///< since the start, or since that of the cycle
  Tick start;              ///< since the start, or since that of the cycle
  Change pass;             ///< change in one pass
  double pass_duration;    ///< [s]
  std::int64_t times;      ///< at least 1
  std::size_t first, end;  ///< its pieces
};

struct MotionPlace {
  Change before;
  const MotionPiece* piece;
  Tick time;  ///< since the start of the piece
};

struct BodyState {
  Rotation attitude;
  Vec3 centre;  ///< relative to the reference [m]
};

/// Change from the start of a piece to a time in it.
[[nodiscard]] inline Change change(const MotionPiece& p, const Tick& time) noexcept {
  const Vec3 way = p.velocity * static_cast<double>(time.second) + p.velocity * time.fraction;
  const Rotation attitude = p.attitude.until(time);
  if (p.about_itself) return {attitude, {no_rotation, way}};
  const Rotation orbit = p.spins ? p.orbit.until(time) : attitude;
  return {attitude, {orbit, p.centre - orbit * p.centre + way}};
}

/// State of a body whose own centre is at `start`, relative to the reference, as placed [m].
[[nodiscard]] inline BodyState state_at(const MotionPlace& place, const Vec3& start) noexcept {
  const Change all = then(place.before, change(*place.piece, place.time));
  return {all.attitude, all.path.point(start)};
}

/// Velocity of a body's own centre, now at `centre`, relative to the reference [m/s].
[[nodiscard]] inline Vec3 velocity_at(const MotionPlace& place, const Vec3& centre) noexcept {
  const MotionPiece& p = *place.piece;
  if (p.about_itself) return p.velocity;
  const Turning& orbit = p.spins ? p.orbit : p.attitude;
  const auto seconds = static_cast<double>(place.time.second);
  const Vec3 axis_point = p.centre + p.velocity * seconds + p.velocity * place.time.fraction;
  return p.velocity + orbit.angular_rate * cross(orbit.axis, centre - axis_point);
}

/// Runs one after another; the last of them may make a cycle that repeats for ever.
struct MotionTimeline {
  std::vector<MotionRun> runs;      ///< the cycle's last
  std::vector<MotionPiece> pieces;  ///< pieces of all runs
  std::size_t cycle_first = 0;      ///< first run of the cycle; the number of runs without a cycle
  Tick cycle_start{};
  Change cycle_before{}, cycle{};  ///< change until the cycle's start, and in one cycle
  double cycle_duration = 0;       ///< [s]

  [[nodiscard]] bool is_consistent() const noexcept {
    const auto has_pieces = [this](const MotionRun& run) {
      return run.first < run.end && run.end <= pieces.size() && run.times > 0;
    };
    const bool has_runs = !runs.empty() && cycle_first <= runs.size();
    return has_runs && std::all_of(runs.begin(), runs.end(), has_pieces);
  }

  [[nodiscard]] std::size_t heap_bytes() const noexcept {
    return runs.capacity() * sizeof(MotionRun) + pieces.capacity() * sizeof(MotionPiece);
  }

  void shrink_to_fit() {
    runs.shrink_to_fit();
    pieces.shrink_to_fit();
  }

  /// Piece at a time since the start of the survey. Requires at least one run.
  [[nodiscard]] MotionPlace place_of(const Tick& tick) const noexcept {
    Tick time = tick < Tick{} ? Tick{} : tick;
    Change before;
    auto first = runs.begin(), end = runs.begin() + static_cast<std::ptrdiff_t>(cycle_first);
    if (cycle_first < runs.size() && !(time < cycle_start)) {
      const Periods cycles(since(cycle_start, time), cycle_duration);
      before = then(cycle_before, repeated(cycle, cycles.whole));
      time = cycles.rest;
      first = end;
      end = runs.end();
    }
    const auto before_start = [](const auto& t, const auto& later) { return t < later.start; };
    const MotionRun& run = *(std::upper_bound(first + 1, end, time, before_start) - 1);
    time = since(run.start, time);
    before = then(before, run.before);
    if (run.times > 1) {
      Periods passes(time, run.pass_duration);
      if (passes.whole >= run.times) {
        passes.whole = run.times - 1;
        passes.rest = Tick::of_seconds(run.pass_duration);
      }
      before = then(before, repeated(run.pass, passes.whole));
      time = passes.rest;
    }
    const MotionPiece *const from = &pieces[run.first], *const to = pieces.data() + run.end;
    const MotionPiece& piece = *(std::upper_bound(from + 1, to, time.seconds(), before_start) - 1);
    if (piece.start > 0) time = since(Tick::of_seconds(piece.start), time);
    return {then(before, piece.before), &piece, time};
  }
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
