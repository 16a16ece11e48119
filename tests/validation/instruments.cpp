// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Instruments of other kinds: coherent ones, and apertures side by side.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/fmcw.hpp>
#include <pulsecast/transport/aperture_overlap.hpp>

#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

constexpr double unit = 299'792'458 / 2e9;  // c / 2B for a bandwidth of 1 GHz [m]
const Emitter emitter{.laser = {.wavelength = 1.55e-6}};

std::vector<Echo> echoes(std::vector<Reflection> reflections) {
  const Fmcw detector({.bandwidth = 1e9});
  auto w = detector.workspace(reflections.size());
  const Detection found = detector.detect({emitter, {}, reflections, {}}, w);
  return {found.echoes.begin(), found.echoes.end()};
}

/// Share of pairs of plates, so many c / 2B apart, that are two echoes.
double parted(double apart) {
  int parted = 0;
  for (int i = 0; i < 1000; ++i) {
    const double near = 30 + 0.0013 * i;
    parted +=
        echoes({{.range = near, .power = 1e-6}, {.range = near + apart * unit, .power = 1e-6}}).size() == 2 ? 1 : 0;
  }
  return parted / 1000.0;
}

}  // namespace

TEST_CASE("frequency-modulated continuous wave") {
  double range = 0, velocity = 0;
  for (int i = 0; i < 2000; ++i) {
    const double at = 5 + 0.1037 * i, speed = -40 + 0.0401 * i;
    const auto found = echoes({{.range = at, .power = 1e-6, .velocity = speed}});
    REQUIRE(found.size() == 1);
    range = std::max(range, std::fabs(found[0].range - at));
    velocity = std::max(velocity, std::fabs(found[0].velocity - speed));
  }
  const std::string title = "sweeps of 1 GHz in 10 us, ";
  row(title + "2000 surfaces of -40 to 40 m/s: largest error of the radial velocity [m/s]", 0, velocity, 1e-3);
  row(title + "the same: largest error of the range [m]", 0, range, 1e-4);
  row(title + "plates 0.5 c/2B apart: share of two echoes", 0, parted(0.5), 1e-3);
  row(title + "plates 2 c/2B apart: share of two echoes", 1, parted(2), 1e-3);
}

TEST_CASE("apertures side by side") {
  const Receiver receiver{.diameter = 0.05};
  const Laser laser{.divergence = 0.5e-3, .waist_diameter = 0.01};
  const ApertureGeometry g{.separation = 0.08, .field_of_view = 1.5e-3};
  double worst = 0;
  for (double range = 20; range < 200; range *= 1.05) {
    // Source: overlap function of geometrical optics, by rings of the beam; the arc of a ring in the view by the law of
    // cosines
    const double beam = 0.5 * std::hypot(0.01, 0.5e-3 * range), view = 0.025 + range * std::tan(0.75e-3);
    double share = 0;
    constexpr int rings = 20'000;
    for (int i = 0; i < rings; ++i) {
      const double r = beam * (i + 0.5) / rings;
      const double cosine = std::clamp((r * r + 0.08 * 0.08 - view * view) / (2 * r * 0.08), -1.0, 1.0);
      share += std::acos(cosine) / pi * (2 * i + 1.0) / rings / rings;
    }
    worst = std::max(worst, std::fabs(aperture_overlap(g, receiver, laser, range) - share));
  }
  row("apertures 80 mm apart, 20 to 200 m: largest error of the overlap", 0, worst, 1e-4);
}
