// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/voxel_grid.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <pulsecast/scene/scene.hpp>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

static_assert(Geometry<VoxelGrid<OpaqueVoxels>> && Geometry<VoxelGrid<ScaledVoxels>>);
using namespace pulsecast::support;

static_assert(std::copyable<VoxelGrid<>>);

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// One cell, from (1, 2, 3) to (3, 4, 5).
VoxelData one_cell() { return {.corner = {-3, -2, -1}, .edge = 2, .cells = {{2, 2, 2}}}; }

/// All cells of a block.
VoxelData block(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, double edge, const Vec3& corner = {}) {
  VoxelData data{.corner = corner, .edge = edge};
  for (std::uint32_t z = 0; z < nz; ++z)
    for (std::uint32_t y = 0; y < ny; ++y)
      for (std::uint32_t x = 0; x < nx; ++x) data.cells.push_back({x, y, z});
  return data;
}

/// Different cells of a lattice of that size, in random order.
VoxelData scattered(Generator& random, std::size_t n, std::uint32_t size, double edge, const Vec3& corner) {
  VoxelData data{.corner = corner, .edge = edge};
  std::set<std::array<std::uint32_t, 3>> taken;
  while (taken.size() < n) {
    const auto one = [&] { return static_cast<std::uint32_t>(random.whole(size)); };
    const std::array<std::uint32_t, 3> cell{one(), one(), one()};
    if (taken.insert(cell).second) data.cells.push_back(cell);
  }
  return data;
}

template <class Grid>
ClosestHits met(const Grid& grid, const RayBundle& rays) {
  ClosestHits nearest(rays);
  grid.closest(rays, nearest);
  return nearest;
}

/// Range at which a single ray meets the grid; infinite if it does not.
template <class Grid>
double range(const Grid& grid, const Ray& ray) {
  const ClosestHits nearest = met(grid, bundle_of(ray));
  return nearest.met(0) ? nearest.range[0] : infinity;
}

template <class Grid>
Vec3 normal(const Grid& grid, const Ray& ray) {
  const RayBundle rays = bundle_of(ray);
  const ClosestHits nearest = met(grid, rays);
  return nearest.met(0) ? grid.surface(nearest.primitive_of(0), rays, 0).normal : Vec3{7};
}

/// The cube of an entry, by the definition of `VoxelData`.
Box cube(const VoxelData& data, std::size_t i) {
  const auto& c = data.cells[i];
  const double scale = data.scales.empty() ? 1.0 : static_cast<double>(data.scales[i]);
  Vec3 centre = Vec3(c[0], c[1], c[2]) + 0.5;
  if (!data.shifts.empty()) centre += Vec3(data.shifts[i][0], data.shifts[i][1], data.shifts[i][2]);
  return {data.corner + data.edge * (centre - scale / 2), data.corner + data.edge * (centre + scale / 2)};
}

/// Where a ray is inside a box: from `in` to `out`, if that is not before.
struct Inside {
  double in = -infinity, out = infinity;

  Inside(const Box& box, const Ray& ray) {
    for (int k = 0; k < 3; ++k) {
      const double low = box.min[k] - ray.origin[k], high = box.max[k] - ray.origin[k], d = ray.direction[k];
      if (d == 0) {
        if (low > 0 || high < 0) {
          in = infinity;
          out = -infinity;
        }
        continue;
      }
      in = std::max(in, (d > 0 ? low : high) / d);
      out = std::min(out, (d > 0 ? high : low) / d);
    }
  }
};

/// Between which ranges a ray meets the first of all cubes, each of which may be larger or smaller by next to nothing.
/// Every one is tested.
struct Between {
  double least = infinity, most = infinity;
};
Between every_cube(const VoxelData& data, const Ray& ray, double slack) {
  Between found;
  for (std::size_t i = 0; i < data.cells.size(); ++i) {
    const Box box = cube(data, i);
    const Inside larger({box.min - slack, box.max + slack}, ray), smaller({box.min + slack, box.max - slack}, ray);
    if (larger.in <= larger.out && larger.out > ray.near) {  // may be met
      const bool surely_around = smaller.in <= std::min(ray.near, smaller.out);
      const double at = larger.in > ray.near ? larger.in : surely_around ? std::max(smaller.out, ray.near) : ray.near;
      if (at <= ray.far) found.least = std::min(found.least, at);
    }
    if (smaller.in < smaller.out && smaller.out > ray.near) {  // must be met
      const double at = larger.in > ray.near ? smaller.in : larger.out;
      if (at <= ray.far) found.most = std::min(found.most, at);
    }
  }
  return found;
}

/// Rays into a grid, from anywhere, many of them along axes or through corners of cells.
RayBundle rays_for(Generator& random, const VoxelData& data, const Box& bounds) {
  const bool on_lattice = random.coin();
  const auto place = [&](double margin) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
      const double reach = margin * bounds.size()[k];
      p[k] = random.uniform(bounds.min[k] - reach, bounds.max[k] + reach);
      if (on_lattice) p[k] = data.corner[k] + data.edge * std::round((p[k] - data.corner[k]) / data.edge * 2) / 2;
    }
    return p;
  };
  RayBundle rays =
      random.cone(place(random.coin() ? 0 : 1), random.unit(), random.log_uniform(1e-4, 1), 1 + random.whole(64));
  for (std::size_t j = 0; j < rays.size; ++j) {
    Vec3 d = on_lattice ? place(0) - rays.origin : rays.direction(j);
    if (random.coin()) d = cube(data, random.whole(data.cells.size())).centre() - rays.origin;
    if (random.uniform() < 0.2) d[static_cast<int>(random.whole(3))] = 0;
    if (random.uniform() < 0.1) d = random.coin() ? Vec3{1, -1, 0} : Vec3{-1, 1, 1};
    if (length(d) > 0) rays.set_direction(j, normalize(d));
  }
  rays.near = random.coin() ? 0 : random.uniform(0, length(bounds.size()) / 3);
  if (random.uniform() < 0.3) rays.far = rays.near + random.uniform(0, length(bounds.size()));
  rays.pad();
  return rays;
}

template <class Filling>
void compare_with_every_cube(const VoxelData& data, std::uint64_t seed, int bundles) {
  CAPTURE(seed);
  const VoxelGrid<Filling> grid(data);
  Generator random(seed);
  const double slack = 1e-6 * data.edge + 4e-15 * (max_norm(grid.bounds().min) + max_norm(grid.bounds().max));
  std::size_t count = 0, wrong = 0;
  for (int b = 0; b < bundles; ++b) {
    const RayBundle rays = rays_for(random, data, grid.bounds());
    const ClosestHits nearest = met(grid, rays);
    for (std::size_t j = 0; j < rays.size; ++j) {
      const Between expected = every_cube(data, rays.ray(j), slack);
      const double found = nearest.met(j) ? nearest.range[j] : infinity;
      const double unsure = nearest.met(j) ? 1e-9 * (1 + found) : 0;
      count += nearest.met(j) ? 1 : 0;
      if (found >= expected.least - unsure && found <= expected.most + unsure && (!nearest.met(j) || found > rays.near))
        continue;
      if (++wrong > 3) continue;
      CAPTURE(b);
      CAPTURE(j);
      CAPTURE(rays.near);
      CAPTURE(expected.least);
      CHECK(found == expected.most);
    }
  }
  CHECK(wrong == 0);
  CHECK(count > static_cast<std::size_t>(bundles));
}

}  // namespace

TEST_CASE("a single cube is entered by its faces") {
  const VoxelGrid<> grid(one_cell());
  CHECK(grid.size() == 1);
  CHECK(grid.bounds() == Box{{1, 2, 3}, {3, 4, 5}});
  CHECK(grid.cell(0) == grid.bounds());
  for (int k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0}) {
      Vec3 out{};
      out[k] = side;
      const Ray ray{Vec3{2.1, 3.2, 4.3} + out * 10.0, -out};
      const double expected =
          10 + side * (Vec3{2.1, 3.2, 4.3}[k] - (side > 0 ? grid.bounds().max[k] : grid.bounds().min[k]));
      CHECK(range(grid, ray) == relative(expected, 1e-14));
      CHECK(normal(grid, ray) == out);
    }
  CHECK(range(grid, {{0, 1, 2}, normalize(Vec3{1, 1, 1})}) == relative(std::sqrt(3), 1e-14));
  CHECK(range(grid, {{0, 2.5, 3.5}, normalize(Vec3{2, 1, 0})}) == relative(std::sqrt(1.25), 1e-14));
  CHECK(range(grid, {{0, 3, 4}, -axis::right}) == infinity);
  CHECK(range(grid, {{0, 5, 4}, axis::right}) == infinity);
  CHECK(range(grid, {{0, 3, 4}, axis::right, 0, 0.99}) == infinity);
  CHECK(range(grid, {{0, 3, 4}, axis::right, 0, 1}) == 1);
}

TEST_CASE("a ray that begins inside a cube meets its far side") {
  const VoxelGrid<> grid(one_cell());
  CHECK(range(grid, {{2, 3, 4}, axis::right}) == 1);
  CHECK(normal(grid, {{2, 3, 4}, axis::right}) == -axis::right);
  CHECK(normal(grid, {{2.8, 2.1, 4}, normalize(Vec3{1, 0.5, 0})}) == -axis::right);  // though nearer to a face along y
  CHECK(range(grid, {{2, 3, 4}, -axis::up}) == 1);
  CHECK(range(grid, {{0, 3, 4}, axis::right, 1.5}) == 3);
  CHECK(range(grid, {{0, 3, 4}, axis::right, 1}) == 3);  // nothing is met at `near` itself
  CHECK(range(grid, {{0, 3, 4}, axis::right, 3}) == infinity);
  CHECK(range(grid, {{2, 3, 4}, axis::right, 0, 0.5}) == infinity);
  CHECK(range(grid, {{1, 3, 4}, axis::right}) == 2);
  CHECK(range(grid, {{3, 3, 4}, -axis::right}) == 2);
}

TEST_CASE("from inside a cube that has a neighbour, the neighbour is met where it begins") {
  VoxelData data = block(3, 1, 1, 1);
  data.materials = {0, 1, 2};
  const VoxelGrid<> grid(data);
  const RayBundle rays = bundle_of({{0.25, 0.5, 0.5}, axis::right});
  const ClosestHits nearest = met(grid, rays);
  CHECK(nearest.range[0] == 0.75);
  CHECK(grid.surface(nearest.primitive_of(0), rays, 0).material_index == 1);
  CHECK(!grid.surface(nearest.primitive_of(0), rays, 0).foliage);
  CHECK(grid.material_count() == 3);
  CHECK(range(grid, {{2.25, 0.5, 0.5}, axis::right}) == 0.75);
}

TEST_CASE("the ground below voxels that are no ground is found at its top") {
  VoxelData data = block(2, 2, 5, 1);
  data.cells.erase(data.cells.begin() + 8, data.cells.begin() + 12);  // a gap from z = 2 to 3
  for (const auto& cell : data.cells) data.materials.push_back(cell[2] < 1 ? 1 : 0);
  std::vector<Material> materials(2);
  materials[1].ground = true;
  const Scene<VoxelGrid<>> scene(
      {{.geometry = std::make_shared<const VoxelGrid<>>(data), .materials = material_table(materials)}});
  const auto height = scene.ground_height({0.5, 1.5});
  REQUIRE(height);
  CHECK(*height == relative(1, 1e-14));
  CHECK_FALSE(scene.ground_height({2.5, 1.5}));
}

TEST_CASE("incidence is by the voxel's normal, by the face, or perpendicular") {
  VoxelData data = block(2, 1, 1, 1);
  data.normals = {{0.6F, 0, 0.8F}, {0, 0, 0}};
  const Ray first{{0.5, 0.5, 9}, -axis::up}, second{{1.5, 0.5, 9}, -axis::up};
  const VoxelGrid<OpaqueVoxels> by_normal(data);
  CHECK(length(normal(by_normal, first) - Vec3{0.6, 0, 0.8}) < 1e-6);
  CHECK(normal(by_normal, second) == axis::up);
  const VoxelGrid<OpaqueVoxels> by_face(data, {.incidence = Incidence::face});
  CHECK(normal(by_face, first) == axis::up);
  CHECK(normal(by_face, {{9, 0.5, 0.5}, -axis::right}) == axis::right);
  const VoxelGrid<OpaqueVoxels> straight(data, {.incidence = Incidence::perpendicular});
  CHECK(normal(straight, first) == Vec3{});
  data.scales = {0.5F, 0.5F};
  CHECK(normal(VoxelGrid<ScaledVoxels>(data), first) == axis::up);
  CHECK(normal(VoxelGrid<ScaledVoxels>(data, {.incidence = Incidence::perpendicular}), first) == Vec3{});
}

TEST_CASE("normals are kept to a few millionths, and those along axes exactly") {
  Generator random(411);
  VoxelData data = block(1, 1, 1000, 1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 n = i < 3 ? Vec3{i == 0, i == 1, i == 2} * (i == 1 ? -1.0 : 1.0) : random.unit();
    data.normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
  }
  const VoxelGrid<> grid(data);
  for (std::size_t i = 0; i < 1000; ++i) {
    const Vec3 expected{data.normals[i][0], data.normals[i][1], data.normals[i][2]};
    const Vec3 found = normal(grid, {{-5, 0.5, static_cast<double>(i) + 0.5}, axis::right});
    CHECK(length(found - expected) < (i < 3 ? 1e-300 : 2e-6));
  }
}

TEST_CASE("a normal that is a little too long keeps its direction") {
  VoxelData data = one_cell();
  data.normals = {{0, 0, 1.0005F}};
  CHECK(normal(VoxelGrid<>(data), {{2, 3, 10}, -axis::up}) == axis::up);
}

TEST_CASE("a scaled cube is as large as it is said and where it is said") {
  VoxelData data{.corner = {10, 20, 30}, .edge = 2, .cells = {{1, 1, 1}}};
  data.scales = {0.5F};
  data.shifts = {{0.25F, -0.25F, 0}};
  const VoxelGrid<ScaledVoxels> grid(data);  // the cube goes from (13, 22, 32.5) to (14, 23, 33.5)
  CHECK(grid.bounds() == Box{{12, 22, 32}, {14, 24, 34}});
  CHECK(range(grid, {{13.5, 22.5, 40}, -axis::up}) == relative(6.5, 1e-6));
  CHECK(range(grid, {{0, 22.5, 33}, axis::right}) == relative(13, 1e-6));
  CHECK(range(grid, {{20, 22.5, 33}, -axis::right}) == relative(6, 1e-6));
  CHECK(range(grid, {{12.9, 22.5, 40}, -axis::up}) == infinity);
  CHECK(range(grid, {{13.5, 23.1, 40}, -axis::up}) == infinity);
  CHECK(range(grid, {{13.5, 22.5, 33}, axis::up}) == relative(0.5, 1e-5));
  CHECK(range(grid, {{12.5, 22.5, 33}, axis::right}) == relative(0.5, 1e-5));
  CHECK(normal(grid, {{12.5, 22.5, 33}, axis::right}) == -axis::right);
  data.shifts = {{-0.2500009F, 0.2500009F, 0}};  // as far as rounding of a file may go, and no farther than the cell
  CHECK(range(VoxelGrid<ScaledVoxels>(data), {{0, 23.5, 33}, axis::right}) == 12);
  CHECK(range(VoxelGrid<ScaledVoxels>(data), {{12.5, 30, 33}, -axis::forward}) == 6);
  data.scales = {1};
  data.shifts.clear();
  CHECK(range(VoxelGrid<ScaledVoxels>(data), {{13, 23, 40}, -axis::up}) == 6);
}

TEST_CASE("a grid is met as if every cube had been tested") {
  Generator random(412);
  for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{-7.5, 3, 11}, Vec3{567890.25, 5412345.5, 345.75}})
    for (const double edge : {1.0, 0.1}) {
      CAPTURE(corner.x);
      CAPTURE(edge);
      compare_with_every_cube<OpaqueVoxels>(scattered(random, 3, 3, edge, corner), 413, 100);
      compare_with_every_cube<OpaqueVoxels>(scattered(random, 200, 12, edge, corner), 414, 60);
      compare_with_every_cube<OpaqueVoxels>(scattered(random, 400, 70, edge, corner), 415, 60);
      compare_with_every_cube<OpaqueVoxels>(scattered(random, 1500, 200, edge, corner), 416, 100);
      VoxelData scaled = scattered(random, 300, 30, edge, corner);
      for (std::size_t i = 0; i < scaled.cells.size(); ++i) {
        const double scale = random.uniform(0.1, 1), room = (1 - scale) / 2;
        const auto shift = [&] { return static_cast<float>(random.uniform(-room, room)); };
        scaled.scales.push_back(static_cast<float>(scale));
        scaled.shifts.push_back({shift(), shift(), shift()});
      }
      compare_with_every_cube<ScaledVoxels>(scaled, 417, 60);
    }
}

TEST_CASE("a bundle finds what its rays find alone") {
  Generator random(418);
  const VoxelData data = scattered(random, 2000, 40, 0.25, {1000, -2000, 3});
  const VoxelGrid<> grid(data);
  for (int b = 0; b < 200; ++b) {
    const RayBundle rays = rays_for(random, data, grid.bounds());
    const ClosestHits nearest = met(grid, rays);
    for (std::size_t j = 0; j < rays.size; ++j) {
      const ClosestHits alone = met(grid, bundle_of(rays.ray(j)));
      CHECK(alone.range[0] == nearest.range[j]);
      CHECK(alone.id[0] == nearest.id[j]);
    }
  }
}

TEST_CASE("what was met before is beaten only by what is nearer, or as near and of a smaller number") {
  const VoxelGrid<> grid(one_cell());
  const RayBundle rays = bundle_of({{0, 3, 4}, axis::right});
  for (const double before : {0.5, 1.0, 1.5}) {
    ClosestHits nearest(rays);
    nearest.part = std::uint64_t{1} << 32;
    nearest.offer(0, before, 5);
    nearest.part = 0;
    grid.closest(rays, nearest);
    CHECK(nearest.part_of(0) == (before < 1 ? 1 : 0));
    CHECK(nearest.range[0] == std::min(before, 1.0));
  }
}

TEST_CASE("through the edges and corners of a closed wall nothing escapes") {
  for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{567890, 5412345, 345}, Vec3{0.1, 0.7, -0.3}})
    for (const std::uint32_t size : {5U, 21U}) {
      VoxelData data = block(size, size, size, 1, corner);
      std::erase_if(data.cells, [&](const auto& c) {
        return std::all_of(c.begin(), c.end(), [&](std::uint32_t x) { return x > 0 && x < size - 1; });
      });
      const VoxelGrid<> grid(data);
      std::size_t escaped = 0;
      const int reach = 4;
      for (int origin = 0; origin < 8; ++origin) {
        RayBundle rays;
        rays.origin = corner + Vec3{1.0 + (origin & 1), 2.0 + (origin >> 1 & 1) * 0.5, 2.0 + (origin >> 2) * 0.5};
        for (int x = -reach; x <= reach; ++x)
          for (int y = -reach; y <= reach; ++y) {
            rays.size = 0;
            for (int z = -reach; z <= reach; ++z)
              if (x != 0 || y != 0 || z != 0) rays.set_direction(rays.size++, normalize(Vec3{x, y, z}));
            rays.pad();
            const ClosestHits nearest = met(grid, rays);
            for (std::size_t j = 0; j < rays.size; ++j) escaped += nearest.met(j) ? 0 : 1;
          }
      }
      CAPTURE(size);
      CAPTURE(corner.x);
      CHECK(escaped == 0);
    }
}

TEST_CASE("rays between cells of a block, along its planes and edges, meet it where it begins") {
  for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{567890, 5412345, 345}}) {
    const VoxelGrid<> grid(block(9, 9, 9, 1, corner));
    for (int i = 0; i < 9; ++i)
      for (int j = 0; j < 9; ++j) {
        CHECK(range(grid, {corner + Vec3{i, j, 20}, -axis::up}) == 11);
        CHECK(range(grid, {corner + Vec3{i, -4, j + 0.5}, axis::forward}) == 4);
        CHECK(range(grid, {corner + Vec3{14, i, j}, -axis::right}) == 5);
        if (i < 8 && j > 0)
          CHECK(range(grid, {corner + Vec3{i - 1.0, j, -1}, normalize(Vec3{1, 0, 1})}) == relative(std::sqrt(2), 1e-9));
      }
  }
}

TEST_CASE(
    "rays of no number, without direction or without range meet nothing, and their neighbours are not disturbed") {
  const VoxelGrid<> grid(block(5, 5, 5, 1));
  const double nan = std::nan("");
  RayBundle rays;
  rays.origin = {2.5, 2.5, 9};
  rays.size = 7;
  const Vec3 directions[] = {-axis::up,       {nan, 0, -1},   {0, 0, 0},   {0, 0, -infinity},
                             {nan, nan, nan}, {0, 1e-320, 0}, {0, 0, -0.5}};
  for (std::size_t j = 0; j < rays.size; ++j) rays.set_direction(j, directions[j]);
  rays.pad();
  const ClosestHits nearest = met(grid, rays);
  for (std::size_t j = 1; j < 6; ++j) CHECK_FALSE(nearest.met(j));
  CHECK(nearest.range[0] == 4);
  CHECK(nearest.range[6] == 8);
  CHECK(range(grid, {{nan, 2, 9}, -axis::up}) == infinity);
  CHECK(range(grid, {{2, 2, infinity}, -axis::up}) == infinity);
  CHECK(range(grid, {{2.5, 2.5, 2.5}, {1e-320, 0, 0}}) == infinity);
  CHECK(range(grid, {{2.5, 2.5, 9}, -axis::up, infinity}) == infinity);
  CHECK(range(grid, {{2.5, 2.5, 9}, -axis::up, 5, 4}) == infinity);
  CHECK(range(grid, {{2.5, 2.5, 1e9}, -axis::up}) == relative(1e9 - 5, 1e-15));
}

TEST_CASE("cells that are the same, or too far apart, are refused") {
  const auto refusal = [](const VoxelData& data) -> std::string {
    try {
      const VoxelGrid<> grid(data);
      return {};
    } catch (const SettingError& error) {
      return error.what();
    }
  };
  VoxelData data{.cells = {{0, 0, 0}, {7, 0, 0}, {0, 0, 0}}};
  CHECK(refusal(data) == "VoxelData::cells is 2, but must be unique; this entry repeats entry 0");
  data.cells[2] = {2097152, 0, 0};
  CHECK(refusal(data).find("within 2097152 cells of each other") != std::string::npos);
  data.cells[2] = {2097151, 0, 0};
  CHECK(refusal(data) == "");
  data.edge = -1;
  CHECK(refusal(data).find("VoxelData::edge") == 0);
}

TEST_CASE("fillings ask for the columns that they need") {
  const VoxelData data = one_cell();
  CHECK_THROWS_AS(VoxelGrid<ScaledVoxels>{data}, SettingError);
  CHECK_THROWS_AS(VoxelGrid<TransmissiveVoxels>{data}, SettingError);
}

TEST_CASE("no grid takes more than 40 bytes a voxel") {
  Generator random(419);
  const auto check = [&](VoxelData data) {
    const std::size_t n = data.cells.size();
    CAPTURE(n);
    for (std::size_t i = 0; i < n; ++i) {
      data.normals.push_back({0, 0, 1});
      data.densities.push_back(1);
      data.scales.push_back(0.5F);
      data.shifts.push_back({0, 0.1F, 0});
      data.materials.push_back(1);
    }
    CHECK(VoxelGrid<OpaqueVoxels>(data).memory() <= 40 * n + 16);
    CHECK(VoxelGrid<ScaledVoxels>(data).memory() <= 40 * n + 16);
    CHECK(VoxelGrid<TransmissiveVoxels>(data).memory() <= 40 * n + 16);
  };
  for (const std::uint32_t size : {10U, 20U, 40U, 100U, 400U, 5000U, 2097152U})
    for (const std::size_t n : {std::size_t{1}, std::size_t{2}, std::size_t{17}, std::size_t{900}, std::size_t{20000}})
      if (n < std::size_t{size} * size * size / 2) check(scattered(random, n, size, 1, {}));
  check(block(32, 32, 32, 1));
  check(block(300, 300, 1, 1));
  VoxelData apart;  // one a brick, one a block
  for (std::uint32_t i = 0; i < 20; ++i)
    for (std::uint32_t j = 0; j < 20; ++j) {
      apart.cells.push_back({4 * i, 4 * j, 0});
      apart.cells.push_back({16 * i, 16 * j, 100});
    }
  check(apart);
}

// ----------------------------------------------------------------------------- transmissive voxels

namespace {

/// A slab of leaves, 12 m by 12 m by 1 m below z = 1, of voxels that are 1/n metres long.
VoxelData slab(std::uint32_t n, double density) {
  VoxelData data = block(12 * n, 12 * n, n, 1.0 / n, {-6, -6, 0});
  data.densities.assign(data.cells.size(), static_cast<float>(density));
  return data;
}

struct NamedLeaves {
  const char* name;
  LeafAngles leaves;
};

std::vector<NamedLeaves> all_leaves() {
  std::vector<LeafProjection> table;
  for (int i = 0; i <= 18; ++i) table.push_back({i * pi / 36, 0.2 + 0.03 * i});
  return {{"spherical", LeafAngles::spherical()},        {"uniform", LeafAngles::uniform()},
          {"planophile", LeafAngles::planophile()},      {"erectophile", LeafAngles::erectophile()},
          {"plagiophile", LeafAngles::plagiophile()},    {"extremophile", LeafAngles::extremophile()},
          {"ellipsoidal", LeafAngles::ellipsoidal(2.5)}, {"table", LeafAngles::table(table)}};
}

/// Downwards at an angle from the vertical.
Vec3 downwards(double zenith) { return rotation_about(axis::up, 0.4) * Vec3{std::sin(zenith), 0, -std::cos(zenith)}; }

constexpr double five_zeniths[] = {0.0, 0.35, 0.7, 1.05, 1.3};

/// Share of n subrays, 50 a pulse, along one direction that meet nothing.
template <class Target>
double share_that_passes(const Target& target, const Ray& ray, std::size_t n, std::uint64_t seed) {
  RayBundle rays;
  rays.origin = ray.origin;
  rays.near = ray.near;
  rays.far = ray.far;
  rays.size = 50;
  rays.seed = seed;
  for (std::size_t j = 0; j < rays.size; ++j) rays.set_direction(j, ray.direction);
  rays.pad();
  std::size_t passed = 0;
  for (rays.pulse = 0; rays.pulse < n / rays.size; ++rays.pulse) {
    if constexpr (BundleTarget<Target>) {
      std::array<Hit, 50> hits;
      target.closest(rays, hits);
      for (const Hit& hit : hits) passed += hit.range < infinity ? 0 : 1;
    } else {
      const ClosestHits nearest = met(target, rays);
      for (std::size_t j = 0; j < rays.size; ++j) passed += nearest.met(j) ? 0 : 1;
    }
  }
  return static_cast<double>(passed) / static_cast<double>(n);
}

/// How many standard errors of n draws a share is away from what it should be.
double errors(double share, double expected, std::size_t n) {
  return std::fabs(share - expected) / std::sqrt(expected * (1 - expected) / static_cast<double>(n));
}

}  // namespace

TEST_CASE(
    "a slab of leaves lets through what Beer and Lambert say: a million rays for each distribution and direction") {
  const double density = 1.5;
  const std::size_t n = 1'000'000;
  std::uint64_t seed = 10'000;  // each case draws for itself
  for (const NamedLeaves& named : all_leaves()) {
    CAPTURE(named.name);
    const VoxelGrid<TransmissiveVoxels> grid(slab(2, density), {.leaf_angles = named.leaves});
    for (const double zenith : five_zeniths) {
      CAPTURE(zenith);
      const Vec3 direction = downwards(zenith);
      const double expected = std::exp(-named.leaves.projection(direction) * density / std::cos(zenith));
      CHECK(errors(share_that_passes(grid, {{0.1, 0.2, 1.5}, direction}, n, ++seed), expected, n) < 3);
    }
  }
}

TEST_CASE("so it does for voxels of any size, and for a scanner that stands inside") {
  const double density = 2;
  const std::size_t n = 16'000;  // in 480 cases, of which one or so is beyond three standard errors
  std::uint64_t seed = 30'000;
  for (const std::uint32_t size : {1U, 3U, 10U}) {
    CAPTURE(size);
    for (const NamedLeaves& named : all_leaves()) {
      CAPTURE(named.name);
      const VoxelGrid<TransmissiveVoxels> grid(slab(size, density), {.leaf_angles = named.leaves});
      for (const double zenith : five_zeniths) {
        CAPTURE(zenith);
        const Vec3 direction = downwards(zenith);
        const double per_metre = named.leaves.projection(direction) * density, slanted = 1 / std::cos(zenith);
        const Ray above{{0.1, 0.2, 1.5}, direction}, inside{{0.1, 0.2, 0.6}, direction};
        const Ray late{above.origin, direction, 0.9 * slanted}, upwards{inside.origin, -direction};
        CHECK(errors(share_that_passes(grid, above, n, ++seed), std::exp(-per_metre * slanted), n) < 4);
        CHECK(errors(share_that_passes(grid, inside, n, ++seed), std::exp(-per_metre * 0.6 * slanted), n) < 4);
        CHECK(errors(share_that_passes(grid, upwards, n, ++seed), std::exp(-per_metre * 0.4 * slanted), n) < 4);
        CHECK(errors(share_that_passes(grid, late, n, ++seed), std::exp(-per_metre * 0.6 * slanted), n) < 4);
      }
    }
  }
}

TEST_CASE("leaves are met at depths of an exponential distribution, and at the same ones whatever the size of voxels") {
  const double density = 1.5;
  const Vec3 direction = downwards(0.5);
  const VoxelGrid<TransmissiveVoxels> coarse(slab(1, density)), fine(slab(9, density));
  std::vector<double> depths;
  double apart = 0;
  for (PulseIndex pulse = 0; pulse < 40'000; ++pulse) {
    RayBundle rays = bundle_of({{0, 0, 2}, direction});
    rays.pulse = pulse;
    rays.seed = 426;
    const ClosestHits one = met(coarse, rays), other = met(fine, rays);
    REQUIRE(one.met(0) == other.met(0));
    if (!one.met(0)) continue;
    apart = std::max(apart, std::fabs(one.range[0] - other.range[0]));
    depths.push_back(one.range[0] - 1 / std::cos(0.5));
    CHECK(fine.cell(other.primitive_of(0)).min.z <= rays.origin.z + other.range[0] * direction.z + 1e-9);
    CHECK(fine.cell(other.primitive_of(0)).max.z >= rays.origin.z + other.range[0] * direction.z - 1e-9);
  }
  CHECK(apart < 1e-9);
  std::sort(depths.begin(), depths.end());
  const double whole = 1 - std::exp(-0.5 * density / std::cos(0.5)), n = static_cast<double>(depths.size());
  double distance = 0;  // of Kolmogorov and Smirnov
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double expected = (1 - std::exp(-0.5 * density * depths[i])) / whole;
    distance = std::max({distance, std::fabs(expected - static_cast<double>(i) / n),
                         std::fabs(expected - static_cast<double>(i + 1) / n)});
  }
  CHECK(distance * std::sqrt(n) < 1.63);  // 1 %
}

TEST_CASE("through voxels of different densities, and gaps, the depths add up") {
  VoxelData data = slab(5, 0);
  const float densities[] = {3, 0, 0.5F, 2, 0};
  for (std::size_t i = 0; i < data.cells.size(); ++i) data.densities[i] = densities[data.cells[i][2]];
  std::erase_if(data.densities, [](float d) { return d == 0.5F; });
  std::erase_if(data.cells, [](const auto& cell) { return cell[2] == 2; });
  const VoxelGrid<TransmissiveVoxels> grid(data);
  const std::size_t n = 200'000;
  const double slanted = 1 / std::cos(0.8);
  CHECK(errors(share_that_passes(grid, {{0, 0, 3}, downwards(0.8)}, n, 427), std::exp(-0.5 * 5 * 0.2 * slanted), n) <
        3);
  data.densities.assign(data.cells.size(), 0);
  CHECK(share_that_passes(VoxelGrid<TransmissiveVoxels>(data), {{0, 0, 3}, -axis::up}, 1000, 427) == 1);
}

TEST_CASE(
    "plants behind each other draw for themselves; each keeps its gaps when it is scaled, and its vertical when it is "
    "turned") {
  using Woods = Scene<VoxelGrid<TransmissiveVoxels>>;
  const double density = 1;
  const LeafAngles leaves = LeafAngles::planophile();
  const auto plant =
      std::make_shared<const VoxelGrid<TransmissiveVoxels>>(slab(2, density), TransmissiveVoxels{leaves});
  const std::size_t n = 200'000;
  const double zenith = 0.6, one = std::exp(-leaves.projection(downwards(zenith)) * density / std::cos(zenith));
  const Ray ray{{0, 0, 40}, downwards(zenith)};
  const Vec3 along = ray.direction / -ray.direction.z;
  const auto at = [&](double z, double scale = 1, const Rotation& turned = no_rotation) {
    const Vec3 foot = ray.origin + along * (40 - z);
    return Woods::Part{.geometry = plant, .placement = {.rotation = turned, .scale = scale, .translation = foot}};
  };
  CHECK(errors(share_that_passes(Woods({at(0)}), ray, n, 428), one, n) < 3);
  CHECK(errors(share_that_passes(Woods({at(0), at(5)}), ray, n, 429), one * one, n) < 3);
  CHECK(errors(share_that_passes(Woods({at(0), at(5), at(10)}), ray, n, 430), one * one * one, n) < 3);
  CHECK(errors(share_that_passes(Woods({at(0, 4)}), ray, n, 431), one, n) < 3);
  // leaning so that the beam comes along its own vertical
  const Rotation lean = rotation_about(cross(axis::up, -ray.direction), zenith);
  CHECK(errors(share_that_passes(Woods({at(0, 1, lean)}), ray, n, 432),
               std::exp(-leaves.projection(axis::up) * density), n) < 3);
}

TEST_CASE("no leaf is met at `near` itself, however dense they are") {
  const VoxelGrid<TransmissiveVoxels> grid(slab(1, 1e30));
  for (const double near : {0.0, 0.25, 0.75}) {
    const double found = range(grid, {{0, 0, 1.5}, -axis::up, near});
    CHECK(found > near);
    CHECK(found == relative(std::max(near, 0.5), 1e-15));
  }
  CHECK(range(grid, {{0, 0, 0.5}, -axis::up}) > 0);
  CHECK(range(grid, {{0, 0, 1.5}, -axis::up, 0, 0.4}) == infinity);
}

TEST_CASE(
    "a subray draws the same whatever bundle it comes in, and leaves are tilted against it by their mean, or not at "
    "all") {
  const VoxelGrid<TransmissiveVoxels> grid(slab(3, 1)), flat(slab(3, 1), TransmissiveVoxels{.tilted_leaves = false});
  Generator random(433);
  RayBundle rays = random.cone({0, 0, 4}, -axis::up, 0.2, 40);
  rays.seed = 434;
  rays.pulse = 435;
  rays.first_subray = 7;
  const ClosestHits all = met(grid, rays);
  for (std::size_t j = 0; j < rays.size; ++j) {
    RayBundle alone = bundle_of(rays.ray(j));
    alone.seed = rays.seed;
    alone.pulse = rays.pulse;
    alone.first_subray = 7 + static_cast<std::uint32_t>(j);
    CHECK(met(grid, alone).range[0] == all.range[j]);
    if (!all.met(j)) continue;
    const Vec3 normal = grid.surface(all.primitive_of(j), rays, j).normal;
    CHECK(std::fabs(length(normal) - 1) < 1e-14);
    CHECK(std::fabs(dot(normal, normalize(rays.direction(j))) + 2.0 / 3) < 1e-9);
    CHECK(flat.surface(all.primitive_of(j), rays, j).normal == Vec3{});
  }
}
