// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/accel/binary_sah_tree.hpp>
#include <pulsecast/base/parallel.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast {

/// A tree of boxes with up to eight children a node, all of whose boxes a bundle is tested against at once. It is split in two by the
/// surface-area heuristic, down to single primitives; then some levels are made one, and up to `leaf_size` primitives a leaf, as costs
/// least. Every primitive stands in exactly one leaf. A bundle goes through it as a whole, front to back. Where a split would make the
/// binary tree deeper than 64 levels, it halves. The tree is the same for every number of threads that it is built on; 0 for as many as
/// the machine runs.
/// Source: Wald 2007 (build in bins); Wald, Boulos & Shirley 2007 (bundles by interval arithmetic); Wald, Benthin & Boulos 2008
/// (collapsing).
template <std::floating_point Real = float>
class Bvh {
 public:
  /// Of a span of boxes, or of anything that has a size and gives a `Box` of each number. Leaves of some primitives, at most 7, are for
  /// those that are tested several at once; where a test is a search of its own, as in the parts of a scene, take one a leaf, each behind
  /// its own box.
  explicit Bvh(const detail::BoxRangeRef& boxes, unsigned threads = 0, std::uint32_t leaf_size = 4) {
    require_within("Bvh::leaf_size", leaf_size, 1, 7, "");
    detail::BuildInput<Real> input(boxes, threads);
    bounds_ = input.bounds, centre_ = input.centre;
    if (input.primitives.empty()) return;
    const BinaryTree binary(input.primitives, leaf_size, threads);
    collapse(binary, threads);
  }

  explicit Bvh(DeserializeTag) {}
  template <class Archive>
  void archive(Archive& a) {
    a(bounds_, centre_, depth_, nodes_, primitives_);
  }

  /// Whether it is a tree at all, no deeper than it may be, and over so many primitives.
  [[nodiscard]] bool is_consistent(std::size_t primitives) const {
    std::vector<std::uint8_t> depths(nodes_.size());  // 0 where nothing leads to so far
    if (!depths.empty()) depths[0] = 1;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      if (depths[i] == 0 || depths[i] > detail::max_depth || node.boxes.count > places) return false;
      for (std::size_t place = 0; place < node.boxes.count; ++place) {
        const std::size_t first = node.first(place);
        if (node.size(place) > 0) {
          if (first > primitives_.size() || node.size(place) > primitives_.size() - first) return false;
        } else {
          if (first <= i || first >= nodes_.size() || depths[first] != 0) return false;
          depths[first] = static_cast<std::uint8_t>(depths[i] + 1);
        }
      }
    }
    return std::all_of(primitives_.begin(), primitives_.end(), [&](PrimitiveIndex i) { return i < primitives; });
  }

  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  [[nodiscard]] std::size_t memory() const noexcept { return nodes_.memory() + primitives_.memory(); }

  [[nodiscard]] std::span<const PrimitiveIndex> order() const noexcept { return {primitives_.data(), primitives_.size()}; }

  /// Steps from the root to the deepest leaf, at most 64.
  [[nodiscard]] std::size_t depth() const noexcept { return depth_; }

  template <class Test>
  requires std::invocable<const Test&, std::span<const PrimitiveIndex>>
  void closest(const RayBundle& rays, const Test& test, ClosestHits& nearest) const noexcept {
    if (nodes_.empty()) return;
    if (rays.size == 1)
      descend(RayInterval<Real>(rays, bounds_, centre_), rays, test, nearest);
    else
      descend(BundleInterval<Real>(rays, bounds_, centre_), rays, test, nearest);
  }

 private:
  using BinaryTree = detail::BinarySahTree<Real>;
  static constexpr std::size_t places = BinaryTree::places;

  struct alignas(64) Node {
    QuantizedBox8<Real> boxes;
    std::uint32_t children = 0;       ///< the first node below; the others follow it
    std::uint32_t primitives = 0;     ///< the first primitive of the leaves; the others follow it
    std::uint8_t kinds[places] = {};  ///< by place: the size of a leaf in the lower three bits, 0 for a node; above, where it follows

    [[nodiscard]] std::uint32_t size(std::size_t place) const noexcept { return kinds[place] & 7U; }
    [[nodiscard]] std::uint32_t first(std::size_t place) const noexcept {
      return (size(place) > 0 ? primitives : children) + (kinds[place] >> 3U);
    }
  };
  static_assert(sizeof(Node) == (sizeof(Real) == 4 ? 128 : 192));

  struct StackEntry {
    Real entry;
    std::uint32_t first, size;  ///< of a leaf's primitives, or the number of a node and 0
  };
  static constexpr std::uint32_t nothing = 0xFFFFFFFF;  ///< in place of a size

  template <class Interval, class Test>
  void descend(const Interval& interval, const RayBundle& rays, const Test& test, ClosestHits& nearest) const noexcept {
    std::array<StackEntry, (places - 1) * detail::max_depth + 1> stack;
    std::size_t stack_size = 0;
    Real limit = interval.limit(rays, nearest);
    const Node* node = nodes_.data();
    for (;;) {
      std::array<Real, places> entries;
      unsigned met = interval.inside(node->boxes, limit, entries);
      const auto take_first = [&]() noexcept -> StackEntry {
        const auto place = static_cast<std::size_t>(std::countr_zero(met));
        met &= met - 1;
        return {entries[place], node->first(place), node->size(place)};
      };
      StackEntry next{0, 0, nothing};
      if (met != 0) {  // the nearest at once; the others to the stack, the nearest of them on top
        next = take_first();
        const std::size_t bottom = stack_size;
        while (met != 0) {
          StackEntry other = take_first();
          if (other.entry < next.entry) std::swap(other, next);
          prefetch_entry(other, test);
          std::size_t at = stack_size++;
          for (; at > bottom && stack[at - 1].entry < other.entry; --at) stack[at] = stack[at - 1];
          stack[at] = other;
        }
      }
      while (next.size > 0) {
        if (next.size != nothing) {
          test(std::span<const PrimitiveIndex>(primitives_.data() + next.first, next.size));
          limit = interval.limit(rays, nearest);
        }
        do {
          if (stack_size == 0) return;
          next = stack[--stack_size];
        } while (next.entry > limit);
      }
      node = &nodes_[next.first];
    }
  }

  template <class Test>
  void prefetch_entry(const StackEntry& next, const Test& test) const noexcept {
    if (next.size == 0)
      prefetch(&nodes_[next.first]);
    else if constexpr (requires { test.prefetch(std::span<const PrimitiveIndex>()); })
      test.prefetch(std::span<const PrimitiveIndex>(primitives_.data() + next.first, next.size));
  }

  /// A node to be made of what is below one of the binary tree.
  struct Open {
    typename BinaryTree::Range range;
    std::uint32_t node, depth;
  };

  /// Makes the upper nodes one after another, and what is below them side by side: first by themselves, then where they stand in the end.
  void collapse(const BinaryTree& binary, unsigned threads) {
    const std::size_t count = binary.primitives().size();
    const SharedBuffer<PrimitiveIndex> primitives(count);
    std::vector<Node> upper(1);
    std::vector<Open> below;
    const std::size_t grain = std::max<std::size_t>(count / 64, 4096);
    std::size_t next = 0;
    std::size_t depth = make_nodes(
        binary, {binary.root(), 0, 1}, upper, primitives, next, [&](const Open& open) { return open.range.size() <= grain; }, below);
    struct Subtree {
      std::vector<Node> nodes;
      std::size_t first_node = 0, first_primitive = 0, depth = 0;
    };
    std::vector<Subtree> subtrees(below.size());
    for (std::size_t i = 0; i < below.size(); ++i) subtrees[i].first_primitive = next, next += below[i].range.size();
    for_each_index(below.size(), threads, [&](std::size_t i) {
      Subtree& own = subtrees[i];
      own.nodes.resize(1);
      std::size_t at = own.first_primitive;
      std::vector<Open> none;
      own.depth = make_nodes(
          binary, {below[i].range, 0, below[i].depth}, own.nodes, primitives, at, [](const Open&) { return false; }, none);
    });
    std::size_t nodes = upper.size();
    for (Subtree& own : subtrees) own.first_node = nodes, nodes += own.nodes.size() - 1, depth = std::max(depth, own.depth);
    const SharedBuffer<Node> all(nodes);
    std::copy(upper.begin(), upper.end(), all.begin());
    for_each_index(subtrees.size(), threads, [&](std::size_t i) {  // its first node takes the place that was left for it
      const Subtree& own = subtrees[i];
      for (std::size_t k = 0; k < own.nodes.size(); ++k) {
        Node& node = all[k == 0 ? below[i].node : own.first_node + k - 1] = own.nodes[k];
        node.children += static_cast<std::uint32_t>(own.first_node - 1);
      }
    });
    nodes_ = all, primitives_ = primitives, depth_ = depth;
  }

  /// Makes a node, for which there is a place, and all that is below it but for what is `left`, which goes to `below`. Gives the depth.
  template <class Left>
  static std::size_t make_nodes(const BinaryTree& binary, const Open& top, std::vector<Node>& nodes,
                                const SharedBuffer<PrimitiveIndex>& primitives, std::size_t& next, const Left& left,
                                std::vector<Open>& below) {
    std::size_t depth = 0;
    std::vector<Open> tasks{top};
    std::vector<typename BinaryTree::Range> children;
    while (!tasks.empty()) {
      const Open task = tasks.back();
      tasks.pop_back();
      if (left(task)) {
        below.push_back(task);
        continue;
      }
      children.clear();
      binary.gather(task.range, places, children);
      Node node;
      node.children = static_cast<std::uint32_t>(nodes.size()), node.primitives = static_cast<std::uint32_t>(next);
      node.boxes.begin(binary.box(task.range));
      for (std::size_t place = 0; place < children.size(); ++place) {
        const auto& child = children[place];
        node.boxes.add(binary.box(child));
        if (binary.leaf(child)) {
          node.kinds[place] = static_cast<std::uint8_t>((next - node.primitives) << 3U | child.size());
          for (std::uint32_t i = child.begin; i < child.end; ++i) primitives[next++] = binary.primitives()[i].primitive;
        } else {
          node.kinds[place] = static_cast<std::uint8_t>((nodes.size() - node.children) << 3U);
          tasks.push_back({child, static_cast<std::uint32_t>(nodes.size()), task.depth + 1});
          nodes.emplace_back();
        }
      }
      nodes[task.node] = node;
      depth = std::max<std::size_t>(depth, task.depth);
    }
    return depth;
  }

  Box bounds_;
  Vec3 centre_{};
  SharedArray<Node> nodes_;                 ///< the root first
  SharedArray<PrimitiveIndex> primitives_;  ///< of the leaves
  std::size_t depth_ = 0;
};

static_assert(Accelerator<Bvh<float>> && Accelerator<Bvh<double>>);

}  // namespace pulsecast
