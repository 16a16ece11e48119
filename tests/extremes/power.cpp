// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Power: from 1e-300 W to 1e300 W; and what it is made of besides: the receiver's aperture and the wavelength.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/detector/radiometry.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include "extremes/detectors.hpp"
#include "extremes/row.hpp"

using namespace pulsecast;
using namespace pulsecast::extremes;

namespace {

const std::string quantity = "power";

/// The energy of the record of a wall, of the right one.
template <class Detector>
double energy_of_record(const Laser& laser, double range) {
  const WaveformSettings settings{.threshold = 0, .record_length = 200e-9};
  const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 1, .laser = laser}}};
  const Wall wall{range};
  const Survey survey{source, SingleRay{}, wall, validation::vacuum, Detector{settings}};
  auto workspace = survey.workspace();
  double energy = 0;
  for (const float power : survey(0, workspace).waveform)
    energy += static_cast<double>(power) * settings.sample_interval;
  return energy / (from_wall(laser, range) * std::exp(2.0) / 2 * laser.pulse_length / 3.3946806708);
}

}  // namespace

TEST_CASE("powers before a wall") {
  struct Case {
    const char* name;
    double power, range;
  };
  for (const auto& [name, power, range] : {Case{"1e-20 W, wall at 1 m", 1e-20, 1},
                                           {"1e-20 W, wall at 40 000 km", 1e-20, 4e7},
                                           {"1 W, wall at 40 000 km", 1, 4e7},
                                           {"1e20 W, wall at 1 m", 1e20, 1},
                                           {"1e20 W, wall at 40 000 km", 1e20, 4e7}}) {
    const Laser laser{.peak_power = power};
    const Errors errors = errors_at_wall(laser, range, WaveformSettings{.threshold = 0});
    const std::string wall = name + std::string(", all detectors and widths: ");
    row(quantity, wall + "largest error of the range [m]", 0, errors.range, 1e-6);
    row(quantity, wall + "largest error of the amplitude, as a share", 0, errors.amplitude, 1e-3);
    row(quantity, wall + "largest error of the width, as a share", 0, errors.width, 0.01);
    row(quantity, name + std::string(", record of FullWaveform: energy, of the right one"), 1,
        energy_of_record<FullWaveform<>>(laser, range), 1e-3);
    row(quantity, name + std::string(", record of AnalyticWaveform: energy, of the right one"), 1,
        energy_of_record<AnalyticWaveform<>>(laser, range), 1e-3);
  }
}

TEST_CASE("apertures and wavelengths before a wall") {
  for (const auto& [name, diameter] : {std::pair{"an aperture of 0.1 mm", 1e-4}, {"an aperture of 1 km", 1e3}})
    for (const double range : {1.0, 4e7}) {
      const Receiver receiver{.diameter = diameter, .visibility = validation::vacuum.visibility};
      receiver.validate();
      const double radius = diameter / 2, spread = std::hypot(range, radius);
      const std::string wall = name + std::string(range == 1 ? ", wall at 1 m" : ", wall at 40 000 km");
      // Source: laser radar equation for an extended target, Jelalian 1992; near by, the solid angle of a disc on the
      // quantity
      row(quantity, wall + ": received power, of the right one", 1,
          LinkBudget(receiver, Laser{}).power(1, 1, range) /
              (Laser{}.peak_power * (radius / spread) * (radius / spread) * 0.99),
          1e-12);
    }
  for (const auto& [name, wavelength] : {std::pair{"10 nm", 1e-8}, {"1 cm", 1e-2}}) {
    const Scanner scanner{.laser = {.wavelength = wavelength}};
    scanner.validate();
    for (const double visibility : {1.0, 23e3, 1e9}) {
      const double lost = extinction(wavelength, visibility);
      CHECK(lost > 0);
      CHECK(lost < 10);
      CHECK(LinkBudget(Receiver{.visibility = visibility}, scanner.laser).power(1, 1, 1) > 0);
    }
  }
}

TEST_CASE("powers, apertures and wavelengths that cannot be") {
  for (const auto& [name, power] :
       {std::pair{"1e-300 W", 1e-300}, {"1e-21 W", 1e-21}, {"1e21 W", 1e21}, {"1e300 W", 1e300}, {"0 W", 0.0}})
    refused(quantity, name, [power = power] { Scanner{.laser = {.peak_power = power}}.validate(); });
  for (const auto& [name, diameter] : {std::pair{"an aperture of 1e-300 m", 1e-300},
                                       {"an aperture of 0.09 mm", 9e-5},
                                       {"an aperture of 1.1 km", 1.1e3}})
    refused(quantity, name, [diameter = diameter] { Receiver{.diameter = diameter}.validate(); });
  for (const auto& [name, length] : {std::pair{"a wavelength of 1e-300 m", 1e-300},
                                     {"a wavelength of 9 nm", 9e-9},
                                     {"a wavelength of 1.1 cm", 1.1e-2}})
    refused(quantity, name, [length = length] { Scanner{.laser = {.wavelength = length}}.validate(); });
  refused(quantity, "a threshold without bound",
          [] { return FullWaveform{WaveformSettings{.threshold = std::numeric_limits<double>::infinity()}}; });
  refused(quantity, "noise of 1e300 W", [] { ReceiverNoise{.deviation = 1e300}.validate(); });
  refused(quantity, "sunlight of 1e300 W", [] { ReceiverNoise{.background = 1e300}.validate(); });
}
