// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Voxels of leaves beside leaves that are triangles, each placed and turned at random, and beside closed forms of a
// turbid medium.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "support/generators.hpp"
#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

using Leaves = TriangleMesh<>;
using Voxels = VoxelGrid<TransmissiveVoxels>;

constexpr double half_circle = std::numbers::pi;
constexpr double height = 1000;      ///< of the scanner, so that light is all but parallel [m]
constexpr double reflectance = 0.4;  ///< of leaves

const Material leaf_material{.reflectance = reflectance};

/// Leaf inclinations. Source: de Wit 1965; closed forms: Goel & Strebel 1984.
struct Foliage {
  const char* name;
  LeafAngles angles;
  double (*density)(double);  ///< of the inclination, from 0 to half_circle / 2; at most 2
};

std::vector<Foliage> foliages() {
  return {{"spherical", LeafAngles::spherical(), [](double t) { return std::sin(t); }},
          {"planophile", LeafAngles::planophile(), [](double t) { return 2 / half_circle * (1 + std::cos(2 * t)); }},
          {"erectophile", LeafAngles::erectophile(), [](double t) { return 2 / half_circle * (1 - std::cos(2 * t)); }}};
}

/// Mean cosine and mean squared cosine between leaf normals and light, by their definitions.
struct Cosines {
  double mean = 0, mean_square = 0;
};

Cosines cosines(const Foliage& foliage, double zenith) {
  constexpr int n = 1000;
  Cosines all;
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) / n * half_circle / 2, share = foliage.density(t) * half_circle / 2 / n / n;
    for (int k = 0; k < n; ++k) {
      const double azimuth = (k + 0.5) / n * half_circle;
      const double c = std::cos(zenith) * std::cos(t) + std::sin(zenith) * std::sin(t) * std::cos(azimuth);
      all.mean += share * std::fabs(c);
      all.mean_square += share * c * c;
    }
  }
  return all;
}

// ------------------------------------------------------------------------------------------ leaves

/// Adds an equilateral triangle of an area about a centre, whose normal and turn about it are drawn.
void add_leaf(MeshData& mesh, const Vec3& centre, double area, const Foliage& foliage, support::Generator& random) {
  double t = 0;
  do t = random.uniform(0, half_circle / 2);
  while (random.uniform(0, 2) > foliage.density(t));
  const double azimuth = random.uniform(0, 2 * half_circle), turn = random.uniform(0, 2 * half_circle);
  const Vec3 normal{std::sin(t) * std::cos(azimuth), std::sin(t) * std::sin(azimuth), std::cos(t)};
  const Vec3 level{-std::sin(azimuth), std::cos(azimuth), 0}, steep = cross(normal, level);
  const double radius = std::sqrt(4 * area / (3 * std::sqrt(3.0)));
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int k = 0; k < 3; ++k) {
    const double a = turn + k * 2 * half_circle / 3;
    mesh.vertices.push_back(centre + radius * (std::cos(a) * level + std::sin(a) * steep));
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// Light that a canopy met and sent back, as shares of the light that was sent; what was sent back of a white wall's.
struct Seen {
  double met = 0, back = 0;
  std::array<double, 4> by_depth{};  ///< light sent back from quarters of the slab, from above, as shares of it
};

/// Light of pulses on a canopy below z = `top`.
template <class Survey>
Seen seen(const Survey& survey, double top, double thickness) {
  auto workspace = survey.workspace();
  Seen all;
  const double pulses = static_cast<double>(survey.size()), full = Laser{}.peak_power * vacuum.efficiency;
  for (PulseIndex i = 0; i < survey.size(); ++i) {
    const Outcome o = survey(i, workspace);
    all.met += 1 - o.energy.share(&EnergyLedger::missed);
    for (const SubrayRecord& hit : o.subrays) {
      if (!hit.met()) continue;
      const double back = hit.power / full * 4 * hit.range * hit.range / (vacuum.diameter * vacuum.diameter);
      const double quarter = std::clamp(4 * (top - hit.point.z) / thickness, 0.0, 3.5);  // leaves stick out a little
      all.back += back;
      all.by_depth[static_cast<std::size_t>(quarter)] += back;
    }
  }
  for (double& share : all.by_depth) share /= all.back;
  all.met /= pulses;
  all.back /= pulses;
  return all;
}

// -------------------------------------------------------------------------------------------- slab

constexpr double tile = 4;               ///< edge of a square of leaves, which is repeated along the flight [m]
constexpr double leaf_area_index = 1.5;  ///< of a slab of 1 m [m^2/m^2]

/// Three squares of leaves of 1 cm^2, from z = -1 m to 0.
Scene<Leaves> slab_of_leaves(const Foliage& foliage, std::uint64_t seed) {
  support::Generator random(seed);
  MeshData mesh;
  const auto count = static_cast<std::size_t>(std::lround(tile * tile * leaf_area_index / 1e-4));
  for (std::size_t k = 0; k < count; ++k) {
    const double x = random.uniform(0, tile), y = random.uniform(0, tile), z = random.uniform(-1, 0);
    add_leaf(mesh, {x, y, z}, 1e-4, foliage, random);
  }
  const auto shape = std::make_shared<const Leaves>(mesh);
  const auto materials = material_table({leaf_material});
  std::vector<Scene<Leaves>::Part> parts;
  for (const double from : {-tile, 0.0, tile}) parts.push_back({shape, materials, {.translation = {0, from, 0}}, 1});
  return Scene<Leaves>(std::move(parts));
}

/// The same by voxels.
Scene<Voxels> slab_of_voxels(const Foliage& foliage) {
  VoxelData slab{.corner = {0, -tile, -1}, .edge = 0.5};
  for (std::uint32_t x = 0; x < 8; ++x)
    for (std::uint32_t y = 0; y < 24; ++y)
      for (std::uint32_t z = 0; z < 2; ++z) {
        slab.cells.push_back({x, y, z});
        slab.densities.push_back(static_cast<float>(leaf_area_index));
      }
  return Scene<Voxels>({{std::make_shared<const Voxels>(slab, TransmissiveVoxels{.leaf_angles = foliage.angles}),
                         material_table({leaf_material}),
                         {},
                         1}});
}

/// What a flight over the middle square sees that looks down and ahead, with footprints of 2 m.
template <class Map>
Seen flight(const Map& map, double zenith) {
  const double back = height * std::tan(zenith);
  const StraightLine line{.from = {tile / 2, -back, height}, .to = {tile / 2, tile - back, height}, .speed = tile};
  // a waist has every subray traced by itself: the cone of a bundle would hold thousands of leaves, which takes far
  // longer
  const Laser laser{.divergence = 2 / (height / std::cos(zenith)), .waist_diameter = 1e-3};
  const Platform source{line, Mount{.boresight = rotation_about(axis::right, zenith - half_circle / 2)},
                        Deflector{FixedBeam{}, Scanner{.pulse_rate = 400, .pulses = 400, .laser = laser}}};
  const Survey survey{source, WithSubrayRecord{SunflowerFootprint{600}}, map, vacuum, FirstHit{}, 7};
  return seen(survey, 0, 1);
}

// ------------------------------------------------------------------------------------------ sphere

// Spheres of RAMI-IV: a radius of 0.5 m, leaves of 5 m^2 per m^2 of a sphere's cross section, in all directions.
constexpr double radius = 0.5;
constexpr double cross_section = half_circle * radius * radius;  ///< [m^2]
constexpr double sphere_density =
    5 * cross_section / (cross_section * radius * 4 / 3);  ///< leaf area density [m^2/m^3]

/// A sphere of 50,000 leaves about the origin.
Scene<Leaves> sphere_of_leaves(const Foliage& foliage) {
  support::Generator random(11);
  MeshData mesh;
  constexpr int count = 50'000;
  while (mesh.triangles.size() < count) {
    const Vec3 place = random.point(radius);
    if (length(place) < radius) add_leaf(mesh, place, 5 * cross_section / count, foliage, random);
  }
  return Scene<Leaves>({{std::make_shared<const Leaves>(mesh), material_table({leaf_material}), {}, 1}});
}

/// The same by voxels of 1 cm; those at its surface have the density of their share inside.
Scene<Voxels> sphere_of_voxels(const Foliage& foliage) {
  constexpr std::uint32_t n = 100, parts = 3;
  VoxelData data{.corner = Vec3(-radius), .edge = 2 * radius / n};
  for (std::uint32_t c = 0; c < n * n * n; ++c) {
    const std::array<std::uint32_t, 3> cell{c % n, c / n % n, c / n / n};
    int inside = 0;
    for (std::uint32_t p = 0; p < parts * parts * parts; ++p) {
      const Vec3 at{cell[0] + (p % parts + 0.5) / parts, cell[1] + (p / parts % parts + 0.5) / parts,
                    cell[2] + (p / parts / parts + 0.5) / parts};
      inside += length(data.corner + data.edge * at) < radius;
    }
    if (inside == 0) continue;
    data.cells.push_back(cell);
    data.densities.push_back(static_cast<float>(sphere_density * inside / (parts * parts * parts)));
  }
  return Scene<Voxels>({{std::make_shared<const Voxels>(data, TransmissiveVoxels{.leaf_angles = foliage.angles}),
                         material_table({leaf_material}),
                         {},
                         1}});
}

/// Even light over the square about a beam, whose half side is the 1/e^2 radius.
class SquareFootprint {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return n * n; }
  [[nodiscard]] double share(std::size_t) const noexcept { return 1.0 / (n * n); }
  [[nodiscard]] Vec2 offset(std::size_t j) const noexcept { return {place(j % n), place(j / n)}; }

 private:
  static constexpr std::size_t n = 500;
  static double place(std::size_t k) noexcept { return (static_cast<double>(k) + 0.5) / n * 2 - 1; }
};
static_assert(Footprint<SquareFootprint>);

/// What a pulse from above sees of the unit cell of a canopy, which holds one sphere.
template <class Map>
Seen unit_cell(const Map& map, double cover) {
  const Laser laser{.divergence = std::sqrt(cross_section / cover) / height};
  const Platform source{Tripod{.position = {0, 0, height}},
                        Mount{.boresight = rotation_about(axis::right, -half_circle / 2)},
                        Deflector{FixedBeam{}, Scanner{.pulses = 1, .laser = laser}}};
  const Survey survey{source, WithSubrayRecord{SquareFootprint{}}, map, vacuum, FirstHit{}, 3};
  return seen(survey, radius, 2 * radius);
}

}  // namespace

TEST_CASE("a slab of voxels and one of leaves") {
  std::uint64_t seed = 1;
  for (const Foliage& foliage : foliages()) {
    const Scene<Leaves> leaves = slab_of_leaves(foliage, seed++);
    const Scene<Voxels> voxels = slab_of_voxels(foliage);
    for (const int angle : {0, 45}) {
      const double zenith = angle * half_circle / 180;
      const Seen by_leaves = flight(leaves, zenith), by_voxels = flight(voxels, zenith);
      const std::string head =
          std::string(foliage.name) + " leaves as triangles, " + std::to_string(angle) + " degrees: ";
      row(Kind::second_implementation, head + "light sent back, of that of voxels", 1, by_leaves.back / by_voxels.back,
          0.02);
      row(Kind::second_implementation, head + "light sent back by light met, of that of voxels", 1,
          by_leaves.back / by_leaves.met / (by_voxels.back / by_voxels.met), 0.02);
      // light that is met, by the law of Beer and Lambert, times reflectance and the mean cosine over what is met
      const Cosines c = cosines(foliage, zenith);
      const double met = 1 - std::exp(-c.mean * leaf_area_index / std::cos(zenith));
      row(head + "light sent back", reflectance * c.mean_square / c.mean * met, by_leaves.back, 0.003);
    }
  }
}

TEST_CASE("depths that a slab sends light back from") {
  const Foliage spherical = foliages()[0];
  const Seen by_leaves = flight(slab_of_leaves(spherical, 1), 0), by_voxels = flight(slab_of_voxels(spherical), 0);
  // Source: Ross 1981: k exp(-k z) of leaves of an extinction k. Leaves shade once, as light returns by the way it
  // came: not exp(-2 k z)
  const double k = cosines(spherical, 0).mean * leaf_area_index;
  for (std::size_t q = 0; q < 4; ++q) {
    const double from = 0.25 * static_cast<double>(q),
                 expected = (std::exp(-k * from) - std::exp(-k * (from + 0.25))) / (1 - std::exp(-k));
    const std::string depth = ", 0 degrees: share sent back from quarter " + std::to_string(q + 1) + " of the slab";
    row("spherical leaves as voxels" + depth, expected, by_voxels.by_depth[q], 0.005);
    row("spherical leaves as triangles" + depth, expected, by_leaves.by_depth[q], 0.005);
  }
}

TEST_CASE("floating spheres of RAMI-IV") {
  // Source: exp(-k s) over the chords of a sphere, integrated; t is its diameter by the mean free path
  const double t = 2 * radius * 0.5 * sphere_density, passed = 2 / (t * t) * (1 - (1 + t) * std::exp(-t));
  const Foliage spherical = foliages()[0];
  const Scene<Leaves> leaves = sphere_of_leaves(spherical);
  const Scene<Voxels> voxels = sphere_of_voxels(spherical);
  for (const double cover : {0.2, 0.4}) {
    const Seen by_leaves = unit_cell(leaves, cover), by_voxels = unit_cell(voxels, cover);
    const std::string tail = cover == 0.2 ? ", cover 0.2: " : ", cover 0.4: ";
    row("RAMI-IV spheres of voxels" + tail + "gap fraction from above", 1 - cover * (1 - passed), 1 - by_voxels.met,
        0.002);
    row("RAMI-IV spheres of triangles" + tail + "gap fraction from above", 1 - cover * (1 - passed), 1 - by_leaves.met,
        0.002);
    const double back = reflectance * 2 / 3 * cover * (1 - passed);
    row("RAMI-IV spheres of voxels" + tail + "light sent back", back, by_voxels.back, 0.001);
    row("RAMI-IV spheres of triangles" + tail + "light sent back", back, by_leaves.back, 0.001);
  }
}
