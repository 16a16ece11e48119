// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/geometry/ray_cone.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

/// True if a ray is inside a box anywhere, by its slabs in extended precision.
bool meets(const Vec3& origin, const Vec3& direction, const Box& box) {
  long double entry = 0, exit = infinity;
  for (int k = 0; k < 3; ++k) {
    const long double o = origin[k], d = direction[k];
    if (d == 0 && (o < box.min[k] || o > box.max[k])) return false;
    if (d == 0) continue;
    const long double one = (box.min[k] - o) / d, other = (box.max[k] - o) / d;
    entry = std::max(entry, std::min(one, other));
    exit = std::min(exit, std::max(one, other));
  }
  return entry <= exit;
}

Box grown(const Box& box, double by) { return {box.min - Vec3{by, by, by}, box.max + Vec3{by, by, by}}; }

}  // namespace

TEST_CASE("a cone passes what is behind it and beside it, and no box that it touches") {
  const RayCone cone{.spread = 0.1};
  CHECK_FALSE(cone.passes({{-1, 10, -1}, {1, 12, 1}}));
  CHECK_FALSE(cone.passes({{-1, -1, -1}, {1, 1, 1}}));
  CHECK(cone.passes({{-1, -12, -1}, {1, -10, 1}}));
  // far wall at 12 m: as directions are an interval, a box of half side h is passed from (1.2 + 0.2 h) / 0.9 m to the
  // side on
  CHECK_FALSE(cone.passes({{1.3, 10, -1}, {1.9, 12, 1}}));
  CHECK(cone.passes({{1.41, 10, -1}, {2.01, 12, 1}}));
  CHECK(cone.passes({{-1, 10, 1.41}, {1, 12, 2.01}}));
  CHECK(RayCone{.direction = -axis::forward, .spread = 0.1}.passes({{-1, 10, -1}, {1, 12, 1}}));
}

TEST_CASE("a line of no width passes a corner by more than a millionth, and no nearer") {
  const RayCone diagonal{.origin = {0, 0, 0}, .direction = normalize(Vec3{1, 1, 0})};
  CHECK(diagonal.passes({{5.0001, 4, -1}, {6, 4.9999, 1}}));
  CHECK_FALSE(diagonal.passes({{5.000001, 4, -1}, {6, 4.999999, 1}}));
}

TEST_CASE("a cone or box that is not finite is not passed") {
  const Box box{{10, 10, 10}, {11, 11, 11}}, ahead{{-1, 10, 0}, {1, 12, 1}},
      tall{{10, -infinity, 10}, {11, infinity, 11}};
  REQUIRE(RayCone{}.passes(box));
  const RayCone nowhere{.origin = {none, 0, 0}, .direction = {0.6, 0.8, 0}}, lost{.direction = {none, none, none}},
      vague{.spread = none};
  CHECK_FALSE(nowhere.passes(ahead));
  CHECK_FALSE(lost.passes(box));
  CHECK_FALSE(vague.passes(box));
  CHECK_FALSE(RayCone{}.passes(Box{}));
  CHECK_FALSE(RayCone{}.passes(tall));
}

TEST_CASE("no ray of a cone meets a box that the cone passes, and a line passes each box that it clearly misses") {
  std::size_t passed = 0, missed = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double scale = any.log_uniform(1e-3, 1e6);
    const Box box = any.box(scale, 1e-6 * scale, scale);
    RayCone cone{.origin = any.point(2 * scale), .direction = any.unit(), .spread = any.log_uniform(1e-6, 1)};
    if (any.coin()) cone.direction = normalize(box.centre() + any.point(scale) - cone.origin);
    if (cone.passes(box)) {
      ++passed;
      const RayBundle rays = any.cone(cone.origin, cone.direction, 2 * std::asin(cone.spread / 2), RayBundle::capacity);
      for (std::size_t j = 0; j < rays.size; ++j) REQUIRE_FALSE(meets(rays.origin, rays.direction(j), box));
    }
    cone.spread = 0;
    if (meets(cone.origin, cone.direction, grown(box, 1e-4 * scale))) continue;
    ++missed;
    REQUIRE(cone.passes(box));
  }
  CHECK(passed > 4000);
  CHECK(missed > 10000);
}
