// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/scene.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/allocations.hpp"
#include "support/archetypes.hpp"
#include "support/counting_executor.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using support::LeastGeometry;

namespace {

static_assert(BundleTarget<Scene<LeastGeometry>> && BundleTarget<Scene<TriangleMesh<>>>);
static_assert(BundleTarget<Scene<LeastGeometry, TriangleMesh<>>>);

using Disc = Part<LeastGeometry>;

/// The unit disc, facing up, placed.
Disc disc(const Placement& placement = {}, ObjectId object = 0, const Material& material = {}) {
  static const auto shape = std::make_shared<const LeastGeometry>();
  return {shape, material_table({material}), placement, object};
}

template <class Map>
Hit ask(const Map& map, const Ray& ray) {
  std::array<Hit, 1> hits;
  map.closest(bundle_of(ray), hits);
  return hits[0];
}

MeshData some_triangles(support::Generator& any, std::size_t n) {
  MeshData data;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 p = any.point(5);
    const auto first = static_cast<std::uint32_t>(data.vertices.size());
    for (int corner = 0; corner < 3; ++corner) data.vertices.push_back(p + any.point(1));
    data.triangles.push_back({first, first + 1, first + 2});
    data.materials.push_back(static_cast<std::uint32_t>(any.whole(3)));
  }
  return data;
}

/// A floor that counts how often it is asked for its surface.
template <bool Flat>
struct Counted {
  static constexpr bool uniform_surface = Flat;
  static inline int asked = 0;
  Box box{{-1, -1, 0}, {1, 1, 0}};
  const Box& bounds() const noexcept { return box; }
  std::size_t memory() const noexcept { return 0; }
  std::size_t material_count() const noexcept { return 1; }
  void closest(const RayBundle& rays, ClosestHits& nearest) const noexcept {
    for (std::size_t j = 0; j < rays.size; ++j) nearest.offer(j, -rays.origin.z / rays.z[j], 0);
  }
  SurfaceInteraction surface(PrimitiveIndex, const RayBundle&, std::size_t) const noexcept {
    ++asked;
    return SurfaceInteraction{axis::up, 0};
  }
};

/// How often it is for a bundle of seven rays, each of which is described as it should be.
template <class Shape>
int surfaces_asked() {
  const Scene<Shape> scene({{std::make_shared<const Shape>()}});
  RayBundle rays;
  rays.origin = {0, 0, 5};
  rays.size = 7;
  for (std::size_t j = 0; j < rays.size; ++j)
    rays.set_direction(j, normalize(Vec3{0.01 * static_cast<double>(j), 0, -1}));
  rays.pad();
  std::vector<Hit> hits(rays.size);
  scene.closest(rays, hits);
  for (std::size_t j = 0; j < rays.size; ++j) {
    CHECK(hits[j].cos_incidence == -rays.z[j]);
    CHECK(hits[j].backscatter == 0.5 * -rays.z[j]);
  }
  return Shape::asked;
}

}  // namespace

TEST_CASE("a disc met squarely, at a slant, and missed") {
  const Scene<LeastGeometry> scene({disc({}, 7, {.reflectance = 0.5, .classification = 6})});
  const Hit square = ask(scene, {{0.5, 0, 10}, {0, 0, -1}});
  REQUIRE(square.met());
  CHECK(square.range == 10);
  CHECK(square.cos_incidence == 1);
  CHECK(square.backscatter == 0.5);
  CHECK(square.object == 7);
  CHECK(square.classification == 6);
  const Hit slant = ask(scene, {{0, -10, 10}, normalize(Vec3{0, 1, -1})});
  CHECK(slant.range == support::relative(std::sqrt(200.0), 1e-14));
  CHECK(slant.cos_incidence == support::relative(std::sqrt(0.5), 1e-14));
  CHECK(slant.backscatter == support::relative(0.5 * std::sqrt(0.5), 1e-14));
  CHECK_FALSE(ask(scene, {{1.5, 0, 10}, {0, 0, -1}}).met());
  CHECK_FALSE(ask(scene, {{0, 0, 10}, {0, 0, 1}}).met());
}

TEST_CASE("both sides of a surface count") {
  const Scene<LeastGeometry> scene({disc()});
  const Hit below = ask(scene, {{0, 0, -3}, {0, 0, 1}});
  CHECK(below.range == 3);
  CHECK(below.cos_incidence == 1);
}

TEST_CASE("nothing is met at the near end or before it, nor beyond the far end") {
  const Scene<LeastGeometry> scene({disc()});
  CHECK_FALSE(ask(scene, {{0, 0, 10}, {0, 0, -1}, 10}).met());
  CHECK(ask(scene, {{0, 0, 10}, {0, 0, -1}, 9.999}).met());
  CHECK(ask(scene, {{0, 0, 10}, {0, 0, -1}, 0, 10}).met());
  CHECK_FALSE(ask(scene, {{0, 0, 10}, {0, 0, -1}, 0, 9.999}).met());
}

TEST_CASE("a disc that is turned, scaled and moved is met where it stands, with ranges in metres of the world") {
  // three times as large, standing upright, facing north, at UTM coordinates
  const Vec3 utm{500000, 5400000, 300};
  const Scene<LeastGeometry> scene({disc({rotation_about(axis::right, pi / 2), 3, utm}, 5)});
  const Hit hit = ask(scene, {utm + Vec3{2.9, -50, 0}, axis::forward});
  REQUIRE(hit.met());
  CHECK(std::fabs(hit.range - 50) < 1e-8);
  CHECK(hit.cos_incidence == support::relative(1, 1e-12));
  CHECK(hit.object == 5);
  CHECK_FALSE(ask(scene, {utm + Vec3{3.1, -50, 0}, axis::forward}).met());
  CHECK(ask(scene, {utm + Vec3{0, -50, 2.9}, axis::forward}).met());
  CHECK_FALSE(ask(scene, {utm + Vec3{0, -50, 3.1}, axis::forward}).met());
}

TEST_CASE("an instance of a mesh answers as the same mesh transformed by hand") {
  int met = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Placement placement{any.rotation(), any.log_uniform(0.05, 20), any.point(1000)};
    const MeshData data = some_triangles(any, 200);
    MeshData moved = data;
    for (Vec3& v : moved.vertices) v = placement.point(v);
    const MaterialTable materials = material_table(
        {{.reflectance = 0.1}, {.reflectance = 0.5, .classification = 2}, {.reflectance = 0.9, .classification = 3}});
    using Mesh = TriangleMesh<>;
    const Scene<Mesh> instance({{std::make_shared<const Mesh>(data), materials, placement, 4}});
    const Scene<Mesh> by_hand({{std::make_shared<const Mesh>(moved), materials, {}, 4}});
    for (int k = 0; k < 20; ++k) {
      const Vec3 from = placement.point(any.unit() * 20.0), to = placement.point(any.point(4));
      const RayBundle rays = any.cone(from, normalize(to - from), 0.02, 16);
      std::array<Hit, RayBundle::capacity> a, b;
      instance.closest(rays, a);
      by_hand.closest(rays, b);
      for (std::size_t j = 0; j < rays.size; ++j) {
        REQUIRE(a[j].met() == b[j].met());
        if (!a[j].met()) continue;
        ++met;
        REQUIRE(std::fabs(a[j].range - b[j].range) < 1e-9 * (1 + b[j].range));
        REQUIRE(a[j].cos_incidence == support::relative(b[j].cos_incidence, 1e-8));
        REQUIRE(a[j].backscatter == support::relative(b[j].backscatter, 1e-8));
        REQUIRE(a[j].classification == b[j].classification);
        REQUIRE(a[j].object == 4);
      }
    }
  }
  CHECK(met > 1000);
}

TEST_CASE("a bundle's hits are those of its rays asked one by one") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Disc> discs;
    for (ObjectId k = 0; k < 50; ++k)
      discs.push_back(disc({any.rotation(), any.log_uniform(0.1, 10), any.point(50)}, k));
    const Scene<LeastGeometry> scene(discs);
    const RayBundle rays =
        any.cone(any.point(60), any.unit(), any.log_uniform(1e-4, 1), 1 + any.whole(RayBundle::capacity));
    std::array<Hit, RayBundle::capacity> hits;
    scene.closest(rays, hits);
    for (std::size_t j = 0; j < rays.size; ++j) {
      const Hit alone = ask(scene, rays.ray(j));
      REQUIRE(hits[j].range == alone.range);
      REQUIRE(hits[j].met() == alone.met());
      if (alone.met()) {
        REQUIRE(hits[j].object == alone.object);
        REQUIRE(hits[j].cos_incidence == alone.cos_incidence);
      }
    }
  }
}

TEST_CASE("of many parts the nearest is met, as if each were asked alone") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Disc> discs;
    for (ObjectId k = 0; k < 40; ++k)
      discs.push_back(disc({any.rotation(), any.log_uniform(1, 10), any.point(20)}, 100 + k));
    const Scene<LeastGeometry> scene(discs);
    for (int ray_number = 0; ray_number < 20; ++ray_number) {
      const Ray ray{any.point(40), any.unit()};
      Hit nearest;
      for (const Disc& d : discs) {
        const Hit hit = ask(Scene<LeastGeometry>({d}), ray);
        if (hit.range < nearest.range) nearest = hit;
      }
      const Hit hit = ask(scene, ray);
      REQUIRE(hit.range == nearest.range);
      if (hit.met()) REQUIRE(hit.object == nearest.object);
    }
  }
}

TEST_CASE("of parts in the same place the first in the list is met") {
  for (const ObjectId first : {1U, 2U}) {
    std::vector<Disc> discs{disc({}, first), disc({}, 3 - first)};
    for (ObjectId k = 0; k < 30; ++k) discs.push_back(disc({.translation = {0, 0, -1.0 - k}}, 10 + k));
    CHECK(ask(Scene<LeastGeometry>(discs), {{0, 0, 10}, {0, 0, -1}}).object == first);
  }
}

TEST_CASE("parts of several kinds of geometry stand in one scene") {
  using Mesh = TriangleMesh<>;
  const auto mesh = std::make_shared<const Mesh>(MeshData{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}});
  const Scene<LeastGeometry, Mesh> scene(
      {{std::make_shared<const LeastGeometry>(), material_table(), {.translation = {0, 0, 1}}, 1},
       {mesh, material_table(), {.translation = {10, 0, 2}}, 2}});
  CHECK(ask(scene, {{0, 0, 10}, {0, 0, -1}}).object == 1);
  CHECK(ask(scene, {{0, 0, 10}, {0, 0, -1}}).range == 9);
  CHECK(ask(scene, {{10, 0, 10}, {0, 0, -1}}).object == 2);
  CHECK(ask(scene, {{10, 0, 10}, {0, 0, -1}}).range == 8);
}

TEST_CASE("a flat primitive is asked for its surface once for all neighbours that met it, any other by each ray") {
  CHECK(surfaces_asked<Counted<true>>() == 1);
  CHECK(surfaces_asked<Counted<false>>() == 7);
}

TEST_CASE("rays of NaN miss and do not disturb their neighbours") {
  const Scene<LeastGeometry> scene({disc()});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(ask(scene, {{nan, 0, 10}, {0, 0, -1}}).met());
  CHECK_FALSE(ask(scene, {{0, 0, 10}, {nan, nan, nan}}).met());
}

TEST_CASE("ten thousand trees cost less than twice the memory of one and 300 bytes a tree") {
  support::Generator any(2);
  using Mesh = TriangleMesh<>;
  const auto tree = std::make_shared<const Mesh>(some_triangles(any, 60'000));
  const auto materials = material_table({{.name = "a name too long to be held in place"}, {}, {}});
  const std::size_t alone = Scene<Mesh>({{tree, materials}}).memory();
  std::vector<Part<Mesh>> wood;
  for (ObjectId k = 0; k < 10'000; ++k)
    wood.push_back(
        {.geometry = tree,
         .materials = materials,
         .placement = {rotation_about(axis::up, any.uniform(0, 2 * pi)), any.uniform(0.5, 2), any.point(1000)},
         .object = k,
         .name = "tree " + std::to_string(k)});
  const Scene<Mesh> scene(std::move(wood));
  CHECK(scene.memory() < 2 * alone + 10'000 * 300);
  CHECK(scene.memory() > alone + 10'000 * sizeof(Part<Mesh>));
  CHECK(scene.parts()[77].name == "tree 77");
}

TEST_CASE("the memory of a scene counts names and tables of materials, a shared one once") {
  const auto memory = [](std::vector<Disc> parts) { return Scene<LeastGeometry>(std::move(parts)).memory(); };
  Disc a = disc(), b = disc();
  const std::size_t separate = memory({a, b});
  b.materials = a.materials;
  CHECK(memory({a, b}) == separate - sizeof(std::vector<Material>) - sizeof(Material));
  b.name.assign(1000, 'x');
  CHECK(memory({a, b}) > separate - sizeof(std::vector<Material>) - sizeof(Material) + 1000);
}

TEST_CASE("the bounds of a scene hold all of its parts") {
  const Scene<LeastGeometry> scene({disc({.translation = {100, 0, 0}}), disc({.scale = 5})});
  CHECK(scene.bounds().min.x == support::relative(-5, 1e-12));
  CHECK(scene.bounds().max.x == support::relative(101, 1e-12));
  CHECK(scene.parts().size() == 2);
}

TEST_CASE("a scene refuses parts that cannot be") {
  CHECK_THROWS_AS(Scene<LeastGeometry>({disc({.scale = 0})}), SettingError);
  CHECK_THROWS_AS(Scene<LeastGeometry>({Disc{nullptr}}), SettingError);
  CHECK_THROWS_AS(Scene<LeastGeometry>({Disc{std::make_shared<const LeastGeometry>(), nullptr}}), SettingError);
  CHECK_THROWS_AS(Scene<LeastGeometry>({Disc{std::make_shared<const LeastGeometry>(), material_table({})}}),
                  SettingError);
}

TEST_CASE("an empty scene is met nowhere") {
  const Scene<LeastGeometry> scene(std::vector<Disc>{});
  CHECK_FALSE(ask(scene, {{0, 0, 10}, {0, 0, -1}}).met());
}

TEST_CASE("the height of the ground is that of the highest ground, whatever grows or stands on it") {
  const Material soil{.ground = true}, leaf{};
  const Scene<LeastGeometry> scene(
      {disc({.translation = {0, 0, 3}}, 1, leaf), disc({.translation = {0, 0, 1}}, 2, soil),
       disc({.translation = {0.5, 0, -2}}, 3, soil), disc({.scale = 2, .translation = {0, 0, 2}}, 4, leaf)});
  CHECK(scene.ground_height({0, 0}).value() == 1);
  CHECK(scene.ground_height({1.2, 0}).value() == -2);
  CHECK_FALSE(scene.ground_height({-1.5, 0}).has_value());  // leaves alone
  CHECK_FALSE(scene.ground_height({9, 9}).has_value());
}

TEST_CASE("of several levels of ground, the one nearest to a height is found") {
  const Material soil{.ground = true}, leaf{};
  const Scene<LeastGeometry> scene(
      {disc({.translation = {0, 0, 6}}, 1, soil), disc({.translation = {0, 0, 0}}, 2, soil),
       disc({.translation = {0, 0, 3}}, 3, leaf), disc({.translation = {0, 0, -4}}, 4, soil)});
  const auto near = [&](double height) { return scene.ground_height({0, 0}, height).value(); };
  CHECK(scene.ground_height({0, 0}).value() == 6);
  CHECK(near(std::numeric_limits<double>::infinity()) == 6);
  CHECK(near(100) == 6);
  CHECK(near(3.1) == 6);
  CHECK(near(2.9) == 0);
  CHECK(near(0) == 0);
  CHECK(near(-1.9) == 0);
  CHECK(near(-2.1) == -4);
  CHECK(near(-100) == -4);
  CHECK_FALSE(scene.ground_height({9, 9}, 0).has_value());
}

TEST_CASE("ground under a part that lies exactly on it is found, whatever the order of the parts") {
  const auto sheet = [](double z, bool ground) {
    const MeshData mesh{.vertices = {{-5, -5, z}, {5, -5, z}, {5, 5, z}, {-5, 5, z}},
                        .triangles = {{0, 1, 2}, {0, 2, 3}}};
    return Scene<TriangleMesh<>>::Part{.geometry = std::make_shared<const TriangleMesh<>>(mesh),
                                       .materials = material_table({{.ground = ground}})};
  };
  std::vector parts{sheet(1.3, false), sheet(1.3, true), sheet(1.3, false), sheet(4, false)};
  for (std::size_t turn = 0; turn < parts.size(); ++turn) {
    std::rotate(parts.begin(), parts.begin() + 1, parts.end());
    CHECK(Scene<TriangleMesh<>>(parts).ground_height({1, 2}).value() == support::relative(1.3, 1e-14));
  }
}

TEST_CASE("the ground of a slope at UTM coordinates is where it should be") {
  const double east = 4.7e5, north = 5.4e6;
  const MeshData slope{.vertices = {{east, north, 100},
                                    {east + 100, north, 110},
                                    {east + 100, north + 100, 130},
                                    {east, north + 100, 120}},
                       .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const Scene<TriangleMesh<>> scene(
      {{.geometry = std::make_shared<const TriangleMesh<>>(slope), .materials = material_table({{.ground = true}})}});
  CHECK(std::fabs(scene.ground_height({east + 30, north + 50}).value() - (100 + 3 + 10)) < 1e-8);
}

TEST_CASE("a scene of other placements meets what a scene made of these parts meets") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Disc> discs;
    const std::size_t count = 1 + any.whole(150);
    const auto anywhere = [&] { return Placement{any.rotation(), any.log_uniform(0.1, 10), any.point(50)}; };
    for (ObjectId k = 0; k < count; ++k) discs.push_back(disc(anywhere(), k));
    Scene<LeastGeometry> now(discs), unused({});
    for (int tick = 0; tick < 6; ++tick) {
      std::vector<Placement> placements;
      for (Disc& d : discs) {
        d.placement.translation = d.placement.translation + any.point(1);
        if (tick == 4) d.placement = anywhere();  // the index is made anew
        placements.push_back(d.placement);
      }
      Scene<LeastGeometry> next =
          tick % 2 ? now.with_placements(placements) : now.with_placements(placements, std::move(unused));
      unused = std::exchange(now, std::move(next));
      const Scene<LeastGeometry> fresh(discs);
      for (int k = 0; k < 30; ++k) {
        const RayBundle rays = any.cone(any.point(60), any.unit(), any.log_uniform(1e-4, 1), any.coin() ? 1 : 40);
        std::array<Hit, RayBundle::capacity> hits, expected;
        now.closest(rays, hits);
        fresh.closest(rays, expected);
        for (std::size_t j = 0; j < rays.size; ++j) {
          REQUIRE(hits[j].range == expected[j].range);
          REQUIRE(hits[j].object == expected[j].object);
          REQUIRE(hits[j].cos_incidence == expected[j].cos_incidence);
        }
      }
      for (int k = 0; k < 3; ++k) {
        REQUIRE(now.bounds().min[k] == doctest::Approx(fresh.bounds().min[k]));
        REQUIRE(now.bounds().max[k] == doctest::Approx(fresh.bounds().max[k]));
      }
    }
  }
}

TEST_CASE("of two scenes placed by turns nothing is allocated after the second tick") {
  support::Generator any(5);
  std::vector<Disc> discs;
  for (ObjectId k = 0; k < 500; ++k) {
    discs.push_back(disc({.translation = any.point(50)}, k));
    discs.back().name = "a name too long to be held in place, number " + std::to_string(k);
  }
  std::vector<Placement> placements;
  for (const Disc& d : discs) placements.push_back(d.placement);
  Scene<LeastGeometry> now(discs), unused(discs);
  std::size_t before = 0;
  for (int tick = 0; tick < 8; ++tick) {
    if (tick == 2) before = support::allocations;
    for (Placement& placement : placements) placement.translation.x += 0.1;
    Scene<LeastGeometry> next = now.with_placements(placements, std::move(unused));
    unused = std::move(now);
    now = std::move(next);
  }
  CHECK(support::allocations == before);
  CHECK(now.parts()[7].placement.translation == placements[7].translation);
}

TEST_CASE("a scene is placed anew beside a copy that is still used, and into itself") {
  const std::array<Placement, 3> lower{}, higher{Placement{.translation = {0, 0, 1}}, {.translation = {0, 0, 2}}, {}};
  Scene<LeastGeometry> now({disc({}, 1), disc({}, 2), disc({}, 3)});
  const Ray down{{0, 0, 10}, {0, 0, -1}};
  now = now.with_placements(lower);
  const Scene<LeastGeometry> copy = now;
  now = now.with_placements(higher, std::move(now));
  CHECK(ask(now, down).range == 8);
  CHECK(ask(now, down).object == 2);
  CHECK(ask(copy, down).range == 10);
}

TEST_CASE("a scene placed in the memory of another one has nothing of the other's parts") {
  const std::array<Placement, 2> apart{Placement{}, {.translation = {10, 0, 0}}};
  const Scene<LeastGeometry> scene({disc({}, 1), disc({}, 2)});
  const std::vector<std::vector<Disc>> others{{}, {disc({}, 7)}, {disc({}, 8), disc({}, 9)}, {disc(), disc(), disc()}};
  for (const std::vector<Disc>& other : others) {
    CAPTURE(other.size());
    const Scene<LeastGeometry> placed = scene.with_placements(apart, Scene<LeastGeometry>(other));
    CHECK(placed.parts().size() == 2);
    CHECK(ask(placed, {{0, 0, 10}, {0, 0, -1}}).object == 1);
    CHECK(ask(placed, {{10, 0, 10}, {0, 0, -1}}).object == 2);
  }
}

TEST_CASE("placements of another number or out of range are refused") {
  const Scene<LeastGeometry> scene({disc()});
  CHECK_THROWS_WITH_AS(static_cast<void>(scene.with_placements({})),
                       "Scene::with_placements (number) is 0, but must be from 1 to 1", SettingError);
  const std::array<Placement, 1> flat{Placement{.scale = 0}};
  CHECK_THROWS_AS(static_cast<void>(scene.with_placements(flat)), SettingError);
  const std::array<Placement, 1> coarse{Placement{.rotation = Rotation{1.0005, 0, 0, 0}}};
  CHECK(length(scene.with_placements(coarse).parts()[0].placement.rotation) == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("parts are added and removed, and share their geometry") {
  const Scene<LeastGeometry> scene({disc({}, 1), disc({.translation = {0, 0, 1}}, 2)});
  const std::array<Disc, 1> more{disc({.translation = {0, 0, 3}}, 3)};
  const Ray down{{0, 0, 10}, {0, 0, -1}};
  const Scene<LeastGeometry> fuller = scene.with_parts(more);
  CHECK(fuller.parts().size() == 3);
  CHECK(fuller.parts()[0].object == 1);
  CHECK(fuller.parts()[2].object == 3);
  CHECK(fuller.parts()[0].geometry == scene.parts()[0].geometry);
  CHECK(ask(fuller, down).object == 3);
  const Scene<LeastGeometry> emptier = fuller.without([](const Disc& part) { return part.object >= 2; });
  CHECK(emptier.parts().size() == 1);
  CHECK(ask(emptier, down).object == 1);
  CHECK(scene.without([](const Disc&) { return true; }).parts().empty());
}

TEST_CASE("the user's threads build the index of a scene, which is the same on any") {
  support::CountingExecutor executor;
  support::Generator any(11);
  std::vector<Disc> discs;
  std::vector<Placement> placements;
  for (ObjectId k = 0; k < 10'000; ++k) {
    discs.push_back(disc({.translation = any.point(200)}, k));
    placements.push_back({.translation = any.point(200)});
  }
  const Scene<LeastGeometry> alone(discs, 1), shared(discs, executor);
  CHECK(executor.calls() > 0);
  const Scene<LeastGeometry> placed = shared.with_placements(placements, executor);
  CHECK(executor.calls() > 0);  // the index is made anew
  const Scene<LeastGeometry> again = shared.with_placements(placements, Scene<LeastGeometry>({}), executor);
  CHECK(executor.calls() > 0);
  const Scene<LeastGeometry> fuller = shared.with_parts(std::span(discs).first(1), executor);
  CHECK(executor.calls() > 0);
  const Scene<LeastGeometry> fewer = shared.without([](const Disc& part) { return part.object == 0; }, executor);
  CHECK(executor.calls() > 0);
  CHECK(alone.memory() == shared.memory());
  const Scene<LeastGeometry> placed_alone = alone.with_placements(placements, 1);
  for (int k = 0; k < 500; ++k) {
    const Ray ray{any.point(200), any.unit()};
    REQUIRE(ask(shared, ray).range == ask(alone, ray).range);
    REQUIRE(ask(placed, ray).range == ask(placed_alone, ray).range);
    REQUIRE(ask(again, ray).range == ask(placed_alone, ray).range);
  }
}

namespace {
using Mesh = TriangleMesh<>;
}  // namespace

TEST_CASE("no ray meets anything of a cone that is said to meet nothing, and of most that meet nothing it is said") {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const auto mesh = std::make_shared<const Mesh>(support::soup(any, 60, 3));
    const Placement placed{any.rotation(), any.log_uniform(0.3, 3), any.point(5)};
    const Scene<Mesh> alone({{.geometry = mesh}}), turned({{.geometry = mesh, .placement = placed}});
    std::vector<Part<Mesh, LeastGeometry>> parts{{.geometry = mesh, .placement = placed}};
    for (int k = 0; k < 20; ++k)
      parts.push_back(
          {.geometry = std::make_shared<const LeastGeometry>(), .placement = {any.rotation(), 1, any.point(40)}});
    const Scene<Mesh, LeastGeometry> several(parts);
    std::size_t of_one = 0, of_turned = 0, of_several = 0;
    CHECK(support::cone_laws(alone, support::cones_from(20, seed, 2000), of_one) == "");
    CHECK(support::cone_laws(turned, support::cones_from(20, seed, 2000), of_turned) == "");
    CHECK(support::cone_laws(several, support::cones_from(60, seed, 2000), of_several) == "");
    CHECK(of_one > 1000);
    CHECK(of_turned > 500);
    CHECK(of_several > 700);
  }
}

TEST_CASE("a cone between the parts of a scene, or between the branches of its only mesh, meets nothing") {
  MeshData posts;  // two at the ends of a square, whose bounds are the square
  for (const double at : {0.0, 10.0}) support::add_triangle(posts, {{at, at, 0}, {at + 0.1, at, 0}, {at, at, 9}});
  for (int k = 1; k < 40; ++k) support::add_triangle(posts, {{0, 0.01 * k, 0}, {0.1, 0.01 * k, 0}, {0, 0.01 * k, 9}});
  const auto mesh = std::make_shared<const Mesh>(posts);
  const RayCone across{.origin = {10, -1, 4}, .direction = normalize(Vec3{-1, 1, 0}), .spread = 1e-3};
  REQUIRE_FALSE(across.passes(mesh->bounds()));
  CHECK(Scene<Mesh>({{.geometry = mesh}}).misses_cone(across));
  const RayCone along{.origin = {10.02, 20, 1}, .direction = -axis::forward, .spread = 1e-3};
  CHECK_FALSE(Scene<Mesh>({{.geometry = mesh}}).misses_cone(along));
  const Scene<Mesh> two({{.geometry = mesh}, {.geometry = mesh, .placement = {.translation = {30, 0, 0}}}});
  CHECK(two.misses_cone({.origin = {20, -5, 4}, .direction = axis::forward, .spread = 1e-2}));
}
