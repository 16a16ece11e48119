// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_HILLSHADE_HPP
#define PULSECAST_SHAPE_HILLSHADE_HPP

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>
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

/// Heights about a pixel [m]. What is missing, or beyond the edge, is as on a plane through the pixel and its opposite
/// neighbour, or its neighbours to the sides; level without these.
template <class Heights>
class PixelSurroundings {
 public:
  PixelSurroundings(const Heights& heights, const RasterGrid& grid, std::uint32_t column, std::uint32_t row) noexcept
      : heights_(heights), grid_(grid), column_(column), row_(row), own_(at(0, 0)) {}

  [[nodiscard]] double own() const noexcept { return own_; }

  /// Height of the pixel `east` columns and `south` rows away.
  [[nodiscard]] double operator()(int east, int south) const noexcept {
    const double height = at(east, south);
    if (!std::isnan(height)) return height;
    const double opposite = at(-east, -south);
    if (!std::isnan(opposite)) return 2 * own_ - opposite;
    return east == 0 || south == 0 ? own_ : (*this)(east, 0) + (*this)(0, south) - own_;
  }

 private:
  [[nodiscard]] double at(int east, int south) const noexcept {
    const std::int64_t column = std::int64_t{column_} + east, row = std::int64_t{row_} + south;
    if (column < 0 || row < 0 || column >= grid_.columns || row >= grid_.rows)
      return std::numeric_limits<double>::quiet_NaN();
    return static_cast<double>(
        heights_[grid_.index(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row))]);
  }

  const Heights& heights_;
  const RasterGrid& grid_;
  std::uint32_t column_, row_;
  double own_;
};

}  // namespace detail

/// Brightness of the pixels of a raster in the light of a sun, row by row: from 1 in its own shade to 255 where the sun
/// is overhead, in proportion to the cosine of incidence; 0 where the height is missing. No pixel casts a shadow on
/// another. Source: Horn 1981, Hill shading and the reflectance map (slopes by differences of three neighbours on each
/// side, weighted 1, 2, 1); range of values: GDAL manual, gdaldem hillshade.
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
        const detail::PixelSurroundings z(heights, grid, column, row);
        if (std::isnan(z.own())) continue;
        const double east = (z(1, -1) + 2 * z(1, 0) + z(1, 1)) - (z(-1, -1) + 2 * z(-1, 0) + z(-1, 1));
        const double north = (z(-1, -1) + 2 * z(0, -1) + z(1, -1)) - (z(-1, 1) + 2 * z(0, 1) + z(1, 1));
        const double per_pixel = settings.vertical_scale / 8;
        const Vec3 normal = normalize(Vec3{-per_pixel * east / grid.pixel.x, -per_pixel * north / grid.pixel.y, 1});
        shades[grid.index(column, row)] =
            static_cast<std::uint8_t>(1 + std::lround(254 * std::max(0.0, dot(normal, sun))));
      }
  });
  return shades;
}

}  // namespace PULSECAST_NAMESPACE

#endif
