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
#include <pulsecast/io/detail/side_files.hpp>
#include <pulsecast/io/world_file.hpp>
#include <pulsecast/shape/raster.hpp>

/// Place and heights of the pixels of a GeoTIFF by its tags.
namespace PULSECAST_NAMESPACE::io::detail {

/// Tags and keys by number. Source: OGC GeoTIFF 1.1, annex B and 7.1; GDAL manual.
namespace geotiff {
inline constexpr ttag_t pixel_scale = 33550, tie_points = 33922, transformation = 34264, key_directory = 34735,
                        key_numbers = 34736, key_texts = 34737, metadata = 42112, nodata = 42113;
inline constexpr std::uint16_t model_type = 1024, raster_type = 1025, citation = 1026, geodetic = 2048,
                               projected = 3072, projected_citation = 3073, linear_unit = 3076, unit_size = 3077,
                               vertical = 4096, vertical_unit = 4099;
inline constexpr std::uint16_t user_defined = 32767, first_private = 32768;
inline constexpr std::uint16_t metre = 9001, foot = 9002, us_foot = 9003;  ///< EPSG codes of units

/// Unit by EPSG code, and names between bars. Source: EPSG 10.076; GDALRasterBand::GetUnitType.
struct LengthUnit {
  std::uint16_t code = metre;
  double metres = 1;
  std::string_view names = "|m|metre|metres|meter|meters|";
};
inline constexpr std::array<LengthUnit, 8> length_units{{
    {},
    {1025, 0.001, "|mm|millimetre|"},
    {1033, 0.01, "|cm|centimetre|"},
    {9036, 1000, "|km|kilometre|"},
    {9096, 0.9144, "|yd|yard|"},
    {foot, 0.3048, "|ft|foot|feet|international foot|"},
    {us_foot, 1200.0 / 3937.0, "|us survey foot|us_survey_foot|foot_us|us-ft|ftus|sft|sfoot|"},
    {9095, 0.3048007491, "|british foot (1936)|"},
}};

/// Vertical systems in other units than metres, or of depths; others from 3855 to 9999 are in metres, but for those of
/// GeoTIFF 1.0. Source: EPSG registry 10.076; GeoTIFF 1.0, 6.3.4.
inline constexpr std::array<std::uint16_t, 5> systems_in_feet{6130, 6131, 6132, 8050, 8228};
inline constexpr std::array<std::uint16_t, 3> systems_in_us_feet{5702, 6360, 8052};
inline constexpr std::uint16_t system_in_british_feet = 5754;
inline constexpr std::array<std::uint16_t, 29> systems_of_depths{
    5336, 5612, 5614, 5706, 5715, 5734, 5739, 5789, 5831, 5861, 5862, 5863, 5864, 5865, 5866,
    5867, 5873, 6357, 6358, 6359, 7976, 8051, 8053, 8358, 8378, 8897, 9287, 9288, 9672};

/// Unit of x, y and z of a compound system in feet; 0 for others. Source: EPSG registry 10.076.
[[nodiscard]] constexpr std::uint16_t unit_of_compound(std::uint16_t code) noexcept {
  if (code >= 8700 && code <= 8711) return foot;
  return code == 7407 || (code >= 8712 && code <= 8800) ? us_foot : std::uint16_t{0};
}
[[nodiscard]] constexpr bool is_vertical_in_metres(std::uint16_t code) noexcept {
  return code >= 3855 && code <= 9999 && !(code >= 5001 && code <= 5106);
}
}  // namespace geotiff

/// Place of a key's value: the number itself for `at` 0, else an index into tag `at`. Source: OGC GeoTIFF 1.1, 7.1.2.
struct GeoKey {
  std::uint16_t at = 0, count = 0, value = 0;
};
[[nodiscard]] inline std::optional<GeoKey> find_key(const TiffFile& file, std::uint16_t wanted) {
  const auto keys = file.tags<std::uint16_t>(geotiff::key_directory);
  for (std::size_t i = 4; i + 4 <= keys.size() && i / 4 <= keys[3]; i += 4)
    if (keys[i] == wanted) return GeoKey{keys[i + 1], keys[i + 2], keys[i + 3]};
  return std::nullopt;
}

/// Value of a key.
[[nodiscard]] inline std::uint16_t geo_key(const TiffFile& file, std::uint16_t wanted, std::uint16_t otherwise) {
  const std::optional<GeoKey> key = find_key(file, wanted);
  return key && key->at == 0 ? key->value : otherwise;
}

/// True if a file has one of some keys.
[[nodiscard]] inline bool is_any_key(const TiffFile& file, std::initializer_list<std::uint16_t> wanted) {
  return std::ranges::any_of(wanted, [&](std::uint16_t key) { return find_key(file, key).has_value(); });
}

/// Keeps to the rules of the keys. @throws FileError for unknown ones
inline void keep_keys(TiffFile& file) {
  const auto keys = file.tags<std::uint16_t>(geotiff::key_directory);
  for (std::size_t i = 4; i + 4 <= keys.size() && i / 4 <= keys[3]; i += 4) {
    const std::uint16_t key = keys[i];
    const bool is_projection = (key >= 3074 && key <= 3096) && key != geotiff::linear_unit && key != geotiff::unit_size;
    if (key >= geotiff::first_private) continue;
    file.keep(key >= 2048 && key <= 2062 ? "GeoKeys 2048 to 2062"
              : is_projection            ? "GeoKeys 3074 to 3096"
                                         : text::message("GeoKey ", key));
  }
}

/// Metres per unit by its EPSG code; empty if it is unknown.
[[nodiscard]] inline std::optional<double> metres_of(std::uint16_t unit) noexcept {
  for (const geotiff::LengthUnit& known : geotiff::length_units)
    if (known.code == unit) return known.metres;
  return std::nullopt;
}

/// Sets the vertical system of a file, and the unit of its heights. `is_scaled`: a setting replaces the unit.
/// @throws FileError for a system of depths, and an unknown unit
inline void read_vertical(TiffFile& file, SpatialReference& made, bool is_scaled) {
  const std::uint16_t system = geo_key(file, geotiff::vertical, 0);
  const auto is_in = [&](const auto& codes) { return std::ranges::find(codes, system) != codes.end(); };
  if (is_in(geotiff::systems_of_depths)) {
    if (!is_scaled) file.keep("GeoKey 4096 = depth");
    return;
  }
  std::uint16_t unit = geo_key(file, geotiff::vertical_unit, 0);
  const bool is_given = unit != 0 && unit != geotiff::user_defined;
  if (!is_given)
    unit = is_in(geotiff::systems_in_feet)             ? geotiff::foot
           : is_in(geotiff::systems_in_us_feet)        ? geotiff::us_foot
           : system == geotiff::system_in_british_feet ? std::uint16_t{9095}
                                                       : geotiff::unit_of_compound(made.epsg);
  if (!is_given && unit == 0 && system != 0 && !geotiff::is_vertical_in_metres(system) && !is_scaled)
    file.keep("GeoKey 4096 alone");
  if (is_given && !metres_of(unit) && !is_scaled) file.keep("GeoKey 4099 = other");
  made.vertical_unit = metres_of(unit).value_or(1);
  made.vertical_epsg = system == geotiff::user_defined ? std::uint16_t{0} : system;
}

/// Text of a key.
[[nodiscard]] inline std::string_view key_text(const TiffFile& file, std::uint16_t wanted) {
  const auto all = file.tags<char>(geotiff::key_texts);
  const std::optional<GeoKey> key = find_key(file, wanted);
  if (!key || key->at != geotiff::key_texts || key->value >= all.size()) return {};
  return std::string_view(all.data(), all.size()).substr(key->value, key->count);
}

/// Well-known text that Esri's programs write into a citation; else empty. Source: GDAL manual, GTiff driver.
[[nodiscard]] inline std::string_view citation_wkt(const TiffFile& file) {
  for (const std::uint16_t key : {geotiff::citation, geotiff::projected_citation})
    if (const std::string_view text = key_text(file, key); text.starts_with("ESRI PE String = "))
      return text.substr(17, text.find('|') - 17);
  return {};
}

/// Unit of the coordinates by the code of a system or its name, as GDAL leaves out the key in compound ones; 0 if
/// unknown. Source: EPSG registry 10.076, where NAD27 alone has feet without `(ftUS)` or `(ft)` in the name.
[[nodiscard]] inline std::uint16_t unit_by_name(const TiffFile& file, std::uint16_t system) {
  if ((system >= 26729 && system <= 26813) || (system >= 32001 && system <= 32058)) return geotiff::us_foot;
  for (const std::uint16_t key : {geotiff::projected_citation, geotiff::citation}) {
    std::string_view name = key_text(file, key);
    name = name.substr(0, name.find(" + "));
    if (name.find("(ftUS)") != name.npos) return geotiff::us_foot;
    if (name.find("(ft)") != name.npos) return geotiff::foot;
  }
  return geotiff::unit_of_compound(system);
}

/// Unit of the coordinates [m]. @throws FileError for an unknown one
[[nodiscard]] inline double horizontal_unit(TiffFile& file, const SpatialReference& named) {
  const std::optional<GeoKey> size_key = find_key(file, geotiff::unit_size);
  const auto numbers = file.tags<double>(geotiff::key_numbers);
  const bool has_size = size_key && size_key->at == geotiff::key_numbers && size_key->value < numbers.size();
  const double size = has_size ? numbers[size_key->value] : 0;
  const std::uint16_t given = geo_key(file, geotiff::linear_unit, 0);
  if (const auto metres = metres_of(given != 0 ? given : unit_by_name(file, named.epsg))) return *metres;
  if (size >= 1e-6 && size <= 1e6) return size;
  if (given != 0 || size_key) file.keep("GeoKey 3076 = other");
  if (!named.wkt.empty()) return named.unit;
  if (named.epsg != 0 && las_utm(named.epsg).empty()) file.keep("GeoKey 3072 alone");
  return 1;
}

/// Reference system of a file, by its keys or by the files beside it. `is_scaled`: a setting replaces the unit of
/// heights. @throws FileError for one in degrees or geocentric, and by the rules
[[nodiscard]] inline SpatialReference reference_of(TiffFile& file, bool is_scaled) {
  keep_keys(file);
  const bool is_silent = !is_any_key(file, {geotiff::model_type, geotiff::geodetic, geotiff::projected});
  SpatialReference made = read_side_files(file.path(), file.warnings(), is_silent);
  const std::uint16_t projected = geo_key(file, geotiff::projected, 0);
  const std::uint16_t geodetic = geo_key(file, geotiff::geodetic, 0);
  const std::uint16_t model = geo_key(file, geotiff::model_type, geodetic != 0 && projected == 0 ? 2 : 0);
  if (model == 2) file.keep("GeoKey 1024 = 2");
  if (model == 3) file.keep("GeoKey 1024 = 3");
  if (const std::string_view text = citation_wkt(file); !text.empty())
    made = reference_of(text, file.path(), file.warnings());
  made.epsg = projected == geotiff::user_defined ? std::uint16_t{0} : projected;
  made.unit = horizontal_unit(file, made);
  if (geotiff::unit_of_compound(made.epsg) != 0 || is_any_key(file, {geotiff::vertical, geotiff::vertical_unit}))
    read_vertical(file, made, is_scaled);
  else if (made.unit != 1 && made.wkt.empty() && !is_scaled)
    file.keep("GeoKey 3076 alone");
  return made;
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
    if ((matrix[10] != 0 && matrix[10] != 1) || matrix[11] != 0) file.keep("tag 33550 z");
    return {.x = matrix[3], .y = matrix[7], .step_x = matrix[0], .step_y = matrix[5]};
  }
  if (scale.size() >= 2 && ties.size() >= 6) {
    if (scale[1] < 0)
      file.warn("ModelPixelScale has a negative height of the pixel; its magnitude is taken, as GDAL does");
    if (scale[0] < 0) file.fail("has pixels of a negative width: expected a positive one");
    if ((scale.size() >= 3 && scale[2] != 0 && scale[2] != 1) || ties[2] != 0 || ties[5] != 0) file.keep("tag 33550 z");
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

/// Height of a number: `scale` times the number, plus `offset` [m].
struct HeightScale {
  double scale = 1, offset = 0;
};

/// Item of GDAL's metadata. Source: GDAL manual, GTiff driver.
struct MetadataItem {
  std::string_view name, role, value;
  unsigned band = 0;  ///< from 1; 0: none
};

[[nodiscard]] inline std::vector<MetadataItem> metadata_items(const TiffFile& file) {
  const auto attribute = [](std::string_view tag, std::string_view name) -> std::string_view {
    const std::size_t at = tag.find(name);
    if (at == tag.npos) return {};
    const std::string_view value = tag.substr(at + name.size());
    return value.substr(0, value.find('"'));
  };
  const auto text = file.tags<char>(geotiff::metadata);
  const std::string_view all(text.data(), text.size());
  std::vector<MetadataItem> items;
  for (std::size_t at = all.find("<Item "); at != all.npos; at = all.find("<Item ", at + 1)) {
    const std::size_t close = std::min(all.find('>', at), all.size() - 1);
    const std::string_view tag = all.substr(at, close - at);
    const auto sample = text::number_in<std::uint16_t>(attribute(tag, " sample=\""));
    items.push_back({attribute(tag, " name=\""), attribute(tag, " role=\""),
                     text::trimmed(all.substr(close + 1, all.find('<', close) - close - 1)),
                     sample ? *sample + 1U : 0});
  }
  return items;
}

/// True for a colour as GDAL names the role of a band. Source: GDALGetColorInterpretationName.
[[nodiscard]] inline bool is_colour(std::string_view name) {
  constexpr std::array<std::string_view, 7> names{"Red", "Green", "Blue", "Cyan", "Magenta", "Yellow", "Black"};
  return std::ranges::find(names, name) != names.end();
}

/// Keeps to the rules of GDAL's metadata. @throws FileError by the rules
inline void keep_items(TiffFile& file, std::uint16_t band) {
  const std::vector<MetadataItem> items = metadata_items(file);
  const auto has_role = [&](std::string_view role) {
    return std::ranges::any_of(items, [&](const MetadataItem& i) { return i.role == role && i.band == band; });
  };
  for (const auto& [name, role, value, of] : items) {
    if (!role.empty()) file.keep(text::message("item ", role));
    if (role == "colorinterp" && of == band && is_colour(value))
      file.keep(band == 1 ? "colours" : "colours, another band");
    if (!role.empty() || (of != 0 && of != band)) continue;
    const bool is_scale = text::lower(name).ends_with("scale_factor") && value != "1" && !has_role("scale");
    if (is_scale || (text::lower(name).ends_with("add_offset") && value != "0" && !has_role("offset")))
      file.keep("item scale_factor, add_offset");
  }
}

/// Bands of opacity, from 1. Source: TIFF 6.0, ExtraSamples.
[[nodiscard]] inline std::vector<std::uint16_t> alpha_bands(const TiffFile& file, std::uint16_t samples) {
  std::vector<std::uint16_t> bands;
  for (const MetadataItem& item : metadata_items(file))
    if (item.role == "colorinterp" && item.value == "Alpha" && item.band >= 1 && item.band <= samples)
      bands.push_back(static_cast<std::uint16_t>(item.band));
  std::uint16_t count = 0;
  const std::uint16_t* kinds = nullptr;
  if (TIFFGetField(file.handle(), TIFFTAG_EXTRASAMPLES, &count, &kinds) != 1 || kinds == nullptr) return bands;
  for (std::uint16_t i = 0; i < count && count <= samples; ++i)
    if (kinds[i] == EXTRASAMPLE_ASSOCALPHA || kinds[i] == EXTRASAMPLE_UNASSALPHA)
      bands.push_back(static_cast<std::uint16_t>(samples - count + i + 1));
  return bands;
}

/// Heights of a band, from 1; `by_keys`: metres a unit, but for a unit of the band.
/// @throws FileError for a scale of 0 or no number
[[nodiscard]] inline HeightScale height_scale(TiffFile& file, std::uint16_t band, double by_keys) {
  HeightScale made;
  double metres = by_keys;
  for (const auto& [name, role, value, of] : metadata_items(file)) {
    if (of != band || value.empty()) continue;
    if (role == "unittype") {
      const std::string word = '|' + text::lower(value) + '|';
      const auto* const known = std::ranges::find_if(
          geotiff::length_units, [&](const geotiff::LengthUnit& u) { return u.names.find(word) != u.names.npos; });
      if (known == geotiff::length_units.end()) file.keep("item unittype = other");
      metres = known == geotiff::length_units.end() ? 1 : known->metres;
    }
    if (role != "scale" && role != "offset") continue;
    const std::optional<double> number = text::finite_number_in(value);
    if (!number || !(std::fabs(*number) <= 1e15))
      file.fail("has the ", role, ' ', text::quoted(value), " of heights: expected a number");
    (role == "scale" ? made.scale : made.offset) = *number;
  }
  made = {.scale = made.scale * metres, .offset = made.offset * metres};
  if (made.scale == 0) file.fail("has the scale 0 of heights: expected another number");
  return made;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
