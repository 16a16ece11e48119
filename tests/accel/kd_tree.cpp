// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/accel/kd_tree.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "support/scenes.hpp"

using namespace pulsecast;

static_assert(Accelerator<KdTree<float>>);
using namespace pulsecast::support;

static_assert(Accelerator<KdTree<double>>);

TEST_CASE_TEMPLATE("every primitive stands in a leaf of a KdTree, and in four on average at most", Real, float,
                   double) {
  Generator random(50);
  std::vector<Box> boxes;
  for (int i = 0; i < 5000; ++i) boxes.push_back(random.box(10, 1e-4, 10));
  const KdTree<Real> tree(boxes);
  std::size_t largest = 0, sum = 0;
  for (const std::size_t count : offers(tree, boxes.size(), largest)) {
    CHECK(count > 0);
    sum += count;
  }
  CHECK(sum <= 4 * boxes.size());
  CHECK(tree.depth() <= 64);
  CHECK(tree.memory() >= boxes.size() * sizeof(PrimitiveIndex));
}

TEST_CASE_TEMPLATE(
    "a KdTree has the same bytes on any number of threads, and of boxes that are made as they are asked for", Real,
    float, double) {
  Generator random(51);
  std::vector<Box> boxes;
  for (int i = 0; i < 40'000; ++i) boxes.push_back(random.box(100, 1e-3, 1));  // several chunks, and several subtrees
  struct Made {
    const std::vector<Box>& all;
    [[nodiscard]] std::size_t size() const noexcept { return all.size(); }
    [[nodiscard]] Box operator[](std::size_t i) const noexcept { return all[i]; }
  };
  const auto bytes_of = [](KdTree<Real> tree) {
    std::vector<std::byte> bytes;
    const auto add = [&](const auto& member) {
      if constexpr (requires { member.memory(); }) {
        const auto all = std::as_bytes(std::span(member.data(), member.size()));
        bytes.insert(bytes.end(), all.begin(), all.end());
      }
    };
    auto each = [&](const auto&... members) { (add(members), ...); };
    tree.archive(each);
    return bytes;
  };
  const auto alone = bytes_of(KdTree<Real>(boxes, 1));
  for (const unsigned threads : {2U, 5U}) CHECK(bytes_of(KdTree<Real>(Made{boxes}, threads)) == alone);
}

TEST_CASE_TEMPLATE("a KdTree of primitives that all stand at one point is one leaf", Real, float, double) {
  const std::vector<Box> boxes(10000, Box{{1, 2, 3}, {1, 2, 3}});
  const KdTree<Real> tree(boxes);
  std::size_t largest = 0;
  CHECK(offers(tree, boxes.size(), largest) == std::vector<std::size_t>(boxes.size(), 1));
  CHECK(tree.depth() == 0);
}

TEST_CASE_TEMPLATE("a KdTree parts small boxes that stand apart", Real, float, double) {
  std::vector<Box> boxes;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) boxes.push_back({{x * 10.0, y * 10.0, 0}, {x * 10.0 + 1, y * 10.0 + 1, 1}});
  const KdTree<Real> tree(boxes);
  std::size_t largest = 0;
  CHECK(offers(tree, boxes.size(), largest) == std::vector<std::size_t>(boxes.size(), 1));
  CHECK(largest == 1);
}

TEST_CASE("a KdTree of boxes that crowd at a point is no deeper than its limit, and still whole") {
  const std::vector<Box> boxes = crowd(2000, 0.75);
  const KdTree<double> tree(boxes);
  std::size_t largest = 0;
  for (const std::size_t count : offers(tree, boxes.size(), largest)) CHECK(count > 0);
  CHECK(tree.depth() <= 8 + 1.3 * std::log2(4000.0));
}

TEST_CASE("a KdTree goes into a narrow column of leaves for rays along an axis") {
  std::vector<Box> boxes;
  for (int x = 0; x < 50; ++x)
    for (int y = 0; y < 50; ++y) boxes.push_back({{x * 1.0, y * 1.0, 0}, {x + 1.0, y + 1.0, 0.1}});
  const KdTree<float> tree(boxes);
  const RayBundle rays = bundle_of({{25.5, 25.5, 100}, -axis::up});
  ClosestHits nearest(rays);
  std::size_t count = 0;
  tree.closest(
      rays, [&](std::span<const PrimitiveIndex> p) { count += p.size(); }, nearest);
  CHECK(count > 0);
  CHECK(count < 50);
}

TEST_CASE_TEMPLATE("a tree that was built is sound for as many primitives as it has, and for no fewer", Tree,
                   KdTree<float>, KdTree<double>) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    std::vector<Box> boxes;
    for (std::uint64_t n = 1 + random.whole(300); n > 0; --n) boxes.push_back(random.box(10, 1e-3, 10));
    const Tree tree(boxes);
    CHECK(tree.is_consistent(boxes.size()));
    CHECK_FALSE(tree.is_consistent(boxes.size() - 1));
  }
  CHECK(Tree(std::span<const Box>{}).is_consistent(0));
  CHECK(Tree(crowd(200, 0.5)).is_consistent(400));
  CHECK(Tree(DeserializeTag{}).is_consistent(0));
}

TEST_CASE_TEMPLATE("an archive whose nodes are no tree of 64 levels at most, or lead beyond it, is noticed", Real,
                   float, double) {
  const std::vector<Box> boxes{{{0, 0, 0}, {1, 1, 1}}};
  const KdTree<Real> tree(boxes);  // one leaf
  const auto is_sound = [&](std::size_t count, const auto& change) {
    return with_nodes(tree, count, change).is_consistent(boxes.size());
  };
  const auto chain = [](auto& nodes) {
    for (std::size_t i = 0; i + 2 < nodes.size(); i += 2) nodes[i].place(i + 1, 0);
  };
  CHECK(is_sound(1, chain));
  CHECK(is_sound(2 * 64 + 1, chain));
  CHECK_FALSE(is_sound(2 * 65 + 1, chain));
  for (std::size_t count = 2; count < 64; count += 2)
    CHECK_FALSE(is_sound(count, [&](auto& nodes) {
      chain(nodes);
      nodes[count - 2].place(count - 1, 0);  // the upper child is missing
    }));
  CHECK_FALSE(is_sound(6, [](auto& nodes) {
    nodes[0].place(1, 0);
    nodes[1].place(4, 0);
    nodes[2].place(3, 0);  // its upper child is the lower one of the node before
  }));
  CHECK_FALSE(is_sound(1, [](auto& nodes) { nodes[0].place(1, 3); }));
}
