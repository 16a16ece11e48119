// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// How far away things are met: from 1 mm, as by a borescope, to 40,000 km, as from a satellite.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/height_field.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "extremes/meshes.hpp"
#include "extremes/row.hpp"
#include "support/generators.hpp"
#include "support/scenes.hpp"
#include "validation/one_pulse.hpp"

using namespace pulsecast;
using namespace pulsecast::extremes;
using namespace pulsecast::support;

namespace {

const std::string quantity = "range";

struct Distance {
  std::string name;
  double range;
};
const std::vector<Distance> distances{{"1 mm", 1e-3}, {"1 m", 1}, {"1 km", 1e3}, {"1000 km", 1e6}, {"40,000 km", 4e7}};

/// Bumpy ground of 20 x 20 pixels, a hundredth of the distance from one to the next, but 10 m at most; its middle in
/// the origin.
Raster ground(double distance, Generator& random) {
  const double pixel = std::min(distance / 100, 10.0);
  Raster raster{.columns = 20, .rows = 20, .first = {-9.5 * pixel, 9.5 * pixel}, .pixel = {pixel, pixel}};
  for (int i = 0; i < 400; ++i) raster.heights.push_back(static_cast<float>(random.uniform(-0.3, 0.3) * pixel));
  return raster;
}

}  // namespace

TEST_CASE("ground at any range") {
  std::uint64_t seed = 8200;
  for (const Distance& d : distances) {
    CAPTURE(d.name);
    CAPTURE(++seed);
    Generator random(seed);
    const Raster raster = ground(d.range, random);
    const MeshData data = raster.mesh();
    const HeightField field(raster);
    const Meshes meshes(data);
    Verdict verdict;
    Comparison others;
    for (int time = 0; time < 60; ++time) {
      const Vec3 from = normalize(random.unit() + Vec3{0, 0, 1.5});
      RayBundle rays;
      rays.origin = from * d.range;
      rays.size = random.coin() ? 1 : 8;
      for (std::size_t j = 0; j < rays.size; ++j) rays.set_direction(j, normalize(target(random, data) - rays.origin));
      if (random.coin()) rays.far = (1 + random.uniform(-1e-6, 1e-6)) * d.range;
      if (random.coin()) rays.near = (1 - 1e-2) * d.range;
      rays.pad();
      judge(field, data, rays, verdict);
      meshes.compare(rays, others);
      compare(meshes.linear, field, "HeightField", rays, others);
    }
    check(verdict, others);
    row(quantity, "ground at " + d.name + ": largest error of a range [1e-15 of it]", 0, verdict.worst / d.range * 1e15,
        100);
  }
}

TEST_CASE("what lies at the very ends of a ray, at any range") {
  std::size_t good = 0, bad = 0;
  for (const Distance& d : distances) {
    const double size = d.range / 4;
    const MeshData data{{{d.range, -size, -size}, {d.range, size, -size}, {d.range, 0, size}}, {{0, 1, 2}}, {}};
    const Meshes meshes(data);
    const auto meet = [&](double near, double far) {
      const RayBundle rays = bundle_of({{}, axis::right, near, far});
      std::size_t met = 0;
      const auto ask = [&](const auto& mesh) {
        ClosestHits nearest(rays);
        mesh.closest(rays, nearest);
        met += nearest.met(0) && nearest.range[0] == d.range ? 1 : 0;
      };
      ask(meshes.linear);
      ask(meshes.bvh);
      ask(meshes.exact_bvh);
      ask(meshes.kd_tree);
      ask(meshes.exact_kd_tree);
      return met;
    };
    const double before = std::nextafter(d.range, 0), after = std::nextafter(d.range, 1e9);
    good += meet(0, d.range) + meet(before, after);
    bad += meet(0, before) + meet(d.range, after);
  }
  row(quantity, "wall at these ranges: answers, of 50, that meet it up to its range, or from a rounding before it", 50,
      static_cast<double>(good), 0);
  row(quantity,
      "wall at these ranges: answers, of 50, that meet it up to a rounding before its range, or from there on", 0,
      static_cast<double>(bad), 0);
}

TEST_CASE("voxels at any range") {
  for (const Distance& d : distances) {
    const double edge = std::min(d.range / 100, 10.0);
    VoxelData data{.corner = {0, -5 * edge, -5 * edge}, .edge = edge};
    for (std::uint32_t y = 0; y < 10; ++y)
      for (std::uint32_t z = 0; z < 10; ++z) data.cells.push_back({0, y, z});
    const VoxelGrid<> grid(data);
    const std::uint64_t seed = 8220;
    Generator random(seed);
    double worst = 0;
    std::size_t met = 0;
    for (int time = 0; time < 1000; ++time) {
      const Vec3 aim{0, random.uniform(-4.9, 4.9) * edge, random.uniform(-4.9, 4.9) * edge};
      const Vec3 origin{-d.range, random.uniform(-0.3, 0.3) * d.range, random.uniform(-0.3, 0.3) * d.range};
      const RayBundle rays = bundle_of({origin, normalize(aim - origin)});
      ClosestHits nearest(rays);
      grid.closest(rays, nearest);
      met += nearest.met(0) ? 1 : 0;
      if (nearest.met(0)) worst = std::max(worst, std::fabs(nearest.range[0] * rays.x[0] - d.range));
    }
    CHECK(met == 1000);
    row(quantity, "voxels at " + d.name + ": largest error of a range [1e-15 of it]", 0, worst / d.range * 1e15, 100);
  }
}

TEST_CASE("a pulse's echo from a wall, at any range") {
  const auto ask = [](const std::string& detector, const auto& instrument) {
    double worst = 0, worst_power = 0;
    for (const Distance& d : distances) {
      CAPTURE(d.name);
      const double size = d.range / 4;
      const MeshData plate{{{-size, d.range, -size}, {size, d.range, -size}, {0, d.range, size}}, {{0, 1, 2}}, {}};
      const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(plate)}});
      // Source: laser radar equation for an extended target, Jelalian 1992; near by, the solid angle of a disc on the
      // quantity
      const Receiver& receiver = validation::vacuum;
      const double reach = std::hypot(d.range, receiver.diameter / 2),
                   gain = receiver.diameter * receiver.diameter * receiver.efficiency;
      const Laser laser{.peak_power = 1e9};
      const validation::Result result = validation::one_pulse(scene, SingleRay{}, laser, receiver, instrument);
      REQUIRE(result.echoes.size() == 1);
      worst = std::max(worst, std::fabs(result.echoes[0].range - d.range));
      worst_power =
          std::max(worst_power, std::fabs(result.power / (laser.peak_power * 0.5 * gain / (4 * reach * reach)) - 1));
    }
    row(quantity, detector + ", wall at these ranges: largest error of the range [nm]", 0, worst * 1e9, 1000);
    row(quantity, detector + ", wall at these ranges: largest error of the power [1e-12]", 0, worst_power * 1e12, 1);
  };
  const WaveformSettings settings{.threshold = 0, .timing = EchoTiming::true_range};
  ask("FirstHit", FirstHit{});
  ask("AnalyticWaveform", AnalyticWaveform{settings});
  ask("FullWaveform", FullWaveform{settings});
}
