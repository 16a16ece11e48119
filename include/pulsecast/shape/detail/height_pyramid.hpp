// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_HEIGHT_PYRAMID_HPP
#define PULSECAST_SHAPE_DETAIL_HEIGHT_PYRAMID_HPP

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/shape/raster.hpp>

/// Min-max pyramid of the heights of a raster: its layout and its construction.
namespace PULSECAST_NAMESPACE::detail {

/// Rectangle of cells or nodes, ends included.
struct CellRectangle {
  std::uint32_t west, east, north, south;

  [[nodiscard]] std::size_t count() const noexcept { return (std::size_t{east} - west + 1) * (south - north + 1); }
  /// Nodes that hold the cells; a node is 2^wide by 2^tall cells.
  [[nodiscard]] CellRectangle in_nodes(std::uint32_t wide, std::uint32_t tall) const noexcept {
    return {west >> wide, east >> wide, north >> tall, south >> tall};
  }
};

/// Interval of heights [m]; empty at first.
struct HeightInterval {
  float least = std::numeric_limits<float>::max(), greatest = -std::numeric_limits<float>::max();

  void extend(float low, float high) noexcept {  // NaN fails every comparison
    least = low < least ? low : least;
    greatest = high > greatest ? high : greatest;
  }
};

/// Level 0 are the cells. A node of a higher level has eight children in the level below: 4 by 2
/// cells, then alternately 2 by 4 and 4 by 2 nodes. The pyramid holds their heights, node by node:
/// eight minima, then eight maxima; an empty interval without triangle.
struct PyramidLevel {
  std::uint32_t columns = 0, rows = 0;
  std::size_t begin = 0;                 ///< start in the pyramid
  std::array<std::uint32_t, 2> shift{};  ///< log2 of a node's width and height [cells]
  std::array<std::uint32_t, 2> below{};  ///< log2 of a child's width and height [cells]
  std::array<float, 8> east{}, south{};  ///< offsets of the children from the north-west [m]
  std::array<float, 2> size{};           ///< size of a child, east and south [m]

  [[nodiscard]] std::size_t node(std::uint32_t column, std::uint32_t row) const noexcept {
    return begin + (std::size_t{row} * columns + column) * 16;
  }
  /// Index of a child's minimum height, by its column and row; the maximum is eight numbers on.
  [[nodiscard]] std::size_t of_child(std::uint32_t column, std::uint32_t row) const noexcept {
    const std::uint32_t w = wide(), tall = 3 - w;
    const std::uint32_t right = column & ((1U << w) - 1), down = row & ((1U << tall) - 1);
    return node(column >> w, row >> tall) + right + (down << w);
  }
  /// Number of column bits in a child's slot.
  [[nodiscard]] std::uint32_t wide() const noexcept { return shift[0] - below[0]; }
  friend bool operator==(const PyramidLevel&, const PyramidLevel&) = default;
};

/// Levels of the pyramid of a raster, up to one that is a single node.
struct PyramidLayout {
  static constexpr std::size_t max_levels = 18;  ///< without level 0; two make one node of 8 by 8

  std::array<PyramidLevel, max_levels + 1> levels{};
  std::uint32_t top = 0;  ///< highest level
  std::size_t size = 0;   ///< numbers in the pyramid

  explicit PyramidLayout(const RasterGrid& grid) noexcept {
    levels[0] = {.columns = grid.columns - 1, .rows = grid.rows - 1};
    do {
      const PyramidLevel& below = levels[top];
      PyramidLevel& level = levels[++top];
      const std::uint32_t wide = top % 2 == 1 ? 2 : 1, tall = 3 - wide;
      level.columns = ((below.columns - 1) >> wide) + 1;
      level.rows = ((below.rows - 1) >> tall) + 1;
      level.begin = size;
      level.below = below.shift;
      level.shift = {below.shift[0] + wide, below.shift[1] + tall};
      level.size = {static_cast<float>((1U << below.shift[0]) * grid.pixel.x),
                    static_cast<float>((1U << below.shift[1]) * grid.pixel.y)};
      for (std::uint32_t i = 0; i < 8; ++i) {
        const std::uint32_t column = i & ((1U << wide) - 1), row = i >> wide;
        level.east[i] = static_cast<float>((column << below.shift[0]) * grid.pixel.x);
        level.south[i] = static_cast<float>((row << below.shift[1]) * grid.pixel.y);
      }
      if (top > 1) size = level.node(0, level.rows);  // level 1 reads the heights themselves
    } while (levels[top].columns > 1 || levels[top].rows > 1);
  }
};

/// Bounding box of the triangles of a node of level 1: 4 by 2 cells.
[[nodiscard]] Box ground_of(const RasterGrid& grid, const auto& heights, std::uint32_t node_column,
                            std::uint32_t node_row) {
  const std::uint32_t west = 4 * node_column, east = std::min(west + 4, grid.columns - 1);
  const std::uint32_t north = 2 * node_row, south = std::min(north + 2, grid.rows - 1);
  HeightInterval range;
  bool whole = true;
  for (std::uint32_t row = north; row <= south; ++row)
    for (std::size_t at = grid.index(west, row); at <= grid.index(east, row); ++at) {
      const float height = heights[at];
      range.extend(height, height);
      whole = whole && height == height;
    }
  Box box;
  if (whole) {
    box.extend(grid.vertex(west, south, range.least));
    box.extend(grid.vertex(east, north, range.greatest));
    return box;
  }
  for (std::uint32_t row = north; row < south; ++row)
    for (std::uint32_t column = west; column < east; ++column)
      for (const int which : {0, 1}) {
        const RasterCell cell(grid, heights, column, row);
        if (cell.has(which)) box.extend(cell.triangle(grid, which).bounds());
      }
  return box;
}

/// Heights of a pyramid, and the bounding box of the ground.
struct HeightPyramid {
  std::vector<float> heights;
  Box bounds{};

  HeightPyramid(const RasterGrid& grid, const auto& pixels, const PyramidLayout& layout, Workers workers)
      : heights(layout.size) {
    constexpr HeightInterval empty;
    for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = i % 16 < 8 ? empty.least : empty.greatest;
    std::vector<Box> grounds(layout.levels[1].rows);
    if (std::size_t{grid.columns} * grid.rows < 1'000'000) workers = 1;  // starts no threads
    for (unsigned level = 1; level <= layout.top; ++level)
      for_each_index(layout.levels[level].rows, level <= 2 ? workers : 1, [&](std::size_t task) {
        const auto row = static_cast<std::uint32_t>(task);
        for (std::uint32_t column = 0; column < layout.levels[level].columns; ++column) {
          HeightInterval own;
          if (level == 1) {
            const Box ground = ground_of(grid, pixels, column, row);
            if (ground.empty()) continue;
            grounds[row].extend(ground);
            own = {static_cast<float>(ground.min.z), static_cast<float>(ground.max.z)};
          } else {
            const float* below = heights.data() + layout.levels[level].node(column, row);
            own = {*std::min_element(below, below + 8), *std::max_element(below + 8, below + 16)};
          }
          if (level == layout.top) continue;
          float* place = heights.data() + layout.levels[level + 1].of_child(column, row);
          place[0] = own.least;
          place[8] = own.greatest;
        }
      });
    for (const Box& ground : grounds) bounds.extend(ground);
  }
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
