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
#include <vector>

#include <pulsecast/accel/two_tree.hpp>
#include <pulsecast/base/frozen.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast {

/// A tree of boxes with up to eight children a node, all of whose boxes a bundle is tested against at once. It is split in two by the
/// surface-area heuristic, down to single primitives; then some levels are made one, and up to four primitives a leaf, as costs least.
/// Every primitive stands in exactly one leaf. A bundle goes through it as a whole, front to back. Where a split would make the tree of
/// twos deeper than 64 levels, halves are made. The tree is the same for every number of threads that it is built on; 0 for as many as
/// the machine runs.
/// Source: Wald 2007 (build in bins); Wald, Boulos & Shirley 2007 (bundles by interval arithmetic); Wald, Benthin & Boulos 2008
/// (collapsing).
template <std::floating_point Real = float>
class Bvh {
 public:
  explicit Bvh(std::span<const Box> boxes, unsigned threads = 0) {
    detail::BuildInput<Real> input(boxes);
    bounds_ = input.bounds, centre_ = input.centre;
    if (input.primitives.empty()) return;
    Twos twos(input.primitives, threads);
    collapse(twos);
  }

  explicit Bvh(Unfilled) {}
  template <class Archive>
  void archive(Archive& a) {
    a(bounds_, centre_, depth_, nodes_, primitives_);
  }

  /// Whether it is a tree at all, no deeper than it may be, and over so many primitives.
  [[nodiscard]] bool sound(std::size_t primitives) const {
    std::vector<std::uint8_t> depths(nodes_.size());  // 0 where nothing leads to so far
    if (!depths.empty()) depths[0] = 1;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      if (depths[i] == 0 || depths[i] > detail::deepest || node.boxes.count > places) return false;
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
  void closest(const RayBundle& rays, const Test& test, Nearest& nearest) const noexcept {
    if (nodes_.empty()) return;
    const BundleInterval<Real> interval(rays, bounds_, centre_);
    std::array<Waiting, (places - 1) * detail::deepest + 1> stack;
    std::size_t waiting = 0;
    Real limit = round_up<Real>(nearest.limit(rays));
    const Node* node = nodes_.data();
    for (;;) {
      std::array<Real, places> entries;
      unsigned met = interval.inside(node->boxes, limit, entries);
      if (std::has_single_bit(met)) {  // mostly: nothing to put in order
        const auto place = static_cast<std::size_t>(std::countr_zero(met));
        if (node->size(place) == 0) {
          node = &nodes_[node->first(place)];
          continue;
        }
      }
      const std::size_t bottom = waiting;
      for (; met != 0; met &= met - 1) {  // to the stack, the nearest on top
        const auto place = static_cast<std::size_t>(std::countr_zero(met));
        const Waiting next{entries[place], node->first(place), node->size(place)};
        if (next.size == 0)
          prefetch(&nodes_[next.first]);
        else if constexpr (requires { test.soon(std::span<const PrimitiveIndex>()); })
          test.soon(std::span<const PrimitiveIndex>(primitives_.data() + next.first, next.size));
        std::size_t at = waiting++;
        for (; at > bottom && stack[at - 1].entry < next.entry; --at) stack[at] = stack[at - 1];
        stack[at] = next;
      }
      for (;;) {
        if (waiting == 0) return;
        const Waiting& next = stack[--waiting];
        if (next.entry > limit) continue;
        if (next.size == 0) {
          node = &nodes_[next.first];
          break;
        }
        test(std::span<const PrimitiveIndex>(primitives_.data() + next.first, next.size));
        limit = round_up<Real>(nearest.limit(rays));
      }
    }
  }

 private:
  static constexpr std::size_t places = 8, leaf_size = 4;

  struct alignas(64) Node {
    CompactBoxes<Real> boxes;
    std::uint32_t children = 0;       ///< the first node below; the others follow it
    std::uint32_t primitives = 0;     ///< the first primitive of the leaves; the others follow it
    std::uint8_t kinds[places] = {};  ///< by place: the size of a leaf in the lower three bits, 0 for a node; above, where it follows

    [[nodiscard]] std::uint32_t size(std::size_t place) const noexcept { return kinds[place] & 7U; }
    [[nodiscard]] std::uint32_t first(std::size_t place) const noexcept {
      return (size(place) > 0 ? primitives : children) + (kinds[place] >> 3U);
    }
  };
  static_assert(sizeof(Node) == (sizeof(Real) == 4 ? 128 : 192));

  struct Waiting {
    Real entry;
    std::uint32_t first, size;  ///< of a leaf's primitives, or the number of a node and 0
  };

  using Twos = detail::TwoTree<Real, places, leaf_size>;

  void collapse(const Twos& twos) {
    struct Open {
      typename Twos::Range range;
      std::uint32_t node, depth;
    };
    std::vector<Node> nodes(1);
    auto primitives = room_for<PrimitiveIndex>(twos.primitives().size());
    std::vector<Open> tasks{{twos.root(), 0, 1}};
    std::vector<typename Twos::Range> children;
    while (!tasks.empty()) {
      const Open task = tasks.back();
      tasks.pop_back();
      children.clear();
      twos.gather(task.range, places, children);
      Node node;
      node.children = static_cast<std::uint32_t>(nodes.size()), node.primitives = static_cast<std::uint32_t>(primitives.size());
      node.boxes.begin(twos.box(task.range));
      for (std::size_t place = 0; place < children.size(); ++place) {
        const auto& child = children[place];
        node.boxes.add(twos.box(child));
        if (twos.leaf(child)) {
          node.kinds[place] = static_cast<std::uint8_t>((primitives.size() - node.primitives) << 3U | child.size());
          for (std::uint32_t i = child.begin; i < child.end; ++i) primitives.push_back(twos.primitives()[i].primitive);
        } else {
          node.kinds[place] = static_cast<std::uint8_t>((nodes.size() - node.children) << 3U);
          tasks.push_back({child, static_cast<std::uint32_t>(nodes.size()), task.depth + 1});
          nodes.emplace_back();
        }
      }
      nodes[task.node] = node;
      depth_ = std::max<std::size_t>(depth_, task.depth);
    }
    nodes_ = std::move(nodes), primitives_ = std::move(primitives);
  }

  Box bounds_;
  Vec3 centre_{};
  Frozen<Node> nodes_;                 ///< the root first
  Frozen<PrimitiveIndex> primitives_;  ///< of the leaves
  std::size_t depth_ = 0;
};

static_assert(Accelerator<Bvh<float>> && Accelerator<Bvh<double>>);

}  // namespace pulsecast
