// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_SPATIAL_REFERENCE_HPP
#define PULSECAST_IO_SPATIAL_REFERENCE_HPP

#include <cstdint>
#include <string>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Reference system that a file names. Coordinates are in metres here; files have them in its units.
struct SpatialReference {
  std::uint16_t epsg = 0;           ///< EPSG code of the horizontal system, or of a compound one; 0: unknown
  std::uint16_t vertical_epsg = 0;  ///< EPSG code of the vertical system; 0: unknown
  double unit = 1;                  ///< unit of x and y in files [m]
  double vertical_unit = 1;         ///< unit of z in files [m]
  std::string wkt = {};             ///< OGC well-known text; empty: unknown

  friend bool operator==(const SpatialReference&, const SpatialReference&) = default;
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
