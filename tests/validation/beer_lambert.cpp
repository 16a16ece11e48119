// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// What passes a slab of leaves, by the law of Beer and Lambert, for a scanner above it that looks down aslant.

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using namespace pulsecast::validation;

namespace {

/// The mean projection of unit leaf area, by its definition: the mean of the cosine between leaf normal and direction
/// over all azimuths and the distribution of inclinations. Source: Ross 1981; de Wit 1965 for the distributions.
template <class Density>
double projection(const Density& density, double zenith) {
  const int n = 2000;
  double sum = 0;
  std::vector<double> cosines;  // of the azimuths
  for (int k = 0; k < n; ++k) cosines.push_back(std::cos((k + 0.5) / n * pi));
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) / n * pi / 2, share = density(t);
    const double upright = std::cos(zenith) * std::cos(t), aside = std::sin(zenith) * std::sin(t);
    for (const double cosine : cosines) sum += share * std::fabs(upright + aside * cosine);
  }
  return sum * pi / 2 / n / n;
}

/// Share of a million subrays that pass 2 m of leaves of 0.6 m^2/m^3.
double passed(const LeafAngles& leaves, double zenith, std::uint64_t seed) {
  using Grid = VoxelGrid<TransmissiveVoxels>;
  VoxelData slab{.corner = {-20, -20, 0}, .edge = 0.5};
  for (std::uint32_t x = 0; x < 80; ++x)
    for (std::uint32_t y = 0; y < 80; ++y)
      for (std::uint32_t z = 0; z < 4; ++z) {
        slab.cells.push_back({x, y, z});
        slab.densities.push_back(0.6F);
      }
  const Scene<Grid> scene(
      {{std::make_shared<const Grid>(slab, TransmissiveVoxels{.leaf_angles = leaves}), material_table(), {}, 1}});
  const Platform source{Tripod{.position = {0, 0, 10}},
                        Mount{.boresight = rotation_about(axis::right, zenith - pi / 2)},
                        Deflector{FixedBeam{}, Scanner{.pulses = 2000, .laser = {.divergence = 1e-6}}}};
  const Survey survey{source, SunflowerFootprint{500}, scene, vacuum, FirstHit{}, seed};
  return run(survey, {}).energy.share(&EnergyLedger::missed);
}

}  // namespace

TEST_CASE("share that passes a slab of leaves") {
  const double zenith = 40_deg, depth = 2 * 0.6 / std::cos(zenith);
  // three standard errors of a million draws are 1.5e-3 at most
  const auto check = [&](const char* name, const LeafAngles& leaves, const auto& density, std::uint64_t seed) {
    row("slab of " + std::string(name) + " leaves, 40 degrees from the vertical: share that passes",
        std::exp(-projection(density, zenith) * depth), passed(leaves, zenith, seed), 0.0015);
  };
  check(
      "spherical", LeafAngles::spherical(), [](double t) { return std::sin(t); }, 1);
  check(
      "planophile", LeafAngles::planophile(), [](double t) { return 2 / pi * (1 + std::cos(2 * t)); }, 2);
  check(
      "erectophile", LeafAngles::erectophile(), [](double t) { return 2 / pi * (1 - std::cos(2 * t)); }, 3);
  check(
      "plagiophile", LeafAngles::plagiophile(), [](double t) { return 2 / pi * (1 - std::cos(4 * t)); }, 4);
  check(
      "extremophile", LeafAngles::extremophile(), [](double t) { return 2 / pi * (1 + std::cos(4 * t)); }, 5);
  check(
      "uniform", LeafAngles::uniform(), [](double) { return 2 / pi; }, 6);
}
