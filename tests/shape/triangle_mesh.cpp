// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/triangle_mesh.hpp>

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <pulsecast/accel/kd_tree.hpp>
#include <pulsecast/accel/linear.hpp>

#include "support/scenes.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

static_assert(Geometry<TriangleMesh<Linear<>>> && Geometry<TriangleMesh<KdTree<>>> &&
              Geometry<TriangleMesh<Bvh<double>>>);
static_assert(std::copyable<TriangleMesh<>>);

namespace {

/// What the refusal of mesh data says; empty if it is accepted.
std::string refusal(const MeshData& data) {
  try {
    const TriangleMesh<> mesh(data);
    return {};
  } catch (const SettingError& error) {
    return error.what();
  }
}

MeshData square() { return {{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}, {3, 1}}; }

}  // namespace

TEST_CASE("a mesh is met where its triangles are") {
  const TriangleMesh<> mesh(square());
  CHECK(mesh.size() == 2);
  CHECK(mesh.bounds() == Box{{0, 0, 0}, {2, 2, 0}});
  CHECK(mesh.memory() > 4 * sizeof(Vec3));
  CHECK(mesh.material_count() == 4);
  CHECK(mesh.triangle(1).c == Vec3{0, 2, 0});

  RayBundle rays = bundle_of({{1, 1, 5}, -axis::up});
  rays.size = 3;
  rays.set_direction(0, normalize(Vec3{0.5, -0.5, -5}));
  rays.set_direction(1, normalize(Vec3{-0.5, 0.5, -5}));
  rays.set_direction(2, normalize(Vec3{5, 5, -5}));
  rays.pad();
  ClosestHits nearest(rays);
  mesh.closest(rays, nearest);
  REQUIRE(nearest.met(0));
  REQUIRE(nearest.met(1));
  CHECK_FALSE(nearest.met(2));
  CHECK(nearest.primitive_of(0) == 0);
  CHECK(nearest.primitive_of(1) == 1);
  CHECK(nearest.range[0] == doctest::Approx(std::sqrt(25.5)).epsilon(1e-15));
  const SurfaceInteraction surface = mesh.surface(0, rays, 0);
  CHECK(surface.normal == axis::up);
  CHECK(surface.material_index == 3);
  CHECK(mesh.surface(1, rays, 1).material_index == 1);
}

TEST_CASE("a ray at the edge of two triangles meets the first") {
  const TriangleMesh<> mesh(square());
  const RayBundle rays = bundle_of({{1, 1, 5}, -axis::up});
  ClosestHits nearest(rays);
  mesh.closest(rays, nearest);
  CHECK(nearest.range[0] == 5);
  CHECK(nearest.primitive_of(0) == 0);
}

TEST_CASE("what an earlier part met is beaten only by what is nearer") {
  const TriangleMesh<> mesh(square());
  const RayBundle rays = bundle_of({{1, 0.5, 5}, -axis::up});
  ClosestHits nearest(rays);
  nearest.offer(0, 4, 77);
  nearest.part = std::uint64_t{1} << 32;
  mesh.closest(rays, nearest);
  CHECK(nearest.range[0] == 4);
  ClosestHits other(rays);
  other.offer(0, 6, 77);
  other.part = std::uint64_t{1} << 32;
  mesh.closest(rays, other);
  CHECK(other.range[0] == 5);
  CHECK(other.part_of(0) == 1);
}

TEST_CASE("without materials every triangle is of material 0") {
  MeshData data = square();
  data.materials.clear();
  const TriangleMesh<> mesh(data);
  CHECK(mesh.material_count() == 1);
  CHECK(mesh.surface(1, bundle_of({}), 0).material_index == 0);
}

TEST_CASE("a triangle without area has no normal and is never met") {
  const TriangleMesh<> mesh(MeshData{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}, {}});
  CHECK(mesh.surface(0, bundle_of({}), 0).normal == Vec3{0, 0, 0});
  const RayBundle rays = bundle_of({{1, 0, 5}, -axis::up});
  ClosestHits nearest(rays);
  mesh.closest(rays, nearest);
  CHECK_FALSE(nearest.met(0));
}

TEST_CASE("the normal of a very small or very large triangle is unit") {
  for (const double size : {1e-30, 1e-6, 1.0, 1e7, 1e15}) {
    const TriangleMesh<> mesh(MeshData{{{0, 0, 0}, {size, 0, 0}, {0, size, 0}}, {{0, 1, 2}}, {}});
    CAPTURE(size);
    CHECK(length(mesh.surface(0, bundle_of({}), 0).normal - axis::up) < 1e-12);
  }
}

TEST_CASE("a mesh that cannot be is refused") {
  CHECK(refusal(square()) == "");
  MeshData data = square();
  data.triangles[1][2] = 4;
  CHECK(refusal(data).find("see triangle 1") != std::string::npos);
  data = square();
  data.vertices[0].x = 1e19;
  CHECK(refusal(data).find("within 1e18 m") != std::string::npos);
}

TEST_CASE("a mesh that was built is sound, and one that was not filled is met by nothing") {
  CHECK(TriangleMesh<>(square()).is_consistent());
  const TriangleMesh<> none(DeserializeTag{});
  CHECK(none.is_consistent());
  CHECK(none.bounds().empty());
  const RayBundle rays = bundle_of({{1, 1, 5}, -axis::up});
  ClosestHits nearest(rays);
  none.closest(rays, nearest);
  CHECK_FALSE(nearest.met(0));
}

namespace {

/// A grid of so many by so many squares of two triangles each, with heights; each triangle has corners of its own.
MeshData torn_ground(std::uint32_t squares) {
  Generator random(70);
  const std::size_t side = squares + 1;
  std::vector<double> heights(side * side);
  for (double& height : heights) height = random.uniform(-0.3, 0.3);
  const auto point = [&](std::uint32_t x, std::uint32_t y) { return Vec3{0.1 * x, 0.1 * y, heights[y * side + x]}; };
  MeshData data;
  for (std::uint32_t y = 0; y < squares; ++y)
    for (std::uint32_t x = 0; x < squares; ++x)
      for (const std::uint32_t half : {0U, 1U}) {
        const auto first = static_cast<std::uint32_t>(data.vertices.size());
        for (const Vec3& corner : {point(x + half, y + half), point(x + 1, y), point(x, y + 1)})
          data.vertices.push_back(corner);
        data.triangles.push_back({first, first + 1, first + 2});
      }
  return data;
}

/// Bytes of the arrays of a mesh beside its index.
template <class Mesh>
std::vector<std::byte> bytes_of(Mesh mesh) {
  std::vector<std::byte> bytes;
  const auto add = [&](const auto& member) {
    if constexpr (requires { member.data(); }) {
      const auto all = std::as_bytes(std::span(member.data(), member.size()));
      bytes.insert(bytes.end(), all.begin(), all.end());
    }
  };
  auto each = [&](const auto&... members) { (add(members), ...); };
  mesh.archive(each);
  return bytes;
}

bool same_bits(const Triangle& a, const Triangle& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace

TEST_CASE_TEMPLATE("triangles of a mesh of several blocks keep their numbers and corners on any number of threads",
                   Mesh, TriangleMesh<>, TriangleMesh<KdTree<>>) {
  MeshData data = torn_ground(100);
  data.vertices[4].x = -0.0;
  data.vertices[5].x = 0.0;
  for (const unsigned threads : {1U, 3U}) {
    CAPTURE(threads);
    const Mesh mesh(data, threads);
    REQUIRE(mesh.size() == data.triangles.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i)
      different += same_bits(mesh.triangle(static_cast<PrimitiveIndex>(i)), data.triangle(i)) ? 0 : 1;
    CHECK(different == 0);
    CHECK(mesh.is_consistent());
    CHECK(bytes_of(mesh) == bytes_of(Mesh(data, 1)));
  }
}

TEST_CASE("corners that are equal are shared") {
  const MeshData data = torn_ground(100);
  const TriangleMesh<> mesh(data);
  const double bytes = static_cast<double>(mesh.memory() - mesh.index().memory()) / static_cast<double>(mesh.size());
  CAPTURE(bytes);
  CHECK(bytes <
        6 + 4 +
            0.6 * sizeof(Vec3));  // numbers, places, and half a corner a triangle, but for some at the ends of blocks
}

TEST_CASE("a mesh of up to 256 materials spends a byte on each, one of a single material none") {
  MeshData data = torn_ground(20);
  const std::size_t bare = TriangleMesh<>(data).memory();
  const auto with = [&](std::uint32_t count) {
    data.materials.resize(data.triangles.size());
    for (std::size_t i = 0; i < data.materials.size(); ++i)
      data.materials[i] = static_cast<std::uint32_t>(i * 7) % count;
    const TriangleMesh<> mesh(data);
    CHECK(mesh.material_count() == count);
    CHECK(mesh.is_consistent());
    std::size_t different = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i)
      different +=
          mesh.surface(static_cast<PrimitiveIndex>(i), bundle_of({}), 0).material_index == data.materials[i] ? 0 : 1;
    CHECK(different == 0);
    return mesh.memory();
  };
  CHECK(with(1) == bare);
  CHECK(with(2) == bare + data.triangles.size());
  CHECK(with(256) == bare + data.triangles.size());
  CHECK(with(257) == bare + 4 * data.triangles.size());
}

TEST_CASE("a broad bundle among many small triangles, which gives up, meets what its rays meet alone") {
  Generator random(77);
  MeshData leaves;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const Vec3 centre{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(0, 3)};
    for (int k = 0; k < 3; ++k) leaves.vertices.push_back(centre + 0.05 * random.unit());
    leaves.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const TriangleMesh<> mesh(leaves);
  const TriangleMesh<Linear<>> all(leaves);
  for (const std::size_t size : {std::size_t{2}, std::size_t{19}, RayBundle::capacity}) {
    RayBundle rays;
    rays.origin = {0.1, -0.2, 30};
    rays.size = size;
    for (std::size_t j = 0; j < size; ++j)
      rays.set_direction(j, normalize(Vec3{random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), -1}));
    rays.pad();
    ClosestHits nearest(rays), expected(rays);
    nearest.part = expected.part = std::uint64_t{5} << 32;
    mesh.closest(rays, nearest);
    all.closest(rays, expected);
    INFO("seed 77, ", size, " rays");
    for (std::size_t j = 0; j < size; ++j) {
      CHECK(nearest.range[j] == expected.range[j]);
      CHECK(nearest.id[j] == expected.id[j]);
    }
  }
}
