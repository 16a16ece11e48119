// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of scanning a grid of voxels by their number: 10^4 and 10^7 cells of the same kind of scene, single rays and
// bundles, alternating. Rows are named scene/cells/subrays.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/shape/voxel_data.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "report.hpp"
#include "scenes.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

double draw(std::uint64_t i) { return uniform({1, i, 0, Purpose::scene}); }

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
bench::Bundles pulses(const VoxelGrid<Filling>& grid, std::size_t subrays, std::size_t count) {
  const SunflowerFootprint footprint(subrays);
  const Box box = grid.bounds();
  const Vec3 size = box.size(), place{box.centre().x, box.centre().y, box.max.z + 0.3 * size.x};
  bench::Bundles all;
  for (std::size_t i = 0; i < count; ++i) {
    const double along = static_cast<double>(i) / static_cast<double>(count),
                 across = 300 * along - std::floor(300 * along);
    const Vec3 towards = normalize(box.min + size * Vec3{across, along, 0.5} - place);
    const Rotation aim = rotation_about(cross(axis::forward, towards), std::acos(dot(axis::forward, towards)));
    RayBundle rays;
    rays.origin = place;
    rays.size = subrays;
    rays.pulse = i;
    for (std::size_t j = 0; j < subrays; ++j)
      rays.set_direction(j, aim * subray_direction(footprint.offset(j), 0.3_mrad));
    rays.pad();
    all.add(rays);
  }
  return all;
}

template <class Filling>
struct Built {
  VoxelGrid<Filling> grid;
  double seconds;  ///< to build
};

template <class Filling>
Built<Filling> build(VoxelData data) {
  if constexpr (!std::is_same_v<Filling, OpaqueVoxels>)
    data.densities.assign(data.cells.size(), static_cast<float>(5 / data.edge));
  const double start = bench::process_seconds();
  VoxelGrid<Filling> grid(data);
  return {std::move(grid), bench::process_seconds() - start};
}

template <class Filling>
void compare(bench::Report& report, const std::string& scene, VoxelData (*make)(std::uint32_t), std::uint32_t small,
             std::uint32_t large) {
  if (!report.wanted(scene)) return;
  report.heading(scene);
  const std::vector<Built<Filling>> built{build<Filling>(make(small)), build<Filling>(make(large))};
  for (const std::size_t subrays : {std::size_t{1}, std::size_t{19}}) {
    std::vector<std::function<void()>> works;
    for (const auto& [grid, seconds] : built)
      works.emplace_back([&grid = grid, all = pulses(grid, subrays, 200'000 / subrays)] {
        bench::keep(bench::sum_of_ranges(grid, all));
      });
    const std::vector<bench::Times> times = report.by_turns(works);
    const double rays = static_cast<double>(200'000 / subrays * subrays);
    for (std::size_t k = 0; k < built.size(); ++k) {
      const double cells = static_cast<double>(built[k].grid.size());
      report.row(scene + "/" + std::to_string(built[k].grid.size()) + "/" + std::to_string(subrays),
                 {{"Mrays/s", rays / bench::median(times[k]) / 1e6},
                  {"times as fast as the first", bench::speed_ratio(times[k], times[0])},
                  {"s to build", built[k].seconds},
                  {"bytes/voxel", static_cast<double>(built[k].grid.memory()) / cells}});
    }
  }
}

}  // namespace

int main(int count, char** words) {
  bench::Report report("voxel_grid", count, words);
  compare<OpaqueVoxels>(report, "haze, opaque", haze, 100, 1000);
  compare<OpaqueVoxels>(report, "hills, opaque", hills, 100, 3162);
  compare<OpaqueVoxels>(report, "block, opaque", block, 22, 215);
  compare<TransmissiveVoxels>(report, "haze, transmissive", haze, 100, 1000);
  compare<TransmissiveVoxels>(report, "block, transmissive", block, 22, 215);
}
