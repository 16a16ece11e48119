// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/accel/bvh.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "support/scenes.hpp"

using namespace pulsecast;

static_assert(Accelerator<Bvh<float>> && MissesCones<Bvh<float>>);
using namespace pulsecast::support;

static_assert(Accelerator<Bvh<double>>);

static_assert(sizeof(BoundingBox<float>) == 24);

TEST_CASE_TEMPLATE("every primitive stands in exactly one leaf of a Bvh, beside three others at most", Real, float,
                   double) {
  Generator random(50);
  std::vector<Box> boxes;
  for (int i = 0; i < 5000; ++i) boxes.push_back(random.box(10, 1e-4, 10));
  const Bvh<Real> tree(boxes);
  std::size_t largest = 0;
  CHECK(offers(tree, boxes.size(), largest) == std::vector<std::size_t>(boxes.size(), 1));
  CHECK(largest <= 4);
  CHECK(tree.depth() <= 64);
  const double bytes = static_cast<double>(tree.memory()) / static_cast<double>(boxes.size());
  CAPTURE(bytes);
  CHECK(bytes < 20 * sizeof(Real));
}

TEST_CASE_TEMPLATE("a Bvh of primitives that all stand at one point is halved", Real, float, double) {
  const std::vector<Box> boxes(10000, Box{{1, 2, 3}, {1, 2, 3}});
  const Bvh<Real> tree(boxes);
  std::size_t largest = 0;
  CHECK(offers(tree, boxes.size(), largest) == std::vector<std::size_t>(boxes.size(), 1));
  CHECK(largest <= 4);
  CHECK(tree.depth() <= 14);
}

TEST_CASE_TEMPLATE("a Bvh of the halves of a square is one leaf, one of boxes apart has a leaf each", Real, float,
                   double) {
  const Box square{{0, 0, 0}, {1, 1, 0}};
  for (const double apart : {0.0, 0.4, 2.0}) {
    const std::vector<Box> boxes{square, {square.min + Vec3{apart, 0, 0}, square.max + Vec3{apart, 0, 0}}};
    std::size_t largest = 0;
    CHECK(offers(Bvh<Real>(boxes), boxes.size(), largest) == std::vector<std::size_t>(2, 1));
    CHECK(largest == (apart > 1 ? 1 : 2));
  }
}

TEST_CASE("a Bvh of boxes that crowd at a point is no deeper than 64 levels, and still whole") {
  const std::vector<Box> boxes = crowd(2000, 0.75);  // one bin in 16 takes off about ten boxes a level
  const Bvh<double> tree(boxes);
  std::size_t largest = 0;
  CHECK(offers(tree, boxes.size(), largest) == std::vector<std::size_t>(boxes.size(), 1));
  CHECK(tree.depth() <= 64);
  CHECK(tree.depth() > 40);  // it came near to the limit: 510 without one
}

TEST_CASE_TEMPLATE("a Bvh is the same on any number of threads, and of boxes that are made as they are asked for", Real,
                   float, double) {
  Generator random(51);
  std::vector<Box> boxes;
  for (int i = 0; i < 40'000; ++i) boxes.push_back(random.box(100, 1e-3, 1));  // several chunks, and several subtrees
  std::sort(boxes.begin(), boxes.end(),
            [](const Box& a, const Box& b) { return a.min.y < b.min.y; });  // chunks of different bounds
  struct Made {
    const std::vector<Box>& all;
    [[nodiscard]] std::size_t size() const noexcept { return all.size(); }
    [[nodiscard]] Box operator[](std::size_t i) const noexcept { return all[i]; }
  };
  const Bvh<Real> alone(boxes, 1);
  std::size_t largest = 0;
  CHECK(offers(alone, boxes.size(), largest) == std::vector<std::size_t>(boxes.size(), 1));
  CHECK(alone.is_consistent(boxes.size()));
  for (const unsigned threads : {2U, 5U}) {
    CAPTURE(threads);
    const Bvh<Real> other(Made{boxes}, threads);
    CHECK(std::equal(other.order().begin(), other.order().end(), alone.order().begin(), alone.order().end()));
    CHECK(other.memory() == alone.memory());
    CHECK(other.depth() == alone.depth());
    CHECK(other.is_consistent(boxes.size()));
    CHECK(offers(other, boxes.size(), largest) == std::vector<std::size_t>(boxes.size(), 1));
  }
}

TEST_CASE_TEMPLATE("an archive whose nodes are no tree of 64 levels at most, or lead beyond it, is noticed", Real,
                   float, double) {
  const std::vector<Box> boxes{{{0, 0, 0}, {1, 1, 1}}, {{5, 0, 0}, {6, 1, 1}}, {{50, 0, 0}, {51, 1, 1}}};
  const Bvh<Real> tree(boxes, 1, 1);  // one node of three leaves
  const auto is_sound = [&](std::size_t count, const auto& change) {
    return with_nodes(tree, count, change).is_consistent(boxes.size());
  };
  const auto chain = [](auto& nodes) {
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      nodes[i].size[0] = 0;
      nodes[i].first[0] = static_cast<std::uint32_t>(i + 1);
    }
  };
  CHECK(is_sound(1, chain));
  CHECK(is_sound(64, chain));
  CHECK_FALSE(is_sound(65, chain));
  CHECK_FALSE(is_sound(2, [](auto&) {}));  // the second node has no parent
  CHECK_FALSE(is_sound(2, [&](auto& nodes) {
    chain(nodes);
    nodes[0].size[1] = 0;  // the second node twice
    nodes[0].first[1] = 1;
  }));
  for (std::size_t count = 1; count < 64; ++count)
    CHECK_FALSE(is_sound(count, [&](auto& nodes) {
      chain(nodes);
      nodes.back().size[0] = 0;  // a node that is missing
      nodes.back().first[0] = static_cast<std::uint32_t>(count);
    }));
  CHECK_FALSE(is_sound(1, [](auto& nodes) { nodes[0].first[0] = 3; }));
  CHECK_FALSE(is_sound(1, [](auto& nodes) { nodes[0].used = 5; }));
}

TEST_CASE_TEMPLATE("a cone that misses a Bvh comes near none of its boxes, and one between distant boxes misses it",
                   Real, float, double) {
  std::size_t missed = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Box> boxes;
    for (std::uint64_t k = any.whole(300); k < 301; ++k) boxes.push_back(any.box(10, 1e-4, 0.5));
    const Bvh<Real> tree(boxes);
    for (int k = 0; k < 20; ++k) {
      const RayCone cone{.origin = any.point(20), .direction = any.unit(), .spread = any.log_uniform(1e-5, 0.1)};
      if (!tree.misses_cone(cone)) continue;
      ++missed;
      const RayBundle rays = any.cone(cone.origin, cone.direction, 2 * std::asin(cone.spread / 2), RayBundle::capacity);
      for (const Box& box : boxes)
        for (std::size_t j = 0; j < rays.size; ++j)
          REQUIRE(RayCone{rays.origin, rays.direction(j)}.passes({box.min + 1e-5, box.max - 1e-5}));
    }
  }
  CHECK(missed > 500);
  std::vector<Box> corners;
  for (int i = 0; i < 100; ++i)
    for (const double at : {0.0, 100.0}) corners.push_back({{at, at, 0.01 * i}, {at + 1, at + 1, 0.01 * i + 1}});
  const Bvh<Real> apart(corners);
  CHECK(apart.misses_cone({.origin = {50, -1, 0.5}, .spread = 0.01}));
  CHECK_FALSE(apart.misses_cone({.origin = {0.5, -1, 0.5}, .spread = 0.01}));
  CHECK(Bvh<Real>(std::span<const Box>{}).misses_cone({}));
}
