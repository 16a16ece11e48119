// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/phong.hpp>

#include <cmath>

#include <doctest/doctest.h>

#include <pulsecast/material/material.hpp>

#include "support/relative.hpp"
#include "support/scattering_laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(ScattersBetween<Phong>);

namespace {
constexpr double nir = 1.064e-6;
}

TEST_CASE("Phong's law keeps the laws of scattering") {
  CHECK(support::scattering_laws(Phong{}) == "");  // without a lobe
  CHECK(support::scattering_laws(Phong{0.4, 30}, {.peaked = true}) == "");
}

TEST_CASE("Phong's law in lanes is that of one cosine") {
  const Phong law{0.4, 12.5};
  for (double cosine = 0; cosine <= 1; cosine += 0.01)
    CHECK(law.backscatter(simd::Doubles{} + cosine, nir)[0] == law.backscatter(cosine, nir));
}
