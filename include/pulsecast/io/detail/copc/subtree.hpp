// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_COPC_SUBTREE_HPP
#define PULSECAST_IO_DETAIL_COPC_SUBTREE_HPP

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/io/detail/copc/octree.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Picks the point nearest to the centre of each cell of a node, the first of several, from
/// `counts` points of its children, in order of the cells: `cell(child, i)` is the cell of a point,
/// `off(child, i)` its distance from the centre. Returns those of each child, ascending.
template <class CellOf, class OffOf>
[[nodiscard]] auto copc_sample(std::span<const std::size_t> counts, const CellOf& cell, const OffOf& off) {
  std::vector<std::vector<std::uint32_t>> picked(counts.size());
  bool any = false;
  std::uint64_t now = 0, least = 0;
  for (std::size_t child = 0; child < counts.size(); ++child)
    for (std::uint32_t i = 0; i < counts[child]; ++i) {  // a cell never spans two children
      const std::uint64_t of = cell(child, i), distance = off(child, i);
      if (!any || of != now) {
        picked[child].push_back(i);
      } else if (distance < least) {
        picked[child].back() = i;
      } else {
        continue;
      }
      any = true;
      now = of;
      least = distance;
    }
  return picked;
}

/// Calls take(i) for the picked of `count` points, and leave(i) for the others, in order.
template <class Take, class Leave>
void copc_part(std::size_t count, std::span<const std::uint32_t> picked, const Take& take, const Leave& leave) {
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (next < picked.size() && picked[next] == i) {
      take(i);
      ++next;
    } else {
      leave(i);
    }
  }
}

/// Node of an octree in memory.
struct CopcNode {
  CopcKey key{};
  bool has_children = false;            ///< true if a node below holds points
  std::vector<std::uint32_t> points{};  ///< numbers of its records
};

/// Octree of some points below one node. A node is a leaf if it has few points, or its cells are no
/// longer than a step. Points of other nodes are picked from their children, from below.
class CopcSubtree {
 public:
  /// Whole records of `record` bytes within the node `key` of `root`.
  CopcSubtree(std::span<const std::byte> records, std::size_t record, const CopcRoot& root, const CopcKey& key,
              std::size_t leaf_points)
      : leaf_points_(leaf_points), bits_(std::min(root.bits_of(key), copc_morton_bits)) {
    const unsigned shift = root.bits_of(key) - bits_;
    const CopcPlace corner = root.corner_of(key);
    ranks_.resize(records.size() / record);
    for (std::size_t i = 0; i < ranks_.size(); ++i) {
      CopcPlace place = copc_place(records.data() + i * record);
      for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = (place[axis] - corner[axis]) >> shift;
      ranks_[i] = {copc_morton(place), static_cast<std::uint32_t>(i)};
    }
    std::sort(ranks_.begin(), ranks_.end());
    static_cast<void>(build(0, ranks_.size(), key, 0));
    for (CopcNode& node : nodes_)
      for (std::uint32_t& point : node.points) point = ranks_[point].number;
    ranks_ = {};
  }

  /// Nodes, children before parents; the last is the root.
  [[nodiscard]] std::vector<CopcNode>& nodes() noexcept { return nodes_; }

 private:
  /// Builds the node of a range of `ranks_`; returns its number. Until the end, points are ranks.
  std::size_t build(std::size_t begin, std::size_t end, const CopcKey& key, unsigned depth) {
    CopcNode node{key, false, {}};
    if (end - begin <= leaf_points_ || bits_ - depth <= copc_grid_bits) {
      node.points.resize(end - begin);
      std::iota(node.points.begin(), node.points.end(), static_cast<std::uint32_t>(begin));
      nodes_.push_back(std::move(node));
      return nodes_.size() - 1;
    }
    std::vector<std::size_t> children;
    const unsigned shift = 3 * (bits_ - depth - 1);
    for (unsigned i = 0; i < 8; ++i) {
      const auto some = std::span(ranks_).subspan(begin, end - begin);
      const auto border = std::ranges::partition_point(some, [&](auto& r) { return (r.key >> shift & 7U) <= i; });
      const std::size_t next = begin + static_cast<std::size_t>(border - some.begin());
      if (next > begin) children.push_back(build(begin, next, key.child(i), depth + 1));
      begin = next;
    }
    sample(node, children, bits_ - depth - copc_grid_bits);
    nodes_.push_back(std::move(node));
    return nodes_.size() - 1;
  }

  /// Moves points of the children to their parent, whose cells have a side of 2^cell_bits.
  void sample(CopcNode& node, std::span<const std::size_t> children, unsigned cell_bits) {
    std::vector<std::size_t> counts;
    for (const std::size_t child : children) counts.push_back(nodes_[child].points.size());
    const auto key = [&](auto child, auto i) { return ranks_[nodes_[children[child]].points[i]].key; };
    const auto cell = [&](auto child, auto i) { return key(child, i) >> (3 * cell_bits); };
    const auto off = [&](auto child, auto i) { return copc_off_centre(copc_place_of(key(child, i)), cell_bits); };
    const auto picked = copc_sample(counts, cell, off);
    for (std::size_t child = 0; child < children.size(); ++child) {
      CopcNode& below = nodes_[children[child]];
      std::size_t left = 0;
      const auto take = [&](auto i) { node.points.push_back(below.points[i]); };
      copc_part(counts[child], picked[child], take, [&](auto i) { below.points[left++] = below.points[i]; });
      below.points.resize(left);
      node.has_children = node.has_children || below.has_children || left > 0;
    }
  }

  std::size_t leaf_points_;
  unsigned bits_;  // side of the root: 2^bits units of the ranks' keys
  std::vector<CopcRank> ranks_;
  std::vector<CopcNode> nodes_;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
