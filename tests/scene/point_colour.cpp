// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/point_colour.hpp>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/material/spectrum.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

using namespace pulsecast;

namespace {

using Map = Scene<TriangleMesh<>>;

/// Wall of 2 m by 2 m across the view, 10 m ahead, whose lower left corner has the texture coordinates (0, 0) and its
/// upper right one (1, 1).
Map::Part wall(Material material) {
  return {.geometry = std::make_shared<const TriangleMesh<>>(
              MeshData{.vertices = {{-1, 10, -1}, {1, 10, -1}, {1, 10, 1}, {-1, 10, 1}},
                       .triangles = {{0, 1, 2}, {0, 2, 3}},
                       .texture = {{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)}, {Vec2(0, 0), Vec2(1, 1), Vec2(0, 1)}}}),
          .materials = material_table({std::move(material)}),
          .object = 4};
}

/// Red and green above, blue and a grey below.
std::shared_ptr<const Image> four_pixels() {
  return std::make_shared<const Image>(
      Image{2, 2, 3, std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 102, 102, 102}});
}

/// Colour of the echo where a ray from the origin meets the wall at a place on it [m].
std::optional<PointColour> colour_at(const PointColours& colours, double x, double z, double range_error = 0) {
  const Vec3 to(x, 10, z);
  const std::vector<Shot> shots{{.direction = normalize(to), .echoes = 1}};
  const std::vector<Echo> echoes{{.range = length(to) + range_error, .object = 4}};
  return colours(EchoBatch{shots, echoes, {}, 0}, shots[0], echoes[0]);
}

}  // namespace

TEST_CASE("each point of a wall with a picture has the colour of its pixel") {
  const Map scene({wall({.reflectance = 0, .picture = four_pixels()})});
  const PointColours colours = colours_of(scene);
  CHECK(colour_at(colours, -0.5, 0.5) == PointColour{65535, 0, 0});
  CHECK(colour_at(colours, 0.5, 0.5) == PointColour{0, 65535, 0});
  CHECK(colour_at(colours, -0.5, -0.5) == PointColour{0, 0, 65535});
  CHECK(colour_at(colours, 0.5, -0.5) == PointColour{26214, 26214, 26214});  // 102 / 255 is 0.4
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-0.999, 0.999);
  for (int n = 0; n < 1000; ++n) {
    const double x = place(random), z = place(random);
    if (std::fabs(x) < 1e-6 || std::fabs(z) < 1e-6) continue;  // between pixels
    CAPTURE(n);
    CAPTURE(x);
    CAPTURE(z);
    const PointColour expected = x < 0   ? z < 0 ? PointColour{0, 0, 65535} : PointColour{65535, 0, 0}
                                   : z < 0 ? PointColour{26214, 26214, 26214}
                                         : PointColour{0, 65535, 0};
    CHECK(colour_at(colours, x, z) == expected);
  }
}

TEST_CASE("a picture is multiplied by the colour of its material; without one, that colour alone is the point's") {
  const Map dyed({wall({.reflectance = 0, .colour = {0.5, 0.25, 1}, .picture = four_pixels()})});
  const PointColours colours = colours_of(dyed);
  CHECK(colour_at(colours, -0.5, 0.5) == PointColour{32768, 0, 0});  // 32767.5 is rounded away from zero
  CHECK(colour_at(colours, 0.5, -0.5) == PointColour{13107, 6554, 26214});
  const Map plain({wall({.reflectance = 0, .colour = {0.2, 0, 1}})});
  CHECK(colour_at(colours_of(plain), 0.3, 0.7) == PointColour{13107, 0, 65535});
  const Map usual({wall({.reflectance = 0})});
  CHECK(colour_at(colours_of(usual), 0.3, 0.7) == PointColour{65535, 65535, 65535});
}

TEST_CASE("without texture coordinates, a picture does not count") {
  Map::Part part = wall({.reflectance = 0, .colour = {1, 0.4, 0}, .picture = four_pixels()});
  part.geometry = std::make_shared<const TriangleMesh<>>(
      MeshData{{{-1, 10, -1}, {1, 10, -1}, {1, 10, 1}, {-1, 10, 1}}, {{0, 1, 2}, {0, 2, 3}}});
  const Map scene({part});
  CHECK(colour_at(colours_of(scene), -0.5, 0.5) == PointColour{65535, 26214, 0});
}

TEST_CASE("the near infrared is the reflectance there: that of the spectrum at 842 nm, else that of the material") {
  const Map grey({wall({.reflectance = 0.4, .colour = {0, 0, 0}})});
  CHECK(colour_at(colours_of(grey), 0, 0.5)->near_infrared == 26214);
  // from 0.1 at 642 nm to 0.9 at 1042 nm in a straight line: 0.5 at 842 nm
  const std::vector<SpectralSample> line{{642e-9, 0.1}, {1042e-9, 0.9}};
  const auto leaf = std::make_shared<const Spectrum>(line);
  const Map green({wall({.reflectance = 0.2, .spectrum = leaf, .colour = {0, 0, 0}})});
  CHECK(colour_at(colours_of(green), 0, 0.5) == PointColour{0, 0, 0, 32768});
}

TEST_CASE("shares beyond black and white are cut, so that no colour wraps around") {
  const Material bright{.reflectance = 1.5, .colour = {2, -1, 0.5}};  // not validated
  CHECK(colour_of({.material = &bright}) == PointColour{65535, 0, 32768, 65535});
}

TEST_CASE("an echo without a surface has no colour, and a tolerance of zero is refused") {
  const Map scene({wall({.picture = four_pixels()})});
  CHECK(colour_at(colours_of(scene), 0.5, 0.5, 0.15));
  CHECK_FALSE(colour_at(colours_of(scene), 0.5, 0.5, 0.25));  // too far from the wall
  CHECK(colour_at(colours_of(scene, 0.3), 0.5, 0.5, 0.25));
  CHECK_FALSE(colour_at(colours_of(scene), 1.5, 0.5));  // beside it
  CHECK_THROWS_AS(static_cast<void>(colours_of(scene, 0)), SettingError);
}

TEST_CASE("the colours of layers are those of the layer that an echo is from") {
  const Map still({wall({.reflectance = 0, .picture = four_pixels()})}), empty({});
  const Layered world{empty, still};
  CHECK(colour_at(colours_of(world), 0.5, 0.5) == PointColour{0, 65535, 0});
}
