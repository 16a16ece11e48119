// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PNG_HEIGHTS_RULES_HPP
#define PULSECAST_IO_DETAIL_PNG_HEIGHTS_RULES_HPP

#include <array>

#include <pulsecast/io/format_rules.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Chunks of PNG files of heights. Source: PNG, second edition (ISO/IEC 15948), 11.3; PNG extensions 1.4.
inline constexpr std::array<FormatRule, 5> png_rules{{
    {"tRNS", FormatUse::refused, "no transparent grey: that of missing heights is a setting"},
    {"pCAL", FormatUse::refused, "no calibration of its numbers: scale and offset are settings"},
    {"sCAL", FormatUse::refused, "no scale of its pixels: a world file or a setting tells their size"},
    {"oFFs", FormatUse::refused, "no offset of its pixels: a world file or a setting tells their place"},
    {"acTL", FormatUse::refused, "one picture, not an animation"},
}};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
