// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/accel/bvh.hpp>
#include <pulsecast/accel/kd_tree.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/scenes.hpp"

// No ray leaves a closed mesh, wherever it aims.

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

/// Rays in all; the environment variable PULSECAST_RAYS asks for another number.
std::uint64_t rays_asked() {
  const char* text = std::getenv("PULSECAST_RAYS");
  return text ? std::strtoull(text, nullptr, 10) : 500000;
}

struct Closed {
  std::string name;
  MeshData data;
  Vec3 centre;
  double room;  ///< half of a cube about the centre that lies inside [m]
};

std::vector<Closed> closed_meshes() {
  Generator random(30);
  std::vector<Closed> meshes{{"sphere", icosphere(3), {}, 0.5},
                             {"spindle of needles", spindle(1000, 5, 5), {}, 1},
                             {"flat spindle of needles", spindle(1000, 5, 1e-3), {}, 1e-4},
                             {"bumpy ground", block(random, 40), {20, 20, -2}, 2}};
  const std::size_t n = meshes.size();
  const Vec3 utm{4.7e5 + 1.0 / 3, 5.4e6 + 1.0 / 7, 300.1};
  for (std::size_t i = 0; i < n; ++i)
    meshes.push_back({meshes[i].name, moved(meshes[i].data, utm), meshes[i].centre + utm, meshes[i].room});
  return meshes;
}

RayBundle inside_out(Generator& random, const Closed& mesh, std::size_t size) {
  RayBundle rays;
  rays.origin = mesh.centre + random.point(mesh.room);
  rays.size = size;
  const bool narrow = random.coin();
  Vec3 aim = target(random, mesh.data);
  for (std::size_t j = 0; j < size; ++j) {
    if (!narrow) aim = target(random, mesh.data);
    const bool astray = random.whole(4) == 0;
    const double off = astray ? random.log_uniform(1e-17, 1) : 0;
    rays.set_direction(j, normalize(normalize(aim - rays.origin) + random.unit() * off));
  }
  rays.pad();
  return rays;
}

template <Geometry G>
void check(const G& shape, const Closed& mesh, std::uint64_t rays, std::uint64_t seed) {
  Generator random(seed);
  std::uint64_t sent = 0, lost = 0;
  while (sent < rays) {
    const RayBundle out = inside_out(random, mesh, random.coin() ? 64 : 1 + random.whole(19));
    lost += escaped(shape, out);
    sent += out.size;
  }
  CAPTURE(mesh.name);
  CAPTURE(mesh.centre.x);
  CAPTURE(seed);
  CHECK(lost == 0);
}

}  // namespace

TEST_CASE("no ray from inside a closed mesh gets out, at the origin or at map coordinates") {
  const std::vector<Closed> meshes = closed_meshes();
  const std::uint64_t each = rays_asked() / (4 * meshes.size()) + 1;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    check(TriangleMesh<Bvh<>>(meshes[i].data), meshes[i], each, 310 + i);
    check(TriangleMesh<Bvh<double>>(meshes[i].data), meshes[i], each, 320 + i);
    check(TriangleMesh<KdTree<>>(meshes[i].data), meshes[i], each, 330 + i);
    check(TriangleMesh<KdTree<double>>(meshes[i].data), meshes[i], each, 340 + i);
  }
}

TEST_CASE("the count of lost rays notices one missing triangle, and edges that do not quite meet") {
  Closed mesh{"sphere", icosphere(3), {}, 0.5};
  Generator random(35);
  const auto lost = [&](const MeshData& data) {
    const TriangleMesh<Bvh<>> shape(data);
    std::uint64_t count = 0;
    for (int time = 0; time < 300; ++time) count += escaped(shape, inside_out(random, mesh, 64));
    return count;
  };
  MeshData hole = mesh.data;
  hole.triangles.pop_back();
  CHECK(lost(hole) > 0);

  MeshData cracked;  // every triangle a billionth smaller
  for (std::size_t i = 0; i < mesh.data.triangles.size(); ++i) {
    const Triangle t = mesh.data.triangle(i);
    const Vec3 middle = (t.a + t.b + t.c) / 3.0;
    const auto inwards = [&](const Vec3& p) { return p + (middle - p) * 1e-9; };
    add_triangle(cracked, {inwards(t.a), inwards(t.b), inwards(t.c)});
  }
  CHECK(lost(cracked) > 0);
}
