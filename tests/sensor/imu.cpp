// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/sensor/imu.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/platform/ground_vehicle.hpp>
#include <pulsecast/platform/multicopter.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/platform/waypoints.hpp>

#include "support/allocations.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/refused_field.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using support::relative;

namespace {

using BodyPose = Pose<frame::Body, frame::World>;
constexpr double g = standard_gravity;

/// Circle to the left, looking along it.
struct Circle {
  using refinements = refines<tag::Differentiable>;
  double radius = 8, rate = 0.7;
  BodyPose at(Tick t) const noexcept {
    const double angle = rate * t.seconds();
    return {rotation_about(axis::up, angle), {radius * std::cos(angle), radius * std::sin(angle), 0}};
  }
  Derivatives derivatives(Tick t) const noexcept {
    const double angle = rate * t.seconds();
    const Vec3 out{std::cos(angle), std::sin(angle), 0}, along{-out.y, out.x, 0};
    return {radius * rate * along, -radius * rate * rate * out, rate * axis::up, {}};
  }
};

/// The same for a path without derivatives.
template <class Path>
struct PosesOnly {
  Path path;
  BodyPose at(Tick t) const noexcept { return path.at(t); }
};

/// Gauss-Legendre quadrature of a vector, 5 points, in n panels.
Vec3 integral(double from, double to, int n, const auto& f) {
  constexpr std::array<double, 5> x{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                    0.9061798459386640};
  constexpr std::array<double, 5> w{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                    0.2369268850561891};
  Vec3 sum{};
  const double half = 0.5 * (to - from) / n;
  for (int panel = 0; panel < n; ++panel)
    for (std::size_t k = 0; k < 5; ++k) sum += half * w[k] * f(from + (2 * panel + 1 + x[k]) * half);
  return sum;
}

/// Clothoid to the left from north, at constant speed: its curvature grows with the way. Positions are Fresnel's
/// integrals.
struct Clothoid {
  double speed = 6, growth = 0.01;
  double heading(double s) const noexcept { return 0.5 * growth * speed * speed * s * s; }
  double turn(double s) const noexcept { return growth * speed * speed * s; }
  Vec3 velocity(double s) const noexcept { return {-speed * std::sin(heading(s)), speed * std::cos(heading(s)), 0}; }
  BodyPose at(Tick t) const noexcept {
    const double s = t.seconds();
    return {rotation_about(axis::up, heading(s)), integral(0, s, 40, [&](double u) { return velocity(u); })};
  }
};

/// The same with derivatives.
struct KnownClothoid : Clothoid {
  BodyPose at(Tick t) const noexcept { return Clothoid::at(t); }
  Derivatives derivatives(Tick t) const noexcept {
    const double s = t.seconds();
    const Vec3 v = velocity(s);
    return {v, turn(s) * cross(axis::up, v), turn(s) * axis::up, growth * speed * speed * axis::up};
  }
};

/// Smooth motion that turns about all axes.
struct Tumbling {
  BodyPose at(Tick t) const noexcept {
    const double s = t.seconds();
    return {rotation_about({1, 2, 3}, 0.8 * std::sin(1.1 * s)) * rotation_about(axis::right, 0.5 * std::sin(2.3 * s)),
            {20 * std::sin(0.2 * s), 15 * std::cos(0.3 * s), 2 * std::sin(s)}};
  }
};

/// Slalom along a rising way, with a heading that swings.
struct Slalom {
  BodyPose at(Tick t) const noexcept {
    const double s = t.seconds();
    return {level(0.6 * std::sin(0.9 * s)),
            {5 * std::sin(0.5 * s), 4 * s + std::cos(0.8 * s), 0.3 * std::sin(0.4 * s)}};
  }
};

/// The navigator that the documentation of `ImuSample` names, and the trapezoidal rule. Map and earth as stated.
struct Navigator {
  Rotation attitude = no_rotation;
  Vec3 velocity{}, position{};
  Earth earth{};

  template <class Path>
  static Navigator begin(const Imu<Path>& imu, Tick t) {
    const auto pose = imu.instrument_at(t);
    return {pose.rotation, imu.derivatives_at(t).velocity, pose.position, imu.settings().earth};
  }
  void step(const Vec3& angle, const Vec3& change, double interval) {
    const Vec3 turning = earth.map_rate(), before = velocity;
    const Rotation back = rotation_by(-interval * turning);  // the map turns under what does not
    velocity += attitude * change - interval * earth.gravity * (rotation_by(0.5 * interval * turning) * axis::up);
    velocity = back * (velocity - 0.5 * interval * cross(turning, before + velocity));
    position += 0.5 * interval * (before + velocity);
    attitude = normalize(back * attitude * rotation_by(angle));
  }
};

/// Largest errors of position [m] and attitude [rad] of 60 s of increments from a time on.
template <class Path>
Vec2 errors_of_increments(const Imu<Path>& imu, PulseIndex first = 0) {
  Navigator at = Navigator::begin(imu, Tick::of(first, imu.settings().sample_rate));
  Vec2 worst{};
  for (PulseIndex i = first; i < first + static_cast<PulseIndex>(60 * imu.settings().sample_rate); ++i) {
    const ImuSample s = imu.sample(i);
    at.step(s.angle_increment, s.velocity_increment, s.interval);
    const auto pose = imu.instrument_at(s.tick);
    worst.x = std::max(worst.x, length(at.position - pose.position));
    worst.y = std::max(worst.y, length(rotation_vector(conjugate(at.attitude) * pose.rotation)));
  }
  return worst;
}

/// The same of rates: their mean at both ends of each interval.
template <class Path>
Vec2 errors_of_rates(const Imu<Path>& imu) {
  Navigator at = Navigator::begin(imu, Tick::of(1, imu.settings().sample_rate));
  Vec2 worst{};
  ImuSample before = imu.sample(0);
  for (PulseIndex i = 1; i < 60 * 400; ++i) {
    const ImuSample s = imu.sample(i);
    const Vec3 angle = 0.5 * s.interval * (before.angular_rate + s.angular_rate);
    const Vec3 change = 0.5 * s.interval * (before.specific_force + rotation_by(angle) * s.specific_force);
    at.step(angle, change, s.interval);
    before = s;
    const auto pose = imu.instrument_at(s.tick);
    worst.x = std::max(worst.x, length(at.position - pose.position));
    worst.y = std::max(worst.y, length(rotation_vector(conjugate(at.attitude) * pose.rotation)));
  }
  return worst;
}

std::optional<double> hills(Vec2 p) { return 1.2 * std::sin(p.x / 10) * std::cos(p.y / 13); }

const Mount tilted{.lever_arm = {0.4, -0.3, 1.1}, .boresight = rotation_about({1, -2, 0.5}, 25_deg)};

bool same(const ImuSample& a, const ImuSample& b) {
  using support::detail::same;
  return same(a.tick, b.tick) && same(a.interval, b.interval) && same(a.angle_increment, b.angle_increment) &&
         same(a.velocity_increment, b.velocity_increment) && same(a.angular_rate, b.angular_rate) &&
         same(a.specific_force, b.specific_force);
}

}  // namespace

// ---------------------------------------------------------------------------------------- closed forms

TEST_CASE("at rest it feels what carries it, along its own axes") {
  for (const Rotation& boresight : {no_rotation, rotation_about({3, 1, -2}, 130_deg)}) {
    const Imu imu{Tripod{.position = {1e5, -2e5, 300}}, Mount{.lever_arm = {1, 2, 3}, .boresight = boresight}};
    for (const PulseIndex i : {PulseIndex{0}, PulseIndex{7}, PulseIndex{400} * 31557600}) {
      const ImuSample s = imu.sample(i);
      const Vec3 up = conjugate(boresight) * axis::up;
      CHECK(length(s.specific_force - g * up) < 1e-9 * g);
      CHECK(length(s.velocity_increment - g / 400 * up) < 1e-9 * g / 400);
      CHECK(s.angular_rate == Vec3{});
      CHECK(length(s.angle_increment) < 1e-18);
      CHECK(s.interval == 1.0 / 400);
      CHECK(s.tick == Tick::of(i + 1, 400));
    }
  }
}

TEST_CASE("in a circle of constant speed it feels v w to the inside, and turns by w") {
  const Circle circle{};
  const double v = circle.radius * circle.rate, angle = circle.rate / 100;
  const Vec3 change = v * Vec3{-std::sin(angle), std::cos(angle) - 1, 0} + g / 100 * axis::up;
  const auto check = [&](const auto& imu) {
    for (const PulseIndex i : {PulseIndex{0}, PulseIndex{1}, PulseIndex{1234}}) {
      const ImuSample s = imu.sample(i);
      CHECK(length(s.angle_increment - angle * axis::up) < 1e-9 * angle);
      CHECK(length(s.velocity_increment - change) < 1e-9 * length(change));
      CHECK(length(s.angular_rate - circle.rate * axis::up) < 1e-9 * circle.rate);
      CHECK(length(s.specific_force - Vec3{-v * circle.rate, 0, g}) < 1e-9 * g);
    }
  };
  check(Imu{circle, Mount{}, {.sample_rate = 100}});
  check(Imu{PosesOnly<Circle>{circle}, Mount{}, {.sample_rate = 100}});
}

TEST_CASE("on a clothoid its turn grows with the way, and increments are the integrals of what it feels") {
  const auto check = [](const auto& imu) {
    const Clothoid path{};
    for (const PulseIndex i : {PulseIndex{0}, PulseIndex{1}, PulseIndex{500}}) {
      const ImuSample s = imu.sample(i);
      const double end = s.tick.seconds(), begin = end - 0.01, turned = path.heading(end) - path.heading(begin);
      CHECK(length(s.angle_increment - turned * axis::up) < 1e-9 * turned + 1e-15);
      CHECK(length(s.angular_rate - path.turn(end) * axis::up) < 1e-9 * path.turn(end));
      CHECK(length(s.specific_force - Vec3{-path.speed * path.turn(end), 0, g}) < 1e-9 * g);
      const Vec3 felt = integral(begin, end, 4, [&](double u) {
        const double way = path.heading(u) - path.heading(begin), pull = path.speed * path.turn(u);
        return Vec3{-pull * std::cos(way), -pull * std::sin(way), g};
      });
      CHECK(length(s.velocity_increment - felt) < 1e-9 * length(felt));
    }
  };
  check(Imu{KnownClothoid{}, Mount{}, {.sample_rate = 100}});
  check(Imu{PosesOnly<Clothoid>{}, Mount{}, {.sample_rate = 100}});
}

TEST_CASE("a corner is an impulse in the increment of its interval, and in no rate") {
  const std::vector<TimedPose> points{{0, {}}, {1.001, {0, 10.01, 0}}, {2.002, {20.02, 10.01, 0}}};
  const Imu imu{Waypoints(points), Mount{}};
  for (PulseIndex i = 0; i < 800; ++i) {
    const ImuSample s = imu.sample(i);
    const Vec3 jump = i == 400 ? Vec3{20, -10, 0} : Vec3{};  // from 1 s on
    CHECK(length(s.velocity_increment - jump - g / 400 * axis::up) < 1e-9 * (length(jump) + g / 400));
    CHECK(length(s.specific_force - g * axis::up) < 1e-9 * g);
  }
  const StraightLine line{.from = {}, .to = {0, 10, 0}, .speed = 8};
  const Imu stops{line, Mount{}, {.sample_rate = 100}};
  CHECK(length(stops.sample(124).velocity_increment - Vec3{0, -8, g / 100}) < 1e-9);  // at its end, a tick
  CHECK(length(stops.sample(123).velocity_increment - Vec3{0, 0, g / 100}) < 1e-9);
  CHECK(stops.sample(124).specific_force == Vec3{0, 0, g});
}

TEST_CASE("a lever arm feels centripetal and Euler acceleration") {
  struct Swinging {
    BodyPose at(Tick t) const noexcept {
      return {rotation_about(axis::up, 0.3 * std::sin(2 * t.seconds())), {5, 6, 7}};
    }
  };
  const Imu imu{Swinging{}, Mount{.lever_arm = {0, 2, 0}}};
  for (const PulseIndex i : {PulseIndex{1}, PulseIndex{333}}) {
    const ImuSample s = imu.sample(i);
    const double t = s.tick.seconds(), rate = 0.6 * std::cos(2 * t), change = -1.2 * std::sin(2 * t);
    CHECK(length(s.specific_force - Vec3{-2 * change, -2 * rate * rate, g}) < 1e-9 * g);
    const double angle = 0.3 * (std::sin(2 * t) - std::sin(2 * (t - 1.0 / 400)));
    CHECK(length(s.angle_increment - angle * axis::up) < 1e-9 * std::fabs(angle));
    const double before = 0.6 * std::cos(2 * (t - 1.0 / 400));  // velocity along -x times 2 m
    const Vec3 dv = 2.0 * Vec3{-rate * std::cos(angle) + before, -rate * std::sin(angle), 0} + g / 400 * axis::up;
    CHECK(length(s.velocity_increment - dv) < 1e-9 * length(dv));
  }
}

TEST_CASE("a boresight turns all that is measured, and changes nothing else") {
  const Mount straight{.lever_arm = tilted.lever_arm};
  const Imu a{Tumbling{}, straight}, b{Tumbling{}, tilted};
  const Rotation back = conjugate(tilted.boresight);
  for (PulseIndex i = 0; i < 1000; i += 99) {
    const ImuSample s = a.sample(i), t = b.sample(i);
    CHECK(length(t.angle_increment - back * s.angle_increment) < 1e-9 * length(s.angle_increment));
    CHECK(length(t.velocity_increment - back * s.velocity_increment) < 1e-9 * length(s.velocity_increment));
    CHECK(length(t.angular_rate - back * s.angular_rate) < 1e-9 * length(s.angular_rate));
    CHECK(length(t.specific_force - back * s.specific_force) < 1e-9 * g);
  }
}

TEST_CASE("the earth turns about its axis, and pushes what moves north of the equator to the right") {
  const Earth earth = wgs84_earth(48_deg, 500);
  const double rate = 7.292115e-5, c = rate * std::cos(48_deg), s = rate * std::sin(48_deg);
  const Imu still{Tripod{}, Mount{}, {.earth = earth}};
  CHECK(length(still.sample(5).angular_rate - Vec3{0, c, s}) < 1e-9 * rate);
  CHECK(length(still.sample(5).angle_increment - Vec3{0, c, s} / 400.0) < 1e-9 * rate / 400);
  CHECK(length(still.sample(5).specific_force - earth.gravity * axis::up) < 1e-9 * g);
  const Imu north{StraightLine{.to = {0, 1e5, 0}, .speed = 30}, Mount{}, {.earth = earth}};
  const Vec3 held{-2 * s * 30, 0, earth.gravity};  // to the left, against the push to the right
  CHECK(length(north.sample(5).specific_force - held) < 1e-9 * g);
  CHECK(length(north.sample(5).velocity_increment - held / 400.0) < 1e-6 * g / 400);
}

TEST_CASE("normal gravity is that of WGS 84") {
  // source: NIMA TR8350.2, table 3.4, theoretical gravity at the equator and the poles
  CHECK(wgs84_earth(0).gravity == relative(9.7803253359, 1e-12));
  CHECK(wgs84_earth(90_deg).gravity == relative(9.8321849378, 1e-10));
  CHECK(wgs84_earth(-90_deg).gravity == relative(9.8321849378, 1e-10));
  // free-air gradient, 0.3086 mGal/m. Source: Torge 2001, Geodesy, sec. 4.2.2
  CHECK((wgs84_earth(45_deg).gravity - wgs84_earth(45_deg, 1000).gravity) / 1000 == relative(3.086e-6, 1e-3));
}

// ------------------------------------------------------------------------------- strapdown navigation

TEST_CASE("increments, integrated over a minute, are the path to 1 mm and 1e-6 rad") {
  const auto check = [](const Vec2& errors) {
    CHECK(errors.x < 1e-3);
    CHECK(errors.y < 1e-6);
  };
  check(errors_of_increments(Imu{Tumbling{}, tilted}));
  // a lever arm adds a jump of the velocity to each of the angular rate, which the trapezoidal rule misses by half an
  // interval
  for (const Mount& mount : {Mount{}, Mount{.boresight = tilted.boresight}}) {
    const std::vector<Vec2> way{{0, 0}, {0, 60}, {40, 90}, {150, 90}, {150, 200}, {300, 300}, {300, 900}};
    const auto drive = plan_ground_vehicle(way, hills, {.speed = 12});
    REQUIRE(drive.duration().seconds() > 60);
    check(errors_of_increments(Imu{drive, mount}));
    const Earth earth = wgs84_earth(48_deg);
    check(errors_of_increments(Imu{drive, mount, {.earth = earth}}));

    support::Generator any(3);
    std::vector<TimedPose> points;
    for (int k = 0; k < 32; ++k) points.push_back({2.0 * k, any.point(20), any.rotation()});
    check(errors_of_increments(Imu{Waypoints(points, Interpolation::cubic), mount}));

    std::vector<FlightPoint> flight(20);
    for (FlightPoint& p : flight) p.position = any.point(60);
    check(errors_of_increments(Imu{plan_multicopter(flight), mount}));
  }
}

TEST_CASE(
    "means over intervals, integrated by the midpoint rule, are the path of a drive over footings, which rates miss") {
  const std::vector<Vec2> way{{0, 0}, {0, 60}, {40, 90}, {150, 90}, {150, 200}, {300, 300}, {300, 900}};
  const Imu imu{plan_ground_vehicle(way, hills, {.speed = 12}), Mount{}};
  Navigator at = Navigator::begin(imu, {});
  double worst = 0;
  for (PulseIndex i = 0; i < 60 * 400; ++i) {
    const ImuSample s = imu.sample(i);
    const Vec3 angle = s.interval * s.mean_angular_rate();
    at.step(angle, s.interval * (rotation_by(0.5 * angle) * s.mean_specific_force()), s.interval);
    worst = std::max(worst, length(at.position - imu.instrument_at(s.tick).position));
  }
  CHECK(worst < 1e-3);
  CHECK(errors_of_rates(imu).x > 1);
}

TEST_CASE("after a year the increments are as exact as in the first second") {
  struct Delayed {
    Tumbling motion{};
    BodyPose at(Tick t) const noexcept { return motion.at(t - Tick{31557600, 0}); }
  };
  const Imu now{Tumbling{}, tilted};
  const Imu then{Delayed{}, tilted};
  for (PulseIndex i = 0; i < 1000; i += 37) {
    const ImuSample a = now.sample(i), b = then.sample(i + PulseIndex{400} * 31557600);
    CHECK(length(a.angle_increment - b.angle_increment) < 1e-14);
    CHECK(length(a.velocity_increment - b.velocity_increment) < 1e-12);
    CHECK(b.tick == a.tick + Tick{31557600, 0});
  }
}

TEST_CASE("rates of a path of continuous acceleration, integrated over a minute, are the path to 1 mm") {
  CHECK(errors_of_rates(Imu{Slalom{}, Mount{}}).x < 1e-3);
  CHECK(errors_of_rates(Imu{Slalom{}, tilted}).x < 1e-3);
  CHECK(errors_of_rates(Imu{Circle{}, tilted}).x < 1e-3);
}

// ----------------------------------------------------------------------------------------------- noise

namespace {

/// Angles of three gyroscopes and velocities of three accelerometers, integrated from increments at rest.
std::array<std::vector<double>, 6> integrated(const InertialErrors& errors, PulseIndex n, double rate,
                                              std::uint64_t seed) {
  const Imu imu{
      Tripod{},
      Mount{},
      {.sample_rate = rate, .gyroscope = errors, .accelerometer = errors, .earth = {.gravity = 0}, .seed = seed}};
  std::array<std::vector<double>, 6> sums;
  for (auto& sum : sums) sum.assign(n + 1, 0);
  for (PulseIndex i = 0; i < n; ++i) {
    const ImuSample s = imu.sample(i);
    for (int k = 0; k < 3; ++k) {
      const auto c = static_cast<std::size_t>(k);
      sums[c][i + 1] = sums[c][i] + s.angle_increment[k];
      sums[c + 3][i + 1] = sums[c + 3][i] + s.velocity_increment[k];
    }
  }
  return sums;
}

/// Overlapping Allan variance of m samples. Source: IEEE Std 952-1997, annex C; Riley 2008, sec. 5.2.
double allan_variance(const std::vector<double>& sum, std::size_t m, double interval) {
  double squares = 0;
  for (std::size_t i = 0; i + 2 * m < sum.size(); ++i) {
    const double second = sum[i + 2 * m] - 2 * sum[i + m] + sum[i];
    squares += second * second;
  }
  const double time = static_cast<double>(m) * interval;
  return squares / (2 * time * time * static_cast<double>(sum.size() - 2 * m));
}

/// Checks the deviation over six axes by the sum of the parts that IEEE Std 952 has for N, B and K.
void check_deviation(const InertialErrors& e, PulseIndex n, std::uint64_t seed) {
  const double rate = 200;
  const auto sums = integrated(e, n, rate, seed);
  for (std::size_t m = 1; m <= n / 10; m = m < 3 ? m + 1 : m * 3 / 2) {
    CAPTURE(m);
    double variance = 0;
    for (const auto& sum : sums) variance += allan_variance(sum, m, 1 / rate) / 6;
    const double time = static_cast<double>(m) / rate;
    const double expected = e.random_walk * e.random_walk / time +
                            2 * std::numbers::ln2 / pi * e.bias_instability * e.bias_instability +
                            e.rate_random_walk * e.rate_random_walk * time / 3;
    const double groups = static_cast<double>(n) / static_cast<double>(m);
    const double error = 1 / std::sqrt(2 * (groups - 1) * 6);  // standard error, by six independent axes
    CHECK(std::sqrt(variance) == relative(std::sqrt(expected), groups >= 2000 ? 0.05 : 3 * error + 0.01));
  }
}

}  // namespace

TEST_CASE("noise has the Allan deviation of its data sheet") {
  SUBCASE("white") { check_deviation({.random_walk = 3e-4}, 200'000, 1); }
  SUBCASE("flicker") { check_deviation({.bias_instability = 2e-5}, 100'000, 2); }
  SUBCASE("random walk of the rate") { check_deviation({.rate_random_walk = 1e-4}, 100'000, 3); }
  SUBCASE("all") {
    check_deviation({.random_walk = 3e-5, .bias_instability = 1.2e-4, .rate_random_walk = 4e-5}, 100'000, 4);
  }
}

TEST_CASE("a random walk of the rate spreads as the root of time, over blocks of any length") {
  const double interval = 0.01, k = 0.02;
  for (const PulseIndex i : {PulseIndex{0}, PulseIndex{1}, PulseIndex{2}, PulseIndex{7}, PulseIndex{1000},
                             PulseIndex{1} << 20, (PulseIndex{1} << 40) + 12345}) {
    CAPTURE(i);
    double squares = 0, next = 0;
    const std::uint32_t n = 3000;
    for (std::uint32_t seed = 0; seed < n; ++seed) {
      const detail::InertialNoise noise({.rate_random_walk = k}, interval, seed, 0);
      squares += noise.mean(i) * noise.mean(i) / n;
      const double step = noise.mean(i + 1) - noise.mean(i);
      next += step * step / n;
    }
    const double before = static_cast<double>(i) * interval;  // mean of W over the interval: t + dt / 3
    CHECK(squares == relative(k * k * (before + interval / 3), 5 * std::sqrt(2.0 / n)));
    CHECK(next == relative(k * k * interval * 2 / 3, 5 * std::sqrt(2.0 / n)));
  }
}

TEST_CASE("axes and seeds draw apart, and a bias is drawn once") {
  const InertialErrors errors{.bias = {1, 2, 3}, .bias_deviation = 0.5};
  const ImuSettings settings{.gyroscope = errors, .accelerometer = errors, .earth = {.gravity = 0}};
  double squares = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    ImuSettings other = settings;
    other.seed = seed;
    const Imu imu{Tripod{}, Mount{}, other};
    const ImuSample first = imu.sample(0), later = imu.sample(123456);
    CHECK(first.angular_rate == later.angular_rate);
    CHECK(first.specific_force == later.specific_force);
    CHECK(first.angular_rate != first.specific_force);
    for (const Vec3& e : {first.angular_rate - errors.bias, first.specific_force - errors.bias})
      squares += dot(e, e) / 6000;
  }
  CHECK(squares == relative(0.25, 0.1));
}

TEST_CASE("samples are pure in their number, and allocate nothing") {
  ImuSettings settings = stim_300();
  settings.gyroscope.rate_random_walk = settings.accelerometer.rate_random_walk = 1e-6;
  const Imu imu{Tumbling{}, tilted, settings};
  std::vector<ImuSample> forwards;
  for (PulseIndex i = 0; i < 300; ++i) forwards.push_back(imu.sample(i));
  const auto copy = imu;
  const auto allocations = support::allocations.load();
  bool alike = true;
  for (PulseIndex i = 300; i-- > 0;)
    alike = alike && same(imu.sample(i), forwards[i]) && same(copy.sample(i), forwards[i]);
  CHECK(alike);
  CHECK(support::allocations.load() == allocations);
  static_assert(noexcept(imu.sample(0)));
}

TEST_CASE("samples are found by time") {
  for (const double rate : {400.0, 100.0, 333.3, 1e4}) {
    const Imu imu{Tripod{}, Mount{}, {.sample_rate = rate}};
    CHECK(imu.sample_from({}) == 0);
    CHECK(imu.sample_from({-5, 0.5}) == 0);
    for (const PulseIndex i : {PulseIndex{0}, PulseIndex{1}, PulseIndex{12345}, static_cast<PulseIndex>(1e7 * rate)}) {
      CHECK(imu.sample_from(imu.tick(i)) == i);
      CHECK(imu.sample_from(imu.tick(i) + Tick{0, 1e-9}) == i + 1);
      CHECK(imu.sample_from(imu.tick(i) - Tick{0, 1e-9}) == i);
    }
    CHECK(imu.sample_from({std::int64_t{1} << 60, 0}) == PulseIndex{1} << 52);
  }
  const Imu imu{Tripod{}, Mount{}, {.sample_rate = 400}};
  for (const PulseIndex i : {0U, 1U, 799U, 800U, 123456U})
    CHECK(std::fabs((imu.sample(i).middle() - Tick::of(2 * i + 1, 800)).seconds()) < 1e-15);
}

// ------------------------------------------------------------------------------------- other errors

TEST_CASE("a rate beyond the range is cut off, in increments, too") {
  ImuSettings settings{};
  settings.gyroscope.range = 0.5;
  settings.accelerometer.range = 9;
  const ImuSample s = Imu{Circle{}, Mount{}, settings}.sample(3);
  CHECK(s.angular_rate == Vec3{0, 0, 0.5});
  CHECK(s.angle_increment.z == relative(0.5 / 400, 1e-12));
  CHECK(s.specific_force.z == 9);
  CHECK(s.velocity_increment.z == relative(9.0 / 400, 1e-12));
  CHECK(s.specific_force.x == relative(-8 * 0.7 * 0.7, 1e-12));
}

TEST_CASE("rates are rounded to steps, and scaled and mixed before") {
  ImuSettings settings{};
  settings.accelerometer.resolution = 0.01;
  settings.gyroscope.gain[2] = Vec3{0.02, 0, 1.1};  // what turns about z is felt about x, too
  const ImuSample s = Imu{Circle{}, Mount{}, settings}.sample(3);
  CHECK(length(s.angular_rate - Vec3{0.014, 0, 0.77}) < 1e-12);
  CHECK(length(s.angle_increment - Vec3{0.014, 0, 0.77} / 400.0) < 1e-12);
  CHECK(s.specific_force.z == relative(9.81, 1e-12));
  CHECK(s.specific_force.x == relative(-3.92, 1e-12));
  for (int k = 0; k < 3; ++k) {
    const double steps = s.velocity_increment[k] * 400 / 0.01;
    CHECK(std::fabs(steps - std::round(steps)) < 1e-9);
  }
  settings.gyroscope.range = 1;
  settings.gyroscope.resolution = 0.6;  // beyond the range after rounding, too
  settings.gyroscope.bias = {0.95, 0, 0};
  CHECK(Imu{Tripod{}, Mount{}, settings}.sample(3).angular_rate.x == 1);
}

TEST_CASE("rounded increments keep their sums to half a step") {
  const Imu imu{Tumbling{}, tilted};
  const double angle_step = 1e-4, velocity_step = 2e-3;
  IncrementQuantizer rounded(angle_step, velocity_step);
  Vec3 angle{}, velocity{};
  for (PulseIndex i = 0; i < 5000; ++i) {
    const ImuSample exact = imu.sample(i), s = rounded(exact);
    for (int k = 0; k < 3; ++k) {
      const double steps = s.angle_increment[k] / angle_step, others = s.velocity_increment[k] / velocity_step;
      REQUIRE(std::fabs(steps - std::round(steps)) < 1e-9);
      REQUIRE(std::fabs(others - std::round(others)) < 1e-9);
    }
    angle += s.angle_increment - exact.angle_increment;
    velocity += s.velocity_increment - exact.velocity_increment;
    REQUIRE(is_within(angle, 0.5001 * angle_step));
    REQUIRE(is_within(velocity, 0.5001 * velocity_step));
    REQUIRE(s.angular_rate == exact.angular_rate);
  }
}

TEST_CASE("sensors of three grades have the noise of their data sheets") {
  const ImuSettings consumer = mpu_6050(), industrial = mti_1(), tactical = stim_300();
  for (const ImuSettings& s : {consumer, industrial, tactical}) CHECK_NOTHROW(s.validate());
  CHECK(degrees(consumer.gyroscope.random_walk) == relative(0.005, 1e-12));
  CHECK(degrees(industrial.gyroscope.bias_instability) * 3600 * 0.664 == relative(10, 1e-3));
  CHECK(degrees(tactical.gyroscope.random_walk) * 60 == relative(0.15, 1e-12));
  CHECK(consumer.gyroscope.random_walk > industrial.gyroscope.random_walk / 2);
  CHECK(industrial.gyroscope.random_walk > tactical.gyroscope.random_walk);
  CHECK(consumer.accelerometer.random_walk > industrial.accelerometer.random_walk);
  CHECK(stim_300(1000).sample_rate == 1000);
}

TEST_CASE("settings out of range are refused by name") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const auto& change) {
    ImuSettings settings{};
    change(settings);
    return support::refused_field([&] { static_cast<void>(Imu{Tripod{}, Mount{}, settings}); });
  };
  CHECK(refused([](auto&) {}) == "");
  CHECK(refused([&](auto& s) { s.sample_rate = nan; }) == "ImuSettings::sample_rate");
  CHECK(refused([](auto& s) { s.sample_rate = 0; }) == "ImuSettings::sample_rate");
  const std::string gyro = "ImuSettings::gyroscope: InertialErrors::",
                    acc = "ImuSettings::accelerometer: InertialErrors::";
  CHECK(refused([&](auto& s) { s.gyroscope.bias.y = nan; }) == gyro + "bias (length)");
  CHECK(refused([](auto& s) { s.accelerometer.bias_deviation = -1; }) == acc + "bias_deviation");
  CHECK(refused([&](auto& s) { s.gyroscope.random_walk = nan; }) == gyro + "random_walk");
  CHECK(refused([](auto& s) { s.gyroscope.bias_instability = -1; }) == gyro + "bias_instability");
  CHECK(refused([](auto& s) { s.accelerometer.rate_random_walk = detail::infinity; }) == acc + "rate_random_walk");
  CHECK(refused([&](auto& s) { s.gyroscope.gain[1].z = nan; }) == gyro + "gain (column)");
  CHECK(refused([](auto& s) { s.gyroscope.range = 0; }) == gyro + "range");
  CHECK(refused([&](auto& s) { s.accelerometer.range = nan; }) == acc + "range");
  CHECK(refused([](auto& s) { s.accelerometer.resolution = -1e-3; }) == acc + "resolution");
  CHECK(refused([&](auto& s) { s.earth.gravity = nan; }) == "Earth::gravity");
  CHECK(refused([](auto& s) { s.earth.angular_rate = 2; }) == "Earth::angular_rate");
  CHECK(refused([](auto& s) { s.earth.latitude = 48; }) == "Earth::latitude");
  CHECK(support::refused_field([] { static_cast<void>(wgs84_earth(48)); }) == "Earth::latitude");
  CHECK(support::refused_field([] { static_cast<void>(wgs84_earth(0, 1e6)); }) == "wgs84_earth (height)");
  CHECK(support::refused_field([] { static_cast<void>(IncrementQuantizer(-1, 0)); }) ==
        "IncrementQuantizer (angle_step)");
  CHECK(support::refused_field([&] { static_cast<void>(IncrementQuantizer(1, nan)); }) ==
        "IncrementQuantizer (velocity_step)");
  const Mount far{.lever_arm = {nan, 0, 0}};
  CHECK(support::refused_field([&] { static_cast<void>(Imu{Tripod{}, far}); }) == "Mount::lever_arm (length)");
  CHECK(support::refused_field([] {
          static_cast<void>(Imu{StraightLine{.speed = -1}, Mount{}});
        }) == "StraightLine::speed");
}
