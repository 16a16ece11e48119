// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_RECEIVER_CHAIN_HPP
#define PULSECAST_DETECTOR_RECEIVER_CHAIN_HPP

#include <algorithm>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/detector/detail/filtered_noise.hpp>

namespace PULSECAST_NAMESPACE {

/// APD or PIN diode with amplifier and digitiser. Powers are optical. Signal and noise pass the
/// same low-pass, calibrated: a flat target at normal incidence has the height of its received
/// power. Sources: Richmond & Cain 2010, ch. 1 and 4; McIntyre 1966 (excess noise).
struct ReceiverChain {
  double bandwidth = 0;             ///< 3 dB electrical bandwidth; 0 for that of the pulse [Hz]
  double noise_power = 0;           ///< of the amplifier, equivalent, one-sided [W/sqrt(Hz)]
  double background = 0;            ///< received sunlight [W]
  double quantum_efficiency = 0.8;  ///< photoelectrons per photon, in (0, 1]
  bool shot_noise = false;          ///< true if light and dark current have shot noise
  double excess_noise = 1;          ///< excess noise factor of the avalanche gain, from 1 to 100
  double dark_current = 0;          ///< dark current that is multiplied, before the gain [A]
  double saturation = 0;            ///< greatest power of the amplifier; 0 for no limit [W]
  double recovery = 0;              ///< time constant of its fall after saturation [s]
  double full_scale = 0;            ///< power at the digitiser's highest code; 0 without steps [W]
  double baseline = 0;              ///< power below zero at the digitiser's lowest code [W]
  int bits = 10;                    ///< resolution of the digitiser, from 1 to 24
  bool matched_filter = false;      ///< true if samples are first correlated with the pulse

  void validate() const {
    require_within("ReceiverChain::bandwidth", bandwidth, 0, 1e15, "Hz");
    require_within("ReceiverChain::noise_power", noise_power, 0, 1, "W/sqrt(Hz)");
    require_within("ReceiverChain::background", background, 0, 1e20, "W");
    require_positive("ReceiverChain::quantum_efficiency", quantum_efficiency, "");
    require_within("ReceiverChain::quantum_efficiency", quantum_efficiency, 0, 1, "");
    require_within("ReceiverChain::excess_noise", excess_noise, 1, 100, "");
    require_within("ReceiverChain::dark_current", dark_current, 0, 1, "A");
    require_not_negative("ReceiverChain::saturation", saturation, "W");
    require_not_negative("ReceiverChain::recovery", recovery, "s");
    require_not_negative("ReceiverChain::full_scale", full_scale, "W");
    require_not_negative("ReceiverChain::baseline", baseline, "W");
    require_within("ReceiverChain::bits", bits, 1, 24, "");
  }

  /// True if there is noise also without a signal.
  [[nodiscard]] bool noisy() const noexcept {
    return noise_power > 0 || (shot_noise && (background > 0 || dark_current > 0));
  }

  /// Low-pass for a full width at half maximum of `pulse_length` [s]. Without a bandwidth, it is as
  /// wide as the pulse: a matched filter of a Gaussian pulse.
  [[nodiscard]] LowPass filter(double pulse_length) const noexcept {
    return bandwidth > 0 ? LowPass::of_bandwidth(bandwidth) : LowPass{pulse_length / std::sqrt(8 * std::numbers::ln2)};
  }

  /// One-sided density of the noise before the low-pass, at a power `signal` [W]: of the amplifier,
  /// and shot noise of signal, background and dark current [W^2/Hz].
  [[nodiscard]] double density(double signal, double wavelength) const noexcept {
    constexpr double charge = 1.602176634e-19;  // [C]. Source: SI, exact (26th CGPM, 2018)
    if (!shot_noise) return noise_power * noise_power;
    const double energy_per_electron = planck_constant * speed_of_light / (wavelength * quantum_efficiency);
    const double dark = dark_current * energy_per_electron / charge;
    return noise_power * noise_power +
           2 * excess_noise * energy_per_electron * (std::max(signal, 0.0) + background + dark);
  }

  /// Code of the digitiser for a power, as the power that it stands for [W].
  [[nodiscard]] double quantized(double power) const noexcept {
    if (full_scale == 0) return power;
    const double step = (full_scale + baseline) / (std::exp2(bits) - 1);
    return std::nearbyint((std::clamp(power, -baseline, full_scale) + baseline) / step) * step - baseline;
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
