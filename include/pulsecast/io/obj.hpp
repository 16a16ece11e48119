// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_OBJ_HPP
#define PULSECAST_IO_OBJ_HPP

#include <filesystem>
#include <string>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/parallel.hpp>
#include <pulsecast/io/detail/material_pictures.hpp>
#include <pulsecast/io/detail/up_axis.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/shape/mesh_data.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings for OBJ files.
struct ObjSettings {
  UpAxis up = UpAxis::z;      ///< vertical axis of the file
  SpectralLibrary spectra{};  ///< spectra for `helios_spectra` in MTL files
  bool texture = false;       ///< true to read texture coordinates also if no material has a picture
};

/// Content of an OBJ file, all objects and groups together.
struct ObjModel {
  MeshData mesh;                    ///< in units of the file, which should be metres; without triangles of zero area
  std::vector<Material> materials;  ///< materials of triangles, in order of first use
  std::vector<MaterialPictures> pictures{};    ///< of each material, not read: see `add_pictures`; or empty
  std::vector<std::string> warnings;           ///< oddities that could still be read
  std::vector<std::filesystem::path> files{};  ///< MTL files that were looked for, those that are missing, too
};

/// Reads an OBJ file and its MTL files. Polygons, also concave ones, are triangulated. Warns if no face has an area, or
/// an MTL file is missing; its materials become `undescribed`. Holds some megabytes at most. Throws a `FileError` with
/// path and line at the first error. Limits: faces refer to vertices above them and have at most 4096 corners;
/// coordinates stay within 1e12, where a double resolves 0.1 mm, and are accurate to some units in the last place.
[[nodiscard]] ObjModel read_obj(const std::filesystem::path& path, const ObjSettings& settings = {},
                                const Workers& workers = {});

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_OBJ)
#include <pulsecast/io/detail/obj/reader.hpp>
#endif

#endif
