// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/point_cloud.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(point_cloud) {
  const std::filesystem::path path = fuzz::file(data, size, "cloud");
  for (const PointCloudSettings& settings :
       {PointCloudSettings{.normals = VoxelNormals::fitted},
        PointCloudSettings{.voxel_size = 0.25,
        .lattice = VoxelLattice::at_multiples,
        .normals = VoxelNormals::mean,
        .default_normal = axis::up,
        .colours = true,
        .classes = true,
        .objects = true},
        PointCloudSettings{.voxel_size = 1e-6, .normals = VoxelNormals::nearest, .colours = true}})
    fuzz::may_refuse([&] {
      const PointCloud cloud = read_point_cloud(path, settings);
      const VoxelData& voxels = cloud.voxels;
      voxels.validate();
      fuzz::expect(voxels.cells.size() <= cloud.points);
      fuzz::expect(cloud.classes.empty() || cloud.classes.size() == voxels.cells.size());
      fuzz::expect(cloud.colours.empty() || cloud.colours.size() == voxels.cells.size());
      for (const auto& channels : cloud.colours)
        for (const float channel : channels) fuzz::expect(channel >= 0 && channel <= 1.000001F);
    });
}
