// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/sensor/spinning_sensor.hpp>

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/units.hpp>

namespace pulsecast {
namespace {

using namespace literals;

SpinningSensor two_lasers() {
  return {.lasers = {{.elevation = 10_deg, .azimuth = 3_deg, .height = 0.01},
                     {.elevation = -5_deg, .height = -0.01, .delay = 20_us}},
          .sequence_rate = 10_kHz,
          .rotation_rate = 10,
          .exit_radius = 0.02};
}

TEST_CASE("a head spins to the right, and lasers leave it where and when the data sheet says") {
  const SpinningSensor sensor = two_lasers();
  const SpinningSource source = sensor.source(0.1);
  CHECK(source.size() == 2 * 1000);
  const auto first = source.pulse(0), second = source.pulse(1), quarter = source.pulse(2 * 250);
  REQUIRE((first && second && quarter));
  CHECK(first->tick == Tick{});
  CHECK(second->tick.seconds() == doctest::Approx(20e-6));
  CHECK(length(first->origin() - Vec3{0, 0.02, 0.01}) < 1e-15);
  const auto along = [](double azimuth, double elevation) {
    return Vec3{std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
  };
  CHECK(length(first->direction() - along(3_deg, 10_deg)) < 1e-14);
  CHECK(length(second->direction() - along(sensor.heading(second->tick), -5_deg)) < 1e-14);
  CHECK(sensor.heading(quarter->tick) == doctest::Approx(90_deg));
  CHECK(length(quarter->origin() - Vec3{0.02, 0, 0.01}) < 1e-15);
  CHECK(length(quarter->direction() - along(93_deg, 10_deg)) < 1e-14);
  CHECK(source.emitters()[1].channel == 1);
}

TEST_CASE("the slots from a time on begin with a firing sequence, and none is left out") {
  const SpinningSensor sensor = two_lasers();
  CHECK(sensor.slot_from({}) == 0);
  CHECK(sensor.slot_from(Tick::of_seconds(1e-9)) == 2);
  CHECK(sensor.slot_from(sensor.sequence_start(123'456)) == 2 * 123'456);
  CHECK(sensor.slot_from(Tick{3600, 0}) == 2 * 36'000'000);
}

TEST_CASE("rings are counted from below") { CHECK(two_lasers().rings() == std::vector<std::uint16_t>{1, 0}); }

TEST_CASE("data sheets out of range are refused") {
  SpinningSensor none = two_lasers();
  none.lasers.clear();
  CHECK_THROWS_WITH_AS(static_cast<void>(none.source(1)), doctest::Contains("SpinningSensor::lasers"), SettingError);
  SpinningSensor steep = two_lasers();
  steep.lasers[0].elevation = 2;
  CHECK_THROWS_WITH_AS(static_cast<void>(steep.source(1)), doctest::Contains("SensorLaser::elevation"), SettingError);
  CHECK_THROWS_WITH_AS(static_cast<void>(two_lasers().source(-1)), doctest::Contains("duration"), SettingError);
}

}  // namespace
}  // namespace pulsecast
