// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Leaf area density: 0, and 1e-12 to 1e9 and beyond, in one cell and in a row of them. How deep each ray gets is held
// against the free path that its random number gives, in extended precision.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/random.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "extremes/detectors.hpp"
#include "extremes/row.hpp"

using namespace pulsecast;
using namespace pulsecast::extremes;

namespace {

using Grid = VoxelGrid<TransmissiveVoxels>;
using Leaves = Scene<Grid>;
using Real = long double;

const std::string quantity = "leaf area density";
constexpr double before = 10;  // of the leaves: empty space [m]
constexpr PulseIndex pulses = 20'000;
constexpr std::uint64_t seed = 5;

/// A row of cells along the beam, from 10 m on.
Leaves row_of_cells(float density, double edge, std::uint32_t cells,
                    const LeafAngles& angles = LeafAngles::spherical()) {
  VoxelData data{.corner = {-0.5 * edge, before, -0.5 * edge}, .edge = edge};
  for (std::uint32_t k = 0; k < cells; ++k) {
    data.cells.push_back({0, k, 0});
    data.densities.push_back(density);
  }
  return Leaves(
      {{std::make_shared<const Grid>(data, TransmissiveVoxels{.leaf_angles = angles}), material_table(), {}, 1}});
}

template <class Detector>
auto survey_of(const Leaves& leaves, const Detector& detector) {
  const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = pulses}}};
  return Survey{source, SingleRay{}, leaves, validation::vacuum, detector, seed};
}

/// Of all pulses: how many met leaves, how many did and should not or should and did not, and the largest error of a
/// range, as a share.
struct Depths {
  std::uint64_t met = 0, wrong = 0;
  double worst = 0;

  template <class Detector>
  void add(const Leaves& leaves, double density, double depth, const Detector& detector, PulseIndex number) {
    const auto survey = survey_of(leaves, detector);
    auto workspace = survey.workspace();
    for (PulseIndex i = 0; i < number; ++i) {
      const Outcome outcome = survey(i, workspace);
      const Real path = -std::log(static_cast<Real>(uniform({seed, i, 0, Purpose::free_path}))) / (0.5L * density);
      const bool meets = path < depth, found = !outcome.echoes.empty();
      met += found ? 1 : 0;
      wrong += found == meets ? 0 : 1;
      if (!found || !meets) continue;
      worst = std::max(worst, static_cast<double>(std::fabs(outcome.echoes[0].range / (before + path) - 1)));
    }
  }
};

}  // namespace

TEST_CASE("leaf area densities") {
  struct Case {
    const char* name;
    float density;
    double edge;  // [m]
    std::uint32_t cells;
  };
  for (const auto& [name, density, edge, cells] :
       {Case{"0, in 1000 cells of 1 km", 0, 1e3, 1000},
        {"1e-12, in 1000 cells of 1 m", 1e-12F, 1, 1000},
        {"1e-12, in 1000 cells of 2e9 m", 1e-12F, 2e9, 1000},
        {"1e-12, in a cell of 2e12 m", 1e-12F, 2e12, 1},
        {"1, in 200 cells of 0.01 m", 1, 0.01, 200},
        {"1e9, in a cell of 1 m", 1e9F, 1, 1},
        {"1e9, in 100 cells of 0.1 nm", 1e9F, 1e-10, 100},
        {"3.4e38, in a cell of 1 m", std::numeric_limits<float>::max(), 1, 1}}) {
    const Leaves leaves = row_of_cells(density, edge, cells);
    const double real_density = density, depth = edge * cells;
    Depths depths;
    depths.add(leaves, real_density, depth, FirstHit{}, pulses);
    const std::string what = name + std::string(", 20 000 rays: ");
    row(quantity, what + "share that is met", -std::expm1(-0.5 * real_density * depth),
        static_cast<double>(depths.met) / pulses, 0.01);
    for_each_waveform(WaveformSettings{.threshold = 0}, [&](const char*, const auto& detector) {
      depths.add(leaves, real_density, depth, detector, 200);
    });
    row(quantity, what + "met and should not be, or the reverse, all detectors and widths", 0,
        static_cast<double>(depths.wrong), 0);
    row(quantity, what + "largest error of the range, as a share", 0, depths.worst, 1e-13);
  }
}

TEST_CASE("leaves edge on, and densities that cannot be") {
  std::vector<LeafProjection> edge_on;
  for (int k = 0; k <= 18; ++k) edge_on.push_back({.zenith = k * pi / 36, .g = 0});
  Depths depths;
  depths.add(row_of_cells(1e9F, 1, 1, LeafAngles::table(edge_on)), 0, 1, FirstHit{}, pulses);
  row(quantity, "1e9, all leaves edge on, 20 000 rays: how many are met", 0, static_cast<double>(depths.met), 0);
  refused(quantity, "-1e-12", [] { return row_of_cells(-1e-12F, 1, 1); });
  refused(quantity, "infinite", [] { return row_of_cells(std::numeric_limits<float>::infinity(), 1, 1); });
  refused(quantity, "no number", [] { return row_of_cells(std::numeric_limits<float>::quiet_NaN(), 1, 1); });
}
