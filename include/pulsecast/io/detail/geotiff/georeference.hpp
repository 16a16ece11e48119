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
inline constexpr std::uint16_t model_type = 1024, raster_type = 1025, geodetic = 2048, projected = 3072,
                               linear_unit = 3076, unit_size = 3077, vertical = 4096, vertical_unit = 4099;
inline constexpr std::uint16_t user_defined = 32767;
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

/// Projected systems whose names, as `(ft)` or `(ftUS)`, do not tell their unit, from one code to another; odd units
/// are links, yards, chains and other feet. Source: EPSG registry 10.076.
inline constexpr std::array<std::uint16_t, 34> ranges_in_us_feet{
    2155, 2155, 2194, 2194, 2204, 2204, 2964, 2964, 3102, 3102,  3561,  3565,  3991,  3992,  4455,  4456,  5623,
    5625, 6200, 6202, 6966, 6966, 7057, 7070, 8518, 8540, 26729, 26813, 32001, 32058, 32074, 32077, 32099, 32099};
inline constexpr std::array<std::uint16_t, 10> ranges_in_feet{3080, 3080, 3359, 3359, 5588,
                                                              5588, 6128, 6141, 6391, 6391};
inline constexpr std::array<std::uint16_t, 2> ranges_in_metres{26814, 26846};
inline constexpr std::array<std::uint16_t, 38> ranges_in_odd_units{
    2066,  2066,  2136,  2136,  2159,  2160,  2314,  2314,  3139,  3140,  3167,  3167,  3407,
    3407,  5472,  5472,  5589,  5589,  22300, 22300, 24100, 24100, 24370, 24374, 24382, 24382,
    24571, 24571, 27291, 27292, 29371, 29385, 29871, 29871, 29872, 29872, 30200, 30200};

/// Unit of x, y and z of a compound system in feet; 0 for others. Source: EPSG registry 10.076.
[[nodiscard]] constexpr std::uint16_t unit_of_compound(std::uint16_t code) noexcept {
  if (code >= 8700 && code <= 8711) return foot;
  return code == 7407 || (code >= 8712 && code <= 8800) ? us_foot : std::uint16_t{0};
}
}  // namespace geotiff

/// Entry of a key: its value for `at` 0, else an index into tag `at`. Source: OGC GeoTIFF 1.1, 7.1.2.
struct GeoKey {
  std::uint16_t key = 0, at = 0, count = 0, value = 0;
};
[[nodiscard]] inline std::vector<GeoKey> geo_keys(const TiffFile& file) {
  const auto keys = file.tags<std::uint16_t>(geotiff::key_directory);
  std::vector<GeoKey> all;
  for (std::size_t i = 4; i + 4 <= keys.size() && i / 4 <= keys[3]; i += 4)
    all.push_back({keys[i], keys[i + 1], keys[i + 2], keys[i + 3]});
  return all;
}

/// Value of a key, or index into tag `at`.
[[nodiscard]] inline std::uint16_t geo_key(const TiffFile& file, std::uint16_t wanted, std::uint16_t otherwise,
                                           ttag_t at = 0) {
  for (const GeoKey& key : geo_keys(file))
    if (key.key == wanted && key.at == at) return key.value;
  return otherwise;
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
  if (!is_given && !is_scaled && unit == 0 && (system < 3855 || (system > 5000 && system < 5107) || system > 9999))
    file.keep("GeoKey 4096 alone");
  if (is_given && !metres_of(unit) && !is_scaled) file.keep("GeoKey 4099 = other");
  made.vertical_unit = metres_of(unit).value_or(1);
  made.vertical_epsg = system == geotiff::user_defined ? std::uint16_t{0} : system;
}

/// Unit of the coordinates by a system's code or name, as GDAL writes no key of compound ones; empty if unknown [m].
[[nodiscard]] inline std::optional<double> unit_by_name(std::uint16_t system, std::string_view citations) {
  const auto is_in = [system](const auto& ranges) {
    const auto end = std::ranges::upper_bound(ranges, system);
    return (end - ranges.begin()) % 2 == 1 || (end != ranges.begin() && *std::prev(end) == system);
  };
  if (is_in(geotiff::ranges_in_us_feet)) return 1200.0 / 3937.0;
  if (is_in(geotiff::ranges_in_feet)) return 0.3048;
  if (is_in(geotiff::ranges_in_metres)) return 1;
  if (is_in(geotiff::ranges_in_odd_units)) return std::nullopt;
  const std::string_view name = citations.substr(0, citations.find(" + "));  // the vertical system follows
  if (name.find("(ftUS)") != name.npos) return 1200.0 / 3937.0;
  if (name.find("(ft)") != name.npos) return 0.3048;
  if (const auto metres = metres_of(geotiff::unit_of_compound(system))) return metres;
  return !name.empty() || !las_utm(system).empty() ? std::optional(1.0) : std::nullopt;
}

/// Unit of the coordinates [m]. @throws FileError for an unknown one
[[nodiscard]] inline double horizontal_unit(TiffFile& file, const SpatialReference& named, std::string_view citations) {
  const auto numbers = file.tags<double>(geotiff::key_numbers);
  const std::size_t at = geo_key(file, geotiff::unit_size, 0xFFFF, geotiff::key_numbers);
  const double size = at < numbers.size() ? numbers[at] : 0;
  const std::uint16_t given = geo_key(file, geotiff::linear_unit, 0);
  if (const auto metres = metres_of(given)) return *metres;
  if (size >= 1e-6 && size <= 1e6) return size;
  if (given != 0) file.keep("GeoKey 3076 = other");
  if (named.epsg == 0 || !named.wkt.empty()) return named.unit;
  const std::optional<double> metres = unit_by_name(named.epsg, citations);
  if (!metres) file.keep("GeoKey 3072 alone");
  return metres.value_or(1);
}

/// Reference system of a file, by its keys or by the files beside it. `is_scaled`: a setting replaces the unit of
/// heights. @throws FileError for one in degrees or geocentric, and by the rules
[[nodiscard]] inline SpatialReference reference_of(TiffFile& file, bool is_scaled) {
  for (const GeoKey& key : geo_keys(file))
    if (key.key <= geotiff::user_defined) file.keep(text::message("GeoKey ", key.key));
  const std::uint16_t projected = geo_key(file, geotiff::projected, 0);
  const bool is_globe = projected == 0 && geo_key(file, geotiff::geodetic, 0) != 0;
  const std::uint16_t model = geo_key(file, geotiff::model_type, is_globe ? 2 : 0);
  if (model == 2) file.keep("GeoKey 1024 = 2");
  if (model == 3) file.keep("GeoKey 1024 = 3");
  SpatialReference made = read_side_files(file.path(), file.warnings(), model == 0 && projected == 0);
  const auto texts = file.tags<char>(geotiff::key_texts);
  const std::string_view citations(texts.data(), texts.size()), esri = "ESRI PE String = ";
  if (const std::size_t at = citations.find(esri); at != citations.npos)
    made = reference_of(citations.substr(at + esri.size(), citations.find('|', at) - at - esri.size()), file.path(),
                        file.warnings());
  made.epsg = projected == geotiff::user_defined ? std::uint16_t{0} : projected;
  made.unit = horizontal_unit(file, made, citations);
  const std::uint16_t heights = geo_key(file, geotiff::vertical, geo_key(file, geotiff::vertical_unit, 0));
  if (heights != 0 || geotiff::unit_of_compound(made.epsg) != 0)
    read_vertical(file, made, is_scaled);
  else if (made.unit != 1 && made.wkt.empty() && !is_scaled)
    file.keep("GeoKey 3076 alone");
  return made;
}

/// True if a tie is the centre of a pixel. Source: OGC GeoTIFF 1.1, 7.1.3 (PixelIsPoint).
[[nodiscard]] inline bool is_point(const TiffFile& file) { return geo_key(file, geotiff::raster_type, 1) == 2; }

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
    const auto* const known = std::ranges::find_if(geotiff::length_units, [&](const geotiff::LengthUnit& u) {
      return u.names.find('|' + text::lower(value) + '|') != u.names.npos;
    });
    if (known == geotiff::length_units.end()) file.keep("item unittype = other");
    made.heights.unit = known == geotiff::length_units.end() ? 1 : known->metres;
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
