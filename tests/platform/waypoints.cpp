// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/waypoints.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(Trajectory<Waypoints> && MovesInLanes<Waypoints>);

namespace {

const Vec3 utm{512345.678, 5403210.987, 1234.5};

Tick at(double seconds) { return Tick::of_seconds(seconds); }

double heading(const Pose<frame::Body, frame::World>& pose) { return heading_of(pose.direction(axis::forward)); }

/// Waypoints at random times that are up to 10,000 times farther apart here than there.
std::vector<TimedPose> random_points(support::Generator& any, std::size_t n) {
  std::vector<TimedPose> points;
  double time = any.uniform(0, 100);
  for (std::size_t i = 0; i < n; ++i, time += any.log_uniform(1e-3, 10))
    points.push_back({.time = time, .position = utm + any.point(100), .rotation = any.rotation()});
  return points;
}

/// Lists of positions at which a careless planner hangs or gives NaN.
std::vector<std::vector<Vec3>> awkward_lists() {
  std::vector<std::vector<Vec3>> lists{
      {utm},
      {utm, utm, utm},                                                   // repeated
      {utm, utm + axis::up, utm + 2.0 * axis::up, utm},                  // vertical
      {utm, utm + 100.0 * axis::right, utm, utm + 100.0 * axis::right},  // straight back
      {utm, utm, utm + axis::right, utm + axis::right, utm + axis::right + axis::up, utm + axis::right},  // all of it
      {{}, {1e-200, 0, 0}, {0, 1e-200, 0}, {5e-324, 5e-324, 5e-324}, {0, 1e-160, 0}},  // next to nothing
  };
  std::vector<Vec3> millimetres, many, still(10'000, utm);
  support::Generator any(7);
  for (int i = 0; i < 1000; ++i) millimetres.push_back(utm + any.point(1e-3));
  for (int i = 0; i < 10'000; ++i) many.push_back(utm + any.point(1e4));
  lists.insert(lists.end(), {millimetres, many, still});
  return lists;
}

}  // namespace

TEST_CASE("between two waypoints a body moves straight at constant velocity") {
  const Waypoints path(
      {{.time = 10, .position = utm}, {.time = 14, .position = utm + Vec3{8, -4, 2}}, {.time = 15, .position = utm}});
  CHECK(length(path.at(at(11)).position - (utm + Vec3{2, -1, 0.5})) < 1e-9);
  CHECK(length(path.at(at(14.25)).position - (utm + Vec3{6, -3, 1.5})) < 1e-9);
  CHECK(path.at(at(14)).position == utm + Vec3{8, -4, 2});
  CHECK(path.duration() == Tick{15, 0});
}

TEST_CASE("before the first and after the last waypoint a body stands there") {
  for (const auto kind : {Interpolation::linear, Interpolation::cubic}) {
    const Waypoints path({{2, utm, level(1)}, {3, utm + axis::right, level(2)}, {5, utm - axis::right, level(3)}},
                         kind);
    for (const double t : {0.0, 1.0, 1.999}) {
      CHECK(path.at(at(t)).position == utm);
      CHECK(heading(path.at(at(t))) == support::relative(1, 1e-14));
    }
    for (const double t : {5.0, 5.001, 1e9}) {
      CHECK(path.at(at(t)).position == utm - axis::right);
      CHECK(heading(path.at(at(t))) == support::relative(3, 1e-14));
    }
  }
}

TEST_CASE("a heading crosses north the short way, to either side") {
  const auto halfway = [](double from, double to) {
    return degrees(heading(Waypoints({{0, {}, level(from)}, {2, {}, level(to)}}).at({1, 0})));
  };
  CHECK(std::fabs(halfway(350_deg, 10_deg)) < 1e-12);
  CHECK(std::fabs(halfway(10_deg, 350_deg)) < 1e-12);
  CHECK(halfway(350_deg, 20_deg) == support::relative(5, 1e-12));
  CHECK(halfway(20_deg, -30_deg) == support::relative(-5, 1e-12));
  CHECK(halfway(179_deg, -177_deg) == support::relative(-179, 1e-12));
  CHECK(halfway(-2 * pi + 0.1, 2 * pi + 0.3) == support::relative(degrees(0.2), 1e-12));
}

TEST_CASE("a turn to the right turns right, at a constant rate") {
  const Waypoints path({{0, {}, level(80_deg)}, {10, {}, level(140_deg)}});
  for (int second = 0; second <= 10; ++second) {
    CAPTURE(second);
    CHECK(degrees(heading(path.at({second, 0}))) == support::relative(80 + 6 * second, 1e-12));
    CHECK(length(path.at({second, 0}).direction(axis::up) - axis::up) < 1e-14);
  }
}

TEST_CASE("cubic positions follow any parabola exactly, whatever the times") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Vec3 velocity = any.point(50), acceleration = any.point(3);
    const auto place = [&](double t) { return t * velocity + 0.5 * t * t * acceleration; };
    std::vector<TimedPose> points;
    for (double t = any.uniform(); points.size() < 3 + seed % 5; t += any.log_uniform(0.1, 10))
      points.push_back({.time = t, .position = place(t)});
    const Waypoints path(points, Interpolation::cubic);
    for (int k = 0; k < 50; ++k) {
      const double t = any.uniform(points.front().time, points.back().time);
      CHECK(length(path.at(at(t)).position - place(t)) < 1e-10 * (1 + length(place(points.back().time))));
    }
  }
}

TEST_CASE("cubic positions pass through the waypoints, and their velocity does not jump there") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<TimedPose> points;
    for (double t = 0; points.size() < 12; t += any.log_uniform(0.1, 10))
      points.push_back({.time = t, .position = any.point(100)});
    const Waypoints path(points, Interpolation::cubic);
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      CAPTURE(i);
      const double t = points[i].time, dt = 1e-5;
      const Vec3 here = path.at(at(t)).position;
      CHECK(length(here - points[i].position) < 1e-11);
      const Vec3 before = (here - path.at(at(t - dt)).position) / dt,
                 after = (path.at(at(t + dt)).position - here) / dt;
      CHECK(length(after - before) < 2);  // the acceleration, up to 1e5 m/s^2, for dt; a kink would be hundreds
    }
  }
}

TEST_CASE("two waypoints are the same path, linear or cubic") {
  const std::vector<TimedPose> points{{.time = 1, .position = utm}, {.time = 4, .position = utm + Vec3{30, 60, -3}}};
  const Waypoints linear(points), cubic(points, Interpolation::cubic);
  for (double t = 0; t < 5; t += 0.1) CHECK(length(linear.at(at(t)).position - cubic.at(at(t)).position) < 1e-8);
}

TEST_CASE("waypoints keep the laws of a motion") {
  for (const std::size_t n : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{30}, std::size_t{10'000}}) {
    CAPTURE(n);
    for (const auto kind : {Interpolation::linear, Interpolation::cubic}) {
      support::Generator any(n);
      auto points = random_points(any, n);
      for (std::size_t k = 2; k < n; k += 7) points[k].time = points[k - 1].time;
      const Waypoints path(points, kind);
      std::vector<Tick> ticks{{}, path.duration(), path.duration() + Tick{1, 0}};
      for (std::size_t k = 0; k < 300; ++k) ticks.push_back(at(any.uniform(0, points.back().time)));
      for (std::size_t k = 0; k < n; k += n / 10 + 1) ticks.push_back(at(points[k].time));
      CHECK(support::motion_laws(path, ticks) == "");
    }
  }
}

TEST_CASE("derivatives of waypoints are those of their poses, whichever way they turn") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    for (const auto kind : {Interpolation::linear, Interpolation::cubic}) {
      support::Generator any(seed);
      std::vector<TimedPose> points;
      for (double time = any.uniform(0, 10); points.size() < 10; time += any.log_uniform(0.3, 10))
        points.push_back({.time = time, .position = any.point(20), .rotation = any.rotation()});
      points[5].time = points[4].time;
      const Waypoints path(points, kind);
      std::vector<Tick> ticks{{}, path.duration(), path.duration() + Tick{1, 0}};
      for (const TimedPose& p : points) ticks.push_back(at(p.time));
      for (int k = 0; k < 100; ++k) ticks.push_back(at(any.uniform(0, points.back().time)));
      CHECK(support::derivative_laws(path, ticks, 3e-5) == "");
    }
  }
}

TEST_CASE(
    "where a time stands twice, a body jumps: it arrives as the first waypoint says, and is from then on where the "
    "last one does") {
  const std::vector<TimedPose> points{{0, utm, level(1)},
                                      {2, utm + 4.0 * axis::right, level(1)},
                                      {2, utm, level(3)},
                                      {2, utm + 9.0 * axis::up, level(2)},
                                      {4, utm + 5.0 * axis::up, level(2)},
                                      {5, utm + 5.0 * axis::up, level(2)}};
  for (const auto kind : {Interpolation::linear, Interpolation::cubic}) {
    const Waypoints path(points, kind), before({points[0], points[1]}, kind),
        after({points[3], points[4], points[5]}, kind);
    for (double t = 0; t < 2; t += 0.125) CHECK(path.at(at(t)).position == before.at(at(t)).position);
    for (double t = 2; t < 6; t += 0.125) CHECK(path.at(at(t)).position == after.at(at(t)).position);
    CHECK(length(path.at(at(2 - 1e-9)).position - points[1].position) < 1e-8);
    CHECK(heading(path.at(at(2 - 1e-9))) == support::relative(1, 1e-9));
    CHECK(path.at(at(2)).position == points[3].position);
    CHECK(heading(path.at(at(2))) == support::relative(2, 1e-14));
    const Waypoints ends({points[0], points[1], points[3]}, kind), begins({points[1], points[3], points[4]}, kind);
    CHECK(ends.at(ends.duration()).position == points[3].position);
    CHECK(begins.at(at(2)).position == points[3].position);
    CHECK(begins.at(at(1)).position == points[1].position);
  }
}

TEST_CASE("a rotation of single precision is made unit") {
  support::Generator any(3);
  for (int k = 0; k < 1000; ++k) {
    const Rotation r = any.rotation();
    const Rotation rounded{static_cast<float>(r.w), static_cast<float>(r.x), static_cast<float>(r.y),
                           static_cast<float>(r.z)};
    CHECK(length(Waypoints({{.rotation = rounded}}).at({}).rotation) == support::relative(1, 1e-15));
  }
}

TEST_CASE("waypoints refuse times that do not ascend and poses that cannot be, and name the waypoint") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const std::vector<TimedPose>& points) -> std::string {
    try {
      const Waypoints path(points);
    } catch (const SettingError& error) {
      return error.field();
    }
    return "";
  };
  CHECK(refused({}) == "Waypoints::points (number)");
  CHECK(refused({{.time = 1}, {.time = 2}, {.time = 2}, {.time = 1.5}}) == "Waypoints::points[3].time");
  CHECK(refused({{.time = 1}, {.time = 0.5}, {.time = 2}}) == "Waypoints::points[1].time");
  CHECK(refused({{.time = 1}, {.time = nan}}) == "Waypoints::points[1].time");
  CHECK(refused({{.time = 1}, {.time = 2, .position = {0, nan, 0}}}) == "Waypoints::points[1].position (length)");
  CHECK(refused({{.time = 1, .rotation = Rotation{1, 1, 0, 0}}}) == "Waypoints::points[0].rotation (norm)");
  CHECK(refused({{.time = 1, .rotation = Rotation{1.0011, 0, 0, 0}}}) == "Waypoints::points[0].rotation (norm)");
  CHECK(refused({{.time = 1}, {.time = 2}}) == "");
  CHECK_THROWS_WITH_AS(Waypoints({{0, {}}, {5e-324, axis::right}, {1, axis::up}}, Interpolation::cubic),
                       "Waypoints::points[1] (velocity from the previous one) is inf m/s, but must be finite",
                       SettingError);
}

TEST_CASE("bodies without a heading look along their path") {
  const auto headings = [](const std::vector<Vec3>& positions) {
    std::vector<TimedPose> points;
    for (const Vec3& p : positions) points.push_back({.time = static_cast<double>(points.size()), .position = utm + p});
    std::vector<int> all;
    for (const TimedPose& p : with_headings(points)) {
      all.push_back(static_cast<int>(std::lround(degrees(heading_of(p.rotation * axis::forward)))));
      CHECK(length(p.rotation * axis::up - axis::up) < 1e-14);
    }
    return all;
  };
  using Headings = std::vector<int>;
  CHECK(headings({{0, 0, 0}, {0, 9, 0}, {9, 9, 0}, {9, 0, 0}}) == Headings{0, 45, 135, 180});  // right turns turn right
  CHECK(headings({{0, 0, 0}, {0, 9, 0}, {-9, 9, 0}}) == Headings{0, -45, -90});
  CHECK(headings({{0, 0, 0}, {9, 0, 0}, {0, 0, 0}}) == Headings{90, 90, -90});  // straight back
  CHECK(headings({{0, 0, 0}, {0, 0, 5}, {9, 0, 5}, {9, 0, 9}, {9, 0, 9}}) == Headings{90, 90, 90, 90, 90});
  CHECK(headings({{0, 0, 0}, {9, 0, 0}, {9, 0, 0}, {9, -9, 0}}) == Headings{90, 135, 135, 180});
  CHECK(headings({{0, 0, 0}, {0, 0, 5}}) == Headings{0, 0});
  CHECK(headings({{0, 0, 0}}) == Headings{0});
  CHECK(headings({}).empty());

  const auto of_jump = with_headings({{0, {0, 0, 0}}, {1, {9, 0, 0}}, {1, {0, -9, 0}}, {2, {0, 0, 0}}, {2, {5, 5, 0}}});
  const int expected[] = {90, 90, 0, 0, 0};
  for (std::size_t k = 0; k < 5; ++k)
    CHECK(std::lround(degrees(heading_of(of_jump[k].rotation * axis::forward))) == expected[k]);
}

TEST_CASE("a path at constant speed reaches each position when its length says") {
  const auto points = at_constant_speed({utm, utm + Vec3{3, 4, 0}, utm + Vec3{3, 4, 0}, utm + Vec3{3, 4, 12}}, 2);
  REQUIRE(points.size() == 3);  // the repeated one is left out
  CHECK(points[0].time == 0);
  CHECK(points[1].time == support::relative(2.5, 1e-9));
  CHECK(points[2].time == support::relative(8.5, 1e-9));
  CHECK(points[2].position == utm + Vec3{3, 4, 12});
  CHECK_THROWS_AS((void)at_constant_speed({utm, axis::right}, 0), SettingError);
  CHECK_THROWS_AS((void)at_constant_speed({utm, {std::nan(""), 0, 0}}, 1), SettingError);
}

TEST_CASE("no list of positions makes a path hang or give what is no number") {
  std::size_t number = 0;
  for (const auto& positions : awkward_lists()) {
    CAPTURE(number++);
    for (const auto kind : {Interpolation::linear, Interpolation::cubic}) {
      const Waypoints path(at_constant_speed(positions, 5), kind);
      std::vector<Tick> ticks;
      for (int k = 0; k <= 500; ++k) ticks.push_back(at(path.duration().seconds() * k / 500));
      CHECK(support::motion_laws(path, ticks) == "");
      CHECK(length(path.at(path.duration()).position - positions.back()) < 1e-6);
    }
  }
}
