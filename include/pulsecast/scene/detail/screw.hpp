// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_DETAIL_SCREW_HPP
#define PULSECAST_SCENE_DETAIL_SCREW_HPP

#include <pulsecast/base/tick.hpp>
#include <pulsecast/base/vector.hpp>

/// Repeated rigid motions in closed form.
namespace PULSECAST_NAMESPACE::detail {

/// Duration from one tick to a later one.
[[nodiscard]] inline Tick since(const Tick& start, const Tick& tick) noexcept {
  const double fraction = tick.fraction - start.fraction;
  const std::int64_t second = tick.second - start.second;
  if (fraction < 0 && fraction + 1 < 1) return {second - 1, fraction + 1};
  return {second, fraction > 0 ? fraction : 0};
}

/// Time as a number of whole periods [s] and a remainder.
struct Periods {
  std::int64_t whole;
  Tick rest;

  /// Exact, as fmod is: the phase of a period after a year is that of the first second.
  Periods(const Tick& time, double period) noexcept {
    const double second = static_cast<double>(time.second);
    const double of_seconds = std::fmod(second, period), sum = of_seconds + time.fraction,
                 last = std::fmod(sum, period);
    whole = std::llround((second - of_seconds) / period) + std::llround((sum - last) / period);
    rest = Tick::of_seconds(last);
  }
};

/// Rigid motion: rotation about the origin, then a shift [m].
struct Screw {
  Rotation turn = no_rotation;
  Vec3 shift{};

  [[nodiscard]] Vec3 point(const Vec3& p) const noexcept { return turn * p + shift; }
};

[[nodiscard]] inline Screw then(const Screw& first, const Screw& second) noexcept {
  return {normalize(second.turn * first.turn), second.point(first.shift)};
}

/// Axis and angle of a rotation, the angle in [0, pi] [rad]; any axis without rotation.
struct RotationParts {
  Vec3 axis;
  double angle;

  explicit RotationParts(const Rotation& r) noexcept {
    const Vec3 v = r.w < 0 ? Vec3{-r.x, -r.y, -r.z} : Vec3{r.x, r.y, r.z};
    const double sine = length(v);
    axis = sine > 0 ? v / sine : axis::up;
    angle = 2 * std::atan2(sine, std::fabs(r.w));
  }
};

/// Replaces a rotation of less than 1e-15 rad, a rounding, by none: repetitions do not amplify it.
[[nodiscard]] inline Rotation unless_rounding(const Rotation& r) noexcept {
  return RotationParts(r).angle < 1e-15 ? no_rotation : r;
}

/// An angle [rad] times n, modulo whole turns.
[[nodiscard]] inline double multiple(double angle, std::int64_t n) noexcept {
  return 2 * pi * Tick{n, 0}.phase(angle / (2 * pi));
}

/// A rigid motion repeated n times: a screw of n times the angle and n times the glide. Across the
/// axis, the n equal steps sum up as the sides of a regular polygon. Source: Chasles 1830, every
/// rigid motion is a screw; sum of sin(k a): Gradshteyn & Ryzhik, 1.341.
[[nodiscard]] inline Screw repeated(const Screw& once, std::int64_t n) noexcept {
  if (n == 0) return {};
  if (once.turn == no_rotation) return {no_rotation, static_cast<double>(n) * once.shift};
  const RotationParts turn(once.turn);
  if (turn.angle == 0) return {no_rotation, static_cast<double>(n) * once.shift};
  const Vec3 along = dot(once.shift, turn.axis) * turn.axis, across = once.shift - along;
  const double half = multiple(turn.angle / 2, n);
  const double chord = std::sin(half) / std::sin(turn.angle / 2);
  const Vec3 sum = chord * (rotation_about(turn.axis, half - turn.angle / 2) * across);
  return {rotation_about(turn.axis, multiple(turn.angle, n)), static_cast<double>(n) * along + sum};
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
