// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_COPC_PLAN_HPP
#define PULSECAST_IO_DETAIL_COPC_PLAN_HPP

#include <pulsecast/io/detail/copc/runs.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Sizes that shape the octree and the work on it.
struct CopcSizes {
  std::size_t leaf_points = 50'000;               ///< points of a leaf, unless it is too small
  std::size_t block_points = 1U << 19;            ///< points of a subtree that is built in memory
  std::size_t run_bytes = std::size_t{64} << 20;  ///< size of a run [byte]
  std::size_t most_cells = 1U << 20;              ///< cells of all runs
  std::size_t page_nodes = 64;                    ///< nodes of a subtree listed in the page above
};

/// Subtree that is built in memory: its root, and its points in the runs.
struct CopcBlock {
  CopcKey key{};
  std::uint64_t points = 0;
  std::vector<CopcExtent> extents{};
};

/// Division of points to blocks in the order of `copc_before`.
class CopcPlan {
 public:
  /// Division of all points, with a cube about them as root.
  CopcPlan(const CopcRuns& runs, const CopcSizes& sizes) : sizes_(sizes) {
    gather_cells(runs);
    choose_root(runs.bits());
    divide_all(runs);
  }

  /// Division of the points of one node, whose cells are smaller than the node.
  CopcPlan(const CopcRuns& runs, const CopcSizes& sizes, const CopcRoot& root, const CopcKey& top)
      : sizes_(sizes), top_(top), root_(root) {
    gather_cells(runs);
    corner_ = root.corner_of(top);
    for (std::int64_t& c : corner_) c >>= runs.bits();
    depth_ = root.bits - runs.bits();
    divide_all(runs);
  }

  [[nodiscard]] const CopcKey& top() const noexcept { return top_; }  ///< node that is divided
  [[nodiscard]] const CopcRoot& root() const noexcept { return root_; }
  [[nodiscard]] std::span<const CopcBlock> blocks() const noexcept { return blocks_; }

 private:
  struct Cell {
    std::uint64_t key = 0, path = 0;  // Morton numbers: in all space, and from `corner_`
    std::uint64_t count = 0;
    std::size_t block = 0;
  };

  void divide_all(const CopcRuns& runs) {
    for (Cell& cell : cells_) cell.path = copc_morton(from_corner(cell.key));
    std::ranges::sort(cells_, {}, &Cell::path);
    divide(cells_, top_);
    std::ranges::sort(cells_, {}, &Cell::key);
    find_extents(runs);
    cells_ = {};
  }

  void gather_cells(const CopcRuns& runs) {
    for (const auto& run : runs.cells())
      for (const CopcCell& cell : run) cells_.push_back({cell.key, 0, cell.count, 0});
    std::ranges::sort(cells_, {}, &Cell::key);
    std::size_t used = 0;
    for (const Cell& cell : cells_) {
      if (used > 0 && cells_[used - 1].key == cell.key)
        cells_[used - 1].count += cell.count;
      else
        cells_[used++] = cell;
    }
    cells_.resize(used);
    cells_.shrink_to_fit();
  }

  /// Chooses the least cube that holds all, of a power of two of cells, with room on either side.
  void choose_root(unsigned cell_bits) {
    CopcPlace least = copc_place_of(cells_[0].key), most = least;
    for (const Cell& cell : cells_) {
      const CopcPlace place = copc_place_of(cell.key);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        least[axis] = std::min(least[axis], place[axis]);
        most[axis] = std::max(most[axis], place[axis]);
      }
    }
    const std::int64_t widest = std::max({most[0] - least[0], most[1] - least[1], most[2] - least[2]});
    depth_ = static_cast<unsigned>(std::bit_width(static_cast<std::uint64_t>(widest)));
    root_.bits = depth_ + cell_bits;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t width = most[axis] - least[axis];
      corner_[axis] = least[axis] - ((std::int64_t{1} << depth_) - 1 - width) / 2;
      root_.corner[axis] = corner_[axis] * (std::int64_t{1} << cell_bits);
    }
  }

  [[nodiscard]] CopcPlace from_corner(std::uint64_t key) const noexcept {
    CopcPlace place = copc_place_of(key);
    for (std::size_t axis = 0; axis < 3; ++axis) place[axis] -= corner_[axis];
    return place;
  }

  /// Divides the cells of a node until blocks are small enough, or of a single cell.
  void divide(std::span<Cell> cells, const CopcKey& key) {
    std::uint64_t points = 0;
    for (const Cell& cell : cells) points += cell.count;
    const bool fine = root_.bits_of(key) <= copc_morton_bits || points <= sizes_.leaf_points;
    const auto level = static_cast<unsigned>(key.level);
    if (level == depth_ || (points <= sizes_.block_points && fine)) {
      for (Cell& cell : cells) cell.block = blocks_.size();
      blocks_.push_back({key, points, {}});
      return;
    }
    const unsigned shift = 3 * (depth_ - level - 1);
    for (unsigned i = 0; i < 8; ++i) {
      const auto end = std::ranges::partition_point(cells, [&](auto& c) { return (c.path >> shift & 7U) <= i; });
      const auto some = static_cast<std::size_t>(end - cells.begin());
      if (some > 0) divide(cells.first(some), key.child(i));
      cells = cells.subspan(some);
    }
  }

  /// Finds the points of each block in the runs, whose cells are ordered by keys, as `cells_`.
  void find_extents(const CopcRuns& runs) {
    std::uint64_t at = 0;
    for (const auto& run : runs.cells()) {
      auto known = cells_.begin();
      for (const CopcCell& cell : run) {
        known = std::ranges::lower_bound(known, cells_.end(), cell.key, {}, &Cell::key);
        std::vector<CopcExtent>& extents = blocks_[known->block].extents;
        if (!extents.empty() && extents.back().begin + extents.back().count == at)
          extents.back().count += cell.count;
        else
          extents.push_back({at, cell.count});
        at += cell.count;
      }
    }
  }

  CopcSizes sizes_;
  std::vector<Cell> cells_;
  std::vector<CopcBlock> blocks_;
  CopcKey top_{};
  CopcRoot root_;
  CopcPlace corner_{};  // of what is divided, in cells
  unsigned depth_ = 0;  // level of a cell
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
