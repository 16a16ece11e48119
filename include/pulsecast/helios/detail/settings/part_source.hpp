// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SETTINGS_PART_SOURCE_HPP
#define PULSECAST_HELIOS_DETAIL_SETTINGS_PART_SOURCE_HPP

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/helios/detail/settings/mount.hpp>

/// Sources of the geometry of parts: loading filters.
namespace PULSECAST_NAMESPACE::helios {

/// Materials of geometry files without any.
struct MaterialSource {
  std::filesystem::path file{};       ///< MTL file; empty: undescribed material. `matfile`
  std::optional<std::string> name{};  ///< default: first in alphabetical order; `matname`
  int random = 0;                     ///< number of variants; `randomMaterials`
  double random_range = 1;            ///< maximum colour difference of variants; `randomRange`

  void validate() const {
    detail::require_at_least(0, "randomMaterials", random);
    require_not_negative("randomRange", random_range, "");
  }

  bool operator==(const MaterialSource&) const = default;
};

/// Triangles: filter `objloader`.
struct ObjSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or matches of `efilepath`, by name
  bool y_up = false;                           ///< `up`

  bool operator==(const ObjSource&) const = default;
};

/// Elevation raster: filter `geotiffloader`.
struct GeoTiffSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, `efilepath`; `.asc` and `.png` tell other formats
  MaterialSource material{};                   ///< that of pixels without a class
  bool mosaic = false;                         ///< true: the files are tiles of one raster. `mosaic`
  std::filesystem::path classes{};             ///< raster of classes, which choose materials; empty: none. `classfile`
  bool class_colours = false;                  ///< true: its colour table colours the materials. `classcolours`
  std::optional<double> height_scale{};  ///< metres per unit of height; by default that of the file [m]. `heightScale`
  double height_offset = 0;              ///< added to the heights [m]. `heightOffset`
  std::optional<double> missing{};       ///< number of missing heights; by default that of the file. `noDataValue`
  std::optional<double> pixel_size{};    ///< of PNG files without a world file [m]. `pixelSize`

  void validate() const {
    material.validate();
    if (height_scale) require_within("GeoTiffSource::height_scale", *height_scale, 1e-9, 1e6, "m");
    require_within("GeoTiffSource::height_offset", height_offset, -1e9, 1e9, "m");
    if (pixel_size) require_within("GeoTiffSource::pixel_size", *pixel_size, 1e-6, 1e6, "m");
  }

  bool operator==(const GeoTiffSource&) const = default;
};

/// Point cloud, converted to voxels: filter `xyzloader`.
struct XyzSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or matches of `efilepath`, by name
  MaterialSource material{};
  std::string separator{};               ///< set of column separators, default detected; `separator`
  double voxel_size = 1;                 ///< edge length; `voxelSize` [m]
  std::optional<Vec3> default_normal{};  ///< non-zero, any length; `defaultNormal`
  int estimate_normals = 0;              ///< 0: from the file, else fitted to a plane in each voxel; `estimateNormals`
  bool snap_neighbor_normal = false;  ///< normal of the point nearest to the centre, not the mean; `snapNeighborNormal`
  std::array<int, 3> normal_columns{3, 4, 5};  ///< from 0; `normalXIndex`, Y and Z

  void validate() const {
    material.validate();
    detail::require_at_least(0, "estimateNormals", estimate_normals);
  }

  bool operator==(const XyzSource&) const = default;
};

/// Interaction of rays with voxels: `intersectionMode`.
enum class VoxelMode : std::uint8_t {
  transmittive,  ///< random transmission of rays
  fixed,         ///< opaque cubes
  scaled,        ///< opaque cubes, scaled by their content
};

/// Voxels with their content: filter `detailedvoxels`.
struct VoxelSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or matches of `efilepath`, by name
  MaterialSource material{};
  VoxelMode mode = VoxelMode::transmittive;  ///< `intersectionMode`
  double scaling_exponent = 0.5;             ///< scaled mode only; `intersectionArgument`
  bool random_shift = false;                 ///< scaled mode: random place of each cube in its cell; `randomShift`
  double leaf_area = 0;                      ///< 0: leaves without a size. `leafArea_m2` [m^2]
  double clumping = 1;                       ///< factor of the extinction. `clumping`
  std::filesystem::path leaf_angles{};       ///< look-up table; empty: none. `ladlut`

  void validate() const { material.validate(); }

  bool operator==(const VoxelSource&) const = default;
};

/// Vertical axis of a mesh file: `up`.
enum class MeshUp : std::uint8_t {
  file,  ///< by the file, see `io::read_mesh_file`
  z,     ///< z
  y,     ///< y
};

/// Mesh file: filter `meshloader`, of this library. Its nodes become parts.
struct MeshSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or matches of `efilepath`, by name
  MeshUp up = MeshUp::file;                    ///< `up`
  std::optional<double> unit{};                ///< size of a unit, default by the file; `unit` [m]
  std::filesystem::path materials{};  ///< MTL file whose materials replace those of the same names. `materials`

  void validate() const {
    if (unit) require_within("unit", *unit, 1e-9, 1e9, "m");
  }

  bool operator==(const MeshSource&) const = default;
};

/// Any source of geometry.
using PartSource = std::variant<ObjSource, GeoTiffSource, XyzSource, VoxelSource, MeshSource>;

namespace detail {

inline void validate_source(const PartSource& source) {
  std::visit([](const auto& one) { (void)validated(one); }, source);
}

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE::helios

#endif
