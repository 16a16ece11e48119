// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_ACCEL_DETAIL_BINARY_SAH_TREE_HPP
#define PULSECAST_ACCEL_DETAIL_BINARY_SAH_TREE_HPP

#include <pulsecast/accel/detail/sah.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Binary SAH tree with one primitive per leaf, and the dynamic program that collapses it into an
/// 8-wide tree of minimum SAH cost, of up to `leaf_size` a leaf. Reorders primitives. Source: Wald
/// 2007 (binned build); Ylitie, Karras & Laine 2017, sec. 3.2 (dynamic program).
template <std::floating_point Real>
class BinarySahTree {
 public:
  static constexpr std::size_t places = 8;  ///< children per node of the collapsed tree

  /// Subtree: a range of primitives; `middle`: second child's start, and node; 0 for one.
  struct Range {
    std::uint32_t begin, end, middle;
    [[nodiscard]] std::uint32_t size() const noexcept { return end - begin; }
  };

  /// At least one primitive, in an array that must outlive the tree. `leaf_size`: greatest number
  /// of primitives per leaf of the collapsed tree.
  BinarySahTree(std::span<Boxed<Real>> primitives, std::uint32_t leaf_size, const Workers& workers)
      : primitives_(primitives), leaf_size_(leaf_size), spare_(primitives.size()), nodes_(primitives.size()) {
    // upper levels: one node at a time on all threads; then the subtrees in parallel
    struct Step {
      Task task;
      Sums sums{};
      std::size_t halves = 0;  // index of the first of two; 0 for a subtree
    };
    const unsigned threads = workers.count();
    const std::size_t all = primitives.size();
    const std::size_t grain = threads == 1 ? all : std::max<std::size_t>(all / (8 * threads), 4096);
    std::vector<Step> steps;
    steps.push_back({{0, static_cast<std::uint32_t>(all), 0, false, &root_, bounds(workers)}});
    std::vector<std::size_t> subtrees;
    const SharedBuffer<ChunkBins> space(threads == 1 ? 1 : chunk_count(all));
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (steps[i].task.size() <= grain) {
        subtrees.push_back(i);
        const auto size = [&](std::size_t k) { return steps[subtrees[k]].task.size(); };
        for (std::size_t k = subtrees.size() - 1; k > 0 && size(k - 1) < size(k); --k)  // largest first
          std::swap(subtrees[k - 1], subtrees[k]);
        continue;
      }
      const auto halves = split(steps[i].task, space, workers);
      steps[i].halves = steps.size();
      for (const Task& half : halves) steps.push_back({half});
    }
    for_each_index(subtrees.size(), workers, [&](std::size_t i) {
      Step& step = steps[subtrees[i]];
      step.sums = build(step.task, SharedBuffer<ChunkBins>(1));
    });
    for (std::size_t i = steps.size(); i-- > 0;)
      if (const std::size_t halves = steps[i].halves; halves > 0) {
        const Step &first = steps[halves], &second = steps[halves + 1];
        Node& node = nodes_[*steps[i].task.number];
        steps[i].sums = plan(node, first.sums, first.task.size(), second.sums, second.task.size());
      }
    spare_ = {};
  }

  [[nodiscard]] std::span<const Boxed<Real>> primitives() const noexcept { return primitives_; }
  [[nodiscard]] Range root() const noexcept { return {0, static_cast<std::uint32_t>(primitives_.size()), root_}; }
  [[nodiscard]] const BoundingBox<Real>& box(const Range& range) const noexcept {
    return range.middle == 0 ? primitives_[range.begin].box : nodes_[range.middle].box;
  }

  [[nodiscard]] bool leaf(const Range& range) const noexcept { return range.middle == 0 || nodes_[range.middle].leaf; }

  struct Children {
    std::array<Range, places> ranges;
    std::size_t count = 0;
  };

  /// Appends the children that this range contributes for `given` of its parent's eight slots.
  void gather(const Range& range, std::size_t given, Children& children) const {
    const bool split = given > 1 && range.middle != 0;
    const std::uint8_t left = split ? nodes_[range.middle].left[given - 2] : 0;
    if (left == 0) {
      children.ranges[children.count++] = range;
    } else {
      gather(first(range), left, children);
      gather(second(range), given - left, children);
    }
  }

 private:
  static constexpr std::size_t few = 4096;  ///< smaller trees, perhaps of shapes, take all slices
  static constexpr double leaf_cost = 1;    ///< SAH cost of the tests in a leaf, by a traversal step's

  /// SAH cost of the best collapse with up to j + 1 slots of the parent, by index j.
  using Sums = std::array<double, places>;

  /// Inner node. Its index is the gap between neighbours in the final order that it splits.
  struct Node {
    BoundingBox<Real> box;
    std::uint32_t first, second;    ///< indices of the children, 0 for one primitive
    std::uint8_t left[places - 1];  ///< slots of the first child, out of j + 2; 0: one for the node
    bool leaf;
  };

  using Bins = detail::Bins<Real>;
  using Corner = simd::Vec4<Real>;
  using Growing = GrowingBox<Real>;

  struct Bounds {
    Growing boxes, centres;  ///< centres times two

    void extend(const Boxed<Real>& boxed) noexcept {
      const Corner low = boxed.low(), high = boxed.high(), centre = low + high;
      boxes.extend(low, high);
      centres.extend(centre, centre);
    }
    void extend(const Bounds& by) noexcept {
      boxes.extend(by.boxes);
      centres.extend(by.centres);
    }
  };

  struct Task {
    std::uint32_t begin, end, depth;
    bool spare;             ///< true if the primitives are in the spare array
    std::uint32_t* number;  ///< destination of the node's index
    Bounds bounds;

    [[nodiscard]] std::uint32_t size() const noexcept { return end - begin; }
  };

  /// Bins of one chunk of a node's primitives, for the parallel split.
  struct ChunkBins {
    Bins bins;
    std::uint32_t to[2];  ///< next destination in either half
    Growing centres[2];   ///< bounds of the centres, times two
  };

  struct Split {
    std::size_t axis = 0, slice = 0;  ///< first slice of the second half; 0 for no split
    double cost = infinity;
  };

  [[nodiscard]] Bounds bounds(const Workers& workers) const {
    const SharedBuffer<Bounds> all(chunk_count(primitives_.size()));
    for_each_chunk(primitives_.size(), workers, [&](std::size_t i, std::size_t begin, std::size_t end) {
      Bounds own;
      for (std::size_t at = begin; at < end; ++at) own.extend(primitives_[at]);
      all[i] = own;
    });
    Bounds bounds;
    for (const Bounds& own : all) bounds.extend(own);
    return bounds;
  }

  [[nodiscard]] Boxed<Real>* array(bool spare) const noexcept { return spare ? spare_.data() : primitives_.data(); }

  Sums build(const Task& task, const SharedBuffer<ChunkBins>& space) {
    if (task.size() > 2) {
      const auto [first, second] = split(task, space, 1);
      const Sums of_first = build(first, space), of_second = build(second, space);
      return plan(nodes_[*task.number], of_first, first.size(), of_second, second.size());
    }
    if (task.spare) std::copy_n(spare_.data() + task.begin, task.size(), primitives_.data() + task.begin);
    const auto sums_of = [&](std::uint32_t i) {
      Sums sums;
      sums.fill(half_area(primitives_[i].box) * leaf_cost);
      return sums;
    };
    *task.number = task.size() == 1 ? 0 : task.end - 1;
    if (task.size() == 1) return sums_of(task.begin);
    Node& node = nodes_[*task.number];
    node.box = task.bounds.boxes.box();
    node.first = node.second = 0;
    return plan(node, sums_of(task.begin), 1, sums_of(task.begin + 1), 1);
  }

  /// Splits a node of three or more primitives; both halves keep levels to halve to one.
  std::array<Task, 2> split(const Task& task, const SharedBuffer<ChunkBins>& space, const Workers& workers) {
    const Boxed<Real>* const from = array(task.spare) + task.begin;
    const bool alone = task.size() <= 2 * chunk_size || workers.count() == 1;
    const std::size_t parts = alone ? 1 : chunk_count(task.size());
    const auto each_part = [&](const auto& act) {
      if (alone) return act(space[0], from, from + task.size());
      for_each_chunk(task.size(), workers, [&](std::size_t i, std::size_t begin, std::size_t end) {
        act(space[i], from + begin, from + end);
      });
    };
    constexpr std::size_t most = Bins::max_slices;
    const std::size_t count = primitives_.size() <= few ? most : std::min<std::size_t>(most, 4 + task.size() / 16);
    const Slices<Real> slices(task.bounds.centres.min, task.bounds.centres.max, count);
    each_part([&](ChunkBins& part, const Boxed<Real>* begin, const Boxed<Real>* end) noexcept {
      part.bins.fill(slices, begin, end);
    });
    Bins together;
    const Bins* all = &space[0].bins;
    if (parts > 1) {
      together.clear(slices.count());
      for (std::size_t i = 0; i < parts; ++i) together.add(space[i].bins, slices.count());
      all = &together;
    }
    const Split split = best_split(*all, slices, task.size());
    if (split.slice == 0) return halve(task);
    std::uint32_t left = 0;
    Task first{task.begin, 0, task.depth + 1, !task.spare, nullptr, {}},
        second{0, task.end, task.depth + 1, !task.spare, nullptr, {}};
    for (std::size_t i = 0; i < slices.count(); ++i) {
      (i < split.slice ? first : second).bounds.boxes.extend(all->boxes[split.axis][i]);
      if (i < split.slice) left += all->counts[split.axis][i];
    }
    const std::uint32_t larger = std::max(left, task.size() - left);
    if (task.depth + 1 + static_cast<std::uint32_t>(std::bit_width(larger - 1)) > max_depth) return halve(task);
    const std::uint32_t middle = first.end = second.begin = task.begin + left;
    std::uint32_t to[2] = {task.begin, middle};
    for (std::size_t i = 0; i < parts; ++i) {
      ChunkBins& part = space[i];
      std::copy_n(to, 2, part.to);
      const auto& counts = part.bins.counts[split.axis];
      for (std::size_t s = 0; s < slices.count(); ++s) to[s < split.slice ? 0 : 1] += counts[s];
    }
    each_part([&](ChunkBins& part, const Boxed<Real>* begin, const Boxed<Real>* end) noexcept {
      scatter(part, slices, split, array(!task.spare), begin, end);
    });
    for (std::size_t i = 0; i < parts; ++i) {
      first.bounds.centres.extend(space[i].centres[0]);
      second.bounds.centres.extend(space[i].centres[1]);
    }
    return made(task, first, second);
  }

  std::array<Task, 2> made(const Task& task, Task& first, Task& second) noexcept {
    Node& node = nodes_[second.begin];
    node.box = task.bounds.boxes.box();
    *task.number = second.begin;
    first.number = &node.first;
    second.number = &node.second;
    return {first, second};
  }

  /// Moves primitives to their halves, stable in order.
  static void scatter(ChunkBins& part, const Slices<Real>& slices, const Split& split, Boxed<Real>* to,
                      const Boxed<Real>* begin, const Boxed<Real>* end) noexcept {
    part.centres[0] = part.centres[1] = Growing();
    for (; begin != end; ++begin) {
      const Corner centre = begin->low() + begin->high();
      const std::size_t k = split.axis;
      const std::size_t half = slices.reaches(k, begin->box.min[k] + begin->box.max[k], split.slice) ? 1 : 0;
      to[part.to[half]++] = *begin;
      part.centres[half].extend(centre, centre);
    }
  }

  /// Splits at the median along the longest axis.
  std::array<Task, 2> halve(const Task& task) {
    const Growing& centres = task.bounds.centres;
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (centres.max[k] - centres.min[k] > centres.max[axis] - centres.min[axis]) axis = k;
    const auto is_before = [axis](const Boxed<Real>& a, const Boxed<Real>& b) {
      return a.box.min[axis] + a.box.max[axis] < b.box.min[axis] + b.box.max[axis];
    };
    Boxed<Real>* const all = array(task.spare);
    const std::uint32_t middle = task.begin + task.size() / 2;
    std::nth_element(all + task.begin, all + middle, all + task.end, is_before);
    Task first{task.begin, middle, task.depth + 1, task.spare, nullptr, {}},
        second{middle, task.end, task.depth + 1, task.spare, nullptr, {}};
    for (std::uint32_t i = task.begin; i < task.end; ++i) (i < middle ? first : second).bounds.extend(all[i]);
    return made(task, first, second);
  }

  /// Cheapest split between slices; the cost is the sum of area times count.
  static Split best_split(const Bins& bins, const Slices<Real>& slices, std::uint32_t size) noexcept {
    Split best;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!slices.valid(k)) continue;
      std::array<double, Bins::max_slices> second_cost;
      Growing box;
      std::uint32_t count = 0;
      for (std::size_t i = slices.count(); i-- > 1;) {
        box.extend(bins.boxes[k][i]);
        count += bins.counts[k][i];
        second_cost[i] = count == 0 ? 0 : box.half_area() * count;
      }
      box = Growing();
      count = 0;
      for (std::size_t i = 1; i < slices.count(); ++i) {
        if (bins.counts[k][i - 1] == 0) continue;  // same split as the one before
        box.extend(bins.boxes[k][i - 1]);
        count += bins.counts[k][i - 1];
        if (count == size) break;
        const double cost = box.half_area() * count + second_cost[i];
        if (cost < best.cost) best = {k, i, cost};
      }
    }
    return best;
  }

  [[nodiscard]] Range first(const Range& r) const noexcept { return {r.begin, r.middle, nodes_[r.middle].first}; }
  [[nodiscard]] Range second(const Range& r) const noexcept { return {r.middle, r.end, nodes_[r.middle].second}; }

  Sums plan(Node& node, const Sums& first, std::size_t in_first, const Sums& second,
            std::size_t in_second) const noexcept {
    Sums sums;
    const std::size_t size = in_first + in_second;
    for (std::size_t j = 1; j < places; ++j) {
      if (j >= size) {  // more places than primitives
        sums[j] = sums[j - 1];
        node.left[j - 1] = node.left[j - 2];
        continue;
      }
      sums[j] = infinity;
      for (std::size_t k = j > in_second ? j - in_second : 0; k < std::min(j, in_first); ++k)
        if (const double sum = first[k] + second[j - 1 - k]; sum < sums[j]) {
          sums[j] = sum;
          node.left[j - 1] = static_cast<std::uint8_t>(k + 1);
        }
    }
    const double area = half_area(node.box), as_node = area + sums[places - 1];
    const double as_leaf = size <= leaf_size_ ? area * leaf_cost : infinity;
    node.leaf = as_leaf <= as_node;
    sums[0] = std::min(as_leaf, as_node);
    for (std::size_t j = 1; j < places; ++j)  // the last entry is the node itself: the root may hold a leaf alone
      if (const double whole = j + 1 < places ? sums[0] : as_leaf; whole <= sums[j]) {
        sums[j] = whole;
        node.left[j - 1] = 0;
      }
    return sums;
  }

  std::span<Boxed<Real>> primitives_;
  std::uint32_t leaf_size_;
  SharedBuffer<Boxed<Real>> spare_;  ///< second buffer during the build
  SharedBuffer<Node> nodes_;
  std::uint32_t root_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
