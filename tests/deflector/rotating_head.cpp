// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/deflector/rotating_head.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(Head<RotatingHead> && MovesInLanes<RotatingHead>);

TEST_CASE("a head that turns at a positive rate turns left") {
  const RotatingHead head{.angular_rate = 90_deg};
  CHECK(length(head.at({0, 0}).direction(axis::forward) - axis::forward) < 1e-15);
  CHECK(length(head.at({1, 0}).direction(axis::forward) + axis::right) < 1e-15);
  CHECK(length(head.at({2, 0}).direction(axis::forward) + axis::forward) < 1e-15);
  CHECK(length(head.at({3, 0}).direction(axis::forward) - axis::right) < 1e-15);
  CHECK(length(head.at({0, 0.5}).direction(axis::forward) - Vec3{-std::sin(45_deg), std::cos(45_deg), 0}) < 1e-15);
  CHECK(head.at({1, 0}).position == Vec3{});
}

TEST_CASE("a head that turns at a negative rate turns right") {
  const RotatingHead head{.angular_rate = -90_deg};
  CHECK(length(head.at({1, 0}).direction(axis::forward) - axis::right) < 1e-15);
  CHECK(length(head.at({5, 0}).direction(axis::forward) - axis::right) < 1e-15);
}

TEST_CASE("a head begins at its start angle, and a head at rest stays there") {
  const RotatingHead head{.angular_rate = 0, .start = -90_deg};
  CHECK(length(head.at({0, 0}).direction(axis::forward) - axis::right) < 1e-15);
  CHECK(length(head.at({1000000, 0.3}).direction(axis::forward) - axis::right) < 1e-15);
}

TEST_CASE("a head turns about its own axis, whatever its length") {
  const RotatingHead head{.angular_rate = 90_deg, .axis = {5, 0, 0}};
  CHECK(length(head.at({1, 0}).direction(axis::forward) - axis::up) < 1e-15);
}

TEST_CASE("a head's angle does not wear out with time") {
  // a turn a second: after any whole number of seconds it stands where it began
  const RotatingHead head{.angular_rate = 2 * pi, .start = 0.3};
  for (const std::int64_t second : {1LL, 1000LL, 100000000LL})
    CHECK(length(head.at({second, 0.25}).direction(axis::forward) - head.at({0, 0.25}).direction(axis::forward)) <
          1e-14);
}

TEST_CASE("a head keeps the laws of a motion") {
  const auto ticks = support::some_ticks(5);
  CHECK(support::motion_laws(RotatingHead{.angular_rate = 0.37, .start = 1, .axis = {1, 2, 3}}, ticks) == "");
}

TEST_CASE("a head refuses what it cannot turn about") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(RotatingHead{}.validate());
  CHECK_THROWS_AS(RotatingHead{.angular_rate = nan}.validate(), SettingError);
  CHECK_THROWS_AS(RotatingHead{.start = nan}.validate(), SettingError);
  CHECK_THROWS_AS((RotatingHead{.axis = {0, 0, 0}}.validate()), SettingError);
  CHECK_THROWS_AS((RotatingHead{.axis = {0, nan, 0}}.validate()), SettingError);
}
