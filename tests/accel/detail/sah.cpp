// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/accel/detail/sah.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

/// A corner of a box; the fourth lane means nothing.
template <class Real>
simd::Vec4<Real> corner(Real x, Real y, Real z) {
  const Real all[4] = {x, y, z, std::numeric_limits<Real>::quiet_NaN()};
  return simd::Vec4<Real>::from(all[0]);
}

/// Slices along the second axis alone.
template <class Real>
pulsecast::detail::Slices<Real> slices_of(Real low, Real high, std::size_t count) {
  return {corner<Real>(0, low, 0), corner<Real>(0, high, 0), count};
}

}  // namespace

TEST_CASE_TEMPLATE("slices are numbered in order, begin at their edge, and take in what lies outside", Real, float,
                   double) {
  const auto slices = slices_of<Real>(-4, 4, 16);
  const auto of = [&](Real y) { return slices.of(corner<Real>(7, y, -7))[1]; };
  CHECK(slices.count() == 16);
  CHECK(slices.valid(1));
  CHECK(slices.edge(1, 0) == -4);
  CHECK(slices.edge(1, 8) == 0);
  CHECK(of(-4) == 0);
  CHECK(of(static_cast<Real>(-3.75)) == 0);
  CHECK(of(static_cast<Real>(-3.25)) == 1);
  CHECK(of(4) == 15);
  CHECK(of(-1000) == 0);
  CHECK(of(static_cast<Real>(1e30)) == 15);
  CHECK(of(std::numeric_limits<Real>::quiet_NaN()) == 0);
  std::size_t before = 0, different = 0;
  for (Real y = -5; y < 5; y += static_cast<Real>(0.01)) {
    CHECK(of(y) >= before);
    before = of(y);
    for (std::size_t i = 1; i < 16; ++i) different += slices.reaches(1, y, i) == (before >= i) ? 0 : 1;
  }
  CHECK(different == 0);
}

TEST_CASE_TEMPLATE("axes are sliced each by itself; one without length, or too short to divide, is not", Real, float,
                   double) {
  const pulsecast::detail::Slices<Real> slices(corner<Real>(0, 5, -1), corner<Real>(4, 5, 1), 4);
  CHECK(slices.valid(0));
  CHECK_FALSE(slices.valid(1));
  CHECK(slices.valid(2));
  CHECK(slices.of(corner<Real>(static_cast<Real>(3.5), 5, static_cast<Real>(-0.25))) ==
        std::array<std::uint32_t, 3>{3, 0, 1});
  CHECK_FALSE(slices_of<Real>(3, 2, 16).valid(1));
  CHECK_FALSE(slices_of<Real>(0, std::numeric_limits<Real>::denorm_min(), 16).valid(1));
  CHECK(slices_of<Real>(3, 4, 16).valid(1));
}

TEST_CASE("half of the surface of a box is that of three of its sides") {
  CHECK(pulsecast::detail::half_area(BoundingBox<float>{{0, 0, 0}, {2, 3, 4}}) == 26);
  CHECK(pulsecast::detail::half_area(BoundingBox<double>{{1, 1, 1}, {1, 1, 1}}) == 0);
}

TEST_CASE_TEMPLATE("a box that takes in others holds them", Real, float, double) {
  const pulsecast::detail::Boxed<Real> boxes[2] = {{{{0, 1, 2}, {3, 4, 5}}, 0xFFFFFFFE}, {{{-1, 2, 3}, {1, 2, 9}}, 1}};
  pulsecast::detail::GrowingBox<Real> growing;
  for (const auto& boxed : boxes) growing.extend(boxed.low(), boxed.high());
  const BoundingBox<Real> box = growing.box();
  CHECK(box.min[0] == -1);
  CHECK(box.min[1] == 1);
  CHECK(box.min[2] == 2);
  CHECK(box.max[0] == 3);
  CHECK(box.max[1] == 4);
  CHECK(box.max[2] == 9);
  CHECK(growing.half_area() == pulsecast::detail::half_area(box));
}

TEST_CASE_TEMPLATE("a build sees every box but the empty ones, relative to the centre, never smaller than it is", Real,
                   float, double) {
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
  box = {{0, -1.1e18, 0}, {1, 1, 1}};
  CHECK_THROWS_AS(Input(std::span(&box, 1)), SettingError);
  CHECK_THROWS_AS(Input(std::span<const Box>(&box, std::size_t{0xFFFFFFFF})),
                  SettingError);  // refused before it is looked at
}
