// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_HEIGHT_SCALE_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_HEIGHT_SCALE_HPP

#include <algorithm>
#include <array>
#include <cmath>

#include <pulsecast/base/text.hpp>
#include <pulsecast/io/detail/geotiff/georeference.hpp>
#include <pulsecast/io/detail/geotiff/tiff_file.hpp>

/// Heights by the numbers of a file: unit, scale and offset.
namespace PULSECAST_NAMESPACE::io::detail {

/// Height of a number: `scale` times the number, plus `offset` [m].
struct HeightScale {
  double scale = 1, offset = 0;
};

namespace geotiff {

/// Unit of length by EPSG code, and names between bars. Source: EPSG registry 10.076; GDALRasterBand::GetUnitType.
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

/// Vertical systems in other units than metres, or of depths. Source: EPSG registry 10.076, vertical systems and axes.
inline constexpr std::array<std::uint16_t, 5> systems_in_feet{6130, 6131, 6132, 8050, 8228};
inline constexpr std::array<std::uint16_t, 3> systems_in_us_feet{5702, 6360, 8052};
inline constexpr std::uint16_t system_in_british_feet = 5754;
inline constexpr std::array<std::uint16_t, 29> systems_of_depths{
    5336, 5612, 5614, 5706, 5715, 5734, 5739, 5789, 5831, 5861, 5862, 5863, 5864, 5865, 5866,
    5867, 5873, 6357, 6358, 6359, 7976, 8051, 8053, 8358, 8378, 8897, 9287, 9288, 9672};

}  // namespace geotiff

/// Text of an item of GDAL's metadata by role and band, from 1; or empty. Source: GDAL, GTiff driver, GDAL_METADATA.
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
    if (attribute(tag, " role") != role || text::number_in<unsigned>(attribute(tag, " sample")) != band - 1U) continue;
    return text::trimmed(all.substr(close + 1, all.find('<', close) - close - 1));
  }
  return {};
}

/// Metres per unit of height by the keys of a file. @throws FileError for a system of depths
[[nodiscard]] inline double metres_by_keys(TiffFile& file) {
  const std::uint16_t system = geo_key(file, geotiff::vertical, 0);
  const auto is_in = [&](const auto& codes) { return std::find(codes.begin(), codes.end(), system) != codes.end(); };
  if (is_in(geotiff::systems_of_depths))
    file.fail("has depths, by its vertical system EPSG:" + std::to_string(system) +
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
    file.warn("vertical system " + std::to_string(system) + ": " +
              (is_given || unit != geotiff::metre ? "" : "metres are assumed; ") +
              "heights stay in it, and LAS files do not name it");
  for (const geotiff::LengthUnit& known : geotiff::length_units)
    if (known.code == unit) return known.metres;
  file.warn("the unit of its heights has the code " + std::to_string(unit) + "; metres are assumed");
  return 1;
}

/// Metres per unit of height by GDAL's name of a unit. Source: GDAL manual, GDALRasterBand::GetUnitType.
[[nodiscard]] inline double metres_by_name(TiffFile& file, std::string_view name) {
  const std::string word = '|' + text::lower(name) + '|';
  for (const geotiff::LengthUnit& known : geotiff::length_units)
    if (known.names.find(word) != known.names.npos) return known.metres;
  file.warn("the unit of its heights is " + text::quoted(name) + "; metres are assumed");
  return 1;
}

/// Heights of a band, from 1, by all tags. @throws FileError for a scale of 0 or no number, and as `metres_by_keys`
[[nodiscard]] inline HeightScale height_scale(TiffFile& file, std::uint16_t band) {
  const auto text = file.tags<char>(geotiff::metadata);
  const std::string_view all(text.data(), text.size());
  const std::string_view unit = metadata_item(all, "unittype", band);
  const double by_keys = metres_by_keys(file), metres = unit.empty() ? by_keys : metres_by_name(file, unit);
  if (metres > 0.3 && metres < 0.31) file.warn("heights in feet become metres");
  const auto number = [&](const char* role, double otherwise) {
    const std::string_view word = metadata_item(all, role, band);
    if (word.empty()) return otherwise;
    const std::optional<double> value = text::finite_number_in(word);
    if (!value || !(std::fabs(*value) <= 1e15))
      file.fail(std::string("has the ") + role + ' ' + text::quoted(word) + " of heights: expected a number");
    return *value;
  };
  const HeightScale made{.scale = number("scale", 1) * metres, .offset = number("offset", 0) * metres};
  if (made.scale == 0) file.fail("has the scale 0 of heights: expected another number");
  return made;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
