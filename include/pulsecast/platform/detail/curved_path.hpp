// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_DETAIL_CURVED_PATH_HPP
#define PULSECAST_PLATFORM_DETAIL_CURVED_PATH_HPP

#include <span>
#include <vector>

#include <pulsecast/base/frame.hpp>

namespace PULSECAST_NAMESPACE {

/// Position and heading of a vehicle on the map.
struct Stance {
  Vec2 position{};     ///< position east and north [m]
  double heading = 0;  ///< heading clockwise from north; may exceed a turn [rad]
};

/// Straight line or circular arc, driven forwards or backwards.
struct PathPiece {
  Stance start{};            ///< stance where the piece begins
  double length = 0;         ///< length of the piece [m]
  double curvature = 0;      ///< curvature of the wheels' turn; positive to the right [1/m]
  double gear = 1;           ///< 1 forwards, -1 backwards
  std::size_t waypoint = 0;  ///< number of the waypoint ahead

  /// Stance after a driven length [m]. Source: chord of an arc, 2 r sin(angle / 2).
  [[nodiscard]] Stance after(double driven) const noexcept {
    const double way = gear * driven, half = 0.5 * curvature * way;
    const double chord = std::fabs(half) < 1e-4 ? way * (1 - half * half / 6) : way * std::sin(half) / half;
    const double middle = start.heading + half;
    return {start.position + chord * Vec2{std::sin(middle), std::cos(middle)}, start.heading + 2 * half};
  }
  [[nodiscard]] Stance end() const noexcept { return after(length); }  ///< at its end
};

/// Angle of the first and the last arc of a three-point turn on the spot by `angle` in [0, pi]; the middle one,
/// backwards, turns by the rest. All have one radius; for pi, each is pi/3. Source: family C|C|C of Reeds & Shepp 1990,
/// with centres 2 r apart, for zero displacement: sin(middle / 2) = sin(angle / 2) / 2.
[[nodiscard]] inline double outer_arc_of_three_point_turn(double angle) noexcept {
  return 0.5 * angle - std::asin(0.5 * std::sin(0.5 * angle));
}

/// Path through waypoints: straight legs joined by tangent arcs of one radius (the circles and
/// lines of Dubins 1957). Where an arc would take more than half of a leg, it makes a three-point
/// turn at the waypoint. Consecutive waypoints must differ. Headings are continuous.
[[nodiscard]] inline std::vector<PathPiece> path_through(std::span<const Vec2> waypoints, double radius) {
  std::vector<PathPiece> path;
  const std::size_t legs = waypoints.empty() ? 0 : waypoints.size() - 1;
  const auto way = [&](std::size_t k) { return waypoints[k + 1] - waypoints[k]; };
  const auto heading = [&](std::size_t k) { return heading_of({way(k).x, way(k).y, 0}); };
  double taken = 0, looks = legs > 0 ? heading(0) : 0;  // length taken by the arc before
  for (std::size_t k = 0; k < legs; ++k) {
    const double whole = length(way(k)), angle = k + 1 < legs ? std::remainder(heading(k + 1) - looks, 2 * pi) : 0;
    const Vec2 direction = way(k) / whole;
    const double touch = radius * std::tan(0.5 * std::fabs(angle)),
                 room = k + 1 < legs ? 0.5 * std::fmin(whole, length(way(k + 1))) : 0;
    const bool tight = !(touch <= room) || std::fabs(angle) > 3;  // the tangent is meaningless
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
    looks += angle;
    taken = left;
  }
  return path;
}

}  // namespace PULSECAST_NAMESPACE

#endif
