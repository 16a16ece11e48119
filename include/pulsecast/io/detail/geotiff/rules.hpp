// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_RULES_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_RULES_HPP

#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Tags, images, bands and items of GDAL's metadata. Source: TIFF 6.0; GDAL manual, GTiff driver.
inline constexpr std::array<FormatRule, 17> geotiff_rules{{
    {"item scale", FormatUse::read, "of the numbers of a band"},
    {"item offset", FormatUse::read, "of the numbers of a band, after the scale"},
    {"item unittype", FormatUse::read, "unit of heights"},
    {"item unittype = other", FormatUse::noted, "the unit of heights is unknown: metres are assumed"},
    {"item colorinterp", FormatUse::read, "role of a band, as `Alpha`"},
    {"item description", FormatUse::read, "name of a band"},
    {"item scale_factor, add_offset", FormatUse::noted, "numbers are not scaled by items without a role"},
    {"item positive = down", FormatUse::noted, "numbers are taken as heights, not as depths"},
    {"mask", FormatUse::read, "image, file `.msk` or alpha band: heights are missing where it is 0"},
    {"mask of another size", FormatUse::refused, "the raster's size: gdal_translate -mask none"},
    {"colours", FormatUse::refused, "heights, not a picture: gdal_translate -b BAND takes one"},
    {"colours, another band", FormatUse::noted, "the numbers of a picture's band are taken as heights"},
    {"other image", FormatUse::noted, "the first is read: gdal_translate GTIFF_DIR:2:FILE takes the next"},
    {"first image = overview", FormatUse::refused, "the raster first: gdal_translate GTIFF_DIR:2:FILE"},
    {"tag 33550 z", FormatUse::noted, "vertical scale and shift of the place have no effect without a vertical system"},
    {"tag 32997", FormatUse::refused, "one layer, not a volume (ImageDepth 1)"},
    {"tag 274", FormatUse::refused, "rows from the top (Orientation 1): gdal_translate writes it"},
}};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
