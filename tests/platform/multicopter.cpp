// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/multicopter.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(Trajectory<MulticopterFlight>);
using support::Generator;
using support::relative;
using support::detail::sentence;

namespace {

using Points = std::vector<FlightPoint>;

double cosine(const Rotation& a, const Rotation& b) { return std::fabs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z); }

/// The first promise that a flight does not keep; empty if it keeps all. In each piece at its ends and in between, from
/// the piece itself; `grain` is how exactly a place can be told where the flight goes [m].
std::string broken_promise(const MulticopterFlight& flight, const MulticopterSettings& s, const Points& points,
                           double grain = 1e-9) {
  const double more = 1 + 1e-9;
  const auto& pieces = flight.motion().pieces();
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const auto& [start, piece] = pieces[k];
    for (int i = 0; i <= 8; ++i) {
      const auto state = piece.after(piece.duration * i / 8);
      const Vec3 a = state.acceleration;
      if (!finite(state.position) || !finite(a)) return sentence("piece ", k, " is not finite");
      if (!(length(state.velocity) <= s.speed * more))
        return sentence("piece ", k, " has a speed of ", length(state.velocity));
      if (!(length(a) <= s.acceleration * more)) return sentence("piece ", k, " has an acceleration of ", length(a));
      if (!(length(state.jerk) <= s.jerk * more)) return sentence("piece ", k, " has a jerk of ", length(state.jerk));
      const double bank = std::atan2(std::hypot(a.x, a.y), a.z + standard_gravity);
      if (!(bank <= s.bank_max * more)) return sentence("piece ", k, " has a bank of ", bank);
    }
    if (k + 1 == pieces.size()) break;
    const auto end = piece.after(piece.duration), next = pieces[k + 1].piece.after(0);
    const double gap = length(next.position - end.position);
    if (!(gap <= grain)) return sentence("a gap of ", gap, " m behind piece ", k);
    if (!(length(next.velocity - end.velocity) <= 1e-9 * s.speed)) return sentence("the speed jumps behind piece ", k);
    if (!(length(next.acceleration - end.acceleration) <= 1e-9 * s.acceleration))
      return sentence("the acceleration jumps behind piece ", k);
  }
  const auto& turns = flight.heading().pieces();
  for (std::size_t k = 0; k < turns.size(); ++k) {
    if (!(std::fabs(turns[k].piece.velocity) <= s.yaw_rate * more))
      return sentence("the yaw rate of turn ", k, " is too high");
    const Tick t = turns[k].start;
    if (k > 0 &&
        !(std::fabs(turns[k].piece.position -
                    turns[k - 1]
                        .piece.after(std::fmin(turns[k - 1].piece.duration, t.seconds() - turns[k - 1].start.seconds()))
                        .position) < 1e-6))
      return sentence("the heading jumps at turn ", k);
  }
  const auto end = flight.motion().at(flight.duration());
  if (!(length(flight.at({}).position - points.front().position) <= 1e-9))
    return "it does not begin at the first waypoint";
  if (!(length(end.position - points.back().position) <= 1e-9)) return "it does not arrive at the last waypoint";
  if (length(end.velocity) != 0 || length(end.acceleration) != 0) return "it does not arrive at rest";
  return {};
}

MulticopterSettings random_settings(Generator& random) {
  MulticopterSettings s{.speed = random.log_uniform(0.1, 50),
                        .acceleration = random.log_uniform(0.1, 30),
                        .jerk = random.log_uniform(0.1, 100),
                        .bank_max = random.log_uniform(2_deg, 80_deg),
                        .yaw_rate = random.log_uniform(0.05, 5),
                        .turn = random.coin() ? MulticopterTurn::smooth : MulticopterTurn::stop_and_turn,
                        .turn_distance = random.log_uniform(0.01, 100)};
  if (random.coin()) s.departure_heading = random.uniform(-2 * pi, 2 * pi);
  if (random.coin()) s.arrival_heading = random.uniform(-2 * pi, 2 * pi);
  return s;
}

}  // namespace

TEST_CASE("a straight flight takes L / v + v / a + a / j and leans into its acceleration") {
  const MulticopterSettings s{.speed = 5, .acceleration = 2, .jerk = 4};
  const auto flight = plan_multicopter(Points{{{0, 0, 30}}, {{0, 100, 30}}}, s);
  CHECK(flight.duration().seconds() == relative(100 / 5.0 + 5 / 2.0 + 2 / 4.0, 1e-14));
  CHECK(flight.at({0, 0}).position == Vec3{0, 0, 30});
  CHECK(flight.at(flight.duration()).position == Vec3{0, 100, 30});
  const Vec3 thrust = flight.at({1, 0}).direction(axis::up);  // full acceleration
  CHECK(std::atan2(thrust.y, thrust.z) == relative(std::atan(2 / standard_gravity), 1e-14));
  CHECK(length(flight.at({10, 0}).direction(axis::up) - axis::up) < 1e-15);  // steady
  CHECK(flight.at(flight.duration()).direction(axis::forward) == axis::forward);
  CHECK(flight.at({21, 0}).direction(axis::up).y < -0.1);  // braking
}

TEST_CASE("where it stops and turns it flies straight legs and looks along them") {
  const MulticopterSettings s{.yaw_rate = 30_deg, .turn = MulticopterTurn::stop_and_turn};
  const auto flight = plan_multicopter(Points{{{0, 0, 9}}, {{0, 40, 9}}, {{30, 40, 9}}}, s);
  const double leg_1 = 40 / 8.0 + 8 / 3.0 + 3 / 6.0, leg_2 = 30 / 8.0 + 8 / 3.0 + 3 / 6.0, turn = 3;
  CHECK(flight.duration().seconds() == relative(leg_1 + turn + leg_2, 1e-14));
  for (double t = 0; t < flight.duration().seconds(); t += 0.1) {
    const Vec3 p = flight.at(Tick::of_seconds(t)).position;
    CHECK((std::fabs(p.x) < 1e-12 || std::fabs(p.y - 40) < 1e-12));
  }
  const auto half = flight.at(Tick::of_seconds(leg_1 + turn / 2));
  CHECK(length(half.position - Vec3{0, 40, 9}) < 1e-12);
  CHECK(length(half.direction(axis::forward) - Vec3{std::sqrt(0.5), std::sqrt(0.5), 0}) < 1e-12);
}

TEST_CASE("it hovers as long as it is told, and turning counts") {
  const MulticopterSettings s{.yaw_rate = 30_deg};
  const auto time = [&](double hover) {
    return plan_multicopter(Points{{{0, 0, 9}}, {{0, 40, 9}, hover}, {{30, 40, 9}, 1}}, s).duration().seconds();
  };
  CHECK(time(10) - time(4) == relative(6, 1e-12));
  CHECK(time(2) == relative(time(3), 1e-12));
  CHECK(time(0) < time(3) - 2);
}

TEST_CASE("in a smooth turn the bank follows from speed and radius: tan(bank) = v^2 / (g r)") {
  const MulticopterSettings s{.speed = 6, .acceleration = 4, .jerk = 8, .bank_max = 60_deg};
  const auto flight = plan_multicopter(Points{{{0, 0, 50}}, {{0, 100, 50}}, {{60, 180, 50}}}, s);
  int asked = 0;
  for (double t = 0; t < flight.duration().seconds(); t += 0.01) {
    const auto at = [&](double offset) { return flight.at(Tick::of_seconds(t + offset)); };
    // Source: the circle through three points has the radius abc / 4A
    const Vec3 a = at(-0.02).position, b = at(0).position, c = at(0.02).position;
    const double twice_area = length(cross(b - a, c - a)), speed = length(c - a) / 0.04;
    const double radius = length(b - a) * length(c - b) * length(c - a) / (2 * twice_area);
    if (!(radius < 60)) continue;
    const Vec3 way = normalize(c - a), aside = cross(way, axis::up), thrust = at(0).direction(axis::up);
    const double bank = dot(thrust, aside) / thrust.z;  // to the right
    CHECK(std::fabs(bank - speed * speed / (standard_gravity * radius)) < 3e-3);
    ++asked;
  }
  CHECK(asked > 50);
}

TEST_CASE("a smooth turn begins and ends on its legs, as far from the waypoint as it may, and never speeds up") {
  const MulticopterSettings s{.turn_distance = 5};
  const auto flight = plan_multicopter(Points{{{0, 0, 9}}, {{0, 100, 9}}, {{100, 100, 9}}}, s);
  double nearest = 1e9;
  for (double t = 0; t < flight.duration().seconds(); t += 0.01) {
    const Vec3 p = flight.at(Tick::of_seconds(t)).position;
    nearest = std::fmin(nearest, length(p - Vec3{0, 100, 9}));
    if (p.x > 1e-9) CHECK(p.y >= 95 - 1e-9);
    if (p.y < 100 - 1e-9) CHECK(p.x <= 5 + 1e-9);
  }
  CHECK(nearest > 0.5);
  CHECK(nearest < 5 / std::sqrt(2.0));
  CHECK(flight.duration().seconds() <
        plan_multicopter(Points{{{0, 0, 9}}, {{0, 100, 9}, 1e-9}, {{100, 100, 9}}}, s).duration().seconds());
}

TEST_CASE("it departs and arrives with the headings that are wished, and turns the shorter way") {
  const MulticopterSettings s{.yaw_rate = 0.5, .departure_heading = 350_deg, .arrival_heading = -20_deg};
  const auto flight = plan_multicopter(Points{{{5, 5, 9}}, {{15, 5, 9}}}, s);
  CHECK(length(flight.at({}).direction(axis::forward) - Vec3{std::sin(-10_deg), std::cos(-10_deg), 0}) < 1e-14);
  CHECK(length(flight.at(flight.duration()).direction(axis::forward) - Vec3{std::sin(-20_deg), std::cos(-20_deg), 0}) <
        1e-14);
  const auto plain = plan_multicopter(Points{{{5, 5, 9}}, {{15, 5, 9}}}, {});
  CHECK(flight.duration().seconds() - plain.duration().seconds() == relative((100_deg + 110_deg) / 0.5, 1e-12));
}

TEST_CASE("a vertical flight is level and keeps the heading") {
  const auto flight = plan_multicopter(Points{{{5, 5, 0}}, {{5, 5, 40}}, {{25, 5, 40}}, {{25, 5, 0}}}, {});
  CHECK(length(flight.at({}).direction(axis::forward) - axis::right) < 1e-14);  // it rises as it will fly on
  CHECK(length(flight.at({1, 0}).direction(axis::up) - axis::up) < 1e-14);
  CHECK(length(flight.at(flight.duration()).direction(axis::forward) - axis::right) < 1e-14);
}

TEST_CASE("however fast it may sink, it keeps a tenth of its weight on its rotors and does not topple") {
  const MulticopterSettings s{.speed = 50, .acceleration = 30, .jerk = 100};
  const auto flight = plan_multicopter(Points{{{0, 0, 200}}, {{0, 0, 0}}}, s);
  double least = 0;
  for (const auto& [start, piece] : flight.motion().pieces()) least = std::fmin(least, piece.acceleration.z);
  CHECK(least == relative(-0.9 * standard_gravity, 1e-9));
  for (double t = 0; t < flight.duration().seconds(); t += 0.01)
    CHECK(flight.at(Tick::of_seconds(t)).direction(axis::up) == axis::up);
}

TEST_CASE("flights over random waypoints keep all limits, have no gaps, and arrive") {
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const MulticopterSettings s = random_settings(random);
    Points points(1 + random.whole(12));
    const double reach = random.log_uniform(0.01, 1e4);
    for (auto& p : points) {
      p.position = random.point(reach);
      if (random.whole(4) == 0) p.hover = random.log_uniform(0.01, 10);
      if (random.whole(8) == 0) p.position = points[0].position;
    }
    const auto flight = plan_multicopter(points, s);
    CHECK(broken_promise(flight, s, points) == "");
  }
}

TEST_CASE("finite differences of the poses themselves keep the limits, and no attitude jumps") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const MulticopterSettings s{.turn = seed % 2 == 0 ? MulticopterTurn::smooth : MulticopterTurn::stop_and_turn};
    Points points(6);
    for (auto& p : points) p.position = random.point(60);
    const auto flight = plan_multicopter(points, s);
    const double h =
        1e-3;  // differences of a millisecond are exact to 1e-14 / h^2 in acceleration, 1e-14 / h^3 in jerk
    double most = 0, fastest = 0, turned = 1;
    for (double t = 2 * h; t < flight.duration().seconds(); t += 37 * h) {
      const auto at = [&](double i) { return flight.at(Tick::of_seconds(t + i * h)); };
      fastest = std::fmax(fastest, length(at(1).position - at(-1).position) / (2 * h));
      most = std::fmax(most, length(at(1).position - 2.0 * at(0).position + at(-1).position) / (h * h));
      turned = std::fmin(turned, cosine(at(0).rotation, at(1).rotation));
    }
    CHECK(fastest <= s.speed * (1 + 1e-6));
    CHECK(most <= s.acceleration * (1 + 1e-6));
    // half of the angle that yaw, and a lean of at most jerk / g a second, can turn in a millisecond
    CHECK(std::acos(std::fmin(turned, 1.0)) <= 0.5 * h * (s.yaw_rate + s.jerk / standard_gravity) * 1.05);
  }
}

TEST_CASE("a flight says when it passes each waypoint, also one that stands twice in the list") {
  const Points points{{{0, 0, 40}},  {{60, 0, 40}},  {{60, 0, 40}}, {{60, 80, 40}, 3},
                      {{60, 0, 45}}, {{160, 0, 45}}, {{260, 0, 45}}};
  for (const auto turn : {MulticopterTurn::smooth, MulticopterTurn::stop_and_turn}) {
    const MulticopterFlight flight = plan_multicopter(points, {.turn = turn});
    REQUIRE(flight.passes().size() == points.size());
    CHECK(flight.passes()[1] == flight.passes()[2]);
    for (std::size_t k = 0; k < points.size(); ++k) {
      CAPTURE(k);
      const auto miss = [&](double later) {
        return length(flight.at(Tick::of_seconds(flight.passes()[k].seconds() + later)).position - points[k].position);
      };
      CHECK(miss(0) < (turn == MulticopterTurn::smooth && (k == 1 || k == 2 || k == 4) ? 4 : 1e-6));
      CHECK(miss(0) <= miss(-0.01) + 1e-9);
      CHECK(miss(0) <= miss(0.01) + 1e-9);
    }
  }
}

TEST_CASE("no list of waypoints is too odd for a flight") {
  MulticopterSettings s;
  for (const auto turn : {MulticopterTurn::smooth, MulticopterTurn::stop_and_turn}) {
    s.turn = turn;
    const auto keeps = [&](const Points& points, double grain = 1e-9) {
      return broken_promise(plan_multicopter(points, s), s, points, grain);
    };
    CHECK(keeps({{{1, 2, 3}}}) == "");
    CHECK(keeps({{{1, 2, 3}}, {{1, 2, 3}}, {{1, 2, 3}}}) == "");
    CHECK(keeps({{{0, 0, 0}}, {{0, 9, 0}}, {{0, 9, 0}}, {{0, 18, 0}}}) == "");
    CHECK(keeps({{{0, 0, 0}}, {{0, 9, 0}}, {{0, 0, 0}}, {{0, 9, 0}}}) == "");
    CHECK(keeps({{{0, 0, 0}}, {{0, 0, 9}}, {{0, 0, -9}}}) == "");
    CHECK(keeps({{{0, 0, 0}}, {{1e-3, 0, 0}}, {{1e-3, 1e-3, 0}}, {{0, 0, 1e-3}}}) == "");
    CHECK(keeps({{{0, 0, 0}}, {{1e-8, 0, 0}}, {{0, 1e-8, 1e-8}}}) == "");
    CHECK(keeps({{{0, 0, 0}}, {{1e-300, 0, 0}}, {{0, 1e-300, 0}}}) == "");
    CHECK(keeps({{{0, 0, 0}}, {{0, 100, 0}}, {{1e-9, 200, 0}}, {{1e-9, 200, 100}}}) == "");
    CHECK(keeps({{{500000, 5400000, 300}}, {{500001, 5400000, 300}}, {{500001, 5400000.001, 300}}}, 2e-9) == "");
    CHECK(keeps({{{-1e9, 1e9, 1e9}}, {{1e9, 1e9, -1e9}}, {{0, 0, 0}}}, 1e-6) == "");
  }
}

TEST_CASE("ten thousand waypoints are planned, be they in a row, in a circle, or anywhere") {
  Generator random(7);
  Points row(10000), circle(10000), anywhere(10000);
  for (std::size_t k = 0; k < row.size(); ++k) {
    const double i = static_cast<double>(k);
    row[k].position = {1e-3 * i, 0, 0};
    circle[k].position = {20 * std::cos(0.01 * i), 20 * std::sin(0.01 * i), 1e-3 * i};
    anywhere[k].position = random.point(1000);
  }
  for (const Points* points : {&row, &circle, &anywhere})
    CHECK(broken_promise(plan_multicopter(*points, {}), {}, *points) == "");
}

TEST_CASE("a flight keeps the laws of a motion") {
  Generator random(3);
  Points points(8);
  for (auto& p : points) p.position = random.point(50);
  const auto flight = plan_multicopter(points, {});
  std::vector<Tick> ticks;
  for (int i = -5; i < 300; ++i) ticks.push_back(Tick::of_seconds(flight.duration().seconds() * i / 290));
  CHECK(support::motion_laws(flight, ticks) == "");
}

TEST_CASE("derivatives of a flight are those of its poses") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    Points points(6);
    for (auto& p : points) p = {random.point(30), random.coin() ? 0.0 : 1.0};
    const auto flight = plan_multicopter(points, {.departure_heading = 2.0, .arrival_heading = 1.0});
    std::vector<Tick> ticks{{}, flight.duration(), flight.duration() + Tick{1, 0}};
    for (int i = -5; i < 300; ++i) ticks.push_back(Tick::of_seconds(flight.duration().seconds() * i / 290));
    CHECK(support::derivative_laws(flight, ticks) == "");
  }
}

TEST_CASE("the guard sees a flight that breaks a limit") {
  const Points points{{{0, 0, 9}}, {{0, 100, 9}}, {{100, 100, 9}}};
  const auto flight = plan_multicopter(points, {});
  CHECK(broken_promise(flight, {.speed = 7.9}, points).find("speed") != std::string::npos);
  CHECK(broken_promise(flight, {.acceleration = 2.9}, points).find("acceleration") != std::string::npos);
  CHECK(broken_promise(flight, {.jerk = 5.9}, points).find("jerk") != std::string::npos);
  CHECK(broken_promise(flight, {.bank_max = 0.29}, points).find("bank") != std::string::npos);
  CHECK(broken_promise(flight, {.yaw_rate = 0.1}, points).find("yaw rate") != std::string::npos);
  CHECK(broken_promise(flight, {}, {{{0, 0, 9}}, {{1, 100, 9}}}).find("arrive") != std::string::npos);
}

TEST_CASE("a flight that cannot be is refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const Points points{{{0, 0, 0}}, {{1, 0, 0}}};
  CHECK_THROWS_AS((void)plan_multicopter(Points{}, {}), SettingError);
  CHECK_THROWS_WITH_AS((void)plan_multicopter(Points{{{0, 0, 0}}, {{0, nan, 0}}}, {}),
                       "plan_multicopter: waypoints[1].position.y is nan m, but must be from -1e+09 to 1e+09",
                       SettingError);
  CHECK_THROWS_AS((void)plan_multicopter(Points{{{0, 0, infinite}}}, {}), SettingError);
  CHECK_THROWS_AS((void)plan_multicopter(Points{{{1e300, 0, 0}}}, {}), SettingError);
  CHECK_THROWS_AS((void)plan_multicopter(Points{{{0, 0, 0}, -1}}, {}), SettingError);
  for (const double bad : {0.0, -1.0, nan, infinite, 1e-300, 1e300}) {
    CAPTURE(bad);
    CHECK_THROWS_AS((void)plan_multicopter(points, {.speed = bad}), SettingError);
    CHECK_THROWS_AS((void)plan_multicopter(points, {.acceleration = bad}), SettingError);
    CHECK_THROWS_AS((void)plan_multicopter(points, {.jerk = bad}), SettingError);
    CHECK_THROWS_AS((void)plan_multicopter(points, {.bank_max = bad}), SettingError);
    CHECK_THROWS_AS((void)plan_multicopter(points, {.yaw_rate = bad}), SettingError);
    CHECK_THROWS_AS((void)plan_multicopter(points, {.turn_distance = bad}), SettingError);
  }
  CHECK_THROWS_AS((void)plan_multicopter(points, {.departure_heading = nan}), SettingError);
  CHECK_THROWS_AS((void)plan_multicopter(points, {.arrival_heading = infinite}), SettingError);
}
