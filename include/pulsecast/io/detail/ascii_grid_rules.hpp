// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_ASCII_GRID_RULES_HPP
#define PULSECAST_IO_DETAIL_ASCII_GRID_RULES_HPP

#include <array>

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

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
