// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Divergence: from 0 to 30 degrees, round and elliptical, before a wall across the beam.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/accel/bvh.hpp>
#include <pulsecast/accel/kd_tree.hpp>
#include <pulsecast/accel/linear.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "extremes/detectors.hpp"
#include "extremes/row.hpp"

using namespace pulsecast;
using namespace pulsecast::extremes;
using namespace pulsecast::literals;

namespace {

using Real = long double;

const std::string quantity = "divergence";
constexpr double distance =
    1;  // of the wall: so near that the pulse does not show how far apart its subrays are met [m]

/// A wall of many triangles, so that there is a tree to go through.
template <class Index>
auto wall() {
  MeshData data;
  constexpr int n = 20;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k) data.vertices.push_back({4.0 * i / n - 2, distance, 4.0 * k / n - 2});
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = i * (n + 1) + k, b = a + n + 1;
      data.triangles.push_back({a, b, b + 1});
      data.triangles.push_back({a, b + 1, a + 1});
    }
  using Mesh = TriangleMesh<Index>;
  return Scene<Mesh>({{std::make_shared<const Mesh>(data), material_table({{.reflectance = 1}}), {}, 1}});
}

/// What the subrays are worth that a footprint sends through a divergence, by the angles of its subrays.
struct Expected {
  Real nearest = std::numeric_limits<Real>::infinity();  ///< [m]
  Real mean = 0;                                         ///< range of the energy that comes back [m]

  Expected(const auto& footprint, const Divergence& divergence) {
    Real sum = 0;
    for (std::size_t j = 0; j < footprint.size(); ++j) {
      const Real x = 0.5L * divergence.across * footprint.offset(j).x, y = 0.5L * divergence.up * footprint.offset(j).y;
      const Real cosine = std::cos(std::hypot(x, y)), range = distance / cosine;
      const Real radius = 0.5L * validation::vacuum.diameter;
      const Real power = footprint.share(j) * cosine / (range * range + radius * radius);  // of a Lambertian surface
      nearest = std::min(nearest, range);
      mean += power * range;
      sum += power;
    }
    mean /= sum;
  }
};

}  // namespace

TEST_CASE("divergences before a wall") {
  const auto linear = wall<Linear<double>>();
  const auto bvh = wall<Bvh<float>>();
  const auto exact_bvh = wall<Bvh<double>>();
  const auto kd_tree = wall<KdTree<float>>();
  const auto exact_kd_tree = wall<KdTree<double>>();
  const SunflowerFootprint footprint{279};
  struct Case {
    const char* name;
    Divergence divergence;
  };
  for (const auto& [name, divergence] : {Case{"0", 0.0},
                                         {"1e-300 rad", 1e-300},
                                         {"1e-9 rad", 1e-9},
                                         {"10 degrees", 10_deg},
                                         {"30 degrees", 30_deg},
                                         {"30 degrees by 5.2e-7 rad", {30_deg, 30_deg * 1e-6}},
                                         {"5.2e-7 rad by 30 degrees", {30_deg * 1e-6, 30_deg}}}) {
    const Laser laser{.divergence = divergence};
    const Expected expected(footprint, divergence);
    double worst = 0, differ = 0;
    for_each_detector(WaveformSettings{.threshold = 0}, [&](const char* detector_name, const auto& detector) {
      CAPTURE(detector_name);
      const auto one = [&](const auto& map) {
        return validation::one_pulse(map, footprint, laser, validation::vacuum, detector);
      };
      const auto result = one(linear);
      REQUIRE(result.echoes.size() == 1);
      const bool first = std::string(detector_name) == "FirstHit";
      worst = std::max(
          worst, static_cast<double>(std::fabs(result.echoes[0].range - (first ? expected.nearest : expected.mean))));
      CHECK(result.energy.share(&EnergyLedger::missed) == 0);
      CHECK(std::isfinite(result.echoes[0].width));
      for (const auto& other : {one(bvh), one(kd_tree), one(exact_bvh), one(exact_kd_tree)})
        differ += other.echoes.size() == 1 && other.echoes[0].range == result.echoes[0].range &&
                          other.echoes[0].amplitude == result.echoes[0].amplitude
                      ? 0
                      : 1;
    });
    const std::string what = name + std::string(", wall at 1 m, 279 subrays, all detectors and widths: ");
    row(quantity, what + "largest error of the range [m]", 0, worst, 1e-9);
    row(quantity, what + "echoes that other accelerators give otherwise, in float and double", 0, differ, 0);
  }
}

TEST_CASE("divergences that cannot be") {
  for (const auto& [name, divergence] : {std::pair{"31 by 1 degrees", Divergence{31_deg, 1_deg}},
                                         {"1 by 31 degrees", {1_deg, 31_deg}},
                                         {"-1e-9 rad", -1e-9},
                                         {"no number", std::numeric_limits<double>::quiet_NaN()},
                                         {"0 by 1 mrad", {0, 1e-3}},
                                         {"1e-9 rad by 10 mrad", {1e-9, 1e-2}},
                                         {"0.5 rad by 5e-324 rad", {0.5, 5e-324}}})
    refused(quantity, name, [&divergence = divergence] { Scanner{.laser = {.divergence = divergence}}.validate(); });
}
