// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_GEOREFERENCE_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_GEOREFERENCE_HPP

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include <tiffio.h>

#include <pulsecast/io/detail/geotiff/raster_layout.hpp>
#include <pulsecast/io/detail/geotiff/tiff_file.hpp>
#include <pulsecast/io/detail/las/reference.hpp>
#include <pulsecast/io/world_file.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Tags and keys by number. Source: OGC GeoTIFF 1.1, annex B and 7.1; GDAL manual.
namespace geotiff {
inline constexpr ttag_t pixel_scale = 33550, tie_points = 33922, transformation = 34264, key_directory = 34735,
                        metadata = 42112, nodata = 42113;
enum Key : std::uint16_t {
  model_type = 1024,
  raster_type = 1025,
  projected = 3072,
  linear_unit = 3076,
  vertical = 4096,
  vertical_unit = 4099
};
inline constexpr std::uint16_t user_defined = 32767;
inline constexpr std::uint16_t metre = 9001, foot = 9002, us_foot = 9003;  ///< EPSG codes of units
}  // namespace geotiff

/// Value of a key. Source: OGC GeoTIFF 1.1, 7.1.2 (requirements class GeoKeyDirectory).
[[nodiscard]] inline std::uint16_t geo_key(const TiffFile& file, geotiff::Key wanted, std::uint16_t otherwise) {
  const auto keys = file.tags<std::uint16_t>(geotiff::key_directory);
  for (std::size_t i = 4; i + 4 <= keys.size() && i / 4 <= keys[3]; i += 4)
    if (keys[i] == wanted && keys[i + 1] == 0) return keys[i + 3];
  return otherwise;
}

/// EPSG code of the projected reference system, if any. Throws a `FileError` for another system, or in feet.
[[nodiscard]] inline std::optional<std::uint16_t> projected_epsg(TiffFile& file) {
  const std::uint16_t model = geo_key(file, geotiff::model_type, 1), given = geo_key(file, geotiff::linear_unit, 0);
  const std::uint16_t unit = given == 0 ? geotiff::metre : given;
  if (model == 2) file.fail("is in degrees (a geographic reference system): expected a projected one, in metres");
  if (model == 3) file.fail("is in a geocentric reference system: expected a projected one, in metres");
  if (unit == geotiff::foot || unit == geotiff::us_foot) file.fail("has coordinates in feet: expected metres");
  if (unit != geotiff::metre)
    file.warn("the unit of its coordinates has the code " + std::to_string(unit) + "; metres are assumed");
  const std::uint16_t projected = geo_key(file, geotiff::projected, 0);
  if (given == 0 && projected != 0 && las_utm(projected).empty())
    file.warn("does not tell the unit of its coordinates, in the projected system " + std::to_string(projected) +
              "; metres are assumed");
  return projected != 0 && projected != geotiff::user_defined ? std::optional(projected) : std::nullopt;
}

/// True if a tie is the centre of a pixel. Source: OGC GeoTIFF 1.1, 7.1.3 (PixelIsArea, PixelIsPoint).
[[nodiscard]] inline bool is_point(const TiffFile& file) { return geo_key(file, geotiff::raster_type, 1) == 2; }

/// Corner of the first pixel of a file, and the steps of a column to the east and of a row to the north [m].
struct RasterCorner {
  double x = 0, y = 0, step_x = 0, step_y = 0;
};

/// Position of the pixels of a file, by its tags or by a world file. Throws a `FileError` without a georeference, and
/// for rows that do not go east. Source: OGC GeoTIFF 1.1, 7.1.1 (raster to model).
[[nodiscard]] inline RasterCorner raster_corner(TiffFile& file, const RasterLayout& layout) {
  const auto scale = file.tags<double>(geotiff::pixel_scale), ties = file.tags<double>(geotiff::tie_points),
             matrix = file.tags<double>(geotiff::transformation);
  if (matrix.size() >= 16) {
    const double turn = std::max(std::fabs(matrix[1]) * layout.rows, std::fabs(matrix[4]) * layout.columns);
    if (!(turn <= 1e-3 * std::min(std::fabs(matrix[0]), std::fabs(matrix[5]))))  // in pixels, over the whole raster
      file.fail("is rotated or sheared: expected rows to the east; resampling to north up makes them so");
    if ((matrix[10] != 0 && matrix[10] != 1) || matrix[11] != 0)
      file.warn("the vertical scale and shift of ModelTransformation are ignored; vertical_scale is a setting");
    return {.x = matrix[3], .y = matrix[7], .step_x = matrix[0], .step_y = matrix[5]};
  }
  if (scale.size() >= 2 && ties.size() >= 6) {
    if (scale[1] < 0)
      file.warn("ModelPixelScale has a negative height of the pixel; its magnitude is taken, as GDAL does");
    if (scale[0] < 0) file.fail("has pixels of a negative width: expected a positive one");
    if ((scale.size() >= 3 && scale[2] != 0 && scale[2] != 1) || ties[2] != 0 || ties[5] != 0)
      file.warn(
          "the vertical scale of ModelPixelScale, and the height of ModelTiepoint, are ignored; vertical_scale is a "
          "setting");
    const double step_x = scale[0], step_y = -std::fabs(scale[1]);
    return {.x = ties[3] - ties[0] * step_x, .y = ties[4] - ties[1] * step_y, .step_x = step_x, .step_y = step_y};
  }
  if (const std::filesystem::path beside = world_file_of(file.path()); ties.empty() && !beside.empty()) {
    const WorldFile world = read_world_file(beside);
    const double to_corner = is_point(file) ? 0 : 0.5;
    return {.x = world.first.x - to_corner * world.step.x,
            .y = world.first.y - to_corner * world.step.y,
            .step_x = world.step.x,
            .step_y = world.step.y};
  }
  if (ties.size() > 6)
    file.fail("is placed by control points: expected rows to the east (ModelPixelScale and ModelTiepoint)");
  file.fail("has no georeference: expected ModelPixelScale and ModelTiepoint, ModelTransformation, or a world file");
}

/// Raster without heights, with the columns of a file from the west and its rows from the north. Throws as
/// `raster_corner`, and for pixels out of bounds.
[[nodiscard]] inline Raster placed_raster(const TiffFile& file, const RasterLayout& layout,
                                          const RasterCorner& corner) {
  const double to_centre = is_point(file) ? 0 : 0.5;
  const double column = corner.step_x < 0 ? layout.columns - 1.0 : 0, row = corner.step_y > 0 ? layout.rows - 1.0 : 0;
  Raster raster{
      .columns = layout.columns,
      .rows = layout.rows,
      .first = {corner.x + (column + to_centre) * corner.step_x, corner.y + (row + to_centre) * corner.step_y},
      .pixel = {std::fabs(corner.step_x), std::fabs(corner.step_y)}};
  const auto sound = [](double first, double pixel) {
    return std::fabs(first) <= 1e15 && pixel >= 1e-9 && pixel <= 1e6;
  };
  if (!sound(raster.first.x, raster.pixel.x) || !sound(raster.first.y, raster.pixel.y))
    file.fail(
        "has its first pixel or the size of pixels out of bounds: expected within 1e15 m, and from 1e-9 m to 1e6 m");
  return raster;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
