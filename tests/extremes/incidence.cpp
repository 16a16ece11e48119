// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// How a ray meets a surface: from straight down to all but along it, in its plane, at its edges and corners, along the
// borders of cells.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/height_field.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "extremes/meshes.hpp"
#include "extremes/row.hpp"
#include "support/double_double.hpp"
#include "support/generators.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using namespace pulsecast::extremes;
using namespace pulsecast::support;

namespace {

const std::string quantity = "incidence";
const std::vector<std::string> angles{"0", "60", "89", "89.99", "89.9999"};

double radians(const std::string& degrees) { return std::stod(degrees) * pi / 180; }

template <Geometry G>
double range_of(const G& shape, const RayBundle& rays) {
  ClosestHits nearest(rays);
  shape.closest(rays, nearest);
  return nearest.met(0) ? nearest.range[0] : -1;
}

}  // namespace

TEST_CASE("a plane at any incidence") {
  double worst_cosine = 0;
  for (const std::string& angle : angles) {
    const std::uint64_t seed = 8400;
    CAPTURE(angle);
    CAPTURE(seed);
    Generator random(seed);
    const double slant = radians(angle);
    double worst = 0;
    std::size_t wrong = 0;
    Comparison others;
    for (int time = 0; time < 100; ++time) {
      // a square of 2 m in any attitude, met near its middle from 1 m away
      const Rotation turn = random.rotation();
      const Vec3 u = turn * axis::right, v = turn * axis::forward, n = turn * axis::up, middle = random.point(10);
      const MeshData data{{middle - u - v, middle + u - v, middle + u + v, middle - u + v}, {{0, 1, 2}, {0, 2, 3}}, {}};
      const Vec3 aim = middle + u * random.uniform(-0.1, 0.1) + v * random.uniform(-0.1, 0.1);
      const double turned = random.uniform(0, 2 * pi);
      const Vec3 from = n * std::cos(slant) + (u * std::cos(turned) + v * std::sin(turned)) * std::sin(slant);
      const RayBundle rays = bundle_of({aim + from, -from});
      const Meshes meshes(data);
      Verdict verdict;
      judge(meshes.linear, data, rays, verdict);
      meshes.compare(rays, others);
      wrong += verdict.wrong + (verdict.met == 1 ? 0 : 1);
      worst = std::max(worst, verdict.worst);
      const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(data)}});
      Hit hit;
      scene.closest(rays, std::span(&hit, 1));
      const ExactVec3 normal =
          cross(ExactVec3(data.vertices[1], data.vertices[0]), ExactVec3(data.vertices[2], data.vertices[0]));
      const double cosine =
          std::fabs(static_cast<double>(dot(normal, ExactVec3(rays.direction(0))))) / length(Vec3(normal));
      worst_cosine = std::max(worst_cosine, std::fabs(hit.cos_incidence - cosine));
    }
    INFO(others.first);
    CHECK(others.different == 0);
    CHECK(wrong == 0);
    row(quantity, "square met at " + angle + " degrees, 1 m away: largest error of a range, times the cosine [1e-15 m]",
        0, worst * 1e15 * std::cos(slant), 100);
  }
  row(quantity, "square met at these angles: largest error of the cosine [1e-15]", 0, worst_cosine * 1e15, 100);
}

TEST_CASE("ground and voxels at any incidence") {
  Raster raster{.columns = 33, .rows = 33, .first = {-16, 16}};
  raster.heights.assign(33 * 33, 0.F);
  const HeightField field(raster);
  VoxelData data{.corner = {-16, -16, -1}, .edge = 1};
  for (std::uint32_t x = 0; x < 32; ++x)
    for (std::uint32_t y = 0; y < 32; ++y) data.cells.push_back({x, y, 0});
  const VoxelGrid<> grid(data);
  for (const std::string& angle : angles) {
    const std::uint64_t seed = 8410;
    CAPTURE(angle);
    CAPTURE(seed);
    Generator random(seed);
    const double slant = radians(angle);
    double of_field = 0, of_grid = 0;
    for (int time = 0; time < 1000; ++time) {
      const double turned = random.uniform(0, 2 * pi);
      const Vec3 down{std::sin(slant) * std::cos(turned), std::sin(slant) * std::sin(turned), -std::cos(slant)};
      const Vec3 aim{random.uniform(-3, 3), random.uniform(-3, 3), 0};
      Ray ray{aim - down * 10.0, down};
      const double exact = static_cast<double>(DoubleDouble(ray.origin.z) / DoubleDouble(-down.z));
      of_field = std::max(of_field, std::fabs(range_of(field, bundle_of(ray)) - exact));
      of_grid = std::max(of_grid, std::fabs(range_of(grid, bundle_of(ray)) - exact));
    }
    row(quantity,
        "ground of a raster met at " + angle +
            " degrees, 10 m away: largest error of a range, times the cosine [1e-15 m]",
        0, of_field * 1e15 * std::cos(slant), 1000);
    row(quantity,
        "top of voxels met at " + angle + " degrees, 10 m away: largest error of a range, times the cosine [1e-15 m]",
        0, of_grid * 1e15 * std::cos(slant), 1000);
  }
}

TEST_CASE("a ray within next to nothing of a triangle's plane") {
  const std::uint64_t seed = 8420;
  CAPTURE(seed);
  Generator random(seed);
  Verdict verdict;
  Comparison others;
  for (int time = 0; time < 10000; ++time) {
    const Rotation turn = random.rotation();
    const Vec3 u = turn * axis::right, v = turn * axis::forward, n = turn * axis::up, at = random.point(3);
    const double thin = random.coin() ? 1 : random.log_uniform(1e-8, 1);
    const MeshData data{{at, at + u, at + u * random.uniform() + v * thin}, {{0, 1, 2}}, {}};
    const double turned = random.coin() ? random.uniform(0, 2 * pi) : random.log_uniform(1e-12, 1);
    const double off = random.log_uniform(1e-12, 1e-3);
    const Vec3 from = u * std::cos(turned) + v * std::sin(turned);
    const Vec3 aim = target(random, data);
    const Vec3 origin = aim + from * random.uniform(1, 10) + n * (random.coin() ? off * random.uniform() : off);
    const RayBundle rays =
        bundle_of({origin, normalize(aim + from * random.uniform(-0.01, 0.01) + v * (off * random.normal()) - origin)});
    const Meshes meshes(data);
    judge(meshes.linear, data, rays, verdict);
    meshes.compare(rays, others);
  }
  check(verdict, others);
  // the same at a corner, where a wall stands right before it: what the wall hides may depend on roundings, but not on
  // the accelerator
  for (int time = 0; time < 10000; ++time) {
    const Rotation turn = random.rotation();
    const Vec3 u = turn * axis::right, v = turn * axis::forward, n = turn * axis::up, corner = random.point(1);
    MeshData data{{corner, corner - u - v * 0.3, corner - u + v * 0.3}, {{0, 1, 2}}, {}};
    const double off = random.log_uniform(1e-12, 1e-6), range = random.uniform(1, 3);
    const Vec3 origin = corner + (u * std::cos(0.1) + v * std::sin(0.1)) * range + n * off,
               way = normalize(corner - origin);
    const Vec3 wall = corner - way * (random.uniform() * 1e-15 * range / off);
    add_triangle(data, {wall + v * 3.0, wall + n * 3.0 - v * 2.0, wall - n * 3.0 - v * 2.0});
    Meshes(data).compare(bundle_of({origin, way}), others);
  }
  CHECK(others.different == 0);
  row(quantity,
      "triangles and needles seen from 1e-12 to 1e-3 rad off their planes: rays that do not answer as stated, of " +
          std::to_string(verdict.rays),
      0, static_cast<double>(verdict.wrong), 0);
}

TEST_CASE("a ray in the plane of a triangle") {
  // whole numbers, so that it is quite in the plane; turned onto every quantity
  std::size_t met = 0, through = 0;
  Comparison others;
  for (int k = 0; k < 3; ++k) {
    const auto turned = [k](const Vec3& p) {
      Vec3 q;
      for (int i = 0; i < 3; ++i) q[(i + k) % 3] = p[i];
      return q;
    };
    // in a plane across an quantity, and in the plane x + y + z = 0
    const MeshData across{{turned({0, 0, 0}), turned({4, 0, 0}), turned({0, 4, 0})}, {{0, 1, 2}}, {}};
    const MeshData aslant{{turned({4, -4, 0}), turned({0, 4, -4}), turned({-4, 0, 4})}, {{0, 1, 2}}, {}};
    for (const auto& [data, ends] :
         {std::pair{across, std::vector<Vec3>{{-4, 1, 0}, {-3, -3, 0}, {5, -1, 0}, {9, 0, 0}, {1, 1, 0}}},
          std::pair{aslant, std::vector<Vec3>{{8, -8, 0}, {5, -1, -4}, {-8, 4, 4}, {1, 1, -2}, {0, 0, 0}}}}) {
      const Meshes meshes(data);
      for (const Vec3& from : ends)
        for (const Vec3& to : ends) {
          if (from == to) continue;
          const RayBundle rays = bundle_of({turned(from), turned(to - from)});
          met += range_of(meshes.linear, rays) < 0 ? 0 : 1;
          meshes.compare(rays, others);
        }
    }
    // and into a cube in the plane of its lid: its side is met
    MeshData cube{{},
                  {{0, 1, 3},
                   {0, 3, 2},
                   {4, 7, 5},
                   {4, 6, 7},
                   {0, 5, 1},
                   {0, 4, 5},
                   {2, 3, 7},
                   {2, 7, 6},
                   {0, 2, 6},
                   {0, 6, 4},
                   {1, 7, 3},
                   {1, 5, 7}},
                  {}};
    for (int i = 0; i < 8; ++i) cube.vertices.push_back(turned(Vec3{i & 1, i >> 1 & 1, i >> 2}));
    const Meshes meshes(cube);
    for (const double y : {0.0, 0.25, 0.5, 1.0}) {
      const RayBundle rays = bundle_of({turned({-2, y, 1}), turned({1, 0, 0})});
      through += range_of(meshes.linear, rays) == 2 ? 0 : 1;
      meshes.compare(rays, others);
    }
  }
  // and in the plane of any triangle, but for roundings
  const std::uint64_t seed = 8425;
  CAPTURE(seed);
  Generator random(seed);
  for (int time = 0; time < 1000; ++time) {
    const Rotation turn = random.rotation();
    const Vec3 u = turn * axis::right, v = turn * axis::forward;
    const MeshData data{{-u, u, v}, {{0, 1, 2}}, {}};
    const Vec3 from = u * random.uniform(-5, 5) + v * random.uniform(-5, -1),
               to = u * random.uniform(-0.5, 0.5) + v * random.uniform(0, 0.5);
    const Meshes meshes(data);
    const RayBundle rays = bundle_of({from, normalize(to - from)});
    met += range_of(meshes.linear, rays) < 0 ? 0 : 1;
    meshes.compare(rays, others);
  }
  INFO(others.first);
  CHECK(others.different == 0);
  row(quantity, "triangle, in its plane: rays that meet it, of 1120", 0, static_cast<double>(met), 0);
  row(quantity, "cube, in the plane of its lid: rays that do not meet its side, of 12", 0, static_cast<double>(through),
      0);
}

TEST_CASE("a ray through an edge and through a corner") {
  const std::uint64_t seed = 8430;
  CAPTURE(seed);
  Generator random(seed);
  // a fan of triangles about a corner, over a floor that only a ray through a gap would meet
  constexpr std::uint32_t around = 1000;
  MeshData data;
  data.vertices.push_back({0.1, 0.2, 0.3});
  for (std::uint32_t i = 0; i < around; ++i) {
    const double turn = 2 * pi * i / around;
    data.vertices.push_back({std::cos(turn), std::sin(turn), 0.1 * std::sin(3 * turn)});
    data.triangles.push_back({0, 1 + i, 1 + (i + 1) % around});
  }
  add_triangle(data, {{-90, -90, -1}, {90, -90, -1}, {0, 90, -1}});
  const Meshes meshes(data);
  std::size_t edges = 0, corners = 0;
  Comparison others;
  for (int time = 0; time < 2000; ++time) {
    const Vec3 origin = Vec3{0, 0, random.log_uniform(2, 1e6)} + random.point(0.5), corner = data.vertices[0];
    const Vec3 edge = corner + (data.vertices[1 + random.whole(around)] - corner) * random.uniform();
    const RayBundle at_corner = bundle_of({origin, normalize(corner - origin)}),
                    at_edge = bundle_of({origin, normalize(edge - origin)});
    const auto misses = [&](const RayBundle& rays, const Vec3& aim) {
      const double range = length(aim - origin);
      return std::fabs(range_of(meshes.linear, rays) - range) < 1e-14 * range ? 0U : 1U;
    };
    corners += misses(at_corner, corner);
    edges += misses(at_edge, edge);
    meshes.compare(at_corner, others);
    meshes.compare(at_edge, others);
  }
  INFO(others.first);
  CHECK(others.different == 0);
  row(quantity, "fan of 1000 triangles: rays at a shared edge that slip through, of 2000", 0,
      static_cast<double>(edges), 0);
  row(quantity, "fan of 1000 triangles: rays at the shared corner that slip through, of 2000", 0,
      static_cast<double>(corners), 0);
}

TEST_CASE("a ray along the border of cells") {
  // a slope of whole heights to the east: rays in the planes of columns, rows and diagonals, at any slant
  constexpr std::uint32_t cells = 16;
  for (const Vec2 first : {Vec2{0, 0}, Vec2{500000, 5400000}}) {
    const std::string where = first.x == 0 ? "at the origin" : "at UTM";
    Raster raster{.columns = cells + 1, .rows = cells + 1, .first = first};
    for (std::uint32_t r = 0; r <= cells; ++r)
      for (std::uint32_t c = 0; c <= cells; ++c) raster.heights.push_back(static_cast<float>(c));
    const HeightField field(raster);
    const Meshes meshes(raster.mesh());
    // voxels as high as they are far in the east, under the same slope
    VoxelData data{.corner = {first.x, first.y - cells, 0}, .edge = 1};
    for (std::uint32_t x = 0; x < cells; ++x)
      for (std::uint32_t y = 0; y < cells; ++y)
        for (std::uint32_t z = 0; z <= x; ++z) data.cells.push_back({x, y, z});
    const VoxelGrid<> grid(data);
    std::size_t of_field = 0, of_grid = 0, sent = 0;
    Comparison others;
    for (std::uint32_t c = 1; c < cells; ++c)
      for (std::uint32_t r = 1; r < cells; ++r)
        for (const Vec2 way :
             {Vec2{0, 0}, Vec2{0, 1}, Vec2{0, -1}, Vec2{1, 0}, Vec2{-0.5, 0}, Vec2{1, 1}, Vec2{-0.5, -0.5}}) {
          // down by one and on by `way`, so as to meet the corner of cells (c, r) in its plane
          const Vec3 aim{first.x + c, first.y - r, static_cast<double>(c)}, down{way.x, way.y, -1};
          const RayBundle rays = bundle_of({aim - 4.0 * down, down});
          ++sent;
          of_field += range_of(field, rays) == 4 ? 0 : 1;
          compare(meshes.linear, field, "HeightField", rays, others);
          meshes.compare(rays, others);
          if (way.x != 0) continue;  // others meet voxels farther west first
          // the cell in the east of the border is the one that is met: its top is at c + 1
          of_grid += range_of(grid, rays) == 3 ? 0 : 1;
        }
    INFO(others.first);
    CHECK(others.different == 0);
    row(quantity,
        "raster " + where +
            ", along borders and diagonals of cells: rays that do not meet the ground where it is, of " +
            std::to_string(sent),
        0, static_cast<double>(of_field), 0);
    row(quantity,
        "voxels " + where + ", along borders of cells: rays that do not meet the cell in the east, of " +
            std::to_string(sent * 3 / 7),
        0, static_cast<double>(of_grid), 0);
  }
}
