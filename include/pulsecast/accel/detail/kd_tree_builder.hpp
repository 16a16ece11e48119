// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_ACCEL_DETAIL_KD_TREE_BUILDER_HPP
#define PULSECAST_ACCEL_DETAIL_KD_TREE_BUILDER_HPP

#include <pulsecast/accel/detail/sah.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Build of a kd-tree: large nodes level by level, in chunks of their primitives, then the subtrees
/// below, both on all threads. Nodes and leaves are in depth-first order, lower children first, for
/// any number of threads. `Node`: a node of 16 bytes, as `KdTree` has it.
template <std::floating_point Real, class Node>
class KdTreeBuilder {
 public:
  KdTreeBuilder(const SharedBuffer<Boxed<Real>>& primitives, const Workers& workers) {
    const auto count = static_cast<double>(primitives.size());
    // Source: Pharr, Jakob & Humphreys 2016, sec. 4.4
    deepest_ = std::min(max_depth, static_cast<std::size_t>(8 + 1.3 * std::log2(count)));
    const Box whole = box_of(primitives);
    cell = whole.box();
    steps_.push_back({{whole, cell, leaves_per_primitive * count, 0}, primitives});
    split_large(workers);
    for_each_index(steps_.size(), workers, [&](std::size_t i) {
      Step& step = steps_[i];
      if (step.lower == 0) step.subtree = build(step.task, std::exchange(step.primitives, {}));
    });
    join(workers);
  }

  BoundingBox<Real> cell;  ///< bounds of the primitives, relative to their centre [m]
  std::size_t depth = 0;   ///< steps to the deepest leaf
  SharedArray<Node> nodes;
  SharedArray<PrimitiveIndex> order;

 private:
  using Box = GrowingBox<Real>;
  using Primitives = std::span<const Boxed<Real>>;

  static constexpr std::size_t grain = 4096;  ///< primitives of a subtree at most, for the cache
  static constexpr std::size_t slice_count = 32;
  static constexpr double leaves_per_primitive = 4;
  static constexpr double empty_bonus = 0.8;  ///< factor with an empty side. Source: Wald & Havran 2006, 3.2

  struct Task {
    Box filled;  ///< bounds of its primitives
    BoundingBox<Real> cell;
    double allowance;  ///< greatest number of references to its primitives in the leaves below
    std::size_t depth;
  };

  struct Split {
    int axis = -1;  ///< -1 for no worthwhile split
    Real at = 0;
  };

  /// Numbers of primitives whose boxes begin and end in each slice of a cell, along each axis.
  struct Counts {
    std::array<std::uint32_t, slice_count> begun[3] = {}, ended[3] = {};

    void fill(const Slices<Real>& slices, Primitives part) noexcept {
      for (const Boxed<Real>& boxed : part) {
        const auto first = slices.of(boxed.low()), last = slices.of(boxed.high());
        for (std::size_t k = 0; k < 3; ++k) {
          ++begun[k][first[k]];
          ++ended[k][last[k]];
        }
      }
    }
    void add(const Counts& others) noexcept {
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < slice_count; ++i) {
          begun[k][i] += others.begun[k][i];
          ended[k][i] += others.ended[k][i];
        }
    }
  };

  struct Subtree {
    std::vector<Node> nodes{};  ///< its first node has a place beside its sibling
    std::vector<PrimitiveIndex> order{};
    std::size_t depth = 0;
  };

  /// Node of the upper levels, or root of a subtree.
  struct Step {
    Task task;
    SharedBuffer<Boxed<Real>> primitives;  ///< until it is split
    Split split{};
    std::size_t lower = 0;  ///< index of the lower child, the upper one follows it; 0 for a subtree
    Subtree subtree{};
    /// Places of its node, and of the first node and reference below.
    std::size_t own = 0, first_node = 0, first_reference = 0;
  };

  /// Chunk of the primitives of a large node.
  struct Piece {
    std::size_t step;
    Primitives part;
    Counts counts{};
    std::size_t sizes[2] = {}, to[2] = {};  ///< primitives in either half, and index of their first
    std::array<Box, 2> filled{};
  };

  static bool reaches_lower(const Boxed<Real>& b, const Split& s) noexcept {
    return b.box.min[s.axis] < s.at || b.box.max[s.axis] <= s.at;
  }
  static bool reaches_upper(const Boxed<Real>& b, const Split& s) noexcept { return b.box.max[s.axis] > s.at; }

  static Box box_of(Primitives part) noexcept {
    Box box;
    for (const Boxed<Real>& boxed : part) box.extend(boxed.low(), boxed.high());
    return box;
  }

  /// Slices of the part of a node's cell that its primitives fill.
  static Slices<Real> slices_of(const Task& task) noexcept {
    const Boxed<Real> within{task.cell, 0};
    return {simd::max(task.filled.min, within.low()), simd::min(task.filled.max, within.high()), slice_count};
  }

  /// True if a split into halves of these numbers of primitives pays, and is within the allowance.
  static bool worthwhile(const Task& task, std::size_t size, std::size_t lower, std::size_t upper) noexcept {
    return static_cast<double>(lower + upper) <= task.allowance && std::min(lower, upper) != size;
  }

  /// Halves of a node, without their bounds.
  static std::array<Task, 2> halves(const Task& task, const Split& split, std::size_t lower,
                                    std::size_t upper) noexcept {
    const auto half = [&](std::size_t side) -> Task {
      const double share = task.allowance * static_cast<double>(side) / static_cast<double>(lower + upper);
      return {{}, task.cell, share, task.depth + 1};
    };
    Task below = half(lower), above = half(upper);
    below.cell.max[split.axis] = above.cell.min[split.axis] = split.at;
    return {below, above};
  }

  static Split best_split(const Task& task, const Counts& counts, std::size_t size) noexcept {
    const Slices<Real> slices = slices_of(task);
    Split best;
    const auto n = static_cast<double>(size);
    const BoundingBox<Real>& cell = task.cell;
    const double area = half_area(cell);
    double best_cost = test_cost * n;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!slices.valid(axis)) continue;
      const int k = static_cast<int>(axis);
      const Real end = std::min(task.filled.max[axis], cell.max[k]);
      double lower = 0, upper = n;
      for (std::size_t i = 0; i <= slice_count; ++i) {
        if (i > 0) {
          lower += counts.begun[axis][i - 1];
          upper -= counts.ended[axis][i - 1];
        }
        const Real at = i == slice_count ? end : slices.edge(axis, i);
        if (!(at > cell.min[k] && at < cell.max[k])) continue;
        BoundingBox<Real> below = cell, above = cell;
        below.max[k] = above.min[k] = at;
        const double tests = (half_area(below) * lower + half_area(above) * upper) / area;
        const double cost = (1 + test_cost * tests) * (lower == 0 || upper == 0 ? empty_bonus : 1);
        if (cost < best_cost) {
          best_cost = cost;
          best = {k, at};
        }
      }
    }
    return best;
  }

  /// Splits nodes of more than `grain` primitives, a level at a time.
  void split_large(const Workers& workers) {
    for (std::size_t begin = 0, end = 1; begin < end; begin = std::exchange(end, steps_.size())) {
      std::vector<Piece> pieces;
      for (std::size_t i = begin; i < end; ++i) {
        const Primitives all = steps_[i].primitives;
        if (all.size() <= grain || steps_[i].task.depth >= deepest_) continue;
        for (std::size_t from = 0; from < all.size(); from += chunk_size)
          pieces.push_back({i, all.subspan(from, std::min(chunk_size, all.size() - from))});
      }
      const auto each = [&](const auto& act) {
        const auto act_on = [&](std::size_t i) { act(pieces[i], steps_[pieces[i].step]); };
        for_each_index(pieces.size(), workers, act_on);
      };
      each([](Piece& piece, const Step& step) { piece.counts.fill(slices_of(step.task), piece.part); });
      for_each_step(pieces, [](std::span<Piece> of, Step& step) {
        for (const Piece& piece : of.subspan(1)) of[0].counts.add(piece.counts);
        step.split = best_split(step.task, of[0].counts, step.primitives.size());
      });
      each([](Piece& piece, const Step& step) {
        if (step.split.axis < 0) return;
        for (const Boxed<Real>& boxed : piece.part) {
          piece.sizes[0] += reaches_lower(boxed, step.split) ? 1 : 0;
          piece.sizes[1] += reaches_upper(boxed, step.split) ? 1 : 0;
        }
      });
      for_each_step(pieces, [this](std::span<Piece> of, Step& step) { make_halves(of, step); });
      each([this](Piece& piece, const Step& step) {
        if (step.lower > 0) scatter(piece, step);
      });
      for_each_step(pieces, [this](std::span<Piece> of, Step& step) {
        if (step.lower == 0) return;
        for (const Piece& piece : of)
          for (std::size_t half = 0; half < 2; ++half) steps_[step.lower + half].task.filled.extend(piece.filled[half]);
        step.primitives = {};
      });
    }
  }

  void for_each_step(std::vector<Piece>& pieces, const auto& act) {
    for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
      while (end < pieces.size() && pieces[end].step == pieces[begin].step) ++end;
      act(std::span(pieces).subspan(begin, end - begin), steps_[pieces[begin].step]);
    }
  }

  /// Makes the halves of a node, and room for their primitives, unless it is a leaf.
  void make_halves(std::span<Piece> pieces, Step& step) {
    std::size_t sizes[2] = {};
    for (Piece& piece : pieces)
      for (std::size_t half = 0; half < 2; ++half)
        piece.to[half] = std::exchange(sizes[half], sizes[half] + piece.sizes[half]);
    if (step.split.axis < 0 || !worthwhile(step.task, step.primitives.size(), sizes[0], sizes[1])) return;
    step.lower = steps_.size();
    const auto tasks = halves(step.task, step.split, sizes[0], sizes[1]);
    for (std::size_t half = 0; half < 2; ++half)
      steps_.push_back({tasks[half], SharedBuffer<Boxed<Real>>(sizes[half])});
  }

  /// Copies primitives to the halves that they reach, in their order.
  void scatter(Piece& piece, const Step& step) noexcept {
    Boxed<Real>* const to[2] = {steps_[step.lower].primitives.data() + piece.to[0],
                                steps_[step.lower + 1].primitives.data() + piece.to[1]};
    Boxed<Real>* lower = to[0];
    Boxed<Real>* upper = to[1];
    for (const Boxed<Real>& boxed : piece.part) {
      if (reaches_lower(boxed, step.split)) *lower++ = boxed;
      if (reaches_upper(boxed, step.split)) *upper++ = boxed;
    }
    for (std::size_t half = 0; half < 2; ++half) piece.filled[half] = box_of({to[half], piece.sizes[half]});
  }

  [[nodiscard]] Subtree build(const Task& root, Primitives primitives) const {
    struct Open {
      Task task;
      std::size_t node, begin;  ///< of the node, and its first pending primitive
    };
    Subtree made;
    made.nodes.resize(1);
    std::vector<Boxed<Real>> pending;
    pending.reserve(2 * primitives.size());
    const SharedBuffer<Boxed<Real>> below(primitives.size()), above(primitives.size());
    for (std::vector<Open> open{{root, 0, 0}}; !open.empty();) {
      const Open next = open.back();
      const Task& task = next.task;
      open.pop_back();
      const bool is_root = made.nodes.size() == 1;
      const Primitives part = is_root ? primitives : Primitives(pending).subspan(next.begin);
      Split split;
      if (task.depth < deepest_) {
        Counts counts;
        counts.fill(slices_of(task), part);
        split = best_split(task, counts, part.size());
      }
      std::size_t lower = 0, upper = 0;
      if (split.axis >= 0)
        for (const Boxed<Real>& boxed : part) {
          if (reaches_lower(boxed, split)) below[lower++] = boxed;
          if (reaches_upper(boxed, split)) above[upper++] = boxed;
        }
      made.depth = std::max(made.depth, task.depth);
      if (split.axis < 0 || !worthwhile(task, part.size(), lower, upper)) {
        made.nodes[next.node].place(made.order.size(), 3);
        made.nodes[next.node].count = static_cast<std::uint32_t>(part.size());
        for (const Boxed<Real>& boxed : part) made.order.push_back(boxed.primitive);
        pending.resize(next.begin);
        continue;
      }
      const std::size_t children = made.nodes.size();
      made.nodes[next.node] = Node::inner(children, split.axis, split.at);
      made.nodes.resize(children + 2);
      auto tasks = halves(task, split, lower, upper);
      tasks[0].filled = box_of({below.data(), lower});
      tasks[1].filled = box_of({above.data(), upper});
      pending.resize(next.begin);
      pending.insert(pending.end(), above.data(), above.data() + upper);
      pending.insert(pending.end(), below.data(), below.data() + lower);
      open.push_back({tasks[1], children + 1, next.begin});
      open.push_back({tasks[0], children, next.begin + upper});
    }
    return made;
  }

  /// Places a step at `own`, and all below it from `node` and `reference` on, in depth first order.
  void place(Step& step, std::size_t own, std::size_t& node, std::size_t& reference) noexcept {
    step.own = own;
    step.first_node = node;
    step.first_reference = reference;
    if (step.lower == 0) {
      node += step.subtree.nodes.size() - 1;
      reference += step.subtree.order.size();
      return;
    }
    node += 2;
    for (std::size_t half = 0; half < 2; ++half)
      place(steps_[step.lower + half], step.first_node + half, node, reference);
  }

  void join(const Workers& workers) {
    std::size_t node_count = 1, reference_count = 0;
    place(steps_[0], 0, node_count, reference_count);
    const SharedBuffer<Node> all(node_count);
    const SharedBuffer<PrimitiveIndex> references(reference_count);
    for_each_index(steps_.size(), workers, [&](std::size_t i) {
      const Step& step = steps_[i];
      if (step.lower > 0) {
        all[step.own] = Node::inner(step.first_node, step.split.axis, step.split.at);
        return;
      }
      const Subtree& own = step.subtree;
      std::copy(own.order.begin(), own.order.end(), references.data() + step.first_reference);
      const auto placed = [&](Node node) {
        const std::size_t start = node.axis() == 3 ? step.first_reference : step.first_node - 1;
        node.place(node.first() + start, node.axis());
        return node;
      };
      all[step.own] = placed(own.nodes[0]);
      std::transform(own.nodes.begin() + 1, own.nodes.end(), all.data() + step.first_node, placed);
    });
    for (const Step& step : steps_) depth = std::max(depth, step.subtree.depth);
    nodes = all;
    order = references;
  }

  std::size_t deepest_;  ///< depth limit of the leaves
  std::vector<Step> steps_;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
