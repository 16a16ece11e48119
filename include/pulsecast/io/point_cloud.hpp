// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_POINT_CLOUD_HPP
#define PULSECAST_IO_POINT_CLOUD_HPP

#include <filesystem>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/detail/text/text_point_columns.hpp>
#include <pulsecast/shape/voxel_data.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Source of the normals of voxels.
enum class VoxelNormals : std::uint8_t {
  none,     ///< no normals
  mean,     ///< mean of the unit normals of the points inside, from the file
  nearest,  ///< normal of the point nearest to the voxel's centre, of those that have one
  fitted,   ///< normal of the least-squares plane through the points inside; points up
};

/// Position of the lattice of voxels.
enum class VoxelLattice : std::uint8_t {
  at_cloud,      ///< begins at the minimum coordinates; centred along an axis without extent
  at_multiples,  ///< faces at integer multiples of the voxel size, the same for adjacent clouds
};

/// Settings for voxels of a point cloud.
struct PointCloudSettings {
  double voxel_size = 1;                          ///< edge of a voxel [m]
  VoxelLattice lattice = VoxelLattice::at_cloud;  ///< position of the lattice
  VoxelNormals normals = VoxelNormals::none;      ///< source of the normals
  std::optional<Vec3> default_normal{};           ///< for voxels without, of any length but 0
  bool colours = false;                           ///< true to give voxels colours
  std::optional<double> colour_max{};             ///< default: 65535 in LAS, of the type in PLY, else 255
  bool classes = false;                           ///< true to give voxels classes, if all files have them
  bool objects = false;                           ///< true to give voxels objects, if all files have them
  TextPointColumns columns = {};                  ///< columns of text files

  void validate() const {
    require_positive("PointCloudSettings::voxel_size", voxel_size, "m");
    require_within("PointCloudSettings::voxel_size", voxel_size, 0, 1e12, "m");
    const Vec3 normal = default_normal.value_or(Vec3{1, 0, 0});
    if (!is_within(normal, 1e100) || !(max_norm(normal) >= 1e-100))
      throw SettingError("PointCloudSettings::default_normal length", length(normal), "", "from 1e-100 to 1e100");
    if (colour_max) require_positive("PointCloudSettings::colour_max", *colour_max, "");
    columns.validate();
  }
};

/// Voxels occupied by the points of a cloud.
struct PointCloud {
  VoxelData voxels;                             ///< with normals, if requested and available
  std::vector<std::array<float, 3>> colours{};  ///< of voxels, from 0 to 1, root mean square
  std::uint64_t points = 0;                     ///< number of points read
  std::vector<std::string> warnings{};          ///< oddities that could still be read
  std::vector<std::uint32_t> classes{};         ///< of voxels: the most frequent, or the lowest of these
  std::vector<std::uint32_t> objects{};         ///< of voxels, as classes
};

/// Reads point clouds, text (`TextPoints`), PTX (`PtxPoints`), PLY (`PlyPoints`), or LAS, LAZ and COPC
/// (`LasPoints`), as detected, into one grid of voxels. Files are read twice, for the extent and for the voxels: memory
/// is that of the voxels.
///
/// A voxel includes its lower faces and excludes its upper ones, but for the last ones of
/// `at_cloud`. Plane fits need three points not on one line. A voxel without a normal gets the
/// default, or zero with a warning. Colours above the maximum are an error. Throws a `FileError`
/// with path and line or byte at the first error. Limits: 2^32 voxels an axis, 2^32 - 2 occupied.
[[nodiscard]] PointCloud read_point_cloud(const std::vector<std::filesystem::path>& paths,
                                          const PointCloudSettings& settings = {});

/// Reads a single point cloud.
[[nodiscard]] inline PointCloud read_point_cloud(const std::filesystem::path& path,
                                                 const PointCloudSettings& settings = {}) {
  return read_point_cloud(std::vector{path}, settings);
}

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_POINT_CLOUD)
#include <pulsecast/io/detail/point_cloud_reader.hpp>
#endif

#endif
