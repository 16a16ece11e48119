// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_SPATIAL_REFERENCE_HPP
#define PULSECAST_IO_SPATIAL_REFERENCE_HPP

#include <functional>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Reference system that a file names. Coordinates are in metres here; files have them in its units.
struct SpatialReference {
  std::uint16_t epsg = 0;           ///< EPSG code of the horizontal system, or of a compound one; 0: unknown
  std::uint16_t vertical_epsg = 0;  ///< EPSG code of the vertical system; 0: unknown
  double unit = 1;                  ///< unit of x and y in files [m]
  double vertical_unit = 1;         ///< unit of z in files [m]
  std::string wkt = {};             ///< OGC well-known text; empty: unknown

  void validate() const {
    for (const std::uint16_t code : {epsg, vertical_epsg})
      if (code != 0) require_within("SpatialReference, EPSG code", code, 1024, 32766, "");  // source: OGC GeoTIFF 1.1
    for (const double one : {unit, vertical_unit}) require_within("SpatialReference::unit", one, 1e-9, 1e6, "m");
  }

  friend bool operator==(const SpatialReference&, const SpatialReference&) = default;
};

/// Place on a map.
struct MapPoint {
  Vec2 place{};            ///< east and north [m]
  double convergence = 0;  ///< direction of true north, clockwise from grid north [rad]
};

/// Place on a map of a longitude and a latitude [deg], as by `map_projector`. Heights are kept.
using MapProjector = std::function<MapPoint(double longitude, double latitude)>;

namespace detail {

/// `complete_reference` in a program that includes `io/reference.hpp`, else null: readers ask it for the units of
/// systems that files name by codes alone. Set before `main`.
inline SpatialReference (*reference_database)(const SpatialReference& codes, const std::string& name) = nullptr;

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE::io

#endif
