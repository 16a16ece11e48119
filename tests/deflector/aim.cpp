// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/deflector/aim.hpp>

#include <cmath>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

TEST_CASE("a beam aimed above forward stays in the plane of forward and up") {
  for (const double angle : {-180_deg, -90_deg, -20_deg, 0.0, 1e-9, 45_deg, 170_deg}) {
    CHECK(length(aimed_above(angle).direction(axis::forward) - Vec3{0, std::cos(angle), std::sin(angle)}) < 1e-15);
    CHECK(length(aimed_above(angle).direction(axis::right) - axis::right) < 1e-15);
  }
}

TEST_CASE("a beam aimed at two angles goes where a map and a level would say, and its right stays level") {
  support::Generator any(1);
  for (int k = 0; k < 1000; ++k) {
    const double azimuth = any.uniform(-4, 4), elevation = any.uniform(-pi / 2, pi / 2);
    CAPTURE(azimuth);
    CAPTURE(elevation);
    const auto pose = aimed_at(azimuth, elevation);
    const double level = std::cos(elevation);
    CHECK(length(pose.direction(axis::forward) -
                 Vec3{level * std::sin(azimuth), level * std::cos(azimuth), std::sin(elevation)}) < 1e-15);
    CHECK(std::fabs(pose.direction(axis::right).z) < 1e-15);
  }
}

TEST_CASE("a beam aimed along a direction goes there by the shortest turn") {
  support::Generator any(2);
  for (int k = 0; k < 2000; ++k) {
    Vec3 direction = any.unit();
    if (k % 2 == 1) {  // almost straight back, or almost forward
      const double aside = any.log_uniform(1e-12, 0.1), turn = any.uniform(0, 2 * pi);
      const double along = std::sqrt((1 - aside) * (1 + aside));
      direction = {aside * std::cos(turn), k % 4 == 1 ? -along : along, aside * std::sin(turn)};
    }
    CAPTURE(k);
    CAPTURE(direction.y);
    const auto pose = aimed_along(direction);
    CHECK(length(pose.direction(axis::forward) - direction) < 2e-15);
    CHECK(pose.rotation.y == 0);  // about an axis square to forward,
    CHECK(pose.rotation.w >= 0);  // by half a turn at most
    CHECK(pose.position == Vec3{});
  }
}

TEST_CASE("a beam can be aimed straight forward and straight back") {
  CHECK(aimed_along(axis::forward).direction(axis::up) == axis::up);
  CHECK(length(aimed_along(-axis::forward).direction(axis::forward) + axis::forward) < 1e-15);
  CHECK(length(aimed_along({1e-160, -1, 0}).direction(axis::forward) + axis::forward) < 1e-15);
}
