// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/geometry/box.hpp>

#include <doctest/doctest.h>

#include <limits>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

TEST_CASE("a box as made is empty, has no surface, and is replaced by what extends it") {
  Box box;
  CHECK(box.empty());
  CHECK(box.half_area() == 0);
  box.extend(Box{});
  CHECK(box.empty());
  box.extend(Vec3{1, 2, 3});
  CHECK_FALSE(box.empty());
  CHECK(box == Box{{1, 2, 3}, {1, 2, 3}});
  CHECK(box.half_area() == 0);
}

TEST_CASE("a box knows its centre, its size and half of its surface") {
  const Box box{{-1, 0, 2}, {1, 3, 6}};
  CHECK(box.centre() == Vec3{0, 1.5, 4});
  CHECK(box.size() == Vec3{2, 3, 4});
  CHECK(box.half_area() == 26);
}

TEST_CASE("the centre of a box of the largest numbers is finite") {
  const double most = std::numeric_limits<double>::max();
  CHECK(Box{{-most, most, 0}, {most, most, 0}}.centre() == Vec3{0, most, 0});
}

TEST_CASE("a box that is turned over or not a number is empty") {
  CHECK(Box{{0, 0, 1}, {1, 1, 0}}.empty());
  CHECK(Box{{0, std::numeric_limits<double>::quiet_NaN(), 0}, {1, 1, 1}}.empty());
  CHECK_FALSE(Box{{0, 0, 0}, {1, 1, 0}}.empty());
}

TEST_CASE("extending boxes is the same in any order and holds all that was put in") {
  Generator random(60);
  for (int time = 0; time < 100; ++time) {
    const Box a = random.box(10, 1e-3, 10), b = random.box(10, 1e-3, 10);
    const Vec3 p = random.point(20);
    Box one = a, other;
    one.extend(b);
    one.extend(p);
    other.extend(p);
    other.extend(b);
    other.extend(a);
    CHECK(one == other);
    CHECK(min(one.min, p) == one.min);
    CHECK(max(one.max, b.max) == one.max);
  }
}
