// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/hillshade.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <pulsecast/base/units.hpp>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

/// A plane that rises by `east` to the east and by `north` to the north, in pixels of 2 m by 4 m.
Raster plane(double east, double north) {
  Raster raster{.columns = 7, .rows = 6, .first = {100, 200}, .pixel = {2, 4}};
  for (std::uint32_t r = 0; r < 6; ++r)
    for (std::uint32_t c = 0; c < 7; ++c)
      raster.heights.push_back(static_cast<float>(1000 + 2.0 * c * east - 4.0 * r * north));
  return raster;
}

/// Shade of a plane, from its normal and the direction of the sun by azimuth and elevation.
std::uint8_t expected(double east, double north, const HillshadeSettings& s) {
  const Vec3 normal = normalize(Vec3{-east * s.vertical_scale, -north * s.vertical_scale, 1});
  const Vec3 sun{std::sin(s.azimuth) * std::cos(s.elevation), std::cos(s.azimuth) * std::cos(s.elevation),
                 std::sin(s.elevation)};
  return static_cast<std::uint8_t>(1 + std::lround(254 * std::max(0.0, dot(normal, sun))));
}

}  // namespace

TEST_CASE("a plane has the cosine of incidence everywhere, at its edges too") {
  for (const double east : {0.0, 0.5, -1.0, 2.0})
    for (const double north : {0.0, 0.25, -2.0})
      for (const double azimuth : {0.0, 1.0, 3.0, 5.5})
        for (const double elevation : {0.0, 0.3, 1.2, pi / 2})
          for (const double exaggeration : {1.0, 3.0}) {
            const HillshadeSettings settings{
                .azimuth = azimuth, .elevation = elevation, .vertical_scale = exaggeration};
            const std::vector<std::uint8_t> found = hillshade(plane(east, north), settings);
            CHECK(found == std::vector<std::uint8_t>(42, expected(east, north, settings)));
          }
}

TEST_CASE("level ground is as bright as the sun is high, and a slope that faces the sun is white") {
  CHECK(hillshade(plane(0, 0), {.elevation = 90_deg})[0] == 255);
  CHECK(hillshade(plane(0, 0), {.elevation = 30_deg})[0] == 128);
  CHECK(hillshade(plane(0, 0), {.elevation = 0})[0] == 1);
  CHECK(hillshade(plane(1, 0), {.azimuth = 270_deg, .elevation = 45_deg})[0] == 255);  // rises to the east, faces west
  CHECK(hillshade(plane(1, 0), {.azimuth = 90_deg, .elevation = 45_deg})[0] == 1);
  CHECK(hillshade(plane(0, -1), {.azimuth = 0, .elevation = 45_deg})[0] == 255);  // falls to the north, faces it
  CHECK(hillshade(plane(0, -1), {.azimuth = 180_deg, .elevation = 45_deg})[0] == 1);
}

TEST_CASE("a missing pixel is 0, and a plane about it stays a plane") {
  Raster raster = plane(0.5, 0.25);
  raster.heights[2 * 7 + 3] = missing;
  std::vector<std::uint8_t> shades(42, expected(0.5, 0.25, {}));
  shades[2 * 7 + 3] = 0;
  CHECK(hillshade(raster) == shades);
  raster.heights.assign(42, missing);
  raster.heights[8] = 5;
  shades.assign(42, 0);
  shades[8] = expected(0, 0, {});
  CHECK(hillshade(raster) == shades);
}

TEST_CASE("the slope in the middle of nine pixels is that of Horn") {
  Raster raster{.columns = 3, .rows = 3, .pixel = {2, 3}, .heights = {1, 5, 2, 4, 9, 7, 3, 8, 6}};
  const double east = ((2 + 2 * 7 + 6) - (1 + 2 * 4 + 3)) / (8 * 2.0),
               north = ((1 + 2 * 5 + 2) - (3 + 2 * 8 + 6)) / (8 * 3.0);
  const HillshadeSettings low{.azimuth = 2, .elevation = 0.4};
  CHECK(hillshade(raster, low)[4] == expected(east, north, low));
}

TEST_CASE("packed heights have the shades of the same heights in floating point") {
  support::Generator random(5);
  Raster packed{.columns = 40, .rows = 30, .packed = {.scale = 0.1, .missing = 7}};
  for (std::size_t i = 0; i < packed.pixels(); ++i)
    packed.packed.numbers.push_back(static_cast<std::uint16_t>(random.whole(12)));
  CHECK(hillshade(packed) == hillshade(packed.unpacked()));
}

TEST_CASE("suns that cannot be are refused") {
  const auto refused = [](const HillshadeSettings& s) {
    try {
      (void)hillshade(plane(0, 0), s);
      return std::string();
    } catch (const SettingError& error) {
      return std::string(error.what());
    }
  };
  CHECK(refused({.elevation = -0.1}).find("HillshadeSettings::elevation") == 0);
  CHECK(refused({.azimuth = 315}).find("HillshadeSettings::azimuth") == 0);
  CHECK(refused({.vertical_scale = 0}).find("HillshadeSettings::vertical_scale") == 0);
}
