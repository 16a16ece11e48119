// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/scan_angle.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;

TEST_CASE("a scan angle is that of its direction, whatever the direction's length") {
  CHECK(ScanAngle() == 0.0);
  CHECK(ScanAngle(0, 3) == 0.0);
  CHECK(ScanAngle(2, 0) == doctest::Approx(std::numbers::pi / 2).epsilon(1e-15));
  CHECK(ScanAngle(-0.5, 0.5) == doctest::Approx(-std::numbers::pi / 4).epsilon(1e-15));
  CHECK(ScanAngle(0, -1) == doctest::Approx(std::numbers::pi).epsilon(1e-15));
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double angle = any.uniform(-3.1, 3.1), length = any.log_uniform(1e-9, 1e9);
    CHECK(ScanAngle(length * std::sin(angle), length * std::cos(angle)) == doctest::Approx(angle).epsilon(1e-12));
  }
}

TEST_CASE("a scan angle that was given as a number is that number") {
  for (const double angle : {0.0, -0.3, 3.5, 1e-300}) CHECK(ScanAngle(angle) == angle);
  ScanAngle later(1, 1);
  later = -0.25;
  CHECK(later == -0.25);
}

TEST_CASE("the scan angle of a direction of NaN is NaN") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(ScanAngle(nan, 1)));
  CHECK(std::isnan(ScanAngle(1, nan)));
  CHECK(std::isnan(ScanAngle(nan, nan)));
}
