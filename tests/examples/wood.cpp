// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include "../../examples/wood.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <variant>

#include <pulsecast/geometry/bundle.hpp>

using namespace pulsecast;

namespace {

const wood::Scene& first_wood() {
  static const wood::Scene scene = wood::scene(1);
  return scene;
}

const wood::Scene& second_wood() {
  static const wood::Scene scene = wood::scene(2);
  return scene;
}

const wood::Mesh& mesh_of(const wood::Scene::Part& part) { return *part.geometry; }

std::vector<Vec3> corners(const wood::Mesh& mesh) {
  std::vector<Vec3> all;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Triangle t = mesh.triangle(static_cast<PrimitiveIndex>(i));
    all.insert(all.end(), {t.a, t.b, t.c});
  }
  return all;
}

Hit seen(const wood::Scene& scene, const Vec3& from, const Vec3& direction) {
  std::array<Hit, 1> hits;
  scene.closest(bundle_of({.origin = from, .direction = normalize(direction)}), hits);
  return hits[0];
}

/// The height of the ground alone, met from above.
double ground_at(const wood::Scene& scene, const Vec3& place) {
  const auto& ground = scene.parts().front();
  const RayBundle down =
      bundle_of({.origin = Vec3(place.x, place.y, 100) - ground.placement.translation, .direction = -axis::up});
  ClosestHits nearest(down);
  mesh_of(ground).closest(down, nearest);
  return nearest.met(0) ? 100 - nearest.range[0] : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

TEST_CASE("a seed gives the same wood again, and another seed another wood") {
  const auto again = wood::scene(1);
  REQUIRE(again.parts().size() == first_wood().parts().size());
  for (std::size_t i = 0; i < again.parts().size(); ++i) {
    CHECK(again.parts()[i].placement.translation == first_wood().parts()[i].placement.translation);
    CHECK(corners(mesh_of(again.parts()[i])) == corners(mesh_of(first_wood().parts()[i])));
  }
  CHECK(second_wood().parts().back().placement.translation != first_wood().parts().back().placement.translation);
}

TEST_CASE("the wood has more than 200,000 triangles, each stored once however many trees share it") {
  std::set<const wood::Mesh*> models;
  std::size_t stored = 0, standing = 0;
  for (const auto& part : first_wood().parts()) {
    standing += mesh_of(part).size();
    if (models.insert(&mesh_of(part)).second) stored += mesh_of(part).size();
  }
  CHECK(stored > 200'000);
  CHECK(standing > 10 * stored);
  CHECK(models.size() == 10);
}

TEST_CASE("all that grows stands on the ground and within the plot") {
  const auto parts = first_wood().parts();
  for (std::size_t i = 1; i < parts.size(); ++i) {
    CAPTURE(i);
    const Vec3& foot = parts[i].placement.translation;
    CHECK(max_norm({foot.x, foot.y, 0}) < wood::side / 2);
    CHECK(std::fabs(foot.z - ground_at(first_wood(), foot)) < 0.25);
  }
}

TEST_CASE("every part has a number of its own, as the labels of its points") {
  std::set<ObjectId> numbers;
  for (const auto& part : first_wood().parts()) numbers.insert(part.object);
  CHECK(numbers.size() == first_wood().parts().size());
}

TEST_CASE("a tripod has room at every glade") {
  for (const std::uint64_t seed : {1u, 2u}) {
    const wood::Scene& scene = seed == 1 ? first_wood() : second_wood();
    for (const Vec3& glade : wood::glades(seed)) {
      CAPTURE(seed);
      CAPTURE(glade.x);
      CAPTURE(glade.y);
      CHECK(seen(scene, glade + axis::up, -axis::up).classification == 2);
      CHECK(seen(scene, glade + axis::up, -axis::up).range == doctest::Approx(1).epsilon(0.05));
      for (int k = 0; k < 72; ++k)
        CHECK(seen(scene, glade + 1.7 * axis::up, {std::cos(k * pi / 36), std::sin(k * pi / 36), 0}).range > 1);
    }
  }
}

TEST_CASE("a leaf has the size it is given") {
  MeshData leaf;
  wood::add_leaf(leaf, {1, 2, 3}, {0.2, 0, 0}, {0, 0.05, 0}, wood::leaf);
  REQUIRE(leaf.triangles.size() == 2);
  CHECK(length(leaf.vertices[2] - leaf.vertices[0]) == doctest::Approx(0.2));
  CHECK(length(leaf.vertices[3] - leaf.vertices[1]) == doctest::Approx(0.1));
}

TEST_CASE("an axis keeps its length and grows thinner") {
  wood::Dice dice(7, 1);
  const wood::Axis axis = wood::grow(dice, {}, axis::up, {.length = 3, .radius = 0.2, .wander = 0.3, .steps = 10});
  double along = 0;
  for (std::size_t k = 1; k < axis.points.size(); ++k) {
    along += length(axis.points[k] - axis.points[k - 1]);
    CHECK(axis.radii[k] < axis.radii[k - 1]);
  }
  CHECK(along == doctest::Approx(3));
}
