// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/deflector/fiber_array.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(Optic<FiberArray>);

TEST_CASE("a fibre array draws equally spaced points from end to end, both ends included, and begins again") {
  const FiberArray array{.fibers = 11, .fiber_rate = 1e5, .half_angle = 20_deg};
  for (PulseIndex i = 0; i < 33; ++i) {
    CAPTURE(i);
    const Tick t = Tick::of(i, 1e5);
    const double expected = -20_deg + static_cast<double>(i % 11) * 4_deg;
    CHECK(array.fiber(t) == i % 11);
    CHECK(std::fabs(array.angle(t) - expected) < 1e-15);
    CHECK(length(array.at(t).direction(axis::forward) - Vec3{0, std::cos(expected), std::sin(expected)}) < 1e-15);
  }
}

TEST_CASE("a fibre array of one shines forward") {
  CHECK(FiberArray{.fibers = 1}.angle({0, 0.3}) == 0);
  CHECK(FiberArray{.fibers = 1}.at({0, 0.3}).direction(axis::forward) == axis::forward);
}

TEST_CASE("a fibre array keeps the laws of a motion") {
  const auto ticks = support::some_ticks(3);
  CHECK(support::motion_laws(FiberArray{.fibers = 13, .fiber_rate = 777.7}, ticks) == "");
}

TEST_CASE("a fibre array refuses what cannot be") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(FiberArray{}.validate());
  CHECK_THROWS_AS(FiberArray{.fibers = 0}.validate(), SettingError);
  for (const double bad : {0.0, -1.0, nan}) CHECK_THROWS_AS(FiberArray{.fiber_rate = bad}.validate(), SettingError);
  for (const double bad : {-0.1, 3.2, nan}) CHECK_THROWS_AS(FiberArray{.half_angle = bad}.validate(), SettingError);
}
