// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/lambert.hpp>

#include <cmath>

#include <doctest/doctest.h>

#include <pulsecast/material/material.hpp>

#include "support/relative.hpp"
#include "support/scattering_laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(ScattersBetween<Lambert> && ScattersBetween<DirectionIndependent>);

namespace {
constexpr double nir = 1.064e-6;
}

TEST_CASE("Lambert's law keeps the laws of scattering") { CHECK(support::scattering_laws(Lambert{}) == ""); }

TEST_CASE("a law that is independent of the direction scatters into others as Lambert's") {
  CHECK(support::scattering_laws(DirectionIndependent{}, {.peaked = true}) == "");
  CHECK(DirectionIndependent{}.backscatter(0.2, {nir, 0.7}) == 0.7);
}
