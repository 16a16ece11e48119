// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/gravity.hpp>

#include <cmath>

#include <doctest/doctest.h>

TEST_CASE("a metre is fallen in the time of the textbook") {
  CHECK(std::sqrt(2 / pulsecast::standard_gravity) == doctest::Approx(0.4516).epsilon(1e-4));
}
