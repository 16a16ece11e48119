// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/straight_line.hpp>

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

static_assert(Trajectory<StraightLine> && MovesInLanes<StraightLine>);

namespace {
const Vec3 utm{512345.678, 5403210.987, 1234.5};
}

TEST_CASE("a straight line is flown at its speed, level and looking along it") {
  const StraightLine east{.from = utm, .to = utm + Vec3{3000, 0, 400}, .speed = 50};
  const auto pose = east.at({20, 0.5});
  const double slant = std::hypot(3000.0, 400.0);
  CHECK(length(pose.position - (utm + Vec3{3000, 0, 400} * (50 * 20.5 / slant))) < 1e-9);
  CHECK(length(pose.direction(axis::forward) - axis::right) < 1e-15);  // level, though the path climbs
  CHECK(length(pose.direction(axis::up) - axis::up) < 1e-15);
  CHECK(east.duration().seconds() == support::relative(slant / 50, 1e-15));
}

TEST_CASE("a line begins and ends exactly where it should, and stays there") {
  const StraightLine line{.from = utm, .to = utm + Vec3{-700.1, 300.7, -20.3}, .speed = 33.3};
  CHECK(line.at({}).position == line.from);
  CHECK(line.at(line.duration() + Tick{0, 1e-9}).position == line.to);
  CHECK(line.at({1000000, 0}).position == line.to);
  CHECK(length(line.at(line.duration()).position - line.to) < 1e-8);
}

TEST_CASE("who goes straight up, or nowhere, looks north") {
  for (const Vec3& way : {Vec3{0, 0, 50}, Vec3{0, 0, -50}, Vec3{}}) {
    const StraightLine line{.from = utm, .to = utm + way, .speed = 10};
    CHECK_NOTHROW(line.validate());
    for (const Tick t : {Tick{-1, 0.5}, Tick{}, Tick{2, 0.5}, Tick{100, 0}}) {
      CHECK(finite(line.at(t).position));
      CHECK(finite(line.derivatives(t).velocity));
      CHECK(length(line.at(t).direction(axis::forward) - axis::forward) < 1e-15);
    }
    CHECK(line.at({100, 0}).position == line.to);
  }
  CHECK(StraightLine{.from = utm, .to = utm}.duration() == Tick{});
}

TEST_CASE("straight lines of any length keep the laws of a motion") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Vec3 from = any.point(1e7);
    const StraightLine line{
        .from = from, .to = from + any.log_uniform(1e-12, 1e6) * any.unit(), .speed = any.log_uniform(1e-3, 1e3)};
    std::vector<Tick> ticks{{}, line.duration(), {1000000000, 0.5}};
    for (int k = 0; k < 20; ++k) ticks.push_back(Tick::of_seconds(any.uniform(0, line.duration().seconds())));
    CHECK(support::motion_laws(line, ticks) == "");
  }
}

TEST_CASE("the velocity of a straight line is its speed on the way, and nothing behind its end") {
  const StraightLine line{.from = {1, 2, 3}, .to = {31, 42, 3}, .speed = 5};
  CHECK(length(line.derivatives({3, 0.5}).velocity - Vec3{3, 4, 0}) < 1e-15);
  for (const Tick t : {Tick{10, 0}, Tick{10, 0.1}}) CHECK(line.derivatives(t).velocity == Vec3{});
  const std::vector<Tick> ticks{{}, {1, 0.3}, {9, 0.9}, {10, 0}, {11, 0}};
  CHECK(support::derivative_laws(line, ticks) == "");
}

TEST_CASE("a straight line refuses what cannot be flown") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  CHECK_NOTHROW(StraightLine{}.validate());
  CHECK_THROWS_AS((StraightLine{.from = {nan, 0, 0}}.validate()), SettingError);
  CHECK_THROWS_AS((StraightLine{.to = {0, inf, 0}}.validate()), SettingError);
  for (const double speed : {0.0, -1.0, nan, inf, 1e-300}) {
    CAPTURE(speed);
    CHECK_THROWS_AS((StraightLine{.speed = speed}.validate()), SettingError);
  }
}
