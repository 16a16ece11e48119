// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_RECEIVER_NOISE_HPP
#define PULSECAST_DETECTOR_RECEIVER_NOISE_HPP

#include <pulsecast/detector/detail/ideal_samples.hpp>

namespace PULSECAST_NAMESPACE {

/// Receiver of infinite bandwidth, with white noise. A policy of `FullWaveform`.
struct ReceiverNoise {
  double deviation = 0;           ///< of the electronic noise per sample, from 0 to 1e20 [W]
  double background = 0;          ///< received sunlight power, from 0 to 1e20 [W]
  double quantum_efficiency = 1;  ///< share of background photons detected, in (0, 1]

  void validate() const {
    require_within("ReceiverNoise::deviation", deviation, 0, 1e20, "W");
    require_within("ReceiverNoise::background", background, 0, 1e20, "W");
    require_positive("ReceiverNoise::quantum_efficiency", quantum_efficiency, "");
    require_within("ReceiverNoise::quantum_efficiency", quantum_efficiency, 0, 1, "");
  }

  [[nodiscard]] bool none() const noexcept { return deviation == 0 && background == 0; }  ///< no noise

  /// Standard deviation of a sample [W]: electronic noise, and shot noise of the background. The
  /// photon count is Poisson-distributed, of a variance equal to its mean, and large: nearly
  /// normal. Source: Liu et al. 2006, Applied Optics 45.
  [[nodiscard]] double deviation_of_sample(double wavelength, double interval) const noexcept {
    const double photon = planck_constant * speed_of_light / wavelength;
    return std::sqrt(deviation * deviation + background * photon / (quantum_efficiency * interval));
  }

  static constexpr bool runs_without_reflections = false;  ///< false: noise alone is not heard
  struct Workspace {};
  [[nodiscard]] Workspace workspace() const { return {}; }

  /// Takes away noise and background.
  void silence() noexcept { *this = {}; }
  void prepare(const Laser&, const WaveformSettings&) const noexcept {}  ///< nothing to do
  /// A maximum is that of the samples about it.
  [[nodiscard]] double timing_reach(const Laser&) const noexcept { return 0; }
  /// As the concept WaveformReceiver requires.
  [[nodiscard]] IdealSamples samples(const WaveformSettings& s, const DetectorInput& input,
                                     std::span<const Reflection> reflections, double width_tail,
                                     Workspace&) const noexcept {
    const double of_sample = none() ? 0 : deviation_of_sample(input.emitter.laser.wavelength, s.sample_interval);
    return {of_sample, background, s, input, reflections, width_tail};
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
