// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SENSOR_VELODYNE_HPP
#define PULSECAST_SENSOR_VELODYNE_HPP

#include <pulsecast/sensor/spinning_sensor.hpp>

namespace PULSECAST_NAMESPACE {

/// Velodyne VLP-16, which spins 5 to 20 times a second. Axes as in its manual: y forward, at
/// azimuth 0, and x right. Source: Velodyne, VLP-16 user manual 63-9243 rev. D, 2018, table 9-1,
/// 9.3.1.1 (times) and data sheet. Of the accuracy of 3 cm, 2 cm are taken as noise; the divergence
/// is the geometric mean of 3.0 and 1.2 mrad, and the shortest range the customary one.
[[nodiscard]] inline SpinningSensor velodyne_vlp_16(double rotation_rate = 10) {
  using namespace literals;
  constexpr std::array<double, 16> heights_mm{11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                              5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};
  const Laser beam{.wavelength = 903_nm, .peak_power = 31, .pulse_length = 6_ns, .divergence = 1.9_mrad};
  SpinningSensor sensor{.name = "VLP-16",
                        .sequence_rate = 1 / 55.296e-6,
                        .rotation_rate = rotation_rate,
                        .beam = beam,
                        .range_min = 0.5,
                        .range_max = 100,
                        .range_deviation = 2_cm};
  for (std::size_t k = 0; k < 16; ++k) {
    const double number = static_cast<double>(k), low = k % 2 == 0 ? -15_deg : 0;
    sensor.lasers.push_back({low + number * 1_deg, 0, 1e-3 * heights_mm[k], number * 2.304e-6});
  }
  return sensor;
}

/// Velodyne VLP-32C, whose lasers fire two at a time; the rest is as for the VLP-16. Source:
/// Velodyne, VLP-32C user manual 63-9325 rev. C, 2019, table of lasers and data sheet.
[[nodiscard]] inline SpinningSensor velodyne_vlp_32c(double rotation_rate = 10) {
  using namespace literals;
  constexpr std::array<std::pair<double, double>, 32> rows{
      // elevation and azimuth [deg]
      {{-25, 1.4},     {-1, -4.2},    {-1.667, 1.4},  {-15.639, -1.4}, {-11.31, 1.4},  {0, -1.4},      {-0.667, 4.2},
       {-8.843, -1.4}, {-7.254, 1.4}, {0.333, -4.2},  {-0.333, 1.4},   {-6.148, -1.4}, {-5.333, 4.2},  {1.333, -1.4},
       {0.667, 4.2},   {-4, -1.4},    {-4.667, 1.4},  {1.667, -4.2},   {1, 1.4},       {-3.667, -4.2}, {-3.333, 4.2},
       {3.333, -1.4},  {2.333, 1.4},  {-2.667, -1.4}, {-3, 1.4},       {7, -1.4},      {4.667, 1.4},   {-2.333, -4.2},
       {-2, 4.2},      {15, -1.4},    {10.333, 1.4},  {-1.333, -1.4}}};
  SpinningSensor sensor = velodyne_vlp_16(rotation_rate);
  sensor.name = "VLP-32C";
  sensor.beam.divergence = 2.1_mrad;
  sensor.range_min = 1;
  sensor.range_max = 200;
  for (const SensorLaser& firing : std::exchange(sensor.lasers, {}))
    for (int laser = 0; laser < 2; ++laser) {
      const auto [elevation, azimuth] = rows[sensor.lasers.size()];
      sensor.lasers.push_back({elevation * 1_deg, azimuth * 1_deg, 0, firing.delay});
    }
  return sensor;
}

}  // namespace PULSECAST_NAMESPACE

#endif
