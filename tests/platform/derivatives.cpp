// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/derivatives.hpp>

#include <cmath>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/waypoints.hpp>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

using BodyPose = Pose<frame::Body, frame::World>;

/// Circle to the left at a radius [m] and an angular rate [rad/s], looking along it.
struct Circle {
  double radius = 8, rate = 0.7;
  BodyPose at(Tick t) const noexcept {
    const double angle = rate * t.seconds();
    return {rotation_about(axis::up, angle), {radius * std::cos(angle), radius * std::sin(angle), 3}};
  }
};

/// Rolls and pitches in place.
struct Rocking {
  BodyPose at(Tick t) const noexcept {
    const double s = t.seconds();
    return {rotation_about(axis::forward, 0.4 * std::sin(2 * s)) * rotation_about(axis::right, 0.3 * std::cos(3 * s)),
            {}};
  }
};

struct Copied {  // a path without its derivatives
  Waypoints path;
  BodyPose at(Tick t) const noexcept { return path.at(t); }
};

static_assert(Trajectory<Circle> && !Differentiable<Circle> && !Differentiable<Copied>);

}  // namespace

TEST_CASE("rotation vectors and rotations are inverse, by the smaller angle") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Vec3 vector = any.log_uniform(1e-300, 3.14) * any.unit();
    CHECK(length(rotation_vector(rotation_by(vector)) - vector) <= 1e-15 * length(vector));
    CHECK(length(rotation_vector(-rotation_by(vector)) - vector) <= 1e-15 * length(vector));
  }
  CHECK(rotation_by({}) == no_rotation);
  CHECK(rotation_vector(no_rotation) == Vec3{});
}

TEST_CASE("a circle is differentiated to its centripetal acceleration") {
  const Circle circle{};
  for (const Tick t : {Tick{}, Tick{3, 0.21}, Tick{31557600, 0.125}}) {
    const double angle = circle.rate * t.seconds(), v = circle.radius * circle.rate;
    const Derivatives d = derivatives_of(circle, t);
    // a year is some 2e7 rad here: the circle itself is as coarse as 4e-9
    const double less = t.second > 100 ? 1e-5 : 1e-9;
    CHECK(length(d.velocity - v * Vec3{-std::sin(angle), std::cos(angle), 0}) < less);
    CHECK(length(d.angular_rate - circle.rate * axis::up) < less);
    if (t.second > 100) continue;
    CHECK(length(d.acceleration + v * circle.rate * Vec3{std::cos(angle), std::sin(angle), 0}) < 1e-9);
    CHECK(length(d.angular_acceleration) < 1e-9);
  }
}

TEST_CASE("what is differentiated by its poses is what is known in closed form") {
  support::Generator any(1);
  std::vector<TimedPose> points;
  for (int k = 0; k < 10; ++k) points.push_back({2.0 * k, any.point(20), any.rotation()});
  const Waypoints path(points, Interpolation::cubic);
  const Copied copy{path};
  for (int k = 0; k < 9; ++k) {
    const Tick t = Tick::of_seconds(2 * k + 0.9);
    const Derivatives a = derivatives_of(path, t), b = derivatives_of(copy, t);
    CHECK(length(a.velocity - b.velocity) < 1e-11);
    CHECK(length(a.acceleration - b.acceleration) < 1e-8);
    CHECK(length(a.angular_rate - b.angular_rate) < 1e-10);
    CHECK(length(a.angular_acceleration - b.angular_acceleration) < 1e-8);
  }
}

TEST_CASE("an heir that replaces the poses of a path has derivatives of its own") {
  struct Faster : StraightLine {
    BodyPose at(Tick t) const noexcept { return StraightLine::at(t + t); }
  };
  const Faster path{{.to = {0, 1000, 0}, .speed = 10}};
  CHECK(length(derivatives_of(path, {3, 0}).velocity - Vec3{0, 20, 0}) < 1e-9);
  CHECK(derivatives_of(StraightLine{path}, {3, 0}).velocity == Vec3{0, 10, 0});
}

TEST_CASE("an instrument on a lever arm moves as its own poses do") {
  const Mount mount{.lever_arm = {0.3, -1.2, 0.8}, .boresight = rotation_about({1, 2, -1}, 40_deg)};
  struct Carried {
    Mount mount;
    BodyPose at(Tick t) const noexcept {
      const auto pose = Rocking{}.at(t) * mount.pose();
      return {pose.rotation, pose.position};
    }
  };
  for (const Tick t : {Tick{}, Tick{1, 0.4}, Tick{7, 0.7}}) {
    const Derivatives a = derivatives_of(Rocking{}, mount, t), b = derivatives_of(Carried{mount}, t);
    CHECK(length(a.velocity - b.velocity) < 1e-8);
    CHECK(length(a.acceleration - b.acceleration) < 1e-8);
    CHECK(length(a.angular_rate - b.angular_rate) < 1e-9);
    CHECK(length(a.angular_acceleration - b.angular_acceleration) < 1e-8);
  }
}

TEST_CASE("rotations that follow each other add up their derivatives") {
  const auto inner = [](double s) { return rotation_about(axis::right, 0.3 * std::cos(3 * s)); };
  const double s = 1.4, roll = 0.8 * std::cos(2 * s), roll_change = -1.6 * std::sin(2 * s);
  Derivatives d{.angular_rate = roll * axis::forward, .angular_acceleration = roll_change * axis::forward};
  d.turn_by(inner(s), -0.9 * std::sin(3 * s) * axis::right, -2.7 * std::cos(3 * s) * axis::right);
  const Derivatives found = derivatives_of(Rocking{}, Tick::of_seconds(s));
  CHECK(length(d.angular_rate - found.angular_rate) < 1e-9);
  CHECK(length(d.angular_acceleration - found.angular_acceleration) < 1e-8);
}
