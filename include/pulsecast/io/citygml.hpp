// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_CITYGML_HPP
#define PULSECAST_IO_CITYGML_HPP

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/io/detail/material_pictures.hpp>
#include <pulsecast/io/mesh_file.hpp>

/// City models of CityGML 1 and 2 files, by libcitygml.
namespace PULSECAST_NAMESPACE::io {

/// Settings for CityGML files.
struct CityGmlSettings {
  unsigned max_lod = 4;               ///< of the levels of detail up to it, an object's highest is read
  bool interior = false;              ///< true: rooms, their surfaces and furniture, too
  std::filesystem::path materials{};  ///< MTL file that replaces materials by name; or none
  SpectralLibrary spectra{};          ///< spectra for `helios_spectra` in that file
  bool isolated = false;              ///< true: in a child process; for untrusted files
  ImportLimits limits{};              ///< of that process

  void validate() const {
    require_within("CityGmlSettings::max_lod", max_lod, 0, 4, "");
    limits.validate();
  }
};

/// Content of a CityGML file.
struct CityGml {
  /// A placement for each city object with surfaces, named by its gml:id, with its origin near it.
  /// Materials are named by classes of CityGML, and have ASPRS classes: 2 for relief, land use and
  /// ground, 5 for vegetation, 6 for buildings, 9 for water, 10 for railways, 11 for roads, tracks
  /// and squares, 17 for bridges, 0 for others. Implicit geometries are shared.
  MeshFile file;
  std::optional<std::uint16_t> epsg{};  ///< code of the reference system of coordinates, if any
};

/// Reads the surfaces of a CityGML file, in metres, without closure surfaces and textures. Source:
/// OGC City Geography Markup Language 2.0 (12-019); LAS 1.4 R15, table 17. @throws SettingError
/// @throws FileError for a missing or damaged file, coordinates in degrees or a document type
[[nodiscard]] CityGml read_citygml(const std::filesystem::path& path, const CityGmlSettings& settings = {},
                                   const Workers& workers = {});

/// True for a name that ends in `.gml` or `.citygml`.
[[nodiscard]] bool is_citygml(const std::filesystem::path& path);

}  // namespace PULSECAST_NAMESPACE::io

#include <pulsecast/io/detail/citygml_reader.hpp>

#endif
