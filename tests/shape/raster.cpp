// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/raster.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace pulsecast;

namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

/// Two cells from west to east; the pixels are 2 m by 4 m, the north-western one at (100, 200).
Raster two_cells() {
  return {.columns = 3, .rows = 2, .first = {100, 200}, .pixel = {2, 4}, .heights = {1, 2, 3, 4, 5, 6}};
}

std::string refusal(const Raster& raster) {
  try {
    raster.validate();
    return {};
  } catch (const SettingError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE(
    "a raster's mesh has its pixels as vertices, and two triangles a cell along its south-west to north-east "
    "diagonal") {
  const MeshData mesh = two_cells().mesh();
  REQUIRE(mesh.vertices.size() == 6);
  REQUIRE(mesh.triangles.size() == 4);
  const auto corners = [&](std::size_t triangle) {
    std::vector<Vec3> all;
    for (const std::uint32_t vertex : mesh.triangles[triangle]) all.push_back(mesh.vertices[vertex]);
    return all;
  };
  CHECK(corners(0) == std::vector<Vec3>{{100, 200, 1}, {100, 196, 4}, {102, 200, 2}});
  CHECK(corners(1) == std::vector<Vec3>{{100, 196, 4}, {102, 196, 5}, {102, 200, 2}});
  CHECK(corners(2) == std::vector<Vec3>{{102, 200, 2}, {102, 196, 5}, {104, 200, 3}});
  CHECK(corners(3) == std::vector<Vec3>{{102, 196, 5}, {104, 196, 6}, {104, 200, 3}});
}

TEST_CASE("a raster's mesh leaves out triangles with a missing corner, and pixels that no triangle needs") {
  Raster raster = two_cells();
  raster.heights[0] = missing;
  CHECK(raster.mesh().triangles.size() == 3);
  CHECK(raster.mesh().vertices.size() == 5);
  raster.heights[4] = missing;
  const MeshData mesh = raster.mesh();
  CHECK(mesh.triangles.empty());
  CHECK(mesh.vertices.empty());
}

TEST_CASE("a mosaic of tiles is the raster that they were cut from") {
  Raster whole{.columns = 7, .rows = 5, .first = {1000.1, 2000.7}, .pixel = {0.3, 0.7}};
  for (std::size_t i = 0; i < 35; ++i) whole.heights.push_back(static_cast<float>(i));
  for (std::size_t i = 0; i < 35; ++i) whole.materials.push_back(i % 3 == 0 ? 1 : 0);
  const auto cut = [&](std::uint32_t west, std::uint32_t north, std::uint32_t columns, std::uint32_t rows) {
    Raster tile{
        .columns = columns, .rows = rows, .first = whole.first + Vec2{west * 0.3, north * -0.7}, .pixel = whole.pixel};
    for (std::uint32_t r = north; r < north + rows; ++r)
      for (std::uint32_t c = west; c < west + columns; ++c) {
        tile.heights.push_back(whole.heights[7 * r + c]);
        tile.materials.push_back(whole.materials[7 * r + c]);
      }
    return tile;
  };
  const auto same = [&](const Raster& all) {
    return all.columns == 7 && all.rows == 5 && all.first == whole.first && all.heights == whole.heights &&
           all.materials == whole.materials;
  };
  CHECK(same(mosaic({cut(0, 0, 4, 2), cut(4, 0, 3, 2), cut(0, 2, 4, 3), cut(4, 2, 3, 3)})));
  CHECK(same(mosaic({cut(3, 1, 4, 4), cut(0, 0, 7, 3), cut(0, 2, 5, 3)})));  // tiles that overlap
  Raster holed = cut(0, 0, 7, 5);
  holed.heights[8] = missing;
  CHECK(same(mosaic({holed, cut(0, 0, 2, 2)})));  // the second tile fills the hole
  const Raster apart = mosaic({cut(0, 0, 2, 2), cut(5, 3, 2, 2)});
  CHECK(apart.heights.size() == 35);
  CHECK(std::isnan(apart.heights[3]));
  CHECK(apart.heights[34] == 34);

  const auto refused = [](const std::vector<Raster>& tiles) {
    try {
      (void)mosaic(tiles);
      return std::string();
    } catch (const SettingError& error) {
      return std::string(error.what());
    }
  };
  CHECK(refused({}).find("mosaic (number of tiles)") == 0);
  Raster shifted = cut(4, 0, 3, 2), coarse = shifted, far = shifted;
  shifted.first.x += 0.1;
  coarse.pixel.y = 0.71;
  far.first.x += 1e6;
  CHECK(refused({cut(0, 0, 4, 2), shifted}).find("mosaic (shift of a tile's pixels") == 0);
  CHECK(refused({cut(0, 0, 4, 2), coarse}).find("mosaic (shift of a tile's pixels") == 0);
  CHECK(refused({cut(0, 0, 4, 2), far}).find("mosaic (pixels)") == 0);
}

TEST_CASE("a mosaic of packed tiles is packed, where they are packed alike and there is a number for gaps") {
  const auto tile = [](double east, std::vector<std::uint16_t> numbers) {
    return Raster{.columns = 2,
                  .rows = 2,
                  .first = {east, 0},
                  .packed = {.numbers = std::move(numbers), .scale = 0.5, .missing = 9}};
  };
  const Raster all = mosaic({tile(0, {1, 2, 3, 9}), tile(1, {5, 6, 7, 8}), tile(4, {1, 1, 1, 1})});
  CHECK(all.packed.numbers == std::vector<std::uint16_t>{1, 2, 6, 9, 1, 1, 3, 7, 8, 9, 1, 1});
  CHECK(all.packed.scale == 0.5);
  CHECK(all.unpacked().heights[2] == 3);
  CHECK(std::isnan(all.unpacked().heights[3]));

  Raster bare = tile(0, {0, 2, 3, 9}), far = tile(3, {1, 4, 5, 5});
  bare.packed.missing = far.packed.missing = std::nullopt;
  const Raster apart = mosaic({bare, far});
  CHECK(apart.packed.missing == 6);  // the least that is free
  CHECK(apart.packed.numbers == std::vector<std::uint16_t>{0, 2, 6, 1, 4, 3, 9, 6, 5, 5});

  Raster other = tile(2, {1, 1, 1, 1});
  other.packed.scale = 2;
  const Raster wide = mosaic({tile(0, {1, 2, 3, 4}), other});
  CHECK_FALSE(wide.is_packed());
  CHECK(wide.heights == std::vector<float>{0.5F, 1, 2, 2, 1.5F, 2, 2, 2});
}

TEST_CASE("a raster takes its materials from one of codes with other pixels") {
  Raster ground = two_cells();  // pixels at 100, 102, 104 m east and 200, 196 m north
  // codes in pixels of 3 m, from 99 to 105 m east and from 201 to 195 m north
  const Raster codes{
      .columns = 2, .rows = 2, .first = {100.5, 199.5}, .pixel = {3, 3}, .heights = {21, 7, missing, 30}};
  CHECK(set_materials(ground, codes, {{7, 2}, {21, 1}, {30, 3}}, 9) == 1);
  CHECK(ground.materials == std::vector<std::uint8_t>{1, 2, 2, 9, 3, 3});
  CHECK(set_materials(ground, codes, {{30, 3}, {static_cast<double>(missing), 5}, {30, 4}}) ==
        4);  // of equal codes, the first counts
  CHECK(ground.materials == std::vector<std::uint8_t>{0, 0, 0, 0, 3, 3});
  const Raster elsewhere{.columns = 2, .rows = 2, .first = {103, 197}, .pixel = {1, 1}, .heights = {5, 5, 5, 5}};
  CHECK(set_materials(ground, elsewhere, {{5, 1}}) ==
        5);  // of pixels from 102.5 to 104.5 m east and from 197.5 to 195.5 m north
  CHECK(ground.materials == std::vector<std::uint8_t>{0, 0, 0, 0, 0, 1});
  const Raster edges{.columns = 2, .rows = 2, .first = {101, 199}, .pixel = {2, 2}, .heights = {1, 2, 3, 4}};
  Raster within = two_cells();  // whose pixels are on the edges of those codes
  CHECK(set_materials(within, edges, {{1, 1}, {2, 2}, {3, 3}, {4, 4}}) == 0);
  CHECK(within.materials == std::vector<std::uint8_t>{1, 2, 2, 3, 4, 4});
  Raster packed{.columns = 2,
                .rows = 2,
                .first = {100.5, 199.5},
                .pixel = {3, 3},
                .packed = {.numbers = {21, 7, 0, 30}, .missing = 0}};
  Raster both = two_cells();
  CHECK(set_materials(both, packed, {{7, 2}, {21, 1}, {30, 3}}, 9) == 1);
  CHECK(both.materials == std::vector<std::uint8_t>{1, 2, 2, 9, 3, 3});
  const MeshData mesh = ground.mesh();
  CHECK(mesh.materials == std::vector<std::uint32_t>{0, 0, 0, 1});
}

TEST_CASE("a raster that cannot be is refused, and the refusal says what is wrong") {
  const auto with = [](auto change) {
    Raster raster = two_cells();
    change(raster);
    return refusal(raster);
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal(two_cells()) == "");
  CHECK(with([](Raster& r) { r.columns = 1; }) == "Raster::columns is 1, but must be from 2 to 134217728");
  CHECK(with([](Raster& r) { r.rows = 0; }) == "Raster::rows is 0, but must be from 2 to 134217728");
  CHECK(with([](Raster& r) { r.columns = r.rows = 60000; }).find("cells between them is 3599880001") !=
        std::string::npos);
  CHECK(with([](Raster& r) {
          r.materials = {1, 2};
        }) == "Raster::materials is 2, but must be as many as pixels, 6, or none");
  CHECK(with([](Raster& r) { r.heights.pop_back(); }) == "Raster::heights is 5, but must be as many as pixels, 6");
  CHECK(with([](Raster& r) { r.heights[4] = std::numeric_limits<float>::infinity(); }) ==
        "Raster::heights is inf m, but must be within 1e15 m, or NaN; see pixel 4");
  CHECK(with([](Raster& r) { r.pixel.y = -1; }).find("Raster::pixel.y is -1 m") == 0);
  CHECK(with([&](Raster& r) { r.pixel.x = none; }).find("Raster::pixel.x is nan m") == 0);
  for (const int axis : {0, 1}) {
    const auto fine_and_far = [&](Raster& r) {
      r.first[axis] = 1e15;
      r.pixel[axis] = 0.5;  // a coordinate there rounds by 0.0625 m
    };
    CHECK(with(fine_and_far).find(axis == 0 ? "Raster::pixel.x is 0.5 m" : "Raster::pixel.y is 0.5 m") == 0);
  }
  CHECK(with([](Raster& r) { r.packed.numbers = {1, 2, 3, 4, 5, 6}; }) ==
        "Raster::heights (number of them beside `packed`) is 6, but must be from 0 to 0");
  const auto packed_with = [&](auto change) {
    return with([&](Raster& r) {
      r.heights.clear();
      r.packed.numbers = {1, 2, 3, 4, 5, 6};
      change(r.packed);
    });
  };
  CHECK(packed_with([](PackedHeights&) {}) == "");
  CHECK(packed_with([](PackedHeights& p) { p.numbers.pop_back(); }) ==
        "Raster::packed.numbers is 5, but must be as many as pixels, 6, or none");
  CHECK(packed_with([](PackedHeights& p) { p.scale = 0; }).find("PackedHeights::scale is 0 m") == 0);
  CHECK(with([](Raster& r) { r.first.x = 1e16; }).find("Raster::first.x is ") == 0);
  CHECK(with([&](Raster& r) { r.first.y = none; }).find("Raster::first.y is nan m") == 0);
}
