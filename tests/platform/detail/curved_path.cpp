// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/detail/curved_path.hpp>

#include <cmath>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using support::Generator;
using support::relative;

namespace {

double apart(const Vec2& a, const Vec2& b) { return length(a - b); }
double between(double a, double b) { return std::fabs(std::remainder(a - b, 2 * pi)); }

}  // namespace

TEST_CASE("a line goes where it looks, backwards if need be") {
  const PathPiece ahead{{{1, 2}, 90_deg}, 10}, back{{{1, 2}, 90_deg}, 10, 0, -1};
  CHECK(apart(ahead.after(4).position, {5, 2}) < 1e-15);
  CHECK(apart(back.after(4).position, {-3, 2}) < 1e-15);
  CHECK(ahead.end().heading == 90_deg);
}

TEST_CASE("an arc is an arc of a circle, to the right and to the left") {
  const double r = 7;
  for (const double side : {1.0, -1.0}) {
    const PathPiece arc{{{0, 0}, 0}, r * pi, side / r};
    CHECK(apart(arc.after(r * pi / 2).position, {side * r, r}) < 1e-14);
    CHECK(apart(arc.end().position, {side * 2 * r, 0}) < 1e-14);
    CHECK(arc.end().heading == relative(side * pi, 1e-15));
    for (double s = 0; s < arc.length; s += 0.3)
      CHECK(apart(arc.after(s).position, {side * r, 0}) == relative(r, 1e-14));
  }
}

TEST_CASE("an arc that hardly bends is as exact as one that does") {
  const double r = 1e6, s = 100;
  const Vec2 end = PathPiece{{{0, 0}, 0}, 200, 1 / r}.after(s).position;
  CHECK(end.y == relative(r * std::sin(s / r), 1e-14));
  CHECK(end.x == relative(2 * r * std::pow(std::sin(s / r / 2), 2), 1e-12));
}

TEST_CASE("a curve is cut by an arc that touches both legs") {
  const std::vector<Vec2> waypoints{{0, 0}, {0, 50}, {50, 50}};
  const auto path = path_through(waypoints, 6);
  REQUIRE(path.size() == 3);
  CHECK(path[0].length == relative(44, 1e-14));
  CHECK(path[1].length == relative(6 * pi / 2, 1e-14));
  CHECK(path[2].length == relative(44, 1e-14));
  CHECK(apart(path[1].end().position, {6, 50}) < 1e-13);
  CHECK(path[1].curvature == 1 / 6.0);
  CHECK(path[2].waypoint == 2);
}

TEST_CASE("straight back takes a three-point turn of three sixths of a circle that ends where it began") {
  const std::vector<Vec2> waypoints{{0, 0}, {0, 50}, {0, 10}};
  const auto path = path_through(waypoints, 6);
  REQUIRE(path.size() == 5);
  for (int k = 1; k <= 3; ++k) CHECK(path[static_cast<std::size_t>(k)].length == relative(6 * pi / 3, 1e-14));
  CHECK(path[1].gear == 1);
  CHECK(path[2].gear == -1);
  CHECK(path[3].gear == 1);
  CHECK(apart(path[1].start.position, {0, 50}) < 1e-13);
  CHECK(apart(path[3].end().position, {0, 50}) < 1e-13);
  CHECK(between(path[3].end().heading, pi) < 1e-14);
}

TEST_CASE("three-point turns by any angle end where they began") {
  for (double angle = 0.01; angle < pi; angle += 0.1) {
    const double r = 5, outer = outer_arc_of_three_point_turn(angle), middle = angle - 2 * outer;
    CHECK(outer >= 0);
    CHECK(middle >= 0);
    const PathPiece first{{{3, 4}, 0.5}, r * outer, 1 / r}, second{first.end(), r * middle, -1 / r, -1},
        third{second.end(), r * outer, 1 / r};
    CHECK(apart(third.end().position, {3, 4}) < 1e-14);
    CHECK(third.end().heading == relative(0.5 + angle, 1e-14));
  }
}

TEST_CASE("one waypoint or none gives no way") {
  CHECK(path_through({}, 5).empty());
  CHECK(path_through(std::vector<Vec2>{{1, 2}}, 5).empty());
}

TEST_CASE("ways through random waypoints join up, keep the radius, and pass each waypoint as near as a curve does") {
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const double reach = random.log_uniform(0.1, 1e4), radius = random.log_uniform(0.1, 100);
    std::vector<Vec2> waypoints(2 + random.whole(12));
    for (auto& p : waypoints) p = {random.uniform(-reach, reach), random.uniform(-reach, reach)};
    if (waypoints.size() > 3) waypoints[2] = waypoints[0];  // straight back
    const auto path = path_through(waypoints, radius);
    const double grain = 1e-12 * (reach + radius * static_cast<double>(waypoints.size()));
    CHECK(apart(path.front().start.position, waypoints.front()) <= grain);
    CHECK(apart(path.back().end().position, waypoints.back()) <= grain);
    for (std::size_t k = 0; k < path.size(); ++k) {
      CHECK(path[k].length >= 0);
      CHECK((path[k].curvature == 0 || std::fabs(path[k].curvature) == 1 / radius));
      if (k == 0) continue;
      CHECK(apart(path[k - 1].end().position, path[k].start.position) <= grain);
      CHECK(between(path[k - 1].end().heading, path[k].start.heading) <= 1e-12);
      CHECK(path[k].waypoint >= path[k - 1].waypoint);
    }
  }
}
