// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_ACCEL_BVH_HPP
#define PULSECAST_ACCEL_BVH_HPP

#include <pulsecast/accel/detail/binary_sah_tree.hpp>
#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

template <std::floating_point Real>
class BvhRefit;

/// BVH with up to eight children per node, whose boxes are tested against a bundle together. The
/// build splits a binary SAH tree down to single primitives, and collapses it at least SAH cost
/// into nodes and leaves of up to `leaf_size` primitives, each in exactly one leaf. A bundle
/// traverses it as a whole, front to back. A range is halved where a split would exceed 64 levels.
/// The tree is the same for any workers. Source: Wald 2007 (binned build); Wald, Boulos & Shirley
/// 2007 (bundles by interval arithmetic); Wald, Benthin & Boulos 2008 (collapsing).
template <std::floating_point Real = float>
class Bvh {
 public:
  /// Builds the tree over `boxes` [m]: a span, or a sized range that yields a `Box` by index.
  /// `leaf_size`, from 1 to 7: several for vectorized tests; 1 where a test is a search. @throws
  /// SettingError for another, coordinates beyond 1e18 m, or over 4294967294 boxes
  explicit Bvh(const detail::BoxRangeRef& boxes, const Workers& workers = {}, std::uint32_t leaf_size = 4) {
    require_within("Bvh::leaf_size", leaf_size, 1, 7, "");
    detail::BuildInput<Real> input(boxes, workers);
    bounds_ = input.bounds;
    centre_ = input.centre;
    if (input.primitives.empty()) return;
    const BinaryTree binary(input.primitives, leaf_size, workers);
    collapse(binary, workers);
  }

  explicit Bvh(DeserializeTag) {}
  void archive(auto& a) { a(bounds_, centre_, depth_, nodes_, primitives_); }

  [[nodiscard]] bool is_consistent(std::size_t primitives) const {
    std::vector<std::uint8_t> depths(nodes_.size());  // 0 for no parent so far
    if (!depths.empty()) depths[0] = 1;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Node& node = nodes_[i];
      if (depths[i] == 0 || depths[i] > detail::max_depth || (node.used & (node.used + 1U)) != 0) return false;
      for (std::size_t place = 0; place < node.count(); ++place) {
        const std::size_t first = node.first[place];
        if (node.size[place] > 0) {
          if (first > primitives_.size() || node.size[place] > primitives_.size() - first) return false;
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

  [[nodiscard]] std::span<const PrimitiveIndex> order() const noexcept {
    return {primitives_.data(), primitives_.size()};
  }

  [[nodiscard]] std::size_t depth() const noexcept { return depth_; }

  template <class Rays>
  void closest(const Rays& rays, const detail::LeafTest auto& test, auto& nearest) const noexcept {
    if (nodes_.empty()) return;
    if constexpr (detail::EndsEarly<std::remove_reference_t<decltype(nearest)>>)
      descend_to_any(rays, test, nearest);
    else if constexpr (Rays::capacity == 1)
      descend_alone(rays, test, nearest);
    else
      descend(BundleInterval<Real>(rays, bounds_, centre_), rays, test, nearest);
  }

  /// True only if no ray of a cone comes near a primitive, as required by `MissesCones`. Opens few
  /// nodes: a cone between the leaves deep in the tree gets false.
  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept {
    if (nodes_.empty() || cone.passes(bounds_)) return true;
    constexpr std::size_t max_opened = 16;
    const BundleInterval<Real> interval(cone, bounds_, centre_);
    std::array<std::uint32_t, (places - 1) * max_opened + 1> waiting;
    waiting[0] = 0;
    std::size_t count = 1;
    for (std::size_t opened = 0; count > 0; ++opened) {
      if (opened == max_opened) return false;
      const Node& node = nodes_[waiting[--count]];
      std::array<Real, places> entries;
      for (unsigned met = interval.inside(node.boxes, std::numeric_limits<Real>::max(), entries) & node.used; met != 0;
           met &= met - 1) {
        const auto place = static_cast<std::size_t>(std::countr_zero(met));
        if (node.size[place] > 0) return false;
        waiting[count++] = node.first[place];
      }
    }
    return true;
  }

 private:
  friend class BvhRefit<Real>;
  using BinaryTree = detail::BinarySahTree<Real>;
  static constexpr std::size_t places = BinaryTree::places;

  struct alignas(64) Node {
    Box8<Real> boxes;
    std::uint32_t first[places] = {};  ///< by child: first primitive of a leaf, or index of a node
    std::uint8_t size[places] = {};    ///< by child: primitives of a leaf, 0 for a node
    std::uint8_t used = 0;             ///< bit mask of the places with a child, the first ones

    [[nodiscard]] std::size_t count() const noexcept { return static_cast<std::size_t>(std::popcount(used)); }
  };
  static_assert(sizeof(Node) == (sizeof(Real) == 4 ? 256 : 448));

  struct StackEntry {
    Real entry;
    std::uint32_t first, size;  ///< of a leaf: primitive and size; of a node: index and 0
  };
  static constexpr std::uint32_t nothing = 0xFFFFFFFF;  ///< sentinel in place of a size

  void descend(const auto& interval, const auto& rays, const auto& test, auto& nearest) const noexcept {
    std::array<StackEntry, (places - 1) * detail::max_depth + 1> stack;
    std::size_t stack_size = 0;
    Real limit = interval.limit(rays, nearest);
    const Node* node = nodes_.data();
    for (;;) {
      std::array<Real, places> entries;
      unsigned met = interval.inside(node->boxes, limit, entries) & node->used;
      const auto take_first = [&]() noexcept -> StackEntry {
        const auto place = static_cast<std::size_t>(std::countr_zero(met));
        met &= met - 1;
        return {entries[place], node->first[place], node->size[place]};
      };
      StackEntry next{0, 0, nothing};
      if (met != 0) {  // nearest child next; the others on the stack, nearest on top
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

  /// Child of a node, to be visited by a single ray: first primitive of a leaf, or index of a node.
  /// The key has the size of a leaf as its tag, or 0.
  struct Child {
    typename RayInterval<Real>::Key key;
    std::uint32_t first;
  };

  void descend_alone(const auto& rays, const auto& test, auto& nearest) const noexcept {
    using Interval = RayInterval<Real>;
    const auto size_of = [](typename Interval::Key key) noexcept { return static_cast<std::uint32_t>(key & 7); };
    const Interval interval(rays, bounds_, centre_);
    std::array<Child, (places - 1) * detail::max_depth + 1> stack;
    Child* top = stack.data();
    Real limit = interval.limit(rays, nearest);
    Child next{0, 0};
    const auto take_next = [&]() noexcept {  // false without one
      do {
        if (top == stack.data()) return false;
        next = *--top;
      } while (next.key > Interval::last_key(limit));
      return true;
    };
    for (;;) {
      const auto in_registers = interval.loaded();
      do {
        const Node& node = nodes_[next.first];
        typename Interval::Keys keys;
        unsigned met = in_registers.inside(node.boxes, limit, keys) & node.used;
        const auto take_first = [&]() noexcept -> Child {
          const auto place = static_cast<std::size_t>(std::countr_zero(met));
          met &= met - 1;
          return {keys[place] | static_cast<int>(node.size[place]), node.first[place]};
        };
        if (met == 0) {
          if (!take_next()) return;
          continue;
        }
        next = take_first();  // nearest child next; the others on the stack, nearest on top
        const Child* const bottom = top;
        while (met != 0) {
          Child other = take_first();
          if (other.key < next.key) std::swap(other, next);
          prefetch_entry({0, other.first, size_of(other.key)}, test);
          Child* place = top++;
          for (; place != bottom && place[-1].key < other.key; --place) *place = place[-1];
          *place = other;
        }
      } while (size_of(next.key) == 0);
      do {
        test(std::span<const PrimitiveIndex>(primitives_.data() + next.first, size_of(next.key)));
        limit = interval.limit(rays, nearest);
        if (!take_next()) return;
      } while (size_of(next.key) != 0);
    }
  }

  /// Of a single ray that ends at any hit: the leaves of a node first, its nodes in any order.
  void descend_to_any(const auto& rays, const auto& test, auto& nearest) const noexcept {
    const RayInterval<Real> interval(rays, bounds_, centre_);
    const Real limit = interval.limit(rays, nearest);
    std::array<std::uint32_t, (places - 1) * detail::max_depth + 1> waiting;
    std::size_t count = 1;
    waiting[0] = 0;
    do {
      const Node& node = nodes_[waiting[--count]];
      typename RayInterval<Real>::Keys keys;
      for (unsigned met = interval.inside(node.boxes, limit, keys) & node.used; met != 0; met &= met - 1) {
        const auto place = static_cast<std::size_t>(std::countr_zero(met));
        const std::uint32_t first = node.first[place];
        if (node.size[place] == 0) {
          waiting[count++] = first;
        } else {
          test(std::span<const PrimitiveIndex>(primitives_.data() + first, node.size[place]));
          if (nearest.done()) return;
        }
      }
    } while (count > 0);
  }

  template <class Test>
  [[gnu::always_inline]] void prefetch_entry(const StackEntry& next, const Test& test) const noexcept {
    static_assert(detail::members_checked<Test, tag::PrefetchesPrimitives>);
    if (next.size == 0)
      prefetch(&nodes_[next.first]);
    else if constexpr (PrefetchesPrimitives<Test>)
      test.prefetch(std::span<const PrimitiveIndex>(primitives_.data() + next.first, next.size));
  }

  /// Node of the wide tree to be made from a range of the binary tree.
  struct Open {
    typename BinaryTree::Range range;
    std::uint32_t node, depth;
  };

  /// Makes the upper nodes serially, the subtrees in parallel, then copies these into place.
  void collapse(const BinaryTree& binary, const Workers& workers) {
    const std::size_t count = binary.primitives().size();
    const SharedBuffer<PrimitiveIndex> primitives(count);
    std::vector<Node> upper;
    upper.resize(1);
    std::vector<Open> below;
    const std::size_t grain = std::max<std::size_t>(count / 64, 4096);
    std::size_t next = 0;
    std::size_t depth = make_nodes(binary, {binary.root(), 0, 1}, upper, primitives, next, grain, below);
    struct Subtree {
      std::vector<Node> nodes;
      std::size_t first_node = 0, first_primitive = 0, depth = 0;
    };
    std::vector<Subtree> subtrees(below.size());
    for (std::size_t i = 0; i < below.size(); ++i) {
      subtrees[i].first_primitive = next;
      next += below[i].range.size();
    }
    for_each_index(below.size(), workers, [&](std::size_t i) {
      Subtree& own = subtrees[i];
      own.nodes.resize(1);
      std::size_t at = own.first_primitive;
      std::vector<Open> none;
      own.depth = make_nodes(binary, {below[i].range, 0, below[i].depth}, own.nodes, primitives, at, 0, none);
    });
    std::size_t nodes = upper.size();
    for (Subtree& own : subtrees) {
      own.first_node = nodes;
      nodes += own.nodes.size() - 1;
      depth = std::max(depth, own.depth);
    }
    const SharedBuffer<Node> all(nodes);
    std::copy(upper.begin(), upper.end(), all.begin());
    for_each_index(subtrees.size(), workers,
                   [&](std::size_t i) {  // the first node of a subtree takes its reserved slot
                     const Subtree& own = subtrees[i];
                     for (std::size_t k = 0; k < own.nodes.size(); ++k) {
                       Node& node = all[k == 0 ? below[i].node : own.first_node + k - 1] = own.nodes[k];
                       for (std::size_t place = 0; place < node.count(); ++place)
                         if (node.size[place] == 0) node.first[place] += static_cast<std::uint32_t>(own.first_node - 1);
                     }
                   });
    nodes_ = all;
    primitives_ = primitives;
    depth_ = depth;
  }

  /// Fills the reserved node `open.node` and makes its subtree. Ranges of at most `grain`
  /// primitives go to `below` instead. Returns the depth.
  static std::size_t make_nodes(const BinaryTree& binary, const Open& open, std::vector<Node>& nodes,
                                const SharedBuffer<PrimitiveIndex>& primitives, std::size_t& next, std::size_t grain,
                                std::vector<Open>& below) {
    if (open.range.size() <= grain) {
      below.push_back(open);
      return 0;
    }
    typename BinaryTree::Children children;
    binary.gather(open.range, places, children);
    Node node;
    node.used = static_cast<std::uint8_t>((1U << children.count) - 1);
    std::size_t inner = nodes.size();
    for (std::size_t place = 0; place < children.count; ++place) {
      const auto& child = children.ranges[place];
      const bool leaf = binary.leaf(child);
      node.boxes.put(place, binary.box(child));
      node.size[place] = static_cast<std::uint8_t>(leaf ? child.size() : 0);
      node.first[place] = static_cast<std::uint32_t>(leaf ? next : inner++);
      if (leaf)
        for (std::uint32_t i = child.begin; i < child.end; ++i) primitives[next++] = binary.primitives()[i].primitive;
    }
    nodes[open.node] = node;
    nodes.resize(inner);
    std::size_t depth = open.depth;
    for (std::size_t place = children.count; place-- > 0;) {
      if (node.size[place] > 0) continue;
      const Open child{children.ranges[place], node.first[place], open.depth + 1};
      depth = std::max(depth, make_nodes(binary, child, nodes, primitives, next, grain, below));
    }
    return depth;
  }

  Box bounds_;
  Vec3 centre_{};
  SharedArray<Node> nodes_;                 ///< root first
  SharedArray<PrimitiveIndex> primitives_;  ///< leaf primitives
  std::size_t depth_ = 0;
};

}  // namespace PULSECAST_NAMESPACE

#endif
