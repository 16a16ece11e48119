// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/detail/piecewise_cubic.hpp>

#include <pulsecast/base/vector.hpp>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("a piece of constant jerk is a cubic in time") {
  const CubicPiece<double> piece{10, 1, 2, 3, 4};
  const auto state = piece.after(2);
  CHECK(state.position == doctest::Approx(1 + 2 * 2 + 3 * 4 / 2.0 + 4 * 8 / 6.0));
  CHECK(state.velocity == doctest::Approx(2 + 3 * 2 + 4 * 4 / 2.0));
  CHECK(state.acceleration == doctest::Approx(3 + 4 * 2));
  CHECK(state.jerk == 4);
  CHECK(state.duration == 8);
}

TEST_CASE("what follows after two times is what follows after their sum") {
  const CubicPiece<Vec3> piece{10, {1, 2, 3}, {-1, 0, 2}, {0.5, 1, -1}, {1, 2, 3}};
  const auto twice = piece.after(0.75).after(1.5), once = piece.after(2.25);
  CHECK(length(twice.position - once.position) < 1e-13);
  CHECK(length(twice.velocity - once.velocity) < 1e-13);
  CHECK(length(twice.acceleration - once.acceleration) < 1e-13);
}

TEST_CASE("a motion rests before its first piece, after its last, and between pieces that do not touch") {
  PiecewiseCubic<double> motion(5);
  motion.add({1, 0}, {.duration = 2, .position = 5, .velocity = 3});
  motion.add({4, 0.5}, {.duration = 1, .position = 11, .velocity = -1});
  CHECK(motion.at({-3, 0}).position == 5);
  CHECK(motion.at({0, 0.5}).position == 5);
  CHECK(motion.at({2, 0.5}).position == 9.5);
  CHECK(motion.at({3, 0.75}).position == 11);
  CHECK(motion.at({5, 0}).position == 10.5);
  CHECK(motion.at({1000000000000, 0}).position == 10);
}

TEST_CASE("a piece cuts short what was there, also from the same start on") {
  PiecewiseCubic<double> motion(0);
  motion.add({1, 0}, {.duration = 10, .velocity = 1});
  motion.add({3, 0}, {.duration = 10, .position = 2, .velocity = -1});
  motion.add({3, 0}, {.duration = 10, .position = 2, .velocity = 5});
  CHECK(motion.at({2, 0}).position == 1);
  CHECK(motion.at({4, 0}).position == 7);
  CHECK(motion.pieces().size() == 4);
}

TEST_CASE("a motion is as smooth after a year as in the first second") {
  PiecewiseCubic<double> motion(0);
  motion.add({31536000, 0.25}, {.duration = 10, .velocity = 1e6});
  CHECK(motion.at({31536000, 0.25 + 0x1p-52}).position == 1e6 * 0x1p-52);
}
