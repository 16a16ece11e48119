// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/heading.hpp>

#include <cmath>
#include <initializer_list>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

TEST_CASE("a heading counts clockwise from north, whatever the slope") {
  CHECK(heading_of({0, 3, 0}) == 0);
  CHECK(heading_of({2, 0, -5}) == support::relative(90_deg, 1e-15));
  CHECK(heading_of({-1, -1, 7}) == support::relative(-135_deg, 1e-15));
  CHECK(heading_of({0, -1e-200, 1}) == support::relative(180_deg, 1e-15));
}

TEST_CASE("what has no heading is given another") {
  CHECK(heading_of({0, 0, 5}) == 0);
  CHECK(heading_of({0, 0, -5}, 1.5) == 1.5);
  CHECK(heading_of({-0.0, 0.0, 0}, 1.5) == 1.5);
}

TEST_CASE("a level body looks where its heading says, and its right is a quarter turn clockwise of it") {
  for (const double heading : {-3.0, -1.0, 0.001, 0.5, 1.5, 3.1}) {
    CAPTURE(heading);
    const Rotation r = level(heading);
    CHECK(heading_of(r * axis::forward) == support::relative(heading, 1e-14));
    CHECK(length(r * axis::right - Vec3{std::cos(heading), -std::sin(heading), 0}) < 1e-15);
    CHECK(length(r * axis::up - axis::up) < 1e-15);
  }
}
