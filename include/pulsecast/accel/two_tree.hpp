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
#include <utility>
#include <vector>

#include <pulsecast/accel/sah.hpp>
#include <pulsecast/base/lanes.hpp>
#include <pulsecast/base/parallel.hpp>

namespace pulsecast::detail {

/// A tree of boxes that is split in two by the surface-area heuristic down to single primitives, and the plan of how it turns into one of
/// `Places` children a node with up to `LeafSize` primitives a leaf, so that the surface of its boxes, times what is done in them, is least
/// in sum. The primitives are brought into the order of its leaves.
/// Source: Wald 2007 (bins); Ylitie, Karras & Laine 2017, sec. 3.2 (plan).
template <std::floating_point Real, std::size_t Places, std::size_t LeafSize>
class TwoTree {
 public:
  /// What is below a node: primitives side by side. `middle` is where the second child begins, and the node's number; 0 for one primitive.
  struct Range {
    std::uint32_t begin, end, middle;
    [[nodiscard]] std::uint32_t size() const noexcept { return end - begin; }
  };

  /// At least one primitive, which must outlive the tree.
  TwoTree(std::span<Boxed<Real>> primitives, unsigned threads) : primitives_(primitives), nodes_(primitives.size()) {
    // the upper levels one after another, each on all threads; then what is below them side by side
    struct Subtree {
      Task task;
      Sums sums;
    };
    std::vector<Subtree> subtrees;
    std::vector<Task> upper{{0, static_cast<std::uint32_t>(primitives.size()), 0, &root_}};
    const std::size_t grain = std::max<std::size_t>(primitives.size() / 64, 4096);
    while (!upper.empty()) {
      const Task task = upper.back();
      upper.pop_back();
      if (task.end - task.begin > grain)
        split(task, upper, threads);
      else
        subtrees.push_back({task, {}});
    }
    for_each_index(subtrees.size(), threads, [&](std::size_t i) {
      Subtree& subtree = subtrees[i];
      std::vector<Task> tasks{subtree.task};
      while (!tasks.empty()) {
        const Task task = tasks.back();
        tasks.pop_back();
        split(task, tasks, 1);
      }
      subtree.sums = plan({subtree.task.begin, subtree.task.end, *subtree.task.number}, [](const Range&) noexcept { return nullptr; });
    });
    std::sort(subtrees.begin(), subtrees.end(), [](const Subtree& a, const Subtree& b) { return a.task.begin < b.task.begin; });
    plan(root(), [&](const Range& range) noexcept -> const Sums* {
      const auto at = std::partition_point(subtrees.begin(), subtrees.end(), [&](const Subtree& s) { return s.task.begin < range.begin; });
      return at != subtrees.end() && at->task.begin == range.begin && at->task.end == range.end ? &at->sums : nullptr;
    });
  }

  [[nodiscard]] std::span<const Boxed<Real>> primitives() const noexcept { return primitives_; }
  [[nodiscard]] Range root() const noexcept { return {0, static_cast<std::uint32_t>(primitives_.size()), root_}; }
  [[nodiscard]] const BoundingBox<Real>& box(const Range& range) const noexcept {
    return range.middle == 0 ? primitives_[range.begin].box : nodes_[range.middle].box;
  }

  /// Whether the plan makes it a leaf.
  [[nodiscard]] bool leaf(const Range& range) const noexcept { return range.middle == 0 || nodes_[range.middle].leaf; }

  /// What stands in the places of a node that this one was given so many of.
  void gather(const Range& range, std::size_t given, std::vector<Range>& children) const {
    const std::uint8_t left = given > 1 && range.middle != 0 ? nodes_[range.middle].left[given - 2] : 0;
    if (left == 0) return children.push_back(range);
    gather(first(range), left, children);
    gather(second(range), given - left, children);
  }

 private:
  static constexpr std::size_t bins = 16;
  static constexpr double leaf_cost = 1;  ///< of the tests in a leaf, where a step of the traversal costs 1

  /// What the best plan costs where a node takes up to j + 1 places of the one above, j being the index.
  using Sums = std::array<double, Places>;

  /// An inner node. Every place between two primitives that are neighbours in the end splits just one of them, and so is its number.
  struct Node {
    BoundingBox<Real> box;
    std::uint32_t first, second;    ///< the numbers of its children, 0 for one primitive
    std::uint8_t left[Places - 1];  ///< of j + 2 places, how many its first child gets; 0 if it takes but one itself
    bool leaf;
  };

  struct Task {
    std::uint32_t begin, end, depth;
    std::uint32_t* number;  ///< where the number of the node is to stand
  };

  using Corner = Four<Real>;  ///< x, y, z and one lane that means nothing

  /// A box as it grows.
  struct Growing {
    Corner min{std::numeric_limits<Real>::max()}, max{-std::numeric_limits<Real>::max()};

    void extend(const Corner& low, const Corner& high) noexcept { min = smaller(low, min), max = greater(high, max); }
    void extend(const Growing& by) noexcept { extend(by.min, by.max); }
    [[nodiscard]] BoundingBox<Real> box() const noexcept { return {{min[0], min[1], min[2]}, {max[0], max[1], max[2]}}; }
  };

  static Corner low(const Boxed<Real>& boxed) noexcept { return Corner::from(boxed.box.min[0]); }
  static Corner high(const Boxed<Real>& boxed) noexcept { return Corner::from(boxed.box.max[0]); }
  static_assert(sizeof(Boxed<Real>) >= 7 * sizeof(Real), "high() reads one lane beyond the box");

  struct Bounds {
    Growing boxes, centres;  ///< the centres doubled
  };

  /// Where splits are considered: slices of the centres' box, along each axis.
  struct Slicing {
    Corner low, per_width;
    bool valid[3];

    explicit Slicing(const Growing& centres) noexcept : low(centres.min) {
      Real per[4] = {};
      for (std::size_t k = 0; k < 3; ++k) {
        const Real extent = centres.max[k] - centres.min[k], slices = static_cast<Real>(bins) / extent;
        valid[k] = extent > 0 && slices <= std::numeric_limits<Real>::max();
        per[k] = valid[k] ? slices : 0;
      }
      per_width = Corner::from(per[0]);
    }
    /// The slice along each axis that holds a box.
    [[nodiscard]] std::array<std::uint32_t, 3> of(const Boxed<Real>& boxed) const noexcept {
      const Corner slice = (TwoTree::low(boxed) + TwoTree::high(boxed) - low) * per_width;
      const Corner within = smaller(greater(slice, Corner(0)), Corner(bins - 1));
      return {static_cast<std::uint32_t>(within[0]), static_cast<std::uint32_t>(within[1]), static_cast<std::uint32_t>(within[2])};
    }
  };

  struct Bin {
    Growing box;
    std::uint32_t count = 0;
  };
  using Bins = std::array<std::array<Bin, bins>, 3>;

  struct Split {
    int axis = -1;  ///< -1 if there is none
    std::size_t bin = 0;
    double cost = std::numeric_limits<double>::infinity();
  };

  /// Puts together what `part(begin, end, result)` makes of stretches of a part, on several threads where it is large.
  template <class Result, class Part, class Join>
  static Result over(std::span<Boxed<Real>> all, unsigned threads, const Part& part, const Join& join) {
    constexpr std::size_t stretch = 1U << 16;
    Result result;
    if (threads == 1 || all.size() <= stretch) {
      part(all, result);
      return result;
    }
    std::vector<Result> results((all.size() + stretch - 1) / stretch);
    for_each_index(results.size(), threads,
                   [&](std::size_t i) { part(all.subspan(i * stretch, std::min(stretch, all.size() - i * stretch)), results[i]); });
    for (const Result& r : results) join(result, r);
    return result;
  }

  /// Makes a node of a range, and gives its halves to do.
  void split(const Task& task, std::vector<Task>& tasks, unsigned threads) {
    const std::span<Boxed<Real>> part = primitives_.subspan(task.begin, task.end - task.begin);
    if (part.size() == 1) {
      *task.number = 0;
      return;
    }
    const auto bounds = over<Bounds>(
        part, threads,
        [](std::span<const Boxed<Real>> some, Bounds& b) noexcept {
          for (const Boxed<Real>& boxed : some) {
            const Corner low = TwoTree::low(boxed), high = TwoTree::high(boxed);
            b.boxes.extend(low, high), b.centres.extend(low + high, low + high);
          }
        },
        [](Bounds& b, const Bounds& other) noexcept { b.boxes.extend(other.boxes), b.centres.extend(other.centres); });
    const std::uint32_t middle = task.begin + static_cast<std::uint32_t>(divide(part, bounds.centres, task.depth, threads));
    Node& node = nodes_[middle];
    node.box = bounds.boxes.box();
    *task.number = middle;
    tasks.push_back({middle, task.end, task.depth + 1, &node.second});
    tasks.push_back({task.begin, middle, task.depth + 1, &node.first});
  }

  /// Moves the left part to the front and gives its size; both parts are left with levels enough to be halved down to single primitives.
  static std::size_t divide(std::span<Boxed<Real>> part, const Growing& centres, std::size_t depth, unsigned threads) {
    if (part.size() == 2) return 1;
    const Slicing slicing(centres);
    if (const Split split = best_split(part, slicing, threads); split.axis >= 0) {
      const auto k = static_cast<std::size_t>(split.axis);
      const auto in_left = [&](const Boxed<Real>& boxed) { return slicing.of(boxed)[k] < split.bin; };
      const auto left = static_cast<std::size_t>(std::partition(part.begin(), part.end(), in_left) - part.begin());
      const std::size_t larger = std::max(left, part.size() - left);
      if (depth + 1 + levels_of_halving(larger) <= deepest) return left;
    }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (centres.max[k] - centres.min[k] > centres.max[axis] - centres.min[axis]) axis = k;
    const auto centre = [axis](const Boxed<Real>& boxed) { return boxed.box.min[axis] + boxed.box.max[axis]; };
    std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2), part.end(),
                     [&](const Boxed<Real>& a, const Boxed<Real>& b) { return centre(a) < centre(b); });
    return part.size() / 2;
  }

  /// The cheapest split between slices, its cost being the sum of area times number.
  static Split best_split(std::span<Boxed<Real>> part, const Slicing& slicing, unsigned threads) {
    const auto all = over<Bins>(
        part, threads,
        [&](std::span<const Boxed<Real>> some, Bins& to) noexcept {
          for (const Boxed<Real>& boxed : some) {
            const Corner low = TwoTree::low(boxed), high = TwoTree::high(boxed);
            const auto slices = slicing.of(boxed);
            for (std::size_t k = 0; k < 3; ++k) {
              Bin& bin = to[k][slices[k]];
              bin.box.extend(low, high), ++bin.count;
            }
          }
        },
        [](Bins& to, const Bins& others) noexcept {
          for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < bins; ++i) to[k][i].box.extend(others[k][i].box), to[k][i].count += others[k][i].count;
        });
    Split best;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!slicing.valid[k]) continue;
      std::array<double, bins> right_cost;
      Growing box;
      std::uint32_t count = 0;
      for (std::size_t i = bins; i-- > 1;) {
        if (all[k][i].count > 0) box.extend(all[k][i].box), count += all[k][i].count;
        right_cost[i] = count == 0 ? 0 : half_area(box.box()) * count;
      }
      box = Growing(), count = 0;
      for (std::size_t i = 1; i < bins; ++i) {
        if (all[k][i - 1].count == 0) continue;  // the same split as the one before
        box.extend(all[k][i - 1].box), count += all[k][i - 1].count;
        if (count == part.size()) break;
        const double cost = half_area(box.box()) * count + right_cost[i];
        if (cost < best.cost) best = {static_cast<int>(k), i, cost};
      }
    }
    return best;
  }

  [[nodiscard]] Range first(const Range& r) const noexcept { return {r.begin, r.middle, nodes_[r.middle].first}; }
  [[nodiscard]] Range second(const Range& r) const noexcept { return {r.middle, r.end, nodes_[r.middle].second}; }

  /// Plans a node and all below it, but for those whose sums `known` gives.
  template <class Known>
  Sums plan(const Range& range, const Known& known) {
    if (const Sums* sums = known(range)) return *sums;
    Sums sums;
    if (range.middle == 0) {
      sums.fill(half_area(primitives_[range.begin].box) * leaf_cost);
      return sums;
    }
    const Sums of_first = plan(first(range), known), of_second = plan(second(range), known);
    Node& node = nodes_[range.middle];
    for (std::size_t j = 1; j < Places; ++j) {
      sums[j] = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < j; ++k)
        if (const double sum = of_first[k] + of_second[j - 1 - k]; sum < sums[j])
          sums[j] = sum, node.left[j - 1] = static_cast<std::uint8_t>(k + 1);
    }
    const double area = half_area(node.box), as_node = area + sums[Places - 1];
    const double as_leaf = range.size() <= LeafSize ? area * leaf_cost : std::numeric_limits<double>::infinity();
    node.leaf = as_leaf <= as_node;
    sums[0] = std::min(as_leaf, as_node);
    for (std::size_t j = 1; j < Places - 1; ++j)  // not the last, which is the node itself
      if (sums[0] <= sums[j]) sums[j] = sums[0], node.left[j - 1] = 0;
    return sums;
  }

  std::span<Boxed<Real>> primitives_;
  std::vector<Node> nodes_;
  std::uint32_t root_ = 0;
};

}  // namespace pulsecast::detail
