// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/retroreflector.hpp>

#include <cmath>

#include <doctest/doctest.h>

#include <pulsecast/material/material.hpp>

#include "support/relative.hpp"
#include "support/scattering_laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(ScattersBetween<Retroreflector<>> && Retroreflects<Retroreflector<CubeCorners>>);

namespace {
constexpr double nir = 1.064e-6;
}

TEST_CASE("a retroreflector has its coefficient at normal incidence, and half of its light at its half angle") {
  Material m{.reflectance = 0.1, .law = Retroreflector<Beads>{.coefficient = 70, .optics = {30_deg}}};
  CHECK(m.backscatter(1, nir) == support::relative(0.1 + 70 * pi, 1e-13));
  CHECK(m.backscatter(std::cos(30_deg), nir) == support::relative(0.1 * std::cos(30_deg) + 35 * pi, 1e-13));
  CHECK(m.backscatter(0, nir) == 0);
  m.law = Retroreflector<Beads>{.coefficient = 1 / pi, .optics = {60_deg}};  // as a white surface
  m.reflectance = 0;
  CHECK(m.backscatter(std::cos(40_deg), nir) == support::relative(std::cos(40_deg), 1e-13));
}

TEST_CASE("cube corners return light by their open area, up to an angle, and prisms up to that inside") {
  Material m{.reflectance = 0, .law = Retroreflector<CubeCorners>{.coefficient = 1 / pi}};
  CHECK(m.backscatter(1, 1e-6) == doctest::Approx(1));
  CHECK(m.backscatter(std::cos(35.2_deg), 1e-6) > 0);
  CHECK(m.backscatter(std::cos(35.3_deg), 1e-6) == 0);
  double before = 1;
  for (int degrees = 1; degrees < 36; ++degrees) {
    const double now = m.backscatter(std::cos(degrees * 1_deg), 1e-6);
    CHECK(now < before);
    before = now;
  }
  // Source: lens of two equal circles, shifted by sqrt(2) tan(a) of their radius; in projection
  const double a = 20_deg, t = std::sqrt(2.0) * std::tan(a);
  CHECK(m.backscatter(std::cos(a), 1e-6) ==
        doctest::Approx(std::cos(a) * 2 / pi * (std::acos(t) - t * std::sqrt(1 - t * t))).epsilon(1e-12));
  m.law = Retroreflector<CubeCorners>{.coefficient = 1 / pi, .optics = {1.455}};
  const double limit = std::asin(1.455 * std::sin(std::atan(std::sqrt(0.5))));
  CHECK(m.backscatter(std::cos(limit - 0.001), 1e-6) > 0);
  CHECK(m.backscatter(std::cos(limit + 0.001), 1e-6) == 0);
  CHECK(degrees(limit) == doctest::Approx(57.1).epsilon(0.01));
  m.law = Retroreflector<CubeCorners>{.coefficient = 300, .half_angle = 0.03, .optics = {1.455}};
  CHECK(m.law.returned_share() == doctest::Approx(300 * pi * 0.03 * 0.03 / 2));
  CHECK_NOTHROW(m.validate());
  m.law = Retroreflector<CubeCorners>{.coefficient = 300, .half_angle = 0.06};  // more light than there is
  CHECK_THROWS_AS(m.validate(), SettingError);
}

TEST_CASE("retroreflectors that cannot be are refused") {
  CHECK_THROWS_AS((Material{.law = Retroreflector<>{.coefficient = -1}}.validate()), SettingError);
  CHECK_THROWS_AS((Material{.law = Retroreflector<>{.optics = {0}}}.validate()), SettingError);
  CHECK_THROWS_AS((Material{.law = Retroreflector<CubeCorners>{.optics = {0.9}}}.validate()), SettingError);
}

TEST_CASE("retroreflectors keep the laws of scattering") {
  CHECK(support::scattering_laws(Retroreflector<>{.coefficient = 70}, {.peaked = true}) == "");
  CHECK(support::scattering_laws(Retroreflector<CubeCorners>{.coefficient = 300, .optics = {1.5}}, {.peaked = true}) ==
        "");
}
