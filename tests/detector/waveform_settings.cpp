// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/waveform_settings.hpp>

#include <limits>

#include <doctest/doctest.h>

#include <pulsecast/detector/radiometry.hpp>

using namespace pulsecast;

TEST_CASE("settings of a waveform that cannot be are refused") {
  CHECK_NOTHROW(WaveformSettings{}.validate());
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1e-9, nan, infinity}) {
    CHECK_THROWS_AS(WaveformSettings{.sample_interval = bad}.validate(), SettingError);
    CHECK_THROWS_AS(WaveformSettings{.shape_divisor = bad}.validate(), SettingError);
  }
  for (const double bad : {0.99, 10.1})
    CHECK_THROWS_AS(WaveformSettings{.shape_divisor = bad}.validate(), SettingError);
  for (const double good : {1.0, 10.0}) CHECK_NOTHROW(WaveformSettings{.shape_divisor = good}.validate());
  for (const double bad : {-1e-9, nan, infinity}) {
    CHECK_THROWS_AS(WaveformSettings{.threshold = bad}.validate(), SettingError);
    CHECK_THROWS_AS(WaveformSettings{.separation = bad}.validate(), SettingError);
    CHECK_THROWS_AS(WaveformSettings{.window = bad}.validate(), SettingError);
    CHECK_THROWS_AS(WaveformSettings{.dead_time = bad}.validate(), SettingError);
    CHECK_THROWS_AS(WaveformSettings{.record_length = bad}.validate(), SettingError);
  }
  CHECK_THROWS_AS(WaveformSettings{.returns_max = 0}.validate(), SettingError);
  CHECK_THROWS_AS(WaveformSettings{.returns_max = 256}.validate(), SettingError);
}

TEST_CASE("a record has as many samples as begin in its length") {
  CHECK(WaveformSettings{}.record_capacity() == 0);
  CHECK(WaveformSettings{.sample_interval = 1, .record_length = 10}.record_capacity() == 10);
  CHECK(WaveformSettings{.sample_interval = 1, .record_length = 10.5}.record_capacity() == 11);
}

TEST_CASE("peaks are one if they are closer than the separation, or than window and pulse") {
  CHECK(WaveformSettings{.separation = 3, .window = 1}.min_separation(4) == 3);
  CHECK(WaveformSettings{.separation = 3, .window = 9}.min_separation(4) == 4);
  CHECK(WaveformSettings{.window = 1}.min_separation(4) == 1);
  CHECK(WaveformSettings{.window = 0}.min_separation(4) == 0);
}

TEST_CASE(
    "the default threshold is of more than ten photons of a default laser: a target of 20 % is found at 1 km, and not "
    "at 3 km") {
  const Laser laser;
  const LinkBudget budget(Receiver{}, laser);
  const double photon = 6.62607015e-34 * 299'792'458 / laser.wavelength;
  CHECK(WaveformSettings{}.threshold * laser.pulse_length > 10 * photon);
  CHECK(budget.power(1, 0.2, 1000) > WaveformSettings{}.threshold);
  CHECK(budget.power(1, 0.2, 3000) < WaveformSettings{}.threshold);
}
