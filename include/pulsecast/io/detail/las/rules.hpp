// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_RULES_HPP
#define PULSECAST_IO_DETAIL_LAS_RULES_HPP

#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Items of LAS, LAZ and COPC files. Source: ASPRS LAS 1.4 R15; LASzip.
inline constexpr FormatRule las_rules[]{
    {"withheld points", FormatUse::noted, "marked as withheld and left out"},
    {"synthetic points", FormatUse::noted, "marked as synthetic, and taken like measured ones"},
    {"points of class 7", FormatUse::noted, "of class 7, low noise, and taken like others"},
    {"points of class 18", FormatUse::noted, "of class 18, high noise, and taken like others"},
    {"key-points and overlap", FormatUse::read, "points like others"},
    {"waveforms", FormatUse::noted, "points are read without them"},
    {"extra bytes ObjectId", FormatUse::read, "objects of points, if unsigned, without scale and offset"},
    {"other extra bytes ObjectId", FormatUse::noted,
     "objects are read as unsigned numbers without scale and offset only"},
    {"two numbers of points", FormatUse::noted, "that of LAS 1.4 is taken, not the legacy one"},
    {"steps below 1e-5", FormatUse::noted, "metres are assumed, but without a reference system these may be degrees"},
    {"LASF_Projection 2111", FormatUse::refused, "points that need no transform (OGC Math Transform WKT)"},
    {"LASF_Projection 2112, liblas 2112", FormatUse::read, "reference system as well-known text, for its units"},
    {"LASF_Projection 34735, LASF_Projection 34736, LASF_Projection 34737", FormatUse::read,
     "reference system as GeoTIFF keys, if there is no text"},
    {"lascompatible 22204", FormatUse::noted, "classes above 31 are in extra bytes; laszip restores them"},
    {"LAZ compressor 1", FormatUse::refused, "chunks of points, as by laszip"},
    {"LAZ compressor 2", FormatUse::read, "chunks of points of formats 0 to 3"},
    {"LAZ compressor 3", FormatUse::read, "chunks of layers of formats 6 to 10, also of COPC"},
    {"LAZ item of version 1", FormatUse::refused, "version 2 or later, as by laszip"},
    {"LAZ item of version 2, LAZ item of version 3, LAZ item of version 4", FormatUse::read, "points"},
    {"LAZ wave packet of version 1", FormatUse::refused, "formats 0 to 3 or 6 to 10, as by las2las"},
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
