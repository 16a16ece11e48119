// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/arithmetic.hpp>

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

// What compilers are told by options is in tests/compile_fail/fast_math.cpp.
TEST_CASE("arithmetic has infinities, rays of NaN, an order, and numbers below the least normal one") {
  volatile double zero = 0, large = 1e16, least = std::numeric_limits<double>::min();
  const double infinity = 1 / zero, nothing = infinity - infinity;
  CHECK(infinity > std::numeric_limits<double>::max());
  CHECK(std::isnan(nothing));
  CHECK_FALSE(nothing == nothing);
  CHECK(1 / -zero < 0);
  CHECK((large + 1) - large == 0);
  CHECK(least / 2 > 0);
}
