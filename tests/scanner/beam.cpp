// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scanner/beam.hpp>

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

TEST_CASE("a beam from a point is a cone of half its divergence") {
  const Laser laser{.divergence = 2_mrad};
  CHECK(beam_radius(laser, 0) == Vec2{0, 0});
  CHECK(beam_radius(laser, 100).x == support::relative(0.1, 1e-15));
  CHECK(beam_radius(laser, 100).y == support::relative(0.1, 1e-15));
  CHECK(beam_radius(Laser{.divergence = {1_mrad, 3_mrad}}, 100).x == support::relative(0.05, 1e-15));
  CHECK(beam_radius(Laser{.divergence = {1_mrad, 3_mrad}}, 100).y == support::relative(0.15, 1e-15));
}

TEST_CASE("a beam with a waist is narrowest there, and a cone far from it") {
  const Laser laser{.divergence = 1_mrad, .waist_diameter = 6_mm, .waist_range = 20};
  CHECK(beam_radius(laser, 20).x == support::relative(3_mm, 1e-15));
  CHECK(beam_radius(laser, 26).x == support::relative(std::sqrt(2.0) * 3_mm, 1e-14));  // one Rayleigh length on
  CHECK(beam_radius(laser, 14).x == beam_radius(laser, 26).x);
  CHECK(beam_radius(laser, 1e6).x == support::relative(0.5_mrad * 1e6, 1e-4));
}

TEST_CASE("the divergence of a beam follows from its waist, its wavelength and its quality, by hand") {
  // 4 * 1.064e-6 m / (pi * 5e-3 m) = 0.2709454 mrad
  const Laser perfect = gaussian_beam({.diameter = 5_mm}, Laser{.wavelength = 1064_nm});
  CHECK(perfect.divergence.across == support::relative(0.2709454e-3, 1e-6));
  CHECK(perfect.divergence.up == perfect.divergence.across);
  CHECK(perfect.waist_diameter == support::relative(5_mm, 1e-14));
  CHECK(perfect.waist_range == 0);
  CHECK(beam_quality(perfect) == support::relative(1, 1e-14));
  const Laser real = gaussian_beam({.diameter = 5_mm, .quality = 2.5}, Laser{.wavelength = 1064_nm});
  CHECK(real.divergence.across == support::relative(2.5 * perfect.divergence.across, 1e-14));
  CHECK(beam_quality(real) == support::relative(2.5, 1e-14));
}

TEST_CASE("a focused beam has Carlsson's radius at every range") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const BeamExit exit{.diameter = any.log_uniform(1e-3, 0.1),
                        .focus = (any.coin() ? 1 : -1) * any.log_uniform(1, 1e4),
                        .quality = any.log_uniform(1, 20)};
    const Laser laser = gaussian_beam(exit, Laser{.wavelength = any.log_uniform(0.4e-6, 2e-6)});
    CHECK(beam_quality(laser) == support::relative(exit.quality, 1e-12));
    for (const double range : {0.0, any.log_uniform(0.1, 1e4), std::fabs(exit.focus)}) {
      const double w0 = exit.diameter / 2, omega = exit.quality * laser.wavelength * range / (pi * w0 * w0);
      const double expected = w0 * std::hypot(1 - range / exit.focus, omega);
      CHECK(std::fabs(beam_radius(laser, range).x - expected) < 1e-9 * (w0 + expected));
    }
    CHECK(std::fabs(laser.waist_range) <= std::fabs(exit.focus));
    CHECK((laser.waist_range > 0) == (exit.focus > 0));
  }
}

TEST_CASE("a laser that leaves by an exit keeps all that is not the exit's") {
  const Laser laser{.wavelength = 905_nm, .peak_power = 75, .pulse_length = 5_ns};
  Laser gaussian = gaussian_beam({}, laser);
  gaussian.divergence = laser.divergence;
  gaussian.waist_diameter = 0;
  CHECK(gaussian == laser);
}

TEST_CASE("an exit refuses what no optics can do") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  CHECK_NOTHROW(BeamExit{}.validate());
  CHECK_NOTHROW(BeamExit{.focus = -infinity}.validate());
  for (const double bad : {0.0, -1.0, nan, infinity})
    CHECK_THROWS_AS(BeamExit{.diameter = bad}.validate(), SettingError);
  for (const double bad : {0.0, nan}) CHECK_THROWS_AS(BeamExit{.focus = bad}.validate(), SettingError);
  for (const double bad : {0.99, nan, infinity}) CHECK_THROWS_AS(BeamExit{.quality = bad}.validate(), SettingError);
  CHECK_THROWS_AS((void)gaussian_beam({}, Laser{.wavelength = 0}), SettingError);
}
