// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/concepts.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/generators.hpp"

/// Scenes of triangles, well-behaved and degenerate, and rays that look for trouble in them.
namespace pulsecast::support {

/// The unit ball about the origin, met at both sides; it takes bundles only.
class UnitBall {
 public:
  const Box& bounds() const noexcept { return bounds_; }
  std::size_t memory() const noexcept { return 0; }
  std::size_t material_count() const noexcept { return 1; }
  void closest(const RayBundle& rays, ClosestHits& nearest) const noexcept {
    for (std::size_t j = 0; j < rays.size; ++j) {
      const double a = rays.direction_length * rays.direction_length, b = dot(rays.origin, rays.direction(j));
      const double root = b * b - a * (dot(rays.origin, rays.origin) - 1);
      if (!(root >= 0)) continue;
      for (const double range : {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a})
        if (range > rays.near && range <= rays.far) nearest.offer(j, range, 0);
    }
  }
  SurfaceInteraction surface(PrimitiveIndex, const RayBundle& rays, std::size_t j) const noexcept {
    ClosestHits nearest(rays);
    closest(rays, nearest);
    return {normalize(rays.origin + nearest.range[j] * rays.direction(j)), 0};
  }

 private:
  Box bounds_{{-1, -1, -1}, {1, 1, 1}};
};
static_assert(Geometry<UnitBall>);

using Corners = std::array<std::uint32_t, 3>;

inline void add_triangle(MeshData& mesh, const Triangle& t) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {t.a, t.b, t.c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// Triangles anywhere within reach, of sizes from a thousandth of it to all of it.
[[nodiscard]] inline MeshData soup(Generator& random, std::size_t triangles, double reach) {
  MeshData mesh;
  for (std::size_t i = 0; i < triangles; ++i) {
    const double size = random.log_uniform(1e-3 * reach, reach);
    const Vec3 at = random.point(reach), b = random.point(size), c = random.point(size);
    add_triangle(mesh, {at, at + b, at + c});
  }
  return mesh;
}

/// Long triangles whose third corner lies almost, or quite, on the line through the others.
[[nodiscard]] inline MeshData slivers(Generator& random, std::size_t triangles, double reach) {
  MeshData mesh;
  for (std::size_t i = 0; i < triangles; ++i) {
    const Vec3 a = random.point(reach), b = random.point(reach);
    const double width = random.coin() ? random.log_uniform(1e-14, 1e-2) * reach : 0;
    const double where = random.uniform();
    add_triangle(mesh, {a, b, a + (b - a) * where + random.point(width)});
  }
  return mesh;
}

/// Every triangle twice, the second time turned over.
[[nodiscard]] inline MeshData doubled(MeshData mesh) {
  const std::size_t n = mesh.triangles.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Corners t = mesh.triangles[i];
    mesh.triangles.push_back({t[1], t[0], t[2]});
  }
  return mesh;
}

/// A net of cells x cells squares of side 1, each of two triangles, `height(x, y)` above the plane z = 0.
template <class Height>
[[nodiscard]] MeshData net(std::uint32_t cells, Height height) {
  MeshData mesh;
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x) mesh.vertices.push_back({double(x), double(y), height(x, y)});
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * (cells + 1) + x, c = a + cells + 1;
      mesh.triangles.push_back({a, a + 1, c + 1});
      mesh.triangles.push_back({a, c + 1, c});
    }
  return mesh;
}

[[nodiscard]] inline MeshData plane(std::uint32_t cells) {
  return net(cells, [](std::uint32_t, std::uint32_t) { return 0.0; });
}

/// Right-angled triangles that each lie in an axis plane, their corners on whole numbers.
[[nodiscard]] inline MeshData walls(Generator& random, std::size_t triangles, double reach) {
  MeshData mesh;
  for (std::size_t i = 0; i < triangles; ++i) {
    const Vec3 p = random.point(reach);
    const Vec3 a{std::round(p.x), std::round(p.y), std::round(p.z)};
    const int k = static_cast<int>(random.whole(3));
    Vec3 b = a, c = a;
    b[(k + 1) % 3] += 1 + double(random.whole(4));
    c[(k + 2) % 3] += 1 + double(random.whole(4));
    add_triangle(mesh, {a, b, c});
  }
  return mesh;
}

/// Two fans of needles on one rim, closed: all triangles meet in two points.
[[nodiscard]] inline MeshData spindle(std::uint32_t needles, double radius, double height) {
  MeshData mesh;
  mesh.vertices = {{0, 0, height}, {0, 0, -height}};
  for (std::uint32_t i = 0; i < needles; ++i) {
    const double turn = 2 * pi * i / needles;
    mesh.vertices.push_back({radius * std::cos(turn), radius * std::sin(turn), 0});
    const std::uint32_t here = 2 + i, next = 2 + (i + 1) % needles;
    mesh.triangles.push_back({0, here, next});
    mesh.triangles.push_back({1, next, here});
  }
  return mesh;
}

/// A sphere of radius 1 from an icosahedron whose triangles were quartered `levels` times.
[[nodiscard]] inline MeshData icosphere(int levels) {
  const double t = (1 + std::sqrt(5.0)) / 2;
  MeshData mesh;
  for (const Vec3 v : {Vec3{-1, t, 0},
                       {1, t, 0},
                       {-1, -t, 0},
                       {1, -t, 0},
                       {0, -1, t},
                       {0, 1, t},
                       {0, -1, -t},
                       {0, 1, -t},
                       {t, 0, -1},
                       {t, 0, 1},
                       {-t, 0, -1},
                       {-t, 0, 1}})
    mesh.vertices.push_back(normalize(v));
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> halves;
    const auto half = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, made] =
          halves.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (made) mesh.vertices.push_back(normalize(mesh.vertices[a] + mesh.vertices[b]));
      return found->second;
    };
    std::vector<Corners> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = half(a, b), bc = half(b, c), ca = half(c, a);
      for (const Corners& quarter : {Corners{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})
        finer.push_back(quarter);
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

/// A closed block of ground: bumpy above, flat below, of cells x cells squares of side 1 and of heights in [1, 2] over
/// its floor at z = -5.
[[nodiscard]] inline MeshData block(Generator& random, std::uint32_t cells) {
  MeshData mesh = net(cells, [&](std::uint32_t, std::uint32_t) { return random.uniform(1, 2); });
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  const std::size_t top = mesh.triangles.size();
  for (std::uint32_t i = 0; i < n; ++i) mesh.vertices.push_back({mesh.vertices[i].x, mesh.vertices[i].y, -5});
  for (std::size_t i = 0; i < top; ++i) {
    const Corners t = mesh.triangles[i];
    mesh.triangles.push_back({t[1] + n, t[0] + n, t[2] + n});
  }
  const auto wall = [&](std::uint32_t a, std::uint32_t b) {
    mesh.triangles.push_back({a, b, b + n});
    mesh.triangles.push_back({a, b + n, a + n});
  };
  const std::uint32_t row = cells + 1;
  for (std::uint32_t i = 0; i < cells; ++i) {
    wall(i, i + 1);
    wall(cells * row + i, cells * row + i + 1);
    wall(i * row, (i + 1) * row);
    wall(i * row + cells, (i + 1) * row + cells);
  }
  return mesh;
}

[[nodiscard]] inline MeshData scaled(MeshData mesh, double factor) {
  for (Vec3& v : mesh.vertices) v = v * factor;
  return mesh;
}

[[nodiscard]] inline MeshData moved(MeshData mesh, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v = v + by;
  return mesh;
}

/// Where trouble is: a corner, the middle of an edge, a point on an edge, or a point inside a triangle.
[[nodiscard]] inline Vec3 target(Generator& random, const MeshData& mesh) {
  const Triangle t = mesh.triangle(random.whole(mesh.triangles.size()));
  const std::uint64_t kind = random.whole(4);
  if (kind == 0) return t.a;
  if (kind == 1) return (t.a + t.b) * 0.5;
  const double u = random.uniform();
  if (kind == 2) return t.b + (t.c - t.b) * u;
  const double v = random.uniform(0, 1 - u);
  return t.a + (t.b - t.a) * u + (t.c - t.a) * v;
}

/// A bundle of every kind that there is: narrow and wide, near and far, along an axis, aimed at corners and edges, cut
/// off before and behind, with directions of any length, and now and then with a ray that is not a number.
[[nodiscard]] inline RayBundle bundle(Generator& random, const MeshData& mesh, const Box& bounds, std::size_t size) {
  const Vec3 half = bounds.size() * 0.5;
  const double reach = max_norm(half);
  const double distance = random.coin() ? 1 : random.log_uniform(1e-2, 1e2);
  const Vec3 aim = target(random, mesh);
  Vec3 origin = bounds.centre() + random.point(reach * distance);
  Vec3 axis{};
  if (random.whole(5) == 0) {  // along an axis, straight at the target
    axis[static_cast<int>(random.whole(3))] = random.coin() ? 1 : -1;
    origin = aim - axis * (reach * distance);
  } else {
    axis = random.whole(4) == 0 ? random.unit() : normalize(aim - origin);
    if (random.whole(8) == 0) origin = aim - axis * reach * random.log_uniform(1e-9, 1);
  }
  static constexpr double angles[] = {0, 1e-7, 1e-4, 1e-2, 3};
  RayBundle rays = random.cone(origin, axis, angles[random.whole(5)], size);
  if (random.whole(4) == 0)  // every ray at a target of its own
    for (std::size_t j = 0; j < size; ++j) rays.set_direction(j, normalize(target(random, mesh) - origin));
  if (random.whole(4) == 0) rays.near = length(aim - origin) * random.uniform(0, 1.1);
  if (random.whole(4) == 0) rays.far = length(aim - origin) * random.uniform(0.9, 2);
  if (random.whole(4) == 0) {
    rays.direction_length = random.log_uniform(1e-2, 1e2);
    for (std::size_t j = 0; j < size; ++j) rays.set_direction(j, rays.direction(j) * rays.direction_length);
  }
  if (random.whole(8) == 0) {  // all but along a plane of two axes
    static constexpr double slight[] = {0, -0.0, 1e-300, -1e-300, 1e-40, -1e-40, 1e-20, -1e-20, 1e-12};
    RayBundle::Column* const columns[] = {&rays.x, &rays.y, &rays.z};
    const double component = slight[random.whole(9)] * rays.direction_length;
    RayBundle::Column& column = *columns[random.whole(3)];
    for (std::size_t j = 0; j < size; ++j) column[j] = component;
  }
  if (random.whole(50) == 0) rays.x[random.whole(size)] = std::numeric_limits<double>::quiet_NaN();
  rays.pad();
  return rays;
}

/// How often geometries answered otherwise than the one that is believed.
struct Comparison {
  std::uint64_t rays = 0, met = 0, different = 0;
  std::string first;  ///< the first difference, in words
};

/// Asks two geometries for the same bundle, and counts the rays whose answers differ in any bit.
template <Geometry Believed, Geometry Other>
void compare(const Believed& believed, const Other& other, const char* name, const RayBundle& rays,
             Comparison& result) {
  ClosestHits expected(rays), found(rays);
  believed.closest(rays, expected);
  other.closest(rays, found);
  for (std::size_t j = 0; j < rays.size; ++j) {
    ++result.rays;
    result.met += expected.met(j) ? 1 : 0;
    if (std::bit_cast<std::uint64_t>(expected.range[j]) == std::bit_cast<std::uint64_t>(found.range[j]) &&
        expected.id[j] == found.id[j])
      continue;
    if (++result.different > 1) continue;
    std::ostringstream text;
    text.precision(17);
    text << name << ": ray " << j << " of " << rays.size << " from " << rays.origin.x << ' ' << rays.origin.y << ' '
         << rays.origin.z << " along " << rays.x[j] << ' ' << rays.y[j] << ' ' << rays.z[j] << " met " << found.id[j]
         << " at " << found.range[j] << " instead of " << expected.id[j] << " at " << expected.range[j];
    result.first = text.str();
  }
}

/// Rays from an inner point that met nothing, although the mesh around it is closed.
template <Geometry G>
[[nodiscard]] std::uint64_t escaped(const G& mesh, const RayBundle& rays) {
  ClosestHits nearest(rays);
  mesh.closest(rays, nearest);
  std::uint64_t count = 0;
  for (std::size_t j = 0; j < rays.size; ++j) count += nearest.met(j) ? 0 : 1;
  return count;
}

/// Rays from one point into all octants, to every box that there is.
[[nodiscard]] inline RayBundle all_around(const Vec3& origin) {
  RayBundle rays;
  rays.origin = origin;
  rays.size = 8;
  for (std::size_t j = 0; j < 8; ++j)
    rays.set_direction(j, normalize(Vec3{j & 1 ? 1.0 : -1.0, j & 2 ? 1.0 : -1.0, j & 4 ? 1.0 : -1.0}));
  rays.pad();
  return rays;
}

/// How often a tree offers each of n primitives to rays that reach everything; `largest` is set to the most offered at
/// once.
template <Accelerator A>
[[nodiscard]] std::vector<std::size_t> offers(const A& tree, std::size_t n, std::size_t& largest) {
  std::vector<std::size_t> count(n);
  const RayBundle rays = all_around(tree.bounds().empty() ? Vec3{} : tree.bounds().centre());
  ClosestHits nearest(rays);
  largest = 0;
  const auto test = [&](std::span<const PrimitiveIndex> primitives) {
    largest = std::max(largest, primitives.size());
    for (const PrimitiveIndex i : primitives) ++count[i];
  };
  tree.closest(rays, test, nearest);
  return count;
}

/// A tree of one node with this number of copies of it, then changed: `change(nodes)`.
template <Accelerator A, class Change>
[[nodiscard]] A with_nodes(A tree, std::size_t count, const Change& change) {
  const auto replace = [&]<class Member>(Member& member) {
    if constexpr (
        requires { member[0].first[0]; } || requires { member[0].first(); }) {
      std::vector<typename Member::value_type> nodes(count, member[0]);
      change(nodes);
      member = Member(std::move(nodes));
    }
  };
  auto each = [&](auto&... members) { (replace(members), ...); };
  tree.archive(each);
  return tree;
}

/// Small boxes that crowd at the origin, each a fraction of the size and distance of the one before, on both sides: a
/// build that cuts space evenly peels them off one by one.
[[nodiscard]] inline std::vector<Box> crowd(std::size_t n, double fraction) {
  std::vector<Box> boxes;
  double x = 1;
  for (std::size_t i = 0; i < n; ++i, x *= fraction)
    for (const double side : {-1.0, 1.0}) {
      const Vec3 centre{side * x, side * x, side * x}, half = Vec3(0.1 * x);
      boxes.push_back({centre - half, centre + half});
    }
  return boxes;
}

}  // namespace pulsecast::support
