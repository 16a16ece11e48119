// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Triangles of every size and shape, and very many of them in one place.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "extremes/meshes.hpp"
#include "extremes/row.hpp"
#include "support/double_double.hpp"
#include "support/generators.hpp"
#include "support/scenes.hpp"

#if defined(__SANITIZE_ADDRESS__)
#define PULSECAST_TEST_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PULSECAST_TEST_SANITIZED
#endif
#endif

using namespace pulsecast;
using namespace pulsecast::extremes;
using namespace pulsecast::support;

namespace {

const std::string quantity = "triangle";

/// Rays at triangles from up to so many times their size away.
void shoot(const MeshData& data, double size, double farthest, Generator& random, Verdict& verdict,
           Comparison& others) {
  const Meshes meshes(data);
  for (int time = 0; time < 200; ++time) {
    RayBundle rays;
    rays.origin = target(random, data) + random.unit() * (size * random.log_uniform(1, farthest));
    rays.size = random.coin() ? 1 : 8;
    for (std::size_t j = 0; j < rays.size; ++j)
      rays.set_direction(j, normalize(target(random, data) + random.point(random.coin() ? 0 : size) - rays.origin));
    rays.pad();
    judge(meshes.linear, data, rays, verdict);
    meshes.compare(rays, others);
  }
}

/// A needle with two long sides, or with a blunt corner between them: from a point along u, its width along v.
Triangle needle(Generator& random, double longest, double aspect) {
  const Vec3 a = random.point(longest), u = random.unit(), v = normalize(cross(u, random.unit()));
  const double where = random.coin() ? 1 : random.uniform();
  return {a, a + u * longest, a + u * (longest * where) + v * (longest / aspect)};
}

struct Answer {
  double range;
  PrimitiveIndex primitive;
};
template <Geometry G>
Answer ask(const G& mesh, const Ray& ray) {
  const RayBundle rays = bundle_of(ray);
  ClosestHits nearest(rays);
  mesh.closest(rays, nearest);
  return {nearest.range[0], nearest.primitive_of(0)};
}

/// A slope of squares of side 1, cut in two by the diagonal: z = x / 2.
MeshData slope(std::uint32_t cells) {
  return net(cells, [](std::uint32_t x, std::uint32_t) { return 0.5 * x; });
}

/// The first triangle of such a slope that a place belongs to: of those around a corner or along an edge, that in the
/// row before, or else in the column before.
PrimitiveIndex first_of(std::uint32_t cells, double x, double y) {
  double column = std::floor(x), row = std::floor(y);
  if (y == row && row > 0) --row;
  if (x == column && column > 0) --column;
  return static_cast<PrimitiveIndex>(2 * (row * cells + column) + (x - column >= y - row ? 0 : 1));
}

/// Straight down onto the slope, at its corners, on its edges and between them.
template <Geometry G>
std::size_t wrong_on_slope(const G& mesh, std::uint32_t cells, int times) {
  Generator random(8330);
  std::size_t wrong = 0;
  for (int time = 0; time < times; ++time) {
    const auto at = [&] {
      return 0.125 * static_cast<double>(random.coin() ? 8 * random.whole(cells) + 8 : random.whole(8ULL * cells));
    };
    const double x = at(), y = random.whole(4) == 0 ? x : at();
    const Answer answer = ask(mesh, {{x, y, 2.0 * cells}, -axis::up});
    wrong += answer.range == 2.0 * cells - 0.5 * x && answer.primitive == first_of(cells, x, y) ? 0 : 1;
  }
  return wrong;
}

}  // namespace

TEST_CASE("triangles of any size") {
  std::uint64_t seed = 8300;
  for (const char* side : {"1e-7", "1e-3", "1", "1e3", "1e6"}) {
    CAPTURE(side);
    CAPTURE(++seed);
    Generator random(seed);
    const double size = std::stod(side);
    MeshData data;
    for (int i = 0; i < 40; ++i) {
      const Vec3 at = random.point(5 * size);
      add_triangle(data, {at, at + random.unit() * size, at + random.unit() * size});
    }
    Verdict verdict;
    Comparison others;
    shoot(data, size, 1e9, random, verdict, others);
    check(verdict, others);
    row(quantity,
        "sides of " + std::string(side) + " m, from 1 to 1e9 sides away: rays that do not answer as stated, of " +
            std::to_string(verdict.rays),
        0, static_cast<double>(verdict.wrong), 0);
  }
}

TEST_CASE("triangles of any aspect") {
  std::uint64_t seed = 8310;
  double worst = 0;
  for (const char* text : {"1e2", "1e4", "1e6", "1e8"}) {
    const double aspect = std::stod(text);
    CAPTURE(text);
    CAPTURE(++seed);
    Generator random(seed);
    MeshData data;
    for (int i = 0; i < 40; ++i) add_triangle(data, needle(random, 1, aspect));
    Verdict verdict;
    Comparison others;
    shoot(data, 1, 1e3, random, verdict, others);
    check(verdict, others);
    row(quantity,
        "needles 1 m long, aspect " + std::string(text) + ": rays that do not answer as stated, of " +
            std::to_string(verdict.rays),
        0, static_cast<double>(verdict.wrong), 0);
    const TriangleMesh<> mesh(data);
    for (PrimitiveIndex i = 0; i < 40; ++i) {
      const Triangle t = data.triangle(i);
      const Vec3 exact = normalize(Vec3(cross(ExactVec3(t.b, t.a), ExactVec3(t.c, t.a))));
      worst = std::max(worst, length(mesh.surface(i, bundle_of({}), 0).normal - exact) / aspect);
    }
  }
  row(quantity, "needles of these aspects: largest error of a normal [1e-15 rad of the aspect]", 0, worst * 1e15, 10);
}

TEST_CASE("triangles without area are never met, and hide nothing") {
  const std::uint64_t seed = 8320;
  CAPTURE(seed);
  Generator random(seed);
  MeshData flat;
  for (int i = 0; i < 100; ++i) {
    const auto whole = [&] {
      return Vec3{std::floor(random.uniform(-9, 9)), std::floor(random.uniform(-9, 9)),
                  std::floor(random.uniform(-9, 9))};
    };
    const Vec3 a = whole(), step = i % 3 == 0 ? Vec3{} : whole(), end = random.point(10);
    if (i % 4 == 0)
      add_triangle(flat, {{0, 0, 0}, end, end * random.uniform()});  // in line, but for roundings
    else
      add_triangle(flat, {a, a + step, i % 2 == 0 ? a + step : a + 3.0 * step});
  }
  MeshData good = soup(random, 30, 10), both = flat;
  for (std::size_t i = 0; i < good.triangles.size(); ++i) add_triangle(both, good.triangle(i));
  const Meshes degenerate(flat), mixed(both);
  const TriangleMesh<Linear<>> alone(good);
  std::size_t met = 0, other = 0;
  Comparison others;
  for (int time = 0; time < 2000; ++time) {
    const RayBundle rays = bundle(random, time % 2 == 0 ? flat : both, mixed.bvh.bounds(), random.coin() ? 1 : 19);
    ClosestHits none(rays), found(rays), expected(rays);
    degenerate.linear.closest(rays, none);
    mixed.linear.closest(rays, found);
    alone.closest(rays, expected);
    for (std::size_t j = 0; j < rays.size; ++j) {
      met += none.met(j) ? 1 : 0;
      other += found.range[j] == expected.range[j] || (rays.x[j] != rays.x[j]) ? 0 : 1;
    }
    degenerate.compare(rays, others);
    mixed.compare(rays, others);
  }
  INFO(others.first);
  CHECK(others.different == 0);
  row(quantity, "100 triangles without area: rays that meet one", 0, static_cast<double>(met), 0);
  row(quantity, "30 triangles among 100 without area: rays that do not meet them as without", 0,
      static_cast<double>(other), 0);
  CHECK(degenerate.bvh.surface(3, bundle_of({}), 0).normal == Vec3{});
}

TEST_CASE("very many triangles in one plane") {
#if defined(PULSECAST_TEST_SANITIZED)
  constexpr std::uint32_t many = 200, fewer = 100;
#else
  constexpr std::uint32_t many = 2237,
                          fewer =
                              708;  // 1e7 triangles where it takes seconds to build, 1e6 where it would take minutes
#endif
  const auto wrong = [](const std::string& what, std::uint32_t cells, const auto& mesh, int times) {
    row(quantity, what + ": rays at corners, edges and insides that do not meet the first triangle there", 0,
        static_cast<double>(wrong_on_slope(mesh, cells, times)), 0);
  };
  wrong("1e7 triangles in one plane, Bvh<float>", many, TriangleMesh<Bvh<>>(slope(many)), 100000);
  wrong("1e6 triangles in one plane, Bvh<double>", fewer, TriangleMesh<Bvh<double>>(slope(fewer)), 100000);
  wrong("1e6 triangles in one plane, KdTree<float>", fewer, TriangleMesh<KdTree<>>(slope(fewer)), 100000);
  wrong("1e6 triangles in one plane, KdTree<double>", fewer, TriangleMesh<KdTree<double>>(slope(fewer)), 100000);
  wrong("1e6 triangles in one plane, Linear", fewer, TriangleMesh<Linear<>>(slope(fewer)), 20);
}

TEST_CASE("one triangle very many times over") {
  const Triangle t{{0, 0, 0}, {4, 1, 0}, {1, 3, 2}}, beneath{{0, 0, -1}, {4, 1, -1}, {1, 3, 1}};
  MeshData data;
  data.vertices = {t.a, t.b, t.c, beneath.a, beneath.b, beneath.c};
  data.triangles.push_back({3, 4, 5});
  for (int i = 0; i < 100000; ++i) {
    Corners corners{0, 1, 2};
    std::rotate(corners.begin(), corners.begin() + i % 3, corners.end());
    if (i % 2 == 1) std::swap(corners[0], corners[1]);
    data.triangles.push_back(corners);
  }
  const Meshes meshes(data);
  Generator random(8340);
  std::size_t wrong = 0, asked = 0;
  Comparison others;
  for (int time = 0; time < 30; ++time) {
    const Vec3 at = t.a + (t.b - t.a) * random.uniform(0.1, 0.4) + (t.c - t.a) * random.uniform(0.1, 0.4);
    const RayBundle rays = bundle_of({at + Vec3{0, 0, 5}, -axis::up});
    meshes.compare(rays, others);
    const Answer first = ask(meshes.linear, rays.ray(0));
    ++asked;
    wrong += std::fabs(first.range - 5) < 1e-14 && first.primitive >= 1 ? 0 : 1;
  }
  INFO(others.first);
  CHECK(others.different == 0);
  row(quantity,
      "1e5 doubles of one triangle, and another beneath: rays that do not meet a double, of " + std::to_string(asked),
      0, static_cast<double>(wrong), 0);
  row(quantity, "1e5 doubles of one triangle: rays of which accelerators do not meet the same double", 0,
      static_cast<double>(others.different), 0);
  CHECK(meshes.bvh.index().depth() <= 64);
  CHECK(meshes.kd_tree.index().depth() <= 64);
}
