// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_OBJ_HPP
#define PULSECAST_IO_OBJ_HPP

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/parallel.hpp>
#include <pulsecast/io/detail/material_pictures.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/shape/mesh_data.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings for OBJ files.
struct ObjSettings {
  UpAxis up = UpAxis::z;      ///< vertical axis of the file
  SpectralLibrary spectra{};  ///< spectra for `helios_spectra` in MTL files
  bool texture = false;       ///< true: texture coordinates also if no material has a picture
};

/// Content of an OBJ file, all objects and groups together.
struct ObjModel {
  MeshData mesh;                               ///< in units of the file, which should be metres
  std::vector<Material> materials;             ///< materials of triangles, in order of first use
  std::vector<MaterialPictures> pictures{};    ///< of each material, for `add_pictures`; or empty
  std::vector<std::string> warnings;           ///< oddities that could still be read
  std::vector<std::filesystem::path> files{};  ///< MTL files looked for, also missing ones
};

/// Reads an OBJ file and its MTL files. Polygons, also concave ones, are triangulated; triangles of
/// zero area are left out. Warns if none is left, or an MTL file is missing: its materials become
/// `undescribed`. Throws a `FileError` with path and line at the first error. Limits: faces refer
/// to vertices above them and have at most 4096 corners; coordinates are within 1e12.
[[nodiscard]] ObjModel read_obj(const std::filesystem::path& path, const ObjSettings& settings = {},
                                const Workers& workers = {});

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_OBJ)
#include <pulsecast/io/detail/obj/reader.hpp>
#endif

#endif
