// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_ACCEL_KD_TREE_HPP
#define PULSECAST_ACCEL_KD_TREE_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/accel/sah.hpp>
#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast {

/// Kd-tree split by the surface-area heuristic at the edges of 32 slices per axis. A primitive is in every leaf that its box reaches: at
/// most four leaves on average.
/// Source: Wald & Havran 2006; binned: Shevtsov, Soupikov & Kapustin 2007.
template <std::floating_point Real = float>
class KdTree {
 public:
  /// Builds the tree over boxes [m]. @throws SettingError for coordinates beyond 1e18 m, or more than 4294967294 boxes
  explicit KdTree(std::span<const Box> boxes) {
    detail::BuildInput<Real> input(boxes);
    bounds_ = input.bounds;
    centre_ = input.centre;
    if (input.primitives.empty()) return;
    build({input.primitives.begin(), input.primitives.end()});
  }

  explicit KdTree(DeserializeTag) {}
  template <class Archive>
  void archive(Archive& a) {
    a(bounds_, centre_, cell_, depth_, nodes_, order_);
  }

  /// True if the archived nodes form a tree within the depth limit and index only `primitives` primitives.
  [[nodiscard]] bool is_consistent(std::size_t primitives) const {
    std::vector<std::uint8_t> depths(nodes_.size());  // 0 for no parent so far
    if (!depths.empty()) depths[0] = 1;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      const std::size_t first = node.first();
      if (depths[i] == 0) return false;
      if (node.axis() == 3) {
        if (first > order_.size() || node.count > order_.size() - first) return false;
        continue;
      }
      if (first <= i || first >= nodes_.size() - 1 || depths[first] != 0 || depths[first + 1] != 0) return false;
      if (depths[i] > detail::max_depth) return false;
      depths[first] = depths[first + 1] = static_cast<std::uint8_t>(depths[i] + 1);
    }
    return std::all_of(order_.begin(), order_.end(), [&](PrimitiveIndex i) { return i < primitives; });
  }

  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  [[nodiscard]] std::size_t memory() const noexcept { return nodes_.memory() + order_.memory(); }

  /// Primitives in the order of the leaves, repeated in every leaf that they reach.
  [[nodiscard]] std::span<const PrimitiveIndex> order() const noexcept { return {order_.data(), order_.size()}; }

  /// Steps from the root to the deepest leaf, at most 64.
  [[nodiscard]] std::size_t depth() const noexcept { return depth_; }

  /// Traverses the tree front to back; `test` gets the primitives of each leaf that a bundle or a `BundleOfOne` may meet.
  template <class Rays, class Test, class Hits>
  requires std::invocable<const Test&, std::span<const PrimitiveIndex>>
  void closest(const Rays& rays, const Test& test, Hits& nearest) const noexcept {
    if (nodes_.empty()) return;
    const BundleInterval<Real> interval(rays, bounds_, centre_);
    std::array<StackEntry, detail::max_depth> stack;
    std::size_t stack_size = 0;
    Real limit = round_up<Real>(nearest.limit(rays));
    const Node* node = &nodes_[0];
    Span span = interval.inside(cell_);
    if (span.empty() || span.entry > limit) return;
    for (;;) {
      if (node->axis() < 3) {
        const Node* const children = &nodes_[node->first()];
        const Span low = interval.below(span, node->axis(), node->split), high = interval.above(span, node->axis(), node->split);
        const bool into_low = !low.empty() && low.entry <= limit, into_high = !high.empty() && high.entry <= limit;
        const bool earlier = low.entry < high.entry || (low.entry == high.entry && low.exit <= high.exit);
        const bool low_first = into_low && (!into_high || earlier);
        if (into_low && into_high) {
          PULSECAST_ASSERT(stack_size < stack.size());
          stack[stack_size++] = low_first ? StackEntry{children + 1, high} : StackEntry{children, low};
        }
        if (into_low || into_high) {
          node = low_first ? children : children + 1;
          span = low_first ? low : high;
          continue;
        }
      } else if (node->count > 0) {
        test(std::span<const PrimitiveIndex>(order_.data() + node->first(), node->count));
        limit = round_up<Real>(nearest.limit(rays));
      }
      do {
        if (stack_size == 0) return;
        node = stack[--stack_size].node;
        span = stack[stack_size].span;
      } while (span.entry > limit);
    }
  }

 private:
  using Span = typename BundleInterval<Real>::Span;
  using Boxed = detail::Boxed<Real>;

  static constexpr std::size_t slice_count = 32;
  static constexpr double leaves_per_primitive = 4;
  static constexpr double empty_bonus = 0.8;  ///< cost factor for a split with an empty side. Source: Wald & Havran 2006, sec. 3.2

  struct Node {
    std::uint64_t packed;  ///< split axis, 3 for a leaf; plus four times `first()`
    union {
      Real split;           ///< split plane's coordinate [m]
      std::uint32_t count;  ///< primitives of a leaf
    };
    [[nodiscard]] int axis() const noexcept { return static_cast<int>(packed & 3); }
    /// First leaf primitive in `order_`, or index of the lower child; the upper child follows it.
    [[nodiscard]] std::size_t first() const noexcept { return packed >> 2; }
    void place(std::size_t first, int axis) noexcept { packed = std::uint64_t{first} << 2 | static_cast<std::uint64_t>(axis); }
  };
  static_assert(sizeof(Node) == 16);

  struct StackEntry {
    const Node* node;
    Span span;
  };

  struct Task {
    std::size_t begin;  ///< first primitive of the task in the heap of pending ones
    std::size_t node, depth;
    BoundingBox<Real> cell;
    double allowance;  ///< greatest number of references to its primitives in the leaves below
  };

  struct Split {
    int axis = -1;  ///< -1 for no worthwhile split
    Real at = 0;
  };

  static bool reaches_lower(const Boxed& b, const Split& s) noexcept { return b.box.min[s.axis] < s.at || b.box.max[s.axis] <= s.at; }
  static bool reaches_upper(const Boxed& b, const Split& s) noexcept { return b.box.max[s.axis] > s.at; }

  void build(std::vector<Boxed> heap) {
    cell_ = box_of(heap).box();
    const auto n = static_cast<double>(heap.size());
    // Source: Pharr, Jakob & Humphreys 2016, sec. 4.4
    const std::size_t deepest = std::min(detail::max_depth, static_cast<std::size_t>(8 + 1.3 * std::log2(n)));
    std::vector<Node> nodes(1);
    std::vector<PrimitiveIndex> order;
    std::vector<Task> tasks{{0, 0, 0, cell_, leaves_per_primitive * n}};
    std::vector<Boxed> lower, upper;
    while (!tasks.empty()) {
      const Task task = tasks.back();
      tasks.pop_back();
      const std::span<const Boxed> part(heap.data() + task.begin, heap.size() - task.begin);
      const Split split = task.depth < deepest ? best_split(part, task.cell) : Split{};
      lower.clear();
      upper.clear();
      if (split.axis >= 0) {
        for (const Boxed& boxed : part) {
          if (reaches_lower(boxed, split)) lower.push_back(boxed);
          if (reaches_upper(boxed, split)) upper.push_back(boxed);
        }
      }
      const auto both = static_cast<double>(lower.size() + upper.size());
      depth_ = std::max(depth_, task.depth);
      Node& node = nodes[task.node];
      if (split.axis < 0 || both > task.allowance || std::min(lower.size(), upper.size()) == part.size()) {
        node.place(order.size(), 3);
        node.count = static_cast<std::uint32_t>(part.size());
        for (const Boxed& boxed : part) order.push_back(boxed.primitive);
        heap.resize(task.begin);
        continue;
      }
      const std::size_t children = nodes.size();
      node.place(children, split.axis);
      node.split = split.at;
      nodes.resize(children + 2);
      const auto share = [&](const std::vector<Boxed>& side) { return task.allowance * static_cast<double>(side.size()) / both; };
      Task below{task.begin, children + 1, task.depth + 1, task.cell, share(upper)};
      below.cell.min[split.axis] = split.at;
      heap.resize(task.begin);
      heap.insert(heap.end(), upper.begin(), upper.end());
      tasks.push_back(below);
      below = {heap.size(), children, task.depth + 1, task.cell, share(lower)};
      below.cell.max[split.axis] = split.at;
      heap.insert(heap.end(), lower.begin(), lower.end());
      tasks.push_back(below);
    }
    nodes_ = std::move(nodes);
    order_ = std::move(order);
  }

  static detail::GrowingBox<Real> box_of(std::span<const Boxed> part) noexcept {
    detail::GrowingBox<Real> box;
    for (const Boxed& boxed : part) box.extend(boxed.low(), boxed.high());
    return box;
  }

  static Split best_split(std::span<const Boxed> part, const BoundingBox<Real>& cell) noexcept {
    Split best;
    const auto n = static_cast<double>(part.size());
    const double area = detail::half_area(cell);
    double best_cost = detail::test_cost * n;
    const detail::GrowingBox<Real> filled = box_of(part);
    const Boxed within{cell, 0};
    const auto low = simd::max(filled.min, within.low()), high = simd::min(filled.max, within.high());
    const detail::Slices<Real> slices(low, high, slice_count);
    std::array<std::uint32_t, slice_count> begun[3] = {}, ended[3] = {};
    for (const Boxed& boxed : part) {
      const auto first = slices.of(boxed.low()), last = slices.of(boxed.high());
      for (std::size_t k = 0; k < 3; ++k) {
        ++begun[k][first[k]];
        ++ended[k][last[k]];
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!slices.valid(axis)) continue;
      const int k = static_cast<int>(axis);
      double lower = 0, upper = n;
      for (std::size_t i = 0; i <= slice_count; ++i) {
        if (i > 0) {
          lower += begun[axis][i - 1];
          upper -= ended[axis][i - 1];
        }
        const Real at = i == slice_count ? high[axis] : slices.edge(axis, i);
        if (!(at > cell.min[k] && at < cell.max[k])) continue;
        BoundingBox<Real> below = cell, above = cell;
        below.max[k] = above.min[k] = at;
        const double tests = (detail::half_area(below) * lower + detail::half_area(above) * upper) / area;
        const double cost = (1 + detail::test_cost * tests) * (lower == 0 || upper == 0 ? empty_bonus : 1);
        if (cost < best_cost) {
          best_cost = cost;
          best = {k, at};
        }
      }
    }
    return best;
  }

  Box bounds_;
  Vec3 centre_{};
  BoundingBox<Real> cell_{};
  SharedArray<Node> nodes_;  ///< root first
  SharedArray<PrimitiveIndex> order_;
  std::size_t depth_ = 0;
};

static_assert(Accelerator<KdTree<float>>);

}  // namespace pulsecast

#endif
