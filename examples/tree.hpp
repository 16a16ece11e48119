// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <pulsecast/base/random.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

/// Trees made by code: what grows where is drawn from a seed, so the same seed gives the same tree everywhere.
namespace wood {

using pulsecast::MeshData;
using pulsecast::Rotation;
using pulsecast::Vec3;

/// Numbers of the materials in `materials()` of wood.hpp.
enum MaterialIndex : std::uint32_t { soil, bark, birch_bark, leaf, birch_leaf, needle, fern, stone, timber, shingle };

/// A row of random numbers; each seed and stream give a row of their own.
class Dice {
 public:
  Dice(std::uint64_t seed, std::uint32_t stream) noexcept : seed_(seed), stream_(stream) {}

  double between(double low, double high) noexcept {
    return low + (high - low) * pulsecast::uniform({seed_, count_++, stream_, pulsecast::Purpose::scene});
  }
  double about(double middle, double share) noexcept { return between(middle * (1 - share), middle * (1 + share)); }
  Vec3 vector(double size) noexcept { return {between(-size, size), between(-size, size), between(-size, size)}; }

 private:
  std::uint64_t seed_, count_ = 0;
  std::uint32_t stream_;
};

inline void add_triangle(MeshData& mesh, const Vec3& a, const Vec3& b, const Vec3& c, MaterialIndex material) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.materials.push_back(material);
}

/// Any direction square to the given one.
inline Vec3 square_to(const Vec3& d) noexcept {
  return normalize(cross(d, std::fabs(d.z) < 0.9 ? pulsecast::axis::up : pulsecast::axis::right));
}

/// A stem, limb or twig: a curve that grows thinner.
struct Axis {
  std::vector<Vec3> points;   ///< [m]
  std::vector<double> radii;  ///< [m]

  [[nodiscard]] Vec3 at(double share) const noexcept {
    const auto [k, rest] = place(share);
    return points[k] + rest * (points[k + 1] - points[k]);
  }
  [[nodiscard]] double radius(double share) const noexcept {
    const auto [k, rest] = place(share);
    return radii[k] + rest * (radii[k + 1] - radii[k]);
  }
  [[nodiscard]] Vec3 tangent(double share) const noexcept {
    const std::size_t k = place(share).first;
    return normalize(points[k + 1] - points[k]);
  }

 private:
  [[nodiscard]] std::pair<std::size_t, double> place(double share) const noexcept {
    const double step = std::clamp(share, 0.0, 1.0) * static_cast<double>(points.size() - 1);
    const std::size_t k = std::min(static_cast<std::size_t>(step), points.size() - 2);
    return {k, step - static_cast<double>(k)};
  }
};

/// Growth of an axis.
struct Growth {
  double length;      ///< [m]
  double radius;      ///< at the foot [m]
  double wander = 0;  ///< change of direction per step
  double lift = 0;    ///< pull towards the sky per step; negative droops
  int steps = 4;
};

inline Axis grow(Dice& dice, Vec3 foot, Vec3 direction, const Growth& growth) {
  Axis axis{{foot}, {growth.radius}};
  for (int k = 1; k <= growth.steps; ++k) {
    direction = normalize(direction + dice.vector(growth.wander) + growth.lift * pulsecast::axis::up);
    foot += direction * (growth.length / growth.steps);
    axis.points.push_back(foot);
    axis.radii.push_back(growth.radius * std::pow(1.04 - static_cast<double>(k) / growth.steps, 0.75));
  }
  return axis;
}

/// The surface of an axis: a tube of flat sides.
inline void add_tube(MeshData& mesh, const Axis& axis, std::uint32_t sides, MaterialIndex material) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  Vec3 across = square_to(axis.tangent(0));
  for (std::size_t k = 0; k < axis.points.size(); ++k) {
    const Vec3 along = axis.tangent(static_cast<double>(k) / static_cast<double>(axis.points.size() - 1));
    across = normalize(across - along * dot(along, across));  // as little twist as can be
    const Vec3 other = cross(along, across);
    for (std::uint32_t s = 0; s < sides; ++s) {
      const double angle = 2 * pulsecast::pi * s / sides;
      mesh.vertices.push_back(axis.points[k] + axis.radii[k] * (std::cos(angle) * across + std::sin(angle) * other));
    }
  }
  for (std::uint32_t k = 0; k + 1 < axis.points.size(); ++k) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      const std::uint32_t a = first + k * sides + s, b = first + k * sides + (s + 1) % sides;
      mesh.triangles.push_back({a, b, b + sides});
      mesh.triangles.push_back({a, b + sides, a + sides});
      mesh.materials.insert(mesh.materials.end(), 2, material);
    }
  }
}

/// A leaf or a spray of needles: two triangles, folded along the midrib.
inline void add_leaf(MeshData& mesh, const Vec3& foot, const Vec3& midrib, const Vec3& side, MaterialIndex material) {
  const Vec3 fold = 0.25 * length(side) * normalize(cross(side, midrib));
  const Vec3 middle = foot + 0.45 * midrib + fold;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {foot, middle + side, foot + midrib, middle - side});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  mesh.materials.insert(mesh.materials.end(), 2, material);
}

/// The direction that leaves `along` at an angle [rad], turned about it by `azimuth` [rad].
inline Vec3 branching(const Vec3& along, double angle, double azimuth) noexcept {
  const Vec3 across = square_to(along);
  const Vec3 outwards = std::cos(azimuth) * across + std::sin(azimuth) * cross(along, across);
  return std::cos(angle) * along + std::sin(angle) * outwards;
}

inline constexpr double golden_angle = 2.399963;  ///< between branches, as in many plants [rad]. Source: Vogel 1979

/// Properties in which kinds of broadleaved trees differ.
struct Broadleaf {
  double height = 17;         ///< [m]
  double girth = 0.26;        ///< radius of the stem above its roots [m]
  double crown_base = 0.3;    ///< share of the height
  double spread = 5;          ///< length of the longest limbs [m]
  double steepness = 0.9;     ///< angle between stem and limbs, in the middle of the crown [rad]
  double droop = 0;           ///< of the twigs, per step
  double leaf_length = 0.15;  ///< [m]
  int limbs = 26;
  MaterialIndex stem = bark;
  MaterialIndex leaves = leaf;
};

inline void add_twig(MeshData& mesh, Dice& dice, const Broadleaf& kind, const Vec3& foot, const Vec3& direction,
                     double reach) {
  const Axis twig =
      grow(dice, foot, direction, {.length = reach, .radius = 0.006, .wander = 0.25, .lift = -kind.droop, .steps = 2});
  add_tube(mesh, twig, 3, kind.stem);
  for (int k = 0; k < 12; ++k) {
    const double share = dice.between(0.15, 1), fork = dice.between(0.5, 1.2);
    const Vec3 midrib = normalize(branching(twig.tangent(share), fork, golden_angle * k) + dice.vector(0.3) -
                                  0.3 * pulsecast::axis::up);
    const Vec3 side = normalize(cross(midrib, pulsecast::axis::up + dice.vector(0.5)));
    const double size = dice.about(kind.leaf_length, 0.3);
    add_leaf(mesh, twig.at(share), size * midrib, 0.3 * size * side, kind.leaves);
  }
}

[[nodiscard]] inline MeshData broadleaf(const Broadleaf& kind, Dice dice) {
  MeshData mesh;
  Axis stem = grow(dice, {0, 0, -0.4}, pulsecast::axis::up,
                   {.length = kind.height * 0.95, .radius = kind.girth, .wander = 0.06, .lift = 0.08, .steps = 16});
  stem.radii[0] *= 1.8;
  stem.radii[1] *= 1.1;
  add_tube(mesh, stem, 12, kind.stem);

  for (int i = 0; i < kind.limbs; ++i) {
    const double up_crown = (i + dice.between(0, 0.9)) / kind.limbs;
    const double share = kind.crown_base + (0.98 - kind.crown_base) * up_crown;
    const double envelope =
        std::sqrt(1 - std::pow((up_crown - 0.35) / 0.67, 2));  // an ellipse, widest a third up the crown
    const double angle = kind.steepness * (1.25 - 0.6 * up_crown);
    const double reach = dice.about(kind.spread * envelope, 0.15);
    const Axis limb =
        grow(dice, stem.at(share), branching(stem.tangent(share), angle, golden_angle * i + dice.between(-0.4, 0.4)),
             {.length = reach,
              .radius = std::min(0.55 * stem.radius(share), 0.028 * reach),
              .wander = 0.16,
              .lift = 0.06,
              .steps = 6});
    add_tube(mesh, limb, 6, kind.stem);
    for (int j = 0; j < 9; ++j) {
      const double out = 0.2 + 0.8 * (j + dice.between(0, 1)) / 9;
      const double fork = dice.between(0.5, 1.0), around = golden_angle * j + dice.between(-0.5, 0.5);
      const Axis bough = grow(dice, limb.at(out), branching(limb.tangent(out), fork, around),
                              {.length = reach * (0.55 - 0.3 * out) + 0.3,
                               .radius = 0.5 * limb.radius(out),
                               .wander = 0.2,
                               .lift = 0.04,
                               .steps = 4});
      add_tube(mesh, bough, 4, kind.stem);
      for (int k = 0; k < 5; ++k) {
        const double at = k == 4 ? 1.0 : dice.between(0.25, 1);
        const double leaning = dice.between(0.3, 0.9), length = dice.between(0.35, 0.7);
        add_twig(mesh, dice, kind, bough.at(at), branching(bough.tangent(at), leaning, golden_angle * k), length);
      }
    }
  }
  return mesh;
}

/// Properties in which kinds of conifers differ.
struct Conifer {
  double height = 21;        ///< [m]
  double girth = 0.24;       ///< radius of the stem above its roots [m]
  double crown_base = 0.12;  ///< share of the height
  double spread = 3.1;       ///< length of the longest branches [m]
  int whorls = 36;
  int branches = 7;  ///< in a whorl
};

[[nodiscard]] inline MeshData conifer(const Conifer& kind, Dice dice) {
  MeshData mesh;
  Axis stem = grow(dice, {0, 0, -0.4}, pulsecast::axis::up,
                   {.length = kind.height, .radius = kind.girth, .wander = 0.015, .lift = 0.1, .steps = 16});
  stem.radii[0] *= 1.5;
  add_tube(mesh, stem, 10, bark);

  for (int i = 0; i < kind.whorls; ++i) {
    const double up_crown = static_cast<double>(i) / kind.whorls;
    const double share = kind.crown_base + (1 - kind.crown_base) * up_crown;
    const double turn = dice.between(0, 2 * pulsecast::pi);
    for (int b = 0; b < kind.branches; ++b) {
      const double reach = dice.about(kind.spread * (1.02 - up_crown) * (up_crown < 0.1 ? 0.7 : 1), 0.2) + 0.15;
      const double angle =
          1.75 - 0.9 * up_crown + dice.between(-0.15, 0.15);  // from hanging below to rising at the top
      const Vec3 foot = stem.at(share + dice.between(-0.3, 0.3) * (1 - kind.crown_base) / kind.whorls);
      const Axis branch = grow(
          dice, foot,
          branching(pulsecast::axis::up, angle, turn + 2 * pulsecast::pi * b / kind.branches + dice.between(-0.2, 0.2)),
          {.length = reach, .radius = 0.012 * reach + 0.004, .wander = 0.05, .lift = 0.07, .steps = 4});
      add_tube(mesh, branch, 4, bark);
      const int sprays = 3 + static_cast<int>(reach * 9);
      for (int k = 0; k < sprays; ++k) {  // to the left and right in turn, and hanging
        const double out = 0.15 + 0.85 * (k + 0.5) / sprays;
        const Vec3 along = branch.tangent(out),
                   across = normalize(cross(along, pulsecast::axis::up)) * (k % 2 == 0 ? 1.0 : -1.0);
        const double size = (0.2 + 0.42 * reach * (1.05 - out)) * dice.between(0.7, 1.1);
        const Vec3 midrib = size * normalize(0.75 * along + across - dice.between(0.25, 0.6) * pulsecast::axis::up);
        for (const double roll : {0.1, 1.4}) {
          const Vec3 side = normalize(std::cos(roll) * cross(midrib, pulsecast::axis::up) +
                                      std::sin(roll) * size * pulsecast::axis::up);
          add_leaf(mesh, branch.at(out), midrib, (0.03 + 0.05 * size) * side, needle);
        }
      }
    }
  }
  return mesh;
}

/// Arching fronds with two rows of leaflets.
[[nodiscard]] inline MeshData fern_plant(Dice dice) {
  MeshData mesh;
  for (int i = 0; i < 11; ++i) {
    const double reach = dice.about(0.75, 0.25);
    const Axis frond = grow(dice, {0, 0, 0}, branching(pulsecast::axis::up, dice.between(0.3, 0.7), golden_angle * i),
                            {.length = reach, .radius = 0.006, .wander = 0.05, .lift = -0.28, .steps = 6});
    add_tube(mesh, frond, 3, fern);
    for (int k = 0; k < 24; ++k) {
      const double out = 0.15 + 0.85 * k / 24.0;
      const Vec3 along = frond.tangent(out),
                 across = normalize(cross(along, pulsecast::axis::up)) * (k % 2 == 0 ? 1.0 : -1.0);
      const double size = 0.34 * reach * (1.05 - out) + 0.02;
      add_leaf(mesh, frond.at(out), size * normalize(across + 0.5 * along), 0.12 * size * along, fern);
    }
  }
  return mesh;
}

}  // namespace wood
