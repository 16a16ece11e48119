// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/deflector/polygon_mirror.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(Optic<PolygonMirror> && ForeseesOpening<PolygonMirror> && MovesInLanes<PolygonMirror>);

TEST_CASE("a polygon mirror sweeps from low to high once per line and starts over") {
  const PolygonMirror mirror{.line_rate = 100, .sweep = 60_deg};
  CHECK(mirror.angle({0, 0}) == -60_deg);
  CHECK(mirror.angle({0, 0.0025}) == support::relative(-30_deg, 1e-14));
  CHECK(std::fabs(mirror.angle({0, 0.005})) < 1e-15);
  CHECK(mirror.angle({0, 0.0075}) == support::relative(30_deg, 1e-14));
  CHECK(mirror.angle({0, 0.0099999999}) == support::relative(60_deg, 1e-7));
  CHECK(mirror.angle({0, 0.0125}) == support::relative(-30_deg, 1e-13));
  CHECK(mirror.angle({1000000000, 0.0025}) == support::relative(-30_deg, 1e-13));
}

TEST_CASE("a polygon mirror turns the beam up by its angle, in the plane of forward and up") {
  const PolygonMirror mirror{.line_rate = 100, .sweep = 60_deg};
  for (const Tick t : support::some_ticks(1)) {
    const double a = mirror.angle(t);
    CHECK(length(mirror.at(t).direction(axis::forward) - Vec3{0, std::cos(a), std::sin(a)}) < 1e-15);
    CHECK(length(mirror.at(t).direction(axis::right) - axis::right) < 1e-15);
    CHECK(mirror.at(t).position == Vec3{});
  }
}

TEST_CASE("a polygon mirror's gate lets through the part of each line that it is set to") {
  const PolygonMirror mirror{.line_rate = 100, .sweep = 60_deg, .angle_min = -20_deg, .angle_max = 45_deg};
  int open = 0;
  for (PulseIndex i = 0; i < 120000; ++i) {  // 1200 a line, so that a pulse comes every tenth of a degree
    const Tick t = Tick::of(i, 120e3);
    REQUIRE(mirror.open(t) == (i % 1200 >= 400 && i % 1200 <= 1050));
    open += mirror.open(t);
  }
  CHECK(open == 651 * 100);
}

TEST_CASE("pulses on the ends of a gate and of a line are decided as by whole numbers, however their times round") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const PulseIndex slots = 2 + any.whole(2000), first = 1 + any.whole(slots - 1),
                     last = first + any.whole(slots - first);
    const bool whole = any.coin();  // lines a second: otherwise the rates drift apart by their rounding
    const double lines = whole ? std::round(any.log_uniform(1, 1000)) : any.log_uniform(0.1, 1000),
                 sweep = any.uniform(0.1, pi);
    const auto at = [&](PulseIndex slot) {
      return sweep * (2 * static_cast<double>(slot) / static_cast<double>(slots) - 1);
    };
    const PolygonMirror mirror{.line_rate = lines,
                               .sweep = sweep,
                               .angle_min = whole && first == 1 ? -sweep : at(first),
                               .angle_max = at(last)};
    const PulseIndex start = any.whole(PulseIndex{1} << any.whole(whole ? 32 : 20)) * slots;
    for (PulseIndex i = 0; i < 2 * slots; ++i) {
      const Tick t = Tick::of(start + i, lines * static_cast<double>(slots));
      CAPTURE(i);
      if (whole) REQUIRE(std::fabs(mirror.angle(t) - at(i % slots)) < 1e-6);
      REQUIRE(mirror.open(t) == (at(i % slots) >= mirror.angle_min && i % slots <= last));
    }
  }
}

TEST_CASE("a polygon mirror foresees the moment at which the beam enters its gate") {
  const PolygonMirror mirror{.line_rate = 100, .sweep = 60_deg, .angle_min = -30_deg, .angle_max = 45_deg};
  const auto opens = [](const PolygonMirror& m, Tick t) { return m.next_open(t).seconds(); };
  CHECK(opens(mirror, {0, 0}) == support::relative(0.0025, 1e-9));
  CHECK(opens(mirror, {0, 0.004}) == 0.004);
  CHECK(opens(mirror, {0, 0.009}) == support::relative(0.0125, 1e-9));
  CHECK(opens({.line_rate = 100, .sweep = 60_deg, .angle_max = 0}, {5, 0.009}) == support::relative(5.01, 1e-12));
}

TEST_CASE("no slot before that of the foreseen opening is open, and few after it are closed") {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    PolygonMirror mirror{.line_rate = any.log_uniform(1e-3, 1e6), .sweep = any.uniform(0, pi)};
    mirror.angle_min = any.uniform(-1.2, 1) * mirror.sweep;
    mirror.angle_max = any.uniform(mirror.angle_min, 1.2 * mirror.sweep);
    if (any.coin()) mirror.sweep = pi / static_cast<double>(1 + any.whole(8));  // slots on the ends of lines
    mirror.angle_min = std::clamp(mirror.angle_min, -pi, pi);
    mirror.angle_max = std::clamp(mirror.angle_max, mirror.angle_min, pi);
    const double rate =
        any.coin() ? mirror.line_rate * static_cast<double>(2 + any.whole(3000)) : any.log_uniform(1, 1e9);
    const double fit = std::clamp(rate, 1.0, 1e12);
    const Deflector device{
        mirror, Scanner{.pulse_rate = fit, .pulses = PulseIndex{1} << 48, .delay = any.uniform() * 0.9 / fit}};
    for (int k = 0; k < 20; ++k) {
      const PulseIndex i = any.whole(PulseIndex{1} << (8 + any.whole(39)));
      CAPTURE(i);
      const PulseIndex next = device.next_pulse(i);
      REQUIRE(next >= i);
      for (PulseIndex j = 0; j < 200 && i + j < next; ++j) {
        REQUIRE(!device.pulse(i + j));
        REQUIRE(!device.pulse(next - 1 - j));
      }
      const double lines_per_slot = mirror.line_rate / fit,
                   share = 0.5 * (mirror.angle_max - mirror.angle_min) / mirror.sweep;
      const bool opens =
          std::fabs(mirror.angle_min) < 0.99 * mirror.sweep && share > 0.01;  // for many slots of each line
      if (opens && lines_per_slot < 1e-3 && lines_per_slot > 1e-9 && next < device.size())
        CHECK((device.pulse(next) || device.pulse(next + 1)));
    }
  }
}

TEST_CASE("a mirror that never opens is passed over line by line, however slow it turns") {
  const PolygonMirror closed{.line_rate = 100, .sweep = 0, .angle_min = 1_deg, .angle_max = 2_deg};
  CHECK(closed.next_open({0, 0.001}).seconds() == support::relative(0.011, 1e-9));
  const PolygonMirror stands{.line_rate = 1e-300, .sweep = 60_deg, .angle_min = 0, .angle_max = 45_deg};
  CHECK(stands.next_open({0, 0.5}) == Tick{1'000'000'000'000'000, 0.5});
  CHECK(Deflector{stands, Scanner{.pulses = 1000}}.next_pulse(3) == 1000);
}

TEST_CASE("a polygon mirror without a gate is always open") {
  for (const Tick t : support::some_ticks(2)) CHECK(PolygonMirror{}.open(t));
}

TEST_CASE("a polygon mirror's facets take turns, and each sends its line out of the plane by its own tilt") {
  const std::vector<double> tilts{-2_deg, 1_deg, 3_deg};
  const PolygonMirror mirror{.line_rate = 100, .sweep = 60_deg, .facet_tilts = tilts};
  for (const PulseIndex start : {PulseIndex{0}, PulseIndex{300000000000}})  // of 100 pulses a line
    for (PulseIndex i = start; i < start + 1000; ++i) {
      CAPTURE(i);
      const Tick t = Tick::of(i, 10e3);
      const std::size_t facet = i / 100 % 3;
      REQUIRE(mirror.facet(t) == facet);
      const Vec3 d = mirror.at(t).direction(axis::forward);
      const double a = mirror.angle(t), aside = std::sin(tilts[facet]), along = std::cos(tilts[facet]);
      CHECK(length(d - Vec3{aside, along * std::cos(a), along * std::sin(a)}) < 1e-15);
    }
}

TEST_CASE("a facet ends where its line ends, however long the mirror turns and however its rate rounds") {
  support::Generator any(4);
  for (int k = 0; k < 300; ++k) {
    const double rate = any.log_uniform(0.1, 1e4);
    const std::size_t n = 2 + any.whole(12);
    const PolygonMirror mirror{.line_rate = rate, .facet_tilts = std::vector<double>(n, 0.0)};
    CAPTURE(rate);
    CAPTURE(n);
    const double begin = std::floor(any.log_uniform(1, 1e8));
    double phase = Tick::of_seconds(begin).phase(rate);
    std::size_t facet = mirror.facet(Tick::of_seconds(begin));
    int changes = 0;
    for (int j = 1; j < 500; ++j) {
      const Tick t = Tick::of_seconds(begin) + Tick::of_seconds(j / (rate * 50.3));
      const bool over = t.phase(rate) < phase;  // the next line has begun
      REQUIRE(mirror.facet(t) == (facet + (over ? 1 : 0)) % n);
      phase = t.phase(rate);
      facet = mirror.facet(t);
      changes += over;
    }
    CHECK(changes >= 9);
  }
}

TEST_CASE("at the very beginning of a line, angle and facet tell of the same line") {
  for (const double rate : {1.0, 70.0, 100.0, 333.0})
    for (std::size_t n = 2; n < 14; ++n) {
      const PolygonMirror mirror{.line_rate = rate, .facet_tilts = std::vector<double>(n, 0.0)};
      for (const PulseIndex start : {PulseIndex{0}, PulseIndex{n} * 1000000007})
        for (PulseIndex line = start + 1; line < start + 200; ++line) {
          CAPTURE(rate);
          CAPTURE(n);
          CAPTURE(line);
          const Tick t = Tick::of(line, rate);
          const bool begun =
              mirror.angle(t) < 0;  // else it is still at the last end of the one before, by rounding of the tick
          REQUIRE(mirror.facet(t) == (begun ? line : line - 1) % n);
        }
    }
}

TEST_CASE("a polygon mirror without tilts is one whose tilts are zero") {
  const PolygonMirror plain{.line_rate = 77}, tilted{.line_rate = 77, .facet_tilts = {0}};
  for (const Tick t : support::some_ticks(5))
    CHECK(length(plain.at(t).direction(axis::forward) - tilted.at(t).direction(axis::forward)) == 0);
}

TEST_CASE("a polygon mirror keeps the laws of a motion") {
  CHECK(support::motion_laws(PolygonMirror{.line_rate = 33.3, .facet_tilts = {0.1, -0.1, 0, 0.2}},
                             support::some_ticks(6)) == "");
  CHECK(support::motion_laws(PolygonMirror{.line_rate = 33.3, .angle_min = -0.3, .angle_max = 1},
                             support::some_ticks(3)) == "");
}

TEST_CASE("a polygon mirror refuses what no mirror can do") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(PolygonMirror{}.validate());
  for (const double bad : {0.0, -1.0, nan}) CHECK_THROWS_AS(PolygonMirror{.line_rate = bad}.validate(), SettingError);
  for (const double bad : {-0.1, 3.2, nan}) CHECK_THROWS_AS(PolygonMirror{.sweep = bad}.validate(), SettingError);
  CHECK_THROWS_AS((PolygonMirror{.angle_min = 0.2, .angle_max = 0.1}.validate()), SettingError);
  CHECK_THROWS_AS(PolygonMirror{.angle_min = nan}.validate(), SettingError);
  CHECK_THROWS_AS(PolygonMirror{.angle_max = nan}.validate(), SettingError);
  for (const double bad : {-1.6, 1.6, nan})
    CHECK_THROWS_AS((PolygonMirror{.facet_tilts = {0, bad}}.validate()), SettingError);
}
