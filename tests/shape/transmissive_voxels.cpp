// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/transmissive_voxels.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/geometry/bundle.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "support/generators.hpp"

using namespace pulsecast;

namespace {

using Grid = VoxelGrid<TransmissiveVoxels>;

/// A slab of 20 m by 20 m by 2 m of leaves.
VoxelData slab(double edge, double density) {
  VoxelData data{.corner = {-10, -10, 0}, .edge = edge};
  const auto across = static_cast<std::uint32_t>(std::lround(20 / edge)),
             up = static_cast<std::uint32_t>(std::lround(2 / edge));
  for (std::uint32_t x = 0; x < across; ++x)
    for (std::uint32_t y = 0; y < across; ++y)
      for (std::uint32_t z = 0; z < up; ++z) {
        data.cells.push_back({x, y, z});
        data.densities.push_back(static_cast<float>(density));
      }
  return data;
}

/// Range of the leaf that a ray meets; infinite if none [m].
double range_of(const Grid& grid, const Vec3& origin, const Vec3& direction, std::uint64_t seed = 3,
                PulseIndex pulse = 0) {
  RayBundle rays = bundle_of({origin, direction});
  rays.seed = seed;
  rays.pulse = pulse;
  ClosestHits nearest(rays);
  grid.closest(rays, nearest);
  return nearest.range[0];
}

}  // namespace

TEST_CASE("leaves of a size let as much light pass as those without, whatever the size of voxels and the direction") {
  constexpr double density = 1.2;
  const double area = 1e-3;
  for (const double edge : {0.25, 2.0}) {
    const Grid grid(slab(edge, density), {.leaf_area = area});
    for (const double zenith : {0.0, 0.6, 1.0}) {
      support::Generator random(11);
      const Vec3 direction{std::sin(zenith), 0, -std::cos(zenith)};
      int passed = 0;
      constexpr int rays = 20'000;
      for (int i = 0; i < rays; ++i) {
        const Vec3 foot{random.uniform(-6, 6), random.uniform(-9, 9), 1};
        passed += std::isinf(range_of(grid, foot - 5.0 * direction, direction)) ? 1 : 0;
      }
      const double expected = std::exp(-0.5 * density * 2 / std::cos(zenith));
      INFO("seed 11, voxels of ", edge, " m, zenith ", zenith);
      CHECK(std::fabs(1.0 * passed / rays - expected) < 4 * std::sqrt(expected * (1 - expected) / rays));
    }
  }
}

TEST_CASE("rays closer than a leaf is wide mostly meet the same one, farther ones others, and pulses the same") {
  const Grid grid(slab(0.5, 3), {.leaf_area = 0.01});
  const Vec3 direction = normalize(Vec3{0.3, 0.1, -1});
  support::Generator random(12);
  int near = 0, far = 0, met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 origin{random.uniform(-5, 5), random.uniform(-5, 5), 4};
    const double range = range_of(grid, origin, direction);
    CHECK(range_of(grid, origin, direction, 3, 77) == range);
    if (std::isinf(range)) continue;
    ++met;
    near += std::fabs(range_of(grid, origin + Vec3{0.01, 0, 0}, direction) - range) < 0.01 ? 1 : 0;
    far += std::fabs(range_of(grid, origin + Vec3{0.3, 0, 0}, direction) - range) < 0.01 ? 1 : 0;
  }
  INFO("seed 12: ", met, " met, ", near, " near ones alike, ", far, " far ones");
  CHECK(near > 0.75 * met);  // nine in ten in the same column of a layer
  CHECK(far < 0.1 * met);
  CHECK(range_of(grid, {0, 0, 4}, direction, 3) != range_of(grid, {0, 0, 4}, direction, 4));
}

TEST_CASE("clumping is a factor of the extinction") {
  const Grid clumped(slab(0.5, 2), {.clumping = 0.5}), even(slab(0.5, 1));
  for (PulseIndex pulse = 0; pulse < 500; ++pulse) {
    const double a = range_of(clumped, {0, 0, 4}, -axis::up, 3, pulse),
                 b = range_of(even, {0, 0, 4}, -axis::up, 3, pulse);
    CHECK((std::isinf(a) ? std::isinf(b) : a == doctest::Approx(b).epsilon(1e-12)));
  }
}

TEST_CASE("tilts of leaves of a size have the mean of all leaves, and are spherical where leaves are") {
  const Grid grid(slab(0.5, 3), {.leaf_area = 1e-4});
  support::Generator random(13);
  double mean = 0, square = 0;
  int met = 0;
  for (int i = 0; i < 20'000; ++i) {
    RayBundle rays = bundle_of({{random.uniform(-5, 5), random.uniform(-5, 5), 4}, -axis::up});
    ClosestHits nearest(rays);
    grid.closest(rays, nearest);
    if (!nearest.met(0)) continue;
    CHECK(grid.surface(nearest.primitive_of(0), rays, 0).foliage);
    const double cosine = std::fabs(grid.surface(nearest.primitive_of(0), rays, 0).normal.z);
    mean += cosine;
    square += cosine * cosine;
    ++met;
  }
  INFO("seed 13");
  CHECK(mean / met == doctest::Approx(2.0 / 3).epsilon(0.01));  // 4 standard errors: 0.007
  CHECK(square / met == doctest::Approx(0.5).epsilon(0.02));
}

TEST_CASE("settings out of range are refused") {
  CHECK_THROWS_AS(Grid(slab(1, 1), {.leaf_area = -1}), SettingError);
  CHECK_THROWS_AS(Grid(slab(1, 1), {.leaf_area = 1000}), SettingError);
  CHECK_THROWS_AS(Grid(slab(1, 1), {.clumping = 0}), SettingError);
}
