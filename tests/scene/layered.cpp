// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/layered.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/scene/scene.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "support/archetypes.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/light.hpp"

using namespace pulsecast;
using support::LeastGeometry;

namespace {

using Discs = Scene<LeastGeometry>;
using Disc = Discs::Part;

Disc disc(const Placement& placement, ObjectId object, bool ground = false) {
  static const auto shape = std::make_shared<const LeastGeometry>();
  return {shape, material_table({{.ground = ground}}), placement, object};
}

template <class Map>
Hit ask(const Map& map, const Ray& ray) {
  std::array<Hit, 1> hits;
  map.closest(bundle_of(ray), hits);
  return hits[0];
}

/// Hit of range NaN.
struct Broken {
  std::optional<Hit> closest_hit(const Ray&) const noexcept {
    return Hit{.range = std::numeric_limits<double>::quiet_NaN()};
  }
};

static_assert(BundleTarget<Layered<Discs, Discs>> && BundleTarget<Layered<support::LeastRayTarget, Discs>>);
static_assert(BundleTarget<Layered<Layered<Discs, Discs>, support::LeastBundleTarget>>);
static_assert(std::is_constructible_v<Layered<Discs, Discs>, const Discs&, const Discs&>);
static_assert(!std::is_constructible_v<Layered<Discs, Discs>, const Discs&, Discs>);
static_assert(!std::is_constructible_v<Layered<Discs, Discs>, Discs, const Discs&>);
template <class Map>
concept Bounded = requires(const Map& map) {
  map.bounds();
};
template <class Map>
concept Grounded = requires(const Map& map) {
  map.ground_height({0, 0});
};
static_assert(Bounded<Layered<Discs, Discs>> && Grounded<Layered<Discs, Discs>>);
static_assert(!Bounded<Layered<Discs, support::LeastRayTarget>> && !Grounded<Layered<Discs, support::LeastRayTarget>>);

static_assert(SceneQueries<Layered<Discs, Discs>> && SceneQueries<Layered<Layered<Discs, Discs>, Discs>>);
static_assert(!SceneQueries<Layered<Discs, support::LeastRayTarget>>);

}  // namespace

TEST_CASE("of layers the nearest hit is met, whichever comes first") {
  const Discs low({disc({}, 1)}), high({disc({.translation = {0.5, 0, 2}}, 2)});
  const Ray both{{0, 0, 10}, {0, 0, -1}}, left{{-0.9, 0, 10}, {0, 0, -1}}, none{{5, 0, 10}, {0, 0, -1}};
  for (const Layered<Discs, Discs>& world : {Layered{low, high}, Layered{high, low}}) {
    CHECK(ask(world, both).range == 8);
    CHECK(ask(world, both).object == 2);
    CHECK(ask(world, left).range == 10);
    CHECK(ask(world, left).object == 1);
    CHECK_FALSE(ask(world, none).met());
    CHECK(world.bounds().min == Vec3{-1, -1, 0});
    CHECK(world.bounds().max == Vec3{1.5, 1, 2});
  }
}

namespace {

/// Keeps the far end that it is asked for; is met nowhere.
struct FarEnd {
  mutable double far = 0;
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    far = rays.far;
    std::fill_n(hits.begin(), rays.size, Hit{});
  }
};

}  // namespace

TEST_CASE("no layer is traced beyond the far end, nor beyond the hits of those before it") {
  const Discs none({}), floor({disc({}, 1)});
  const FarEnd last;
  const Layered world{none, floor, last};
  const Ray near{.origin = {0, 0, 10}, .direction = -axis::up, .far = 5},
      far{.origin = {0, 0, 10}, .direction = -axis::up, .far = 50};
  CHECK_FALSE(ask(world, near).met());
  CHECK(last.far == 5);
  CHECK(ask(world, far).range == 10);
  CHECK(last.far == 10);
}

TEST_CASE("at equal range the first layer is met") {
  const Discs one({disc({}, 1)}), two({disc({}, 2)}), three({disc({}, 3)});
  CHECK(ask(Layered{one, two, three}, {{0, 0, 10}, {0, 0, -1}}).object == 1);
  CHECK(ask(Layered{three, two, one}, {{0, 0, 10}, {0, 0, -1}}).object == 3);
}

TEST_CASE("the ground of layers is the highest of theirs") {
  const Discs low({disc({}, 1, true)}),
      high({disc({.translation = {0.5, 0, 2}}, 2, true), disc({.translation = {0, 0, 5}}, 3)});
  const Layered world{low, high};
  CHECK(world.ground_height({0, 0}) == 2);
  CHECK(world.ground_height({-0.9, 0}) == 0);
  CHECK(world.ground_height({1.2, 0}) == 2);
  CHECK(world.ground_height({0, 0}, 0.9) == 0);
  CHECK(world.ground_height({0, 0}, 1.1) == 2);
  CHECK_FALSE(world.ground_height({9, 9}));
}

TEST_CASE("a layer assigned anew is met as it then is") {
  const Discs still({disc({}, 1)});
  Discs moving({disc({.translation = {0, 0, 1}}, 2)});
  const Layered world{still, moving};
  const Ray down{{0, 0, 10}, {0, 0, -1}};
  CHECK(ask(world, down).range == 9);
  const std::array<Placement, 1> next{Placement{.translation = {0, 0, 3}}};
  moving = moving.with_placements(next);
  CHECK(ask(world, down).range == 7);
}

TEST_CASE("a range of NaN in any layer is kept") {
  const Discs still({disc({}, 1)});
  const Broken broken;
  const Ray down{{0, 0, 10}, {0, 0, -1}};
  CHECK(std::isnan(ask(Layered{still, broken}, down).range));
  CHECK(std::isnan(ask(Layered{broken, still}, down).range));
}

TEST_CASE("layers meet what one scene of all their parts meets") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::array<std::vector<Disc>, 3> layers;
    std::vector<Disc> all;
    for (ObjectId k = 0; k < 60; ++k) {
      layers[k / 20].push_back(disc({any.rotation(), any.log_uniform(0.5, 5), any.point(20)}, k));
      all.push_back(layers[k / 20].back());
    }
    const Discs a(layers[0]), b(layers[1]), c(layers[2]), together(all);
    const Layered world{a, b, c};
    for (int k = 0; k < 20; ++k) {
      const RayBundle rays =
          any.cone(any.point(40), any.unit(), any.log_uniform(1e-3, 1), 1 + any.whole(RayBundle::capacity));
      std::array<Hit, RayBundle::capacity> hits, expected;
      world.closest(rays, hits);
      together.closest(rays, expected);
      for (std::size_t j = 0; j < rays.size; ++j) {
        REQUIRE(hits[j].range == expected[j].range);
        REQUIRE(hits[j].object == expected[j].object);
        REQUIRE(hits[j].backscatter == expected[j].backscatter);
      }
    }
  }
}

TEST_CASE("a cone misses layers if it misses each, and none that cannot tell") {
  const Discs low({disc({}, 1)}), high({disc({.translation = {0.5, 0, 2}}, 2)});
  const support::LeastRayTarget own;
  const RayCone up{.origin = {0, 0, 3}, .direction = axis::up, .spread = 0.1},
      between{.origin = {0, 0, 1}, .direction = axis::up, .spread = 0.1};
  CHECK(Layered{low, high}.misses_cone(up));
  CHECK(Layered{low}.misses_cone(between));
  CHECK_FALSE(Layered{low, high}.misses_cone(between));
  CHECK_FALSE(Layered{high, own}.misses_cone(up));
  std::size_t missed = 0;
  CHECK(support::cone_laws(Layered{low, high}, support::cones_from(10, 3, 3000), missed) == "");
  CHECK(missed > 1000);
}

TEST_CASE("light goes on through layers as through one scene of all their parts") {
  using World = support::LightScene;
  const Material kinds[]{{.reflectance = 0.5},
                         {.reflectance = 0.1, .smooth = SmoothInterface::mirror(0.8)},
                         {.reflectance = 0.02, .smooth = SmoothInterface::pane()},
                         {.reflectance = 0.01, .smooth = SmoothInterface::glass()}};
  std::size_t reflections = 0, stretches = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<World::Part> all, still, moving;
    for (std::uint32_t k = 0; k < 14; ++k) {
      const Vec3 right = 5.0 * any.unit();
      all.push_back(
          support::rectangle(any.point(12), right, 5.0 * normalize(cross(right, any.unit())), kinds[k % 4], k));
      (any.uniform() < 0.5 ? still : moving).push_back(all.back());
    }
    const World one(all), first(still), second(moving);
    const Layered layers{first, second};
    const LightPaths light{.spread_planes = false,
                           .scattering = {.orders = 3, .paths = 5},
                           .air = Media({{.medium = {.scattering = 0.01, .backscatter = 1e-4}}})};
    for (int k = 0; k < 5; ++k) {
      const Pose<frame::Beam, frame::World> pose{any.rotation(), any.point(10)};
      const support::Lamp lamp{.laser = {.divergence = 0.01}};
      const auto expected = support::traced(light, one, pose, RingFootprint(3), lamp),
                 seen = support::traced(light, layers, pose, RingFootprint(3), lamp);
      REQUIRE(seen.reflections.size() == expected.reflections.size());
      for (std::size_t j = 0; j < expected.reflections.size(); ++j) {
        const Reflection &a = seen.reflections[j], &b = expected.reflections[j];
        REQUIRE(a.range == b.range);
        REQUIRE(a.power == b.power);
        REQUIRE(a.object == b.object);
        REQUIRE(a.kind == b.kind);
      }
      reflections += expected.reflections.size();
      REQUIRE(seen.continuous.size() == expected.continuous.size());
      for (std::size_t j = 0; j < expected.continuous.size(); ++j)
        REQUIRE(seen.continuous[j].power() == expected.continuous[j].power());
      stretches += expected.continuous.size();
    }
  }
  CHECK(reflections > 2'000);
  CHECK(stretches > 1'000);
}
