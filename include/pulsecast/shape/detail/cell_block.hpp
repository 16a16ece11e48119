// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_CELL_BLOCK_HPP
#define PULSECAST_SHAPE_DETAIL_CELL_BLOCK_HPP

#include <pulsecast/geometry/detail/bundle_interval.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Heights of 4 by 2 cells of a node of level 1: in the raster, or copied, at its edge or packed.
class CellBlock {
 public:
  /// Sets the heights of the cells of a node, and returns the mask of those in the raster.
  unsigned put(Box8<float>& boxes, const RasterGrid& grid, const PixelHeights& all, std::uint32_t column,
               std::uint32_t row) noexcept {
    const std::uint32_t c = 4 * column, r = 2 * row;
    const bool is_whole = c + 5 <= grid.columns && r + 3 <= grid.rows;
    if (is_whole && !all.is_packed()) {
      rows_[0] = all.floats() + grid.index(c, r);
      rows_[1] = rows_[0] + grid.columns;
      rows_[2] = rows_[1] + grid.columns;
      put(boxes);
      return 0xFF;
    }
    const std::uint32_t wide = std::min(grid.columns - c, 5U), high = std::min(grid.rows - r, 3U);
    all.read([&](const auto& heights) {
      is_whole ? copy(heights, grid, c, r) : copy_edge(heights, grid, c, r, wide, high);
    });
    for (std::size_t i = 0; i < 3; ++i) rows_[i] = copied_[i];
    put(boxes);
    const unsigned part = (1U << (wide - 1)) - 1;
    return high == 3 ? part | part << 4 : part;
  }

  /// Cell at a place from 0 to 7 of the node, of this column and row of the raster.
  [[nodiscard]] RasterCell cell(unsigned place, std::uint32_t column, std::uint32_t row) const noexcept {
    return {rows_[place >> 2] + (place & 3), rows_[(place >> 2) + 1] + (place & 3), column, row};
  }

 private:
  void copy(const auto& heights, const RasterGrid& grid, std::uint32_t c, std::uint32_t r) noexcept {
    for (std::uint32_t i = 0; i < 3; ++i)
      for (std::uint32_t j = 0; j < 5; ++j) copied_[i][j] = heights[grid.index(c + j, r + i)];
  }
  /// Copies the pixels in the raster, repeated beyond its edge.
  void copy_edge(const auto& heights, const RasterGrid& grid, std::uint32_t c, std::uint32_t r, std::uint32_t wide,
                 std::uint32_t high) noexcept {
    for (std::uint32_t i = 0; i < 3; ++i)
      for (std::uint32_t j = 0; j < 5; ++j)
        copied_[i][j] = heights[grid.index(c + std::min(j, wide - 1), r + std::min(i, high - 1))];
  }

  void put(Box8<float>& boxes) const noexcept {
    using FourHeights = simd::Vec<float, 4>;
    constexpr float most = std::numeric_limits<float>::max();
    const FourHeights zero = {};
    FourHeights low[3], high[3];
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = zero + most;
      high[i] = zero - most;
      for (const float* from : {rows_[i], rows_[i] + 1}) {  // NaN fails every comparison
        const FourHeights heights = simd::load<FourHeights>(*from);
        low[i] = heights < low[i] ? heights : low[i];
        high[i] = heights > high[i] ? heights : high[i];
      }
    }
    for (std::size_t i = 0; i < 2; ++i) {
      simd::store(FourHeights(low[i] < low[i + 1] ? low[i] : low[i + 1]), boxes.min[2][4 * i]);
      simd::store(FourHeights(high[i] > high[i + 1] ? high[i] : high[i + 1]), boxes.max[2][4 * i]);
    }
  }

  const float* rows_[3];
  float copied_[3][5];
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
