// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_HEIGHT_FIELD_HPP
#define PULSECAST_SHAPE_HEIGHT_FIELD_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/shape/detail/cell_block.hpp>
#include <pulsecast/shape/detail/height_pyramid.hpp>
#include <pulsecast/shape/detail/packed_numbers.hpp>

namespace PULSECAST_NAMESPACE {

/// Ground of a raster with the hits of `Raster::mesh()`, bit by bit, without stored triangles: 5.2
/// bytes per cell, 3.2 where the heights are packed, and of 2, 4, 16 or 256 materials a further 1,
/// 2, 4 or 8 bits. Two-sided. The triangles of cell i, row by row, are primitives 2 i and 2 i + 1.
/// A min-max pyramid of heights, eight children per node, bounds the ground. A bundle traverses it
/// as a whole, front to back, row by row and column by column. Source: Tevs, Ihrke & Seidel 2008
/// (pyramid of heights); Wald, Boulos & Shirley 2007 (bundles by interval arithmetic).
class HeightField {
 public:
  using refinements = refines<tag::UniformGeometry, tag::DeterministicGeometry, tag::SelfChecking>;
  static constexpr bool uniform_surface = true;  ///< as the concept UniformGeometry describes
  static constexpr bool deterministic = true;    ///< as the concept DeterministicGeometry describes

  /// `workers`: threads of the build. @throws SettingError as `Raster::validate`
  explicit HeightField(Raster raster, const Workers& workers = {}) {
    raster.validate();
    grid_ = raster.grid();
    heights_ = {std::move(raster.heights), std::move(raster.packed)};
    materials_ = detail::PackedNumbers(raster.materials);
    const detail::PyramidLayout layout(grid_);
    levels_ = layout.levels;
    top_ = layout.top;
    const auto build = [&](const auto& pixels) { return detail::HeightPyramid(grid_, pixels, layout, workers); };
    auto built = heights_.read(build);
    pyramid_ = std::move(built.heights);
    bounds_ = built.bounds;
    const auto& [columns, rows, first, pixel] = grid_;
    per_metre_ = {1 / pixel.x, -1 / pixel.y};
    constexpr double single = std::numeric_limits<float>::epsilon();
    pad_ = {16 * single * columns * pixel.x, 16 * single * rows * pixel.y};
    centre_ = {first.x + 0.5 * columns * pixel.x, first.y - 0.5 * rows * pixel.y, 0};
  }

  explicit HeightField(DeserializeTag) {}
  void archive(auto& a) { a(grid_, levels_, top_, per_metre_, pad_, centre_, bounds_, heights_, pyramid_, materials_); }

  /// True if the array sizes match the grid.
  [[nodiscard]] bool is_consistent() const noexcept {
    constexpr std::uint32_t limit = detail::max_pixels;
    if (grid_.columns < 2 || grid_.rows < 2 || grid_.columns > limit || grid_.rows > limit) return false;
    const detail::PyramidLayout layout(grid_);
    const std::size_t pixels = std::size_t{grid_.columns} * grid_.rows;
    return heights_.is_consistent(pixels) && pyramid_.size() == layout.size && top_ == layout.top &&
           levels_ == layout.levels && materials_.is_consistent(pixels);
  }

  [[nodiscard]] std::uint32_t columns() const noexcept { return grid_.columns; }  ///< from west to east
  [[nodiscard]] std::uint32_t rows() const noexcept { return grid_.rows; }        ///< from north to south
  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  [[nodiscard]] std::size_t memory() const noexcept {
    return heights_.memory() + pyramid_.memory() + materials_.memory();
  }
  [[nodiscard]] std::size_t material_count() const noexcept { return std::size_t{materials_.greatest()} + 1; }

  /// Triangle of primitive i [m]; its missing corners are NaN.
  [[nodiscard]] Triangle triangle(PrimitiveIndex i) const noexcept {
    const std::uint32_t cell = i / 2, cells = grid_.columns - 1;
    return corners(cell % cells, cell / cells).triangle(grid_, static_cast<int>(i % 2));
  }

  template <class Rays, HitsOf<Rays> Hits>
  void closest(const Rays& rays, Hits& nearest) const noexcept {
    if (bounds_.empty()) return;
    Walk<Rays, Hits> walk(*this, rays, nearest);
    const float lowest = static_cast<float>(bounds_.min.z), highest = static_cast<float>(bounds_.max.z);
    auto span = walk.interval.inside({{-most, -most, lowest}, {most, most, highest}});
    Cells cells{0, levels_[0].columns - 1, 0, levels_[0].rows - 1};
    if (span.empty() || !walk.narrow(span, cells)) return;
    // clips the span to the heights of the cells passed, and these to the span, while that helps
    unsigned level = level_of(cells, top_);
    for (std::size_t before = std::numeric_limits<std::size_t>::max() / 4;
         cells.count() > 1 && 4 * cells.count() <= 3 * before;) {
      before = cells.count();
      const auto [low, high] = heights(cells, level);
      span = walk.interval.above(walk.interval.below(span, 2, high), 2, low);
      if (span.empty() || !walk.narrow(span, cells)) return;
      level = level_of(cells, level);
    }
    if (cells.count() <= few) {
      for (std::uint32_t row = cells.north; row <= cells.south; ++row)
        for (std::uint32_t column = cells.west; column <= cells.east; ++column) walk.take(*this, corners(column, row));
      return walk.test();
    }
    level = std::max(1U, level);
    const auto [x, y] = levels_[level].shift;
    const Cells nodes = cells.in_nodes(x, y);
    for (std::uint32_t i = 0; i <= nodes.south - nodes.north; ++i)
      for (std::uint32_t j = 0; j <= nodes.east - nodes.west; ++j)
        visit(walk, level, walk.westward ? nodes.east - j : nodes.west + j,
              walk.northward ? nodes.south - i : nodes.north + i);
  }

  [[nodiscard]] SurfaceInteraction surface(PrimitiveIndex i, const auto&, std::size_t) const noexcept {
    const Vec3 normal = triangle(i).normal();
    return {finite(normal) ? normal : Vec3{}, materials_[grid_.owner(i)]};
  }

 private:
  static constexpr float most = std::numeric_limits<float>::max();
  static constexpr std::size_t few = 4;  ///< cells up to this number are tested without traversal

  using Cells = detail::CellRectangle;
  using Heights = detail::HeightInterval;
  using Level = detail::PyramidLevel;

  /// Traversal of one bundle.
  template <class Rays, class Hits>
  struct Walk {
    const Rays& rays;
    Hits& nearest;
    BundleInterval<float> interval;
    double least[2], greatest[2];  ///< bounds of the directions [pixels east and south]
    double from[2], slack[2];      ///< origin and its bound of rounding [pixels east and south]
    float pad[2];                  ///< error bound of cell walls [m]
    bool westward, northward;      ///< order of traversal of nodes
    unsigned turns[2];             ///< child permutations by `wide()` less one, for `turned`
    float limit;
    std::array<Triangle, simd::lane_count> triangles;  ///< batch to be tested, with its primitives
    std::array<PrimitiveIndex, simd::lane_count> primitives;
    std::size_t taken = 0;
    detail::CellBlock block;  ///< of the last node of level 1

    Walk(const HeightField& field, const Rays& r, Hits& n) noexcept
        : rays(r), nearest(n), interval(r, field.bounds_, field.centre_), limit(round_up<float>(n.limit(r))) {
      const double bound = std::max(max_norm(field.bounds_.min), max_norm(field.bounds_.max));
      const double scale = std::max(max_norm(r.origin), bound);
      const double rounding = 128 * std::numeric_limits<double>::epsilon() * scale;
      for (int k = 0; k < 2; ++k) {
        const double per_metre = field.per_metre_[k];
        least[k] = (k == 0 ? r.direction_min(k) : r.direction_max(k)) * per_metre;
        greatest[k] = (k == 0 ? r.direction_max(k) : r.direction_min(k)) * per_metre;
        from[k] = (r.origin[k] - field.grid_.first[k]) * per_metre;
        slack[k] = rounding * std::fabs(per_metre);
        pad[k] = static_cast<float>(field.pad_[k] + rounding);
      }
      westward = least[0] < 0;
      northward = least[1] < 0;
      turns[0] = (westward ? 1U : 0U) | (northward ? 6U : 0U);
      turns[1] = (westward ? 3U : 0U) | (northward ? 4U : 0U);
    }

    using Span = BundleInterval<float>::Span;

    /// Adds the triangles of a cell to the batch; tests it when full.
    void take(const HeightField& field, const detail::RasterCell& cell) noexcept {
      const std::size_t number = std::size_t{cell.row} * (field.grid_.columns - 1) + cell.column;
      const auto first = static_cast<PrimitiveIndex>(2 * number);
      for (const int which : {0, 1})
        if (cell.has(which)) {
          triangles[taken] = cell.triangle(field.grid_, which);
          primitives[taken++] = first + static_cast<unsigned>(which);
        }
      if (taken + 2 > triangles.size()) test();
    }

    void test() noexcept {
      if (taken == 0) return;
      const auto triangle_of = [this](std::size_t n) noexcept { return triangles[n]; };
      intersect(std::span(std::as_const(primitives)).first(taken), triangle_of, rays, nearest);
      taken = 0;
      limit = round_up<float>(nearest.limit(rays));
    }

    /// Clips a rectangle to the cells that any ray passes in an interval; false if none is left.
    [[nodiscard]] bool narrow(const Span& span, Cells& cells) const noexcept {
      return narrow(0, span, cells.west, cells.east) && narrow(1, span, cells.north, cells.south);
    }

    /// Clips columns (k = 0) or rows (k = 1).
    [[nodiscard]] bool narrow(int k, const Span& span, std::uint32_t& low, std::uint32_t& high) const noexcept {
      const auto entry = static_cast<double>(span.entry), exit = static_cast<double>(span.exit);
      const double a = from[k] + least[k] * (least[k] < 0 ? exit : entry) - slack[k];
      const double b = from[k] + greatest[k] * (greatest[k] < 0 ? entry : exit) + slack[k];
      if (a >= high + 1.0 || b < low) return false;
      if (a > low) low = static_cast<std::uint32_t>(a);
      if (b < high) high = static_cast<std::uint32_t>(b);
      return true;
    }
  };

  [[nodiscard]] detail::RasterCell corners(std::uint32_t column, std::uint32_t row) const noexcept {
    return heights_.read([&](const auto& all) { return detail::RasterCell(grid_, all, column, row); });
  }

  /// Lowest level, from `level` down, whose nodes hold the cells in at most 2 by 2; or the top.
  [[nodiscard]] unsigned level_of(const Cells& cells, unsigned level) const noexcept {
    for (; level > 0; --level) {
      const Cells nodes = cells.in_nodes(levels_[level - 1].shift[0], levels_[level - 1].shift[1]);
      if (nodes.east - nodes.west > 1 || nodes.south - nodes.north > 1) break;
    }
    return level;
  }

  /// Bounds of the heights of cells, from the nodes of a level that hold them.
  [[nodiscard]] Heights heights(const Cells& cells, unsigned level) const noexcept {
    Heights all;
    if (level == top_) {
      all.extend(static_cast<float>(bounds_.min.z), static_cast<float>(bounds_.max.z));
    } else if (level == 0) {
      return heights_.read([&](const auto& pixels) noexcept { return heights(cells, pixels); });
    } else {
      const Level &own = levels_[level], &above = levels_[level + 1];
      const Cells nodes = cells.in_nodes(own.shift[0], own.shift[1]);
      for (std::uint32_t row = nodes.north; row <= nodes.south; ++row)
        for (std::uint32_t column = nodes.west; column <= nodes.east; ++column) {
          const float* own_heights = pyramid_.data() + above.of_child(column, row);
          all.extend(own_heights[0], own_heights[8]);
        }
    }
    return all;
  }

  [[nodiscard]] Heights heights(const Cells& cells, const auto& pixels) const noexcept {
    Heights all;
    for (std::uint32_t row = cells.north; row <= cells.south + 1; ++row)
      for (std::uint32_t column = cells.west; column <= cells.east + 1; ++column) {
        const float height = pixels[grid_.index(column, row)];
        all.extend(height, height);
      }
    return all;
  }

  void visit(auto& walk, unsigned level, std::uint32_t column, std::uint32_t row) const noexcept {
    const Level& own = levels_[level];
    Box8<float> boxes;
    put_walls(boxes, walk, own, column, row);
    const unsigned taken =
        level == 1 ? walk.block.put(boxes, grid_, heights_, column, row) : put_nodes(boxes, level, column, row);
    std::array<float, 8> entries;
    const unsigned wide = own.wide(), tall = 3 - wide, turn = walk.turns[wide - 1];
    const unsigned met = walk.interval.inside(boxes, walk.limit, entries) & taken;
    for (unsigned open = turned(met, turn); open != 0; open &= open - 1) {
      const unsigned place = static_cast<unsigned>(std::countr_zero(open)) ^ turn;
      if (entries[place] > walk.limit) continue;
      const std::uint32_t c = (column << wide) + (place & ((1U << wide) - 1));
      const std::uint32_t r = (row << tall) + (place >> wide);
      level == 1 ? walk.take(*this, walk.block.cell(place, c, r)) : visit(walk, level - 1, c, r);
    }
    if (level == 1) walk.test();
  }

  /// Moves bit i of eight to position i ^ turn.
  static unsigned turned(unsigned bits, unsigned turn) noexcept {
    if ((turn & 1U) != 0) bits = (bits & 0x55U) << 1 | (bits >> 1 & 0x55U);
    if ((turn & 2U) != 0) bits = (bits & 0x33U) << 2 | (bits >> 2 & 0x33U);
    if ((turn & 4U) != 0) bits = (bits & 0x0FU) << 4 | bits >> 4;
    return bits;
  }

  void put_walls(Box8<float>& boxes, const auto& walk, const Level& own, std::uint32_t column,
                 std::uint32_t row) const noexcept {
    const float west = west_of(column << own.shift[0]) - walk.pad[0],
                north = north_of(row << own.shift[1]) + walk.pad[1];
    const float width = own.size[0] + 2 * walk.pad[0], height = own.size[1] + 2 * walk.pad[1];
    for (std::size_t i = 0; i < 8; i += simd::packet_size<float>) {
      const simd::Packet<float> x = simd::load<simd::Packet<float>>(own.east[i]) + west,
                                y = north - simd::load<simd::Packet<float>>(own.south[i]);
      simd::store(x, boxes.min[0][i]);
      simd::store(simd::Packet<float>(x + width), boxes.max[0][i]);
      simd::store(simd::Packet<float>(y - height), boxes.min[1][i]);
      simd::store(y, boxes.max[1][i]);
    }
  }

  /// Sets the heights of a node's children and returns the mask of those in the raster.
  unsigned put_nodes(Box8<float>& boxes, unsigned level, std::uint32_t column, std::uint32_t row) const noexcept {
    const Level &own = levels_[level], &below = levels_[level - 1];
    const float* heights = pyramid_.data() + own.node(column, row);
    std::memcpy(boxes.min[2], heights, sizeof boxes.min[2]);
    std::memcpy(boxes.max[2], heights + 8, sizeof boxes.max[2]);
    const std::uint32_t wide = own.wide(), tall = 3 - wide;
    const std::uint32_t columns = below.columns - (column << wide), rows = below.rows - (row << tall);
    unsigned taken = rows >= 1U << tall ? 0xFF : (1U << (rows << wide)) - 1;
    if (columns < 1U << wide) taken &= ((1U << columns) - 1) * (wide == 1 ? 0x55 : 0x11);  // each row
    return taken;
  }

  /// Walls of cells, relative to the centre [m].
  [[nodiscard]] float west_of(std::uint32_t column) const noexcept {
    return static_cast<float>((column - 0.5 * grid_.columns) * grid_.pixel.x);
  }
  [[nodiscard]] float north_of(std::uint32_t row) const noexcept {
    return static_cast<float>((0.5 * grid_.rows - row) * grid_.pixel.y);
  }

  detail::RasterGrid grid_;
  std::array<Level, detail::PyramidLayout::max_levels + 1> levels_{};
  std::uint32_t top_ = 0;
  Vec2 per_metre_{};  ///< pixels east per metre east, and pixels south per metre north
  Vec2 pad_{};        ///< error bound of walls in single precision [m]
  Vec3 centre_{};     ///< centre of the raster, at height 0, so that heights are exact
  Box bounds_;
  detail::PixelHeights heights_;
  SharedArray<float> pyramid_;
  detail::PackedNumbers materials_;  ///< of the pixels
};

}  // namespace PULSECAST_NAMESPACE

#endif
