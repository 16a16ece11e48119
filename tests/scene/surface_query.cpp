// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/surface_query.hpp>

#include <cstdint>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

namespace pulsecast {
namespace {

using Map = Scene<TriangleMesh<>>;

/// Wall across the view at a distance [m], of the second of two materials.
Map::Part wall(double y, ObjectId object, std::uint16_t classification) {
  MeshData mesh{{{-5, y, -5}, {5, y, -5}, {5, y, 5}, {-5, y, 5}}, {{0, 1, 2}, {0, 2, 3}}, {1, 1}};
  return {.geometry = std::make_shared<const TriangleMesh<>>(std::move(mesh)),
          .materials = material_table({{}, {.classification = classification}}),
          .object = object};
}

TEST_CASE("an echo's surface has part, material and normal, in one scene and in layers") {
  const Map still({wall(30, 1, 6), wall(10, 2, 5)}), moving({wall(20, 3, 4)});
  const Layered world{still, moving};
  const SurfaceQuery of_scene = surfaces_of(still), of_layers = surfaces_of(world);
  const Shot shot{.direction = axis::forward};
  const std::vector<Shot> shots{shot};
  const EchoBatch batch{shots, {}, {}, 0};
  const auto at = of_scene(batch, shots[0], {.range = 30.05, .object = 1, .classification = 6});
  REQUIRE(at);
  CHECK(at->part == 0);
  CHECK(at->material_index == 1);
  CHECK(at->normal == -axis::forward);
  CHECK(of_scene(batch, shots[0], {.range = 10, .object = 2, .classification = 5})->part == 1);
  CHECK(of_layers(batch, shots[0], {.range = 19.9, .object = 3, .classification = 4})->object == 3);
  CHECK_FALSE(of_scene(batch, shots[0], {.range = 30.5, .object = 1, .classification = 6}));  // beyond the tolerance
  CHECK_FALSE(of_scene(batch, shots[0], {.range = 30, .object = 2, .classification = 6}));    // another object's echo
  CHECK_THROWS_AS(static_cast<void>(surfaces_of(still, 0)), SettingError);
}

TEST_CASE("with recorded subrays, an echo beside the axis finds its surface, too") {
  const Map scene({wall(30, 1, 6)});
  const SurfaceQuery surfaces = surfaces_of(scene);
  const std::vector<Shot> shots{{.direction = normalize(Vec3{1, 5, 0})}};  // passes the wall by
  const Echo echo{.range = 30, .object = 1, .classification = 6};
  std::vector<SubrayRecord> subrays(2);
  subrays[1].range = 30;
  subrays[1].object = 1;
  subrays[1].classification = 6;
  subrays[1].point = {0, 30, 0};
  CHECK_FALSE(surfaces({shots, {}, {}, 0}, shots[0], echo));
  CHECK(surfaces({shots, {}, {}, 0, subrays}, shots[0], echo)->part == 0);
}

TEST_CASE("surfaces of one place that belong to other objects are passed over") {
  const Map scene({wall(30, 1, 6), wall(30.05, 2, 6), wall(30.1, 3, 6)});
  const SurfaceQuery surfaces = surfaces_of(scene);
  const std::vector<Shot> shots{{.direction = axis::forward}};
  CHECK(surfaces({shots, {}, {}, 0}, shots[0], {.range = 30, .object = 3, .classification = 6})->part == 2);
}

}  // namespace
}  // namespace pulsecast
