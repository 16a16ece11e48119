// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/accel/detail/kd_tree_builder.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

template <class Real>
struct Node {
  int split_axis = 3;
  std::uint32_t count = 0;
  std::uint32_t index = 0;
  Real split = 0;

  [[nodiscard]] int axis() const noexcept { return split_axis; }
  [[nodiscard]] std::size_t first() const noexcept { return index; }
  [[nodiscard]] static Node inner(std::size_t first, int axis, Real at) noexcept {
    return {axis, 0, static_cast<std::uint32_t>(first), at};
  }
  bool operator==(const Node&) const = default;
  void place(std::size_t first, int axis) noexcept {
    split_axis = axis;
    index = static_cast<std::uint32_t>(first);
  }
};

template <class Real>
using Builder = pulsecast::detail::KdTreeBuilder<Real, Node<Real>>;
template <class Real>
using Boxed = pulsecast::detail::Boxed<Real>;

/// Follows primitives down a tree, and counts what is not in depth-first order, or in a leaf that it does not reach.
template <class Real>
struct Walk {
  const SharedArray<Node<Real>> nodes;
  const SharedArray<PrimitiveIndex> order;
  std::size_t next_node = 1, next_reference = 0, depth = 0, wrong = 0;

  explicit Walk(const Builder<Real>& tree) : nodes(tree.nodes), order(tree.order) {}

  void follow(std::size_t i, std::size_t level, const std::vector<Boxed<Real>>& part) {
    const Node<Real>& node = nodes[i];
    depth = std::max(depth, level);
    if (node.axis() == 3) {
      if (node.first() != next_reference || node.count != part.size()) ++wrong;
      for (const Boxed<Real>& boxed : part)
        if (next_reference >= order.size() || order[next_reference++] != boxed.primitive) ++wrong;
      return;
    }
    if (node.first() != next_node) ++wrong;
    next_node += 2;
    std::vector<Boxed<Real>> lower, upper;
    for (const Boxed<Real>& boxed : part) {
      const Real min = boxed.box.min[node.axis()], max = boxed.box.max[node.axis()];
      if (min < node.split || max <= node.split) lower.push_back(boxed);
      if (max > node.split) upper.push_back(boxed);
    }
    follow(node.first(), level + 1, lower);
    follow(node.first() + 1, level + 1, upper);
  }
};

template <class Real>
bool same(const Builder<Real>& a, const Builder<Real>& b) {
  return std::ranges::equal(a.nodes, b.nodes) && std::ranges::equal(a.order, b.order) && a.depth == b.depth;
}

}  // namespace

TEST_CASE_TEMPLATE("leaves hold what reaches them, in depth-first order, the same on any number of threads", Real,
                   float, double) {
  for (const std::size_t count : {1U, 2U, 100U, 4096U, 4097U, 40'000U})
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      CAPTURE(count);
      CAPTURE(seed);
      Generator random(seed);
      std::vector<Box> boxes;
      for (std::size_t i = 0; i < count; ++i) boxes.push_back(random.box(100, 1e-3, seed == 0 ? 0.1 : 10));
      if (seed == 2)  // chunks of different bounds
        std::sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.min.y < b.min.y; });
      const pulsecast::detail::BuildInput<Real> input(boxes);
      const Builder<Real> alone(input.primitives, 1);
      Walk<Real> walk(alone);
      walk.follow(0, 0, {input.primitives.begin(), input.primitives.end()});
      CHECK(walk.wrong == 0);
      CHECK(walk.next_node == alone.nodes.size());
      CHECK(walk.next_reference == alone.order.size());
      CHECK(walk.depth == alone.depth);
      CHECK(alone.order.size() <= 4 * count);
      for (const unsigned threads : {2U, 5U}) CHECK(same(Builder<Real>(input.primitives, threads), alone));
    }
}

TEST_CASE_TEMPLATE("equal boxes in a row are split in the middle, however many chunks they are", Real, float, double) {
  constexpr std::size_t count = 1U << 16;
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(i);
    boxes.push_back({{x, 0, 0}, {x + 1, 1, 1}});
  }
  const pulsecast::detail::BuildInput<Real> input(boxes);
  const Builder<Real> tree(input.primitives, 2);
  const auto check = [&](const auto& self, std::size_t node, double low, double high) -> void {
    if (high - low < 1024) return;
    REQUIRE(tree.nodes[node].axis() == 0);
    const double split = static_cast<double>(tree.nodes[node].split);
    CHECK(split == doctest::Approx((low + high) / 2).epsilon(1e-3));
    self(self, tree.nodes[node].first(), low, split);
    self(self, tree.nodes[node].first() + 1, split, high);
  };
  check(check, 0, -0.5 * count, 0.5 * count);
}

TEST_CASE_TEMPLATE("many boxes at one point are a leaf beside the others", Real, float, double) {
  std::vector<Box> boxes(20'000, Box{{50, 50, 50}, {50, 50, 50}});
  Generator random(7);
  for (int i = 0; i < 20'000; ++i) boxes.push_back(random.box(10, 1e-3, 0.1));
  const pulsecast::detail::BuildInput<Real> input(boxes);
  const Builder<Real> tree(input.primitives, 2);
  Walk<Real> walk(tree);
  walk.follow(0, 0, {input.primitives.begin(), input.primitives.end()});
  CHECK(walk.wrong == 0);
  const auto nodes = tree.nodes;
  CHECK(std::count_if(nodes.begin(), nodes.end(),
                      [](const Node<Real>& n) { return n.axis() == 3 && n.count == 20'000; }) == 1);
}
