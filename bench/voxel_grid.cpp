// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// What it costs to scan a grid of voxels, by how many there are: 10^4 and 10^7 cells of the same kind of scene, single rays and bundles.
// Says the ratio of the rates, the memory a voxel and the time to build.

#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <string>
#include <type_traits>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/voxel_data.hpp>
#include <pulsecast/scene/voxel_grid.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

double draw(std::uint64_t i) { return uniform({1, i, 0, Purpose::scene}); }

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One cell in a hundred of a cube.
VoxelData haze(std::uint32_t size) {
  VoxelData data{.edge = 0.1};
  std::uint64_t i = 0;
  for (std::uint32_t z = 0; z < size; ++z)
    for (std::uint32_t y = 0; y < size; ++y)
      for (std::uint32_t x = 0; x < size; ++x)
        if (draw(++i) < 0.01) data.cells.push_back({x, y, z});
  return data;
}

/// A terrain, one cell high, of size^2 cells: the same hills in more detail.
VoxelData hills(std::uint32_t size) {
  VoxelData data{.edge = 100.0 / size};
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const double e = x * data.edge, n = y * data.edge;
      const double height = 10 + 4 * std::sin(e / 9) * std::cos(n / 7) + std::sin(e / 2 + n / 3);
      data.cells.push_back({x, y, static_cast<std::uint32_t>(height / data.edge)});
    }
  return data;
}

/// A block without a gap.
VoxelData block(std::uint32_t size) {
  VoxelData data{.edge = 10.0 / size};
  for (std::uint32_t z = 0; z < size; ++z)
    for (std::uint32_t y = 0; y < size; ++y)
      for (std::uint32_t x = 0; x < size; ++x) data.cells.push_back({x, y, z});
  return data;
}

/// The pulses of a line scanner above the middle of the grid, all over it.
template <class Filling>
std::vector<RayBundle> pulses(const VoxelGrid<Filling>& grid, std::size_t subrays, std::size_t count) {
  const SunflowerFootprint footprint(subrays);
  const Box box = grid.bounds();
  const Vec3 size = box.size(), place{box.centre().x, box.centre().y, box.max.z + 0.3 * size.x};
  std::vector<RayBundle> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double along = static_cast<double>(i) / static_cast<double>(count), across = 300 * along - std::floor(300 * along);
    const Vec3 towards = normalize(box.min + size * Vec3{across, along, 0.5} - place);
    const Rotation aim = rotation_about(cross(axis::forward, towards), std::acos(dot(axis::forward, towards)));
    RayBundle rays;
    rays.origin = place;
    rays.size = subrays;
    rays.pulse = i;
    for (std::size_t j = 0; j < subrays; ++j) rays.set_direction(j, aim * subray_direction(footprint.offset(j), 0.3_mrad));
    rays.pad();
    all.push_back(rays);
  }
  return all;
}

/// Rays a second, the best of five.
template <class Filling>
double rate(const VoxelGrid<Filling>& grid, std::size_t subrays) {
  const auto all = pulses(grid, subrays, 200'000 / subrays);
  double best = 0;
  for (int round = 0; round < 5; ++round) {
    std::size_t met = 0;
    const auto start = std::chrono::steady_clock::now();
    for (const RayBundle& rays : all) {
      ClosestHits nearest(rays);
      grid.closest(rays, nearest);
      for (std::size_t j = 0; j < subrays; ++j) met += nearest.met(j) ? 1 : 0;
    }
    REQUIRE(met > 0);
    best = std::max(best, static_cast<double>(all.size() * subrays) / seconds_since(start));
  }
  return best;
}

template <class Filling>
VoxelGrid<Filling> built(VoxelData data) {
  if constexpr (!std::is_same_v<Filling, OpaqueVoxels>) data.densities.assign(data.cells.size(), static_cast<float>(5 / data.edge));
  const auto start = std::chrono::steady_clock::now();
  VoxelGrid<Filling> grid(data);
  std::cout << "  " << grid.size() << " cells: built in " << seconds_since(start) << " s, "
            << static_cast<double>(grid.memory()) / static_cast<double>(grid.size()) << " bytes a voxel\n";
  return grid;
}

template <class Filling>
void compare(const std::string& scene, const VoxelData& few, const VoxelData& many) {
  std::cout << scene << '\n';
  const auto small = built<Filling>(few), large = built<Filling>(many);
  for (const std::size_t subrays : {std::size_t{1}, std::size_t{19}}) {
    const double a = rate(small, subrays), b = rate(large, subrays);
    std::cout << "  bundles of " << subrays << ": " << a / 1e6 << " and " << b / 1e6 << " million rays a second, ratio " << b / a << '\n';
    CHECK(b / a >= 0.2);
  }
}

}  // namespace

TEST_CASE("a haze of single cells") { compare<OpaqueVoxels>("haze, opaque", haze(100), haze(1000)); }
TEST_CASE("hills") { compare<OpaqueVoxels>("hills, opaque", hills(100), hills(3162)); }
TEST_CASE("a block") { compare<OpaqueVoxels>("block, opaque", block(22), block(215)); }
TEST_CASE("leaves in a haze") { compare<TransmissiveVoxels>("haze, transmissive", haze(100), haze(1000)); }
TEST_CASE("leaves in a block") { compare<TransmissiveVoxels>("block, transmissive", block(22), block(215)); }
