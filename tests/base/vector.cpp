// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/vector.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

namespace {
double distance(const Vec3& a, const Vec3& b) { return length(a - b); }
}  // namespace

TEST_CASE("right, forward and up are a right-handed set of axes") {
  CHECK(cross(axis::right, axis::forward) == axis::up);
  CHECK(cross(axis::forward, axis::up) == axis::right);
  CHECK(cross(axis::up, axis::right) == axis::forward);
}

TEST_CASE("the length of a rotation's axis does not matter") {
  CHECK(distance(rotation_about(axis::up * 1e6, 1.0) * axis::right, rotation_about(axis::up, 1.0) * axis::right) <
        1e-15);
  CHECK(distance(rotation_about(axis::up * 1e-6, 1.0) * axis::right, rotation_about(axis::up, 1.0) * axis::right) <
        1e-15);
}

TEST_CASE("no rotation leaves a vector as it is") { CHECK(no_rotation * Vec3{1, -2, 3} == Vec3{1, -2, 3}); }

TEST_CASE("a product of rotations applies the right one first") {
  const Rotation both = rotation_about(axis::up, pi / 2) * rotation_about(axis::right, pi / 2);
  CHECK(distance(both * axis::forward, axis::up) < 1e-15);
  CHECK(distance(both * axis::right, axis::forward) < 1e-15);
}

TEST_CASE("rotations keep lengths and angles, and the conjugate undoes them") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Rotation turn = any.rotation();
    const Vec3 a = any.unit() * any.log_uniform(1e-3, 1e6), b = any.unit();
    CHECK(length(turn * a) == support::relative(length(a), 1e-14));
    CHECK(std::fabs(dot(turn * a, turn * b) - dot(a, b)) <= 1e-14 * length(a));
    CHECK(distance(conjugate(turn) * (turn * a), a) <= 1e-14 * length(a));
  }
}

TEST_CASE("a rotation about an axis agrees with Rodrigues' formula") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Vec3 axis = any.unit(), v = any.unit();
    const double angle = any.uniform(-7, 7);
    // Source: Rodrigues 1840
    const Vec3 expected =
        v * std::cos(angle) + cross(axis, v) * std::sin(angle) + axis * (dot(axis, v) * (1 - std::cos(angle)));
    CHECK(distance(rotation_about(axis, angle) * v, expected) < 2e-15);
  }
}

TEST_CASE("a vector is finite only if all of it is") {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(finite({1, 2, 3}));
  for (const double bad : {infinity, -infinity, nan}) {
    CHECK_FALSE(finite({bad, 2, 3}));
    CHECK_FALSE(finite({1, bad, 3}));
    CHECK_FALSE(finite({1, 2, bad}));
  }
}

TEST_CASE("min, max and the largest magnitude go by coordinate") {
  CHECK(min({1, 5, -3}, {2, 4, -4}) == Vec3{1, 4, -4});
  CHECK(max({1, 5, -3}, {2, 4, -4}) == Vec3{2, 5, -3});
  CHECK(max_norm({1, -5, 3}) == 5);
  CHECK(max_norm({0, 0, -2}) == 2);
  CHECK(is_within({1, -5, 3}, 5));
  for (const double beyond : {-6.0, std::nan(""), std::numeric_limits<double>::infinity()})
    for (const Vec3& v : {Vec3{beyond, 0, 0}, Vec3{0, beyond, 0}, Vec3{0, 0, beyond}}) CHECK_FALSE(is_within(v, 5));
}

TEST_CASE("a rotation is found again in its matrix") {
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  support::Generator random(seed);
  for (int i = 0; i < 1000; ++i) {
    const Rotation rotation = random.rotation(), again = rotation_of(matrix_of(rotation));
    CHECK(std::fabs(dot(rotation, again)) == doctest::Approx(1).epsilon(1e-15));  // q and -q are the same rotation
    CHECK(length(again) == doctest::Approx(1).epsilon(1e-15));
  }
}
