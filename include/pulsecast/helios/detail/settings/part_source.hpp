// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SETTINGS_PART_SOURCE_HPP
#define PULSECAST_HELIOS_DETAIL_SETTINGS_PART_SOURCE_HPP

#include <variant>

#include <pulsecast/helios/detail/settings/fields.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Materials of geometry files without any.
struct MaterialSource {
  std::filesystem::path file{};       ///< MTL file; empty: undescribed material. `matfile`
  std::optional<std::string> name{};  ///< default: first in alphabetical order; `matname`
  int random = 0;                     ///< number of variants; `randomMaterials`
  double random_range = 1;            ///< maximum colour difference of variants; `randomRange`

  void fields(FieldIo& io) {
    io.file("matfile", file);
    io.text("matname", name);
    io.whole("randomMaterials", random, 0, 1'000'000);
    io.number("randomRange", random_range, units::one, 0, 1e6);
  }
  bool operator==(const MaterialSource&) const = default;
};

/// Triangles: filter `objloader`.
struct ObjSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or matches of `efilepath`, by name
  bool y_up = false;                           ///< `up`

  void fields(FieldIo& io) {
    io.choice("up", y_up, {{"z", false}, {"y", true}});
    io.without_effect({"recomputeVertexNormals"});
  }
  bool operator==(const ObjSource&) const = default;
};

/// Elevation raster: filter `geotiffloader`.
struct GeoTiffSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, `efilepath`; also `.asc`, `.png`
  MaterialSource material{};                   ///< that of pixels without a class
  bool mosaic = false;                         ///< the files are tiles of one raster; `mosaic`
  std::filesystem::path classes{};             ///< raster of classes, for materials; `classfile`
  bool class_colours = false;                  ///< coloured by its colour table; `classcolours`
  std::optional<double> height_scale{};        ///< height unit, default: the file's; `heightScale` [m]
  double height_offset = 0;                    ///< added to the heights; `heightOffset` [m]
  std::optional<double> missing{};             ///< no-data height, default: the file's; `noDataValue`
  std::optional<double> pixel_size{};          ///< of PNG without world file; `pixelSize` [m]

  void fields(FieldIo& io) {
    material.fields(io);
    io.flag("mosaic", mosaic);
    io.file("classfile", classes);
    io.flag("classcolours", class_colours);
    io.number("heightScale", height_scale, units::metre, 1e-9, 1e6);
    io.number("heightOffset", height_offset, units::metre, -1e9, 1e9);
    io.number("noDataValue", missing, units::one, -1e300, 1e300);
    io.number("pixelSize", pixel_size, units::metre, 1e-6, 1e6);
  }
  bool operator==(const GeoTiffSource&) const = default;
};

/// Point cloud, converted to voxels: filter `xyzloader`.
struct XyzSource {
  std::vector<std::filesystem::path> files{};  ///< `filepath`, or matches of `efilepath`, by name
  MaterialSource material{};
  std::string separator{};                     ///< of columns, default detected; `separator`
  double voxel_size = 1;                       ///< edge length; `voxelSize` [m]
  std::optional<Vec3> default_normal{};        ///< non-zero, any length; `defaultNormal`
  int estimate_normals = 0;                    ///< 0: from the file, else fitted; `estimateNormals`
  bool snap_neighbor_normal = false;           ///< of the most central point; `snapNeighborNormal`
  std::array<int, 3> normal_columns{3, 4, 5};  ///< from 0; `normalXIndex`, Y and Z

  void fields(FieldIo& io) {
    material.fields(io);
    io.text("separator", separator);
    io.require({"voxelSize"});
    io.number("voxelSize", voxel_size, units::metre, 0, 1e6);
    io.vector("defaultNormal", default_normal, 1e6);
    io.whole("estimateNormals", estimate_normals, 0, 1'000'000);
    io.flag("snapNeighborNormal", snap_neighbor_normal);
    static constexpr std::array normals{"normalXIndex", "normalYIndex", "normalZIndex"};
    for (std::size_t i = 0; i < 3; ++i) io.whole(normals[i], normal_columns[i], 0, 999);
    io.without_effect({"rgbRIndex", "rgbGIndex", "rgbBIndex", "maxColorValue"}, "has no effect: voxels have no colour");
    io.without_effect({"sparse"});
    if (!io.reads()) return;
    if (voxel_size == 0) {
      voxel_size = 1;
      io.warn("voxelSize", "voxelSize of 0 means 1 m");
    }
    if (default_normal == Vec3{}) {
      default_normal.reset();
      io.warn("defaultNormal", "defaultNormal is zero: it has no direction, and no effect");
    }
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
  bool random_shift = false;                 ///< scaled mode: cubes at random places; `randomShift`
  double leaf_area = 0;                      ///< 0: leaves without a size. `leafArea_m2` [m^2]
  double clumping = 1;                       ///< factor of the extinction. `clumping`
  std::filesystem::path leaf_angles{};       ///< look-up table; empty: none. `ladlut`

  void fields(FieldIo& io) {
    material.fields(io);
    io.choice("intersectionMode", mode,
              {{"transmittive", VoxelMode::transmittive}, {"fixed", VoxelMode::fixed}, {"scaled", VoxelMode::scaled}});
    io.number("intersectionArgument", scaling_exponent, units::one, 0, 100);
    io.flag("randomShift", random_shift);
    io.file("ladlut", leaf_angles);
    io.number("leafArea_m2", leaf_area, units::square_metre, 0, 100);
    io.number("clumping", clumping, units::one, 0.01, 10);
  }
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
  std::filesystem::path materials{};           ///< MTL file for materials by name; `materials`

  void fields(FieldIo& io) {
    io.choice("up", up, {{"file", MeshUp::file}, {"z", MeshUp::z}, {"y", MeshUp::y}});
    io.number("unit", unit, units::metre, 1e-9, 1e9);
    io.file("materials", materials);
  }
  bool operator==(const MeshSource&) const = default;
};

/// Any source of geometry.
using PartSource = std::variant<ObjSource, GeoTiffSource, XyzSource, VoxelSource, MeshSource>;

}  // namespace PULSECAST_NAMESPACE::helios

#endif
