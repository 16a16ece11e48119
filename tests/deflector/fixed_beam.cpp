// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/deflector/fixed_beam.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include <doctest/doctest.h>

#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(Optic<FixedBeam> && MovesInLanes<FixedBeam>);

TEST_CASE("a fixed beam leaves from its origin along its two angles, at any time") {
  const FixedBeam beam{aimed_at(90_deg, -30_deg, {0.01, 0.02, 0.03})};
  for (const Tick t : {Tick{0, 0}, Tick{1000000, 0.5}}) {
    CHECK(length(beam.at(t).direction(axis::forward) - Vec3{std::cos(30_deg), 0, -0.5}) < 1e-15);
    CHECK(beam.at(t).position == Vec3{0.01, 0.02, 0.03});
  }
  CHECK(length(FixedBeam{}.at({}).direction(axis::forward) - axis::forward) == 0);
}

TEST_CASE("a fixed beam keeps the laws of a motion") {
  const std::vector<Tick> ticks{{0, 0}, {0, 0.3}, {77, 0.1}};
  CHECK(support::motion_laws(FixedBeam{aimed_at(1, 0.3, {1, 2, 3})}, ticks) == "");
}

TEST_CASE("a fixed beam of single precision becomes unit in its deflector") {
  const Deflector device{FixedBeam{{Rotation{0.6F, 0.8F, 0, 0}, {}}}, Scanner{}};
  CHECK(std::fabs(length(device.pulse(0)->pose.rotation) - 1) < 1e-15);
}

TEST_CASE("a fixed beam refuses angles and places that cannot be") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(FixedBeam{}.validate());
  CHECK_THROWS_AS(FixedBeam{aimed_at(nan, 0)}.validate(), SettingError);
  CHECK_THROWS_AS((FixedBeam{{Rotation{2, 0, 0, 0}, {}}}.validate()), SettingError);
  CHECK_THROWS_AS((FixedBeam{aimed_at(0, 0, {0, nan, 0})}.validate()), SettingError);
}
