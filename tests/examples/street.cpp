// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include "../../examples/street.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

#include <pulsecast/geometry/bundle.hpp>
#include <pulsecast/platform/ground_vehicle.hpp>

#include <doctest/doctest.h>

using namespace pulsecast;

namespace {

const street::Scene& town() {
  static const street::Scene scene = street::scene(1);
  return scene;
}

const street::Mesh& mesh_of(const street::Scene::Part& part) { return *part.geometry; }

std::vector<Vec3> corners(const street::Mesh& mesh) {
  std::vector<Vec3> all;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Triangle t = mesh.triangle(static_cast<PrimitiveIndex>(i));
    all.insert(all.end(), {t.a, t.b, t.c});
  }
  return all;
}

Hit seen(const Vec3& from, const Vec3& direction) {
  std::array<Hit, 1> hits;
  town().closest(bundle_of({.origin = from, .direction = normalize(direction)}), hits);
  return hits[0];
}

}  // namespace

TEST_CASE("a seed gives the same streets again, and another seed other streets") {
  const auto again = street::scene(1), other = street::scene(2);
  REQUIRE(again.parts().size() == town().parts().size());
  for (std::size_t i = 0; i < again.parts().size(); ++i) {
    CHECK(again.parts()[i].placement.translation == town().parts()[i].placement.translation);
    CHECK(corners(mesh_of(again.parts()[i])) == corners(mesh_of(town().parts()[i])));
  }
  CHECK(other.parts()[5].placement.translation != town().parts()[5].placement.translation);
}

TEST_CASE("the streets have about 50,000 triangles, each counted as often as it stands there") {
  std::size_t triangles = 0;
  for (const auto& part : town().parts()) triangles += mesh_of(part).size();
  CHECK(triangles > 40'000);
  CHECK(triangles < 60'000);
}

TEST_CASE("the ground is where the height says, from edge to edge, and goes up at the kerb") {
  for (double y = -90; y < 90; y += 3.1) {
    for (double x = -60; x < 60; x += 2.3) {
      const auto ground = town().ground_height({x, y});
      REQUIRE(ground);
      CHECK(std::fabs(*ground - street::height({x, y})) < 2e-3);
    }
  }
  CHECK(std::fabs(street::height({6.1, 40}) - street::height({5.9, 40}) - street::kerb) < 0.01);
}

TEST_CASE("houses stand on both sides, the way between them is free, and the houses have their fronts to it") {
  int houses = 0;
  for (double y = -80; y <= 80; y += 1) {
    const Vec3 eye = street::on({0, y}) + 4.5 * axis::up;
    if (std::fabs(y) < 12) continue;
    for (const Vec3& aside : {axis::right, -axis::right}) {
      const Hit hit = seen(eye, aside);
      if (hit.classification != 6) continue;  // a tree, or a lamp post
      ++houses;
      CHECK(std::fabs(hit.range - street::front) < 0.4);
    }
  }
  CHECK(houses > 150);
  CHECK(seen(street::on({1.9, -85}) + 1.5 * axis::up, axis::forward + Vec3{0, 0, 0.02}).range > 150);
}

TEST_CASE("a car that drives there has its wheels on the ground") {
  const auto ground = [](const Vec2& place) { return town().ground_height(place); };
  const GroundVehicleSettings settings;
  const auto drive = plan_ground_vehicle(std::vector<Vec2>{{1.9, -80}, {1.9, -1.9}, {40, -1.9}, {48, -0.6}, {38, 1.9}},
                                         ground, settings);
  double farthest = 0;
  for (double t = 0; t < drive.duration().seconds(); t += 0.05) {
    for (const double x : {-settings.track / 2, settings.track / 2}) {
      for (const double y : {0.0, settings.wheelbase}) {
        const Vec3 wheel = drive.at(Tick::of_seconds(t)).point({x, y, 0});
        farthest = std::fmax(farthest, std::fabs(*ground({wheel.x, wheel.y}) - wheel.z));
      }
    }
  }
  CHECK(farthest < 0.02);
}
