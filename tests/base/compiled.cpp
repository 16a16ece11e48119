// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/compiled.hpp>

#include <cstdio>

#include <doctest/doctest.h>

// That a program of another build does not link, and one of the same build does, is seen by package/compiled.

using namespace pulsecast;

TEST_CASE("a version is a number of two digits a part") {
  unsigned major = 0, minor = 0, patch = 0;
  REQUIRE(std::sscanf(PULSECAST_VERSION, "%u.%u.%u", &major, &minor, &patch) == 3);
  CHECK(detail::version_number() == 10'000 * major + 100 * minor + patch);
}
