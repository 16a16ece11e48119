// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_GEOTIFF_HPP
#define PULSECAST_IO_GEOTIFF_HPP

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings for GeoTIFF files.
struct GeoTiffSettings {
  std::uint16_t band = 1;  ///< band of the heights, from 1
  /// Metres per unit of the numbers; by default unit, scale and offset of the file: of its keys, vertical system and
  /// GDAL's metadata.
  std::optional<double> vertical_scale = std::nullopt;
  std::optional<double> missing = std::nullopt;  ///< value of missing heights; by default from the file (GDAL_NODATA)
  bool packed = false;  ///< whole numbers of 8 and 16 bits as `Raster::packed`, if it can hold them

  void validate() const {
    require_within("GeoTiffSettings::band", band, 1, 65535, "");
    if (vertical_scale) require_positive("GeoTiffSettings::vertical_scale", *vertical_scale, "m");
  }
};

/// Content of a GeoTIFF file.
struct GeoTiff {
  Raster raster;                        ///< heights [m]
  std::optional<std::uint16_t> epsg{};  ///< code of the projected reference system, if any
  std::vector<Vec3> colours{};  ///< colour table (sRGB, channels from 0 to 1) by the value of a pixel; empty without
  std::vector<std::string> warnings{};  ///< oddities that could still be read
};

/// Reads a raster of heights in a projected reference system in metres: the first image of a TIFF file, classic or
/// BigTIFF, of either byte order, in strips or tiles, of integers of 8 to 64 bits or floating-point numbers of 16 to
/// 64, with any compression of libtiff. Heights become `float`. NaN, values not within 1e15 m, and the value for
/// missing ones become NaN. If `packed` is set, whole numbers of 8 and 16 bits stay so, and give the same heights; but
/// not where tiles are left out of 16 bits without a value for missing heights. Throws a `FileError`, with the byte if
/// known, for a raster that is incomplete, rotated, sheared, in degrees, in feet but for its heights, of depths, or
/// without a place by tags or a world file. Masks and alpha bands are not applied, with a warning. Memory is the raster
/// and one strip or row of tiles, as far as read, not as claimed by the header. A picture with a colour table, such as
/// a map of land cover, is a raster of the numbers in the table. Source: TIFF 6.0; OGC GeoTIFF 1.1 (19-008r4); for
/// GDAL_NODATA and tiles that are left out, the GDAL manual, GTiff driver.
[[nodiscard]] GeoTiff read_geotiff(const std::filesystem::path& path, const GeoTiffSettings& settings = {});

/// EPSG code of the projected reference system of a file, if any; reads no heights. Throws as `read_geotiff`.
[[nodiscard]] std::optional<std::uint16_t> read_geotiff_epsg(const std::filesystem::path& path);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINITIONS
#include <pulsecast/io/detail/geotiff/reader.hpp>
#endif

#endif
