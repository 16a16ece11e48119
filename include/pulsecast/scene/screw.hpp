// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include <pulsecast/base/tick.hpp>
#include <pulsecast/base/vector.hpp>

/// Rigid motions that are done again and again, in closed form.
namespace pulsecast::detail {

/// From one tick to a later one.
[[nodiscard]] inline Tick since(const Tick& start, const Tick& tick) noexcept {
  const double fraction = tick.fraction - start.fraction;
  const std::int64_t second = tick.second - start.second;
  return fraction < 0 && fraction + 1 < 1 ? Tick{second - 1, fraction + 1} : Tick{second, fraction > 0 ? fraction : 0};
}

/// A time as so many whole periods [s] and a rest.
struct Periods {
  std::int64_t whole;
  Tick rest;

  /// Exact, as fmod is: a period begins at the same time of it after a year as in the first second.
  Periods(const Tick& time, double period) noexcept {
    const double second = static_cast<double>(time.second);
    const double of_seconds = std::fmod(second, period), sum = of_seconds + time.fraction, last = std::fmod(sum, period);
    whole = std::llround((second - of_seconds) / period) + std::llround((sum - last) / period);
    rest = Tick::of_seconds(last);
  }
};

/// A rigid motion of space: first turned about the origin, then shifted.
struct Screw {
  Rotation turn = no_rotation;
  Vec3 shift{};

  [[nodiscard]] Vec3 point(const Vec3& p) const noexcept { return turn * p + shift; }
};

[[nodiscard]] inline Screw then(const Screw& first, const Screw& second) noexcept {
  return {normalize(second.turn * first.turn), second.point(first.shift)};
}

/// The axis, of any length if there is no turn, and the angle of a rotation, in [0, pi].
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

/// A rotation, or none where it differs from none by roundings only [rad]: what comes back exactly need not be turned again and again.
[[nodiscard]] inline Rotation unless_rounding(const Rotation& r) noexcept { return RotationParts(r).angle < 1e-15 ? no_rotation : r; }

/// An angle [rad] taken n times, less whole turns.
[[nodiscard]] inline double multiple(double angle, std::int64_t n) noexcept { return 2 * pi * Tick{n, 0}.phase(angle / (2 * pi)); }

/// A rigid motion done n times: a screw of n times the angle and n times the glide. Across the axis, n equal steps that each turn by the
/// angle sum up as the vectors of a regular polygon do.
/// Source: Chasles 1830, every rigid motion is a screw; sum of sin(k a): Gradshteyn & Ryzhik, 1.341.
[[nodiscard]] inline Screw repeated(const Screw& once, std::int64_t n) noexcept {
  if (n == 0) return {};
  if (once.turn == no_rotation) return {no_rotation, static_cast<double>(n) * once.shift};
  const RotationParts turn(once.turn);
  if (turn.angle == 0) return {no_rotation, static_cast<double>(n) * once.shift};
  const Vec3 along = dot(once.shift, turn.axis) * turn.axis, across = once.shift - along;
  const double half = multiple(turn.angle / 2, n);
  const Vec3 sum = std::sin(half) / std::sin(turn.angle / 2) * (rotation_about(turn.axis, half - turn.angle / 2) * across);
  return {rotation_about(turn.axis, multiple(turn.angle, n)), static_cast<double>(n) * along + sum};
}

}  // namespace pulsecast::detail
