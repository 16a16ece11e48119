// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/deflector/polygon_mirror.hpp>

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

namespace {
std::vector<Tick> some_ticks(std::uint64_t seed) {
  support::Generator any(seed);
  std::vector<Tick> ticks{{0, 0}};
  for (int k = 0; k < 200; ++k) ticks.push_back(Tick::of_seconds(any.log_uniform(1e-9, 1e8)));
  return ticks;
}
}  // namespace

TEST_CASE("a polygon mirror sweeps from low to high once per line and starts over") {
  const PolygonMirror mirror{.lines_per_second = 100, .sweep = 60_deg};
  CHECK(mirror.angle({0, 0}) == -60_deg);
  CHECK(mirror.angle({0, 0.0025}) == support::relative(-30_deg, 1e-14));
  CHECK(std::fabs(mirror.angle({0, 0.005})) < 1e-15);
  CHECK(mirror.angle({0, 0.0075}) == support::relative(30_deg, 1e-14));
  CHECK(mirror.angle({0, 0.0099999999}) == support::relative(60_deg, 1e-7));
  CHECK(mirror.angle({0, 0.0125}) == support::relative(-30_deg, 1e-13));
  CHECK(mirror.angle({1000000000, 0.0025}) == support::relative(-30_deg, 1e-13));
}

TEST_CASE("a polygon mirror turns the beam up by its angle, in the plane of forward and up") {
  const PolygonMirror mirror{.lines_per_second = 100, .sweep = 60_deg};
  for (const Tick t : some_ticks(1)) {
    const double a = mirror.angle(t);
    CHECK(length(mirror.at(t).direction(forward) - Vec3{0, std::cos(a), std::sin(a)}) < 1e-15);
    CHECK(length(mirror.at(t).direction(right) - right) < 1e-15);
    CHECK(mirror.at(t).position == Vec3{});
  }
}

TEST_CASE("a polygon mirror's gate lets through the part of each line that it is set to") {
  const PolygonMirror mirror{.lines_per_second = 100, .sweep = 60_deg, .angle_min = -20_deg, .angle_max = 45_deg};
  int open = 0;
  for (PulseIndex i = 0; i < 120000; ++i) {  // 1200 a line, so that a pulse comes every tenth of a degree
    const Tick t = Tick::of(i, 120e3);
    const double a = mirror.angle(t);
    REQUIRE(mirror.open(t) == (a >= -20_deg && a <= 45_deg));
    open += mirror.open(t);
  }
  CHECK(std::abs(open - 120000 * 65 / 120) <= 100);  // the pulses at the very ends of the gate round either way
}

TEST_CASE("a polygon mirror without a gate is always open") {
  for (const Tick t : some_ticks(2)) CHECK(PolygonMirror{}.open(t));
}

TEST_CASE("a polygon mirror keeps the laws of a motion") {
  CHECK(support::motion_laws(PolygonMirror{.lines_per_second = 33.3, .angle_min = -0.3, .angle_max = 1}, some_ticks(3)) == "");
}

TEST_CASE("a polygon mirror refuses what no mirror can do") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(PolygonMirror{}.validate());
  for (const double bad : {0.0, -1.0, nan}) CHECK_THROWS_AS(PolygonMirror{.lines_per_second = bad}.validate(), SettingError);
  for (const double bad : {-0.1, 3.2, nan}) CHECK_THROWS_AS(PolygonMirror{.sweep = bad}.validate(), SettingError);
  CHECK_THROWS_AS((PolygonMirror{.angle_min = 0.2, .angle_max = 0.1}.validate()), SettingError);
  CHECK_THROWS_AS(PolygonMirror{.angle_min = nan}.validate(), SettingError);
  CHECK_THROWS_AS(PolygonMirror{.angle_max = nan}.validate(), SettingError);
}
