// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Leaves of a size: voxels beside facets at random places, for scanners of few and of many subrays.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "support/generators.hpp"
#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

constexpr double depth = 6, half = 11, leaf = 0.0064, density = 0.5;  // of the slab [m], [m], [m^2], [m^2/m^3]

/// Square leaves at random places and of random directions.
MeshData facets(std::uint64_t seed) {
  support::Generator random(seed);
  MeshData mesh;
  const auto number = static_cast<std::uint32_t>(std::lround(4 * half * half * depth * density / leaf));
  const double edge = std::sqrt(leaf);
  for (std::uint32_t i = 0; i < number; ++i) {
    const Vec3 centre{random.uniform(-half, half), random.uniform(-half, half), random.uniform(0, depth)};
    const Rotation turn = random.rotation();
    const Vec3 across = turn * Vec3{0.5 * edge, 0, 0}, up = turn * Vec3{0, 0.5 * edge, 0};
    for (const Vec3& corner : {centre - across - up, centre + across - up, centre + across + up, centre - across + up})
      mesh.vertices.push_back(corner);
    mesh.triangles.push_back({4 * i, 4 * i + 1, 4 * i + 2});
    mesh.triangles.push_back({4 * i, 4 * i + 2, 4 * i + 3});
  }
  return mesh;
}

VoxelData voxels() {
  VoxelData slab{.corner = {-half, -half, 0}, .edge = 0.5};
  for (std::uint32_t x = 0; x < 44; ++x)
    for (std::uint32_t y = 0; y < 44; ++y)
      for (std::uint32_t z = 0; z < 12; ++z) {
        slab.cells.push_back({x, y, z});
        slab.densities.push_back(static_cast<float>(density));
      }
  return slab;
}

struct Statistics {
  double echoes = 0, power = 0, deviation = 0;  ///< echoes a pulse; mean power [W]; its relative deviation
};

/// Pulses straight down from 50 m, to places 1 m apart, with a footprint of 0.6 m.
template <class Map>
Statistics of(const Map& map, std::size_t subrays) {
  Statistics s;
  double square = 0;
  int pulses = 0;
  for (int x = -9; x <= 9; ++x)
    for (int y = -9; y <= 9; ++y, ++pulses) {
      const Platform source{
          Tripod{.position = {x, y, 50}}, Mount{.boresight = rotation_about(axis::right, -pi / 2)},
          Deflector{FixedBeam{}, Scanner{.pulses = 1, .laser = {.pulse_length = 4e-9, .divergence = 0.6 / 47}}}};
      const Survey survey{source,
                          SunflowerFootprint{subrays},
                          map,
                          vacuum,
                          FullWaveform{{.threshold = 1e-12, .returns_max = 255}},
                          static_cast<std::uint64_t>(pulses)};
      auto workspace = survey.workspace();
      const Outcome o = survey(0, workspace);
      s.echoes += static_cast<double>(o.echoes.size());
      s.power += o.energy.received;
      square += o.energy.received * o.energy.received;
    }
  s.echoes /= pulses;
  s.power /= pulses;
  s.deviation = std::sqrt(square / pulses / (s.power * s.power) - 1);
  return s;
}

}  // namespace

TEST_CASE("leaves of a size") {
  using Mesh = TriangleMesh<>;
  using Grid = VoxelGrid<TransmissiveVoxels>;
  const Scene<Mesh> leaves({{std::make_shared<const Mesh>(facets(7)), material_table(), {}, 1}});
  const Scene<Grid> sized(
      {{std::make_shared<const Grid>(voxels(), TransmissiveVoxels{.leaf_area = leaf}), material_table(), {}, 1}});

  for (const std::size_t n : std::array<std::size_t, 5>{7, 19, 62, 279, 2001}) {
    const Statistics facets = of(leaves, n), voxels = of(sized, n);
    const std::string title = std::to_string(n) + " subrays, voxels of leaves by facets: ";
    row(Kind::second_implementation, title + "echoes a pulse", 1, voxels.echoes / facets.echoes, 0.05);
    row(Kind::second_implementation, title + "power", 1, voxels.power / facets.power, 0.02);
    row(Kind::second_implementation, title + "deviation of the power", 1, voxels.deviation / facets.deviation, 0.15);
  }
}
