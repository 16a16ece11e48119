// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_CELL_NUMBERS_HPP
#define PULSECAST_IO_DETAIL_CELL_NUMBERS_HPP

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>
#include <vector>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Numbers of the cells of a lattice in order of first occurrence; 20 to 28 bytes a cell.
class CellNumbers {
 public:
  using Cell = std::array<std::uint32_t, 3>;
  static constexpr std::size_t max_size = 4294967294;  ///< upper limit, as in a grid of voxels

  [[nodiscard]] std::size_t size() const noexcept { return cells_.size(); }

  /// Number of a cell; a new cell gets the next one. Requires fewer than `max_size` cells before.
  [[nodiscard]] std::uint32_t number(const Cell& cell) {
    if (2 * (cells_.size() + 1) > slots_.size()) grow();
    std::uint32_t& slot = slots_[slot_of(cell)];
    if (slot == none) {
      slot = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back(cell);
    }
    return slot;
  }

  /// Cells in the order of their numbers, moved out.
  [[nodiscard]] std::vector<Cell> release() && { return std::move(cells_); }

 private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  /// Slot of the cell, or the free slot for it: linear probing from its hash.
  [[nodiscard]] std::size_t slot_of(const Cell& cell) const noexcept {
    std::size_t slot = hash(cell) & (slots_.size() - 1);
    while (slots_[slot] != none && cells_[slots_[slot]] != cell) slot = (slot + 1) & (slots_.size() - 1);
    return slot;
  }

  /// Mixes the coordinates. Source: Steele, Lea & Flood 2014, SplitMix64 (variant 13 of Stafford).
  [[nodiscard]] static std::size_t hash(const Cell& cell) noexcept {
    const std::uint64_t third = cell[2] * std::uint64_t{0x9E3779B97F4A7C15};
    std::uint64_t h = (std::uint64_t{cell[0]} << 32 | cell[1]) ^ std::rotl(third, 29);
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EB;
    return static_cast<std::size_t>(h ^ (h >> 31));
  }

  void grow() {
    slots_.assign(std::max<std::size_t>(16, 2 * slots_.size()), none);
    for (std::size_t i = 0; i < cells_.size(); ++i) slots_[slot_of(cells_[i])] = static_cast<std::uint32_t>(i);
  }

  std::vector<Cell> cells_;
  std::vector<std::uint32_t> slots_;  // cell numbers; a power of two, at most half of them taken
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
