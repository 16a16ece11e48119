// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A wire thinner than the distance of subrays: the mean of many pulses, and of pulses along it.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <doctest/doctest.h>

#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

constexpr double range = 1000, width = 0.01, w = 0.25;  // of the wire, and the beam's radius there [m]
const Laser laser{.divergence = 2 * w / range};

/// Upright, white, and turned towards the light, at a distance from the axis.
struct Wire {
  double aside;  ///< [m]
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double x = range * ray.direction.x / ray.direction.y;
    return std::fabs(x - aside) < width / 2 ? std::optional(Hit{.range = range / ray.direction.y}) : std::nullopt;
  }
};

/// Share of the light that the wire meets. Source: irradiance exp(-2 r^2 / w^2), integrated over the strip.
double of_strip(double aside) {
  const double root = std::sqrt(2.0) / w;
  return 0.5 * (std::erf(root * (aside + width / 2)) - std::erf(root * (aside - width / 2)));
}

struct Errors {
  double mean = 0;    ///< mean share that the wire meets, by the right one
  double echoes = 0;  ///< share of the pulses that meet it
  double along = 0;   ///< root mean square error of the mean of 100 pulses at one place, by the right one
};

/// Of wires at 400 places within half of the beam's radius, 100 pulses each.
template <Footprint Pattern>
Errors of(const Pattern& footprint) {
  constexpr int places = 400, pulses = 100;
  Errors e;
  double right = 0;
  for (int i = 0; i < places; ++i) {
    const Wire wire{w * ((i + 0.5) / places - 0.5)};
    const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = pulses, .laser = laser}}};
    const Survey survey{source, footprint, wire, vacuum, FirstHit{1e-30}, static_cast<std::uint64_t>(i)};
    auto workspace = survey.workspace();
    double met = 0;
    for (PulseIndex pulse = 0; pulse < survey.size(); ++pulse) {
      const double share = 1 - survey(pulse, workspace).energy.share(&EnergyLedger::missed);
      met += share / pulses;
      e.echoes += share > 1e-9 ? 1.0 / (places * pulses) : 0;
    }
    e.mean += met;
    right += of_strip(wire.aside);
    e.along += std::pow(met / of_strip(wire.aside) - 1, 2) / places;
  }
  e.mean /= right;
  e.along = std::sqrt(e.along);
  return e;
}

}  // namespace

TEST_CASE("thin wires") {
  const Errors fixed = of(LatticeFootprint(19)), turned = of(TurnedFootprint{LatticeFootprint(19)}),
               dense = of(LatticeFootprint(97));
  const std::string title = "wire of 10 mm in a footprint of 0.5 m, ";
  row(title + "lattice of 19: mean share of the light", 1, fixed.mean, 0.05);
  row(title + "lattice of 19 turned for each pulse: mean share of the light", 1, turned.mean, 0.05);
  row(title + "lattice of 97: mean share of the light", 1, dense.mean, 0.05);
  row(title + "lattice of 97: share of the pulses with an echo", 1, dense.echoes, 0.01);
  row(Kind::bound, title + "lattice of 97, 100 pulses along it: error of the mean, by the right one", 0, dense.along,
      0.3);
  row(Kind::bound, title + "lattice of 19, 100 pulses along it: error of the mean, by the right one", 0, fixed.along,
      1.2);
  row(Kind::bound,
      title + "lattice of 19 turned for each pulse, 100 pulses along it: error of the mean, by the right one", 0,
      turned.along, 0.3);
  CHECK(fixed.along > 3 * turned.along);
}
