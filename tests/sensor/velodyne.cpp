// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/sensor/velodyne.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

namespace pulsecast {
namespace {

TEST_CASE("firings of a VLP-16 are at the times that its manual publishes, to a nanosecond after an hour") {
  const SpinningSensor sensor = velodyne_vlp_16();
  const SpinningSource source = sensor.source(3601);
  const PulseIndex sequence = 65'104'166;  // one of the hour's last
  for (PulseIndex laser = 0; laser < 16; ++laser) {
    const auto pulse = source.pulse(16 * sequence + laser);
    REQUIRE(pulse);
    const long double expected =
        55.296e-6L * static_cast<long double>(sequence) + 2.304e-6L * static_cast<long double>(laser);
    CHECK(std::fabs(static_cast<double>(expected - static_cast<long double>(pulse->tick.seconds()))) < 1e-9);
  }
}

TEST_CASE("lasers of a VLP-16 hop from below the horizon to above it, 2 degrees apart") {
  const SpinningSensor sensor = velodyne_vlp_16();
  std::vector<double> elevations;
  for (const SensorLaser& laser : sensor.lasers)
    elevations.push_back(std::round(laser.elevation * 180 / pi * 1e9) / 1e9);
  CHECK(elevations == std::vector<double>{-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15});
  CHECK(sensor.rings() == std::vector<std::uint16_t>{0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15});
}

TEST_CASE("lasers of a VLP-32C fire in pairs, each at an elevation of its own") {
  const SpinningSensor sensor = velodyne_vlp_32c();
  REQUIRE(sensor.lasers.size() == 32);
  CHECK(sensor.lasers[1].delay == 0);
  CHECK(sensor.lasers[31].delay == doctest::Approx(15 * 2.304e-6));
  std::vector<std::uint16_t> rings = sensor.rings();
  std::sort(rings.begin(), rings.end());
  for (std::uint16_t k = 0; k < 32; ++k) CHECK(rings[k] == k);
}

}  // namespace
}  // namespace pulsecast
