// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/units.hpp>

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

// Each literal is the double that is nearest to what is written, as if it had been written in SI.
static_assert(100_kHz == 1e5 && 1.5_kHz == 1500.0 && 40_Hz == 40.0 && 12.5_Hz == 12.5 && 2_MHz == 2e6 &&
              0.3_MHz == 0.3e6);
static_assert(0.3_mrad == 0.3e-3 && 3_mrad == 3e-3 && 2_rad == 2.0 && 0.5_rad == 0.5);
static_assert(5_mm == 5e-3 && 0.1_mm == 0.1e-3 && 7_cm == 7e-2 && 1.1_cm == 1.1e-2 && 2_m == 2.0 && 2.5_m == 2.5);
static_assert(3_km == 3e3 && 0.7_km == 0.7e3 && 1_um == 1e-6 && 1.55_um == 1.55e-6 && 1064_nm == 1064e-9 &&
              532.1_nm == 532.1e-9);
static_assert(9_s == 9.0 && 0.5_s == 0.5 && 3_ms == 3e-3 && 0.7_ms == 0.7e-3 && 6_us == 6e-6 && 0.9_us == 0.9e-6);
static_assert(4_ns == 4e-9 && 3.5_ns == 3.5e-9);
static_assert(4_W == 4.0 && 0.5_W == 0.5 && 7_mW == 7e-3 && 0.7_mW == 0.7e-3 && 11_nW == 11e-9 && 0.1_nW == 0.1e-9);
static_assert(180_deg == std::numbers::pi && 90_deg == std::numbers::pi / 2 && 0.0_deg == 0.0 &&
              45.0_deg == std::numbers::pi / 4);
static_assert(1_deg == 0.017453292519943295769 && 20_deg == 0.34906585039886591538 &&
              0.1_deg == 0.0017453292519943295769);
static_assert(-20_deg == -0.34906585039886591538);
static_assert(speed_of_light == 299792458.0);

TEST_CASE("degrees and radians undo each other") {
  CHECK(radians(180) == std::numbers::pi);
  CHECK(radians(-90) == -std::numbers::pi / 2);
  CHECK(degrees(std::numbers::pi) == 180);
  for (double angle_deg = -720; angle_deg <= 720; angle_deg += 7.3)
    CHECK(degrees(radians(angle_deg)) == support::relative(angle_deg, 1e-15));
}

TEST_CASE("a literal in degrees says the same as the conversion") {
  CHECK(20_deg == support::relative(radians(20), 1e-15));
  CHECK(0.5_deg == support::relative(radians(0.5), 1e-15));
}

TEST_CASE("a metre is fallen in the time of the textbook") {
  CHECK(std::sqrt(2 / standard_gravity) == doctest::Approx(0.4516).epsilon(1e-4));
}
