// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/class_materials.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <pulsecast/scene/point_colour.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/height_field.hpp>

using namespace pulsecast;

namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();
const Vec3 red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1};

}  // namespace

TEST_CASE("each code that occurs gets the colour of the table, in its material or a copy of the first") {
  const Raster codes{.columns = 3, .rows = 2, .heights = {0, 2, 1.5F, missing, 9, 2}};
  ClassMaterials classes{.materials = {{.name = "ground", .reflectance = 0.3}, {.name = "water", .reflectance = 0.1}},
                         .listed = {{2, 1}}};
  colour_classes(classes, codes, std::vector<Vec3>{red, green, blue});
  REQUIRE(classes.materials.size() == 3);  // code 1 does not occur, and 9 is not in the table
  CHECK(classes.materials[0].colour == Vec3{1, 1, 1});
  CHECK(classes.materials[1].name == "water");
  CHECK(classes.materials[1].colour == blue);
  CHECK(classes.materials[2].name == "ground 0");
  CHECK(classes.materials[2].colour == red);
  CHECK(classes.materials[2].reflectance == 0.3);
  REQUIRE(classes.listed.size() == 2);
  CHECK(classes.listed[1].code == 0);
  CHECK(classes.listed[1].material == 2);
}

TEST_CASE("a map of land cover colours the ground") {
  Raster ground{.columns = 4, .rows = 4, .heights = std::vector<float>(16, 5)};
  const Raster codes{.columns = 4, .rows = 4, .packed = {.numbers = {7, 7, 8, 8, 7, 7, 8, 8, 7, 7, 8, 8, 7, 7, 8, 8}}};
  std::vector<Vec3> colours(256);
  colours[7] = red;
  colours[8] = {0.5, 0.25, 0};
  ClassMaterials classes;
  colour_classes(classes, codes, colours);
  CHECK(set_materials(ground, codes, classes.listed) == 0);
  const Scene<HeightField> scene(
      {{.geometry = std::make_shared<const HeightField>(ground), .materials = material_table(classes.materials)}});
  const auto colour_at = [&](double x, double y) {
    const Ray ray{{x, y, 9}, -axis::up};
    return colour_of(scene.surface(*scene.closest_hit(ray), ray));
  };
  CHECK(colour_at(0.2, -1.2) == PointColour{65535, 0, 0, 32768});
  CHECK(colour_at(2.4, -1.2) == PointColour{32768, 16384, 0, 32768});
}

TEST_CASE("more than 256 materials are refused") {
  Raster codes{.columns = 16, .rows = 16};
  for (std::uint32_t i = 0; i < 256; ++i) codes.heights.push_back(static_cast<float>(i));
  ClassMaterials fits, full;
  colour_classes(fits, codes, std::vector<Vec3>(255, red));
  CHECK(fits.materials.size() == 256);
  CHECK(fits.listed.back().material == 255);
  CHECK_THROWS_WITH_AS(colour_classes(full, codes, std::vector<Vec3>(256, red)),
                       "ClassMaterials::materials (number) is 257, but must be from 1 to 256", SettingError);
  full.materials.clear();
  CHECK_THROWS_AS(colour_classes(full, codes, std::vector<Vec3>(2)), SettingError);
}
