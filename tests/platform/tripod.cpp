// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/tripod.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(Trajectory<Tripod> && MovesInLanes<Tripod>);

TEST_CASE("a tripod stands where it stands and looks where a compass says") {
  const Vec3 utm{500000, 5400000, 300};
  const Tripod north{.position = utm}, east{.position = utm, .heading = 90_deg},
      northwest{.position = utm, .heading = -45_deg};
  CHECK(north.at({}).position == utm);
  CHECK(length(north.at({}).direction(axis::forward) - axis::forward) < 1e-15);
  CHECK(length(east.at({}).direction(axis::forward) - axis::right) < 1e-15);
  CHECK(length(east.at({}).direction(axis::right) + axis::forward) < 1e-15);
  CHECK(length(northwest.at({}).direction(axis::forward) - Vec3{-std::sqrt(0.5), std::sqrt(0.5), 0}) < 1e-15);
  CHECK(length(northwest.at({}).direction(axis::up) - axis::up) < 1e-15);
}

TEST_CASE("a tripod keeps the laws of a motion and does not move") {
  const Tripod tripod{.position = {1, 2, 3}, .heading = 0.7};
  const std::vector<Tick> ticks{{0, 0}, {0, 0.5}, {1000000, 0.25}};
  CHECK(support::motion_laws(tripod, ticks) == "");
  CHECK(support::derivative_laws(tripod, ticks) == "");
  CHECK(tripod.at(ticks[0]).position == tripod.at(ticks[2]).position);
}

TEST_CASE("a tripod refuses to stand nowhere") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(Tripod{}.validate());
  CHECK_THROWS_AS((Tripod{.position = {nan, 0, 0}}.validate()), SettingError);
  CHECK_THROWS_AS((Tripod{.position = {0, nan, 0}}.validate()), SettingError);
  CHECK_THROWS_AS((Tripod{.position = {0, 0, nan}}.validate()), SettingError);
  CHECK_THROWS_AS(Tripod{.heading = nan}.validate(), SettingError);
}
