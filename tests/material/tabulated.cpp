// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/tabulated.hpp>

#include <cmath>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/material/material.hpp>

#include "support/relative.hpp"
#include "support/scattering_laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(ScattersBetween<Tabulated>);

namespace {
constexpr double nir = 1.064e-6;
}

TEST_CASE("measured backscatter is linear in the angle between the rows, and constant beyond") {
  const Material m{
      .reflectance = 0.5,
      .law = Tabulated{SharedArray<BackscatterAtIncidence>({{10_deg, 3.0}, {20_deg, 1.0}, {60_deg, 0.5}})}};
  CHECK(m.backscatter(1, nir) == support::relative(1.5, 1e-13));
  CHECK(m.backscatter(std::cos(15_deg), nir) == support::relative(1, 1e-13));
  CHECK(m.backscatter(std::cos(40_deg), nir) == support::relative(0.375, 1e-13));
  CHECK(m.backscatter(0, nir) == support::relative(0.25, 1e-13));
}

TEST_CASE("a table without rows, which validation refuses, is black") {
  CHECK(Material{.law = Tabulated{}}.backscatter(0.7, nir) == 0);
}

TEST_CASE("tables that cannot be are refused") {
  CHECK_THROWS_AS((Material{.law = Tabulated{}}.validate()), SettingError);
  const auto table = [](std::vector<BackscatterAtIncidence> rows) {
    return Material{.law = Tabulated{SharedArray<BackscatterAtIncidence>(std::move(rows))}};
  };
  CHECK_NOTHROW(table({{0.1, 1}}).validate());
  CHECK_THROWS_AS(table({{0.2, 1}, {0.1, 1}}).validate(), SettingError);
  CHECK_THROWS_AS(table({{0.2, -1}}).validate(), SettingError);
  CHECK_THROWS_AS(table({{2, 1}}).validate(), SettingError);
}

TEST_CASE("a measured law keeps the laws of scattering") {
  CHECK(support::scattering_laws(Tabulated{SharedArray<BackscatterAtIncidence>({{0.0, 3.0}, {0.3, 1.0}, {1.2, 0.5}})},
                                 {.peaked = true}) == "");
}
