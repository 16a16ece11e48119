// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/accel/refit.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using support::Generator;

namespace {

/// Primitives that a tree offers to a ray, sorted.
template <class Tree>
std::vector<PrimitiveIndex> offered(const Tree& tree, const RayBundle& rays) {
  std::vector<PrimitiveIndex> all;
  ClosestHits nearest(rays);
  tree.closest(
      rays, [&](std::span<const PrimitiveIndex> found) { all.insert(all.end(), found.begin(), found.end()); }, nearest);
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<Box> boxes_of(Generator& any, std::size_t count, double reach) {
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < count; ++i) boxes.push_back(any.box(reach, 1e-3, 1));
  return boxes;
}

std::vector<Box> shifted(std::vector<Box> boxes, Generator& any, double by) {
  for (Box& box : boxes) {
    const Vec3 shift = any.point(by);
    box = {box.min + shift, box.max + shift};
  }
  return boxes;
}

}  // namespace

TEST_CASE("the cost of a tree of two unit cubes is the share of their surfaces in that of the root") {
  const std::vector<Box> boxes{{{0, 0, 0}, {1, 1, 1}}, {{3, 0, 0}, {4, 1, 1}}};
  CHECK(BvhRefit<float>::cost(Bvh<float>(boxes, 1, 1)) == support::relative(6.0 / 9, 1e-3));
  CHECK(BvhRefit<float>::cost(Bvh<float>(std::vector<Box>(3), 1, 1)) == 0);
  CHECK(BvhRefit<float>::cost(Bvh<float>(std::vector<Box>(3, Box{{1, 2, 3}, {1, 2, 3}}), 1, 1)) == 0);
}

TEST_CASE_TEMPLATE("a refitted tree offers every primitive whose box the bundle meets", Real, float, double) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const double reach = any.log_uniform(1, 1e5);
    std::vector<Box> boxes = boxes_of(any, 1 + any.whole(300), reach);
    if (boxes.size() > 5) boxes[3] = boxes[5] = Box{};
    Bvh<Real> tree(boxes, 1, 1), to(std::vector<Box>(), 1, 1);
    BvhRefit<Real> refit, none;
    boxes = shifted(boxes, any, any.log_uniform(1e-3, 1) * reach);
    if (boxes.size() > 5) boxes[3] = boxes[5] = Box{};
    refit.update(tree, none, boxes, to);
    Box bounds;
    for (const Box& box : boxes) bounds.extend(box);
    CHECK(to.bounds() == bounds);
    for (int k = 0; k < 50; ++k) {
      const Box& aimed = boxes[any.whole(boxes.size())];
      if (aimed.empty()) continue;
      const Vec3 from = any.point(2 * reach), at = aimed.min + any.uniform() * aimed.size();
      const std::size_t size = any.coin() ? 1 : 1 + any.whole(RayBundle::capacity);
      const RayBundle rays = any.cone(from, normalize(at - from), 1e-3, size);
      const std::vector<PrimitiveIndex> found = offered(to, rays);
      REQUIRE(std::adjacent_find(found.begin(), found.end()) == found.end());
      for (PrimitiveIndex i = 0; i < boxes.size(); ++i) {
        if (boxes[i].empty()) continue;
        // a box of its own, tested by itself
        const std::vector<Box> own{boxes[i]};
        if (offered(Bvh<double>(own, 1, 1), rays).empty()) continue;
        const Vec3 centre = boxes[i].centre(), to_centre = centre - from;
        const double along = dot(to_centre, rays.direction(0));
        const Vec3 apart = from + along * rays.direction(0) - centre;
        const Vec3 half = 0.5 * boxes[i].size();
        if (std::fabs(apart.x) < half.x && std::fabs(apart.y) < half.y && std::fabs(apart.z) < half.z &&
            along > 0)  // surely met
          REQUIRE(std::binary_search(found.begin(), found.end(), i));
      }
    }
  }
}

TEST_CASE("a tree keeps its order while its boxes move little, and is made anew when they trade places") {
  Generator any(1);
  const std::vector<Box> boxes = boxes_of(any, 2000, 100);
  const Bvh<float> tree(boxes, 1, 1);
  const std::vector<PrimitiveIndex> order(tree.order().begin(), tree.order().end());
  const auto same_order = [&](const Bvh<float>& other) {
    return std::equal(order.begin(), order.end(), other.order().begin());
  };
  BvhRefit<float> first, second, none;
  Bvh<float> near(std::vector<Box>(), 1, 1), anywhere = near;
  first.update(tree, none, shifted(boxes, any, 0.5), near);
  CHECK(same_order(near));
  CHECK(BvhRefit<float>::cost(near) < 1.2 * BvhRefit<float>::cost(tree));
  const std::vector<Box> others = boxes_of(any, 2000, 100);
  second.update(near, first, others, anywhere);
  CHECK_FALSE(same_order(anywhere));
  CHECK(BvhRefit<float>::cost(anywhere) == BvhRefit<float>::cost(Bvh<float>(others, 1, 1)));
}

TEST_CASE("many small steps are measured against the last build, not against the step before") {
  Generator any(2);
  std::vector<Box> boxes = boxes_of(any, 1000, 100);
  const std::vector<Box> ends = boxes_of(any, 1000, 100), starts = boxes;
  Bvh<float> now(boxes, 1, 1), next(std::vector<Box>(), 1, 1);
  BvhRefit<float> state, next_state;
  const double built = BvhRefit<float>::cost(now);
  for (int step = 1; step <= 100; ++step) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Vec3 shift = 0.01 * step * (ends[i].centre() - starts[i].centre());
      boxes[i] = {starts[i].min + shift, starts[i].max + shift};
    }
    next_state.update(now, state, boxes, next);
    std::swap(now, next);
    std::swap(state, next_state);
    REQUIRE(BvhRefit<float>::cost(now) < 2.5 * built);  // without rebuilds it becomes ten times that
  }
}

TEST_CASE("boxes out of reach are refused") {
  const std::vector<Box> boxes{{{0, 0, 0}, {1, 1, 1}}, {{3, 0, 0}, {4, 1, 1}}},
      far{{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 0}, {2e18, 0, 0}}};
  const Bvh<float> tree(boxes, 1, 1);
  Bvh<float> to = tree;
  BvhRefit<float> refit, none;
  CHECK_THROWS_WITH_AS(refit.update(tree, none, far, to),
                       "Accelerator::boxes is 2e+18 m, but must be within 1e18 m of the origin", SettingError);
}

TEST_CASE_TEMPLATE(
    "a ray along a side of a box meets it, far from the origin, and however small the box is in the world", Real, float,
    double) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const double reach = any.log_uniform(1, 1e5);
    const Vec3 place = any.point(1e6);
    std::vector<Box> boxes = boxes_of(any, 1 + any.whole(seed % 2 ? 8 : 300), reach);
    for (Box& box : boxes) box = {place + box.min, place + box.max};
    const Bvh<Real> tree(boxes, 1, 1);
    Bvh<Real> to(std::vector<Box>(), 1, 1);
    BvhRefit<Real> refit, none;
    boxes = shifted(boxes, any, 1e-3 * reach);
    Box bounds;
    for (const Box& box : boxes) bounds.extend(box);
    const auto box_of = [&](std::span<const PrimitiveIndex> some) { return boxes[some[0]]; };
    REQUIRE(refit.refit(tree, none, bounds, box_of, to));
    for (int k = 0; k < 200; ++k) {
      const auto aimed = static_cast<PrimitiveIndex>(any.whole(boxes.size()));
      const Box& box = boxes[aimed];
      Vec3 from, along{};
      for (int axis = 0; axis < 3; ++axis) from[axis] = any.coin() ? box.min[axis] : box.max[axis];
      const auto axis = static_cast<int>(any.whole(3));
      along[axis] = any.coin() ? 1 : -1;
      from[axis] -= 3 * reach * along[axis];
      const std::vector<PrimitiveIndex> found = offered(to, bundle_of({from, along}));
      REQUIRE(std::binary_search(found.begin(), found.end(), aimed));
    }
  }
}

TEST_CASE("a copy of a refitted tree stays as it is when its memory is asked for again") {
  Generator any(3);
  const std::vector<Box> boxes = boxes_of(any, 100, 10);
  const Bvh<float> tree(boxes, 1, 1);
  Bvh<float> to(std::vector<Box>(), 1, 1);
  BvhRefit<float> refit, none;
  refit.update(tree, none, boxes, to);
  const Bvh<float> copy = to;
  std::vector<Box> away = boxes;
  for (Box& box : away) box = {box.min + Vec3{50, 0, 0}, box.max + Vec3{50, 20, 0}};
  const double cost = BvhRefit<float>::cost(copy);
  refit.update(tree, none, away, to);
  CHECK(BvhRefit<float>::cost(copy) == cost);
}

TEST_CASE("a tree made anew is the measure of the refits after it") {
  Generator any(4);
  std::vector<Box> boxes;
  for (int i = 0; i < 1000; ++i) boxes.push_back(any.box(100, 1e-3, 2e-3));
  const Bvh<float> tree(boxes, 1, 1);
  Bvh<float> large(std::vector<Box>(), 1, 1), moved = large;
  BvhRefit<float> first, second, none;
  for (Box& box : boxes) box = {box.min, box.max + Vec3{40, 40, 40}};  // no order is as cheap as before
  first.update(tree, none, boxes, large);
  REQUIRE(BvhRefit<float>::cost(large) > BvhRefit<float>::max_growth * BvhRefit<float>::cost(tree));
  boxes = shifted(boxes, any, 1);
  second.update(large, first, boxes, moved);
  CHECK(std::equal(large.order().begin(), large.order().end(), moved.order().begin()));
  const Bvh<float> anew(boxes, 1, 1);
  CHECK_FALSE(std::equal(large.order().begin(), large.order().end(), anew.order().begin()));
}
