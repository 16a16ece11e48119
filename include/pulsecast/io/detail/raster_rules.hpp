// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_RASTER_RULES_HPP
#define PULSECAST_IO_DETAIL_RASTER_RULES_HPP

#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Keywords of Esri ASCII grids, of any case. Source: Esri, ArcGIS documentation, "Esri ASCII raster format"; GDAL
/// manual, AAIGrid driver.
inline constexpr std::array<FormatRule, 10> ascii_grid_rules{{
    {"ncols", FormatUse::read, "number of columns"},
    {"nrows", FormatUse::read, "number of rows"},
    {"xllcorner", FormatUse::read, "west edge"},
    {"xllcenter", FormatUse::read, "centres of the western pixels"},
    {"yllcorner", FormatUse::read, "south edge"},
    {"yllcenter", FormatUse::read, "centres of the southern pixels"},
    {"cellsize", FormatUse::read, "size of pixels; refused if it can only be degrees"},
    {"dx", FormatUse::read, "width of pixels"},
    {"dy", FormatUse::read, "height of pixels"},
    {"NODATA_value", FormatUse::read, "number of missing heights, -9999 without it"},
}};

/// Chunks of PNG files of heights. Source: PNG, second edition (ISO/IEC 15948), 11.3; PNG extensions 1.4.
inline constexpr std::array<FormatRule, 5> png_rules{{
    {"tRNS", FormatUse::refused, "no transparent grey: that of missing heights is a setting"},
    {"pCAL", FormatUse::refused, "no calibration of its numbers: scale and offset are settings"},
    {"sCAL", FormatUse::refused, "no scale of its pixels: a world file or a setting tells their size"},
    {"oFFs", FormatUse::refused, "no offset of its pixels: a world file or a setting tells their place"},
    {"acTL", FormatUse::refused, "one picture, not an animation"},
}};

/// Files beside a raster: its reference system, and elements of GDAL's `.aux.xml`. Source: OGC 01-009; GDAL manual,
/// Persistent Auxiliary Metadata.
inline constexpr std::array<FormatRule, 8> side_file_rules{{
    {"reference system", FormatUse::read, "`.prj`, or `<SRS>` of `.aux.xml`: coordinates and heights become metres"},
    {"<GeoTransform>", FormatUse::refused, "the place in the raster or a world file: gdal_translate writes it there"},
    {"<GCPList", FormatUse::refused, "a raster placed by rows and columns: gdalwarp makes one of control points"},
    {"<GeodataXform", FormatUse::refused, "a raster placed by rows and columns: gdalwarp makes one"},
    {"<NoDataValue", FormatUse::refused, "missing heights told by the raster: gdal_translate to GeoTIFF writes them"},
    {"<UnitType>", FormatUse::noted, "heights have the unit that the raster or its reference system tells, or metres"},
    {"<Offset>", FormatUse::refused, "an offset in the raster: gdal_translate to GeoTIFF writes it"},
    {"<Scale>", FormatUse::refused, "a scale in the raster: gdal_translate to GeoTIFF writes it"},
}};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
