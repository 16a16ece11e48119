// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/hit.hpp>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("a hit as made has met nothing") {
  Hit hit;
  CHECK_FALSE(hit.met());
  hit.range = 1e300;
  CHECK(hit.met());
}

TEST_CASE("hits of a scene are equal if all their numbers are") {
  const RayHit hit{.range = 5, .part = 1, .primitive = 2, .layer = 3};
  CHECK(hit == RayHit{5, 1, 2, 3});
  CHECK_FALSE(hit == RayHit{6, 1, 2, 3});
  CHECK_FALSE(hit == RayHit{5, 0, 2, 3});
  CHECK_FALSE(hit == RayHit{5, 1, 0, 3});
  CHECK_FALSE(hit == RayHit{5, 1, 2, 0});
}

TEST_CASE("a geometry sets the first three members of a surface") {
  const SurfaceInteraction surface{axis::up, 4, true};
  CHECK(surface.normal == axis::up);
  CHECK(surface.material_index == 4);
  CHECK(surface.foliage);
  CHECK(surface.velocity == Vec3{});
  CHECK_FALSE(surface.texture);
}
