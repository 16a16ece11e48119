// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "tree.hpp"

/// A wood on uneven ground, 64 m by 64 m, with a hut in a clearing: some 150 trees of six kinds, ferns and rocks.
namespace wood {

using pulsecast::Material;
using pulsecast::Vec2;

inline constexpr double side = 64;          ///< of the plot, whose centre is the origin [m]
inline constexpr Vec2 hut_place{5.5, 6.5};  ///< middle of the hut [m]

/// Places without plants: before the hut, on the path that leads there, and in a glade beside it [m].
inline constexpr std::array<Vec2, 3> bare_places{{{-1.6, -1.5}, {-10.2, -11}, {12, -4.5}}};

/// Distance of a place from the path that winds from the south-west to the hut [m].
[[nodiscard]] inline double from_path(const Vec2& at) noexcept {
  const Vec2 nearest{0.75 * at.y + 2 * std::sin(at.y / 6), at.y};
  return at.y < hut_place.y ? length(at - nearest) : length(at - hut_place);
}

/// Reflectances at 1550 nm. Stems are about twice as bright as leaves at this wavelength, as water in the leaves
/// absorbs it. Source: Li et al. 2013, "Separating leaves from trunks and branches with dual-wavelength terrestrial
/// lidar scanning"; all else is chosen to stand apart. Classes: ASPRS LAS 1.4 R15, table 17; 64 is the first that it
/// leaves to its users, here for wood.
[[nodiscard]] inline std::vector<Material> materials() {
  std::vector<Material> all(10);
  all[soil] = {.name = "soil", .reflectance = 0.35, .classification = 2, .ground = true};
  all[bark] = {.name = "bark", .reflectance = 0.45, .classification = 64};
  all[birch_bark] = {.name = "birch bark", .reflectance = 0.6, .classification = 64};
  all[leaf] = {.name = "leaf", .reflectance = 0.25, .classification = 5};
  all[birch_leaf] = {.name = "birch leaf", .reflectance = 0.28, .classification = 5};
  all[needle] = {.name = "needle", .reflectance = 0.18, .classification = 5};
  all[fern] = {.name = "fern", .reflectance = 0.3, .classification = 3};
  all[stone] = {.name = "stone", .reflectance = 0.5, .classification = 1};
  all[timber] = {.name = "timber", .reflectance = 0.65, .classification = 6};
  all[shingle] = {.name = "shingle", .reflectance = 0.3, .classification = 6};
  return all;
}

/// Smooth noise in [-1, 1] whose bumps are one unit wide: random values on a lattice, faded into each other.
/// Source: Perlin 2002, the fade curve of degree five.
[[nodiscard]] inline double noise(std::uint64_t seed, double x, double y) noexcept {
  const double left = std::floor(x), low = std::floor(y);
  const auto value = [&](int i, int j) {
    const auto column = static_cast<std::uint32_t>(static_cast<std::int32_t>(left) + i),
               row = static_cast<std::uint32_t>(static_cast<std::int32_t>(low) + j);
    return 2 * pulsecast::uniform({seed, (std::uint64_t{column} << 32) | row, 0, pulsecast::Purpose::scene}) - 1;
  };
  const auto fade = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
  return std::lerp(std::lerp(value(0, 0), value(1, 0), fade(x - left)),
                   std::lerp(value(0, 1), value(1, 1), fade(x - left)), fade(y - low));
}

/// The height of the ground: noise of ever smaller bumps, level around the hut [m].
class Terrain {
 public:
  explicit Terrain(std::uint64_t seed) noexcept : seed_(seed), level_(hills(hut_place)) {}

  [[nodiscard]] double height(const Vec2& at) const noexcept {
    const double hilly = std::clamp((length(at - hut_place) - 4) / 6, 0.0, 1.0);
    return std::lerp(level_, hills(at), hilly * hilly * (3 - 2 * hilly)) + bumps(at);
  }
  [[nodiscard]] Vec3 on(const Vec2& at) const noexcept { return {at.x, at.y, height(at)}; }

  [[nodiscard]] MeshData mesh() const {
    constexpr std::uint32_t cells = 224;
    MeshData mesh;
    for (std::uint32_t j = 0; j <= cells; ++j) {
      for (std::uint32_t i = 0; i <= cells; ++i) mesh.vertices.push_back(on(side * (Vec2(i, j) / double{cells} - 0.5)));
    }
    for (std::uint32_t j = 0; j < cells; ++j) {
      for (std::uint32_t i = 0; i < cells; ++i) {
        const std::uint32_t a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      }
    }
    mesh.materials.assign(mesh.triangles.size(), soil);
    return mesh;
  }

 private:
  [[nodiscard]] double hills(const Vec2& at) const noexcept {
    return 2.6 * noise(seed_ + 1, at.x / 27, at.y / 27) + 0.9 * noise(seed_ + 2, at.x / 11, at.y / 11);
  }
  [[nodiscard]] double bumps(const Vec2& at) const noexcept {
    return 0.16 * noise(seed_ + 3, at.x / 3.1, at.y / 3.1) + 0.07 * noise(seed_ + 4, at.x / 1.1, at.y / 1.1) +
           0.03 * noise(seed_ + 5, at.x / 0.4, at.y / 0.4);
  }

  std::uint64_t seed_;
  double level_;
};

/// A ball, dented.
[[nodiscard]] inline MeshData rock(std::uint64_t seed) {
  constexpr std::uint32_t rings = 14, sectors = 20;
  MeshData mesh;
  for (std::uint32_t i = 0; i <= rings; ++i) {
    for (std::uint32_t j = 0; j < sectors; ++j) {
      const double polar = pulsecast::pi * i / rings, azimuth = 2 * pulsecast::pi * j / sectors;
      const Vec3 d{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)};
      const double dent = 0.35 * noise(seed, 1.3 * d.x + 2.1 * d.z + 7, 1.3 * d.y - 1.7 * d.z + 3) +
                          0.1 * noise(seed + 1, 4 * d.x + 3 * d.z, 4 * d.y - 3 * d.z);
      mesh.vertices.push_back(Vec3{1, 0.8, 0.6} * d * (1 + dent));
    }
  }
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < sectors; ++j) {
      const std::uint32_t a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
      if (i + 1 < rings) mesh.triangles.push_back({a, a + sectors, b + sectors});
      if (i > 0) mesh.triangles.push_back({a, b + sectors, b});
    }
  }
  mesh.materials.assign(mesh.triangles.size(), stone);
  return mesh;
}

/// A log cabin, 5 m by 4 m, under a roof of shingles; the door is to the south, the chimney to the north.
[[nodiscard]] inline MeshData hut() {
  constexpr double width = 5, depth = 4, log = 0.22, eaves = 11 * log, ridge = eaves + 1.7;
  MeshData mesh;
  const auto beam = [&](const Vec3& from, const Vec3& to, double radius) {
    add_tube(mesh, {{from, to}, {radius, radius}}, 8, timber);
  };
  const auto board = [&](const Vec3& corner, const Vec3& along, const Vec3& across, MaterialIndex material) {
    add_triangle(mesh, corner, corner + along, corner + along + across, material);
    add_triangle(mesh, corner, corner + along + across, corner + across, material);
  };
  for (int i = -2; i < 11; ++i) {
    const double z = (i + 0.5) * log, x = width / 2, y = depth / 2, beyond = 0.3;
    if (i >= 0 && i < 9) {
      beam({-x - beyond, -y, z}, {-0.5, -y, z}, 0.52 * log);
      beam({0.5, -y, z}, {x + beyond, -y, z}, 0.52 * log);
    } else {
      beam({-x - beyond, -y, z}, {x + beyond, -y, z}, 0.52 * log);
    }
    beam({-x - beyond, y, z}, {x + beyond, y, z}, 0.52 * log);
    for (const double end : {-x, x}) beam({end, -y - beyond, z + log / 2}, {end, y + beyond, z + log / 2}, 0.52 * log);
  }
  const double slope_run = depth / 2 + 0.7, rise = (ridge - eaves) / (depth / 2);
  for (const double face : {-1.0, 1.0}) {
    for (const double end : {-width / 2, width / 2}) {  // gables
      add_triangle(mesh, {end, 0, eaves}, {end, face * depth / 2, eaves}, {end, 0, ridge}, timber);
    }
    constexpr int courses = 14;
    for (int k = 0; k < courses; ++k) {  // each course of shingles lies upon the one below
      const double low = slope_run * (1 - static_cast<double>(k) / courses),
                   high = slope_run * (1 - (k + 1.0) / courses);
      const Vec3 corner{-width / 2 - 0.6, face * low, ridge + 0.12 - low * rise + 0.05};
      board(corner, {width + 1.2, 0, 0}, {0, face * (high - low), (low - high) * rise - 0.05}, shingle);
      board(corner, {width + 1.2, 0, 0}, {0, 0, -0.05}, shingle);
    }
  }
  for (int k = 0; k < 4; ++k) {  // chimney
    const Vec3 corners[5] = {{1.2, 0.9, 1}, {1.9, 0.9, 1}, {1.9, 1.6, 1}, {1.2, 1.6, 1}, {1.2, 0.9, 1}};
    board(corners[k], corners[k + 1] - corners[k], {0, 0, ridge - 0.2}, stone);
  }
  return mesh;
}

using Mesh = pulsecast::TriangleMesh<>;
using Scene = pulsecast::Scene<Mesh>;

/// The parts planted so far.
class Planting {
 public:
  Planting(std::uint64_t seed, const Terrain& terrain) : seed_(seed), terrain_(terrain) {}

  void place(std::shared_ptr<const Mesh> model, const Vec2& at, const Rotation& rotation, double scale = 1,
             double sink = 0) {
    parts_.push_back({model,
                      materials_,
                      {rotation, scale, terrain_.on(at) - sink * pulsecast::axis::up},
                      static_cast<pulsecast::ObjectId>(parts_.size())});
  }

  /// Tries random places that are `apart` from each other [m] and where `free(place)` allows it; `choose(place,
  /// chance)` gives the model.
  void scatter(std::uint32_t stream, int tries, double apart, double sink, auto&& free, auto&& choose) {
    Dice dice(seed_, stream);
    std::vector<Vec2> taken;
    for (int i = 0; i < tries; ++i) {
      const Vec2 at{dice.between(-side / 2 + 1, side / 2 - 1), dice.between(-side / 2 + 1, side / 2 - 1)};
      const double turn = dice.between(0, 2 * pulsecast::pi), lean = dice.between(0, 0.05),
                   scale = dice.between(0.72, 1.15), chance = dice.between(0, 1);
      if (std::ranges::any_of(taken, [&](const Vec2& other) { return length(other - at) < apart; }) || !free(at))
        continue;
      taken.push_back(at);
      const Rotation leaning = pulsecast::rotation_about({std::cos(turn), std::sin(turn), 0}, lean);
      place(choose(at, chance), at, leaning * pulsecast::rotation_about(pulsecast::axis::up, 3 * turn), scale, sink);
    }
  }

  [[nodiscard]] Scene scene() && { return Scene(std::move(parts_)); }

 private:
  std::uint64_t seed_;
  const Terrain& terrain_;
  pulsecast::MaterialTable materials_ = pulsecast::material_table(materials());
  std::vector<Scene::Part> parts_;
};

/// Places for a tripod.
[[nodiscard]] inline std::vector<Vec3> glades(std::uint64_t seed) {
  const Terrain terrain(seed);
  std::vector<Vec3> all;
  for (const Vec2& place : bare_places) all.push_back(terrain.on(place));
  return all;
}

/// The wood of a seed. The ground is object 0, the hut object 1.
[[nodiscard]] inline Scene scene(std::uint64_t seed) {
  const auto model = [](const MeshData& mesh) { return std::make_shared<const Mesh>(mesh); };
  const auto oak = model(broadleaf({}, Dice(seed, 1)));
  const auto beech = model(
      broadleaf({.height = 21, .girth = 0.24, .crown_base = 0.42, .spread = 3.8, .steepness = 0.75}, Dice(seed, 2)));
  const auto birch = model(broadleaf({.height = 16,
                                      .girth = 0.13,
                                      .crown_base = 0.35,
                                      .spread = 2.5,
                                      .steepness = 0.7,
                                      .droop = 0.5,
                                      .leaf_length = 0.1,
                                      .limbs = 24,
                                      .stem = birch_bark,
                                      .leaves = birch_leaf},
                                     Dice(seed, 3)));
  const auto spruce = model(conifer({}, Dice(seed, 4)));
  const auto fir =
      model(conifer({.height = 27, .girth = 0.3, .crown_base = 0.3, .spread = 2.7, .whorls = 40}, Dice(seed, 5)));
  const auto sapling = model(conifer(
      {.height = 9, .girth = 0.11, .crown_base = 0.04, .spread = 2.1, .whorls = 30, .branches = 8}, Dice(seed, 6)));
  const auto ferns = model(fern_plant(Dice(seed, 7)));
  const auto boulder = model(rock(seed + 11));

  const Terrain terrain(seed);
  Planting planting(seed, terrain);
  planting.place(model(terrain.mesh()), {0, 0}, pulsecast::no_rotation, 1, terrain.height({0, 0}));
  planting.place(model(hut()), hut_place, pulsecast::rotation_about(pulsecast::axis::up, -0.45));

  const auto clear = [](const Vec2& at, double of_hut, double of_tripods) {
    return length(at - hut_place) > of_hut &&
           std::ranges::all_of(bare_places, [&](const Vec2& place) { return length(place - at) > of_tripods; });
  };
  planting.scatter(
      30, 1500, 4.1, 0, [&](const Vec2& at) { return clear(at, 7.5, 3) && from_path(at) > 3.3; },
      [&](const Vec2& at, double chance) {  // conifers keep to themselves
        const bool dark = noise(seed + 20, at.x / 18, at.y / 18) > 0.05;
        return dark ? (chance < 0.45   ? spruce
                       : chance < 0.75 ? fir
                       : chance < 0.92 ? sapling
                                       : birch)
                    : (chance < 0.35   ? oak
                       : chance < 0.7  ? beech
                       : chance < 0.92 ? birch
                                       : sapling);
      });
  planting.scatter(
      31, 1500, 0.9, 0.02,
      [&](const Vec2& at) {
        return clear(at, 4.5, 1.3) && from_path(at) > 1.1 && noise(seed + 21, at.x / 6, at.y / 6) > 0.1;
      },
      [&](const Vec2&, double) { return ferns; });
  planting.scatter(
      32, 120, 1.5, 0.15,
      [&](const Vec2& at) {
        return clear(at, 4.5, 2) && from_path(at) > 1.6 && noise(seed + 22, at.x / 9, at.y / 9) > 0.3;
      },
      [&](const Vec2&, double) { return boulder; });
  return std::move(planting).scene();
}

}  // namespace wood
