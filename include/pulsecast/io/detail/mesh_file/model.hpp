// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_MODEL_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_MODEL_HPP

#include <pulsecast/io/detail/material_pictures.hpp>
#include <pulsecast/scene/part.hpp>
#include <pulsecast/shape/mesh_data.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Limits of an import in a child process. Memory and time grow with the files that are read.
struct ImportLimits {
  double memory = 1e9;          ///< memory, beside `memory_per_byte` [byte]
  double memory_per_byte = 40;  ///< more for each byte of a file
  double time = 60;             ///< time, beside `time_per_byte` [s]
  double time_per_byte = 2e-6;  ///< more for each byte of the file [s]

  void validate() const {
    require_within("ImportLimits::memory", memory, 1e6, 1e15, "byte");
    require_within("ImportLimits::memory_per_byte", memory_per_byte, 0, 1e6, "");
    require_within("ImportLimits::time", time, 0.01, 1e7, "s");
    require_within("ImportLimits::time_per_byte", time_per_byte, 0, 1, "s");
  }
};

/// Settings for mesh files.
struct MeshFileSettings {
  /// Vertical axis; default: y in glTF and GLB, as named in DAE and FBX, z in others.
  std::optional<UpAxis> up = std::nullopt;
  std::optional<double> unit{};        ///< size of a unit; default: as in DAE and FBX, else 1 [m]
  std::filesystem::path materials{};   ///< MTL file that replaces all but colours; or none
  SpectralLibrary spectra{};           ///< spectra for `helios_spectra` in that file
  bool reflectance_of_colour = false;  ///< true: reflectance by luminance, not 0.5
  bool texture = false;                ///< true: texture coordinates also without pictures
  bool pictures = true;                ///< false: pictures are listed, but not read
  bool files_elsewhere = false;        ///< true: also files outside the folder
  bool isolated = false;               ///< true: in a child process; for untrusted files
  ImportLimits limits{};               ///< of that process

  void validate() const {
    if (unit) require_within("MeshFileSettings::unit", *unit, 1e-9, 1e9, "m");
    limits.validate();
  }
};

/// Mesh of a file, in its own frame, in single precision: to 6e-8 of the distance to the origin.
struct FileMesh {
  MeshData mesh{};                         ///< triangles with an area
  std::vector<std::uint32_t> materials{};  ///< of the mesh: numbers in `MeshFile::materials`
};

/// Node of a file that shows a mesh.
struct MeshPlacement {
  std::size_t mesh = 0;   ///< number of the mesh
  Placement placement{};  ///< from the mesh to the world: z up, in metres
  std::string name{};     ///< of the node and those above it, joined by `/`; or of mesh or file
};

/// Content of a mesh file.
struct MeshFile {
  std::vector<FileMesh> meshes{};              ///< each once, however many nodes show it
  std::vector<MeshPlacement> placements{};     ///< by node, each before those below it
  std::vector<Material> materials{};           ///< materials, in order of first use
  std::vector<MaterialPictures> pictures{};    ///< pictures of the materials, one for each
  std::vector<std::string> warnings{};         ///< oddities that could still be read
  std::vector<std::filesystem::path> files{};  ///< other files that were looked for

  /// Number of triangles, of all placements.
  [[nodiscard]] std::uint64_t triangle_count() const noexcept {
    std::uint64_t count = 0;
    for (const MeshPlacement& one : placements) count += meshes[one.mesh].mesh.triangles.size();
    return count;
  }
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
