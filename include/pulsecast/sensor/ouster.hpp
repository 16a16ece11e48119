// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SENSOR_OUSTER_HPP
#define PULSECAST_SENSOR_OUSTER_HPP

#include <pulsecast/sensor/spinning_sensor.hpp>

namespace PULSECAST_NAMESPACE {

/// Ouster OS1 with 64 evenly spaced lasers, the uppermost first, which fire together: 512, 1024 or
/// 2048 columns a turn, 10 or 20 turns a second, 2048 columns 10. The origin is that of the sensor's frame in its
/// manual, whose forward is ours: the head starts backwards, at encoder 0. Source: Ouster, OS1 data sheet, rev. 7,
/// 2023, and software user manual, 2.x, lidar coordinate frame: lenses 15.806 mm from the axis, 36.180 mm above the
/// base. Noise of 1 cm of the 0.5 to 3 cm published; pulse length typical of the class. Left out: the azimuth offsets
/// of a unit, `SensorLaser::azimuth`.
[[nodiscard]] inline SpinningSensor ouster_os1_64(std::size_t columns = 1024, double rotation_rate = 10) {
  using namespace literals;
  const bool has_mode = columns == 512 || columns == 1024 || (columns == 2048 && rotation_rate == 10);
  if (!has_mode || (rotation_rate != 10 && rotation_rate != 20))
    throw_setting_error("ouster_os1_64 (columns)", static_cast<double>(columns), "",
                        text::joined({"512 or 1024 at 10 or 20 turns a second, or 2048 at 10; these are ",
                                      text::to_text(rotation_rate)}));
  SpinningSensor sensor{.name = "OS-1-64",
                        .sequence_rate = static_cast<double>(columns) * rotation_rate,
                        .rotation_rate = rotation_rate,
                        .start = pi,
                        .exit_radius = 15.806_mm,
                        .beam = {.wavelength = 865_nm, .pulse_length = 6_ns, .divergence = 5.3_mrad},
                        .range_min = 0.5,
                        .range_max = 170,
                        .range_deviation = 1_cm};
  for (std::size_t k = 0; k < 64; ++k)
    sensor.lasers.push_back({.elevation = 21.2_deg - static_cast<double>(k) * 42.4_deg / 63, .height = 36.180_mm});
  return sensor;
}

}  // namespace PULSECAST_NAMESPACE

#endif
