// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/smooth_interface.hpp>

#include <doctest/doctest.h>

using namespace pulsecast;

TEST_CASE("surfaces pass on what their kind does") {
  CHECK_FALSE(SmoothInterface{}.passes_light());
  CHECK(SmoothInterface::mirror().keeps_pencils());
  CHECK(SmoothInterface::pane().keeps_pencils());
  CHECK(SmoothInterface::glass().passes_light());
  CHECK_FALSE(SmoothInterface::glass().keeps_pencils());
  CHECK(SmoothInterface::mirror(0.7).reflectance == 0.7);
  CHECK(SmoothInterface::pane(0.01).thickness == 0.01);
}

TEST_CASE("the glass of panes and bodies is that of windows, at 1.064 um") {
  // Source: Rubin 1985, n = 1.5130 - 0.003169 l^2 + 0.003962 / l^2, l in um; group index n - l dn/dl
  const double l = 1.064, n = 1.5130 - 0.003169 * l * l + 0.003962 / (l * l),
               slope = -2 * 0.003169 * l - 2 * 0.003962 / (l * l * l);
  CHECK(SmoothInterface::glass().inside.index == doctest::Approx(n).epsilon(1e-4));
  CHECK(SmoothInterface::pane().inside.group_index == doctest::Approx(n - l * slope).epsilon(1e-4));
}

TEST_CASE("surfaces that cannot be are refused") {
  CHECK_THROWS_AS(SmoothInterface::mirror(1.1).validate(), SettingError);
  CHECK_THROWS_AS(SmoothInterface::pane(-1).validate(), SettingError);
  CHECK_THROWS_AS((SmoothInterface{.inside = {.index = 0.5}}.validate()), SettingError);
}
