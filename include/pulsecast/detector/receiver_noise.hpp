// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_RECEIVER_NOISE_HPP
#define PULSECAST_DETECTOR_RECEIVER_NOISE_HPP

#include <cmath>
#include <cstdint>

#include <pulsecast/base/random.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/pulse.hpp>

namespace PULSECAST_NAMESPACE {

/// Receiver noise and background light, none by default. Samples are independent.
struct ReceiverNoise {
  double deviation = 0;           ///< standard deviation of the electronic noise per sample, from 0 to 1e20 [W]
  double background = 0;          ///< received sunlight power, from 0 to 1e20 [W]
  double quantum_efficiency = 1;  ///< share of background photons detected, in (0, 1]

  void validate() const {
    require_within("ReceiverNoise::deviation", deviation, 0, 1e20, "W");
    require_within("ReceiverNoise::background", background, 0, 1e20, "W");
    require_positive("ReceiverNoise::quantum_efficiency", quantum_efficiency, "");
    require_within("ReceiverNoise::quantum_efficiency", quantum_efficiency, 0, 1, "");
  }

  /// True without noise.
  [[nodiscard]] bool none() const noexcept { return deviation == 0 && background == 0; }

  /// Standard deviation of a sample [W]: electronic noise, and shot noise of the background. The photon count is Poisson-distributed, with
  /// a variance equal to its mean. It is large per interval, so a normal distribution approximates it. Source: Liu et al. 2006, Applied
  /// Optics 45.
  [[nodiscard]] double deviation_of_sample(double wavelength, double interval) const noexcept {
    constexpr double planck = 6.62607015e-34;  // [J s]. Source: SI, exact by definition of the kilogram (26th CGPM, 2018)
    const double photon = planck * speed_of_light / wavelength;
    return std::sqrt(deviation * deviation + background * photon / (quantum_efficiency * interval));
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
