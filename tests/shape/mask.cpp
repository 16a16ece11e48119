// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/mask.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

namespace {

/// Grey picture whose pixels, row by row from the top, are `value(i)`.
template <class Value>
Image grey(std::uint32_t width, std::uint32_t height, const Value& value) {
  std::vector<std::uint8_t> samples;
  for (std::size_t i = 0; i < std::size_t{width} * height; ++i) samples.push_back(value(i));
  return {width, height, 1, samples};
}

/// Unit square at a height, upright to the axis z, with a picture on all of it.
MeshData card(double height, const Mask& mask) {
  MeshData data{{{0, 0, height}, {1, 0, height}, {1, 1, height}, {0, 1, height}}, {{0, 1, 2}, {0, 2, 3}}};
  data.texture = {{{{0, 0}, {1, 0}, {1, 1}}}, {{{0, 0}, {1, 1}, {0, 1}}}};
  data.masks = {mask};
  return data;
}

/// The same with the solid pixels as squares of two triangles.
MeshData cut(double height, const Mask& mask) {
  MeshData data;
  for (std::uint32_t row = 0; row < mask.height; ++row)
    for (std::uint32_t column = 0; column < mask.width; ++column) {
      const std::size_t i = std::size_t{row} * mask.width + column;
      if ((mask.bits[i / 64] >> i % 64 & 1) == 0) continue;
      const double left = double(column) / mask.width, right = double(column + 1) / mask.width;
      const double low = 1 - double(row + 1) / mask.height, high = 1 - double(row) / mask.height;
      const auto first = static_cast<std::uint32_t>(data.vertices.size());
      for (const Vec2 at : {Vec2{left, low}, Vec2{right, low}, Vec2{right, high}, Vec2{left, high}})
        data.vertices.push_back({at.x, at.y, height});
      data.triangles.push_back({first, first + 1, first + 2});
      data.triangles.push_back({first, first + 2, first + 3});
    }
  return data;
}

Scene<MaskedMesh<>> scene_of(const MeshData& data) {
  return Scene<MaskedMesh<>>({{.geometry = std::make_shared<const MaskedMesh<>>(data)}});
}

}  // namespace

TEST_CASE("a mask has a bit a pixel, by a channel and a cutoff") {
  const Image image = grey(3, 2, [](std::size_t i) { return static_cast<std::uint8_t>(50 * i); });
  const Mask mask = Mask::of(image, 0, 0.5);  // 0, 50, 100 | 150, 200, 250
  CHECK(mask.bits == std::vector<std::uint64_t>{0b111000});
  CHECK(mask.solid_share() == 0.5);
  CHECK(Mask::of(image, 0, 0).solid_share() == 1);
  CHECK(Mask::of(image, 0, 200.0 / 255).bits == std::vector<std::uint64_t>{0b110000});
  CHECK_THROWS_AS(static_cast<void>(Mask::of(image, 1)), SettingError);
  CHECK_THROWS_AS(static_cast<void>(Mask::of(image, 0, 1.5)), SettingError);
  CHECK(Mask{}.solid_share() == 1);
  CHECK_THROWS_AS(Mask({3, 2, {}}).validate(), SettingError);
  CHECK_THROWS_AS(Mask({0, 2, {}}).validate(), SettingError);
}

TEST_CASE("a table of masks tells holes by material and texture coordinates") {
  const Mask half = Mask::of(grey(2, 1, [](std::size_t i) { return static_cast<std::uint8_t>(i == 0 ? 0 : 255); }), 0);
  const pulsecast::detail::MaskTable table(std::vector<Mask>{{}, half});
  CHECK_FALSE(table.empty());
  CHECK(table.is_consistent());
  CHECK_FALSE(table.covers(0));
  CHECK(table.covers(1));
  CHECK_FALSE(table.covers(2));
  CHECK_FALSE(table.solid(1, {0.25, 0.5}));
  CHECK(table.solid(1, {0.75, 0.5}));
  CHECK(table.solid(1, {-0.25, 7.5}));  // pictures repeat
  CHECK(pulsecast::detail::MaskTable(std::vector<Mask>(3)).empty());
}

TEST_CASE("light goes on through the holes of a mask, and meets what is behind") {
  const Mask half = Mask::of(grey(2, 1, [](std::size_t i) { return static_cast<std::uint8_t>(i == 0 ? 0 : 255); }), 0);
  MeshData data = card(2, half);  // solid for x > 0.5
  const MeshData floor = card(0, {});
  for (const Vec3& vertex : floor.vertices) data.vertices.push_back(vertex);
  for (const auto& [a, b, c] : floor.triangles) data.triangles.push_back({a + 4, b + 4, c + 4});
  data.materials = {0, 0, 1, 1};
  data.texture.insert(data.texture.end(), floor.texture.begin(), floor.texture.end());
  const MaskedMesh<> mesh(data);
  const Scene<MaskedMesh<>> scene({{.geometry = std::make_shared<const MaskedMesh<>>(mesh),
                                      .materials = material_table(std::vector<Material>(2))}});
  const auto range = [&](double x) {
    return scene.closest_hit(Ray{.origin = {x, 0.3, 5}, .direction = -axis::up})->range;
  };
  CHECK(range(0.25) == 5);
  CHECK(range(0.75) == 3);
  std::size_t hits = 0;
  CHECK(scene.all_hits(Ray{.origin = {0.25, 0.3, 5}, .direction = -axis::up}, [&](const RayHit& hit) {
    CHECK(hit.primitive >= 2);
    ++hits;
  }) == 1);
  CHECK(scene.all_hits(Ray{.origin = {0.75, 0.3, 5}, .direction = -axis::up}, [](const RayHit&) {}) == 2);
  CHECK_FALSE(scene.occluded(Ray{.origin = {0.25, 0.3, 5}, .direction = -axis::up}, 4));
  CHECK(scene.occluded(Ray{.origin = {0.75, 0.3, 5}, .direction = -axis::up}, 4));
}

TEST_CASE("masked leaves are met as the same leaves cut out, by bundles of any size and by single rays") {
  for (const std::uint64_t seed : {std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{3}}) {
    Generator random(seed);
    const Mask mask =
        Mask::of(grey(13, 9, [&](std::size_t) { return static_cast<std::uint8_t>(random.uniform(0, 256)); }), 0);
    // two sheets, one behind another
    MeshData masked = card(1, mask), solid = cut(1, mask);
    const auto add = [](MeshData& to, const MeshData& more) {
      const auto first = static_cast<std::uint32_t>(to.vertices.size());
      to.vertices.insert(to.vertices.end(), more.vertices.begin(), more.vertices.end());
      for (const auto& [a, b, c] : more.triangles) to.triangles.push_back({a + first, b + first, c + first});
      to.texture.insert(to.texture.end(), more.texture.begin(), more.texture.end());
    };
    add(masked, card(0, mask));
    add(solid, cut(0, mask));
    const MaskedMesh<> with_masks(masked), with_cuts(solid);
    const auto of_masks = scene_of(masked), of_cuts = scene_of(solid);
    std::size_t met = 0;
    for (const std::size_t size : {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{64}}) {
      for (int n = 0; n < 200; ++n) {
        RayBundle rays;
        rays.origin = {random.uniform(0, 1), random.uniform(0, 1), 3};
        rays.size = size;
        for (std::size_t j = 0; j < size; ++j)
          rays.set_direction(j, normalize(Vec3{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), -1}));
        rays.pad();
        ClosestHits found(rays), expected(rays);
        with_masks.closest(rays, found);
        with_cuts.closest(rays, expected);
        INFO("seed ", seed, ", ", size, " rays, bundle ", n);
        for (std::size_t j = 0; j < size; ++j) {
          REQUIRE(found.met(j) == expected.met(j));
          if (found.met(j)) CHECK(found.range[j] == doctest::Approx(expected.range[j]).epsilon(1e-12));
          met += found.met(j) ? 1 : 0;
          const auto alone = of_masks.closest_hit(rays.ray(j));
          REQUIRE(alone.has_value() == found.met(j));
          if (alone) CHECK(alone->range == found.range[j]);
          CHECK(of_masks.occluded(rays.ray(j)) == of_cuts.occluded(rays.ray(j)));
        }
      }
    }
    CHECK(met > 1000);
  }
}

TEST_CASE("the gap fraction of masked leaves is that of their outline") {
  // ellipses of half axes 0.5 and 0.25 of the picture's sides cover pi/8 of it
  const std::uint32_t side = 512;
  const Mask leaf = Mask::of(grey(side, side,
                                  [](std::size_t i) {
                                    const double x = (double(i % side) + 0.5) / side - 0.5,
                                                 y = (double(i / side) + 0.5) / side - 0.5;
                                    return static_cast<std::uint8_t>(x * x / 0.25 + y * y / 0.0625 <= 1 ? 255 : 0);
                                  }),
                             0);
  const auto scene = scene_of(card(0, leaf));
  std::size_t gaps = 0;
  const int rays = 1000;  // a side
  for (int i = 0; i < rays; ++i)
    for (int k = 0; k < rays; ++k)
      if (!scene.closest_hit(Ray{.origin = {(i + 0.5) / rays, (k + 0.5) / rays, 1}, .direction = -axis::up})) ++gaps;
  CHECK(double(gaps) / (double(rays) * rays) == doctest::Approx(1 - pi / 8).epsilon(1e-3));
}
