// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/any_target.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <pulsecast/scene/layered.hpp>
#include <pulsecast/scene/motion.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/height_field.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include <doctest/doctest.h>

#include "support/archetypes.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using support::Generator;

namespace {

using Mesh = TriangleMesh<>;
using Meshes = Scene<Mesh>;
using Moving = MovingScene<Mesh>;
using Terrain = Scene<HeightField>;
using Plane = support::LeastRayTarget;
using Map = AnyTarget<Meshes, Moving, Terrain>;
using MapOrOwn = AnyTarget<Meshes, Plane, Layered<Meshes, Terrain>>;

/// The same plane, as a map that can only be moved.
struct Unique {
  std::unique_ptr<const Plane> plane = std::make_unique<const Plane>();
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept { return plane->closest_hit(ray); }
};

static_assert(BundleTarget<Map> && BundleTarget<MapOrOwn> && BundleTarget<AnyTarget<Plane>> &&
              BundleTarget<AnyTarget<Unique, Plane>>);
static_assert(!RayTarget<Map> && !RayTarget<MapOrOwn>);
static_assert(SceneQueries<Meshes> && SceneQueries<Moving> && SceneQueries<Layered<Meshes>> && !SceneQueries<Plane>);
static_assert(SceneQueries<Map> && !SceneQueries<MapOrOwn>);
template <class M>
concept Bounded = requires(const M& map) {
  map.bounds();
};
template <class M>
concept Grounded = requires(const M& map) {
  map.ground_height({0, 0});
};
static_assert(Bounded<Map> && Grounded<Map> && !Bounded<MapOrOwn> && !Grounded<MapOrOwn>);
static_assert(std::is_constructible_v<Map, Terrain> && !std::is_constructible_v<Map, Plane> &&
              !std::is_default_constructible_v<Map>);

std::shared_ptr<const Mesh> random_mesh(Generator& random) {
  return std::make_shared<const Mesh>(support::soup(random, 60, 10));
}

Terrain random_terrain(Generator& random) {
  Raster raster{.columns = 9, .rows = 9, .first = {-10, 10}, .pixel = {2.5, 2.5}};
  for (std::size_t k = 0; k < 81; ++k) raster.heights.push_back(static_cast<float>(random.point(3).z));
  return Terrain({{.geometry = std::make_shared<const HeightField>(std::move(raster)),
                   .materials = material_table({{.ground = true}})}});
}

/// Ray from outside towards the maps, at any time of a second.
Ray random_ray(Generator& random) {
  const Vec3 origin = 20.0 * random.unit();
  return {
      .origin = origin, .direction = normalize(random.point(8) - origin), .tick = Tick::of_seconds(random.uniform())};
}

template <class Target>
Hit ask(const Target& target, const RayBundle& rays) {
  std::array<Hit, 1> hits;
  target.closest(rays, hits);
  return hits[0];
}

bool same(const Hit& a, const Hit& b) {
  return a.range == b.range && a.cos_incidence == b.cos_incidence && a.backscatter == b.backscatter &&
         a.object == b.object && a.classification == b.classification;
}

/// Compares a target with itself among several, by random rays.
template <class Target>
void compare(const Target& target, const Map& any, Generator& random) {
  CHECK(any.bounds().min == target.bounds().min);
  CHECK(any.bounds().max == target.bounds().max);
  int met = 0;
  for (int i = 0; i < 200; ++i) {
    const Ray ray = random_ray(random);
    const RayBundle rays = bundle_of(ray);
    const Hit hit = ask(target, rays);
    met += hit.met() ? 1 : 0;
    CHECK(same(ask(any, rays), hit));
    const std::optional<RayHit> closest = target.closest_hit(ray);
    CHECK(any.closest_hit(ray) == closest);
    CHECK(any.occluded(ray) == closest.has_value());
    CHECK(any.occluded(ray, 5) == target.occluded(ray, 5));
    std::vector<RayHit> all, all_of_any;
    target.all_hits(ray, [&](const RayHit& h) { all.push_back(h); });
    CHECK(any.all_hits(ray, [&](const RayHit& h) { all_of_any.push_back(h); }) == all.size());
    CHECK(all_of_any == all);
    if (closest) {
      CHECK(any.surface(*closest, ray).normal == target.surface(*closest, ray).normal);
      CHECK(any.surface(*closest, ray).velocity == target.surface(*closest, ray).velocity);
    }
    const Vec3 place = random.point(10);
    CHECK(any.ground_height({place.x, place.y}) == target.ground_height({place.x, place.y}));
    CHECK(any.ground_height({place.x, place.y}, place.z) == target.ground_height({place.x, place.y}, place.z));
  }
  CHECK(met > 10);
}

}  // namespace

TEST_CASE("each of several maps answers as it does alone") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const Meshes still({{.geometry = random_mesh(random)}, {.geometry = random_mesh(random), .object = 2}});
    const auto drift = std::make_shared<const PartMotion>(SteadyMotion{.velocity = random.point(5)});
    const Moving moving({{.geometry = random_mesh(random)}, {.geometry = random_mesh(random), .motion = drift}},
                        {.to = 1});
    const Terrain terrain = random_terrain(random);
    compare(still, Map(still), random);
    compare(moving, Map(moving), random);
    compare(terrain, Map(terrain), random);
  }
}

TEST_CASE("a map of one's own, a reference to maps, and a map that cannot be copied answer among others") {
  Generator random(7);
  const Meshes still({{.geometry = random_mesh(random)}});
  const Terrain terrain = random_terrain(random);
  const Layered both{still, terrain};
  const MapOrOwn own(Plane{}), joined(both);
  const AnyTarget<Unique, Meshes> unique(Unique{});
  for (int i = 0; i < 200; ++i) {
    CAPTURE(i);
    const Ray ray = random_ray(random);
    const RayBundle rays = bundle_of(ray);
    const Hit plane = Plane{}.closest_hit(ray).value_or(Hit{});
    CHECK(same(ask(own, rays), plane));
    CHECK(same(ask(unique, rays), plane));
    CHECK(same(ask(joined, rays), ask(both, rays)));
  }
}

TEST_CASE("another map is assigned at run time, and a layer of one map refers to it") {
  const Ray down{{0.2, 0.3, 10}, {0, 0, -1}};
  const auto plane = std::make_shared<const Mesh>(support::plane(1));
  Meshes low({{.geometry = plane}});
  AnyTarget<Meshes, Plane, Layered<Meshes>> map = low;
  low = Meshes({{.geometry = plane, .placement = {.translation = {0, 0, 4}}}});
  CHECK(ask(map, bundle_of(down)).range == 10);
  map = Layered<Meshes>(low);
  CHECK(ask(map, bundle_of(down)).range == 6);
  low = Meshes({{.geometry = plane, .placement = {.translation = {0, 0, 7}}}});
  CHECK(ask(map, bundle_of(down)).range == 3);
  map = Plane{};
  CHECK(ask(map, bundle_of(down)).range == 10);
}

TEST_CASE("a cone misses the map that is held, unless that cannot tell") {
  Generator random(9);
  const Meshes still({{.geometry = random_mesh(random)}});
  const Map map(still);
  std::size_t missed = 0;
  for (const RayCone& cone : support::cones_from(50, 4, 1000)) {
    CHECK(map.misses_cone(cone) == still.misses_cone(cone));
    if (map.misses_cone(cone)) ++missed;
    CHECK_FALSE(MapOrOwn(Plane{}).misses_cone(cone));
  }
  CHECK(missed > 100);
}
