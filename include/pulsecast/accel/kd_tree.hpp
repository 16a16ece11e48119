// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_ACCEL_KD_TREE_HPP
#define PULSECAST_ACCEL_KD_TREE_HPP

#include <pulsecast/accel/detail/kd_tree_builder.hpp>
#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Kd-tree split by the surface-area heuristic at 32 slices an axis. A primitive is in every leaf
/// that its box reaches, on average four at most. Source: Wald & Havran 2006; Shevtsov et al. 2007.
template <std::floating_point Real = float>
class KdTree {
 public:
  /// Builds the tree over `boxes` [m], of a span or a sized range; the same for any workers.
  /// @throws SettingError for coordinates beyond 1e18 m, or more than 4294967294 boxes
  explicit KdTree(const detail::BoxRangeRef& boxes, const Workers& workers = {}) {
    const detail::BuildInput<Real> input(boxes, workers);
    bounds_ = input.bounds;
    centre_ = input.centre;
    if (input.primitives.empty()) return;
    const detail::KdTreeBuilder<Real, Node> builder(input.primitives, workers);
    cell_ = builder.cell;
    depth_ = builder.depth;
    nodes_ = builder.nodes;
    order_ = builder.order;
  }

  explicit KdTree(DeserializeTag) {}
  void archive(auto& a) { a(bounds_, centre_, cell_, depth_, nodes_, order_); }

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
      if (first <= i || first >= nodes_.size() - 1 || depths[i] > detail::max_depth) return false;
      if (depths[first] != 0 || depths[first + 1] != 0) return false;
      depths[first] = depths[first + 1] = static_cast<std::uint8_t>(depths[i] + 1);
    }
    return std::all_of(order_.begin(), order_.end(), [&](PrimitiveIndex i) { return i < primitives; });
  }

  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  [[nodiscard]] std::size_t memory() const noexcept { return nodes_.memory() + order_.memory(); }

  /// Primitives in the order of the leaves, repeated in each that they reach.
  [[nodiscard]] std::span<const PrimitiveIndex> order() const noexcept { return {order_.data(), order_.size()}; }

  [[nodiscard]] std::size_t depth() const noexcept { return depth_; }

  void closest(const auto& rays, const detail::LeafTest auto& test, auto& nearest) const noexcept {
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
        const Span low = interval.below(span, node->axis(), node->split),
                   high = interval.above(span, node->axis(), node->split);
        const bool into_low = !low.empty() && low.entry <= limit;
        const bool into_high = !high.empty() && high.entry <= limit;
        const bool same = low.entry == high.entry && low.exit <= high.exit;
        const bool low_first = into_low && (!into_high || low.entry < high.entry || same);
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
  struct Node {
    std::uint64_t packed;  ///< split axis, 3 for a leaf; plus four times `first()`
    union {
      Real split;             ///< split plane's coordinate [m]
      std::uint32_t count;    ///< primitives of a leaf
      std::uint64_t all = 0;  ///< so that no byte is undefined
    };
    [[nodiscard]] int axis() const noexcept { return static_cast<int>(packed & 3); }
    /// First leaf primitive in that order, or index of the lower child; the upper child follows it.
    [[nodiscard]] std::size_t first() const noexcept { return packed >> 2; }
    [[nodiscard]] static Node inner(std::size_t first, int axis, Real split) noexcept {
      Node node;
      node.place(first, axis);
      node.split = split;
      return node;
    }
    void place(std::size_t first, int axis) noexcept {
      packed = std::uint64_t{first} << 2 | static_cast<std::uint64_t>(axis);
    }
  };
  static_assert(sizeof(Node) == 16);

  struct StackEntry {
    const Node* node;
    Span span;
  };

  Box bounds_;
  Vec3 centre_{};
  BoundingBox<Real> cell_{};
  SharedArray<Node> nodes_;  ///< root first
  SharedArray<PrimitiveIndex> order_;
  std::size_t depth_ = 0;
};

}  // namespace PULSECAST_NAMESPACE

#endif
