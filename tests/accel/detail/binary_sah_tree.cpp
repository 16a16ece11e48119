// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/accel/detail/binary_sah_tree.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

template <class Real>
using Tree = pulsecast::detail::BinarySahTree<Real>;

std::vector<Box> random_boxes(std::uint64_t seed, std::size_t count) {
  Generator random(seed);
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < count; ++i) boxes.push_back(random.box(100, 1e-3, 1));
  return boxes;
}

template <class Real>
bool holds(const BoundingBox<Real>& outer, const BoundingBox<Real>& inner) {
  for (int k = 0; k < 3; ++k)
    if (inner.min[k] < outer.min[k] || inner.max[k] > outer.max[k]) return false;
  return true;
}

/// What becomes of a binary tree as an 8-wide tree: sizes of leaves, and how many nodes do not hold all that is below
/// them.
struct Shape {
  std::size_t nodes = 0, primitives = 0, largest_leaf = 0, max_children = 0, torn = 0;
  std::vector<std::uint32_t> leaves{};  ///< where each begins, in the order in which they are met
};

template <class Real>
Shape shape_of(const Tree<Real>& tree) {
  Shape shape;
  std::vector<typename Tree<Real>::Range> open{tree.root()};
  while (!open.empty()) {
    const auto range = open.back();
    open.pop_back();
    ++shape.nodes;
    typename Tree<Real>::Children children;
    tree.gather(range, 8, children);
    shape.max_children = std::max(shape.max_children, children.count);
    std::uint32_t at = range.begin;
    for (const auto& child : std::span(children.ranges).first(children.count)) {
      if (child.begin != at || !holds(tree.box(range), tree.box(child))) ++shape.torn;
      at = child.end;
      if (!tree.leaf(child)) {
        open.push_back(child);
        continue;
      }
      shape.primitives += child.size();
      shape.leaves.push_back(child.begin);
      shape.largest_leaf = std::max<std::size_t>(shape.largest_leaf, child.size());
      for (std::uint32_t i = child.begin; i < child.end; ++i)
        if (!holds(tree.box(child), tree.primitives()[i].box)) ++shape.torn;
    }
    if (at != range.end) ++shape.torn;
  }
  return shape;
}

}  // namespace

TEST_CASE_TEMPLATE("a binary tree holds every primitive once, in boxes that hold what is below", Real, float, double) {
  for (const std::size_t count : {1U, 2U, 3U, 4U, 5U, 9U, 100U, 5000U}) {
    CAPTURE(count);
    pulsecast::detail::BuildInput<Real> input(random_boxes(60 + count, count));
    const Tree<Real> tree(input.primitives, 4, 1);
    const Shape shape = shape_of(tree);
    CHECK(shape.torn == 0);
    CHECK(shape.primitives == count);
    CHECK(shape.largest_leaf <= 4);
    CHECK(shape.max_children <= 8);
    std::vector<int> seen(count);
    for (const auto& boxed : tree.primitives()) ++seen[boxed.primitive];
    CHECK(seen == std::vector<int>(count, 1));
  }
}

TEST_CASE("boxes in a row are put in leaves of neighbours") {
  std::vector<Box> boxes;
  for (int i = 0; i < 64; ++i) boxes.push_back({{i * 10.0, 0, 0}, {i * 10.0 + 1, 1, 1}});
  pulsecast::detail::BuildInput<double> input(boxes);
  const Tree<double> tree(input.primitives, 4, 1);
  for (std::uint32_t i = 0; i < 64; ++i) CHECK(tree.primitives()[i].primitive == i);
  CHECK(shape_of(tree).nodes == 9);  // eight leaves of eight would be too large, so eight nodes and one above
}
