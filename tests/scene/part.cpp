// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/part.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "support/archetypes.hpp"
#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

namespace {

Placement any_similarity(support::Generator& any) {
  return {any.rotation(), any.log_uniform(1e-3, 1e3), any.point(1e6)};
}

}  // namespace

TEST_CASE("a similarity turns, then scales, then moves") {
  const Placement s{rotation_about(axis::up, pi / 2), 2, {10, 20, 30}};
  CHECK(length(s.point({1, 0, 0}) - Vec3{10, 22, 30}) < 1e-14);
  CHECK(length(s.point({0, 0, 1}) - Vec3{10, 20, 32}) < 1e-14);
}

TEST_CASE("only a similarity that does nothing is the identity") {
  CHECK(Placement{}.identity());
  CHECK_FALSE(Placement{.rotation = rotation_about(axis::up, 0.1)}.identity());
  CHECK_FALSE(Placement{.scale = 2}.identity());
  CHECK_FALSE((Placement{.translation = {0, 0, 1e-9}}.identity()));
}

TEST_CASE("the box around a placed box holds all of its points, and is no larger than its corners ask for") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Placement s = any_similarity(any);
    const Box box = any.box(10, 0.01, 10);
    const Box placed = s.box(box);
    const double rounding = 1e-14 * (max_norm(placed.min) + max_norm(placed.max));
    Box corners;
    for (int c = 0; c < 8; ++c)
      corners.extend(
          s.point({c & 1 ? box.max.x : box.min.x, c & 2 ? box.max.y : box.min.y, c & 4 ? box.max.z : box.min.z}));
    CHECK(placed == corners);
    for (int k = 0; k < 50; ++k) {
      const Vec3 p = s.point(box.min + box.size() * Vec3{any.uniform(), any.uniform(), any.uniform()});
      for (int axis = 0; axis < 3; ++axis) {
        REQUIRE(p[axis] >= placed.min[axis] - rounding);
        REQUIRE(p[axis] <= placed.max[axis] + rounding);
      }
    }
  }
}

TEST_CASE("rays in a part's own frame reach at the same range the point that they reach in the world") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Placement s = any_similarity(any);
    RayBundle world = any.cone(s.translation + any.point(100), any.unit(), 0.1, 1 + any.whole(RayBundle::capacity));
    world.near = 0.5;
    world.far = 1234;
    world.seed = 7;
    world.pulse = 8;
    world.first_subray = 9;
    world.tick = {1, 0.5};
    const RayBundle local = s.to_local(world);
    CHECK(local.size == world.size);
    CHECK(local.near == 0.5);
    CHECK(local.far == 1234);
    CHECK(local.seed == 7);
    CHECK(local.pulse == 8);
    CHECK(local.first_subray == 9);
    CHECK(local.tick == world.tick);
    CHECK(local.direction_length == support::relative(1 / s.scale, 1e-15));
    const double range = any.log_uniform(0.1, 1000);
    for (std::size_t j = 0; j < world.padded_size(); ++j) {
      REQUIRE(length(local.direction(j)) == support::relative(local.direction_length, 1e-14));
      const Vec3 there = world.origin + range * world.direction(j);
      const Vec3 back = s.point(local.origin + range * local.direction(j));
      REQUIRE(length(back - there) < 1e-14 * 4e6);
    }
  }
}

TEST_CASE("a similarity refuses what is none") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  CHECK_NOTHROW(Placement{}.validate());
  for (const double bad : {0.0, -1.0, nan, infinity}) CHECK_THROWS_AS(Placement{.scale = bad}.validate(), SettingError);
  CHECK_THROWS_AS((Placement{.rotation = Rotation{1, 1, 0, 0}}.validate()), SettingError);
  CHECK_THROWS_AS((Placement{.rotation = Rotation{nan, 0, 0, 0}}.validate()), SettingError);
  CHECK_THROWS_AS((Placement{.translation = {0, nan, 0}}.validate()), SettingError);
  CHECK_THROWS_AS((Placement{.translation = {0, 0, infinity}}.validate()), SettingError);
}

TEST_CASE("a table of materials holds valid ones, and a default one unless told otherwise") {
  CHECK(material_table()->size() == 1);
  CHECK(material_table()->at(0).reflectance == Material{}.reflectance);
  CHECK(material_table({Material{.name = "a"}, Material{.name = "b"}})->at(1).name == "b");
  CHECK_THROWS_AS((void)material_table({Material{}, Material{.reflectance = 2}}), SettingError);
}

TEST_CASE("a part as made stands at the origin, in the default material") {
  const Part<support::LeastGeometry> part{std::make_shared<const support::LeastGeometry>()};
  CHECK(part.placement.identity());
  CHECK(part.materials->size() == 1);
  CHECK(part.object == 0);
  CHECK(part.name.empty());
  CHECK(part.motion == nullptr);
  CHECK(part.materials == Part<support::LeastGeometry>{}.materials);  // one table for all
}
