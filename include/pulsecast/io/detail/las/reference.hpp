// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_REFERENCE_HPP
#define PULSECAST_IO_DETAIL_LAS_REFERENCE_HPP

#include <algorithm>

#include <pulsecast/io/spatial_reference.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Well-known text of UTM on WGS 84, ETRS89 or NAD83, else empty. Source: EPSG; OGC 01-009, 7.
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
  const auto has = [epsg](const Family& f) { return epsg >= f.first && epsg <= f.last; };
  const auto* const family = std::ranges::find_if(families, has);
  if (family == families.end()) return {};
  const Family& of = *family;
  const unsigned zone = epsg - of.first + of.zone;
  const std::string datum =
      text::joined({R"(DATUM[")", of.datum, R"(",SPHEROID[")", of.ellipsoid, R"(",6378137,)", of.flattening,
                    R"(,AUTHORITY["EPSG",")", of.ellipsoid_code, R"("]],AUTHORITY["EPSG",")", of.datum_code, R"("]])"});
  const std::string geographic = text::joined(
      {R"(GEOGCS[")", of.system, R"(",)", datum, R"(,PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]])",
       R"(,UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG",")", of.system_code, R"("]])"});
  return text::joined(
      {R"(PROJCS[")", of.system, " / UTM zone ", std::to_string(zone), of.south ? "S\"," : "N\",", geographic,
       R"(,PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",)",
       std::to_string(6 * static_cast<int>(zone) - 183), R"(],PARAMETER["scale_factor",0.9996])",
       R"(,PARAMETER["false_easting",500000],PARAMETER["false_northing",)", of.south ? "10000000" : "0",
       R"(],UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["Easting",EAST],AXIS["Northing",NORTH])",
       R"(,AUTHORITY["EPSG",")", std::to_string(epsg), R"("]])"});
}

/// GeoTIFF keys: projected model, its code and unit; vertical system and its unit, if it differs. A unit without a code
/// here follows from that of the system. Source: OGC GeoTIFF 1.1, 7.1.2, annex B; EPSG registry, units.
[[nodiscard]] inline std::vector<std::uint16_t> las_geo_keys(const SpatialReference& in) {
  std::vector<std::uint16_t> keys{1, 1, 0, 0};
  const auto add = [&keys](std::uint16_t key, std::uint16_t value) {
    if (value == 0) return;
    keys.insert(keys.end(), {key, 0, 1, value});
    ++keys[3];
  };
  const auto unit = [](double metres) -> std::uint16_t {
    const auto is = [metres](double other) { return std::fabs(metres / other - 1) < 1e-9; };
    return is(1) ? 9001 : is(0.3048) ? 9002 : is(1200.0 / 3937) ? 9003 : 0;  // metre, foot, US survey foot
  };
  add(1024, 1);
  add(3072, in.epsg);
  add(3076, unit(in.unit));
  add(4096, in.vertical_epsg);
  if (in.vertical_epsg != 0 || in.vertical_unit != in.unit) add(4099, unit(in.vertical_unit));
  return keys;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
