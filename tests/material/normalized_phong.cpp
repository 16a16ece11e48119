// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/normalized_phong.hpp>

#include <cmath>

#include <doctest/doctest.h>

#include <pulsecast/material/material.hpp>

#include "support/relative.hpp"
#include "support/scattering_laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(ScattersBetween<NormalizedPhong>);

namespace {
constexpr double nir = 1.064e-6;
}

TEST_CASE("the lobe of normalized Phong holds its share of the energy, by quadrature over the hemisphere") {
  for (const double exponent : {0.0, 1.0, 7.5, 30.0, 100.0})
    for (const double share : {0.2, 1.0}) {
      const Material m{.reflectance = 0.6, .law = NormalizedPhong{share, exponent}};
      // Source: Lafortune & Willems 1994: reflectance ((1 - share) / pi + share (n + 2) / 2 pi cos^n of the angle to
      // the mirror direction)
      const auto brdf = [&](double cos_to_mirror) {
        return 0.6 *
               ((1 - share) / pi + share * (exponent + 2) / (2 * pi) * std::pow(std::fmax(cos_to_mirror, 0), exponent));
      };
      for (const double incidence : {0.0, 0.3, 0.6}) {
        CHECK(m.backscatter(std::cos(incidence), nir) ==
              support::relative(pi * brdf(std::cos(2 * incidence)) * std::cos(incidence), 1e-13));
        double energy = 0;
        constexpr int n = 400;
        for (int i = 0; i < n; ++i)
          for (int k = 0; k < n; ++k) {
            const double zenith = pi / 2 * (i + 0.5) / n, azimuth = 2 * pi * (k + 0.5) / n;
            const double to_mirror =
                std::sin(zenith) * std::cos(azimuth) * std::sin(incidence) + std::cos(zenith) * std::cos(incidence);
            energy += brdf(to_mirror) * std::cos(zenith) * std::sin(zenith) * (pi / 2 / n) * (2 * pi / n);
          }
        INFO("exponent ", exponent, ", incidence ", incidence);
        CHECK(energy < 0.6 * (1 + 1e-4));
        if (incidence == 0) CHECK(energy == support::relative(0.6, 1e-4));
      }
    }
}

TEST_CASE("normalized Phong keeps the laws of scattering") {
  CHECK(support::scattering_laws(NormalizedPhong{0.4, 12.5}, {.peaked = true}) == "");
}
