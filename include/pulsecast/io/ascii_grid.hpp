// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_ASCII_GRID_HPP
#define PULSECAST_IO_ASCII_GRID_HPP

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings for Esri ASCII grids.
struct AsciiGridSettings {
  double vertical_scale = 1;  ///< metres per unit of height [m]
  std::optional<double>
      missing{};  ///< value of missing heights, in the file's unit; by default from the file (NODATA_value), or -9999

  void validate() const { require_positive("AsciiGridSettings::vertical_scale", vertical_scale, "m"); }
};

/// Content of an Esri ASCII grid.
struct AsciiGrid {
  Raster raster;                        ///< heights [m]
  std::vector<std::string> warnings{};  ///< oddities that could still be read
};

/// Reads an Esri ASCII grid, a raster of heights as text, whose coordinates are in metres; the file has no reference
/// system. Keywords of any case and order come first: `ncols`, `nrows`, `xllcorner` or `xllcenter`, `yllcorner` or
/// `yllcenter`, `cellsize` or `dx` and `dy`, and perhaps `NODATA_value`. Heights follow row by row from the north; line
/// ends count as blanks. NaN, values not within 1e15 m, and the value for missing ones become NaN. Memory is the
/// raster, whose size the size of the file bounds. @throws SettingError for settings out of range @throws FileError
/// with the line if known, for a keyword that is unknown, repeated or missing, and for too few, too many or no heights
/// Source: Esri, ArcGIS documentation, "Esri ASCII raster format"; for `dx` and `dy`, the GDAL manual, AAIGrid driver.
[[nodiscard]] AsciiGrid read_ascii_grid(const std::filesystem::path& path, const AsciiGridSettings& settings = {});

/// True for the extension `.asc`, in any case.
[[nodiscard]] inline bool is_ascii_grid(const std::filesystem::path& path) {
  return text::is_same_word(path.extension().string(), ".asc");
}

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINITIONS
#include <pulsecast/io/detail/ascii_grid_reader.hpp>
#endif

#endif
