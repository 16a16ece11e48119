// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_RULES_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_RULES_HPP

#include <array>

#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// GeoKeys, tags, images, bands and items of GDAL's metadata. Keys from 32768 are private. Source: OGC GeoTIFF 1.1,
/// annex B; TIFF 6.0; GDAL manual, GTiff driver.
inline constexpr std::array<FormatRule, 37> geotiff_rules{{
    {"GeoKey 1024", FormatUse::read, "GTModelType: projected coordinates"},
    {"GeoKey 1024 = 2", FormatUse::refused, "projected coordinates, not degrees: gdalwarp -t_srs EPSG:CODE"},
    {"GeoKey 1024 = 3", FormatUse::refused, "projected coordinates, not geocentric: gdalwarp -t_srs EPSG:CODE"},
    {"GeoKey 1025", FormatUse::read, "GTRasterType: pixels are areas or points"},
    {"GeoKey 1026", FormatUse::read, "GTCitation: unit, as `(ftUS)`, or well-known text of Esri"},
    {"GeoKey 20*", FormatUse::read, "geodetic base; coordinates stay in it"},
    {"GeoKey 3072", FormatUse::read, "ProjectedCRS: EPSG code"},
    {"GeoKey 3072 alone", FormatUse::noted, "its unit is not told (GeoKey 3076): metres are assumed"},
    {"GeoKey 3076", FormatUse::read, "ProjLinearUnits: coordinates become metres"},
    {"GeoKey 3076 = other", FormatUse::refused, "a known unit: gdal_edit.py -a_srs EPSG:CODE names one"},
    {"GeoKey 3076 alone", FormatUse::noted, "heights without a unit are taken as metres"},
    {"GeoKey 3077", FormatUse::read, "ProjLinearUnitSize: metres a unit of coordinates"},
    {"GeoKey 30*", FormatUse::read, "parameters of a projection; coordinates stay in it"},
    {"GeoKey 4096", FormatUse::read, "Vertical: EPSG code, and unit of heights"},
    {"GeoKey 4096 = depth", FormatUse::refused, "heights, not depths; with a vertical scale its numbers are heights"},
    {"GeoKey 4096 alone", FormatUse::noted, "the unit of its vertical system is not told: metres are assumed"},
    {"GeoKey 4097", FormatUse::read, "VerticalCitation: name of the vertical system"},
    {"GeoKey 4098", FormatUse::read, "VerticalDatum; heights stay in it"},
    {"GeoKey 4099", FormatUse::read, "VerticalUnits: heights become metres"},
    {"GeoKey 4099 = other", FormatUse::refused, "a known unit of heights, or a vertical scale as a setting"},
    {"GeoKey 5120", FormatUse::noted, "CoordinateEpoch: coordinates stay in it"},
    {"item scale", FormatUse::read, "of the numbers of a band"},
    {"item offset", FormatUse::read, "of the numbers of a band, after the scale"},
    {"item unittype", FormatUse::read, "unit of heights"},
    {"item unittype = other", FormatUse::noted, "the unit of heights is unknown: metres are assumed"},
    {"item colorinterp", FormatUse::read, "role of a band, as `Alpha`"},
    {"item description", FormatUse::read, "name of a band"},
    {"item scale_factor, add_offset", FormatUse::noted, "numbers are not scaled by items without a role"},
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
