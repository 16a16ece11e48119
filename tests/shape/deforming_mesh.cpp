// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/deforming_mesh.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/allocations.hpp"
#include "support/counting_executor.hpp"
#include "support/generators.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using support::Generator;
using Mesh = TriangleMesh<>;

namespace {

/// Requires that two meshes have the same triangles and meet rays at the same ranges.
template <class AnyMesh>
void require_same(const AnyMesh& mesh, const MeshData& data, Generator& any, double reach) {
  const AnyMesh fresh(data, 1);
  REQUIRE(mesh.size() == fresh.size());
  REQUIRE(mesh.is_consistent());
  REQUIRE(mesh.bounds() == fresh.bounds());
  for (PrimitiveIndex i = 0; i < mesh.size(); ++i) {
    REQUIRE(mesh.triangle(i).a == fresh.triangle(i).a);
    REQUIRE(mesh.triangle(i).b == fresh.triangle(i).b);
    REQUIRE(mesh.triangle(i).c == fresh.triangle(i).c);
  }
  for (int k = 0; k < 40; ++k) {
    const Triangle aimed = data.triangle(any.whole(data.triangles.size()));
    const Vec3 from = any.point(2 * reach), at = any.coin() ? aimed.a : (aimed.a + aimed.b + aimed.c) / 3.0;
    const RayBundle rays =
        any.cone(from, normalize(at - from), 0.01, any.coin() ? 1 : 1 + any.whole(RayBundle::capacity));
    ClosestHits hits(rays), expected(rays);
    mesh.closest(rays, hits);
    fresh.closest(rays, expected);
    for (std::size_t j = 0; j < rays.size; ++j) {
      REQUIRE(hits.id[j] == expected.id[j]);
      REQUIRE(hits.range[j] == expected.range[j]);
      if (hits.met(j))
        REQUIRE(mesh.surface(hits.primitive_of(j), rays, j).material_index ==
                fresh.surface(hits.primitive_of(j), rays, j).material_index);
    }
  }
}

}  // namespace

TEST_CASE("texture coordinates and masks stay when the index is built anew") {
  Generator any(11);
  MeshData data;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Vec3 at = any.point(10);
    for (int k = 0; k < 3; ++k) data.vertices.push_back(at + any.point(0.1));
    data.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    data.texture.push_back({Vec2{0, 0}, {1, 0}, {0, 1}});
  }
  data.masks = {{2, 1, {1}}};  // solid on the left
  DeformingMesh<MaskedMesh<>> mesh(data);
  const auto before = mesh.mesh()->memory();
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Vec3 at = any.point(10);  // a scattering that no refit bears
    for (std::uint32_t k = 0; k < 3; ++k) data.vertices[3 * i + k] = at + any.point(0.1);
  }
  const auto moved = mesh.refit(data.vertices);
  CHECK(moved->is_consistent());
  CHECK(moved->texture(7, {0.25, 0.25, 0.5}) == Vec2{0.25, 0.5});
  CHECK(double(moved->memory()) == doctest::Approx(double(before)).epsilon(0.2));
  require_same(*moved, data, any, 10);
}

TEST_CASE("a floor that is raised is met where it is, and the mesh before where it was") {
  DeformingMesh floor(
      {.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, .triangles = {{0, 1, 2}, {0, 2, 3}}});
  const auto range = [](const Mesh& mesh) {
    const RayBundle rays = bundle_of({{0.2, 0.1, 10}, {0, 0, -1}});
    ClosestHits nearest(rays);
    mesh.closest(rays, nearest);
    return nearest.range[0];
  };
  const std::shared_ptr<const Mesh> before = floor.mesh();
  const std::vector<Vec3> raised{{-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}},
      higher{{-1, -1, 3}, {1, -1, 3}, {1, 1, 3}, {-1, 1, 3}};
  CHECK(range(*floor.refit(raised)) == 8);
  CHECK(range(*before) == 10);
  CHECK(range(*floor.refit(higher)) == 7);
  CHECK(range(*floor.mesh()) == 7);
  CHECK(range(*before) == 10);
}

TEST_CASE("a refitted mesh meets what a new mesh of the same triangles meets") {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const double reach = any.log_uniform(1, 1e4);
    MeshData data = seed % 2 ? support::soup(any, 1 + any.whole(800), reach) : support::icosphere(3);
    if (seed % 3 == 0)
      for (std::size_t i = 0; i < data.triangles.size(); ++i)
        data.materials.push_back(static_cast<std::uint32_t>(any.whole(300)));
    DeformingMesh mesh(data, 1);
    require_same(*mesh.mesh(), data, any, reach);
    for (int step = 0; step < 4; ++step) {  // the last tears the mesh apart
      for (Vec3& vertex : data.vertices) vertex = vertex + any.point(step == 3 ? 10 * reach : 0.01);
      mesh.refit(data.vertices);
      require_same(*mesh.mesh(), data, any, reach);
    }
  }
}

TEST_CASE("vertices that begin at one place may part") {
  MeshData data;
  support::add_triangle(data, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  support::add_triangle(data, {{1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
  DeformingMesh mesh(data, 1);
  for (std::size_t i = 3; i < 6; ++i) data.vertices[i].z += 5;
  mesh.refit(data.vertices);
  CHECK(mesh.mesh()->triangle(0).b == Vec3{1, 0, 0});
  CHECK(mesh.mesh()->triangle(1).a == Vec3{1, 0, 5});
}

TEST_CASE("a mesh of several blocks is refitted") {
  Generator any(3);
  MeshData data =
      support::net(150, [](std::uint32_t, std::uint32_t) { return 0.0; });  // 45,000 triangles, three blocks
  DeformingMesh mesh(data, 1);
  for (Vec3& vertex : data.vertices) vertex.z = any.uniform();
  mesh.refit(data.vertices);
  require_same(*mesh.mesh(), data, any, 150);
}

TEST_CASE("a mesh that loses its shape is built anew, and one that keeps it is not") {
  Generator any(4);
  MeshData data = support::icosphere(4);
  DeformingMesh mesh(data, 1);
  const std::vector<PrimitiveIndex> order(mesh.mesh()->index().order().begin(), mesh.mesh()->index().order().end());
  const auto same_order = [&] { return std::equal(order.begin(), order.end(), mesh.mesh()->index().order().begin()); };
  for (Vec3& vertex : data.vertices) vertex = 1.1 * vertex;
  mesh.refit(data.vertices);
  CHECK(same_order());
  for (Vec3& vertex : data.vertices) vertex = any.point(1);
  mesh.refit(data.vertices);
  CHECK_FALSE(same_order());
  CHECK(BvhRefit<float>::cost(mesh.mesh()->index()) == BvhRefit<float>::cost(Mesh(data, 1).index()));
}

TEST_CASE("refits of a mesh that no one else holds allocate nothing after the second") {
  MeshData data = support::icosphere(3);
  DeformingMesh mesh(data, 1);
  std::size_t before = 0;
  for (int tick = 0; tick < 6; ++tick) {
    if (tick == 2) before = support::allocations;
    for (Vec3& vertex : data.vertices) vertex.z += 0.1;
    mesh.refit(data.vertices);
  }
  CHECK(support::allocations == before);
}

TEST_CASE("vertices of another number, or out of range, are refused, and the mesh stays") {
  DeformingMesh mesh({.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}}, .triangles = {{0, 1, 2}}});
  const auto before = mesh.mesh();
  std::vector<Vec3> vertices(3);
  CHECK_THROWS_WITH_AS(mesh.refit(vertices), "DeformingMesh::vertices (number) is 3, but must be from 4 to 4",
                       SettingError);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, std::numeric_limits<double>::infinity(), 2e18}) {
    vertices = {{0, 0, 0}, {1, bad, 0}, {0, 1, 0}, {9, 9, 9}};
    CHECK_THROWS_WITH_AS(mesh.refit(vertices),
                         doctest::Contains(("DeformingMesh::vertices is " + text::to_text(bad) +
                                            " m, but must be finite and within 1e18 m of the origin; see vertex 1")
                                               .c_str()),
                         SettingError);
    CHECK(mesh.mesh() == before);
  }
  vertices = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {nan, 9, 9}};  // in no triangle
  CHECK(mesh.refit(vertices)->triangle(0).a.z == 1);
}

TEST_CASE("copies of meshes stay as they are, whatever is refitted") {
  MeshData data = support::icosphere(3);
  const MeshData first = data;
  Generator any(6);
  DeformingMesh mesh(data, 1);
  std::vector<MeshData> steps;
  std::vector<Mesh> copies;
  for (int step = 0; step < 6; ++step) {
    for (std::size_t i = 0; i < data.vertices.size(); ++i)
      data.vertices[i] = first.vertices[i] + Vec3{3.0 * step, 0, 0};
    steps.push_back(data);
    copies.push_back(*mesh.refit(data.vertices));
  }
  for (std::size_t step = 0; step < steps.size(); ++step) require_same(copies[step], steps[step], any, 10);
}

TEST_CASE("the user's threads build a mesh, at first and anew, which is the same on any") {
  support::CountingExecutor executor;
  Generator any(7);
  MeshData data = support::soup(any, 10'000, 10);
  DeformingMesh mesh(data, executor);
  CHECK(executor.calls() > 0);
  require_same(*mesh.mesh(), data, any, 10);
  mesh.refit(data.vertices, executor);
  CHECK(executor.calls() == 0);
  for (Vec3& vertex : data.vertices) vertex = any.point(100);  // torn apart
  mesh.refit(data.vertices, executor);
  CHECK(executor.calls() > 0);
  require_same(*mesh.mesh(), data, any, 100);
}
