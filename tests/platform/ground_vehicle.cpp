// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/ground_vehicle.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(Trajectory<GroundVehicleDrive>);
using support::Generator;
using support::relative;
using support::detail::sentence;

namespace {

using Points = std::vector<Vec2>;

std::optional<double> level_ground(Vec2) { return 0.0; }
std::optional<double> ramp(Vec2 p) { return 100 + 0.15 * p.x - 0.1 * p.y; }

/// Hills some 60 m apart and 3 m high, in places as steep as 1 in 6.
std::optional<double> hills(Vec2 p) {
  return 1.2 * std::sin(p.x / 10) * std::cos(p.y / 13) + 0.3 * std::sin((p.x + p.y) / 7);
}

/// The four wheels of a vehicle, where they touch the ground.
std::vector<Vec3> wheels(const Pose<frame::Body, frame::World>& pose, const GroundVehicleSettings& s) {
  std::vector<Vec3> all;
  for (const double x : {-s.track / 2, s.track / 2}) {
    for (const double y : {0.0, s.wheelbase}) all.push_back(pose.point({x, y, 0}));
  }
  return all;
}

/// How far the farthest wheel is ever from the ground [m].
double farthest_wheel(const GroundVehicleDrive& drive, const GroundVehicleSettings& s, auto&& ground, int samples) {
  double farthest = 0;
  for (int i = 0; i <= samples; ++i) {
    for (const Vec3& wheel : wheels(drive.at(Tick::of_seconds(drive.duration().seconds() * i / samples)), s))
      farthest = std::fmax(farthest, std::fabs(*ground(Vec2{wheel.x, wheel.y}) - wheel.z));
  }
  return farthest;
}

/// The first promise that a drive on level ground does not keep; empty if it keeps all. From the pieces of way and of
/// time themselves.
std::string broken_promise(const GroundVehicleDrive& drive, const GroundVehicleSettings& s, const Points& points,
                           double grain = 1e-6) {
  const double more = 1 + 1e-9;
  for (std::size_t k = 0; k < drive.sections().size(); ++k) {
    const auto& [path, start, footings] = drive.sections()[k];
    if (!(std::fabs(path.curvature) * s.turn_radius <= more))
      return sentence("section ", k, " bends by ", path.curvature, " /m");
    if (k > 0 && !(length(drive.sections()[k - 1].path.end().position - path.start.position) <= grain))
      return sentence("a gap before section ", k);
  }
  const auto& pieces = drive.driven().pieces();
  std::size_t section = 0;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const CubicPiece<double>& piece = pieces[k].piece;
    const double middle = piece.after(piece.duration / 2).position;
    while (section + 1 < drive.sections().size() && middle >= drive.sections()[section + 1].start) ++section;
    const double bend = std::fabs(drive.sections()[section].path.curvature);
    for (int i = 0; i <= 8; ++i) {
      const auto state = piece.after(piece.duration * i / 8);
      if (!std::isfinite(state.position)) return sentence("piece ", k, " is not finite");
      if (!(state.velocity <= s.speed * more) || !(state.velocity >= -1e-9 * s.speed))
        return sentence("piece ", k, " has a speed of ", state.velocity);
      const double across = state.velocity * state.velocity * bend,
                   acceleration = std::hypot(across, state.acceleration);
      if (!(acceleration <= s.acceleration * more))
        return sentence("piece ", k, " has an acceleration of ", acceleration);
      if (!(std::fabs(state.jerk) <= s.jerk * more)) return sentence("piece ", k, " has a jerk of ", state.jerk);
    }
    if (k + 1 == pieces.size()) break;
    const auto end = piece.after(piece.duration), next = pieces[k + 1].piece.after(0);
    if (!(std::fabs(next.position - end.position) <= grain)) return sentence("a gap behind piece ", k);
    if (!(std::fabs(next.velocity - end.velocity) <= 1e-9 * s.speed))
      return sentence("the speed jumps behind piece ", k);
  }
  for (std::size_t k = 1; k < drive.sections().size(); ++k) {  // at a change of gear it stands
    if (drive.sections()[k].path.gear == drive.sections()[k - 1].path.gear) continue;
    const double there = drive.sections()[k].start;
    const bool stands = std::any_of(pieces.begin(), pieces.end(), [&](const auto& p) {
      return std::fabs(p.piece.position - there) <= grain && std::fabs(p.piece.velocity) <= 1e-12;
    });
    if (!stands) return sentence("it changes gear at speed before section ", k);
  }
  const auto first = drive.at({}).position, last = drive.at(drive.duration()).position;
  if (!(length(Vec2{first.x, first.y} - points.front()) <= grain)) return "it does not begin at the first waypoint";
  if (!(length(Vec2{last.x, last.y} - points.back()) <= grain)) return "it does not arrive at the last waypoint";
  return {};
}

}  // namespace

TEST_CASE("a straight drive takes L / v + v / a + a / j and looks along its way") {
  const GroundVehicleSettings s{.speed = 5, .acceleration = 2, .jerk = 4};
  const auto drive = plan_ground_vehicle(Points{{0, 0}, {100, 0}}, level_ground, s);
  CHECK(drive.duration().seconds() == relative(100 / 5.0 + 5 / 2.0 + 2 / 4.0, 1e-14));
  CHECK(length(drive.at({}).position) < 1e-15);
  CHECK(length(drive.at(drive.duration()).position - Vec3{100, 0, 0}) < 1e-13);
  CHECK(length(drive.at({7, 0}).direction(axis::forward) - axis::right) < 1e-15);
}

TEST_CASE("on a ramp all wheels are on the ground to a tenth of a millimetre, whichever way it goes") {
  const GroundVehicleSettings s;
  const auto drive = plan_ground_vehicle(Points{{0, 0}, {40, 10}, {60, -40}, {0, 0}, {60, 0}}, ramp, s);
  CHECK(farthest_wheel(drive, s, ramp, 2000) < 1e-4);
  const Vec3 normal = normalize(Vec3{-0.15, 0.1, 1});
  for (double t = 0; t < drive.duration().seconds(); t += 0.5)
    CHECK(length(drive.at(Tick::of_seconds(t)).direction(axis::up) - normal) < 1e-5);
}

TEST_CASE("where steep ground bends, the wheels are where the leaning body has them") {
  const auto bowl = [](Vec2 p) -> std::optional<double> { return 0.03 * p.y * p.y; };  // at 12 m as steep as 7 in 10
  const GroundVehicleSettings s;
  CHECK(farthest_wheel(plan_ground_vehicle(Points{{0, -12}, {0, 9}}, bowl, s), s, bowl, 1000) < 2e-4);
}

TEST_CASE("pitch and roll come from the ground") {
  const auto east = plan_ground_vehicle(Points{{0, 0}, {40, 0}}, ramp, {});
  const Vec3 ahead = east.at({3, 0}).direction(axis::forward), aside = east.at({3, 0}).direction(axis::right);
  CHECK(ahead.z / std::hypot(ahead.x, ahead.y) == relative(0.15, 1e-6));
  CHECK(std::fabs(ahead.y) < 1e-12);                                                    // the map shows it looking east
  CHECK(aside.z / std::hypot(aside.x, aside.y) == doctest::Approx(0.1).epsilon(0.02));  // to the south it rises
}

TEST_CASE("over hills the wheels stay within 2 cm of the ground") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    Points points(2 + random.whole(6));
    for (auto& p : points) p = {random.uniform(-100, 100), random.uniform(-100, 100)};
    const GroundVehicleSettings s{.turn_radius = random.log_uniform(4, 15)};
    const auto drive = plan_ground_vehicle(points, hills, s);
    CHECK(farthest_wheel(drive, s, hills, 3000) < 0.02);
  }
}

TEST_CASE("over hills the body keeps the speed limit in space, not only on the map") {
  const GroundVehicleSettings s{.speed = 12, .ground_step = 0.5};
  const auto steep = [](Vec2 p) -> std::optional<double> { return 0.3 * p.x; };
  const auto drive = plan_ground_vehicle(Points{{0, 0}, {300, 0}}, steep, s);
  double fastest = 0;
  for (double t = 0; t + 0.01 < drive.duration().seconds(); t += 0.1)
    fastest = std::fmax(
        fastest, length(drive.at(Tick::of_seconds(t + 0.01)).position - drive.at(Tick::of_seconds(t)).position) / 0.01);
  CHECK(fastest == relative(12, 1e-9));
}

TEST_CASE(
    "drives through random waypoints keep their radius and all limits, stand where they change gear, and arrive") {
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const double reach = random.log_uniform(0.1, 300);
    Points points(1 + random.whole(8));
    for (auto& p : points) {
      p = {random.uniform(-reach, reach), random.uniform(-reach, reach)};
      if (random.whole(6) == 0) p = points[0];
    }
    const GroundVehicleSettings s{.speed = random.log_uniform(0.1, 50),
                                  .acceleration = random.log_uniform(0.1, 10),
                                  .jerk = random.log_uniform(0.1, 20),
                                  .turn_radius = random.log_uniform(1, 20),
                                  .ground_step = 10};
    CHECK(broken_promise(plan_ground_vehicle(points, level_ground, s), s, points) == "");
  }
}

TEST_CASE("the pose of a drive does not jump, also where it changes gear") {
  const auto drive = plan_ground_vehicle(Points{{0, 0}, {0, 40}, {3, 0}, {30, 20}, {32, 20}, {32, 22}}, hills, {});
  const double h = 1e-3;
  for (double t = 0; t < drive.duration().seconds(); t += h) {
    const auto a = drive.at(Tick::of_seconds(t)), b = drive.at(Tick::of_seconds(t + h));
    CHECK(length(a.position - b.position) < 11 * h);
    CHECK(length(a.direction(axis::forward) - b.direction(axis::forward)) < 2 * h);
    CHECK(length(a.direction(axis::up) - b.direction(axis::up)) < 2 * h);
  }
}

TEST_CASE("no list of waypoints is too odd for a drive") {
  const GroundVehicleSettings s{.ground_step = 100};
  const auto keeps = [&](const Points& points, double grain = 1e-6) {
    return broken_promise(plan_ground_vehicle(points, level_ground, s), s, points, grain);
  };
  CHECK(keeps({{1, 2}}) == "");
  CHECK(keeps({{1, 2}, {1, 2}, {1, 2}}) == "");
  CHECK(keeps({{0, 0}, {0, 9}, {0, 9}, {0, 18}}) == "");
  CHECK(keeps({{0, 0}, {0, 9}, {0, 0}, {0, 9}}) == "");
  CHECK(keeps({{0, 0}, {0.001, 0}, {0, 0.001}, {5, 0.001}, {5, 0.002}}) == "");
  CHECK(keeps({{0, 0}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}, {0, 0}}) == "");
  CHECK(keeps({{0, 0}, {1e-300, 0}, {0, 1e-300}, {7, 1e-300}}) == "");
  CHECK(keeps({{0, 0}, {0, 50}, {1e-7, 0}, {0, 60}}) == "");
  CHECK(keeps({{500000, 5400000}, {500020, 5400000}, {500020, 5400020}}) == "");
  CHECK(keeps({{-1e6, 1e6}, {1e6, 1e6}, {0, 0}}) == "");
  CHECK(keeps({{1e9, 1e9}, {1e9 - 30, 1e9}, {1e9 - 30, 1e9 - 50}}) == "");
  CHECK_THROWS_AS((void)plan_ground_vehicle(Points{{-1e9, 1e9}, {1e9, 1e9}}, level_ground, {}),
                  SettingError);  // too long for its steps
}

TEST_CASE("ten thousand waypoints are driven, be they in a row, in a circle, or anywhere") {
  Generator random(7);
  Points row(10000), circle(10000), anywhere(10000);
  for (std::size_t k = 0; k < row.size(); ++k) {
    const double i = static_cast<double>(k);
    row[k] = {1e-3 * i, 0};
    circle[k] = {50 * std::cos(0.01 * i), 50 * std::sin(0.01 * i)};
    anywhere[k] = {random.uniform(-50, 50), random.uniform(-50, 50)};
  }
  const GroundVehicleSettings s{.ground_step = 10};
  for (const Points* points : {&row, &circle, &anywhere})
    CHECK(broken_promise(plan_ground_vehicle(*points, level_ground, s), s, *points) == "");
}

TEST_CASE("on any plane the pose is exact, and a straight drive takes L / v + v / a + a / j of its way in space") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const double east = random.uniform(-0.4, 0.4), north = random.uniform(-0.4, 0.4), heading = random.uniform(-pi, pi);
    const auto plane = [&](Vec2 p) -> std::optional<double> { return 20 + east * p.x + north * p.y; };
    const GroundVehicleSettings s{.speed = random.uniform(2, 20), .ground_step = random.log_uniform(0.05, 2)};
    const Vec2 ahead{std::sin(heading), std::cos(heading)}, end = random.uniform(250, 400) * ahead;
    const auto drive = plan_ground_vehicle(Points{{0, 0}, end}, plane, s);
    const double slope = east * ahead.x + north * ahead.y, way = length(end) * std::hypot(1, slope);
    CHECK(drive.duration().seconds() ==
          relative(way / s.speed + s.speed / s.acceleration + s.acceleration / s.jerk, 1e-13));
    CHECK(drive.warnings().empty());
    for (int i = 0; i <= 20; ++i) {
      const auto pose = drive.at(Tick::of_seconds(drive.duration().seconds() * i / 20));
      const Vec3 forward = pose.direction(axis::forward);
      CHECK(std::fabs(pose.position.z - *plane({pose.position.x, pose.position.y})) < 1e-13);
      CHECK(length(pose.direction(axis::up) - normalize(Vec3{-east, -north, 1})) < 2e-14);
      CHECK(std::fabs(forward.x * ahead.y - forward.y * ahead.x) < 1e-14);
    }
  }
}

TEST_CASE("a step in the ground costs its height in way, wherever it is and however finely the ground is asked") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const double height = random.log_uniform(0.01, 0.3), at = random.uniform(50, 450),
                 step = random.log_uniform(0.01, 1);
    const bool up = random.coin();
    const auto kerb = [&](Vec2 p) -> std::optional<double> { return (p.x < at) == up ? 0 : height; };
    const GroundVehicleSettings s{.speed = random.log_uniform(2, 25), .ground_step = step};
    const double level = 500 / s.speed + s.speed / s.acceleration + s.acceleration / s.jerk;
    const auto drive = plan_ground_vehicle(Points{{0, 0}, {500, 0}}, kerb, s);
    CHECK(drive.duration().seconds() >= level);
    CHECK(drive.duration().seconds() <= level + 1.001 * height / s.speed);
    CHECK(drive.warnings().empty());
    const double high = std::fmax(drive.at({}).position.z, drive.at(drive.duration()).position.z);
    for (const Footing& footing : drive.sections()[0].footings)
      REQUIRE(std::fabs(footing.height - high / 2) <= high / 2 + 1e-12);
  }
}

TEST_CASE("a drive over steps and slopes keeps its limits along the way in space") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const double high = random.uniform(0, 0.3), slope = random.uniform(-0.4, 0.4), wide = random.uniform(0.5, 20);
    const auto ground = [&](Vec2 p) -> std::optional<double> {
      return slope * p.y + (std::fmod(p.x + 1e3, 2 * wide) < wide ? high : 0);
    };
    Points points(2 + random.whole(5));
    for (auto& p : points) p = {random.uniform(-60, 60), random.uniform(-60, 60)};
    const GroundVehicleSettings s{.speed = random.log_uniform(1, 30)};
    const auto drive = plan_ground_vehicle(points, ground, s);
    CHECK(broken_promise(drive, s, points) == "");
    double driven = 0;
    for (const auto& section : drive.sections()) {
      CHECK(std::fabs(section.start - driven) < 1e-9);
      const double step = section.path.length / static_cast<double>(section.footings.size() - 1);
      for (std::size_t i = 1; i < section.footings.size(); ++i) {
        const Footing &a = section.footings[i - 1], &b = section.footings[i];
        REQUIRE(std::fabs(b.along - a.along - std::hypot(step, b.height - a.height)) < 1e-9);
      }
      driven += section.footings.back().along;
    }
    CHECK(drive.at(drive.duration()).position.z == relative(drive.sections().back().footings.back().height, 1e-12));
  }
}

TEST_CASE("a wheel rolls up a kerb along the arc of its axle, and over gaps narrower than it is") {
  const GroundVehicleSettings s{.ground_step = 0.01};
  const auto highest_step = [](const GroundVehicleDrive& drive) {
    double most = 0;
    const auto& footings = drive.sections()[0].footings;
    for (std::size_t i = 1; i < footings.size(); ++i)
      most = std::fmax(most, std::fabs(footings[i].height - footings[i - 1].height));
    return most;
  };
  const auto kerb = [](Vec2 p) -> std::optional<double> { return p.x < 20 ? 0 : 0.15; };
  const auto drive = plan_ground_vehicle(Points{{0, 0}, {40, 0}}, kerb, s);
  const double r = s.wheel_radius,
               reach = std::sqrt(2 * r * 0.15 - 0.15 * 0.15);  // the wheel touches the edge from there on
  for (const Footing& f : drive.sections()[0].footings) {
    if (f.along < 20 - reach - 0.03) CHECK(f.height < 1e-12);
    if (f.along > 20.5) CHECK(f.height == relative(0.15, 1e-12));
  }
  CHECK(highest_step(drive) < 0.06);  // the sampling of the wheel by 26 mm, times the slope of its arc
  for (const double deep : {0.5, 3.0, 100.0}) {
    CAPTURE(deep);
    const auto slit = [&](Vec2 p) -> std::optional<double> { return p.x < 20 || p.x > 20.5 ? deep : 0; };
    const auto over = plan_ground_vehicle(Points{{0, 0}, {40, 0}}, slit, s);
    double lowest = deep;
    for (const Footing& f : over.sections()[0].footings) lowest = std::fmin(lowest, f.height);
    CHECK(std::fabs(deep - lowest - (r - std::sqrt(r * r - 0.25 * 0.25))) < 0.025);
    CHECK(over.warnings().empty());
  }
}

TEST_CASE("gaps in the ground are bridged by a wheel, or driven through at a height that is told, with a note") {
  double wide = 0.5;
  const auto gap = [&](Vec2 p) { return p.x < 20 || p.x > 20 + wide ? std::optional(100.0) : std::nullopt; };
  const Points way{{0, 0}, {40, 0}};
  const double level = plan_ground_vehicle(way, level_ground, {}).duration().seconds();
  for (const std::optional<double> below : {std::optional<double>(), std::optional(0.0)}) {
    const auto drive = plan_ground_vehicle(way, gap, {.height_without_ground = below});
    CHECK(drive.duration().seconds() < level + 0.05);
    REQUIRE(drive.warnings().size() == 1);
    CHECK(drive.warnings()[0].find("no ground at x = 20") != std::string::npos);
  }
  wide = 2;
  CHECK_THROWS_AS((void)plan_ground_vehicle(way, gap, {}), SettingError);
  const auto drive = plan_ground_vehicle(way, gap, {.height_without_ground = 95});
  CHECK(drive.duration().seconds() < level + 2);
  CHECK(drive.warnings().size() == 2);  // of the gap and of its walls
  const auto nowhere = [](Vec2) -> std::optional<double> { return std::nullopt; };
  const auto flat = plan_ground_vehicle(way, nowhere, {.height_without_ground = 3});
  CHECK(flat.warnings().empty());
  CHECK(flat.at({2, 0}).position.z == 3);
}

TEST_CASE("ground that is steeper than 45 degrees, and higher than a wheel, gets a note with its place") {
  double height = 6;
  const auto wall = [&](Vec2 p) -> std::optional<double> { return p.x < 20 ? 0 : height; };
  for (const double step : {0.01, 0.1, 1.0}) {
    CAPTURE(step);
    height = 6;
    const auto drive = plan_ground_vehicle(Points{{0, 0}, {40, 0}}, wall, {.ground_step = step});
    REQUIRE(drive.warnings().size() == 1);
    CHECK(drive.warnings()[0].find("steeper than 45 degrees") != std::string::npos);
    CHECK(drive.warnings()[0].find("steps of up to 6 m") != std::string::npos);
    CHECK(drive.duration().seconds() <
          plan_ground_vehicle(Points{{0, 0}, {40, 0}}, level_ground, {}).duration().seconds() + 1);
    height = 0.3;
    CHECK(plan_ground_vehicle(Points{{0, 0}, {40, 0}}, wall, {.ground_step = step}).warnings().empty());
  }
}

TEST_CASE("where the ground has levels, a vehicle keeps to the one that it came on") {
  const auto bridge = [](Vec2 p, double near = std::numeric_limits<double>::infinity()) -> std::optional<double> {
    const double road = 0.02 * p.x, deck = 6 + 0.05 * p.x;
    if (p.x < 45 || p.x > 55) return road;
    return std::fabs(deck - near) < std::fabs(road - near) || near > 1e300 ? deck : road;
  };
  static_assert(LevelledGround<decltype(bridge)> && !LevelledGround<decltype(level_ground)*>);
  const auto under = plan_ground_vehicle(Points{{0, 0}, {100, 0}}, bridge, {});
  CHECK(under.at(under.duration()).position.z == relative(2, 1e-9));
  for (const Footing& footing : under.sections()[0].footings) REQUIRE(footing.ahead == relative(0.02, 1e-9));
  CHECK(under.warnings().empty());
  const auto starts_at = [&](double height) {
    return plan_ground_vehicle(Points{{50, 0}, {51, 0}}, bridge, {.start_height = height}).at({}).position.z;
  };
  CHECK(starts_at(std::numeric_limits<double>::infinity()) == relative(8.5, 1e-9));
  CHECK(starts_at(7) == relative(8.5, 1e-9));
  CHECK(starts_at(1.5) == relative(1, 1e-9));
}

TEST_CASE("a drive keeps the laws of a motion, and what it was told about the ground") {
  double sea = 3;
  const auto ground = [&](Vec2 p) -> std::optional<double> { return sea + *hills(p); };
  const auto drive = plan_ground_vehicle(Points{{0, 0}, {0, 40}, {3, 0}, {30, 20}}, ground, {});
  const auto told = drive.at({4, 0}).position;
  sea = 8;
  CHECK(drive.at({4, 0}).position == told);
  std::vector<Tick> ticks;
  for (int i = -5; i < 300; ++i) ticks.push_back(Tick::of_seconds(drive.duration().seconds() * i / 290));
  CHECK(support::motion_laws(drive, ticks) == "");
}

TEST_CASE("derivatives of a drive are those of its poses, forwards and backwards, uphill and in curves") {
  const auto drive = plan_ground_vehicle(Points{{0, 0}, {0, 40}, {3, 0}, {30, 20}, {60, 20}}, hills, {});
  std::vector<Tick> ticks{{}, drive.duration(), drive.duration() + Tick{1, 0}};
  for (int i = -5; i < 1000; ++i) ticks.push_back(Tick::of_seconds(drive.duration().seconds() * i / 990));
  CHECK(support::derivative_laws(drive, ticks) == "");
  const auto still = plan_ground_vehicle(Points{{0, 0}}, hills, {});
  CHECK(support::derivative_laws(still, std::vector<Tick>{{}, {1, 0}}) == "");
}

TEST_CASE("the guards see a drive that breaks a promise") {
  const Points points{{0, 0}, {0, 40}, {30, 40}, {30, 10}};
  const GroundVehicleSettings s;
  const auto drive = plan_ground_vehicle(points, level_ground, s);
  CHECK(broken_promise(drive, s, points) == "");
  CHECK(broken_promise(drive, {.speed = 5}, points).find("speed") != std::string::npos);
  CHECK(broken_promise(drive, {.acceleration = 1.9}, points).find("acceleration") != std::string::npos);
  CHECK(broken_promise(drive, {.jerk = 1.9}, points).find("jerk") != std::string::npos);
  CHECK(broken_promise(drive, {.turn_radius = 5.6}, points).find("bends") != std::string::npos);
  CHECK(broken_promise(drive, s, {{0, 0}, {1, 1}}).find("arrive") != std::string::npos);
  CHECK(farthest_wheel(drive, s, hills, 100) > 0.02);
}

TEST_CASE("where there is no ground the waypoint is named") {
  const auto island = [](Vec2 p) { return length(p) < 50 ? std::optional(1.0) : std::nullopt; };
  CHECK_NOTHROW((void)plan_ground_vehicle(Points{{0, 0}, {40, 0}}, island, {}));
  try {
    (void)plan_ground_vehicle(Points{{0, 0}, {20, 0}, {20, 0}, {20, 70}}, island, {});
    FAIL("there is no ground on the way");
  } catch (const SettingError& error) {
    CHECK(error.field().find("waypoints[3]") != std::string::npos);
  }
  const auto broken = [](Vec2) -> std::optional<double> { return std::numeric_limits<double>::quiet_NaN(); };
  CHECK_THROWS_AS((void)plan_ground_vehicle(Points{{0, 0}}, broken, {}), SettingError);
}

TEST_CASE("a drive that cannot be is refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const Points points{{0, 0}, {9, 0}};
  CHECK_THROWS_AS((void)plan_ground_vehicle(Points{}, level_ground, {}), SettingError);
  CHECK_THROWS_AS((void)plan_ground_vehicle(Points{{0, nan}}, level_ground, {}), SettingError);
  CHECK_THROWS_AS((void)plan_ground_vehicle(Points{{0, 0}, {infinite, 0}}, level_ground, {}), SettingError);
  CHECK_THROWS_AS((void)plan_ground_vehicle(points, level_ground, {.height_without_ground = nan}), SettingError);
  for (const double bad : {0.0, -1.0, nan, infinite, 1e-300, 1e300}) {
    CAPTURE(bad);
    CHECK_THROWS_AS((void)plan_ground_vehicle(points, level_ground, {.speed = bad}), SettingError);
    CHECK_THROWS_AS((void)plan_ground_vehicle(points, level_ground, {.acceleration = bad}), SettingError);
    CHECK_THROWS_AS((void)plan_ground_vehicle(points, level_ground, {.jerk = bad}), SettingError);
    CHECK_THROWS_AS((void)plan_ground_vehicle(points, level_ground, {.turn_radius = bad}), SettingError);
    CHECK_THROWS_AS((void)plan_ground_vehicle(points, level_ground, {.wheelbase = bad}), SettingError);
    CHECK_THROWS_AS((void)plan_ground_vehicle(points, level_ground, {.track = bad}), SettingError);
    CHECK_THROWS_AS((void)plan_ground_vehicle(points, level_ground, {.ground_step = bad}), SettingError);
    CHECK_THROWS_AS((void)plan_ground_vehicle(points, level_ground, {.wheel_radius = bad}), SettingError);
  }
}
