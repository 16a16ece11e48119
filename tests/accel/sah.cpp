// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/accel/sah.hpp>

#include <doctest/doctest.h>

#include <vector>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

TEST_CASE_TEMPLATE("slices are numbered in order, begin at their edge, and take in what lies outside", Real, float, double) {
  const pulsecast::detail::Slices<Real, 16> slices(-4, 4);
  CHECK(slices.valid());
  CHECK(slices.edge(0) == -4);
  CHECK(slices.edge(8) == 0);
  CHECK(slices.of(-4) == 0);
  CHECK(slices.of(static_cast<Real>(-3.75)) == 0);
  CHECK(slices.of(static_cast<Real>(-3.25)) == 1);
  CHECK(slices.of(4) == 15);
  CHECK(slices.of(-1000) == 0);
  CHECK(slices.of(static_cast<Real>(1e30)) == 15);
  std::size_t before = 0;
  for (Real x = -5; x < 5; x += static_cast<Real>(0.01)) {
    CHECK(slices.of(x) >= before);
    before = slices.of(x);
  }
}

TEST_CASE_TEMPLATE("an interval without length, or too short to divide, is not sliced", Real, float, double) {
  using Slices = pulsecast::detail::Slices<Real, 16>;
  CHECK_FALSE(Slices(3, 3).valid());
  CHECK_FALSE(Slices(3, 2).valid());
  CHECK_FALSE(Slices(0, std::numeric_limits<Real>::denorm_min()).valid());
  CHECK(Slices(3, 4).valid());
}

TEST_CASE("half of the surface of a box is that of three of its sides") {
  CHECK(pulsecast::detail::half_area(BoundingBox<float>{{0, 0, 0}, {2, 3, 4}}) == 26);
  CHECK(pulsecast::detail::half_area(BoundingBox<double>{{1, 1, 1}, {1, 1, 1}}) == 0);
}

TEST_CASE("a box that takes in another holds both") {
  auto box = pulsecast::detail::no_box<float>();
  pulsecast::detail::extend(box, {{0, 1, 2}, {3, 4, 5}});
  pulsecast::detail::extend(box, {{-1, 2, 3}, {1, 2, 9}});
  CHECK(box.min[0] == -1);
  CHECK(box.min[1] == 1);
  CHECK(box.min[2] == 2);
  CHECK(box.max[0] == 3);
  CHECK(box.max[1] == 4);
  CHECK(box.max[2] == 9);
}

TEST_CASE_TEMPLATE("a build sees every box but the empty ones, relative to the centre, never smaller than it is", Real, float, double) {
  Generator random(41);
  std::vector<Box> boxes;
  const Vec3 utm{4.7e5, 5.4e6, 300};
  for (int i = 0; i < 200; ++i) {
    Box box = random.box(500, 1e-3, 10);
    boxes.push_back({box.min + utm, box.max + utm});
  }
  boxes[3] = boxes[100] = Box{};
  const pulsecast::detail::BuildInput<Real> input(boxes);
  REQUIRE(input.primitives.size() == 198);
  for (const auto& [box, i] : input.primitives) {
    for (int k = 0; k < 3; ++k) {
      CHECK(static_cast<double>(box.min[k]) + input.centre[k] <= boxes[i].min[k]);
      CHECK(static_cast<double>(box.max[k]) + input.centre[k] >= boxes[i].max[k]);
    }
  }
}

TEST_CASE("boxes too far away and too many primitives are refused") {
  using Input = pulsecast::detail::BuildInput<float>;
  Box box{{0, 0, 0}, {1, 1, 1}};
  CHECK_NOTHROW(Input(std::span(&box, 1)));
  box.max.y = 1.1e18;
  CHECK_THROWS_AS(Input(std::span(&box, 1)), SettingError);
  box.max.y = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(Input(std::span(&box, 1)), SettingError);
  box.max.y = std::numeric_limits<double>::quiet_NaN();  // such a box is empty
  CHECK(Input(std::span(&box, 1)).primitives.empty());
  CHECK_THROWS_AS(Input(std::span<const Box>(&box, std::size_t{0xFFFFFFFF})), SettingError);  // refused before it is looked at
}

TEST_CASE("halving a number of parts takes as many levels as its binary logarithm, rounded up") {
  using pulsecast::detail::levels_of_halving;
  CHECK(levels_of_halving(0) == 0);
  CHECK(levels_of_halving(1) == 0);
  CHECK(levels_of_halving(2) == 1);
  CHECK(levels_of_halving(3) == 2);
  CHECK(levels_of_halving(1024) == 10);
  CHECK(levels_of_halving(1025) == 11);
  CHECK(levels_of_halving(std::size_t{1} << 32) == 32);
}
