// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/geometry/triangle.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

const double no_number = std::numeric_limits<double>::quiet_NaN();

/// The range at which a ray meets a triangle.
std::optional<double> meets(const Triangle& t, const Ray& ray) {
  const RayBundle rays = bundle_of(ray);
  ClosestHits nearest(rays);
  intersect(t, 0, rays, nearest);
  if (!nearest.met(0)) return std::nullopt;
  return nearest.range[0];
}

const Triangle flat{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};

/// Where a ray meets a triangle, by barycentric coordinates in long double; `inside` is the smallest of the three.
struct Reference {
  long double range, inside;
};
Reference reference(const Triangle& t, const Ray& ray) {
  using Long = glm::vec<3, long double, glm::defaultp>;
  const Long a(t.a), e1 = Long(t.b) - a, e2 = Long(t.c) - a, o(ray.origin), d(ray.direction);
  const Long p = glm::cross(d, e2), s = o - a, q = glm::cross(s, e1);
  const long double det = glm::dot(e1, p), u = glm::dot(s, p) / det, v = glm::dot(d, q) / det;
  return {glm::dot(e2, q) / det, std::min({u, v, 1 - u - v})};
}

/// Range of a hit, as documented: where the ray crosses the plane, moved into the triangle's box, by four divisions;
/// `moved` if that is elsewhere; no number if it misses the box.
struct Formula {
  double range;
  bool moved, little;  // little: by less than the box was widened
};
Formula formula(const Triangle& t, const Vec3& origin, const Vec3& direction) {
  const Vec3 normal = cross(t.b - t.a, t.a - t.c);
  const double crossing = dot(normal, t.a - origin) / dot(direction, normal);
  const Vec3 low = min(t.a - origin, min(t.b - origin, t.c - origin)),
             high = max(t.a - origin, max(t.b - origin, t.c - origin));
  const double margin = 8 * std::numeric_limits<double>::epsilon() * std::max(max_norm(low), max_norm(high));
  double entry = -std::numeric_limits<double>::infinity(), exit = -entry;
  for (int k = 0; k < 3; ++k) {
    const double per_metre = 1 / (direction[k] * direction[k] > 0 ? direction[k] : 1e-300);
    const double to_low = (low[k] - margin) * per_metre, to_high = (high[k] + margin) * per_metre;
    entry = std::max(entry, std::min(to_low, to_high));
    exit = std::min(exit, std::max(to_low, to_high));
  }
  const double range = entry <= exit ? std::min(std::max(crossing, entry), exit) : no_number;
  return {range, range != crossing, std::fabs(range - crossing) * max_norm(direction) < margin};
}

/// A triangle such as is hard to meet: large or small, far away, thin, level, upright or almost so.
Triangle hard_triangle(Generator& random) {
  const double size = random.log_uniform(1e-3, 1e3);
  const Vec3 at = random.point(random.coin() ? size : random.log_uniform(1, 1e7));
  Triangle t{at, at + random.point(size), at + random.point(size)};
  if (random.coin()) t.c = t.a + random.uniform() * (t.b - t.a) + random.log_uniform(1e-12, 1) * random.point(size);
  if (random.coin()) {
    const auto k = static_cast<int>(random.whole(3));
    const double tilt = random.coin() ? 0 : random.log_uniform(1e-17, 1e-9);
    for (Vec3* corner : {&t.b, &t.c}) (*corner)[k] = t.a[k] + tilt * ((*corner)[k] - t.a[k]);
  }
  return t;
}

/// Rays towards places in and beside a triangle, about one of them: as narrow as a pulse, or less, or wide.
RayBundle rays_towards(const Triangle& t, Generator& random) {
  const double size = std::max(length(t.b - t.a), length(t.c - t.a));
  const auto place = [&] {
    const double u = random.coin() ? static_cast<double>(random.whole(2)) : random.uniform();
    const double v = random.coin() ? random.uniform(0, 1 - u) : 1e-16 * random.uniform(-1, 1);
    return t.a + u * (t.b - t.a) + v * (t.c - t.a);
  };
  const Vec3 middle = place();
  RayBundle rays;
  rays.origin = middle + random.unit() * size * random.log_uniform(1e-3, 1e5);
  if (random.coin())  // almost along the plane
    rays.origin =
        middle + (place() - middle) * random.log_uniform(1, 1e3) + random.unit() * size * random.log_uniform(1e-9, 1);
  if (random.coin()) rays.origin[static_cast<int>(random.whole(3))] = middle[static_cast<int>(random.whole(3))];
  rays.size = 1 + random.whole(RayBundle::capacity);
  const double width = random.log_uniform(1e-12, 1);
  for (std::size_t j = 0; j < rays.size; ++j)
    rays.set_direction(j, normalize(middle + width * (place() - middle) - rays.origin));
  rays.pad();
  return rays;
}

}  // namespace

TEST_CASE("a triangle is met where its plane is, from both sides") {
  CHECK(meets(flat, {{1, 1, 3}, -axis::up}) == 3);
  CHECK(meets(flat, {{1, 1, -3}, axis::up}) == 3);
  const Triangle turned{flat.b, flat.a, flat.c};
  CHECK(meets(turned, {{1, 1, 3}, -axis::up}) == 3);
  CHECK(meets(flat, {{1 - 4, 1, 3}, Vec3{0.8, 0, -0.6}}).value() == doctest::Approx(5).epsilon(1e-15));
}

TEST_CASE("a triangle is missed beside its edges") {
  for (const Vec3 p : {Vec3{-1e-9, 1, 3}, {1, -1e-9, 3}, {2 + 1e-9, 2, 3}, {5, 5, 3}, {-1, -1, 3}, {4 + 1e-9, 0, 3}})
    CHECK_FALSE(meets(flat, {p, -axis::up}));
}

TEST_CASE("edges and corners belong to the triangle") {
  for (const Vec3 p : {Vec3{0, 0, 3}, {4, 0, 3}, {0, 4, 3}, {2, 0, 3}, {0, 2, 3}, {2, 2, 3}})
    CHECK(meets(flat, {p, -axis::up}) == 3);
}

TEST_CASE("what is behind the origin, or at it, is not met") {
  CHECK_FALSE(meets(flat, {{1, 1, 3}, axis::up}));
  CHECK_FALSE(meets(flat, {{1, 1, 0}, axis::up}));
  CHECK_FALSE(meets(flat, {{1, 1, 0}, -axis::up}));
}

TEST_CASE("a triangle is met beyond the near end and up to the far end, the far end included") {
  CHECK(meets(flat, {{1, 1, 3}, -axis::up, 2.999, 10}) == 3);
  CHECK_FALSE(meets(flat, {{1, 1, 3}, -axis::up, 3, 10}));
  CHECK(meets(flat, {{1, 1, 3}, -axis::up, 0, 3}) == 3);
  CHECK_FALSE(meets(flat, {{1, 1, 3}, -axis::up, 0, 2.999}));
}

TEST_CASE("rays in the triangle's plane, or along it, miss") {
  CHECK_FALSE(meets(flat, {{-1, 1, 0}, axis::right}));
  CHECK_FALSE(meets(flat, {{-1, 1, 1}, axis::right}));
  CHECK_FALSE(meets(flat, {{-1, 0, 0}, axis::right}));
  CHECK_FALSE(meets(flat, {{5, -1, 0}, normalize(Vec3{-1, 1, 0})}));
}

TEST_CASE("a ray within 1e-12 rad of the triangle's plane misses, one at ten times that meets it where it should") {
  CHECK_FALSE(meets(flat, {{-1, 1, 2e-13}, {1, 0, -1e-13}}));
  CHECK(meets(flat, {{-1, 1, 2e-11}, {1, 0, -1e-11}}).value() == doctest::Approx(2).epsilon(1e-12));
}

TEST_CASE("a triangle without area is never met") {
  CHECK_FALSE(meets({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, {{0.5, 0, 3}, -axis::up}));
  CHECK_FALSE(meets({{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}, {{1, 1, 3}, -axis::up}));
  CHECK_FALSE(meets({{0, 0, 0}, {0, 0, 0}, {3, 0, 0}}, {{0.5, 0, 3}, -axis::up}));
}

TEST_CASE("nothing that is not a number is met") {
  CHECK_FALSE(meets(flat, {{1, no_number, 3}, -axis::up}));
  for (int k = 0; k < 3; ++k) {
    Vec3 d = -axis::up;
    d[k] = no_number;
    CHECK_FALSE(meets(flat, {{1, 1, 3}, d}));
    Triangle t = flat;
    t.b[k] = no_number;
    CHECK_FALSE(meets(t, {{1, 1, 3}, -axis::up}));
  }
  CHECK_FALSE(meets(flat, {{1, 1, 3}, -axis::up, no_number}));
  CHECK_FALSE(meets(flat, {{1, 1, 3}, -axis::up, 0, no_number}));
  CHECK_FALSE(meets(flat, {{1, 1, 3}, Vec3{0, 0, 0}}));
}

TEST_CASE("of triangles at exactly the same range the one of the smallest number is met, whatever the order") {
  const RayBundle rays = bundle_of({{1, 1, 3}, -axis::up});
  for (const bool upwards : {true, false}) {
    ClosestHits nearest(rays);
    for (PrimitiveIndex i = 0; i < 5; ++i) intersect(flat, upwards ? i : 4 - i, rays, nearest);
    CHECK(nearest.range[0] == 3);
    CHECK(nearest.primitive_of(0) == 0);
  }
}

TEST_CASE("every ray of a bundle is answered as it is alone, and idle lanes are left alone") {
  Generator random(70);
  for (const std::size_t size : {2U, 5U, 8U, 19U, 33U, 64U}) {
    const RayBundle rays = random.cone({1, 1, 3}, -axis::up, 0.7, size);
    ClosestHits nearest(rays);
    intersect(flat, 6, rays, nearest);
    for (std::size_t j = 0; j < size; ++j) {
      const auto alone = meets(flat, rays.ray(j));
      CHECK(nearest.met(j) == alone.has_value());
      if (alone) {
        CHECK(nearest.range[j] == *alone);
        CHECK(nearest.primitive_of(j) == 6);
      }
    }
    for (std::size_t j = size; j < rays.padded_size(); ++j) CHECK_FALSE(nearest.met(j));
  }
}

TEST_CASE(
    "a range is that of the one formula to the last bit, whatever a test leaves out, of a ray alone and of many") {
  if (contracted()) return;  // then the last bits are the compiler's choice
  std::size_t wrong = 0, moved = 0, kept = 0, little = 0;
  for (std::uint64_t seed = 1; seed <= 100'000; ++seed) {
    Generator random(seed);
    const Triangle t = hard_triangle(random);
    const RayBundle rays = rays_towards(t, random);
    ClosestHits nearest(rays);
    intersect(t, 0, rays, nearest);
    for (std::size_t j = 0; j < rays.size; ++j) {
      ClosestHit alone(rays.far);
      intersect(t, 0, SingleRayPacket(rays.ray(j)), alone);
      bool same = alone.range[0] == nearest.range[j] && alone.met(0) == nearest.met(j);
      if (nearest.met(j)) {
        const Formula expected = formula(t, rays.origin, rays.direction(j));
        same &= nearest.range[j] == expected.range;
        ++(expected.moved ? moved : kept);
        little += expected.moved && expected.little;
      }
      if (!same && ++wrong < 5) MESSAGE("seed " << seed << ", ray " << j);
    }
  }
  CHECK(wrong == 0);
  CHECK(moved > 10'000);
  CHECK(little > 500);
  CHECK(kept > 1'000'000);
}

TEST_CASE("where directions are not unit, ranges are in multiples of their length") {
  RayBundle rays = bundle_of({{1, 1, 3}, -axis::up});
  rays.direction_length = 0.25;
  rays.set_direction(0, rays.direction(0) * 0.25);
  rays.pad();
  ClosestHits nearest(rays);
  intersect(flat, 0, rays, nearest);
  CHECK(nearest.range[0] == 12);
}

TEST_CASE("random triangles are met as long double says, at any scale") {
  constexpr std::uint64_t seed = 71;
  CAPTURE(seed);
  Generator random(seed);
  int hits = 0;
  for (int time = 0; time < 100000; ++time) {
    const double scale = random.log_uniform(1e-6, 1e7);
    const Triangle t{random.point(scale), random.point(scale), random.point(scale)};
    const Vec3 origin = random.point(scale);
    const Ray ray{origin, normalize((t.a + t.b + t.c) / 3.0 + random.point(scale) - origin)};
    const auto found = meets(t, ray);
    const Reference expected = reference(t, ray);
    const Vec3 normal = t.normal();
    const double slope = std::fabs(dot(normal, ray.direction));
    const double shape = length(cross(t.b - t.a, t.c - t.a)) / (scale * scale);
    if (slope < 1e-3 || shape < 1e-3) continue;  // ill-posed
    if (std::fabs(static_cast<double>(expected.inside)) > 1e-9) {
      const bool hit = expected.inside > 0 && expected.range > 0;
      CHECK(found.has_value() == hit);
      if (found && hit) {
        CHECK(std::fabs(static_cast<double>(*found - expected.range)) <= 1e-9 * scale);
        ++hits;
      }
    }
  }
  CHECK(hits > 10000);
}

TEST_CASE("a triangle's bounds hold its corners, and its normal is right-handed") {
  const Box box = Triangle{{3, 0, 1}, {0, 2, 1}, {1, 1, -1}}.bounds();
  CHECK(box == Box{{0, 0, -1}, {3, 2, 1}});
  CHECK(flat.normal() == axis::up);
  CHECK_FALSE(finite(Triangle{}.normal()));
}

TEST_CASE("rays of a staggered bundle meet what is beyond their own beginnings") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    StaggeredBundle rays;
    rays.size = 1 + any.whole(RayBundle::capacity);
    rays.origin = any.point(1);
    for (std::size_t j = 0; j < rays.size; ++j)
      rays.set_direction(j, normalize(Vec3{any.uniform(-0.3, 0.3), 1, any.uniform(-0.3, 0.3)}));
    for (std::size_t j = 0; j < rays.padded_size(); ++j) rays.begin[j] = any.uniform(0, 20);
    rays.pad();
    std::vector<Triangle> triangles;
    for (int k = 0; k < 20; ++k) {
      const Vec3 at{any.uniform(-5, 5), any.uniform(1, 20), any.uniform(-5, 5)};
      triangles.push_back({at, at + 6.0 * any.unit(), at + 6.0 * any.unit()});
    }
    ClosestHits together(rays);
    for (PrimitiveIndex k = 0; k < triangles.size(); ++k) intersect(triangles[k], k, rays, together);
    for (std::size_t j = 0; j < rays.size; ++j) {
      Ray ray = rays.ray(j);
      ray.near = rays.begin[j];
      const RayBundle one = bundle_of(ray);
      ClosestHits alone(one);
      for (PrimitiveIndex k = 0; k < triangles.size(); ++k) intersect(triangles[k], k, one, alone);
      CHECK(together.id[j] == alone.id[0]);
      CHECK(together.range[j] == alone.range[0]);
    }
  }
}
