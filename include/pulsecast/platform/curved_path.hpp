// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/platform/heading.hpp>

namespace pulsecast {

/// Where a vehicle is on the map, and where it looks.
struct Stance {
  Vec2 position{};     ///< east and north [m]
  double heading = 0;  ///< clockwise from north; may count several turns [rad]
};

/// A straight line or an arc of a circle, driven forwards or backwards.
struct PathPiece {
  Stance start{};
  double length = 0;         ///< [m]
  double curvature = 0;      ///< of the wheels' turn: to the right above 0 [1/m]
  double gear = 1;           ///< 1 forwards, -1 backwards
  std::size_t waypoint = 0;  ///< number of the waypoint that it leads to

  /// Stance after a length of the piece [m]. Source: the chord of an arc is 2 r sin(angle / 2), along the heading in its middle.
  [[nodiscard]] Stance after(double driven) const noexcept {
    const double way = gear * driven, half = 0.5 * curvature * way;
    const double chord = std::fabs(half) < 1e-4 ? way * (1 - half * half / 6) : way * std::sin(half) / half;  // exact to 1e-18
    const double middle = start.heading + half;
    return {start.position + chord * Vec2{std::sin(middle), std::cos(middle)}, start.heading + 2 * half};
  }
  [[nodiscard]] Stance end() const noexcept { return after(length); }
};

/// The angle that the first and the last arc of a three-point turn on the spot turn by; the one in the middle, backwards, turns by the
/// rest. All three have one radius, and after them the vehicle is where it was, turned by `angle` in [0, pi]: for pi they turn by pi/3
/// each. Source: the family C|C|C of Reeds & Shepp 1990, whose centres are 2 r apart, solved for no displacement: sin(middle / 2) =
/// sin(angle / 2) / 2.
[[nodiscard]] inline double outer_arc_of_three_point_turn(double angle) noexcept {
  return 0.5 * angle - std::asin(0.5 * std::sin(0.5 * angle));
}

/// The way through waypoints: straight legs, joined by arcs of one radius that touch them (the circles and lines of Dubins 1957). Where an
/// arc would take up more than half of a leg, the curve is too tight: there the way goes up to the waypoint, turns on the spot by a
/// three-point turn, and goes on. Each waypoint differs from the one before; a single one gives no way. All headings join up.
[[nodiscard]] inline std::vector<PathPiece> path_through(std::span<const Vec2> waypoints, double radius) {
  std::vector<PathPiece> path;
  const std::size_t legs = waypoints.empty() ? 0 : waypoints.size() - 1;
  const auto way = [&](std::size_t k) { return waypoints[k + 1] - waypoints[k]; };
  const auto heading = [&](std::size_t k) { return heading_of({way(k).x, way(k).y, 0}); };
  double taken = 0, looks = legs > 0 ? heading(0) : 0;  // by the arc before
  for (std::size_t k = 0; k < legs; ++k) {
    const double whole = length(way(k)), angle = k + 1 < legs ? std::remainder(heading(k + 1) - looks, 2 * pi) : 0;
    const Vec2 direction = way(k) / whole;
    const double touch = radius * std::tan(0.5 * std::fabs(angle)), room = k + 1 < legs ? 0.5 * std::fmin(whole, length(way(k + 1))) : 0;
    const bool tight = !(touch <= room) || std::fabs(angle) > 3;  // where the tangent is a number without meaning
    const double left = tight ? 0 : touch, curvature = std::copysign(1 / radius, angle);
    path.push_back({{waypoints[k] + taken * direction, looks}, std::fmax(0.0, whole - taken - left), 0, 1, k + 1});
    const Stance corner{waypoints[k] + (whole - left) * direction, looks};
    if (angle != 0 && !tight) path.push_back({corner, radius * std::fabs(angle), curvature, 1, k + 1});
    if (tight) {
      const double outer = outer_arc_of_three_point_turn(std::fabs(angle)), middle = std::fabs(angle) - 2 * outer;
      const PathPiece first{corner, radius * outer, curvature, 1, k + 1};
      const PathPiece second{first.end(), radius * middle, -curvature, -1, k + 1};
      const PathPiece third{second.end(), radius * outer, curvature, 1, k + 1};
      path.insert(path.end(), {first, second, third});
    }
    looks += angle, taken = left;
  }
  return path;
}

}  // namespace pulsecast
