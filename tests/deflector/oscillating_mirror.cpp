// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/deflector/oscillating_mirror.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(Optic<OscillatingMirror> && MovesInLanes<OscillatingMirror>);

namespace {
/// Rounded triangle, plain triangle and sine, all at a cycle a second.
std::array<OscillatingMirror, 3> mirrors() {
  return {OscillatingMirror{.cycle_rate = 1, .half_angle = 20_deg, .turning_time = 0.1},
          OscillatingMirror{.cycle_rate = 1, .half_angle = 20_deg},
          OscillatingMirror{.cycle_rate = 1, .half_angle = 20_deg, .swing = Swing::sine}};
}
}  // namespace

TEST_CASE("an oscillating mirror starts low, is high after half a cycle, and passes its centre twice a cycle") {
  for (const OscillatingMirror& mirror : mirrors()) {
    CHECK(mirror.angle({0, 0}) == -20_deg);
    CHECK(mirror.angle({0, 0.5}) == 20_deg);
    CHECK(std::fabs(mirror.angle({0, 0.25})) < 1e-15);
    CHECK(std::fabs(mirror.angle({0, 0.75})) < 1e-15);
    int passes = 0;
    for (int k = 0; k < 1000; ++k) {
      const double here = mirror.angle({0, (k + 0.5) / 1000}), next = mirror.angle(Tick::of_seconds((k + 1.5) / 1000));
      passes += (here < 0) != (next < 0);
      REQUIRE(std::fabs(here) <= 20_deg);
    }
    CHECK(passes == 2);
  }
}

TEST_CASE("an oscillating mirror goes back as it came") {
  for (const OscillatingMirror& mirror : mirrors())
    for (int k = 1; k < 500; ++k)
      CHECK(std::fabs(mirror.angle({0, k / 1000.0}) - mirror.angle({0, 1 - k / 1000.0})) < 1e-14);
}

TEST_CASE("an oscillating mirror turns the beam up by its angle, in the plane of forward and up") {
  for (const OscillatingMirror& mirror : mirrors())
    for (const Tick t : support::some_ticks(1)) {
      const double a = mirror.angle(t);
      CHECK(length(mirror.at(t).direction(axis::forward) - Vec3{0, std::cos(a), std::sin(a)}) < 1e-15);
    }
}

TEST_CASE(
    "between its turns a triangle has a constant rate, and in its turns a constant acceleration over the turning "
    "time") {
  const double half_angle = 20_deg, turning_time = 0.1, h = 1e-3;
  const OscillatingMirror mirror{.cycle_rate = 1, .half_angle = half_angle, .turning_time = turning_time};
  const auto angle = [&](double s) { return mirror.angle(Tick::of_seconds(s + 10)); };  // ten whole cycles later
  const double rate = 4 * half_angle / (1 - turning_time);  // from: half_angle = rate * (1/4 - turn/2) + rate * turn/4
  for (double s = 0.05; s < 0.45 - h; s += h) CHECK((angle(s + h) - angle(s)) / h == support::relative(rate, 1e-9));
  for (double s = -0.05 + h; s < 0.05 - h; s += h)  // the rate changes its sign within the turning time
    CHECK((angle(s + h) - 2 * angle(s) + angle(s - h)) / (h * h) == support::relative(2 * rate / turning_time, 1e-6));
  for (double s = 0.45 + h; s < 0.55 - h; s += h)
    CHECK((angle(s + h) - 2 * angle(s) + angle(s - h)) / (h * h) == support::relative(-2 * rate / turning_time, 1e-6));
}

TEST_CASE("a triangle without turning time is one of straight lines") {
  const OscillatingMirror mirror{.cycle_rate = 1, .half_angle = 20_deg};
  for (int k = 0; k <= 50; ++k) CHECK(std::fabs(mirror.angle({0, k / 100.0}) - (-20_deg + k * 0.8_deg)) < 1e-15);
}

TEST_CASE("a sine is one") {
  const OscillatingMirror mirror{.cycle_rate = 1, .half_angle = 20_deg, .swing = Swing::sine};
  for (int k = 0; k < 100; ++k)
    CHECK(std::fabs(mirror.angle({0, k / 100.0}) + 20_deg * std::cos(2 * pi * k / 100)) < 1e-15);
}

TEST_CASE("an oscillating mirror that turns round in 100 pulses has the shape of a peer's") {
  // recorded from HELIOS++: 100 kHz, 50 Hz, 30 degrees; its recurrence is up to half a pulse ahead of the closed form
  const OscillatingMirror mirror{.cycle_rate = 50, .half_angle = 30_deg, .turning_time = 1_ms};
  const double half_pulse = 0.5 * degrees(0.00110289368214492) + 1e-3;
  for (const auto& recorded : std::vector<std::pair<PulseIndex, double>>{{0, -30},
                                                                         {2, -29.9987103846278},
                                                                         {49, -28.4834123222749},
                                                                         {50, -28.4202211690364},
                                                                         {500, 0.0157977883092865},
                                                                         {949, 28.3886255924164},
                                                                         {950, 28.4518167456549},
                                                                         {999, 29.9999999999993},
                                                                         {1000, 30},
                                                                         {1050, 28.4518167456556},
                                                                         {1500, 0.0157977883099541},
                                                                         {1950, -28.4202211690357},
                                                                         {1999, -29.9999999999993}}) {
    CAPTURE(recorded.first);
    CHECK(std::fabs(degrees(mirror.angle(Tick::of(recorded.first, 100e3))) - recorded.second) < half_pulse);
  }
}

TEST_CASE("an oscillating mirror's angle does not wear out with time") {
  OscillatingMirror mirror{.cycle_rate = 50, .turning_time = 1_ms};
  for (const Swing swing : {Swing::triangle, Swing::sine}) {
    mirror.swing = swing;
    for (PulseIndex i = 0; i < 5000; i += 7)  // 10^12 pulses are 10^7 s
      CHECK(std::fabs(mirror.angle(Tick::of(1000000000000 + i, 100e3)) - mirror.angle(Tick::of(i, 100e3))) < 1e-13);
  }
}

TEST_CASE("an oscillating mirror keeps the laws of a motion") {
  for (const OscillatingMirror& mirror : mirrors()) CHECK(support::motion_laws(mirror, support::some_ticks(2)) == "");
}

TEST_CASE("an oscillating mirror refuses what cannot be") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(OscillatingMirror{}.validate());
  CHECK_NOTHROW(OscillatingMirror{.cycle_rate = 50, .turning_time = 10_ms}.validate());
  for (const double bad : {0.0, -1.0, nan})
    CHECK_THROWS_AS(OscillatingMirror{.cycle_rate = bad}.validate(), SettingError);
  for (const double bad : {-0.1, 3.2, nan})
    CHECK_THROWS_AS(OscillatingMirror{.half_angle = bad}.validate(), SettingError);
  for (const double bad : {-0.1, 10.1_ms, nan})
    CHECK_THROWS_AS((OscillatingMirror{.cycle_rate = 50, .turning_time = bad}.validate()), SettingError);
  CHECK_THROWS_AS((OscillatingMirror{.swing = Swing::sine, .turning_time = 1_ms}.validate()), SettingError);
}
