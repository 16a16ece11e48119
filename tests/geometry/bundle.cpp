// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/geometry/bundle.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

TEST_CASE("the bundle of a ray gives the ray back") {
  const Ray ray{{1, 2, 3}, normalize(Vec3{1, 1, 1}), 0.5, 90};
  const RayBundle rays = bundle_of(ray);
  CHECK(rays.size == 1);
  CHECK(rays.padded_size() == RayBundle::lanes);
  CHECK(rays.ray(0).origin == ray.origin);
  CHECK(rays.ray(0).direction == ray.direction);
  CHECK(rays.ray(0).near == 0.5);
  CHECK(rays.ray(0).far == 90);
}

TEST_CASE("a bundle is filled up with copies of its last ray") {
  Generator random(61);
  for (const std::size_t size : {1U, 7U, 8U, 9U, 19U, 63U, 64U}) {
    const RayBundle rays = random.cone({}, axis::forward, 1e-3, size);
    CHECK(rays.padded_size() % RayBundle::lanes == 0);
    CHECK(rays.padded_size() >= size);
    CHECK(rays.padded_size() < size + RayBundle::lanes);
    for (std::size_t j = size; j < rays.padded_size(); ++j) CHECK(rays.direction(j) == rays.direction(size - 1));
  }
  RayBundle level;
  level.size = 1;
  level.set_direction(0, {0.6, 0.8, -0.0});
  level.pad();
  for (std::size_t j = 0; j < level.padded_size(); ++j) CHECK(std::signbit(level.direction(j).z));
}

TEST_CASE("the bounds of the directions leave NaN out") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const std::size_t size : {1U, 2U, 3U}) {
    RayBundle rays;
    rays.set_direction(0, {nan, nan, nan});
    rays.set_direction(1, {1, -2, 3});
    rays.set_direction(2, {4, nan, -5});
    rays.size = size;
    rays.pad();
    CHECK(rays.directions_min == (size == 1 ? Vec3(infinity) : Vec3{1, -2, size == 2 ? 3.0 : -5.0}));
    CHECK(rays.directions_max == (size == 1 ? Vec3(-infinity) : Vec3{size == 2 ? 1.0 : 4.0, -2, 3}));
  }
}

TEST_CASE("the nearer offer wins, and on equal range the smaller number, whatever the order") {
  const RayBundle rays = bundle_of({});
  ClosestHits nearest(rays);
  CHECK_FALSE(nearest.met(0));
  CHECK(nearest.limit(rays) == std::numeric_limits<double>::infinity());
  nearest.offer(0, 5, 7);
  CHECK(nearest.primitive_of(0) == 7);
  nearest.offer(0, 5, 9);
  CHECK(nearest.primitive_of(0) == 7);
  nearest.offer(0, 5, 3);
  CHECK(nearest.primitive_of(0) == 3);
  nearest.offer(0, 6, 1);
  CHECK(nearest.primitive_of(0) == 3);
  nearest.offer(0, 4, 8);
  CHECK(nearest.primitive_of(0) == 8);
  CHECK(nearest.limit(rays) == 4);
  nearest.offer(0, std::numeric_limits<double>::quiet_NaN(), 0);
  CHECK(nearest.primitive_of(0) == 8);
}

TEST_CASE("on equal range the smaller part wins before the smaller primitive") {
  const RayBundle rays = bundle_of({});
  ClosestHits nearest(rays);
  nearest.part = std::uint64_t{2} << 32;
  nearest.offer(0, 5, 1);
  nearest.part = std::uint64_t{1} << 32;
  nearest.offer(0, 5, 6);
  CHECK(nearest.part_of(0) == 1);
  CHECK(nearest.primitive_of(0) == 6);
}

TEST_CASE("what is met at the far end counts, what is beyond does not") {
  RayBundle rays = bundle_of({{}, axis::forward, 0, 10});
  ClosestHits nearest(rays);
  nearest.offer(0, 10.5, 1);
  CHECK_FALSE(nearest.met(0));
  nearest.offer(0, 10, 1);
  CHECK(nearest.met(0));
}

TEST_CASE("the limit is that of the ray which may still go farthest, and idle lanes have no say") {
  Generator random(62);
  const RayBundle rays = random.cone({}, axis::forward, 1e-3, 9);
  ClosestHits nearest(rays);
  for (std::size_t j = 0; j < 8; ++j) nearest.offer(j, 2 + static_cast<double>(j), 0);
  CHECK(nearest.limit(rays) == std::numeric_limits<double>::infinity());
  nearest.offer(8, 1, 0);
  CHECK(nearest.limit(rays) == 9);
  for (std::size_t j = 9; j < rays.padded_size(); ++j) CHECK_FALSE(nearest.met(j));
}
