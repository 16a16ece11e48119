// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <pulsecast/accel/sah.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast {

/// A tree of boxes, split by the surface-area heuristic over 16 bins an axis; every primitive stands in exactly one leaf.
/// A bundle goes through it as a whole, front to back. Where a split would make the tree deeper than 64 levels, halves are made.
/// Source: Wald 2007 (build in bins); Wald, Boulos & Shirley 2007 (bundles by interval arithmetic).
template <std::floating_point Real = float>
class Bvh {
 public:
  explicit Bvh(std::span<const Box> boxes) {
    detail::BuildInput<Real> input(boxes);
    bounds_ = input.bounds, centre_ = input.centre;
    if (input.primitives.empty()) return;
    build(input.primitives);
    order_.reserve(input.primitives.size());
    for (const auto& boxed : input.primitives) order_.push_back(boxed.primitive);
    pairs_.shrink_to_fit();
  }

  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  [[nodiscard]] std::size_t memory() const noexcept {
    return pairs_.capacity() * sizeof(Pair) + order_.capacity() * sizeof(PrimitiveIndex);
  }

  /// Steps from the root to the deepest leaf, at most 64.
  [[nodiscard]] std::size_t depth() const noexcept { return depth_; }

  template <class Test>
  requires std::invocable<const Test&, std::span<const PrimitiveIndex>>
  void closest(const RayBundle& rays, const Test& test, Nearest& nearest) const noexcept {
    if (pairs_.empty()) return;
    const BundleInterval<Real> interval(rays, bounds_, centre_);
    std::array<Waiting, detail::deepest> stack;
    std::size_t waiting = 0;
    Real limit = round_up<Real>(nearest.limit(rays));
    const Node* node = &pairs_[0].nodes[0];
    const auto whole = interval.inside(node->box);
    if (whole.empty() || whole.entry > limit) return;
    for (;;) {
      if (node->count == 0) {
        const Pair& pair = pairs_[node->first];
        const auto a = interval.inside(pair.nodes[0].box), b = interval.inside(pair.nodes[1].box);
        const bool into_a = !a.empty() && a.entry <= limit, into_b = !b.empty() && b.entry <= limit;
        const bool a_first = into_a && (!into_b || a.entry <= b.entry);
        if (into_a && into_b) {
          PULSECAST_EXPECT(waiting < stack.size());
          stack[waiting++] = {&pair.nodes[a_first ? 1 : 0], a_first ? b.entry : a.entry};
        }
        if (into_a || into_b) {
          node = &pair.nodes[a_first ? 0 : 1];
          continue;
        }
      } else {
        test(std::span<const PrimitiveIndex>(order_.data() + node->first, node->count));
        limit = round_up<Real>(nearest.limit(rays));
      }
      do {
        if (waiting == 0) return;
        node = stack[--waiting].node;
      } while (stack[waiting].entry > limit);
    }
  }

 private:
  static constexpr std::size_t bins = 16, largest_leaf = 8;

  struct Node {
    BoundingBox<Real> box;
    std::uint32_t first;  ///< of a leaf's primitives in `order_`, or number of the pair of children
    std::uint32_t count;  ///< of a leaf's primitives; 0 if it has children
  };
  static_assert(sizeof(Node) == 6 * sizeof(Real) + 8);

  /// Brothers share a cache line. The root is the first of pair 0, alone.
  struct alignas(64) Pair {
    Node nodes[2];
  };

  struct Waiting {
    const Node* node;
    Real entry;
  };

  using Boxed = detail::Boxed<Real>;

  struct Task {
    std::uint32_t begin, end, pair;
    std::uint8_t side, depth;
  };

  struct Split {
    int axis = -1;  ///< -1 if there is none
    Real low = 0, high = 0;
    std::size_t bin = 0;
    double cost = std::numeric_limits<double>::infinity();
  };

  static Real doubled_centre(const Boxed& boxed, int axis) noexcept { return boxed.box.min[axis] + boxed.box.max[axis]; }

  void build(std::vector<Boxed>& primitives) {
    pairs_.emplace_back();
    pairs_[0].nodes[1] = {detail::no_box<Real>(), 0, 1};
    std::vector<Task> tasks{{0, static_cast<std::uint32_t>(primitives.size()), 0, 0, 0}};
    while (!tasks.empty()) {
      const Task task = tasks.back();
      tasks.pop_back();
      const std::span<Boxed> part(primitives.data() + task.begin, task.end - task.begin);
      auto box = detail::no_box<Real>(), centres = detail::no_box<Real>();
      for (const Boxed& boxed : part) {
        detail::extend(box, boxed.box);
        for (int k = 0; k < 3; ++k) {
          const Real c = doubled_centre(boxed, k);
          centres.min[k] = c < centres.min[k] ? c : centres.min[k], centres.max[k] = c > centres.max[k] ? c : centres.max[k];
        }
      }
      const Split split = best_split(part, centres);
      const double area = detail::half_area(box);
      const bool worth_it = area + detail::test_cost * split.cost < detail::test_cost * area * static_cast<double>(part.size());
      depth_ = std::max<std::size_t>(depth_, task.depth);
      if (part.size() == 1 || (part.size() <= largest_leaf && !worth_it)) {
        pairs_[task.pair].nodes[task.side] = {box, task.begin, static_cast<std::uint32_t>(part.size())};
        continue;
      }
      const std::uint32_t middle = task.begin + static_cast<std::uint32_t>(divide(part, split, centres, task.depth));
      const auto children = static_cast<std::uint32_t>(pairs_.size());
      const auto below = static_cast<std::uint8_t>(task.depth + 1);
      pairs_[task.pair].nodes[task.side] = {box, children, 0};
      pairs_.emplace_back();
      tasks.push_back({middle, task.end, children, 1, below});
      tasks.push_back({task.begin, middle, children, 0, below});
    }
  }

  /// The cheapest split between bins, its cost being the sum of area times number.
  static Split best_split(std::span<const Boxed> part, const BoundingBox<Real>& centres) noexcept {
    Split best;
    if (part.size() == 1) return best;
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
  std::vector<Pair> pairs_;
  std::vector<PrimitiveIndex> order_;
  std::size_t depth_ = 0;
};

static_assert(Accelerator<Bvh<float>> && Accelerator<Bvh<double>>);

}  // namespace pulsecast
