// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/ply/points.hpp>

#include <pulsecast/io/mesh_file.hpp>
#include <pulsecast/io/point_cloud.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

FUZZ_TARGET(ply) {
  const std::filesystem::path path = fuzz::file(data, size, "a.ply");
  fuzz::may_refuse([&] {
    InputFile file(path, "a mesh");
    if (!io::detail::PlyFile::is_ply(file)) return;
    for (const FileMesh& one : read_mesh_file(path, {.texture = true, .pictures = false}).meshes) one.mesh.validate();
  });
  fuzz::may_refuse([&] {
    PlyPoints points(InputFile(path, "a point cloud"));
    std::size_t count = 0;
    for (; points.next(); ++count) {
      fuzz::expect(finite(points.position()));
      if (points.has_normals()) fuzz::expect(finite(points.normal()));
      if (points.has_class()) (void)points.classification();
      if (points.has_object()) (void)points.object();
    }
    fuzz::expect(count <= size);
  });
  fuzz::may_refuse([&] {
    const PointCloud cloud = read_point_cloud(path, {.normals = VoxelNormals::mean, .colours = true});
    cloud.voxels.validate();
    fuzz::expect(cloud.points <= size);
  });
}
