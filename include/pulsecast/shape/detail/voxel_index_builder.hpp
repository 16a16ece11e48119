// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_VOXEL_INDEX_BUILDER_HPP
#define PULSECAST_SHAPE_DETAIL_VOXEL_INDEX_BUILDER_HPP

#include <pulsecast/shape/detail/voxel_index.hpp>
#include <pulsecast/shape/voxel_data.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Cell of the data, by its coordinates.
using DataCell = std::array<std::uint32_t, 3>;

[[nodiscard]] inline LatticeCell cell_offset(const DataCell& a, const DataCell& b) noexcept {
  const auto part = [&](std::size_t k) { return static_cast<std::int32_t>(a[k] - b[k]); };
  return {part(0), part(1), part(2)};
}

/// Sort order in which the cells of a brick, and the bricks of a block, are contiguous.
[[nodiscard]] inline std::uint64_t cell_sort_key(const LatticeCell& c) noexcept {
  const auto part = [&](std::size_t k) { return static_cast<std::uint64_t>(c[k] >> 4); };
  const std::uint64_t block = part(0) | part(1) << 17 | part(2) << 34;
  return block << 12 | std::uint64_t{cell_bit(c, 2)} << 6 | cell_bit(c, 0);
}

/// Child masks, and the number of the first child of each node.
struct VoxelNodes {
  std::vector<std::uint64_t> mask;
  std::vector<std::uint32_t> first;

  explicit VoxelNodes(std::size_t n) {
    mask.reserve(n);
    first.reserve(n);
  }
  void put(unsigned bit, std::size_t child, bool begins) {
    if (begins) {
      mask.push_back(0);
      first.push_back(static_cast<std::uint32_t>(child));
    }
    mask.back() |= std::uint64_t{1} << bit;
  }
};

/// Builder of a voxel index: sorts cells, groups and hashes bricks and blocks, makes the pyramid.
class VoxelIndexBuilder {
 public:
  explicit VoxelIndexBuilder(VoxelIndex& index) noexcept : index_(index) {}

  void build(const VoxelData& data, std::vector<std::uint32_t>& order) {
    const DataCell least = place(data);
    const std::vector<Keyed> sorted = sorted_cells(data, least);
    order.clear();
    order.reserve(sorted.size());
    std::size_t bricks = 0, blocks = 0;
    std::uint64_t last = no_key;
    for (const Keyed& cell : sorted) {
      if (cell.key == last)
        throw SettingError("VoxelData::cells", cell.number, "",
                           "unique; this entry repeats entry " + std::to_string(order.back()));
      bricks += cell.key >> 6 != last >> 6;
      blocks += cell.key >> 12 != last >> 12;
      last = cell.key;
      order.push_back(cell.number);
    }
    const std::size_t flat = 25 * bricks, deep = 12 * bricks + 28 * blocks;
    const std::size_t budget = 26 * sorted.size(), least_taken = std::min(flat, deep);
    index_.height_ = deep < flat ? 2 : 1;
    const std::size_t roots = index_.height_ == 2 ? blocks : bricks;
    std::vector<std::uint64_t> keys = group(data, least, sorted, bricks, roots);
    hash(keys, roots * (index_.height_ == 2 ? 8 : 5) / 4 + 1);
    make_pyramid(keys, std::max(budget, least_taken) - least_taken);
    index_.size_ = static_cast<std::uint32_t>(sorted.size());
    index_.keys_ = SharedArray<std::uint64_t>(std::move(keys));
  }

 private:
  struct Keyed {
    std::uint64_t key;
    std::uint32_t number;
    friend bool operator<(const Keyed& a, const Keyed& b) noexcept {
      return a.key < b.key || (a.key == b.key && a.number < b.number);
    }
  };

  static constexpr std::uint64_t no_key = ~std::uint64_t{0};

  /// Sets the bounds of the index and returns the lowest coordinates.
  DataCell place(const VoxelData& data) {
    DataCell least = data.cells.front(), most = least;
    for (const auto& cell : data.cells)
      for (std::size_t k = 0; k < 3; ++k) {
        least[k] = std::min(least[k], cell[k]);
        most[k] = std::max(most[k], cell[k]);
      }
    for (std::size_t k = 0; k < 3; ++k) {
      if (most[k] - least[k] >= VoxelIndex::longest)
        throw SettingError("VoxelData::cells", most[k], "", "within 2097152 cells of each other along each axis");
      index_.extent_[k] = static_cast<std::int32_t>(most[k] - least[k] + 1);
    }
    const LatticeCell& extent = index_.extent_;
    index_.edge_ = data.edge;
    const Vec3 corner = index_.corner_ = data.corner + data.edge * Vec3(least[0], least[1], least[2]);
    index_.bounds_ = {corner, corner + data.edge * Vec3(extent[0], extent[1], extent[2])};
    return least;
  }

  /// Cells in the order of their keys; of equal ones, in the order of the data.
  static std::vector<Keyed> sorted_cells(const VoxelData& data, const DataCell& least) {
    std::vector<Keyed> sorted(data.cells.size());
    for (std::size_t i = 0; i < sorted.size(); ++i)
      sorted[i] = {cell_sort_key(cell_offset(data.cells[i], least)), static_cast<std::uint32_t>(i)};
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }

  /// Sets the bricks and blocks of the index and returns the keys of the roots.
  std::vector<std::uint64_t> group(const VoxelData& data, const DataCell& least, const std::vector<Keyed>& sorted,
                                   std::size_t bricks, std::size_t roots) {
    const int height = index_.height_;
    VoxelNodes brick(bricks), block(height == 2 ? roots : 0);
    std::vector<std::uint64_t> keys;
    keys.reserve(roots);
    std::uint64_t last = no_key;
    for (std::size_t i = 0; i < sorted.size(); last = sorted[i++].key) {
      const std::uint64_t key = sorted[i].key;
      const bool new_brick = key >> 6 != last >> 6, new_root = key >> 6 * height != last >> 6 * height;
      const DataCell& cell = data.cells[sorted[i].number];
      if (new_root) keys.push_back(packed_cell(cell_offset(cell, least), 2 * height));
      if (new_brick && height == 2)
        block.put(static_cast<unsigned>(key >> 6) & 63, brick.first.size(), key >> 12 != last >> 12);
      brick.put(static_cast<unsigned>(key) & 63, i, new_brick);
    }
    index_.brick_masks_ = SharedArray<std::uint64_t>(std::move(brick.mask));
    index_.brick_first_ = SharedArray<std::uint32_t>(std::move(brick.first));
    index_.block_masks_ = SharedArray<std::uint64_t>(std::move(block.mask));
    index_.block_first_ = SharedArray<std::uint32_t>(std::move(block.first));
    return keys;
  }

  void hash(const std::vector<std::uint64_t>& keys, std::size_t size) {
    std::vector<std::uint32_t> slots(size, VoxelIndex::nothing);
    for (std::size_t root = 0; root < keys.size(); ++root) {
      std::size_t s = hash_slot(keys[root], size);
      while (slots[s] != VoxelIndex::nothing) s = s + 1 == size ? 0 : s + 1;
      slots[s] = static_cast<std::uint32_t>(root);
    }
    index_.slots_ = SharedArray<std::uint32_t>(std::move(slots));
  }

  /// Builds levels from the cubes of the roots on, each of four times the edge of the one before. A
  /// fourth of the budget bounds each level indexed directly; hashed levels share the rest.
  void make_pyramid(const std::vector<std::uint64_t>& keys, std::size_t budget) {
    const std::size_t affordable = budget / sizeof(std::uint64_t);
    std::vector<VoxelLevel> levels;
    std::vector<std::size_t> whole;  // words
    for (std::int32_t shift = 2 * index_.height_; levels.empty() || whole.back() > 1; shift += 2) {
      std::array<std::size_t, 3> n;
      for (std::size_t k = 0; k < 3; ++k) n[k] = (static_cast<std::size_t>(index_.extent_[k] - 1) >> (shift + 2)) + 1;
      levels.push_back(
          {.extent = {static_cast<std::uint32_t>(n[0]), static_cast<std::uint32_t>(n[1])}, .shift = shift});
      whole.push_back(n[0] * n[1] * n[2]);
    }
    std::size_t hashed = 0;
    for (const std::size_t words : whole) hashed += words > affordable / 4 ? 1 : 0;
    std::vector<std::uint64_t> pyramid;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      VoxelLevel& level = levels[i];
      if (whole[i] > affordable / 4) level.words = affordable * 3 / 4 / hashed;
      const std::size_t words = level.words > 0 ? static_cast<std::size_t>(level.words) : whole[i];
      if (pyramid.size() + words > affordable) continue;
      level.first = pyramid.size();
      pyramid.resize(pyramid.size() + words);
      for (const std::uint64_t key : keys) {
        const LatticeCell c = root_corner(key);
        pyramid[level.word(c)] |= std::uint64_t{1} << cell_bit(c, level.shift);
      }
      std::size_t set = 0;
      for (std::size_t w = level.first; w < pyramid.size(); ++w)
        set += static_cast<std::size_t>(std::popcount(pyramid[w]));
      if (level.words > 0 && set > words * 60)
        pyramid.resize(pyramid.size() - words);  // almost full
      else
        index_.levels_[index_.level_count_++] = level;
    }
    index_.pyramid_ = SharedArray<std::uint64_t>(std::move(pyramid));
  }

  LatticeCell root_corner(std::uint64_t key) const noexcept {
    const LatticeCell c = unpacked_cell(key);
    return {c[0] << 2 * index_.height_, c[1] << 2 * index_.height_, c[2] << 2 * index_.height_};
  }

  VoxelIndex& index_;
};

}  // namespace detail

inline VoxelIndex::VoxelIndex(const VoxelData& data, std::vector<std::uint32_t>& order) {
  detail::VoxelIndexBuilder(*this).build(data, order);
}

}  // namespace PULSECAST_NAMESPACE

#endif
