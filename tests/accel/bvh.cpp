// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/accel/bvh.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include "support/scenes.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

static_assert(sizeof(BoundingBox<float>) == 24);

TEST_CASE_TEMPLATE("every primitive stands in exactly one leaf of a Bvh, and leaves are small", Real, float, double) {
  Generator random(50);
  std::vector<Box> boxes;
  for (int i = 0; i < 5000; ++i) boxes.push_back(random.box(10, 1e-4, 10));
  const Bvh<Real> tree(boxes);
  std::size_t largest = 0;
  CHECK(offers(tree, boxes.size(), largest) == std::vector<std::size_t>(boxes.size(), 1));
  CHECK(largest <= 8);
  CHECK(tree.depth() <= 64);
  CHECK(tree.memory() >= boxes.size() * sizeof(PrimitiveIndex));
}

TEST_CASE_TEMPLATE("a Bvh of primitives that all stand at one point is halved", Real, float, double) {
  const std::vector<Box> boxes(10000, Box{{1, 2, 3}, {1, 2, 3}});
  const Bvh<Real> tree(boxes);
  std::size_t largest = 0;
  CHECK(offers(tree, boxes.size(), largest) == std::vector<std::size_t>(boxes.size(), 1));
  CHECK(largest <= 8);
  CHECK(tree.depth() <= 14);
}

TEST_CASE("a Bvh of boxes that crowd at a point is no deeper than 64 levels, and still whole") {
  const std::vector<Box> boxes = crowd(2000, 0.75);  // one bin in 16 takes off about ten boxes a level
  const Bvh<double> tree(boxes);
  std::size_t largest = 0;
  CHECK(offers(tree, boxes.size(), largest) == std::vector<std::size_t>(boxes.size(), 1));
  CHECK(tree.depth() <= 64);
  CHECK(tree.depth() > 55);  // it came near to the limit, or this is no test of it
}

TEST_CASE_TEMPLATE("a Bvh of nothing, or of empty boxes only, is never met", Real, float, double) {
  std::size_t largest = 0;
  CHECK(offers(Bvh<Real>({}), 0, largest).empty());
  const std::vector<Box> empty(5);
  CHECK(offers(Bvh<Real>(empty), 5, largest) == std::vector<std::size_t>(5, 0));
  CHECK(Bvh<Real>(empty).bounds().empty());
  CHECK(Bvh<Real>(empty).memory() == 0);
}

TEST_CASE("a Bvh leaves out empty boxes among others") {
  Generator random(52);
  std::vector<Box> boxes;
  for (int i = 0; i < 100; ++i) boxes.push_back(i % 3 == 0 ? Box{} : random.box(10, 1e-2, 1));
  std::size_t largest = 0;
  const auto count = offers(Bvh<>(boxes), boxes.size(), largest);
  for (std::size_t i = 0; i < boxes.size(); ++i) CHECK((count[i] > 0) == (i % 3 != 0));
}

TEST_CASE("a Bvh of more than 2^32 - 2 primitives is refused") {
  const Box box{{0, 0, 0}, {1, 1, 1}};
  CHECK_THROWS_AS(Bvh<>(std::span<const Box>(&box, std::size_t{0xFFFFFFFF})), SettingError);
}

TEST_CASE_TEMPLATE("a Bvh is not entered by rays that are not numbers, nor by those that pass by or end before", Real, float, double) {
  Generator random(53);
  std::vector<Box> boxes;
  for (int i = 0; i < 100; ++i) boxes.push_back(random.box(10, 1e-2, 1));
  const Bvh<Real> tree(boxes);
  const auto tested = [&](const Ray& ray) {
    const RayBundle rays = bundle_of(ray);
    Nearest nearest(rays);
    std::size_t count = 0;
    tree.closest(
        rays, [&](std::span<const PrimitiveIndex> p) { count += p.size(); }, nearest);
    return count;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(tested({boxes[0].centre() - Vec3{0, 50, 0}, forward}) > 0);
  CHECK(tested({boxes[0].centre() - Vec3{0, 50, 0}, -forward}) == 0);
  CHECK(tested({boxes[0].centre() - Vec3{0, 50, 0}, forward, 0, 10}) == 0);
  CHECK(tested({boxes[0].centre() - Vec3{0, 50, 0}, forward, 100, 1000}) == 0);
  CHECK(tested({Vec3{nan, 0, 0}, forward}) == 0);
  CHECK(tested({boxes[0].centre(), Vec3{nan, nan, nan}}) == 0);
  CHECK(tested({boxes[0].centre(), Vec3{0, 1, nan}}) == 0);
}
