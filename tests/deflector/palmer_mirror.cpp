// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/deflector/palmer_mirror.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(Optic<PalmerMirror> && MovesInLanes<PalmerMirror>);

TEST_CASE("a Palmer mirror draws a cone of its half angle, from up over right, once a turn") {
  const PalmerMirror mirror{.rotation_rate = 10, .half_angle = 20_deg};
  for (int k = 0; k < 1000; ++k) {
    const double turn = 2 * pi * k / 1000;
    const Vec3 d = mirror.at(Tick::of_seconds(7 + k / 10000.0)).direction(axis::forward);
    CHECK(length(d - Vec3{std::sin(20_deg) * std::sin(turn), std::cos(20_deg), std::sin(20_deg) * std::cos(turn)}) <
          1e-12);
  }
}

TEST_CASE("a Palmer mirror with two half angles draws an ellipse of angles") {
  const double high = 20_deg, wide = 8_deg;
  const PalmerMirror mirror{.rotation_rate = 1, .half_angle = high, .half_angle_across = wide};
  CHECK(length(mirror.at({0, 0}).direction(axis::forward) - Vec3{0, std::cos(high), std::sin(high)}) < 1e-15);
  CHECK(length(mirror.at({0, 0.25}).direction(axis::forward) - Vec3{std::sin(wide), std::cos(wide), 0}) < 1e-15);
  CHECK(length(mirror.at({0, 0.5}).direction(axis::forward) - Vec3{0, std::cos(high), -std::sin(high)}) < 1e-15);
  CHECK(length(mirror.at({0, 0.75}).direction(axis::forward) - Vec3{-std::sin(wide), std::cos(wide), 0}) < 1e-15);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 d = mirror.at({0, k / 1000.0}).direction(axis::forward);
    const double off = std::acos(d.y), scale = off / std::hypot(d.x, d.z);
    CHECK(std::fabs(std::pow(d.x * scale / wide, 2) + std::pow(d.z * scale / high, 2) - 1) < 1e-12);
  }
}

TEST_CASE("a Palmer mirror that does not tilt shines forward") {
  CHECK(PalmerMirror{.half_angle = 0}.at({0, 0.001}).direction(axis::forward) == axis::forward);
}

TEST_CASE("a Palmer mirror's angle does not wear out with time") {
  const PalmerMirror mirror{.rotation_rate = 60};
  for (PulseIndex i = 0; i < 5000; i += 7)  // 10^12 pulses are 10^7 s
    CHECK(length(mirror.at(Tick::of(1000000000000 + i, 100e3)).direction(axis::forward) -
                 mirror.at(Tick::of(i, 100e3)).direction(axis::forward)) < 1e-13);
}

TEST_CASE("a Palmer mirror keeps the laws of a motion") {
  const auto ticks = support::some_ticks(4);
  CHECK(support::motion_laws(PalmerMirror{.rotation_rate = 33.3}, ticks) == "");
  CHECK(support::motion_laws(PalmerMirror{.rotation_rate = 33.3, .half_angle_across = 1}, ticks) == "");
}

TEST_CASE("a Palmer mirror refuses what cannot be") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(PalmerMirror{}.validate());
  for (const double bad : {0.0, -1.0, nan})
    CHECK_THROWS_AS(PalmerMirror{.rotation_rate = bad}.validate(), SettingError);
  for (const double bad : {-0.1, 1.6, nan}) {
    CHECK_THROWS_AS(PalmerMirror{.half_angle = bad}.validate(), SettingError);
    CHECK_THROWS_AS(PalmerMirror{.half_angle_across = bad}.validate(), SettingError);
  }
}
