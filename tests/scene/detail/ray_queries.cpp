// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/detail/ray_queries.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <pulsecast/accel/kd_tree.hpp>
#include <pulsecast/accel/linear.hpp>
#include <pulsecast/scene/motion.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/height_field.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "support/archetypes.hpp"
#include "support/generators.hpp"
#include "support/relative.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

using Mesh = TriangleMesh<>;

/// The triangle (0, 0), (2, 0), (0, 2) at height 0, seen anticlockwise from above, with a texture.
MeshData half_square() {
  return {.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}},
          .triangles = {{0, 1, 2}},
          .texture = {{{Vec2{0, 0}, {1, 0}, {0, 4}}}}};
}

VoxelData cells_in_a_row(std::initializer_list<std::uint32_t> along_x) {
  VoxelData data;
  for (const std::uint32_t x : along_x) data.cells.push_back({x, 0, 0});
  return data;
}

template <class World>
std::vector<RayHit> all(const World& scene, const Ray& ray) {
  std::vector<RayHit> hits;
  const std::size_t calls = scene.all_hits(ray, [&](const RayHit& hit) { hits.push_back(hit); });
  CHECK(calls == hits.size());
  return hits;
}

/// Hits by asking for the closest again from each on.
template <class World>
std::vector<RayHit> chain(const World& scene, Ray ray) {
  std::vector<RayHit> hits;
  while (const auto hit = scene.closest_hit(ray)) {
    hits.push_back(*hit);
    ray.near = hit->range;
  }
  return hits;
}

bool in_order(const RayHit& a, const RayHit& b) {
  return a.range != b.range ? a.range < b.range : a.part != b.part ? a.part < b.part : a.primitive < b.primitive;
}

std::shared_ptr<const PartMotion> any_motion(Generator& any) {
  SteadyMotion m{.velocity = any.point(5), .axis = any.unit(), .angular_rate = any.uniform(-2, 2)};
  if (any.coin()) m.centre = any.point(10);
  return std::make_shared<const PartMotion>(m);
}

template <class Shape>
std::shared_ptr<const Shape> shared(Shape shape) {
  return std::make_shared<const Shape>(std::move(shape));
}

VoxelData some_cells(Generator& any) {
  VoxelData data{.corner = {-1, -1, -1}, .edge = 0.25};
  for (std::uint32_t x = 0; x < 8; ++x)
    for (std::uint32_t y = 0; y < 8; ++y)
      for (std::uint32_t z = 0; z < 8; ++z)
        if (any.whole(3) == 0) data.cells.push_back({x, y, z});
  for (std::size_t i = 0; i < data.cells.size(); ++i) {
    data.scales.push_back(static_cast<float>(any.uniform(0.3, 1)));
    data.densities.push_back(static_cast<float>(any.uniform(0, 3)));
  }
  return data;
}

Raster some_ground(Generator& any) {
  Raster raster{.columns = 9, .rows = 9, .first = {-1, 1}, .pixel = {0.25, 0.25}};
  for (int i = 0; i < 81; ++i) raster.heights.push_back(static_cast<float>(any.uniform(-0.3, 0.3)));
  return raster;
}

using Everything = MovingScene<Mesh, TriangleMesh<KdTree<>>, HeightField, VoxelGrid<>, VoxelGrid<ScaledVoxels>,
                               VoxelGrid<TransmissiveVoxels>, LeastGeometry, TriangleMesh<LeastAccelerator>>;
using Believed = MovingScene<TriangleMesh<Linear<>>, HeightField, VoxelGrid<>, VoxelGrid<ScaledVoxels>,
                             VoxelGrid<TransmissiveVoxels>, LeastGeometry>;

/// The same parts by every accelerator, and by `Linear`.
struct Pair {
  std::vector<Everything::Part> parts;
  std::vector<Believed::Part> believed;

  explicit Pair(Generator& any) {
    const MeshData data = doubled(soup(any, 40, 1));
    const VoxelData cells = some_cells(any);
    const Raster raster = some_ground(any);
    const auto mesh = shared(Mesh(data));
    const auto kd_tree = shared(TriangleMesh<KdTree<>>(data));
    const auto least = shared(TriangleMesh<LeastAccelerator>(data));
    const auto linear = shared(TriangleMesh<Linear<>>(data));
    const auto field = shared(HeightField(raster));
    const auto opaque = shared(VoxelGrid<>(cells));
    const auto scaled = shared(VoxelGrid<ScaledVoxels>(cells));
    const auto leaves = shared(VoxelGrid<TransmissiveVoxels>(cells));
    const auto own = shared(LeastGeometry{});
    for (ObjectId k = 0; k < 12; ++k) {
      const Placement placement =
          k % 4 == 3 ? Placement{} : Placement{any.rotation(), any.log_uniform(0.3, 3), any.point(4)};
      const auto motion = any.whole(3) == 0 ? any_motion(any) : nullptr;
      const auto add = [&](const auto& tested, const auto& oracle) {
        parts.push_back({.geometry = tested, .placement = placement, .object = k, .motion = motion});
        believed.push_back({.geometry = oracle, .placement = placement, .object = k, .motion = motion});
      };
      switch (any.whole(8)) {
        case 0:
          add(mesh, linear);
          break;
        case 1:
          add(kd_tree, linear);
          break;
        case 2:
          add(least, linear);
          break;
        case 3:
          add(field, field);
          break;
        case 4:
          add(opaque, opaque);
          break;
        case 5:
          add(scaled, scaled);
          break;
        case 6:
          add(leaves, leaves);
          break;
        default:
          add(own, own);
      }
    }
  }
};

}  // namespace

static_assert(MadeOfTriangles<Mesh> && MadeOfTriangles<HeightField> && !MadeOfTriangles<VoxelGrid<>>);
static_assert(Textured<Mesh> && !Textured<HeightField>);
static_assert(sizeof(RayHit) == 24);

TEST_CASE("a hit names part, primitive and range, and its surface says all there is to know") {
  const auto mesh = std::make_shared<const Mesh>(half_square());
  const auto table = material_table({{.name = "tile", .classification = 2}});
  const Scene<Mesh> scene({{.geometry = mesh, .placement = {.translation = {0, 0, -50}}},
                           {.geometry = mesh,
                            .materials = table,
                            .placement = {rotation_about(axis::right, pi / 2), 2, {10, 20, 30}},
                            .object = 7}});
  // upright now: its corners are (10, 20, 30), (14, 20, 30), (10, 20, 34), and it is seen anticlockwise from the south
  const Ray ray{.origin = {11, 15, 31}, .direction = axis::forward};
  const auto hit = scene.closest_hit(ray);
  REQUIRE(hit.has_value());
  CHECK(*hit == RayHit{5, 1, 0});
  const SurfaceInteraction at = scene.surface(*hit, ray);
  CHECK(length(at.position - Vec3{11, 20, 31}) < 1e-12);
  CHECK(length(at.normal - Vec3{0, -1, 0}) < 1e-12);
  CHECK(at.front);
  CHECK(at.material == &table->front());
  CHECK(at.part == 1);
  CHECK(at.primitive == 0);
  CHECK(length(at.weights.value() - Vec3{0.5, 0.25, 0.25}) < 1e-12);
  CHECK(length(at.texture.value() - Vec2{0.25, 1}) < 1e-12);
  CHECK(at.velocity == Vec3{});
  CHECK(at.object == 7);
  CHECK(at.classification == 2);

  const Ray from_behind{.origin = {11, 25, 31}, .direction = -axis::forward};
  const SurfaceInteraction behind = scene.surface(scene.closest_hit(from_behind).value(), from_behind);
  CHECK(length(behind.normal - Vec3{0, 1, 0}) < 1e-12);
  CHECK_FALSE(behind.front);

  CHECK(scene.occluded(ray));
  CHECK(scene.occluded(ray, 5));
  CHECK_FALSE(scene.occluded(ray, std::nextafter(5, 0)));
  CHECK_FALSE(scene.occluded({.origin = ray.origin, .direction = ray.direction, .near = 5}));
  CHECK_FALSE(scene.occluded({.origin = ray.origin, .direction = ray.direction, .far = 4}, 6));
  CHECK_FALSE(scene.closest_hit({.origin = {13, 15, 33}}).has_value());
  CHECK(scene.all_hits(from_behind, [](const RayHit&) noexcept {}) == 1);
  static_assert(noexcept(scene.closest_hit(ray))&& noexcept(scene.occluded(ray))&& noexcept(scene.surface(*hit, ray)));
  static_assert(noexcept(scene.all_hits(ray, [](const RayHit&) noexcept {})));
}

TEST_CASE("of equal ranges the smallest id is closest and comes first, and the visitor may stop") {
  MeshData data = doubled(half_square());
  data.texture.clear();
  const auto mesh = std::make_shared<const Mesh>(data);
  std::vector<Scene<Mesh>::Part> parts(30, {.geometry = mesh});
  for (std::size_t i = 20; i < 30; ++i) parts[i].placement.translation.z = -1;
  const Scene<Mesh> scene(parts);
  const Ray down{.origin = {0.5, 0.5, 1}, .direction = -axis::up};
  CHECK(*scene.closest_hit(down) == RayHit{1, 0, 0});
  const std::vector<RayHit> hits = all(scene, down);
  REQUIRE(hits.size() == 60);
  for (std::uint32_t k = 0; k < 60; ++k) CHECK(hits[k] == RayHit{k < 40 ? 1.0 : 2.0, k / 2, k % 2});
  for (const std::size_t stop : {1U, 7U, 32U, 33U, 60U}) {
    std::size_t asked = 0;
    CHECK(scene.all_hits(down, [&](const RayHit&) { return ++asked < stop; }) == stop);
    CHECK(asked == stop);
  }
}

TEST_CASE("a ray through voxels meets each where it enters, and the last of a row where it leaves") {
  const auto grid = std::make_shared<const VoxelGrid<>>(cells_in_a_row({1, 2, 5}));
  const Scene<VoxelGrid<>> scene({{.geometry = grid}});
  const Ray along{.origin = {-1, 0.5, 0.5}, .direction = axis::right};
  const std::vector<RayHit> hits = all(scene, along);
  const std::vector<double> ranges{2, 3, 4, 6, 7};
  REQUIRE(hits.size() == ranges.size());
  for (std::size_t k = 0; k < hits.size(); ++k) {
    CAPTURE(k);
    CHECK(hits[k].range == ranges[k]);
    const SurfaceInteraction at = scene.surface(hits[k], along);
    CHECK(at.normal == Vec3{-1, 0, 0});
    CHECK(at.front);
    CHECK_FALSE(at.weights.has_value());
    CHECK_FALSE(at.texture.has_value());
  }
}

TEST_CASE("a shape of one's own that takes bundles only is asked from each hit on") {
  const Scene<support::UnitBall> scene({{.geometry = std::make_shared<const support::UnitBall>(),
                                         .placement = {.scale = 2, .translation = {0, 10, 0}}}});
  const Ray ahead{.origin = {0, 0, 0}, .direction = axis::forward};
  const auto hits = all(scene, ahead);
  REQUIRE(hits.size() == 2);
  CHECK(hits[0].range == relative(8, 1e-12));
  CHECK(hits[1].range == relative(12, 1e-12));
  CHECK(scene.surface(hits[0], ahead).front);
  CHECK_FALSE(scene.surface(hits[1], ahead).front);
  CHECK(length(scene.surface(hits[1], ahead).normal - Vec3{0, -1, 0}) < 1e-12);
}

TEST_CASE("leaves are drawn by the key of the ray: seed, pulse and subray") {
  VoxelData data = cells_in_a_row({0, 1, 2, 3});
  data.densities.assign(4, 0.7F);
  const Scene<VoxelGrid<TransmissiveVoxels>> scene(
      {{.geometry = std::make_shared<const VoxelGrid<TransmissiveVoxels>>(data)}});
  std::size_t met = 0, different = 0;
  std::optional<double> last;
  for (std::uint32_t k = 0; k < 300; ++k) {
    const Ray ray{.origin = {-1, 0.5, 0.5}, .direction = axis::right, .seed = k % 7, .pulse = k, .subray = k % 5};
    Hit expected;
    scene.closest(bundle_of(ray), {&expected, 1});
    const auto hit = scene.closest_hit(ray);
    REQUIRE(hit.has_value() == expected.met());
    CHECK(hit == scene.closest_hit(ray));
    CHECK(all(scene, ray) == (hit ? std::vector{*hit} : std::vector<RayHit>{}));
    if (!hit) continue;
    CHECK(hit->range == expected.range);
    CHECK(dot(scene.surface(*hit, ray).normal, ray.direction) ==
          doctest::Approx(-2.0 / 3));  // the mean tilt of spherical leaves
    different += last && *last != hit->range ? 1U : 0U;
    last = hit->range;
    ++met;
  }
  CHECK(met > 100);
  CHECK(different == met - 1);
}

TEST_CASE("queries of every shape, still and moving, agree with closest, with one another and with Linear") {
  std::size_t met = 0, several = 0, most = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const Pair pair(any);
    const Everything scene(pair.parts, {.to = 4});
    const Believed believed(pair.believed, {.to = 4});
    for (int k = 0; k < 100; ++k) {
      CAPTURE(k);
      const Tick tick = Tick::of_seconds(any.uniform(0, 5));
      const Vec3 from = any.point(6),
                 to = scene.placement(any.whole(pair.parts.size()), tick).translation + any.point(0.5);
      Ray ray{.origin = from,
              .direction = normalize(to - from),
              .tick = tick,
              .seed = seed,
              .pulse = static_cast<PulseIndex>(k),
              .subray = 3};
      if (any.whole(4) == 0) ray.near = any.uniform(0, 5);
      if (any.whole(4) == 0) ray.far = any.uniform(1, 15);
      Hit nearest;
      scene.closest(bundle_of(ray), {&nearest, 1});
      const auto hit = scene.closest_hit(ray);
      REQUIRE(hit.has_value() == nearest.met());
      REQUIRE(scene.occluded(ray) == hit.has_value());
      const std::vector<RayHit> hits = all(scene, ray);
      REQUIRE(hits == all(believed, ray));
      REQUIRE(hits.empty() != hit.has_value());
      REQUIRE(std::is_sorted(hits.begin(), hits.end(), in_order));
      most = std::max(most, hits.size());
      if (!hit) continue;
      ++met;
      several += hits.size() > 1 ? 1U : 0U;
      REQUIRE(hits.front() == *hit);
      REQUIRE(hit->range == nearest.range);
      REQUIRE(believed.closest_hit(ray) == hit);
      REQUIRE(scene.occluded(ray, hit->range));
      REQUIRE_FALSE(scene.occluded(ray, std::nextafter(hit->range, 0)));
      const SurfaceInteraction at = scene.surface(*hit, ray);
      REQUIRE(at.object == nearest.object);
      REQUIRE(dot(at.normal, ray.direction) <= 1e-12);
      if (at.normal != Vec3{}) {
        REQUIRE(std::fabs(length(at.normal) - 1) < 1e-12);
        REQUIRE(std::fabs(-dot(at.normal, ray.direction) - nearest.cos_incidence) < 1e-9);
      }
      if (at.weights) REQUIRE(std::fabs(at.weights->x + at.weights->y + at.weights->z - 1) < 1e-12);
    }
  }
  CHECK(met > 1500);
  CHECK(several > 1000);
  CHECK(most > AllHits::capacity);
}

TEST_CASE("all hits of voxels are the closest ones from each on") {
  std::size_t met = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const VoxelData cells = some_cells(any);
    const Scene<VoxelGrid<>, VoxelGrid<ScaledVoxels>> opaque({{.geometry = shared(VoxelGrid<>(cells))}}),
        scaled({{.geometry = shared(VoxelGrid<ScaledVoxels>(cells))}});
    for (int k = 0; k < 50; ++k) {
      const Vec3 from = any.point(2), to = any.point(1);
      const Ray ray{.origin = from, .direction = normalize(to - from)};
      REQUIRE(all(opaque, ray) == chain(opaque, ray));
      REQUIRE(all(scaled, ray) == chain(scaled, ray));
      met += all(opaque, ray).size();
    }
  }
  CHECK(met > 2000);
}

TEST_CASE("the weights of a hit put its point together, and the texture follows them") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    MeshData data;
    add_triangle(data, {any.point(3), any.point(3), any.point(3)});
    data.texture = {{Vec2{0, 0}, {1, 0}, {0, 1}}};
    const Scene<Mesh> scene({{.geometry = shared(Mesh(data)), .placement = {any.rotation(), 2, any.point(5)}}});
    const Placement& placement = scene.parts()[0].placement;
    const Triangle t = data.triangle(0);
    const double u = any.uniform(), v = any.uniform(0, 1 - u);
    const Vec3 at = placement.point((1 - u - v) * t.a + u * t.b + v * t.c), from = any.point(10);
    const Ray ray{.origin = from, .direction = normalize(at - from)};
    const auto hit = scene.closest_hit(ray);
    REQUIRE(hit.has_value());
    const SurfaceInteraction point = scene.surface(*hit, ray);
    const double slant = std::fabs(dot(point.normal, ray.direction)) + 1e-3;
    CHECK(length(point.weights.value() - Vec3{1 - u - v, u, v}) < 1e-10 / slant);
    CHECK(length(point.texture.value() - Vec2{point.weights->y, point.weights->z}) < 1e-12);
  }
}

TEST_CASE("a moving surface has the velocity of its point") {
  const auto mesh = std::make_shared<const Mesh>(half_square());
  const auto turning =
      std::make_shared<const PartMotion>(SteadyMotion{.velocity = {0, 0, 3}, .angular_rate = pi / 2, .centre = Vec3{}});
  const MovingScene<Mesh> scene(
      {{.geometry = mesh, .motion = turning}, {.geometry = mesh, .placement = {.translation = {0, 0, -9}}}}, {.to = 9});
  const Ray down{
      .origin = {-0.5, 0.25, 50}, .direction = -axis::up, .tick = {1, 0}};  // turned by 90 degrees, and 3 m up
  const auto hit = scene.closest_hit(down);
  REQUIRE(hit.has_value());
  CHECK(hit->part == 0);
  CHECK(hit->range == relative(47, 1e-12));
  CHECK(length(scene.surface(*hit, down).velocity - Vec3{-0.25 * pi / 2, -0.5 * pi / 2, 3}) < 1e-12);
  const Ray still{.origin = {0.5, 0.25, -5}, .direction = -axis::up, .tick = {1, 0}};
  CHECK(scene.surface(scene.closest_hit(still).value(), still).velocity == Vec3{});
}
