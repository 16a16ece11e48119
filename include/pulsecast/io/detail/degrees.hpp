// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_DEGREES_HPP
#define PULSECAST_IO_DETAIL_DEGREES_HPP

#include <algorithm>
#include <cmath>

#include <pulsecast/base/error.hpp>
#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Question about a raster whose place and pixels may be in degrees; empty for others. Rasters in degrees have pixels
/// of 0.0083 degrees or less as a rule. Source: USGS, GTOPO30 documentation (30 arc seconds).
[[nodiscard]] inline std::string degrees_question(const Raster& raster) {
  const Vec2 last = raster.first + Vec2(raster.columns * raster.pixel.x, -(raster.rows * raster.pixel.y));
  const bool on_globe = std::max(std::fabs(raster.first.x), std::fabs(last.x)) <= 360 &&
                        std::max(std::fabs(raster.first.y), std::fabs(last.y)) <= 91;
  if (!on_globe || raster.pixel.x >= 0.01) return {};
  return "has pixels of " + text::to_text(raster.pixel.x) + " m at (" + text::to_text(raster.first.x) + ", " +
         text::to_text(raster.first.y) + "): is it in degrees? Expected metres";
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
