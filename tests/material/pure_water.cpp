// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/pure_water.hpp>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <string>

#include <doctest/doctest.h>

#include "support/relative.hpp"

using namespace pulsecast;
using support::relative;

namespace {
const double nan_value = std::numeric_limits<double>::quiet_NaN();
const WaterState fresh{.temperature_celsius = 20, .salinity_permille = 0};
}  // namespace

TEST_CASE("the index of water is that of the tables") {
  CHECK(std::fabs(water_index(589.26e-9, fresh) - 1.33299) <
        3e-5);  // CRC Handbook: sodium's line, 20 degrees, relative to air
  // Austin & Halikas 1976: the extremes of temperature and salinity at both ends of the visible
  CHECK(std::fabs(water_index(400e-9, {0, 0}) - 1.344186) < 1e-4);
  CHECK(std::fabs(water_index(700e-9, {0, 0}) - 1.331084) < 1e-4);
  CHECK(std::fabs(water_index(400e-9, {0, 35}) - 1.351415) < 1e-4);
  CHECK(std::fabs(water_index(700e-9, {30, 35}) - 1.335316) < 1e-4);
}

TEST_CASE(
    "the indices of fresh water are those of a later measurement, close in the visible and less so in the infrared") {
  const auto measured = [](double um) {  // Daimon & Masumura 2007: distilled water at 20 degrees, relative to vacuum,
                                         // from 0.182 to 1.129 um
    const double w = um * um;
    return std::sqrt(1 + 5.684027565e-1 * w / (w - 5.101829712e-3) + 1.726177391e-1 * w / (w - 1.821153936e-2) +
                     2.086189578e-2 * w / (w - 2.620722293e-2) + 1.130748688e-1 * w / (w - 1.069792721e1));
  };
  const double air = 1.00027;
  for (const double um : {0.35, 0.4, 0.45, 0.532, 0.6328, 0.7, 0.8, 0.905, 1.064, 1.1}) {
    const double group = measured(um) - um * (measured(um + 1e-4) - measured(um - 1e-4)) / 2e-4;
    const bool visible = um >= 0.4 && um <= 0.7;
    CAPTURE(um);
    CHECK(std::fabs(water_index(um * 1e-6, fresh) - measured(um) / air) < (visible ? 3e-5 : 1.2e-3));
    CHECK(std::fabs(water_group_index(um * 1e-6, fresh) - group / air) < (visible ? 5e-4 : 6e-3));
  }
}

TEST_CASE("the group index of water is n - w dn/dw") {
  for (const WaterState state : {WaterState{}, fresh, WaterState{0, 35}, WaterState{30, 10}})
    for (const double w : {0.36e-6, 0.4e-6, 0.532e-6, 0.7e-6, 1.064e-6}) {
      const double step = 1e-10;
      const double slope = (water_index(w + step, state) - water_index(w - step, state)) / (2 * step);
      CHECK(water_group_index(w, state) == relative(water_index(w, state) - w * slope, 1e-8));
      CHECK(water_group_index(w, state) > water_index(w, state));
    }
}

TEST_CASE(
    "the absorption of pure water is that of the table, and linear between its rows but for the factor 1/wavelength") {
  CHECK(pure_water_absorption(1e-6) == relative(4 * std::numbers::pi * 2.9997851e-6 / 1e-6, 1e-3));
  CHECK(pure_water_absorption(0.97051e-6) ==
        relative(4 * std::numbers::pi * 3.5017904e-6 / 0.97051e-6, 1e-3));  // the strongest near 1 um
  CHECK(pure_water_absorption(1.4487719e-6) == relative(4 * std::numbers::pi * 3.6373923e-4 / 1.4487719e-6, 1e-3));
  const double middle = 0.5 * (1.0000e-6 + 1.0093e-6);
  CHECK(pure_water_absorption(middle) * middle ==
        relative((pure_water_absorption(1.0000e-6) * 1.0000e-6 + pure_water_absorption(1.0093e-6) * 1.0093e-6) / 2,
                 1e-12));
  CHECK(pure_water_absorption(0.8e-6) ==
        relative(4 * std::numbers::pi * 1.25e-7 / 0.8e-6, 0.02));  // Hale & Querry 1973
  CHECK(pure_water_absorption(1.2e-6) ==
        relative(4 * std::numbers::pi * 9.89e-6 / 1.2e-6, 0.25));  // Hale & Querry 1973
}

TEST_CASE("water out of the range of its formulas is refused") {
  for (const double bad : {0.349e-6, 1.101e-6, 532.0, 0.0, nan_value}) {
    CHECK_THROWS_AS((void)water_index(bad), SettingError);
    CHECK_THROWS_AS((void)water_group_index(bad), SettingError);
  }
  for (const double bad : {0.699e-6, 1.601e-6, 1064.0, nan_value})
    CHECK_THROWS_AS((void)pure_water_absorption(bad), SettingError);
  for (const double bad : {-0.1, 30.1, 293.0, nan_value}) {
    CHECK_THROWS_AS((void)water_index(532e-9, {.temperature_celsius = bad}), SettingError);
    CHECK_THROWS_AS((void)water_group_index(532e-9, {.temperature_celsius = bad}), SettingError);
  }
  for (const double bad : {-0.1, 35.1, nan_value})
    CHECK_THROWS_AS((void)water_index(532e-9, {.salinity_permille = bad}), SettingError);
  try {
    (void)water_index(532e-9, {.temperature_celsius = 293});
    FAIL("not refused");
  } catch (const SettingError& e) {
    CHECK(std::string(e.what()).find("WaterState::temperature_celsius") != std::string::npos);
    CHECK(std::string(e.what()).find("293") != std::string::npos);
  }
}
