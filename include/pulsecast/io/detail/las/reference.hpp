// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_REFERENCE_HPP
#define PULSECAST_IO_DETAIL_LAS_REFERENCE_HPP

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include <pulsecast/base/error.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Well-known text of a UTM system on WGS 84, ETRS89 or NAD83; empty for other codes, whose definitions fill a register
/// of thousands. Source: EPSG registry; OGC 01-009 (Coordinate Transformation Services), 7.
[[nodiscard]] inline std::string las_utm(std::uint16_t epsg) {
  struct Family {
    unsigned first, last;  // codes of its zones
    unsigned zone;         // number of the first zone
    std::string_view system, system_code, datum, datum_code, ellipsoid, flattening, ellipsoid_code;
    bool south = false;
  };
  static constexpr std::array<Family, 4> families{{
      {32601, 32660, 1, "WGS 84", "4326", "WGS_1984", "6326", "WGS 84", "298.257223563", "7030"},
      {32701, 32760, 1, "WGS 84", "4326", "WGS_1984", "6326", "WGS 84", "298.257223563", "7030", true},
      {25828, 25838, 28, "ETRS89", "4258", "European_Terrestrial_Reference_System_1989", "6258", "GRS 1980",
       "298.257222101", "7019"},
      {26901, 26923, 1, "NAD83", "4269", "North_American_Datum_1983", "6269", "GRS 1980", "298.257222101", "7019"},
  }};
  const auto family = std::find_if(families.begin(), families.end(),
                                   [&](const Family& f) { return epsg >= f.first && epsg <= f.last; });
  if (family == families.end()) return {};
  const unsigned zone = epsg - family->first + family->zone;
  const auto code = [](std::string_view number) { return text::joined({"AUTHORITY[\"EPSG\",\"", number, "\"]"}); };
  const std::string ellipsoid = text::joined(
      {"SPHEROID[\"", family->ellipsoid, "\",6378137,", family->flattening, ",", code(family->ellipsoid_code), "]"});
  const std::string datum =
      text::joined({"DATUM[\"", family->datum, "\",", ellipsoid, ",", code(family->datum_code), "]"});
  const std::string geographic =
      text::joined({"GEOGCS[\"", family->system, "\",", datum, ",PRIMEM[\"Greenwich\",0,", code("8901"),
                    "],UNIT[\"degree\",0.0174532925199433,", code("9122"), "],", code(family->system_code), "]"});
  const std::string name = text::joined(
      {"PROJCS[\"", family->system, " / UTM zone ", std::to_string(zone), family->south ? "S" : "N", "\","});
  const std::string projection = text::joined(
      {",PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",",
       std::to_string(6 * static_cast<int>(zone) - 183),
       "],PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",",
       family->south ? "10000000" : "0", "],"});
  const std::string axes =
      text::joined({"UNIT[\"metre\",1,", code("9001"), "],AXIS[\"Easting\",EAST],AXIS[\"Northing\",NORTH],"});
  return text::joined({name, geographic, projection, axes, code(std::to_string(epsg)), "]"});
}

/// GeoTIFF key directory: header and keys (projected model, its code, metre). Source: OGC GeoTIFF 1.1, 7.1.2, annex B.
[[nodiscard]] constexpr std::array<std::uint16_t, 16> las_geo_keys(std::uint16_t epsg) noexcept {
  return {1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, epsg, 3076, 0, 1, 9001};
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
