// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Forest of three tree models in one scene, on a terrain raster: a mesh with all leaves; voxels with random
// transmission by leaf density; voxels of a point cloud of the mesh. An airplane flies over it. Writes cloud.las,
// cloud.png, and tree.xyz, the point cloud of the third model.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <utility>
#include <vector>

#include <pulsecast/io/las.hpp>
#include <pulsecast/io/png.hpp>
#include <pulsecast/io/point_cloud.hpp>
#include <pulsecast/io/text_files.hpp>
#include <pulsecast/platform/block_flight.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/shape/height_field.hpp>
#include <pulsecast/shape/leaf_angles.hpp>
#include <pulsecast/shape/voxel_data.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "command_line.hpp"
#include "summary.hpp"
#include "wood.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

using Mesh = TriangleMesh<>;
using Foliage = VoxelGrid<TransmissiveVoxels>;
using Solid = VoxelGrid<OpaqueVoxels>;
using Forest = Scene<HeightField, Mesh, Foliage, Solid>;

/// Height of the ground at a place [m].
double ground(std::uint64_t seed, const Vec2& at) noexcept {
  return 25 * wood::noise(seed + 1, at.x / 210, at.y / 210) + 6 * wood::noise(seed + 2, at.x / 70, at.y / 70) +
         0.4 * wood::noise(seed + 3, at.x / 9, at.y / 9);
}

/// Ground of a square about the origin, in pixels of 1 m.
Raster terrain(std::uint64_t seed, double side) {
  const auto pixels = static_cast<std::uint32_t>(side) + 1;
  Raster raster{.columns = pixels, .rows = pixels, .first = {-side / 2, side / 2}};
  for (std::uint32_t row = 0; row < pixels; ++row)
    for (std::uint32_t column = 0; column < pixels; ++column)
      raster.heights.push_back(static_cast<float>(ground(seed, {column - side / 2, side / 2 - row})));
  return raster;
}

/// Crown without branches: an ellipsoid of leaves, 8 m wide, from 5 m to 17 m above the foot, with fewer leaves towards
/// its centre.
VoxelData crown() {
  constexpr double edge = 0.25, radius = 4, half_height = 6;
  VoxelData voxels{.corner = {-radius, -radius, 5}, .edge = edge};
  for (std::uint32_t i = 0; i < 32; ++i)
    for (std::uint32_t j = 0; j < 32; ++j)
      for (std::uint32_t k = 0; k < 48; ++k) {
        const Vec3 at = (Vec3(i, j, k) + 0.5) * edge - Vec3(radius, radius, half_height);
        const double out = length(at / Vec3(radius, radius, half_height));
        if (out > 1) continue;
        voxels.cells.push_back({i, j, k});
        voxels.densities.push_back(static_cast<float>(0.2 + 1.2 * out * out));  // [m^2/m^3]
      }
  return voxels;
}

/// Scans a tree by one ray per pulse from four sides, into a point cloud file.
void scan_tree(const std::shared_ptr<const Mesh>& tree, const std::filesystem::path& file, unsigned threads) {
  const Scene<Mesh> alone({{.geometry = tree, .materials = material_table(wood::materials())}});
  const Scanner scanner{.pulse_rate = 100_kHz, .pulses = 250'000};
  const OscillatingMirror mirror{.cycle_rate = 50_Hz, .half_angle = 32_deg};
  std::vector<Platform<Tripod, Deflector<RotatingHead, Deflector<OscillatingMirror, Scanner>>>> set_ups;
  for (int side = 0; side < 4; ++side) {
    const double heading = side * 90_deg;  // towards the tree; the head turns from left of it to right of it
    const Vec3 foot = -15.0 * Vec3(std::sin(heading), std::cos(heading), 0);
    const RotatingHead head{.angular_rate = -40_deg / scanner.duration().seconds(), .start = 20_deg};
    set_ups.push_back({Tripod{.position = foot, .heading = heading}, Mount{.lever_arm = {0, 0, 8}},
                       Deflector{head, Deflector{mirror, scanner}}});
  }
  io::XyzWriter xyz(file);
  run(Survey{Legs{set_ups}, SingleRay{}, alone, Receiver{}, FirstHit{}}, {.threads = threads}, xyz);
  xyz.close();
}

/// Forest of `count` trees, drawn from models of one part or several.
Forest plant(std::uint64_t seed, std::size_t count, double side, const std::vector<std::vector<Forest::Part>>& models) {
  const auto soil = material_table({{.name = "soil", .reflectance = 0.35, .classification = 2, .ground = true}});
  std::vector<Forest::Part> parts{
      {.geometry = std::make_shared<const HeightField>(terrain(seed, side)), .materials = soil}};
  wood::Dice dice(seed, 50);
  for (std::size_t tree = 1; tree <= count; ++tree) {
    const Vec2 at{dice.between(-0.49, 0.49) * side, dice.between(-0.49, 0.49) * side};
    const Placement placement{
        rotation_about(axis::up, dice.between(0, 360_deg)), dice.between(0.7, 1.15), {at.x, at.y, ground(seed, at)}};
    const auto model = static_cast<std::size_t>(dice.between(0, static_cast<double>(models.size())));
    for (Forest::Part part : models[model]) {
      part.placement = placement;
      part.object = static_cast<ObjectId>(tree);
      parts.push_back(std::move(part));
    }
  }
  return Forest(std::move(parts));
}

int main(int argc, char** argv) {
  CommandLine line("Scans a forest of meshes, voxels and point clouds from an airplane.");
  std::size_t trees = 10'000;
  double voxel_size = 0.2;
  line.add_number("--trees", trees, 1, 1'000'000, "Number of trees");
  line.add_number("--voxel-size", voxel_size, 0.02, 2, "M", "Voxel size of the trees made from a point cloud");

  return line.run(argc, argv, [&] {
    const auto tree = std::make_shared<const Mesh>(wood::broadleaf({}, wood::Dice(line.seed, 1)));
    scan_tree(tree, line.output / "tree.xyz", line.threads);
    io::PointCloud cloud =
        io::read_point_cloud(line.output / "tree.xyz", {.voxel_size = voxel_size, .normals = io::VoxelNormals::fitted});

    const auto foliage = std::make_shared<const Foliage>(crown(), TransmissiveVoxels{LeafAngles::plagiophile()});
    const auto solid = std::make_shared<const Solid>(std::move(cloud.voxels));
    MeshData stem_data;
    wood::add_tube(stem_data, {{{0, 0, -0.5}, {0, 0, 6}, {0, 0, 14}}, {0.3, 0.22, 0.08}}, 12, wood::bark);
    const auto stem = std::make_shared<const Mesh>(std::move(stem_data));
    const auto all = material_table(wood::materials());
    const auto leaves = material_table({wood::materials()[wood::leaf]});
    const Forest forest = plant(line.seed, trees, 6 * std::sqrt(static_cast<double>(trees)),
                                {{{.geometry = tree, .materials = all}},
                                 {{.geometry = stem, .materials = all}, {.geometry = foliage, .materials = leaves}},
                                 {{.geometry = solid, .materials = leaves}}});

    const Vec3 size = forest.bounds().size();
    const double height = 220, half_angle = 20_deg, pulse_rate = 60_kHz;
    const auto strips = plan_block_flight({.area = forest.bounds(),
                                           .altitude = forest.bounds().max.z + height,
                                           .swath = 2 * height * std::tan(half_angle),
                                           .overlap = 0.1,
                                           .speed = 60});
    const auto airplane = [&](const StraightLine& strip) {
      const auto pulses = static_cast<PulseIndex>(strip.duration().seconds() * pulse_rate);
      const Scanner scanner{
          .pulse_rate = pulse_rate, .pulses = pulses, .laser = {.peak_power = 1000_W, .divergence = 0.5_mrad}};
      return Platform{strip, Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
                      Deflector{OscillatingMirror{.cycle_rate = 60_Hz, .half_angle = half_angle}, scanner}};
    };
    std::vector<decltype(airplane({}))> legs;
    for (const StraightLine& strip : strips) legs.push_back(airplane(strip));

    const Survey survey{Legs{legs}, LatticeFootprint{19}, forest, Receiver{}, FullWaveform{}, line.seed};
    io::LasWriter las(line.output / "cloud.las");
    io::ImageWriter image(line.output / "cloud.png",
                          {.azimuth = 30_deg, .elevation = 25_deg, .field_of_view = 20_deg, .point_size = 2});
    const RunSummary summary = run(survey, {.threads = line.threads, .progress = ProgressLine{}}, las, image);
    las.close();
    image.close();

    const auto mebibytes = [](std::size_t bytes) { return static_cast<double>(bytes) / 1024 / 1024; };
    std::cout << std::fixed << std::setprecision(1) << trees << " trees on " << std::round(size.x) << " m by "
              << std::round(size.y) << " m take " << mebibytes(forest.memory()) << " MiB: the mesh "
              << mebibytes(tree->memory()) << ", the foliage " << mebibytes(foliage->memory()) << ", the voxels of "
              << cloud.points << " points " << mebibytes(solid->memory()) << ".\nFlew " << strips.size()
              << " strips; the results are in " << line.output.string() << ".\n";
    print(summary);
  });
}
