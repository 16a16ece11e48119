// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/detail/lattice_ray.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("crossings at one range are in the order of their axes, after where the ray begins") {
  CHECK(Crossing{1, 2}.before({2, 0}));
  CHECK(Crossing{1, 0}.before({1, 1}));
  CHECK_FALSE(Crossing{1, 1}.before({1, 1}));
  CHECK(Crossing{1, 2}.before({1, Crossing::begin}));
}

TEST_CASE("a cell owns its least faces for rays that go along them") {
  RayBundle rays = bundle_of({{1, 0, 0.5}, axis::forward});
  const LatticeRay ray({0, 0, 0}, 1, rays, 0);
  CHECK(ray.sense(0) == 0);
  CHECK(ray.sense(1) == 1);
  const auto in_cell = [&](double x) {
    const auto passage = ray.through({x, 3, 0}, {x + 1, 4, 1});
    return passage.in.before(passage.out) ? passage.in.range : infinity;
  };
  CHECK(in_cell(0) == infinity);
  CHECK(in_cell(1) == 3);
  CHECK(in_cell(2) == infinity);
}

TEST_CASE("a box beside a ray is not gone through, whichever axis says so") {
  Generator random(441);
  for (int i = 0; i < 2000; ++i) {
    RayBundle rays = bundle_of({random.point(4), random.unit()});
    Vec3 d = rays.direction(0);
    d[static_cast<int>(random.whole(3))] = 0;
    rays.set_direction(0, d);
    rays.pad();
    const Box box = random.box(4, 0.1, 3);
    double in = -infinity, out = infinity;
    for (int k = 0; k < 3; ++k) {
      const double low = box.min[k] - rays.origin[k], high = box.max[k] - rays.origin[k];
      if (d[k] == 0 && (low > 0 || high <= 0)) in = infinity;
      if (d[k] != 0) {
        in = std::max(in, std::min(low / d[k], high / d[k]));
        out = std::min(out, std::max(low / d[k], high / d[k]));
      }
    }
    const auto passage =
        LatticeRay({0, 0, 0}, 1, rays, 0).through({box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z});
    CHECK(passage.in.before(passage.out) == (in < out));
  }
}

TEST_CASE("a ray is at a plane where it crosses it") {
  Generator random(454);
  for (int i = 0; i < 1000; ++i) {
    const RayBundle rays = bundle_of({random.point(1e6), random.unit()});
    const LatticeRay ray(random.point(1e6), random.log_uniform(1e-3, 10), rays, 0);
    const double plane = std::floor(random.uniform(-1e6, 1e6));
    for (int k = 0; k < 3; ++k) {
      CHECK(std::fabs(ray.position(k, ray.crossing(k, plane).range) - plane) < 1e-3);
      CHECK(ray.sense(k) == (rays.direction(0)[k] > 0 ? 1 : -1));
    }
  }
}

TEST_CASE("a ray of no number, or without a direction, goes nowhere") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto valid = [](const Vec3& origin, const Vec3& direction) {
    const RayBundle rays = bundle_of({origin, direction});
    return LatticeRay({0, 0, 0}, 1, rays, 0).valid();
  };
  CHECK(valid({1, 2, 3}, axis::up));
  CHECK_FALSE(valid({1, 2, 3}, {0, 0, 0}));
  CHECK_FALSE(valid({1, 2, 3}, {0, 1e-320, 0}));
  CHECK_FALSE(valid({1, 2, 3}, {0, nan, 1}));
  CHECK_FALSE(valid({1, 2, 3}, {infinity, 0, 1}));
  CHECK_FALSE(valid({nan, 2, 3}, axis::up));
}
