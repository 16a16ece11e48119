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

#include <pulsecast/accel/sah.hpp>
#include <pulsecast/base/frozen.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast {

/// A tree of boxes with up to eight children a node, all of whose boxes a bundle is tested against at once. It is split in two by the
/// surface-area heuristic over 16 bins an axis, down to single primitives, and then three levels or so are made one. Every primitive
/// stands in exactly one place. A bundle goes through it as a whole, front to back. Where a split would make the tree of twos deeper than
/// 64 levels, halves are made.
/// Source: Wald 2007 (build in bins); Wald, Boulos & Shirley 2007 (bundles by interval arithmetic); Wald, Benthin & Boulos 2008
/// (collapsing).
template <std::floating_point Real = float>
class Bvh {
 public:
  explicit Bvh(std::span<const Box> boxes) {
    detail::BuildInput<Real> input(boxes);
    bounds_ = input.bounds, centre_ = input.centre;
    if (!input.primitives.empty()) nodes_ = collapsed(twos(input.primitives));
  }

  explicit Bvh(Unfilled) {}
  template <class Archive>
  void archive(Archive& a) {
    a(bounds_, centre_, depth_, nodes_);
  }

  /// Whether it is a tree at all, no deeper than it may be, and over so many primitives.
  [[nodiscard]] bool sound(std::size_t primitives) const {
    std::vector<std::uint8_t> depths(nodes_.size());  // 0 where nothing leads to so far
    if (!depths.empty()) depths[0] = 1;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      if (depths[i] == 0 || depths[i] > detail::deepest) return false;
      for (std::size_t place = 0; place < places; ++place) {
        if ((node.taken >> place & 1U) == 0) continue;
        const std::uint32_t child = node.children[place];
        const bool primitive = (node.primitives >> place & 1U) != 0;
        if (primitive ? child >= primitives : child <= i || child >= nodes_.size() || depths[child] != 0) return false;
        if (!primitive) depths[child] = static_cast<std::uint8_t>(depths[i] + 1);
      }
    }
    return true;
  }

  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  [[nodiscard]] std::size_t memory() const noexcept { return nodes_.memory(); }

  /// Steps from the root to the deepest primitive, at most 64.
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
      unsigned met = interval.inside(node->boxes, limit, entries) & node->taken;
      const std::size_t first = waiting;
      for (; met != 0; met &= met - 1) {  // to the stack, the nearest on top
        const auto place = static_cast<std::size_t>(std::countr_zero(met));
        const Waiting next{entries[place], node->children[place], (node->primitives >> place & 1U) != 0};
        std::size_t at = waiting++;
        for (; at > first && stack[at - 1].entry < next.entry; --at) stack[at] = stack[at - 1];
        stack[at] = next;
      }
      for (;;) {
        if (waiting == 0) return;
        const Waiting& next = stack[--waiting];
        if (next.entry > limit) continue;
        if (!next.primitive) {
          node = &nodes_[next.child];
          break;
        }
        test(std::span<const PrimitiveIndex>(&next.child, 1));
        limit = round_up<Real>(nearest.limit(rays));
      }
    }
  }

 private:
  static constexpr std::size_t bins = 16, places = 8;

  struct alignas(64) Node {
    EightBoxes<Real> boxes;
    std::uint32_t children[places] = {};  ///< numbers of nodes or of primitives
    std::uint8_t taken = 0;               ///< places that hold a child, a bit each
    std::uint8_t primitives = 0;          ///< places that hold a primitive
  };
  static_assert(sizeof(Node) == (sizeof(Real) == 4 ? 256 : 448));

  struct Waiting {
    Real entry;
    std::uint32_t child;
    bool primitive;
  };

  /// A node of the tree of twos, as it is built: the children of an inner node stand side by side.
  struct Two {
    BoundingBox<Real> box;
    std::uint32_t child;  ///< number of the first child, or of the primitive
    bool primitive;
    std::uint8_t left[places - 1];  ///< of j + 2 places in a node of eight, how many its first child gets; 0 if it takes but one itself
  };

  using Boxed = detail::Boxed<Real>;

  struct Task {
    std::uint32_t begin, end, node;
    std::uint8_t depth;
  };

  struct Split {
    int axis = -1;  ///< -1 if there is none
    Real low = 0, high = 0;
    std::size_t bin = 0;
    double cost = std::numeric_limits<double>::infinity();
  };

  static Real doubled_centre(const Boxed& boxed, int axis) noexcept { return boxed.box.min[axis] + boxed.box.max[axis]; }

  /// The tree of twos; its root is node 0.
  static std::vector<Two> twos(std::span<Boxed> primitives) {
    std::vector<Two> nodes(1);
    nodes.reserve(2 * primitives.size() - 1);
    std::vector<Task> tasks{{0, static_cast<std::uint32_t>(primitives.size()), 0, 0}};
    while (!tasks.empty()) {
      const Task task = tasks.back();
      tasks.pop_back();
      const std::span<Boxed> part = primitives.subspan(task.begin, task.end - task.begin);
      if (part.size() == 1) {
        nodes[task.node] = {part[0].box, part[0].primitive, true, {}};
        continue;
      }
      auto box = detail::no_box<Real>(), centres = detail::no_box<Real>();
      for (const Boxed& boxed : part) {
        detail::extend(box, boxed.box);
        for (int k = 0; k < 3; ++k) {
          const Real c = doubled_centre(boxed, k);
          centres.min[k] = c < centres.min[k] ? c : centres.min[k], centres.max[k] = c > centres.max[k] ? c : centres.max[k];
        }
      }
      const std::uint32_t middle = task.begin + static_cast<std::uint32_t>(divide(part, best_split(part, centres), centres, task.depth));
      const auto children = static_cast<std::uint32_t>(nodes.size());
      const auto below = static_cast<std::uint8_t>(task.depth + 1);
      nodes[task.node] = {box, children, false, {}};
      nodes.resize(nodes.size() + 2);
      tasks.push_back({middle, task.end, children + 1, below});
      tasks.push_back({task.begin, middle, children, below});
    }
    return nodes;
  }

  /// Plans how a tree of twos turns into one of eights, so that the boxes of its nodes have the least surface in sum: `[j]` is that sum if
  /// the tree may take j + 1 places of the node above. Source: Ylitie, Karras & Laine 2017, sec. 3.2.
  static std::array<double, places> plan(std::vector<Two>& twos, std::uint32_t root) {
    std::array<double, places> sums{};
    if (twos[root].primitive) return sums;
    const auto first = plan(twos, twos[root].child), second = plan(twos, twos[root].child + 1);
    std::array<std::uint8_t, places> left{};
    for (std::size_t j = 1; j < places; ++j) {
      sums[j] = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < j; ++k)
        if (const double sum = first[k] + second[j - 1 - k]; sum < sums[j]) sums[j] = sum, left[j] = static_cast<std::uint8_t>(k + 1);
    }
    sums[0] = detail::half_area(twos[root].box) + sums[places - 1];
    for (std::size_t j = 1; j < places - 1; ++j)
      if (sums[0] <= sums[j]) sums[j] = sums[0], left[j] = 0;
    std::copy(left.begin() + 1, left.end(), twos[root].left);
    return sums;
  }

  /// What stands in the places of a node that a tree of twos was given so many of.
  static void gather(const std::vector<Two>& twos, std::uint32_t root, std::size_t given, std::vector<std::uint32_t>& children) {
    const std::uint8_t left = given > 1 && !twos[root].primitive ? twos[root].left[given - 2] : 0;
    if (left == 0) return children.push_back(root);
    gather(twos, twos[root].child, left, children);
    gather(twos, twos[root].child + 1, given - left, children);
  }

  std::vector<Node> collapsed(std::vector<Two> twos) {
    plan(twos, 0);
    struct Open {
      std::uint32_t two, node, depth;
    };
    std::vector<Node> nodes(1);
    std::vector<Open> tasks{{0, 0, 1}};
    std::vector<std::uint32_t> children;
    while (!tasks.empty()) {
      const Open task = tasks.back();
      tasks.pop_back();
      children.clear();
      gather(twos, task.two, places, children);
      Node node;
      node.taken = static_cast<std::uint8_t>((1U << children.size()) - 1);
      for (std::size_t i = 0; i < children.size(); ++i) {
        const Two& two = twos[children[i]];
        node.boxes.put(i, two.box);
        if (two.primitive) {
          node.children[i] = two.child, node.primitives |= static_cast<std::uint8_t>(1U << i);
        } else {
          node.children[i] = static_cast<std::uint32_t>(nodes.size());
          tasks.push_back({children[i], node.children[i], task.depth + 1});
          nodes.emplace_back();
        }
      }
      nodes[task.node] = node;
      depth_ = std::max<std::size_t>(depth_, task.depth);
    }
    return nodes;
  }

  /// The cheapest split between bins, its cost being the sum of area times number.
  static Split best_split(std::span<const Boxed> part, const BoundingBox<Real>& centres) noexcept {
    Split best;
    for (int k = 0; k < 3; ++k) {
      const detail::Slices<Real, bins> slices(centres.min[k], centres.max[k]);
      if (!slices.valid()) continue;
      std::array<BoundingBox<Real>, bins> boxes;
      boxes.fill(detail::no_box<Real>());
      std::array<std::uint32_t, bins> counts{};
      for (const Boxed& boxed : part) {
        const std::size_t bin = slices.of(doubled_centre(boxed, k));
        detail::extend(boxes[bin], boxed.box);
        ++counts[bin];
      }
      std::array<double, bins> right_cost;
      auto box = detail::no_box<Real>();
      std::uint32_t count = 0;
      for (std::size_t bin = bins; bin-- > 1;) {
        detail::extend(box, boxes[bin]), count += counts[bin];
        right_cost[bin] = count == 0 ? 0 : detail::half_area(box) * count;
      }
      box = detail::no_box<Real>(), count = 0;
      for (std::size_t bin = 1; bin < bins; ++bin) {
        detail::extend(box, boxes[bin - 1]), count += counts[bin - 1];
        if (count == 0 || count == part.size()) continue;
        const double cost = detail::half_area(box) * count + right_cost[bin];
        if (cost < best.cost) best = {k, centres.min[k], centres.max[k], bin, cost};
      }
    }
    return best;
  }

  /// Moves the left part to the front and gives its size; both parts are left with levels enough to be halved down to single primitives.
  static std::size_t divide(std::span<Boxed> part, const Split& split, const BoundingBox<Real>& centres, std::size_t depth) {
    if (split.axis >= 0) {
      const detail::Slices<Real, bins> slices(split.low, split.high);
      const auto in_left = [&](const Boxed& boxed) { return slices.of(doubled_centre(boxed, split.axis)) < split.bin; };
      const auto left = static_cast<std::size_t>(std::partition(part.begin(), part.end(), in_left) - part.begin());
      const std::size_t larger = std::max(left, part.size() - left);
      if (depth + 1 + detail::levels_of_halving(larger) <= detail::deepest) return left;
    }
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (centres.max[k] - centres.min[k] > centres.max[axis] - centres.min[axis]) axis = k;
    const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
    std::nth_element(part.begin(), middle, part.end(),
                     [axis](const Boxed& a, const Boxed& b) { return doubled_centre(a, axis) < doubled_centre(b, axis); });
    return part.size() / 2;
  }

  Box bounds_;
  Vec3 centre_{};
  Frozen<Node> nodes_;  ///< the root first
  std::size_t depth_ = 0;
};

static_assert(Accelerator<Bvh<float>> && Accelerator<Bvh<double>>);

}  // namespace pulsecast
