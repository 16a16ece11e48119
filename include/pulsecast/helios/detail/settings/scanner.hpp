// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SETTINGS_SCANNER_HPP
#define PULSECAST_HELIOS_DETAIL_SETTINGS_SCANNER_HPP

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/detector/waveform_settings.hpp>
#include <pulsecast/helios/detail/settings/mount.hpp>

namespace PULSECAST_NAMESPACE::helios {

using pulsecast::KeptReturns;

/// Oscillating mirror: `optics="oscillating"`.
struct OscillatingOptic {
  double scan_product_max = radians(1e6);  ///< of half scan angle times frequency; `scanProduct` in deg Hz [rad/s]

  bool operator==(const OscillatingOptic&) const = default;
};

/// Rotating polygon mirror: `optics="rotating"`. It sweeps `scan_angle_max` to either side and measures in part of
/// that.
struct RotatingOptic {
  /// Maximum half angle of measurement, default `scan_angle_max`; `scanAngleEffectiveMax_deg` [rad]
  std::optional<double> effective_angle_max{};

  bool operator==(const RotatingOptic&) const = default;
};

/// Palmer mirror (conical scan): `optics="conic"`.
struct ConicOptic {
  bool operator==(const ConicOptic&) const = default;
};

/// Array of fibres in a line: `optics="line"`.
struct LineOptic {
  int fibers = 1;  ///< `numFibers`

  bool operator==(const LineOptic&) const = default;
};

/// One rotating glass wedge.
struct RisleyPrism {
  double angle = 0;             ///< wedge; inclined entry face if positive, else exit face. `angle1_deg`... [rad]
  double rotation_rate = 0;     ///< right-handed if positive; `rotorFreq1_Hz`... [Hz]
  double refractive_index = 1;  ///< `refrIndex1`...

  bool operator==(const RisleyPrism&) const = default;
};

/// Risley prisms: `optics="risley"`.
struct RisleyOptic {
  std::array<RisleyPrism, 3> prisms{};  ///< those with angle 0 are absent
  double air_refractive_index = 1;      ///< `refrIndex_air`
  Vec3 incident_beam = axis::forward;   ///< non-zero, any length; `<incidentBeam>`

  bool operator==(const RisleyOptic&) const = default;
};

/// Any optic.
using OpticSettings = std::variant<OscillatingOptic, RotatingOptic, ConicOptic, LineOptic, RisleyOptic>;

/// Sampling of waveforms: `<FWFSettings>`.
struct FullWaveformSettings {
  double bin_size = 0.25e-9;       ///< `binSize_ns` [s]
  std::optional<double> window{};  ///< half width about a peak, default a quarter of the pulse length; `winSize_ns` [s]
  int rings = 3;                   ///< number of subray rings, including the centre; `beamSampleQuality`
  double duration_max = 0;         ///< 0: no limit; `maxFullwaveRange_ns` [s]

  void validate() const {
    detail::require_at_least(1, "beamSampleQuality", rings);
    require_not_negative("maxFullwaveRange_ns", duration_max * 1e9, "ns");
  }

  bool operator==(const FullWaveformSettings&) const = default;
};

/// Errors of a scanner, as formulas of an angle or range: `<deflectionError>`, `<headError>`, `<rangeError>`.
struct ErrorFormulas {
  std::string deflection{};        ///< error of the deflection, as a function of it [rad]; `expr` in THETA
  std::string head{};              ///< error of the head angle, as a function of the deflection [rad]; `expr` in THETA
  double head_zero_threshold = 0;  ///< minimum distance of the argument from 0 and pi; `zeroSinThreshold_deg` [rad]
  std::string range{};             ///< error of the range, as a function of the deflection [m]; `expr` in THETA
  std::string range_noise{};       ///< factor of range noise, by the range [m]; `distanceMeasurementError` in t

  bool operator==(const ErrorFormulas&) const = default;
};

/// One laser with its optic and receiver: `<scanner>`, or each of its `<channel>` elements. The position of
/// `beam_origin` is along the axes of the platform, like that of the mount. The rotation of the mount does not turn it;
/// heading and head do.
struct ChannelSettings {
  std::string id{};                      ///< `id` of the channel; empty for the only channel
  OpticSettings optic{};                 ///< `optics` and its attributes
  double scan_angle_max = 0;             ///< half angle; `scanAngleMax_deg` [rad]
  double scan_rate_min = 0;              ///< `scanFreqMin_Hz` [Hz]
  double scan_rate_max = 0;              ///< 0: no limit; `scanFreqMax_Hz` [Hz]
  MountSettings beam_origin{};           ///< rotation in the frame of the instrument; `<beamOrigin>`
  Vec3 head_axis = axis::up;             ///< non-zero, any length; `<headRotateAxis>`
  double head_rate_max = 0;              ///< 0: fixed; `headRotatePerSecMax_deg` [rad/s]
  double divergence = 0.3e-3;            ///< full angle at 1/e^2 of the peak; `beamDivergence_rad` [rad]
  double pulse_length = 4e-9;            ///< full width at half maximum; `pulseLength_ns` [s]
  double average_power = 4;              ///< `averagePower_w` [W]
  std::optional<double> beam_quality{};  ///< M^2, default a point source; `beamQualityFactor` other than 1
  double wavelength = 1064e-9;           ///< `wavelength_nm` [m]
  double efficiency = 0.99;              ///< `opticalEfficiency`
  double receiver_diameter = 0.15;       ///< `receiverDiameter_m` [m]
  double visibility = 23e3;              ///< atmospheric visibility; `atmosphericVisibility_km` [m]
  double accuracy = 0;                   ///< standard deviation of the range; `accuracy_m` [m]
  double range_min = 0;                  ///< `rangeMin_m` [m]
  double range_max = std::numeric_limits<double>::infinity();  ///< `rangeMax_m` [m]
  int returns_max = 0;                                         ///< per pulse; 0: no limit. `maxNOR`
  KeptReturns returns_kept = KeptReturns::first;               ///< which ones, of more; `keptReturns`
  double received_power_min = 1e-4 / 1e9;                      ///< per echo; `receivedEnergyMin_W`, which is in nW [W]
  FullWaveformSettings waveform{};                             ///< `<FWFSettings>`
  ErrorFormulas errors{};                                      ///< `<deflectionError>`...

  void validate() const {
    require_not_negative("scanAngleMax_deg", degrees(scan_angle_max), "deg");
    require_not_negative("scanFreqMin_Hz", scan_rate_min, "Hz");
    require_not_negative("scanFreqMax_Hz", scan_rate_max, "Hz");
    require_not_negative("headRotatePerSecMax_deg", degrees(head_rate_max), "deg/s");
    detail::require_at_least(0, "maxNOR", returns_max);
    waveform.validate();
  }

  bool operator==(const ChannelSettings&) const = default;
};

/// `<scanner>`, with the overrides of the survey.
struct ScannerSettings {
  std::string id{};                         ///< `id`
  std::string name{};                       ///< `name`
  std::vector<double> pulse_rates{};        ///< supported rates, default first; `pulseFreqs_Hz` [Hz]
  std::vector<ChannelSettings> channels{};  ///< at least one; they fire at the same time, in this order

  void validate() const {
    for (const ChannelSettings& channel : channels) channel.validate();
  }

  bool operator==(const ScannerSettings&) const = default;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
