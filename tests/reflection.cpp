// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/reflection.hpp>

#include <doctest/doctest.h>

#include <array>

using namespace pulsecast;

TEST_CASE("the power of a continuous return is the integral of a line") {
  CHECK(ContinuousReturn{.begin = 10, .end = 14, .at_begin = 3, .at_end = 1}.power() == 8);
  CHECK(ContinuousReturn{.begin = 10, .end = 10, .at_begin = 3, .at_end = 1}.power() == 0);
}

TEST_CASE("a result is dark if neither surfaces nor media return light") {
  const std::array<ContinuousReturn, 1> haze{};
  CHECK(TransportResult{}.dark());
  CHECK_FALSE(TransportResult{.reflections = 1}.dark());
  CHECK_FALSE(TransportResult{.continuous = haze}.dark());
}
