// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Where a scene is, and how large: what counts are the distances in it, not how far it is from the origin of the world.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
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

const std::string quantity = "coordinates";

struct Place {
  std::string name;
  Vec3 at;
};
const std::vector<Place> places{{"UTM", {4.7e5 + 1.0 / 3, 5.4e6 + 1.0 / 7, 300.1}},
                                {"1e7 m", {1e7 + 1.0 / 3, -1e7, 1e7 - 1.0 / 7}},
                                {"Earth-centred", {4.1e6 + 1.0 / 3, 6.2e5, 4.8e6 + 1.0 / 7}},
                                {"1e9 m", {1e9, -1e9 + 1.0 / 3, 1e9}}};

/// Rays between the inside of a sphere and what is around it.
RayBundle about(Generator& random, const Vec3& centre, double radius, std::size_t size) {
  const bool inside = random.coin();
  const Vec3 origin =
      centre + (inside ? random.point(0.5 * radius) : random.unit() * (radius * random.log_uniform(1.5, 100)));
  return random.cone(origin, inside ? random.unit() : normalize(centre + random.point(0.5 * radius) - origin),
                     inside ? 0.5 : 0.2 * radius / length(centre - origin), size);
}

/// Asks a sphere of triangles, and prints by how much ranges err, in units of its radius.
void sphere(const std::string& what, const Vec3& centre, double radius, std::uint64_t seed) {
  CAPTURE(what);
  CAPTURE(seed);
  const MeshData data = moved(scaled(icosphere(1), radius), centre);
  const Meshes meshes(data);
  Generator random(seed);
  Verdict verdict;
  Comparison others;
  for (int time = 0; time < 150; ++time) {
    const RayBundle rays = about(random, centre, radius, random.coin() ? 1 : 8);
    judge(meshes.linear, data, rays, verdict);
    meshes.compare(rays, others);
  }
  check(verdict, others);
  CHECK(verdict.met > verdict.rays / 2);
  row(quantity, "sphere of 80 triangles, " + what + ": largest error of a range [1e-12 of the radius]", 0,
      verdict.worst / radius * 1e12, 10);
}

}  // namespace

TEST_CASE("a sphere of any size at the origin") {
  std::uint64_t seed = 8100;
  for (const char* radius : {"1e-6", "1e-3", "1", "1e3", "1e6", "1e9"})
    sphere("radius " + std::string(radius) + " m, at the origin", {}, std::stod(radius), seed++);
}

TEST_CASE("a sphere of 1 m anywhere") {
  std::uint64_t seed = 8120;
  for (const Place& place : places) sphere("radius 1 m, at " + place.name, place.at, 1, seed++);
}

TEST_CASE("no ray leaves a closed mesh of 1 m, wherever it is") {
  std::uint64_t lost = 0, sent = 0;
  for (const Place& place : places) {
    const std::uint64_t seed = 8130;
    CAPTURE(place.name);
    CAPTURE(seed);
    Generator random(seed);
    const MeshData data = moved(icosphere(2), place.at);
    const Meshes meshes(data);
    for (int time = 0; time < 300; ++time) {
      RayBundle rays;
      rays.origin = place.at + random.point(0.5);
      rays.size = 16;
      for (std::size_t j = 0; j < rays.size; ++j) rays.set_direction(j, normalize(target(random, data) - rays.origin));
      rays.pad();
      lost += escaped(meshes.linear, rays) + escaped(meshes.bvh, rays) + escaped(meshes.exact_bvh, rays) +
              escaped(meshes.kd_tree, rays) + escaped(meshes.exact_kd_tree, rays);
      sent += 5 * rays.size;
    }
    CHECK(lost == 0);
  }
  row(quantity,
      "sphere of 320 triangles, at these places: rays at corners and edges that get out, of " + std::to_string(sent), 0,
      static_cast<double>(lost), 0);
}

namespace {

/// Asks a scene of one part that is turned, and gives the largest error of a range [m]; `own` is where the part is in
/// its own coordinates.
double worst_of_part(const Vec3& own, double scale, const Vec3& centre, std::uint64_t seed) {
  Generator random(seed);
  const MeshData data = moved(icosphere(1), own);
  Placement placement{random.rotation(), scale, {}};
  placement.translation = centre - placement.point(own);
  const Scene<TriangleMesh<>> scene(
      {{.geometry = std::make_shared<const TriangleMesh<>>(data), .placement = placement}});
  // the rays as the part sees them, by the inverse of its rotation in double-double arithmetic
  const auto seen = [&](const ExactVec3& v) {
    const Rotation back = conjugate(placement.rotation);
    const ExactVec3 axle(Vec3{back.x, back.y, back.z}), once = cross(axle, v) * 2;
    return (v + once * back.w + cross(axle, once)) * (DoubleDouble(1) / scale);
  };
  double worst = 0;
  std::size_t met = 0;
  for (int time = 0; time < 300; ++time) {
    const RayBundle rays = about(random, centre, scale, 1);
    const ExactVec3 origin = seen(ExactVec3(rays.origin, placement.translation)),
                    direction = seen(ExactVec3(rays.direction(0)));
    Hit hit;
    scene.closest(rays, std::span(&hit, 1));
    ExactCrossing expected;
    double range = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < data.triangles.size(); ++i) {
      const ExactCrossing crossing = exact_crossing(data.triangle(i), origin, direction);
      const auto at = static_cast<double>(crossing.range);
      if (crossing.inside >= 0 && at > 0 && at < range) {
        range = at;
        expected = crossing;
      }
    }
    if (!(expected.sine > 0.1)) continue;  // edges and silhouettes are for other tests
    ++met;
    worst = std::max(worst, std::fabs(hit.range - range));
  }
  CHECK(met > 100);
  return worst;
}

}  // namespace

TEST_CASE("a part that stands at far coordinates is as exact as at the origin; one of far coordinates as they are") {
  for (const Place& place : places) {
    CAPTURE(place.name);
    row(quantity, "part of 0.25 m, turned, at " + place.name + ": largest error of a range [pm]", 0,
        1e12 * worst_of_part({}, 0.25, place.at, 8140), 10);
    row(quantity,
        "part whose own coordinates are at " + place.name +
            ", turned, at the origin: largest error of a range [1e-15 of the coordinates]",
        0, 1e15 * worst_of_part(place.at, 1, {}, 8145) / length(place.at), 10);
  }
}

TEST_CASE("ground of 1 m anywhere") {
  for (const Place& place : places) {
    const std::uint64_t seed = 8150;
    CAPTURE(place.name);
    CAPTURE(seed);
    Generator random(seed);
    Raster raster{.columns = 11, .rows = 11, .first = {place.at.x, place.at.y}, .pixel = {0.1, 0.1}};
    for (int i = 0; i < 121; ++i) raster.heights.push_back(static_cast<float>(place.at.z + random.uniform(0, 0.3)));
    const MeshData data = raster.mesh();
    const HeightField field(raster);
    const Meshes meshes(data);
    const Vec3 middle = field.bounds().centre();
    Verdict verdict;
    Comparison others;
    for (int time = 0; time < 150; ++time) {
      const Vec3 origin = middle + Vec3{0, 0, 10} + random.point(5);
      const RayBundle rays = random.cone(origin, normalize(target(random, data) - origin), 1e-3, random.coin() ? 1 : 8);
      judge(field, data, rays, verdict);  // none of its triangles is missing, so they are numbered as those of the mesh
      meshes.compare(rays, others);
      compare(meshes.linear, field, "HeightField", rays, others);
    }
    check(verdict, others);
    row(quantity, "raster of 1 m, at " + place.name + ": largest error of a range [pm]", 0, verdict.worst * 1e12, 10);
  }
}

TEST_CASE("voxels of any size, anywhere") {
  struct Case {
    std::string name;
    Vec3 corner;
    double edge;
  };
  std::vector<Case> cases{{"edge 1e-6 m, at the origin", {}, 1e-6}, {"edge 1e6 m, at the origin", {}, 1e6}};
  for (const Place& place : places) cases.push_back({"edge 0.05 m, at " + place.name, place.at, 0.05});
  for (const Case& c : cases) {
    const std::uint64_t seed = 8160;
    CAPTURE(c.name);
    CAPTURE(seed);
    VoxelData data{.corner = c.corner, .edge = c.edge};
    Generator random(seed);
    for (std::uint32_t x = 0; x < 10; ++x)
      for (std::uint32_t y = 0; y < 10; ++y) data.cells.push_back({x, y, x});  // stairs
    const VoxelGrid<> grid(data);
    double worst = 0;
    std::size_t wrong = 0;
    for (int time = 0; time < 2000; ++time) {
      const double depth = random.log_uniform(1, 1e3) * c.edge;
      const std::uint32_t column = static_cast<std::uint32_t>(random.whole(10));
      // straight down into a stair, from above: the face is where corner + edge k is, without a rounding
      const Vec3 origin = c.corner + Vec3{(column + random.uniform(0.1, 0.9)) * c.edge,
                                          random.uniform(0.5, 9.5) * c.edge, 10 * c.edge + depth};
      const RayBundle rays = bundle_of({origin, -axis::up});
      ClosestHits nearest(rays);
      grid.closest(rays, nearest);
      // the column that the origin is in, as rounded
      const DoubleDouble stair = DoubleDouble(origin.x, -c.corner.x) / DoubleDouble(c.edge);
      const DoubleDouble face =
          DoubleDouble(c.corner.z) + DoubleDouble(c.edge) * DoubleDouble(std::floor(static_cast<double>(stair)) + 1);
      wrong += nearest.met(0) ? 0 : 1;
      if (nearest.met(0))
        worst = std::max(worst, std::fabs(static_cast<double>(DoubleDouble(origin.z) - face - nearest.range[0])));
    }
    CHECK(wrong == 0);
    row(quantity, "voxels, " + c.name + ": largest error of a range [1e-12 of the edge]", 0, worst / c.edge * 1e12,
        100);
  }
}

TEST_CASE("what lies farther than can be computed with is refused") {
  const auto mesh_at = [](double at) { return MeshData{{{at, 0, 0}, {at, 1, 0}, {at, 0, 1}}, {{0, 1, 2}}, {}}; };
  refused_as(quantity, "mesh at 1.1e18 m", "within 1e18 m of the origin",
             [&] { return TriangleMesh<Bvh<>>(mesh_at(1.1e18)); });
  CHECK_THROWS_AS((TriangleMesh<Bvh<double>>(mesh_at(1.1e18))), SettingError);
  CHECK_THROWS_AS((TriangleMesh<KdTree<>>(mesh_at(1.1e18))), SettingError);
  CHECK_THROWS_AS((TriangleMesh<Linear<>>(mesh_at(1.1e18))), SettingError);
  refused_as(quantity, "mesh of infinity", "see vertex 0",
             [&] { return TriangleMesh<>(mesh_at(std::numeric_limits<double>::infinity())); });
  refused_as(quantity, "raster at 1.1e15 m", "Raster::first.x", [] {
    return HeightField({.columns = 2, .rows = 2, .first = {1.1e15, 0}, .heights = {1, 1, 1, 1}});
  });
  refused_as(quantity, "raster of a height of 1.1e15 m", "see pixel 3", [] {
    return HeightField({.columns = 2, .rows = 2, .heights = {1, 1, 1, 1.1e15F}});
  });
  refused_as(quantity, "voxels at 1.1e18 m", "VoxelData::corner", [] {
    return VoxelGrid<>({.corner = {0, 1.1e18, 0}, .cells = {{0, 0, 0}}});
  });
  refused_as(quantity, "raster of pixels of 8e-7 m at 1e9 m", "Raster::pixel.x", [] {
    return HeightField({.columns = 2, .rows = 2, .first = {1e9, 0}, .pixel = {8e-7, 1}, .heights = {1, 1, 1, 1}});
  });
  CHECK_THROWS_AS(
      HeightField({.columns = 2, .rows = 2, .first = {0, -1e9}, .pixel = {1, 8e-7}, .heights = {1, 1, 1, 1}}),
      SettingError);
  refused_as(quantity, "voxels of 8e-7 m at 1e9 m", "VoxelData::edge", [] {
    return VoxelGrid<>({.corner = {0, 0, 1e9}, .edge = 8e-7, .cells = {{0, 0, 0}}});
  });
  refused_as(quantity, "part at infinity", "Placement::translation", [&] {
    return Scene<TriangleMesh<>>({{.geometry = std::make_shared<const TriangleMesh<>>(mesh_at(0)),
                                   .placement = {.translation = {0, 0, std::numeric_limits<double>::infinity()}}}});
  });
  refused_as(quantity, "part of 1e-31 of its size", "Placement::scale", [&] {
    return Scene<TriangleMesh<>>(
        {{.geometry = std::make_shared<const TriangleMesh<>>(mesh_at(0)), .placement = {.scale = 1e-31}}});
  });
}
