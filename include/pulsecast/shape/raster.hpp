// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_RASTER_HPP
#define PULSECAST_SHAPE_RASTER_HPP

#include <pulsecast/shape/mesh_data.hpp>
#include <pulsecast/shape/packed_heights.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

inline constexpr std::uint32_t max_pixels = std::uint32_t{1} << 27;  ///< per row or column

/// Placement of a raster's pixels: row 0 is the northernmost, column 0 the westernmost.
struct RasterGrid {
  std::uint32_t columns = 0, rows = 0;
  Vec2 first{}, pixel{1, 1};

  [[nodiscard]] Vec3 vertex(std::uint32_t column, std::uint32_t row, float height) const noexcept {
    return {first.x + column * pixel.x, first.y - row * pixel.y, static_cast<double>(height)};
  }

  [[nodiscard]] std::size_t index(std::uint32_t column, std::uint32_t row) const noexcept {
    return std::size_t{row} * columns + column;
  }

  /// Pixel that holds a place, edges of the raster included; empty outside.
  [[nodiscard]] std::optional<std::size_t> pixel_at(const Vec3& place) const noexcept {
    const double east = (place.x - first.x) / pixel.x + 0.5;
    const double south = (first.y - place.y) / pixel.y + 0.5;
    if (!(east >= 0 && east <= columns && south >= 0 && south <= rows)) return std::nullopt;
    return index(std::min(static_cast<std::uint32_t>(east), columns - 1),
                 std::min(static_cast<std::uint32_t>(south), rows - 1));
  }

  /// Pixel of the right angle of triangle i, row by row, two a cell; inner pixels have two.
  [[nodiscard]] std::size_t owner(PrimitiveIndex i) const noexcept {
    const std::uint32_t cell = i / 2, which = i % 2, cells = columns - 1;
    return index(cell % cells + which, cell / cells + which);
  }
};

/// Cell with corners north-west, south-west, south-east, north-east; triangles 0 1 3 and 1 2 3.
struct RasterCell {
  std::uint32_t column, row;
  float heights[4];

  /// `all`: heights by pixel, `const float*` or `PackedPixels`.
  RasterCell(const RasterGrid& grid, const auto& all, std::uint32_t c, std::uint32_t r) noexcept : column(c), row(r) {
    const std::size_t north = grid.index(c, r), south = north + grid.columns;
    heights[0] = all[north];
    heights[1] = all[south];
    heights[2] = all[south + 1];
    heights[3] = all[north + 1];
  }
  /// `north`, `south`: height of the corner in the west of each row; the next is that in the east.
  RasterCell(const float* north, const float* south, std::uint32_t c, std::uint32_t r) noexcept
      : column(c), row(r), heights{north[0], south[0], south[1], north[1]} {}

  /// True if no corner of a triangle is missing, that is NaN.
  [[nodiscard]] bool has(int triangle) const noexcept {
    const float own = heights[2 * triangle];
    return own == own && heights[1] == heights[1] && heights[3] == heights[3];
  }

  [[nodiscard]] Vec3 corner(const RasterGrid& grid, int k) const noexcept {
    return grid.vertex(column + (k >= 2 ? 1 : 0), row + (k == 1 || k == 2 ? 1 : 0), heights[k]);
  }

  [[nodiscard]] Triangle triangle(const RasterGrid& grid, int which) const noexcept {
    return {corner(grid, which), corner(grid, which + 1), corner(grid, 3)};
  }
};

}  // namespace detail

/// Heights at pixel centres, as in a terrain file. Between four of them are two triangles that meet
/// along the south-west to north-east diagonal; one with a missing corner is left out.
struct Raster {
  std::uint32_t columns = 0, rows = 0;  ///< pixels, from 2 to 2^27 each
  Vec2 first{};                         ///< centre of the first pixel, north-west [m east, m north]
  Vec2 pixel{1, 1};                     ///< spacing of the centres, to the east and to the south [m]
  std::vector<float> heights{};         ///< heights, row by row from the north [m]; NaN if missing
  /// By pixel, index into the part's materials, for triangles with a right angle there; empty: 0.
  std::vector<std::uint8_t> materials{};
  PackedHeights packed{};  ///< heights in 16 bits, in place of `heights`

  void validate() const {
    require_within("Raster::columns", columns, 2, detail::max_pixels, "");
    require_within("Raster::rows", rows, 2, detail::max_pixels, "");
    // two primitives per cell, none of which is `ClosestHits::none`
    const double cells = (columns - 1.0) * (rows - 1.0);
    require_within("Raster::columns and rows, cells between them", cells, 1, 2147483647, "");
    require_within("Raster::first.x", first.x, -1e15, 1e15, "m");
    require_within("Raster::first.y", first.y, -1e15, 1e15, "m");
    // coordinates round by at most an eighth of the least pixel size, so that no two centres coincide
    const auto least = [](double at) { return std::max(1e-9, 0x1p-50 * std::fabs(at)); };
    require_within("Raster::pixel.x", pixel.x, least(first.x), 1e6, "m");
    require_within("Raster::pixel.y", pixel.y, least(first.y), 1e6, "m");
    is_packed() ? check_packed() : check_heights();
    if (!materials.empty()) require_pixels("Raster::materials", materials.size(), ", or none");
  }

  /// Number of pixels.
  [[nodiscard]] std::size_t pixels() const noexcept { return std::size_t{columns} * rows; }
  /// True if the heights are in 16 bits.
  [[nodiscard]] bool is_packed() const noexcept { return !packed.numbers.empty(); }

  /// Calls `work` with the heights of pixels by their index [m], NaN if missing: a
  /// `std::vector<float>` or a value that is indexed like it.
  decltype(auto) read(const auto& work) const {
    if (!is_packed()) return work(heights);
    const std::vector<float> table = detail::height_table(packed);
    return work(detail::PackedPixels{packed.numbers.data(), table.data()});
  }

  /// The same raster with heights in `float`. @throws SettingError as `validate`
  [[nodiscard]] Raster unpacked() const {
    validate();
    if (!is_packed()) return *this;
    Raster wide{.columns = columns, .rows = rows, .first = first, .pixel = pixel};
    wide.materials = materials;
    wide.heights.reserve(pixels());
    read([&](const auto& height) {
      for (std::size_t i = 0; i < pixels(); ++i) wide.heights.push_back(height[i]);
    });
    return wide;
  }

  /// Placement of the pixels.
  [[nodiscard]] detail::RasterGrid grid() const noexcept { return {columns, rows, first, pixel}; }

  /// The same ground as a mesh, with the same hits and 13 times the memory. @throws SettingError
  [[nodiscard]] MeshData mesh() const {
    validate();
    constexpr std::uint32_t missing = std::numeric_limits<std::uint32_t>::max();
    const detail::RasterGrid grid = this->grid();
    if (is_packed()) return unpacked().mesh();
    MeshData mesh;
    std::vector<std::uint32_t> number(heights.size(), missing);
    for (std::uint32_t row = 0; row + 1 < rows; ++row)
      for (std::uint32_t column = 0; column + 1 < columns; ++column) {
        const detail::RasterCell cell(grid, heights.data(), column, row);
        const std::size_t north = grid.index(column, row), south = grid.index(column, row + 1);
        const std::size_t corners[4] = {north, south, south + 1, north + 1};
        for (const int which : {0, 1}) {
          if (!cell.has(which)) continue;
          std::array<std::uint32_t, 3> triangle{};
          for (std::size_t i = 0; i < 3; ++i) {
            const int k = i == 2 ? 3 : which + static_cast<int>(i);
            std::uint32_t& vertex = number[corners[k]];
            if (vertex == missing) {
              vertex = static_cast<std::uint32_t>(mesh.vertices.size());
              mesh.vertices.push_back(cell.corner(grid, k));
            }
            triangle[i] = vertex;
          }
          mesh.triangles.push_back(triangle);
          if (materials.empty()) continue;
          mesh.materials.push_back(materials[which == 0 ? north : south + 1]);
        }
      }
    return mesh;
  }

 private:
  void require_pixels(const char* field, std::size_t size, const char* rest) const {
    if (size == pixels()) return;
    throw SettingError(field, static_cast<double>(size), "", "as many as pixels, " + std::to_string(pixels()) + rest);
  }
  void check_heights() const {
    require_pixels("Raster::heights", heights.size(), "");
    for (std::size_t i = 0; i < heights.size(); ++i)
      if (std::fabs(heights[i]) > 1e15F)
        throw SettingError("Raster::heights", static_cast<double>(heights[i]), "m",
                           "within 1e15 m, or NaN; see pixel " + std::to_string(i));
  }

  void check_packed() const {
    packed.validate();
    require_within("Raster::heights (number of them beside `packed`)", heights.size(), 0, 0);
    require_pixels("Raster::packed.numbers", packed.numbers.size(), ", or none");
  }
};

namespace detail {

/// Column or row of a tile's first pixel, `offset` from that of a mosaic [m]. @throws SettingError
/// if it, or the tile's last one of `count` pixels of size `own`, is between two pixels
[[nodiscard]] inline std::uint32_t place_in_mosaic(double offset, double own, std::uint32_t count, double pixel) {
  const double place = offset / pixel, nearest = std::nearbyint(place);
  const double slip = std::fabs(place - nearest) + std::fabs(own / pixel - 1) * count;
  require_within("mosaic (shift of a tile's pixels against those of the first)", slip, 0, 0.01, "pixel");
  return static_cast<std::uint32_t>(nearest);
}

/// Number that no height of any raster has; empty if none, or if they are packed differently.
[[nodiscard]] inline std::optional<std::uint16_t> number_of_gaps(const std::vector<Raster>& tiles) {
  const PackedHeights& alike = tiles.front().packed;
  for (const Raster& tile : tiles)
    if (!tile.is_packed() || !tile.packed.same_scale(alike)) return {};
  if (alike.missing) return alike.missing;
  std::vector<bool> present(std::size_t{std::numeric_limits<std::uint16_t>::max()} + 1, false);
  for (const Raster& tile : tiles)
    for (const std::uint16_t number : tile.packed.numbers) present[number] = true;
  const auto gap = std::find(present.begin(), present.end(), false);
  if (gap == present.end()) return {};
  return static_cast<std::uint16_t>(gap - present.begin());
}

}  // namespace detail

/// Raster of tiles whose pixels are those of one lattice, to a hundredth, without a gap between
/// them. Pixels without a tile are missing; where tiles overlap, the first with a height counts.
/// Its heights are packed if all are, with one scale. @throws SettingError as `Raster::validate`;
/// for no tile, pixels of different lattices, or tiles on less than a 64th of their extent
[[nodiscard]] inline Raster mosaic(const std::vector<Raster>& tiles) {
  require_within("mosaic (number of tiles)", tiles.size(), 1, 1'000'000);
  const Vec2 pixel = tiles.front().pixel, first = tiles.front().first;
  double west = first.x, north = first.y, east = west, south = north, pixels = 0;
  for (const Raster& tile : tiles) {
    tile.validate();
    west = std::min(west, tile.first.x);
    north = std::max(north, tile.first.y);
    east = std::max(east, tile.first.x + (tile.columns - 1) * pixel.x);
    south = std::min(south, tile.first.y - (tile.rows - 1) * pixel.y);
    pixels += static_cast<double>(tile.pixels());
  }
  const double columns = std::nearbyint((east - west) / pixel.x) + 1,
               rows = std::nearbyint((north - south) / pixel.y) + 1;
  require_within("mosaic (pixels)", columns * rows, 4, std::min(64 * pixels, 4294967296.0), "");
  Raster all{.columns = static_cast<std::uint32_t>(columns),
             .rows = static_cast<std::uint32_t>(rows),
             .first = {west, north},
             .pixel = pixel};
  const detail::RasterGrid grid = all.grid();
  const std::optional<std::uint16_t> gap = detail::number_of_gaps(tiles);
  if (gap) {
    const PackedHeights& alike = tiles.front().packed;
    all.packed = {.scale = alike.scale, .offset = alike.offset, .zero = alike.zero, .missing = gap};
    all.packed.numbers.assign(all.pixels(), *gap);
  } else {
    all.heights.assign(all.pixels(), std::numeric_limits<float>::quiet_NaN());
  }
  for (const Raster& tile : tiles) {
    const std::uint32_t column = detail::place_in_mosaic(tile.first.x - west, tile.pixel.x, tile.columns, pixel.x);
    const std::uint32_t row = detail::place_in_mosaic(north - tile.first.y, tile.pixel.y, tile.rows, pixel.y);
    if (!tile.materials.empty()) all.materials.resize(all.pixels(), 0);
    tile.read([&](const auto& heights) {
      for (std::uint32_t r = 0; r < tile.rows; ++r)
        for (std::uint32_t c = 0; c < tile.columns; ++c) {
          const std::size_t from = tile.grid().index(c, r), to = grid.index(column + c, row + r);
          if (gap ? all.packed.numbers[to] != *gap : !std::isnan(all.heights[to])) continue;
          if (gap)
            all.packed.numbers[to] = tile.packed.numbers[from];
          else
            all.heights[to] = heights[from];
          if (!tile.materials.empty()) all.materials[to] = tile.materials[from];
        }
    });
  }
  all.validate();
  return all;
}

/// Material of the pixels with a code, such as a class of land cover.
struct CodeMaterial {
  double code = 0;            ///< number in the raster of codes
  std::uint8_t material = 0;  ///< index into the part's table of materials
};

/// Sets the materials of a raster by one of codes, which may have other pixels: each pixel takes
/// the code of the one that its centre is in. `otherwise` is for pixels without a code, or with one
/// that is not listed; returns their number. @throws SettingError as `Raster::validate`, of both
inline std::size_t set_materials(Raster& ground, const Raster& codes, const std::vector<CodeMaterial>& listed,
                                 std::uint8_t otherwise = 0) {
  ground.validate();
  codes.validate();
  const detail::RasterGrid grid = ground.grid();
  const auto by_code = [](const auto& a, const auto& b) { return a.code < b.code; };
  std::vector<CodeMaterial> sorted = listed;  // of equal codes, the first counts
  std::erase_if(sorted, [](const CodeMaterial& one) { return std::isnan(one.code); });
  std::stable_sort(sorted.begin(), sorted.end(), by_code);
  std::size_t unlisted = 0;
  std::vector<std::uint8_t> materials(ground.pixels(), otherwise);
  codes.read([&](const auto& code) {
    for (std::uint32_t row = 0; row < ground.rows; ++row)
      for (std::uint32_t column = 0; column < ground.columns; ++column) {
        const std::optional<std::size_t> at = codes.grid().pixel_at(grid.vertex(column, row, 0));
        const CodeMaterial own{at ? static_cast<double>(code[*at]) : std::nan(""), 0};
        const auto found = std::lower_bound(sorted.begin(), sorted.end(), own, by_code);
        if (found == sorted.end() || found->code != own.code)
          ++unlisted;
        else
          materials[grid.index(column, row)] = found->material;
      }
  });
  ground.materials = std::move(materials);
  return unlisted;
}

}  // namespace PULSECAST_NAMESPACE

#endif
