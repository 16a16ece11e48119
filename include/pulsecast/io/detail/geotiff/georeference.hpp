// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_GEOREFERENCE_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_GEOREFERENCE_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include <tiffio.h>

#include <pulsecast/io/detail/geotiff/raster_layout.hpp>
#include <pulsecast/io/detail/las/reference.hpp>
#include <pulsecast/io/world_file.hpp>
#include <pulsecast/shape/raster.hpp>

/// Place and heights of the pixels of a GeoTIFF by its tags.
namespace PULSECAST_NAMESPACE::io::detail {

/// Tags and keys by number. Source: OGC GeoTIFF 1.1, annex B and 7.1; GDAL manual.
namespace geotiff {
inline constexpr ttag_t pixel_scale = 33550, tie_points = 33922, transformation = 34264, key_directory = 34735,
                        metadata = 42112, nodata = 42113;
inline constexpr std::uint16_t model_type = 1024, raster_type = 1025, projected = 3072, linear_unit = 3076,
                               vertical = 4096, vertical_unit = 4099;
inline constexpr std::uint16_t user_defined = 32767;
inline constexpr std::uint16_t metre = 9001, foot = 9002, us_foot = 9003;  ///< EPSG codes of units
}  // namespace geotiff

/// Value of a key. Source: OGC GeoTIFF 1.1, 7.1.2 (requirements class GeoKeyDirectory).
[[nodiscard]] inline std::uint16_t geo_key(const TiffFile& file, std::uint16_t wanted, std::uint16_t otherwise) {
  const auto keys = file.tags<std::uint16_t>(geotiff::key_directory);
  for (std::size_t i = 4; i + 4 <= keys.size() && i / 4 <= keys[3]; i += 4)
    if (keys[i] == wanted && keys[i + 1] == 0) return keys[i + 3];
  return otherwise;
}

/// EPSG code of the projected reference system, if any. @throws FileError for others, and feet
[[nodiscard]] inline std::optional<std::uint16_t> projected_epsg(TiffFile& file) {
  const std::uint16_t model = geo_key(file, geotiff::model_type, 1);
  const std::uint16_t given = geo_key(file, geotiff::linear_unit, 0);
  const std::uint16_t unit = given == 0 ? geotiff::metre : given;
  if (model == 2) file.fail("is in degrees (a geographic reference system): expected a projected one, in metres");
  if (model == 3) file.fail("is in a geocentric reference system: expected a projected one, in metres");
  if (unit == geotiff::foot || unit == geotiff::us_foot) file.fail("has coordinates in feet: expected metres");
  if (unit != geotiff::metre) file.warn("the unit of its coordinates has the code ", unit, "; metres are assumed");
  const std::uint16_t projected = geo_key(file, geotiff::projected, 0);
  if (given == 0 && projected != 0 && las_utm(projected).empty())
    file.warn("does not tell the unit of its coordinates, in the projected system ", projected, "; metres are assumed");
  return projected != 0 && projected != geotiff::user_defined ? std::optional(projected) : std::nullopt;
}

/// True if a tie is the centre of a pixel. Source: OGC GeoTIFF 1.1, 7.1.3 (PixelIsPoint).
[[nodiscard]] inline bool is_point(const TiffFile& file) { return geo_key(file, geotiff::raster_type, 1) == 2; }

/// Corner of the first pixel of a file, and steps of columns to the east and rows to the north [m].
struct RasterCorner {
  double x = 0, y = 0, step_x = 0, step_y = 0;
};

/// Position of the pixels of a file, by its tags or a world file. Source: OGC GeoTIFF 1.1, 7.1.1.
/// @throws FileError without a georeference, and for rows that do not go east
[[nodiscard]] inline RasterCorner raster_corner(TiffFile& file, const RasterLayout& layout) {
  const auto scale = file.tags<double>(geotiff::pixel_scale), ties = file.tags<double>(geotiff::tie_points),
             matrix = file.tags<double>(geotiff::transformation);
  if (matrix.size() >= 16) {
    const double turn = std::max(std::fabs(matrix[1]) * layout.rows, std::fabs(matrix[4]) * layout.columns);
    if (!(turn <= 1e-3 * std::min(std::fabs(matrix[0]), std::fabs(matrix[5]))))  // over the whole raster
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
          "the vertical scale of ModelPixelScale, and the height of ModelTiepoint, are ignored; "
          "vertical_scale is a setting");
    const double step_x = scale[0], step_y = -std::fabs(scale[1]);
    return {.x = ties[3] - ties[0] * step_x, .y = ties[4] - ties[1] * step_y, .step_x = step_x, .step_y = step_y};
  }
  if (const std::filesystem::path beside = world_file_of(file.path()); ties.empty() && !beside.empty()) {
    const auto& [first, step] = read_world_file(beside);
    const Vec2 corner = first - (is_point(file) ? 0 : 0.5) * step;
    return {.x = corner.x, .y = corner.y, .step_x = step.x, .step_y = step.y};
  }
  if (ties.size() > 6)
    file.fail("is placed by control points: expected rows to the east (ModelPixelScale and ModelTiepoint)");
  file.fail("has no georeference: expected ModelPixelScale and ModelTiepoint, ModelTransformation, or a world file");
}

/// Raster without heights, its columns from the west and rows from the north. @throws FileError for
/// pixels out of bounds
[[nodiscard]] inline Raster placed_raster(const TiffFile& file, const RasterLayout& layout, const RasterCorner& from) {
  const double to_centre = is_point(file) ? 0 : 0.5;
  const double column = to_centre + (from.step_x < 0 ? layout.columns - 1.0 : 0);
  const double row = to_centre + (from.step_y > 0 ? layout.rows - 1.0 : 0);
  Raster raster{.columns = layout.columns,
                .rows = layout.rows,
                .first = {from.x + column * from.step_x, from.y + row * from.step_y},
                .pixel = {std::fabs(from.step_x), std::fabs(from.step_y)}};
  const auto sound = [](double first, double pixel) {
    return std::fabs(first) <= 1e15 && pixel >= 1e-9 && pixel <= 1e6;
  };
  if (!sound(raster.first.x, raster.pixel.x) || !sound(raster.first.y, raster.pixel.y))
    file.fail(
        "has its first pixel or the size of pixels out of bounds: expected within 1e15 m, and from 1e-9 m "
        "to 1e6 m");
  return raster;
}

/// Height of a number: `scale` times the number, plus `offset` [m].
struct HeightScale {
  double scale = 1, offset = 0;
};

namespace geotiff {

/// Unit by EPSG code, and names between bars. Source: EPSG 10.076; GDALRasterBand::GetUnitType.
struct LengthUnit {
  std::uint16_t code = metre;
  double metres = 1;
  std::string_view names = "|m|metre|metres|meter|meters|";
};
inline constexpr std::array<LengthUnit, 6> length_units{{
    {},
    {1025, 0.001, "|mm|millimetre|"},
    {1033, 0.01, "|cm|centimetre|"},
    {foot, 0.3048, "|ft|foot|feet|international foot|"},
    {us_foot, 1200.0 / 3937.0, "|us survey foot|us_survey_foot|foot_us|us-ft|ftus|sft|sfoot|"},
    {9095, 0.3048007491, "|british foot (1936)|"},
}};

/// Vertical systems in other units than metres, or of depths. Source: EPSG registry 10.076.
inline constexpr std::array<std::uint16_t, 5> systems_in_feet{6130, 6131, 6132, 8050, 8228};
inline constexpr std::array<std::uint16_t, 3> systems_in_us_feet{5702, 6360, 8052};
inline constexpr std::uint16_t system_in_british_feet = 5754;
inline constexpr std::array<std::uint16_t, 29> systems_of_depths{
    5336, 5612, 5614, 5706, 5715, 5734, 5739, 5789, 5831, 5861, 5862, 5863, 5864, 5865, 5866,
    5867, 5873, 6357, 6358, 6359, 7976, 8051, 8053, 8358, 8378, 8897, 9287, 9288, 9672};

}  // namespace geotiff

/// Item of GDAL's metadata by role and band, from 1; or empty. Source: GDAL manual, GTiff driver.
[[nodiscard]] inline std::string_view metadata_item(std::string_view all, std::string_view role, std::uint16_t band) {
  const auto attribute = [](std::string_view tag, std::string_view name) -> std::string_view {
    const std::size_t at = tag.find(std::string(name) + "=\"");
    if (at == tag.npos) return {};
    const std::string_view value = tag.substr(at + name.size() + 2);
    return value.substr(0, value.find('"'));
  };
  for (std::size_t at = all.find("<Item "); at != all.npos; at = all.find("<Item ", at + 1)) {
    const std::size_t close = std::min(all.find('>', at), all.size() - 1);
    const std::string_view tag = all.substr(at, close - at);
    if (attribute(tag, " role") == role && text::number_in<unsigned>(attribute(tag, " sample")) == band - 1U)
      return text::trimmed(all.substr(close + 1, all.find('<', close) - close - 1));
  }
  return {};
}

/// Metres per unit of height by the keys of a file. @throws FileError for a system of depths
[[nodiscard]] inline double metres_by_keys(TiffFile& file) {
  const std::uint16_t system = geo_key(file, geotiff::vertical, 0);
  const auto is_in = [&](const auto& codes) { return std::ranges::find(codes, system) != codes.end(); };
  if (is_in(geotiff::systems_of_depths))
    file.fail("has depths, by its vertical system EPSG:", system,
              ": expected heights; with a vertical scale as a setting its numbers are heights");
  std::uint16_t unit = geo_key(file, geotiff::vertical_unit, 0);
  const bool is_given = unit != 0 && unit != geotiff::user_defined;
  if (!is_given) {
    unit = is_in(geotiff::systems_in_feet)             ? geotiff::foot
           : is_in(geotiff::systems_in_us_feet)        ? geotiff::us_foot
           : system == geotiff::system_in_british_feet ? std::uint16_t{9095}
                                                       : geotiff::metre;
  }
  if (system != 0)
    file.warn("vertical system ", system, ": ", is_given || unit != geotiff::metre ? "" : "metres are assumed; ",
              "heights stay in it");
  for (const geotiff::LengthUnit& known : geotiff::length_units)
    if (known.code == unit) return known.metres;
  file.warn("the unit of its heights has the code ", unit, "; metres are assumed");
  return 1;
}

/// Metres per unit of height by its name. Source: GDAL manual, GDALRasterBand::GetUnitType.
[[nodiscard]] inline double metres_by_name(TiffFile& file, std::string_view name) {
  const std::string word = '|' + text::lower(name) + '|';
  for (const geotiff::LengthUnit& known : geotiff::length_units)
    if (known.names.find(word) != known.names.npos) return known.metres;
  file.warn("the unit of its heights is ", text::quoted(name), "; metres are assumed");
  return 1;
}

/// Heights of a band, from 1. @throws FileError for a scale of 0 or no number, and depths
[[nodiscard]] inline HeightScale height_scale(TiffFile& file, std::uint16_t band) {
  const auto text = file.tags<char>(geotiff::metadata);
  const std::string_view all(text.data(), text.size());
  const std::string_view unit = metadata_item(all, "unittype", band);
  const double by_keys = metres_by_keys(file);
  const double metres = unit.empty() ? by_keys : metres_by_name(file, unit);
  if (metres > 0.3 && metres < 0.31) file.warn("heights in feet become metres");
  const auto number = [&](const char* role, double otherwise) {
    const std::string_view word = metadata_item(all, role, band);
    if (word.empty()) return otherwise;
    const std::optional<double> value = text::finite_number_in(word);
    if (!value || !(std::fabs(*value) <= 1e15))
      file.fail("has the ", role, ' ', text::quoted(word), " of heights: expected a number");
    return *value;
  };
  const HeightScale made{.scale = number("scale", 1) * metres, .offset = number("offset", 0) * metres};
  if (made.scale == 0) file.fail("has the scale 0 of heights: expected another number");
  return made;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
