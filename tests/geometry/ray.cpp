// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/geometry/ray.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace pulsecast;

TEST_CASE("a ray as made leaves the origin forward and has no end") {
  const Ray ray;
  CHECK(ray.origin == Vec3{0, 0, 0});
  CHECK(ray.direction == axis::forward);
  CHECK(ray.near == 0);
  CHECK(ray.far == std::numeric_limits<double>::infinity());
}
