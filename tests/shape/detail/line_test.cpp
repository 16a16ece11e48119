// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/detail/line_test.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool may_meet(const Triangle& triangle, const SingleRayPacket& ray, const Box& bounds) {
  return LineTest(ray, bounds).meet(TrianglePacket(1, [&](std::size_t) noexcept { return triangle; }), ray).possible !=
         0;
}

/// A triangle of any size and shape: some are thin, flat or turned edge on.
Triangle any_triangle(Generator& random, double scale) {
  Triangle t{random.point(scale), random.point(scale), random.point(scale)};
  const double size = random.log_uniform(1e-9, 1);
  t.b = t.a + size * (t.b - t.a);
  t.c = t.a + size * (t.c - t.a);
  if (random.whole(4) == 0)
    t.c = t.a + (t.b - t.a) * random.uniform() + random.point(size * scale * random.log_uniform(1e-15, 1e-2));
  if (random.whole(8) == 0) t.a.z = t.b.z = t.c.z;
  return t;
}

/// A point of the triangle, often at a corner or an edge, or beside one by some roundings.
Vec3 any_aim(Generator& random, const Triangle& t, double scale) {
  double u = random.uniform(), v = random.uniform(0, 1 - u);
  if (random.whole(3) == 0) u = 0;
  if (random.whole(3) == 0) v = 0;
  Vec3 aim = t.a + (t.b - t.a) * u + (t.c - t.a) * v;
  if (random.coin()) aim = aim + random.point(scale * random.log_uniform(1e-17, 1e-10));
  return aim;
}

}  // namespace

TEST_CASE("a line may meet what is ahead of a ray or behind it, and no triangle beside it") {
  const Triangle t{{-1, 5, -1}, {1, 5, -1}, {0, 5, 1}};
  const Box bounds = t.bounds();
  CHECK(may_meet(t, SingleRayPacket(Ray{}), bounds));
  CHECK(may_meet(t, SingleRayPacket(Ray{.direction = -axis::forward}), bounds));
  CHECK(may_meet({t.b, t.a, t.c}, SingleRayPacket(Ray{}), bounds));
  CHECK(may_meet(t, SingleRayPacket(Ray{.origin = {0, 0, 1}}), bounds));  // through a corner
  for (const Vec3& aside : {Vec3{2, 0, 0}, {-2, 0, 0}, {0, 0, 2}, {0, 0, -2}, {0.6, 0, 0.5}, {1e-9, 0, 1}})
    CHECK_FALSE(may_meet(t, SingleRayPacket(Ray{.origin = aside}), bounds));
}

TEST_CASE("each lane of a packet has its own bit, and idle lanes have that of the last triangle") {
  const Triangle ahead{{-1, 5, -1}, {1, 5, -1}, {0, 5, 1}}, beside{{9, 5, -1}, {11, 5, -1}, {10, 5, 1}};
  Box bounds = ahead.bounds();
  bounds.extend(beside.bounds());
  const SingleRayPacket ray;
  const LineTest line(ray, bounds);
  for (std::size_t met = 0; met < simd::lane_count; ++met) {
    const TrianglePacket packet(simd::lane_count, [&](std::size_t n) noexcept { return n == met ? ahead : beside; });
    CHECK(line.meet(packet, ray).possible == 1U << met);
  }
  CHECK(line.meet(TrianglePacket(1, [&](std::size_t) noexcept { return ahead; }), ray).possible ==
        (1U << simd::lane_count) - 1);
}

TEST_CASE("no hit is passed over, nor changed by sides known for certain: at any scale, near and far from the origin") {
  constexpr std::uint64_t seed = 88;
  CAPTURE(seed);
  Generator random(seed);
  long met = 0, passed = 0, spared = 0, certain = 0, other = 0;
  for (int time = 0; time < 300'000; ++time) {
    const double scale = random.log_uniform(1e-12, 1e12);
    const Vec3 place = random.coin() ? Vec3{} : random.point(scale * random.log_uniform(1, 1e7));
    Triangle t = any_triangle(random, scale);
    const Vec3 aim = any_aim(random, t, scale);
    const Vec3 origin =
        random.coin() ? random.point(scale) : aim + random.unit() * (scale * random.log_uniform(1e-9, 1e3));
    const auto moved = [&](const Vec3& p) { return p + place; };
    t = {moved(t.a), moved(t.b), moved(t.c)};
    SingleRayPacket ray(Ray{.origin = moved(origin), .direction = normalize(aim - origin)});
    if (random.whole(3) == 0) {
      ray.direction_length = random.log_uniform(1e-30, 1e30);
      ray.toward = ray.toward * ray.direction_length;
    }
    const PrimitiveIndex primitive = 0;
    const Box bounds = t.bounds();
    const TrianglePacket packet(1, [&](std::size_t) noexcept { return t; });
    const auto line = LineTest(ray, bounds).meet(packet, ray);
    ClosestHit hit(infinity), at_once(infinity);
    intersect(packet, {&primitive, 1}, ray, hit);
    met += hit.met(0) ? 1 : 0;
    passed += hit.met(0) && line.possible == 0 ? 1 : 0;
    if (line.certain != 0) {
      ++certain;
      intersect(packet, {&primitive, 1}, ray, at_once, pulsecast::detail::SolidEverywhere{}, line.certain);
      other += at_once.range != hit.range || at_once.id != hit.id ? 1 : 0;
    }
    const Vec3 aside = ray.toward + random.point(0.3 * ray.direction_length);
    ray.toward = aside * (ray.direction_length / length(aside));
    spared += may_meet(t, ray, bounds) ? 0 : 1;
  }
  CHECK(passed == 0);
  CHECK(other == 0);
  CHECK(met > 100'000);
  CHECK(spared > 100'000);
  CHECK(certain > 30'000);
}

TEST_CASE("what overflows or underflows passes") {
  for (const double scale : {1e-170, 1e-150, 1e150, 1e300}) {
    CAPTURE(scale);
    const Triangle t{{-scale, 5 * scale, -scale}, {scale, 5 * scale, -scale}, {0, 5 * scale, scale}};
    CHECK(may_meet(t, SingleRayPacket(Ray{}), t.bounds()));
    CHECK(may_meet(t, SingleRayPacket(Ray{.origin = {3 * scale, 0, 0}}), t.bounds()));
  }
}
