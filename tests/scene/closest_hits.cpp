// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/closest_hits.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "support/allocations.hpp"
#include "support/generators.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;

static_assert(DeterministicGeometry<TriangleMesh<>> && !DeterministicGeometry<VoxelGrid<TransmissiveVoxels>>);
static_assert(pulsecast::detail::TracesBundles<Scene<TriangleMesh<>>> &&
              pulsecast::detail::TracesBundles<MovingScene<TriangleMesh<>>>);

namespace {
using Mesh = TriangleMesh<>;

std::shared_ptr<const Mesh> random_mesh(support::Generator& random, int triangles) {
  MeshData mesh;
  for (int i = 0; i < triangles; ++i) {
    const Vec3 centre = random.point(10);
    const Vec3 a = random.point(2), b = random.point(2), c = random.point(2);
    support::add_triangle(mesh, {centre + a, centre + b, centre + c});
  }
  return std::make_shared<const Mesh>(mesh);
}

/// Rays of a few origins, in directions that are close, spread, and along the edges of the cube.
std::vector<Ray> random_rays(support::Generator& random, std::size_t count) {
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Vec3 origin = random.point(15), about = random.unit();
    const double spread = random.log_uniform(1e-6, 2);
    const auto some = static_cast<std::size_t>(random.uniform(1, 700));
    for (std::size_t i = 0; i < some && rays.size() < count; ++i) {
      Vec3 direction = normalize(about + spread * random.point(1));
      if (i % 50 == 0) direction = normalize(Vec3{1, i % 100 == 0 ? -1.0 : 1.0, 1});
      rays.push_back({.origin = origin, .direction = direction, .seed = 3, .pulse = rays.size()});
    }
  }
  return rays;
}

/// World that counts what it is asked for.
struct Counted : Scene<Mesh> {
  std::size_t* alone;
  std::size_t* together;

  [[nodiscard]] std::optional<RayHit> closest_hit(const Ray& ray) const noexcept {
    ++*alone;
    return Scene::closest_hit(ray);
  }
  void closest(const RayBundle& rays, ClosestHits& hits) const noexcept {
    *together += rays.size;
    Scene::closest(rays, hits);
  }
  template <class Visitor>
  void closest(const StaggeredBundle& rays, std::span<Hit> hits, const Visitor& visit) const noexcept {
    Scene::closest(rays, hits, visit);
  }
};

template <class World>
void check(const World& world, std::span<const Ray> rays) {
  std::vector<std::optional<RayHit>> hits(rays.size(), RayHit{.range = -1});
  closest_hits<World>(world, rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    REQUIRE(hits[i] == world.closest_hit(rays[i]));
  }
}
}  // namespace

TEST_CASE("many rays meet what each of them meets alone, to the last bit") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const Scene<Mesh> scene({{.geometry = random_mesh(random, 2000)},
                             {.geometry = random_mesh(random, 10), .placement = {.translation = {3, 4, 5}}}});
    const std::vector<Ray> rays = random_rays(random, 3000);
    check(scene, rays);
  }
}

TEST_CASE("rays with ends, times and directions of their own meet what each of them meets alone") {
  const std::uint64_t seed = 5;
  support::Generator random(seed);
  const auto drift = std::make_shared<const PartMotion>(SteadyMotion{.velocity = {1, 2, 3}});
  const MovingScene<Mesh> scene(
      {{.geometry = random_mesh(random, 500)}, {.geometry = random_mesh(random, 500), .motion = drift}},
      MovingIndexSettings{.to = 10});
  std::vector<Ray> rays = random_rays(random, 3000);
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (i > 500) rays[i].tick = Tick::of_seconds(static_cast<double>(i / 40) / 10);
    if (i > 1000 && i % 30 < 10) rays[i].far = 9;
    if (i > 1500 && i % 30 > 20) rays[i].near = 8;
    if (i > 2000 && i % 20 == 0) rays[i].direction = {not_a_number, 0, 1};
    if (i > 2000 && i % 21 == 0) rays[i].origin.x = not_a_number;
    if (i > 2000 && i % 22 == 0) rays[i].direction = {};
  }
  check(scene, rays);
  check(scene, std::span<const Ray>());
}

TEST_CASE("rays that meet leaves at random keep their own keys") {
  VoxelData data{.edge = 1, .cells = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}};
  data.densities.assign(4, 0.7F);
  const Scene<VoxelGrid<TransmissiveVoxels>> scene(
      {{.geometry = std::make_shared<const VoxelGrid<TransmissiveVoxels>>(data)}});
  CHECK(!scene.deterministic());
  std::vector<Ray> rays;
  for (std::uint64_t k = 0; k < 300; ++k)
    rays.push_back({.origin = {-1, 0.5, 0.5}, .direction = axis::right, .seed = 4, .pulse = k});
  check(scene, rays);
  CHECK(std::any_of(rays.begin(), rays.end(),
                    [&](const Ray& ray) { return scene.closest_hit(ray) != scene.closest_hit(rays[0]); }));
}

TEST_CASE("neighbouring rays are traced together in any order, and rays with nobody beside them alone") {
  support::Generator random(1);
  const Scene<Mesh> scene({{.geometry = random_mesh(random, 100)}});
  std::vector<Ray> rays;  // 500 directions of one cell, one of another
  for (int i = 0; i < 500; ++i) rays.push_back({.direction = normalize(Vec3{0.02 + 2e-5 * i, 1, 0.02})});
  rays.insert(rays.begin() + 100, Ray{.direction = axis::up});
  std::size_t alone = 0, together = 0;
  const Counted counted{scene, &alone, &together};
  std::vector<std::optional<RayHit>> hits(rays.size());
  closest_hits<Counted>(counted, rays, hits);
  CHECK(alone == 1);
  CHECK(together == 500);
}

TEST_CASE("asking many rays at once allocates nothing") {
  support::Generator random(2);
  const Scene<Mesh> scene({{.geometry = random_mesh(random, 100)}});
  const std::vector<Ray> rays = random_rays(random, 2000);
  std::vector<std::optional<RayHit>> hits(rays.size());
  const std::size_t before = support::allocations;
  closest_hits<Scene<Mesh>>(scene, rays, hits);
  CHECK(support::allocations == before);
}
