// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/geometry/detail/bounding_box.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

TEST_CASE_TEMPLATE("rounding down never gives more, rounding up never less, and both are as near as can be", Real,
                   float, double) {
  Generator random(80);
  for (int time = 0; time < 1000; ++time) {
    const double v = (random.coin() ? 1 : -1) * random.log_uniform(1e-60, 1e30);
    CHECK(static_cast<double>(round_down<Real>(v)) <= v);
    CHECK(static_cast<double>(round_up<Real>(v)) >= v);
    CHECK(static_cast<double>(std::nextafter(round_down<Real>(v), std::numeric_limits<Real>::infinity())) > v);
    CHECK(static_cast<double>(std::nextafter(round_up<Real>(v), -std::numeric_limits<Real>::infinity())) < v);
  }
  CHECK(round_up<Real>(std::numeric_limits<double>::infinity()) == std::numeric_limits<Real>::infinity());
  CHECK(round_down<Real>(0.5) == Real(0.5));
}

TEST_CASE_TEMPLATE("boxes contain what they stand for, alone and among eight", Real, float, double) {
  for (std::uint64_t seed = 90; seed < 290; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const Vec3 centre = random.point(1e6);
    Box8<Real> all;
    for (std::size_t place = 0; place < 8; ++place) {
      const Box box = random.box(1e6, 1e-3, 1e5);
      all.put(place, BoundingBox<Real>::around(box, centre));
      const BoundingBox<Real> held = all.at(place);
      for (int k = 0; k < 3; ++k) {
        CHECK(static_cast<double>(held.min[k]) <= box.min[k] - centre[k]);
        CHECK(static_cast<double>(held.max[k]) >= box.max[k] - centre[k]);
      }
    }
  }
}

TEST_CASE_TEMPLATE("a box holds what the subtraction of its centre rounds away", Real, float, double) {
  for (const double wall : {1.0, -1.0})
    for (const double shift : {0x1p-55, -0x1p-55}) {
      const auto box = BoundingBox<Real>::around({Vec3(wall), Vec3(wall)}, Vec3(shift));
      CHECK(static_cast<double>(box.min[0]) < wall);
      CHECK(static_cast<double>(box.max[0]) > wall);
    }
}
