// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "wood.hpp"

/// A valley between wooded hills, 800 m by 800 m: a river, a road, a village with a church.
namespace hills {

using pulsecast::Material;
using pulsecast::MeshData;
using pulsecast::Vec2;
using pulsecast::Vec3;
using wood::Dice;
using wood::noise;

inline constexpr double side = 800;                ///< of the square [m]
inline constexpr Vec3 middle{512000, 5403000, 0};  ///< of the square, in coordinates as large as those of UTM [m]

/// Numbers of the materials in `materials()`.
enum MaterialIndex : std::uint32_t { meadow, field, water, asphalt, wall, roof };

/// Reflectances at 1550 nm, chosen to stand apart; water sends light back from below only. Classes: ASPRS LAS 1.4 R15,
/// table 17.
[[nodiscard]] inline std::vector<Material> materials() {
  std::vector<Material> all(6);
  all[meadow] = {.name = "meadow", .reflectance = 0.3, .classification = 3, .ground = true};
  all[field] = {.name = "field", .reflectance = 0.4, .classification = 2, .ground = true};
  all[water] = {.name = "water",
                .reflectance = 0.3,
                .scattering = pulsecast::Scattering::phong,
                .specular_share = 1,
                .specular_exponent = 60,
                .classification = 9};
  all[asphalt] = {.name = "asphalt", .reflectance = 0.18, .classification = 11, .ground = true};
  all[wall] = {.name = "wall", .reflectance = 0.55, .classification = 6};
  all[roof] = {.name = "roof", .reflectance = 0.45, .classification = 6};
  return all;
}

/// Smooth step from 0 to 1 between low and high.
[[nodiscard]] inline double smooth_step(double low, double high, double x) noexcept {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// The ground and what covers it. Places are relative to the middle of the square.
class Terrain {
 public:
  explicit Terrain(std::uint64_t seed) noexcept : seed_(seed) {}

  /// Middle of the river, or of the road, from south to north [m].
  [[nodiscard]] static double river(double y) noexcept {
    return 75 * std::sin(y / 140) + 30 * std::sin(y / 57 + 1) - 60;
  }
  [[nodiscard]] static double road(double y) noexcept { return 70 * std::sin(y / 150 - 0.1) + 14; }

  /// Approximate distance of a place from the middle of the river, or of the road [m].
  [[nodiscard]] static double from_river(const Vec2& at) noexcept { return distance(at, river); }
  [[nodiscard]] static double from_road(const Vec2& at) noexcept { return distance(at, road); }

  [[nodiscard]] double height(const Vec2& at) const noexcept {
    const double bed = smooth_step(3, 9, from_road(at));  // the road lies level from verge to verge
    const double rough = 0.25 * noise(seed_ + 5, at.x / 4, at.y / 4) + 0.8 * noise(seed_ + 4, at.x / 13, at.y / 13);
    const double dry = smooth_step(8, 14, from_river(at));
    return std::lerp(valley({road(at.y), at.y}), valley(at), bed) + rough * std::min(bed, dry);
  }
  [[nodiscard]] Vec3 on(const Vec2& at) const noexcept { return {at.x, at.y, height(at)}; }

  [[nodiscard]] MaterialIndex cover(const Vec2& at) const noexcept {
    if (from_river(at) < 8) return water;
    if (from_road(at) < 3.5) return asphalt;
    return noise(seed_ + 6, at.x / 90, at.y / 60) > 0.15 ? field : meadow;
  }

  [[nodiscard]] MeshData mesh() const {
    constexpr std::uint32_t cells = 480;
    MeshData mesh;
    for (std::uint32_t j = 0; j <= cells; ++j)
      for (std::uint32_t i = 0; i <= cells; ++i) mesh.vertices.push_back(on(side * (Vec2(i, j) / double{cells} - 0.5)));
    for (std::uint32_t j = 0; j < cells; ++j)
      for (std::uint32_t i = 0; i < cells; ++i) {
        const std::uint32_t a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
        for (const auto& triangle : {std::array{a, b, d}, std::array{a, d, c}}) {
          const Vec3 centre =
              (mesh.vertices[triangle[0]] + mesh.vertices[triangle[1]] + mesh.vertices[triangle[2]]) / 3.0;
          mesh.triangles.push_back(triangle);
          mesh.materials.push_back(cover({centre.x, centre.y}));
        }
      }
    return mesh;
  }

 private:
  [[nodiscard]] static double distance(const Vec2& at, double (*line)(double)) noexcept {
    const double slope = (line(at.y + 1) - line(at.y - 1)) / 2;
    return std::fabs(at.x - line(at.y)) / std::sqrt(1 + slope * slope);
  }

  /// Without roughness and road [m].
  [[nodiscard]] double valley(const Vec2& at) const noexcept {
    const double far = from_river(at), level = 300 - 0.006 * at.y;  // of the water
    const double bottom = level + 2.2 * smooth_step(8, 14, far) + 0.03 * far;
    const double hill = 355 + 45 * noise(seed_ + 1, at.x / 260, at.y / 260) +
                        22 * noise(seed_ + 2, at.x / 110, at.y / 110) + 5 * noise(seed_ + 3, at.x / 40, at.y / 40);
    return std::lerp(bottom, std::max(hill, bottom),
                     smooth_step(60, 300, far + 25 * noise(seed_ + 7, at.x / 80, at.y / 80)));
  }

  std::uint64_t seed_;
};

/// A flat shape with these corners in turn.
inline void add_face(MeshData& mesh, const std::vector<Vec3>& corners, MaterialIndex material) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  for (std::uint32_t k = 1; k + 1 < corners.size(); ++k) {
    mesh.triangles.push_back({first, first + k, first + k + 1});
    mesh.materials.push_back(material);
  }
}

/// Under a saddle roof whose ridge runs along y. It stands 3 m deep, for slopes [m].
inline void add_house(MeshData& mesh, const Vec3& foot, double width, double length, double eaves, double ridge) {
  const double x = width / 2, y = length / 2, beyond = 0.5, drop = beyond * (ridge - eaves) / x;
  const auto at = [&](double right, double ahead, double height) { return foot + Vec3{right, ahead, height}; };
  for (const double s : {-1.0, 1.0}) {
    add_face(mesh, {at(s * x, -y, -3), at(s * x, y, -3), at(s * x, y, eaves), at(s * x, -y, eaves)}, wall);
    add_face(mesh,
             {at(-x, s * y, -3), at(x, s * y, -3), at(x, s * y, eaves), at(0, s * y, ridge), at(-x, s * y, eaves)},
             wall);
    const double edge = s * (x + beyond), gable = y + beyond;
    add_face(mesh,
             {at(edge, -gable, eaves - drop), at(edge, gable, eaves - drop), at(0, gable, ridge), at(0, -gable, ridge)},
             roof);
  }
}

[[nodiscard]] inline MeshData house(double width, double length, double eaves, double ridge) {
  MeshData mesh;
  add_house(mesh, {}, width, length, eaves, ridge);
  return mesh;
}

/// A nave, and a tower with a spire to its south.
[[nodiscard]] inline MeshData church() {
  MeshData mesh = house(11, 24, 9, 17);
  const auto corner = [](int k, double z) {
    return Vec3{k % 4 == 0 || k % 4 == 3 ? -3.5 : 3.5, k % 4 < 2 ? -22 : -15, z};
  };
  for (int k = 0; k < 4; ++k) {
    add_face(mesh, {corner(k, -3), corner(k + 1, -3), corner(k + 1, 26), corner(k, 26)}, wall);
    add_face(mesh, {corner(k, 26), corner(k + 1, 26), {0, -18.5, 45}}, roof);
  }
  return mesh;
}

using Mesh = pulsecast::TriangleMesh<>;
using Scene = pulsecast::Scene<Mesh>;

/// The valley of a seed. The ground is object 0.
[[nodiscard]] inline Scene scene(std::uint64_t seed) {
  const auto model = [](const MeshData& mesh) { return std::make_shared<const Mesh>(mesh); };
  const std::array trees{
      model(broadleaf({}, Dice(seed, 1))),
      model(broadleaf({.height = 21, .girth = 0.24, .crown_base = 0.4, .spread = 4.2}, Dice(seed, 2))),
      model(conifer({}, Dice(seed, 3))), model(conifer({.height = 27, .girth = 0.3, .spread = 3.4}, Dice(seed, 4)))};
  const std::array houses{model(house(9, 12, 5.5, 9.5)), model(house(10, 17, 6, 11)), model(house(8, 9, 3, 7))};

  const Terrain terrain(seed);
  const auto built = pulsecast::material_table(materials()), grown = pulsecast::material_table(wood::materials());
  std::vector<Scene::Part> parts;
  const auto place = [&](const auto& shape, const auto& table, const Vec3& foot, double turn = 0, double scale = 1) {
    parts.push_back({shape,
                     table,
                     {pulsecast::rotation_about(pulsecast::axis::up, turn), scale, middle + foot},
                     static_cast<pulsecast::ObjectId>(parts.size())});
  };
  place(model(terrain.mesh()), built, {});

  Dice dice(seed, 5);
  std::vector<Vec2> taken;
  const auto build = [&](const auto& shape, const Vec2& at, double turn) {
    const bool crowded = std::ranges::any_of(taken, [&](const Vec2& other) { return length(other - at) < 17; });
    if (crowded || Terrain::from_river(at) < 22 || Terrain::from_road(at) < 11) return;
    taken.push_back(at);
    place(shape, built, terrain.on(at), turn);
  };
  build(model(church()), {Terrain::road(30) + 45, 30}, 0.3);
  for (double y = -170; y < 210; y += 24)
    for (const double row : {-40.0, -17.0, 17.0, 72.0}) {
      const Vec2 at{Terrain::road(y) + row + dice.between(-5, 5), y + dice.between(-8, 8)};
      const double along = -std::atan2(Terrain::road(y + 1) - Terrain::road(y - 1), 2.0),
                   turn = along + dice.between(-0.1, 0.1);
      const auto& shape = houses[static_cast<std::size_t>(dice.between(0, 2.999))];
      if (dice.between(0, 1) < 0.8) build(shape, at, dice.between(0, 1) < 0.7 ? turn : turn + pulsecast::pi / 2);
    }

  constexpr double apart = 7;  // trees, on average [m]
  for (double y = -side / 2 + apart; y < side / 2 - apart; y += apart)
    for (double x = -side / 2 + apart; x < side / 2 - apart; x += apart) {
      const Vec2 at{x + dice.between(-2.7, 2.7), y + dice.between(-2.7, 2.7)};
      const double chance = dice.between(0, 1), kind = dice.between(0, 1), turn = dice.between(0, 6.28),
                   scale = dice.between(0.65, 1.15);
      const double river = Terrain::from_river(at),
                   wooded = noise(seed + 8, at.x / 120, at.y / 120) + 0.3 * noise(seed + 9, at.x / 30, at.y / 30);
      const bool on_hill =
          river > 110 && wooded > -0.05 && chance<0.95, on_bank = river> 11 && river < 19 && chance < 0.35;
      const bool alone = river > 22 && chance < 0.03;
      const bool free = std::ranges::none_of(taken, [&](const Vec2& other) { return length(other - at) < 14; });
      if (!(on_hill || on_bank || alone) || Terrain::from_road(at) < 8 || !free) continue;
      const bool dark = on_hill && noise(seed + 10, at.x / 70, at.y / 70) > 0.05;
      place(trees[(dark ? 2U : 0U) + (kind < 0.5 ? 0U : 1U)], grown, terrain.on(at), turn, scale);
    }
  return Scene(std::move(parts));
}

}  // namespace hills
