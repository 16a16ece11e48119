// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/detail/speed_profile.hpp>

#include <cmath>
#include <vector>

#include <pulsecast/base/vector.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using support::Generator;
using support::relative;

namespace {

double duration(const std::vector<CubicPiece<double>>& pieces) {
  double sum = 0;
  for (const auto& p : pieces) sum += p.duration;
  return sum;
}

}  // namespace

TEST_CASE("a piece of constant jerk is a cubic in time") {
  const CubicPiece<double> piece{10, 1, 2, 3, 4};
  const auto state = piece.after(2);
  CHECK(state.position == doctest::Approx(1 + 2 * 2 + 3 * 4 / 2.0 + 4 * 8 / 6.0));
  CHECK(state.velocity == doctest::Approx(2 + 3 * 2 + 4 * 4 / 2.0));
  CHECK(state.acceleration == doctest::Approx(3 + 4 * 2));
  CHECK(state.jerk == 4);
  CHECK(state.duration == 8);
}

TEST_CASE("what follows after two times is what follows after their sum") {
  const CubicPiece<Vec3> piece{10, {1, 2, 3}, {-1, 0, 2}, {0.5, 1, -1}, {1, 2, 3}};
  const auto twice = piece.after(0.75).after(1.5), once = piece.after(2.25);
  CHECK(length(twice.position - once.position) < 1e-13);
  CHECK(length(twice.velocity - once.velocity) < 1e-13);
  CHECK(length(twice.acceleration - once.acceleration) < 1e-13);
}

TEST_CASE("a motion rests before its first piece, after its last, and between pieces that do not touch") {
  PiecewiseCubic<double> motion(5);
  motion.add({1, 0}, {.duration = 2, .position = 5, .velocity = 3});
  motion.add({4, 0.5}, {.duration = 1, .position = 11, .velocity = -1});
  CHECK(motion.at({-3, 0}).position == 5);
  CHECK(motion.at({0, 0.5}).position == 5);
  CHECK(motion.at({2, 0.5}).position == 9.5);
  CHECK(motion.at({3, 0.75}).position == 11);
  CHECK(motion.at({5, 0}).position == 10.5);
  CHECK(motion.at({1000000000000, 0}).position == 10);
}

TEST_CASE("a piece cuts short what was there, also from the same start on") {
  PiecewiseCubic<double> motion(0);
  motion.add({1, 0}, {.duration = 10, .velocity = 1});
  motion.add({3, 0}, {.duration = 10, .position = 2, .velocity = -1});
  motion.add({3, 0}, {.duration = 10, .position = 2, .velocity = 5});
  CHECK(motion.at({2, 0}).position == 1);
  CHECK(motion.at({4, 0}).position == 7);
  CHECK(motion.pieces().size() == 4);
}

TEST_CASE("a motion is as smooth after a year as in the first second") {
  PiecewiseCubic<double> motion(0);
  motion.add({31536000, 0.25}, {.duration = 10, .velocity = 1e6});
  CHECK(motion.at({31536000, 0.25 + 0x1p-52}).position == 1e6 * 0x1p-52);
}

TEST_CASE("from rest to rest over a long way there are seven pieces, whose times are known") {
  // L = 100, v = 5, a = 2, j = 4: T = L / v + v / a + a / j. Source: Biagiotti & Melchiorri 2008, section 3.4
  const auto pieces = speed_profile(100, 0, 0, {.speed = 5, .acceleration = 2, .braking = 2, .jerk = 4});
  REQUIRE(pieces.size() == 7);
  const double times[] = {0.5, 2, 0.5, (100 - 5 * 3.0) / 5, 0.5, 2, 0.5};
  for (std::size_t k = 0; k < 7; ++k) CHECK(pieces[k].duration == relative(times[k], 1e-14));
  CHECK(duration(pieces) == relative(100 / 5.0 + 5 / 2.0 + 2 / 4.0, 1e-14));
  CHECK(pieces[3].velocity == 5);
}

TEST_CASE("over a short way neither speed nor acceleration reaches its limit: four times the cube root of L / 2j") {
  const auto pieces = speed_profile(0.1, 0, 0, {.speed = 5, .acceleration = 2, .braking = 2, .jerk = 4});
  CHECK(duration(pieces) == relative(4 * std::cbrt(0.1 / (2 * 4)), 1e-12));
}

TEST_CASE("over a way of middle length the acceleration reaches its limit, the speed does not") {
  // v (v / a + a / j) = L
  const double v = 3, a = 2, j = 4, way = v * (v / a + a / j);
  const auto pieces = speed_profile(way, 0, 0, {.speed = 5, .acceleration = a, .braking = a, .jerk = j});
  CHECK(duration(pieces) == relative(2 * (v / a + a / j), 1e-12));
}

TEST_CASE("nothing to drive takes no time") {
  CHECK(speed_profile(0, 0, 0, {}).empty());
  CHECK(duration(speed_profile(0, 0.5, 0.5, {})) == 0);
}

TEST_CASE("the reachable speed is what a change of speed needs its length for") {
  const SpeedLimits limits{.speed = 50, .acceleration = 2, .braking = 3, .jerk = 4};
  for (const double to : {3.0, 3.1, 7.0, 40.0}) {
    const double way = SpeedChange{3, to, 2, 4}.distance();
    CHECK(reachable_speed(way, 3, 2, limits) ==
          relative(to, 1e-7));  // to 3 from 3 the distance grows like a square root
  }
  CHECK(reachable_speed(1e6, 3, 2, limits) == 50);
  CHECK(reachable_speed(0, 3, 2, limits) == 3);
}

TEST_CASE("profiles keep their limits, join up, and end where and as fast as they should") {
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const SpeedLimits limits{random.log_uniform(0.01, 100), random.log_uniform(0.01, 100),
                             random.log_uniform(0.01, 100), random.log_uniform(0.01, 100)};
    const double way = random.log_uniform(1e-6, 1e4);
    std::vector<double> joints{random.uniform(0, limits.speed), random.uniform(0, limits.speed)};
    settle_speeds(joints, std::vector<PathSection>{{way, limits}});
    const auto pieces = speed_profile(way, joints[0], joints[1], limits);
    double position = 0, velocity = joints[0], acceleration = 0;
    for (const auto& p : pieces) {
      CHECK(std::fabs(p.position - position) <= 1e-12 * way);
      CHECK(std::fabs(p.velocity - velocity) <= 1e-12 * limits.speed);
      CHECK(std::fabs(p.acceleration - acceleration) <= 1e-12 * std::fmax(limits.acceleration, limits.braking));
      CHECK(std::fabs(p.jerk) <= limits.jerk);
      for (int k = 0; k <= 4; ++k) {
        const auto state = p.after(p.duration * k / 4);
        CHECK(state.velocity <= limits.speed * (1 + 1e-12));
        CHECK(state.velocity >= -1e-12 * limits.speed);
        CHECK(state.acceleration <= limits.acceleration * (1 + 1e-12));
        CHECK(-state.acceleration <= limits.braking * (1 + 1e-12));
        position = state.position;
        velocity = state.velocity;
        acceleration = state.acceleration;
      }
    }
    CHECK(position == relative(way, 1e-12));
    CHECK(std::fabs(velocity - joints[1]) <= 1e-12 * limits.speed);
  }
}

TEST_CASE("settled speeds are never raised, and every section can be driven with them") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    std::vector<PathSection> sections(1 + random.whole(20));
    std::vector<double> wished(sections.size() + 1, 0.0);
    for (std::size_t k = 0; k < sections.size(); ++k) {
      sections[k] = {random.log_uniform(1e-3, 1e3),
                     {30, random.log_uniform(0.1, 10), random.log_uniform(0.1, 10), random.log_uniform(0.1, 10)}};
      if (k > 0) wished[k] = random.uniform(0, 30);
    }
    std::vector<double> joints = wished;
    settle_speeds(joints, sections);
    for (std::size_t k = 0; k < sections.size(); ++k) {
      const auto& [way, limits] = sections[k];
      const bool faster = joints[k + 1] > joints[k];
      CHECK(SpeedChange{joints[k], joints[k + 1], faster ? limits.acceleration : limits.braking, limits.jerk}
                .distance() <= way * (1 + 1e-12));
      CHECK(joints[k] <= wished[k]);
      if (k > 0) CHECK(joints[k] > 0);
    }
  }
}
