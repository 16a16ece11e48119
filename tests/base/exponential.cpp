// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/exponential.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;

namespace {
const double infinity = std::numeric_limits<double>::infinity();
}

TEST_CASE("the exponential errs by less than 4e-16 of its value, for a number and in every lane") {
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double reach = any.log_uniform(1e-9, 708);
    simd::Doubles x{};
    for (std::size_t k = 0; k < simd::lane_count; ++k) x[k] = any.uniform(-reach, reach);
    const simd::Doubles y = exponential(x);
    for (std::size_t k = 0; k < simd::lane_count; ++k) {
      const double expected = std::exp(x[k]);
      CAPTURE(x[k]);
      REQUIRE(std::fabs(y[k] - expected) <= 4e-16 * expected);
      REQUIRE(std::fabs(exponential(double{x[k]}) - expected) <= 4e-16 * expected);
    }
  }
}

TEST_CASE("the exponential of 0 is 1, of what is far below 0 it is 0, and nothing else comes of what is no number") {
  CHECK(exponential(0.0) == 1);
  CHECK(exponential(-0.0) == 1);
  CHECK(exponential(1e-300) == 1);
  for (const double x : {-708.1, -1e5, -1e300, -infinity}) CHECK(exponential(x) == 0);
  CHECK(std::isnan(exponential(std::numeric_limits<double>::quiet_NaN())));
  const simd::Doubles far = exponential(simd::Doubles{} - infinity);
  for (std::size_t k = 0; k < simd::lane_count; ++k) CHECK(far[k] == 0);
}
