// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_GEOTIFF_RULES_HPP
#define PULSECAST_IO_DETAIL_GEOTIFF_RULES_HPP

#include <array>

#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// GeoKeys, tags, images, bands and items of GDAL's metadata. Keys from 32768 are private. Source: OGC GeoTIFF 1.1,
/// annex B; TIFF 6.0; GDAL manual, GTiff driver.
inline constexpr std::array<FormatRule, 39> geotiff_rules{{
    {"GeoKey 1024", FormatUse::read, "GTModelType: projected coordinates"},
    {"GeoKey 1024 = 2", FormatUse::refused, "projected coordinates, not degrees: gdalwarp -t_srs EPSG:CODE makes them"},
    {"GeoKey 1024 = 3", FormatUse::refused, "projected coordinates, not geocentric: gdalwarp -t_srs EPSG:CODE"},
    {"GeoKey 1025", FormatUse::read, "GTRasterType: pixels are areas or points"},
    {"GeoKey 1026", FormatUse::read, "GTCitation: unit, as `(ftUS)`, or well-known text of Esri"},
    {"GeoKeys 2048 to 2062", FormatUse::read, "geodetic base; coordinates stay in it"},
    {"GeoKey 3059", FormatUse::read, "ProjLinearUnitsInterpCorrect, of parameters; coordinates are the same"},
    {"GeoKey 3072", FormatUse::read, "ProjectedCRS: EPSG code"},
    {"GeoKey 3072 alone", FormatUse::noted, "its unit is not told (GeoKey 3076): metres are assumed"},
    {"GeoKey 3073", FormatUse::read, "ProjectedCitation, as GTCitation"},
    {"GeoKeys 3074 to 3096", FormatUse::read, "projection; coordinates stay in it"},
    {"GeoKey 3076", FormatUse::read, "ProjLinearUnits: coordinates become metres"},
    {"GeoKey 3076 = other", FormatUse::refused, "a known unit, or its size: gdal_edit.py -a_srs EPSG:CODE names one"},
    {"GeoKey 3076 alone", FormatUse::noted, "coordinates become metres; heights without a unit are taken as metres"},
    {"GeoKey 3077", FormatUse::read, "ProjLinearUnitSize: metres a unit of coordinates"},
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
    {"item scale_factor, add_offset", FormatUse::noted, "names without a role of GDAL: numbers are not scaled by them"},
    {"mask", FormatUse::read, "image, file `.msk` or alpha band: heights are missing where it is 0"},
    {"mask of another size", FormatUse::refused, "one of the raster's size: gdal_translate -mask none leaves it out"},
    {"colours", FormatUse::refused, "heights, not a picture: gdal_translate -b BAND takes one band of it"},
    {"colours, another band", FormatUse::noted, "the numbers of a picture's band are taken as heights"},
    {"other image", FormatUse::noted, "the first is read: gdal_translate GTIFF_DIR:2:FILE takes the second"},
    {"first image = overview", FormatUse::refused,
     "the raster first: gdal_translate GTIFF_DIR:2:FILE takes the second"},
    {"tag 33550 z", FormatUse::noted,
     "heights of ModelPixelScale, ModelTiepoint and ModelTransformation have no effect"},
    {"tag 32997", FormatUse::refused, "one layer, not a volume (ImageDepth 1)"},
    {"tag 274", FormatUse::refused, "rows from the top (Orientation 1): gdal_translate makes a file with it"},
}};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
