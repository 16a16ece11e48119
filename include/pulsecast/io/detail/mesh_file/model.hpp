// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_MODEL_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_MODEL_HPP

#include <filesystem>
#include <optional>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/io/detail/material_pictures.hpp>
#include <pulsecast/io/detail/up_axis.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/scene/part.hpp>
#include <pulsecast/shape/mesh_data.hpp>

/// Settings and content of mesh files.
namespace PULSECAST_NAMESPACE::io {

/// Limits of an import in a child process. Memory and time grow with the files that are read.
struct ImportLimits {
  double memory = 1e9;          ///< of the import, beside `memory_per_byte` [byte]
  double memory_per_byte = 40;  ///< more for each byte of a file
  double time = 60;             ///< of the import, beside `time_per_byte` [s]
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
  /// Vertical axis; by default by the file: y in glTF and GLB, as named in DAE and FBX, z in others.
  std::optional<UpAxis> up = std::nullopt;
  std::optional<double> unit = std::nullopt;  ///< size of a unit; by default as named in DAE and FBX, 1 in others [m]
  /// MTL file whose materials replace those of the same names but for their colours, with spectra, classes and ground;
  /// empty: none.
  std::filesystem::path materials{};
  SpectralLibrary spectra{};           ///< spectra for `helios_spectra` in that file
  bool reflectance_of_colour = false;  ///< true: reflectance is the luminance of the base colour, in place of 0.5
  bool texture = false;                ///< true to read texture coordinates also if no material has a picture
  bool pictures = true;                ///< false: pictures are listed, but not read
  bool files_elsewhere = false;        ///< true: buffers and pictures may lie outside the file's folder
  /// True: assimp runs in a child process, whose death is a `FileError`. For untrusted files; OBJ files need none.
  bool isolated = false;
  ImportLimits limits{};  ///< of that process

  void validate() const {
    if (unit) require_within("MeshFileSettings::unit", *unit, 1e-9, 1e9, "m");
    limits.validate();
  }
};

/// Mesh of a file, in its own frame, with assimp's single precision: good to 6e-8 of the distance to the origin.
struct FileMesh {
  MeshData mesh{};                         ///< triangles with an area; texture coordinates if a material has a picture
  std::vector<std::uint32_t> materials{};  ///< by material of the mesh: its number in `MeshFile::materials`
};

/// Node of a file that shows a mesh.
struct MeshPlacement {
  std::size_t mesh = 0;   ///< number of the mesh
  Placement placement{};  ///< from the mesh to the world: z up, in metres
  std::string name{};     ///< names of the node and those above it, joined by `/`; else that of the mesh or file
};

/// Content of a mesh file.
struct MeshFile {
  std::vector<FileMesh> meshes{};            ///< each once, however many nodes show it
  std::vector<MeshPlacement> placements{};   ///< in order of the nodes, each before those below it
  std::vector<Material> materials{};         ///< materials, in order of first use
  std::vector<MaterialPictures> pictures{};  ///< pictures of the materials, one for each
  std::vector<std::string> warnings{};       ///< oddities that could still be read
  /// Further files that were looked for, those that are missing, too: buffers, pictures, materials.
  std::vector<std::filesystem::path> files{};

  /// Number of triangles, of all placements.
  [[nodiscard]] std::uint64_t triangle_count() const noexcept {
    std::uint64_t count = 0;
    for (const MeshPlacement& one : placements) count += meshes[one.mesh].mesh.triangles.size();
    return count;
  }
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
