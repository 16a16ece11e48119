// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PNG_SETTINGS_HPP
#define PULSECAST_IO_DETAIL_PNG_SETTINGS_HPP

#include <cstddef>
#include <cstdint>
#include <optional>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/colour.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Meaning of a point's colour.
enum class ColourBy : std::uint8_t { height, intensity, object, classification, return_number, kind };

/// Settings of a picture.
struct ImageSettings {
  int width = 1600;              ///< width of the picture [px]
  int height = 900;              ///< height of the picture [px]
  double azimuth = radians(30);  ///< viewing direction, clockwise from north [rad]
  double elevation = radians(
      30);  ///< viewing direction below the horizon; a quarter turn with azimuth 0 gives a map with north up [rad]
  double field_of_view = radians(30);  ///< angle across the scene, approximate; 0 for a parallel projection [rad]
  std::optional<Vec3>
      eye{};  ///< position of the camera, field of view across the width; if empty, chosen to frame all points [m]
  ColourBy colour_by = ColourBy::height;  ///< meaning of the colours
  double point_size = 0;                  ///< diameter in the middle of the scene; 0 to close the gaps [px]
  Srgb background{13, 17, 23};            ///< colour of the background
  std::size_t points_max = 3'000'000;     ///< maximum to draw; of more, every k-th

  void validate() const {
    require_within("ImageSettings::width", width, 1, 4096, "px");
    require_within("ImageSettings::height", height, 1, 4096, "px");
    require_angle("ImageSettings::azimuth", azimuth);
    require_within("ImageSettings::elevation", elevation, -pi / 2, pi / 2, "rad");
    require_within("ImageSettings::field_of_view", field_of_view, eye ? radians(1) : 0, radians(120), "rad");
    if (eye) require_finite("ImageSettings::eye (length)", length(*eye), "m");
    require_within("ImageSettings::point_size", point_size, 0, 64, "px");
    require_within("ImageSettings::points_max", static_cast<double>(points_max), 2, 1e8, "");
  }
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
