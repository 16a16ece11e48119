// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// What tracing costs: one pulse after another from a scanner's place, by scene, accelerator and number of subrays. A figure counts only
// once the accelerator has agreed with `Linear` on a sample of the same pulses.

#define CATCH_CONFIG_MAIN
#define CATCH_CONFIG_ENABLE_BENCHMARKING
#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <pulsecast/pulsecast.hpp>

#include "../examples/tree.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// Hills, 1 km by 1 km, of 2 * cells^2 triangles.
MeshData hills(std::uint32_t cells) {
  MeshData mesh;
  const double step = 1_km / cells;
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const double x = i * step, y = j * step;
      mesh.vertices.push_back({x, y, 20 * std::sin(x / 90) * std::cos(y / 70) + 2 * std::sin(x / 7 + y / 11)});
    }
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i, c = a + cells + 1;
      mesh.triangles.push_back({a, a + 1, c + 1});
      mesh.triangles.push_back({a, c + 1, c});
    }
  return mesh;
}

/// The pulses of a line scanner that turns, as bundles: `subrays` each, from `place`, within the given elevations.
std::vector<RayBundle> pulses(const Vec3& place, double low, double high, std::size_t subrays, std::size_t count) {
  const SunflowerFootprint footprint(subrays);
  std::vector<RayBundle> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count);
    const double line = 50 * share - std::floor(50 * share);
    const Rotation aim = rotation_about(up, 2 * pi * share) * rotation_about(right, low + (high - low) * line);
    RayBundle rays;
    rays.origin = place, rays.size = subrays;
    for (std::size_t j = 0; j < subrays; ++j) rays.set_direction(j, aim * subray_direction(footprint.offset(j), 0.3_mrad));
    rays.pad();
    all.push_back(rays);
  }
  return all;
}

double sum_of_ranges(const auto& mesh, const std::vector<RayBundle>& all) {
  double sum = 0;
  for (const RayBundle& rays : all) {
    Nearest nearest(rays);
    mesh.closest(rays, nearest);
    for (std::size_t j = 0; j < rays.size; ++j) sum += nearest.met(j) ? nearest.range[j] : 0;
  }
  return sum;
}

template <template <class> class Index>
void measure(const std::string& what, const MeshData& data, const TriangleMesh<Linear>& oracle, const Vec3& place, double low,
             double high) {
  const TriangleMesh<Index> mesh(data);
  for (const std::size_t subrays : {std::size_t{1}, std::size_t{19}}) {
    const auto sample = pulses(place, low, high, subrays, 20);
    REQUIRE(sum_of_ranges(mesh, sample) == sum_of_ranges(oracle, sample));
    const auto all = pulses(place, low, high, subrays, 10'000);
    BENCHMARK("10,000 pulses of " + std::to_string(subrays) + ", " + what) { return sum_of_ranges(mesh, all); };
  }
}

void measure_all(const std::string& scene, const MeshData& data, const Vec3& place, double low, double high) {
  const TriangleMesh<Linear> oracle(data);
  const std::string what = scene + " of " + std::to_string(data.triangles.size()) + " triangles, ";
  measure<Bvh>(what + "Bvh", data, oracle, place, low, high);
  measure<KdTree>(what + "KdTree", data, oracle, place, low, high);
}

}  // namespace

TEST_CASE("hills from the air") { measure_all("hills", hills(500), {500, 500, 1000}, -90_deg, -60_deg); }

TEST_CASE("a tree from the ground") { measure_all("a tree", wood::broadleaf({}, wood::Dice(1, 0)), {8, 0, 1.7}, -10_deg, 60_deg); }

TEST_CASE("a build") {
  const MeshData data = hills(500);
  BENCHMARK("a Bvh of 500,000 triangles") { return TriangleMesh<Bvh>(data).size(); };
  BENCHMARK("a KdTree of 500,000 triangles") { return TriangleMesh<KdTree>(data).size(); };
}
