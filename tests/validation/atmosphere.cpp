// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// What the air takes, measured: a wall seen through air and through none. The figures are by hand from 3.91 / V (lambda
// / 0.55 um)^-q.

#include <cmath>
#include <optional>
#include <string>

#include <doctest/doctest.h>

#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

struct Wall {
  double at;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept { return Hit{at / ray.direction.y, 1, 1, 0, 0}; }
};

/// What is left of the light after the way there and back.
double left(double wavelength, double visibility, double range) {
  const Laser laser{.wavelength = wavelength};
  return one_pulse(Wall{range}, SingleRay{}, laser, Receiver{.visibility = visibility}).power /
         one_pulse(Wall{range}, SingleRay{}, laser).power;
}

}  // namespace

TEST_CASE("extinction of the air by wavelength and visibility") {
  struct Case {
    double wavelength_nm, visibility_km, extinction;  ///< [nm, km, 1/km]
  };
  for (const Case& c : {Case{550, 10, 0.391},
                        {1064, 23, 0.0720935},
                        {1550, 23, 0.0442068},
                        {905, 23, 0.0889769},
                        {1064, 60, 0.0226725},
                        {1064, 5, 0.3685588},
                        {532, 2, 1.9984094},
                        {1550, 0.2, 19.55}}) {
    const double range = 1000 * std::fmin(1, c.visibility_km);
    row("air at " + std::to_string(static_cast<int>(c.wavelength_nm)) + " nm, visibility " +
            std::to_string(static_cast<int>(1000 * c.visibility_km)) + " m: extinction [1/km]",
        c.extinction, -500 / range * std::log(left(c.wavelength_nm * 1e-9, c.visibility_km * 1e3, range)), 1e-6);
  }
}

TEST_CASE("light that is left by range") {
  row("air at 550 nm, visibility 10 km: left after 1 km and back", std::exp(-0.782), left(0.55e-6, 10e3, 1000), 1e-6);
  row("air at 550 nm, visibility 10 km: left after 10 km and back", std::exp(-7.82), left(0.55e-6, 10e3, 10e3), 1e-5);
}
