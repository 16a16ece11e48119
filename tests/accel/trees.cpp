// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include <pulsecast/accel/bvh.hpp>
#include <pulsecast/accel/kd_tree.hpp>

#include "support/scenes.hpp"

// What holds of every tree, whatever its kind and precision.

using namespace pulsecast;
using namespace pulsecast::support;

#define TREES Bvh<float>, Bvh<double>, KdTree<float>, KdTree<double>

TEST_CASE_TEMPLATE("a tree of nothing, or of empty boxes only, is never met", Tree, TREES) {
  std::size_t largest = 0;
  CHECK(offers(Tree(std::span<const Box>{}), 0, largest).empty());
  const std::vector<Box> empty(5);
  CHECK(offers(Tree(empty), 5, largest) == std::vector<std::size_t>(5, 0));
  CHECK(Tree(empty).bounds().empty());
  CHECK(Tree(empty).memory() == 0);
}

TEST_CASE_TEMPLATE("a tree leaves out empty boxes among others", Tree, TREES) {
  Generator random(52);
  std::vector<Box> boxes;
  for (int i = 0; i < 100; ++i) boxes.push_back(i % 3 == 0 ? Box{} : random.box(10, 1e-2, 1));
  std::size_t largest = 0;
  const auto count = offers(Tree(boxes), boxes.size(), largest);
  for (std::size_t i = 0; i < boxes.size(); ++i) CHECK((count[i] > 0) == (i % 3 != 0));
}

TEST_CASE_TEMPLATE("a tree is not entered by rays that are not numbers, nor by those that pass by or end before", Tree,
                   TREES) {
  Generator random(53);
  std::vector<Box> boxes;
  for (int i = 0; i < 100; ++i) boxes.push_back(random.box(10, 1e-2, 1));
  const Tree tree(boxes);
  const auto tested = [&](const Ray& ray) {
    const RayBundle rays = bundle_of(ray);
    ClosestHits nearest(rays);
    std::size_t count = 0;
    tree.closest(
        rays, [&](std::span<const PrimitiveIndex> p) { count += p.size(); }, nearest);
    return count;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(tested({boxes[0].centre() - Vec3{0, 50, 0}, axis::forward}) > 0);
  CHECK(tested({boxes[0].centre() - Vec3{0, 50, 0}, -axis::forward}) == 0);
  CHECK(tested({boxes[0].centre() - Vec3{0, 50, 0}, axis::forward, 0, 10}) == 0);
  CHECK(tested({boxes[0].centre() - Vec3{0, 50, 0}, axis::forward, 100, 1000}) == 0);
  CHECK(tested({Vec3{nan, 0, 0}, axis::forward}) == 0);
  CHECK(tested({boxes[0].centre(), Vec3{nan, nan, nan}}) == 0);
  CHECK(tested({boxes[0].centre(), Vec3{0, 1, nan}}) == 0);
}
