// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// How much there is to be met: nothing, one triangle, or more than numbers of 32 bits can count.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <doctest/doctest.h>

#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/height_field.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "extremes/meshes.hpp"
#include "extremes/row.hpp"
#include "support/generators.hpp"
#include "support/scenes.hpp"
#include "validation/one_pulse.hpp"

using namespace pulsecast;
using namespace pulsecast::extremes;
using namespace pulsecast::support;

namespace {

const std::string quantity = "scene";
constexpr double infinity = std::numeric_limits<double>::infinity();

template <Geometry G>
std::size_t met_in(const G& shape, const RayBundle& rays) {
  ClosestHits nearest(rays);
  shape.closest(rays, nearest);
  std::size_t met = 0;
  for (std::size_t j = 0; j < rays.size; ++j) met += nearest.met(j) ? 1 : 0;
  return met;
}

}  // namespace

TEST_CASE("a scene without parts, and shapes without primitives, are met nowhere") {
  Generator random(8500);
  const Scene<TriangleMesh<>, HeightField, VoxelGrid<>> none({});
  const MovingScene<TriangleMesh<>> none_moves({}, MovingIndexSettings{});
  const std::vector<Box> no_boxes, empty_boxes(5);
  Raster missing{.columns = 9, .rows = 9};
  missing.heights.assign(81, std::numeric_limits<float>::quiet_NaN());
  const HeightField hole(missing);
  std::size_t met = 0;
  for (int time = 0; time < 100; ++time) {
    const RayBundle rays = random.cone(random.point(10), random.unit(), 1, 19);
    std::array<Hit, 19> hits;
    none.closest(rays, hits);
    for (const Hit& hit : hits) met += hit.range < infinity ? 1 : 0;
    none_moves.closest(rays, hits);
    for (const Hit& hit : hits) met += hit.range < infinity ? 1 : 0;
    met += met_in(hole, rays);
    for (const std::vector<Box>& boxes : {no_boxes, empty_boxes}) {
      ClosestHits nearest(rays);
      const auto test = [&](std::span<const PrimitiveIndex> some) { met += some.size(); };
      Linear<float>(boxes).closest(rays, test, nearest);
      Linear<double>(boxes).closest(rays, test, nearest);
      Bvh<float>(boxes).closest(rays, test, nearest);
      Bvh<double>(boxes).closest(rays, test, nearest);
      KdTree<float>(boxes).closest(rays, test, nearest);
      KdTree<double>(boxes).closest(rays, test, nearest);
    }
  }
  CHECK(none.bounds().empty());
  CHECK_FALSE(none.ground_height({0, 0}));
  row(quantity, "no part, no box, no pixel: rays that meet something, of 1900", 0, static_cast<double>(met), 0);
  const validation::Result pulse = validation::one_pulse(none, SunflowerFootprint(19));
  CHECK(pulse.echoes.empty());
  row(quantity, "no part: share of a pulse that misses", 1, pulse.energy.share(&EnergyLedger::missed), 1e-12);
}

TEST_CASE("a scene of one triangle") {
  const MeshData data{{{-1, 5, -1}, {1, 5, -1}, {0, 5, 1}}, {{0, 1, 2}}, {}};
  const Meshes meshes(data);
  Generator random(8510);
  Verdict verdict;
  Comparison others;
  for (int time = 0; time < 200; ++time) {
    const RayBundle rays = random.cone(random.point(1), normalize(axis::forward + random.point(0.3)), 0.2, 8);
    judge(meshes.linear, data, rays, verdict);
    meshes.compare(rays, others);
  }
  check(verdict, others);
  CHECK(verdict.met < verdict.rays);
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(data)}});
  row(quantity, "one triangle: range of a pulse at it [m]", 5,
      validation::one_pulse(scene, SingleRay{}).echoes.at(0).range, 1e-9);
  refused_as(quantity, "mesh of no triangle", "at least one in number", [] {
    return TriangleMesh<>(MeshData{{{0, 0, 0}}, {}, {}});
  });
}

TEST_CASE("more primitives than can be counted are refused before memory is asked for") {
  const Box box{{0, 0, 0}, {1, 1, 1}};
  const std::span<const Box> many(&box,
                                  std::size_t{4294967295});  // refused by their number: none but the first is there
  refused_as(quantity, "2^32 - 1 boxes, Bvh<float>", "in number", [&] { return Bvh<float>(many); });
  refused_as(quantity, "2^32 - 1 boxes, Bvh<double>", "in number", [&] { return Bvh<double>(many); });
  refused_as(quantity, "2^32 - 1 boxes, KdTree<float>", "in number", [&] { return KdTree<float>(many); });
  refused_as(quantity, "2^32 - 1 boxes, KdTree<double>", "in number", [&] { return KdTree<double>(many); });
  refused_as(quantity, "2^32 - 1 boxes, Linear", "in number", [&] { return Linear<float>(many); });
  const auto counts = [](std::size_t vertices, std::size_t triangles) {
    MeshData::validate_counts(vertices, triangles);
    return true;
  };
  CHECK_NOTHROW(static_cast<void>(counts(4294967295, 4294967294)));  // 2^31 + 1 triangles are served
  refused_as(quantity, "mesh of 2^32 - 1 triangles", "MeshData::triangles (number)",
             [&] { return counts(3, 4294967295); });
  refused_as(quantity, "mesh of 2^32 vertices", "MeshData::vertices (number)", [&] { return counts(4294967296, 1); });
  refused_as(quantity, "raster of 65537 x 32769 pixels, 2^31 cells", "cells between them",
             [] { return HeightField({.columns = 65537, .rows = 32769}); });
  refused_as(quantity, "raster of 65536 x 65536 pixels", "cells between them",
             [] { return HeightField({.columns = 65536, .rows = 65536}); });
  refused_as(quantity, "raster of 2^32 - 1 columns", "Raster::columns is",
             [] { return HeightField({.columns = 4294967295, .rows = 2}); });
  refused_as(quantity, "voxels 2^21 cells apart", "within 2097152 cells", [] {
    return VoxelGrid<>({.cells = {{0, 0, 0}, {0, 0, 1U << 21}}});
  });
}

TEST_CASE("a lattice of 9e18 cells, of which the outermost are there, is served") {
  constexpr std::uint32_t last = VoxelIndex::longest - 1;
  VoxelData data{.corner = {-1e6, -1e6, -1e6}};
  for (std::uint32_t i = 0; i < 8; ++i) data.cells.push_back({i & 1 ? last : 0, i & 2 ? last : 0, i & 4 ? last : 0});
  const VoxelGrid<> grid(data);
  std::size_t wrong = 0;
  for (int k = 0; k < 3; ++k)
    for (std::uint32_t i = 0; i < 8; ++i) {
      // from the outside of each corner, along each quantity that leads out of the other end, past what is in the first
      // cell or into it
      Vec3 cell{data.cells[i][0], data.cells[i][1], data.cells[i][2]}, way{};
      const bool low = cell[k] == 0;
      way[k] = low ? 1 : -1;
      const Vec3 centre = data.corner + cell + Vec3(0.5);
      const RayBundle before = bundle_of({centre - way * 10.0, way}), after = bundle_of({centre + way * 10.0, way});
      ClosestHits first(before), second(after);
      grid.closest(before, first);
      grid.closest(after, second);
      wrong += first.met(0) && first.range[0] == 9.5 ? 0 : 1;
      wrong += second.met(0) && second.range[0] == last - 10.5 ? 0 : 1;
    }
  row(quantity,
      "voxels in the corners of a lattice of 2^63 cells: rays along its edges that do not meet them where they are, of "
      "48",
      0, static_cast<double>(wrong), 0);
}

#if defined(__linux__)

namespace {

/// Fills a height field as one that was kept in a file is filled: flat ground of one material at height 0, on pages
/// that nobody ever wrote to.
struct FlatGround {
  std::uint32_t columns, rows;
  std::shared_ptr<const void> zeros;
  std::size_t size;  ///< of the zeros [byte]

  void operator()(pulsecast::detail::RasterGrid& grid, auto& levels, std::uint32_t& top, Vec2& per_metre, Vec2& pad,
                  Vec3& centre, Box& bounds, pulsecast::detail::PixelHeights& heights, SharedArray<float>& pyramid,
                  pulsecast::detail::PackedNumbers&) const {
    grid = {.columns = columns, .rows = rows};
    per_metre = {1, -1};
    pad = Vec2(1e-6 * columns);
    centre = {0.5 * columns, -0.5 * rows, 0};
    bounds = {{0, 1.0 - rows, 0}, {columns - 1.0, 0, 0}};
    levels[0].columns = columns - 1;
    levels[0].rows = rows - 1;
    std::size_t floats = 0;
    for (top = 0; top == 0 || levels[top].columns > 1 || levels[top].rows > 1;) {
      const auto& below = levels[top];
      auto& level = levels[++top];
      const std::uint32_t wide = top % 2 == 1 ? 2 : 1, tall = 3 - wide;
      level.columns = ((below.columns - 1) >> wide) + 1;
      level.rows = ((below.rows - 1) >> tall) + 1;
      level.begin = floats;
      level.below = below.shift;
      level.shift = {below.shift[0] + wide, below.shift[1] + tall};
      level.size = {static_cast<float>(1U << below.shift[0]), static_cast<float>(1U << below.shift[1])};
      for (std::uint32_t i = 0; i < 8; ++i) {
        level.east[i] = static_cast<float>((i & ((1U << wide) - 1)) << below.shift[0]);
        level.south[i] = static_cast<float>(i >> wide << below.shift[1]);
      }
      if (top > 1) floats += std::size_t{level.columns} * level.rows * 16;
    }
    const auto of = [&](std::size_t count) {
      REQUIRE(count * sizeof(float) <= size);
      return SharedArray<float>({static_cast<const float*>(zeros.get()), count}, zeros);
    };
    const auto set = [&](SharedArray<float>& all, SharedArray<std::uint16_t>&) {
      all = of(std::size_t{columns} * rows);
    };
    heights.archive(set);
    pyramid = of(floats);
  }
};

}  // namespace

TEST_CASE("ground of nearly 2^32 triangles is served") {
  constexpr std::uint32_t side = 46341;  // pixels
  constexpr std::size_t size = std::size_t{side} * side * sizeof(float);
  void* const memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  REQUIRE(memory != MAP_FAILED);
  HeightField field(DeserializeTag{});
  FlatGround flat{side, side, {memory, [](void* m) { ::munmap(m, size); }}, size};
  field.archive(flat);
  REQUIRE(field.is_consistent());
  Generator random(8530);
  std::size_t wrong = 0;
  for (int time = 0; time < 2000; ++time) {
    // anywhere, and in the last cells of all
    const auto place = [&] {
      return static_cast<std::uint32_t>(random.coin() ? random.whole(side - 1) : side - 2 - random.whole(3));
    };
    const std::uint32_t column = place(), row = place(), half = random.coin() ? 1 : 0;
    const Vec2 inside = half == 0 ? Vec2{0.25, 0.25} : Vec2{0.75, 0.75};
    const RayBundle rays =
        bundle_of({{column + inside.x, -(row + inside.y), 7}, normalize(Vec3{0.01, -0.01, -1} * random.uniform())});
    const double range = 7 / -rays.z[0];
    const Vec2 at{rays.origin.x + range * rays.x[0], -(rays.origin.y + range * rays.y[0])};
    const auto c = static_cast<std::uint32_t>(at.x), r = static_cast<std::uint32_t>(at.y);
    const std::uint32_t expected = 2 * (r * (side - 1) + c) + (at.x - c + (at.y - r) > 1 ? 1 : 0);
    ClosestHits nearest(rays);
    field.closest(rays, nearest);
    wrong +=
        nearest.met(0) && std::fabs(nearest.range[0] - range) < 1e-9 && nearest.primitive_of(0) == expected ? 0 : 1;
    const Triangle t = field.triangle(expected);
    const Vec3& south_west = expected % 2 == 0 ? t.b : t.a;
    wrong += south_west.x == c && south_west.y == -1.0 - r ? 0 : 1;
  }
  CHECK(2 * std::uint64_t{side - 1} * (side - 1) > (std::uint64_t{1} << 31) + 1);
  row(quantity, "raster of 46341 x 46341 pixels, 4,294,791,200 triangles: rays that do not meet theirs, of 2000", 0,
      static_cast<double>(wrong), 0);
}

#endif
