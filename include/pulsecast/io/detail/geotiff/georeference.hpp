// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_GEOREFERENCE_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_GEOREFERENCE_HPP

#include <tiffio.h>

#include <pulsecast/io/detail/geotiff/raster_layout.hpp>
#include <pulsecast/io/detail/side_files.hpp>

/// Place and heights of the pixels of a GeoTIFF by its tags.
namespace PULSECAST_NAMESPACE::io::detail {

/// Tags by number. Source: OGC GeoTIFF 1.1, 7.1; GDAL manual.
namespace geotiff {
inline constexpr ttag_t pixel_scale = 33550, tie_points = 33922, transformation = 34264, key_directory = 34735,
                        metadata = 42112, nodata = 42113;
}  // namespace geotiff

[[nodiscard]] inline GeoKeys geo_keys(const TiffFile& file) {
  const auto texts = file.tags<char>(GeoKeys::in_texts);
  return {file.tags<std::uint16_t>(geotiff::key_directory),
          file.tags<double>(GeoKeys::in_numbers),
          {texts.data(), texts.size()}};
}

/// Reference system of a file, by its keys, or by the files beside it if these name none. `heights`: unit of heights
/// without one. @throws FileError for one in degrees or geocentric, and by the rules
[[nodiscard]] inline SpatialReference reference_of(TiffFile& file, HeightUnit heights) {
  const GeoKeys keys = geo_keys(file);
  const SpatialReference own = ReferenceReader(file.path(), heights, file.warnings()).by_keys(keys);
  const bool is_silent = keys.code(1024) == 0 && keys.code(3072) == 0 && own == SpatialReference{};
  const SpatialReference beside = read_side_files(file.path(), file.warnings(), heights, is_silent);
  return is_silent ? beside : own;
}

/// True if a tie is the centre of a pixel. Source: OGC GeoTIFF 1.1, 7.1.3 (PixelIsPoint).
[[nodiscard]] inline bool is_point(const TiffFile& file) { return geo_keys(file).code(1025) == 2; }

/// Corner of the first pixel of a file, and steps of columns to the east and rows to the north [m]; height of a number.
struct RasterCorner {
  double x = 0, y = 0, step_x = 0, step_y = 0, step_z = 1, z = 0;
};

/// Position of the pixels of a file, by its tags or a world file; heights are scaled in a vertical system alone.
/// Source: OGC GeoTIFF 1.1, 7.1.1; GDAL manual, GTiff driver. @throws FileError without a georeference, and for rows
/// that do not go east
[[nodiscard]] inline RasterCorner raster_corner(TiffFile& file, const RasterLayout& layout, bool has_heights) {
  const auto scale = file.tags<double>(geotiff::pixel_scale), ties = file.tags<double>(geotiff::tie_points),
             matrix = file.tags<double>(geotiff::transformation);
  if (matrix.size() >= 16) {
    const double turn = std::max(std::fabs(matrix[1]) * layout.rows, std::fabs(matrix[4]) * layout.columns);
    if (!(turn <= 1e-3 * std::min(std::fabs(matrix[0]), std::fabs(matrix[5]))))  // over the whole raster
      file.fail("is rotated or sheared: expected rows to the east; resampling to north up makes them so");
    if ((matrix[10] != 0 && matrix[10] != 1) || matrix[11] != 0) file.keep("tag 33550 z");
    return {.x = matrix[3], .y = matrix[7], .step_x = matrix[0], .step_y = matrix[5]};
  }
  if (scale.size() >= 2 && ties.size() >= 6) {
    if (scale[1] < 0)
      file.warn("ModelPixelScale has a negative height of the pixel; its magnitude is taken, as GDAL does");
    if (scale[0] < 0) file.fail("has pixels of a negative width: expected a positive one");
    const double step_x = scale[0], step_y = -std::fabs(scale[1]);
    RasterCorner made{
        .x = ties[3] - ties[0] * step_x, .y = ties[4] - ties[1] * step_y, .step_x = step_x, .step_y = step_y};
    const double step_z = scale.size() >= 3 && scale[2] != 0 ? scale[2] : 1, z = ties[5] - ties[2] * step_z;
    if (has_heights && std::fabs(z) <= 1e15 && std::fabs(step_z) <= 1e15) {
      made.step_z = step_z;
      made.z = z;
    } else if (step_z != 1 || ties[2] != 0 || ties[5] != 0) {
      file.keep("tag 33550 z");
    }
    return made;
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

/// Raster without heights, its columns from the west and rows from the north; `unit`: of coordinates [m].
/// @throws FileError for pixels out of bounds
[[nodiscard]] inline Raster placed_raster(const TiffFile& file, const RasterLayout& layout, const RasterCorner& from,
                                          double unit) {
  const double to_centre = is_point(file) ? 0 : 0.5;
  const double column = to_centre + (from.step_x < 0 ? layout.columns - 1.0 : 0);
  const double row = to_centre + (from.step_y > 0 ? layout.rows - 1.0 : 0);
  Raster raster{.columns = layout.columns,
                .rows = layout.rows,
                .first = unit * Vec2(from.x + column * from.step_x, from.y + row * from.step_y),
                .pixel = unit * Vec2(std::fabs(from.step_x), std::fabs(from.step_y))};
  const auto sound = [](double first, double pixel) {
    return std::fabs(first) <= 1e15 && pixel >= 1e-9 && pixel <= 1e6;
  };
  if (!sound(raster.first.x, raster.pixel.x) || !sound(raster.first.y, raster.pixel.y))
    file.fail(
        "has its first pixel or the size of pixels out of bounds: expected within 1e15 m, and from 1e-9 m "
        "to 1e6 m");
  return raster;
}

/// Height of a number: `scale` times the number, plus `offset`, in units of `unit` [m].
struct HeightScale {
  double scale = 1, offset = 0, unit = 1;
};

/// What GDAL's metadata and ExtraSamples say of the bands. Source: GDAL manual, GTiff driver; TIFF 6.0, ExtraSamples.
struct BandItems {
  HeightScale heights;                 ///< of one band
  std::vector<std::uint16_t> alpha{};  ///< bands of opacity, from 1
};

/// Sets an item of band `of`, from 1, of the heights or of another. @throws FileError for a scale that is no number
inline void set_item(TiffFile& file, BandItems& made, std::string_view role, std::string_view value, bool is_height,
                     std::size_t of) {
  if (role == "colorinterp" && value == "Alpha") made.alpha.push_back(static_cast<std::uint16_t>(of));
  if (!is_height || value.empty()) return;
  if (role == "colorinterp" && (value == "Red" || value == "Green" || value == "Blue"))
    file.keep(of == 1 ? "colours" : "colours, another band");
  if (role == "unittype") {
    const auto* const known = std::ranges::find_if(length_units, [&](const LengthUnit& u) {
      return u.names.find('|' + text::lower(value) + '|') != u.names.npos;
    });
    if (known == length_units.end()) file.keep("item unittype = other");
    made.heights.unit = known == length_units.end() ? 1 : known->metres;
  }
  if (role != "scale" && role != "offset") return;
  const std::optional<double> number = text::finite_number_in(value);
  if (!number || !(std::fabs(*number) <= 1e15) || (role == "scale" && *number == 0))
    file.fail("has the ", role, ' ', text::quoted(value), " of heights: expected another number");
  (role == "scale" ? made.heights.scale : made.heights.offset) = *number;
}

/// Reads what is said of a band of heights, from 1, in units of `unit` [m] unless the band names one.
[[nodiscard]] inline BandItems band_items(TiffFile& file, std::uint16_t band, std::uint16_t samples, double unit) {
  BandItems made{.heights = {.unit = unit}};
  const auto attribute = [](std::string_view tag, std::string_view name) -> std::string_view {
    const std::size_t at = tag.find(name);
    if (at == tag.npos) return {};
    const std::string_view value = tag.substr(at + name.size());
    return value.substr(0, value.find('"'));
  };
  const auto text = file.tags<char>(geotiff::metadata);
  std::string_view all(text.data(), text.size());
  all = all.substr(0, all.find('\0'));
  bool is_named = false;
  for (std::size_t at = all.find("<Item "); at != all.npos; at = all.find("<Item ", at + 1)) {
    const std::size_t close = std::min(all.find('>', at), all.size() - 1);
    const std::string_view tag = all.substr(at, close - at), role = attribute(tag, " role=\"");
    const std::string name = text::lower(attribute(tag, " name=\""));
    const auto of = text::number_in<std::uint16_t>(attribute(tag, " sample=\""));
    const std::string_view value = text::trimmed(all.substr(close + 1, all.find('<', close) - close - 1));
    is_named = is_named || (role.empty() && value != "1" && value != "0" &&
                            (name.ends_with("scale_factor") || name.ends_with("add_offset")));
    if (name.ends_with("positive") && text::is_same_word(value, "down")) file.keep("item positive = down");
    if (!role.empty()) file.keep(text::message("item ", role));
    if (!role.empty() && of && *of < samples) set_item(file, made, role, value, *of + 1 == band, *of + std::size_t{1});
  }
  if (is_named && made.heights.scale == 1 && made.heights.offset == 0) file.keep("item scale_factor, add_offset");
  std::uint16_t count = 0;
  const std::uint16_t* kinds = nullptr;
  if (TIFFGetField(file.handle(), TIFFTAG_EXTRASAMPLES, &count, &kinds) != 1 || kinds == nullptr) count = 0;
  for (std::uint16_t i = 0; i < count && count <= samples; ++i)
    if (kinds[i] == EXTRASAMPLE_ASSOCALPHA || kinds[i] == EXTRASAMPLE_UNASSALPHA)
      made.alpha.push_back(static_cast<std::uint16_t>(samples - count + i + 1));
  return made;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
