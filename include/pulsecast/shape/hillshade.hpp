// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_HILLSHADE_HPP
#define PULSECAST_SHAPE_HILLSHADE_HPP

#include <pulsecast/shape/raster.hpp>

namespace PULSECAST_NAMESPACE {

/// Light of a hillshade.
struct HillshadeSettings {
  double azimuth = 1.75 * pi;    ///< direction of the sun, clockwise from north [rad]
  double elevation = 0.25 * pi;  ///< of the sun above the horizon, from 0 to pi/2 [rad]
  double vertical_scale = 1;     ///< exaggeration of the heights

  void validate() const {
    require_angle("HillshadeSettings::azimuth", azimuth);
    require_within("HillshadeSettings::elevation", elevation, 0, pi / 2, "rad");
    require_positive("HillshadeSettings::vertical_scale", vertical_scale, "");
  }
};

namespace detail {
/// Height of a pixel [m]; NaN beyond the edge.
[[nodiscard]] double height_at(const auto& heights, const RasterGrid& grid, std::int64_t column,
                               std::int64_t row) noexcept {
  if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows)
    return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(heights[static_cast<std::size_t>(row * grid.columns + column)]);
}

/// Height of the pixel `east` columns and `south` rows from one of a height `own` [m]. If missing,
/// as on a plane through `own` and its opposite neighbour, or those to the sides; else level.
[[nodiscard]] double height_beside(const auto& at, double own, int east, int south) noexcept {
  if (const double height = at(east, south); !std::isnan(height)) return height;
  if (const double opposite = at(-east, -south); !std::isnan(opposite)) return 2 * own - opposite;
  if (east == 0 || south == 0) return own;
  return height_beside(at, own, east, 0) + height_beside(at, own, 0, south) - own;
}
}  // namespace detail

/// Brightness of the pixels of a raster in the light of a sun, row by row: from 1 in its own shade
/// to 255 where the sun is overhead, by the cosine of incidence; 0 where the height is missing. No
/// pixel casts a shadow on another. Source: Horn 1981, Hill shading and the reflectance map (slopes
/// of three neighbours on each side, weighted 1, 2, 1); values: GDAL manual, gdaldem hillshade.
/// @throws SettingError for settings out of range, and as `Raster::validate`
[[nodiscard]] inline std::vector<std::uint8_t> hillshade(const Raster& raster, const HillshadeSettings& settings = {}) {
  settings.validate();
  raster.validate();
  const detail::RasterGrid grid = raster.grid();
  const double level = std::cos(settings.elevation);
  const Vec3 sun{level * std::sin(settings.azimuth), level * std::cos(settings.azimuth), std::sin(settings.elevation)};
  std::vector<std::uint8_t> shades(raster.pixels(), 0);
  raster.read([&](const auto& heights) {
    for (std::uint32_t row = 0; row < grid.rows; ++row)
      for (std::uint32_t column = 0; column < grid.columns; ++column) {
        const auto at = [&](int east, int south) noexcept {
          return detail::height_at(heights, grid, std::int64_t{column} + east, std::int64_t{row} + south);
        };
        const double own = at(0, 0);
        if (std::isnan(own)) continue;
        const auto z = [&](int x, int y) noexcept { return detail::height_beside(at, own, x, y); };
        const auto column_sum = [&](int x) noexcept { return z(x, -1) + 2 * z(x, 0) + z(x, 1); };
        const auto row_sum = [&](int y) noexcept { return z(-1, y) + 2 * z(0, y) + z(1, y); };
        const double east = column_sum(1) - column_sum(-1), north = row_sum(-1) - row_sum(1);
        const double per_pixel = settings.vertical_scale / 8;
        const Vec3 up{-per_pixel * east / grid.pixel.x, -per_pixel * north / grid.pixel.y, 1};
        const double cosine = std::max(0.0, dot(normalize(up), sun));
        shades[grid.index(column, row)] = static_cast<std::uint8_t>(1 + std::lround(254 * cosine));
      }
  });
  return shades;
}

}  // namespace PULSECAST_NAMESPACE

#endif
