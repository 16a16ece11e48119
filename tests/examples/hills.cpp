// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include "../../examples/hills.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <variant>

#include <pulsecast/geometry/bundle.hpp>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {

const hills::Scene& valley() {
  static const hills::Scene scene = hills::scene(1);
  return scene;
}

const hills::Mesh& mesh_of(const hills::Scene::Part& part) { return *part.geometry; }

/// What a plumb line meets at a place relative to the middle; `height` is of what is met [m].
struct Met {
  Hit hit;
  double height;
};

Met below(const Vec2& at) {
  const Vec3 from = hills::middle + Vec3{at.x, at.y, 1000};
  std::array<Hit, 1> hits;
  valley().closest(bundle_of({.origin = from, .direction = -axis::up}), hits);
  return {hits[0], from.z - hits[0].range};
}

}  // namespace

TEST_CASE("a seed gives the same hills again, and another seed other hills") {
  const hills::Terrain terrain(1), again(1), other(2);
  CHECK(terrain.mesh().vertices == again.mesh().vertices);
  CHECK(terrain.mesh().vertices != other.mesh().vertices);
}

TEST_CASE("the ground has more than 200,000 triangles, and fills its square around its middle") {
  const auto& ground = valley().parts().front();
  CHECK(mesh_of(ground).size() > 200'000);
  CHECK(length(ground.placement.box(mesh_of(ground).bounds()).size() * Vec3{1, 1, 0} -
               Vec3{hills::side, hills::side, 0}) < 1e-6);
  CHECK(ground.placement.translation == hills::middle);
}

TEST_CASE("river and road run through the valley and do not meet") {
  std::size_t wet = 0, paved = 0;
  for (double y = -390; y <= 390; y += 10) {
    CAPTURE(y);
    CHECK(hills::Terrain::from_river({hills::Terrain::road(y), y}) > 15);
    wet += below({hills::Terrain::river(y), y}).hit.classification == 9;
    paved += below({hills::Terrain::road(y), y}).hit.classification == 11;
  }
  CHECK(wet > 60);  // of 79; trees hang over the others
  CHECK(paved > 60);
}

TEST_CASE("houses and trees stand on the ground, off river and road") {
  const hills::Terrain terrain(1);
  const auto parts = valley().parts();
  CHECK(parts.size() > 2000);
  for (std::size_t k = 1; k < parts.size(); ++k) {
    CAPTURE(k);
    CHECK(parts[k].object == k);
    const Vec3 foot = parts[k].placement.translation - hills::middle;
    CHECK(std::fabs(foot.z - terrain.height({foot.x, foot.y})) < 1e-9);
    CHECK(hills::Terrain::from_river({foot.x, foot.y}) > 8);
    CHECK(hills::Terrain::from_road({foot.x, foot.y}) > 3.5);
  }
}

TEST_CASE("a house has a roof at the height it is given") {
  const hills::Mesh house(hills::house(9, 12, 5.5, 9.5));
  const RayBundle down = bundle_of({.origin = {0, 1, 100}, .direction = -axis::up});
  ClosestHits nearest(down);
  house.closest(down, nearest);
  CHECK(100 - nearest.range[0] == doctest::Approx(9.5));
  CHECK(house.bounds().max.z == doctest::Approx(9.5));
  CHECK(house.bounds().size().y == doctest::Approx(13));
}
