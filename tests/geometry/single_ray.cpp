// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/geometry/single_ray.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <pulsecast/accel/bvh.hpp>
#include <pulsecast/accel/kd_tree.hpp>
#include <pulsecast/accel/linear.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/scenes.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

static_assert(sizeof(SingleRayPacket) == 104);
static_assert(sizeof(SingleRayPacket) + sizeof(ClosestHit) == 128);
static_assert(sizeof(AllHits) <= 600);
static_assert(!BundleTarget<TriangleMesh<>> && Geometry<TriangleMesh<>>);  // a shape is no scene

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Ray 0 of a bundle, by itself.
SingleRayPacket only_ray(const RayBundle& rays) {
  SingleRayPacket ray(Ray{.origin = rays.origin, .direction = rays.direction(0), .near = rays.near});
  ray.direction_length = rays.direction_length;
  return ray;
}

std::uint64_t bits(double number) { return std::bit_cast<std::uint64_t>(number); }

/// All hits of a mesh, each triangle asked by itself.
std::vector<AllHits::Entry> every_triangle(const MeshData& data, const SingleRayPacket& ray, double far) {
  std::vector<AllHits::Entry> all;
  for (std::size_t i = 0; i < data.triangles.size(); ++i) {
    ClosestHit hit(far);
    intersect(data.triangle(i), static_cast<PrimitiveIndex>(i), ray, hit);
    if (hit.met(0)) all.push_back({hit.range[0], hit.id[0]});
  }
  std::sort(all.begin(), all.end());
  return all;
}

template <class Mesh>
std::vector<AllHits::Entry> all_hits(const Mesh& mesh, SingleRayPacket ray, double far) {
  std::vector<AllHits::Entry> all;
  AllHits buffer(ray.near, far);
  for (;;) {
    mesh.closest(ray, buffer);
    all.insert(all.end(), buffer.hits().begin(), buffer.hits().end());
    if (!buffer.full()) return all;
    ray.near = buffer.continue_after();
  }
}

struct Counts {
  std::size_t met = 0, several = 0, closest = 0, any = 0, all = 0;  ///< the last three: differences
};

template <class Index>
void compare_single(const MeshData& data, const TriangleMesh<Linear<>>& believed, std::uint64_t seed, int rays_asked,
                    Counts& counts) {
  const TriangleMesh<Index> mesh(data);
  Generator random(seed);
  for (int k = 0; k < rays_asked; ++k) {
    const RayBundle rays = bundle(random, data, believed.bounds(), 1);
    const SingleRayPacket ray = only_ray(rays);
    ClosestHits expected(rays);
    believed.closest(rays, expected);
    ClosestHit found(rays.far);
    mesh.closest(ray, found);
    counts.met += expected.met(0) ? 1U : 0U;
    if (bits(found.range[0]) != bits(expected.range[0]) || found.id[0] != expected.id[0]) ++counts.closest;
    AnyHit any(rays.far);
    mesh.closest(ray, any);
    if (any.found != expected.met(0)) ++counts.any;
    const auto every = every_triangle(data, ray, rays.far);
    counts.several += every.size() > 1 ? 1U : 0U;
    if (all_hits(mesh, ray, rays.far) != every) ++counts.all;
  }
}

}  // namespace

TEST_CASE(
    "a ray alone meets what a bundle of one meets, bit for bit, in every accelerator, and all of its triangles in "
    "order") {
  Generator random(31);
  std::uint64_t seed = 310;
  std::size_t several = 0;
  for (const MeshData& data :
       {soup(random, 300, 10), doubled(soup(random, 100, 10)), slivers(random, 200, 10), doubled(plane(8)),
        walls(random, 200, 8), moved(soup(random, 200, 100), {4.7e5, 5.4e6, 300})}) {
    ++seed;
    CAPTURE(seed);
    const TriangleMesh<Linear<>> believed(data);
    Counts counts;
    compare_single<Linear<>>(data, believed, seed, 500, counts);
    compare_single<Bvh<float>>(data, believed, seed, 2000, counts);
    compare_single<Bvh<double>>(data, believed, seed, 500, counts);
    compare_single<KdTree<float>>(data, believed, seed, 500, counts);
    compare_single<KdTree<double>>(data, believed, seed, 500, counts);
    CHECK(counts.met > 1000);
    several += counts.several;
    CHECK(counts.closest == 0);
    CHECK(counts.any == 0);
    CHECK(counts.all == 0);
  }
  CHECK(several > 3000);
}

TEST_CASE("a buffer holds the closest hits in order, each once, and continues after the last") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const double near = static_cast<double>(random.whole(4)),
                 far = random.coin() ? infinity : static_cast<double>(random.whole(60));
    std::vector<AllHits::Entry> offered, expected, found;
    for (std::uint64_t n = random.whole(150); offered.size() < n;)
      offered.push_back({static_cast<double>(random.whole(60)), random.whole(4) << 32 | random.whole(3)});
    for (const auto& hit : offered)
      if (hit.range > near && hit.range <= far) expected.push_back(hit);
    std::sort(expected.begin(), expected.end());
    expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
    AllHits buffer(near, far);
    for (;;) {
      for (const auto& hit : offered) {
        buffer.part = hit.id >> 32 << 32;
        buffer.offer(0, hit.range, static_cast<PrimitiveIndex>(hit.id));
      }
      found.insert(found.end(), buffer.hits().begin(), buffer.hits().end());
      if (!buffer.full()) break;
      const double from = buffer.continue_after();
      CHECK(from < found.back().range);
      CHECK(std::nextafter(from, infinity) == found.back().range);
    }
    CHECK(found == expected);
  }
}

TEST_CASE("a shape whose hits are random is asked from the ray's beginning, also when a full buffer continues") {
  Ray ray;
  ray.near = 2;
  SingleRayPacket asked(ray);
  AllHits buffer(2, 100);
  for (std::size_t k = 0; k < AllHits::capacity; ++k) buffer.offer(0, 3 + static_cast<double>(k), 1);
  asked.near = buffer.continue_after();
  REQUIRE(asked.near > 30);
  double from = 0, to = 0;
  buffer.offer_first(asked, [&](const SingleRayPacket& sent, ClosestHit& first) {
    from = sent.near;
    to = first.range[0];
    first.offer(0, 50, 7);
  });
  CHECK(from == 2);
  CHECK(to == 100);
  REQUIRE(buffer.hits().size() == 1);
  CHECK(buffer.hits()[0] == AllHits::Entry{50, 7});
}

TEST_CASE("a search for any hit ends at the first, and counts none beyond its range") {
  AnyHit any(5);
  any.offer(0, 6, 1);
  CHECK_FALSE(any.done());
  CHECK(any.limit_of(0) == 5);
  any.offer(0, 5, 1);
  CHECK(any.done());
  CHECK(any.limit({}) == -infinity);
}

TEST_CASE("a bundle made of a single ray is that ray, and the other way round") {
  const Ray ray{{1, 2, 3}, {0, 0, 1}, 4, 5, {6, 0.5}, 7, 8, 9};
  const RayBundle rays = bundle_of(SingleRayPacket(ray), 5);
  const Ray back = rays.ray(0);
  CHECK(back.origin == ray.origin);
  CHECK(back.direction == ray.direction);
  CHECK(back.near == 4);
  CHECK(back.far == 5);
  CHECK(back.tick == ray.tick);
  CHECK(back.seed == 7);
  CHECK(back.pulse == 8);
  CHECK(back.subray == 9);
}
