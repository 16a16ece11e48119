// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SETTINGS_SCANNER_HPP
#define PULSECAST_HELIOS_DETAIL_SETTINGS_SCANNER_HPP

#include <variant>

#include <pulsecast/detector/waveform_settings.hpp>
#include <pulsecast/helios/detail/settings/mount.hpp>

namespace PULSECAST_NAMESPACE::helios {

using pulsecast::KeptReturns;

/// Oscillating mirror: `optics="oscillating"`.
struct OscillatingOptic {
  double scan_product_max = radians(1e6);  ///< half angle times rate; `scanProduct` in deg Hz [rad/s]

  void fields(FieldIo& io) { io.number("scanProduct", scan_product_max, units::degree_hertz, 1e-3, 1e12); }
  bool operator==(const OscillatingOptic&) const = default;
};

/// Rotating polygon mirror: `optics="rotating"`. It sweeps `scan_angle_max` to either side.
struct RotatingOptic {
  /// Maximum half angle of measurement, default `scan_angle_max`; `scanAngleEffectiveMax_deg` [rad]
  std::optional<double> effective_angle_max{};

  void fields(FieldIo& io) { io.number("scanAngleEffectiveMax_deg", effective_angle_max, units::degree, 0, 180); }
  bool operator==(const RotatingOptic&) const = default;
};

/// Palmer mirror (conical scan): `optics="conic"`.
struct ConicOptic {
  void fields(FieldIo& /*io*/) {}
  bool operator==(const ConicOptic&) const = default;
};

/// Array of fibres in a line: `optics="line"`.
struct LineOptic {
  int fibers = 1;  ///< `numFibers`

  void fields(FieldIo& io) { io.whole("numFibers", fibers, 1, 1'000'000); }
  bool operator==(const LineOptic&) const = default;
};

/// One rotating glass wedge.
struct RisleyPrism {
  double angle = 0;             ///< wedge: entry face; negative: exit face. `angle1_deg`... [rad]
  double rotation_rate = 0;     ///< right-handed if positive; `rotorFreq1_Hz`... [Hz]
  double refractive_index = 1;  ///< `refrIndex1`...

  bool operator==(const RisleyPrism&) const = default;
};

/// Risley prisms: `optics="risley"`.
struct RisleyOptic {
  std::array<RisleyPrism, 3> prisms{};  ///< those with angle 0 are absent
  double air_refractive_index = 1;      ///< `refrIndex_air`
  Vec3 incident_beam = axis::forward;   ///< non-zero, any length; `<incidentBeam>`

  void fields(FieldIo& io) {
    static constexpr std::array rates{"rotorFreq1_Hz", "rotorFreq2_Hz", "rotorFreq3_Hz"};
    static constexpr std::array angles{"angle1_deg", "angle2_deg", "angle3_deg"};
    static constexpr std::array indices{"refrIndex1", "refrIndex2", "refrIndex3"};
    for (std::size_t i = 0; i < prisms.size(); ++i) {
      io.number(rates[i], prisms[i].rotation_rate, units::hertz, -1e5, 1e5);
      io.number(angles[i], prisms[i].angle, units::degree, -89, 89);
      io.number(indices[i], prisms[i].refractive_index, units::one, 0.1, 10);
    }
    io.number("refrIndex_air", air_refractive_index, units::one, 0.1, 10);
    io.direction("incidentBeam", incident_beam);
  }
  bool operator==(const RisleyOptic&) const = default;
};

/// Any optic, and the default of each.
using OpticSettings = std::variant<OscillatingOptic, RotatingOptic, ConicOptic, LineOptic, RisleyOptic>;
inline const std::array<OpticSettings, 5> default_optics{OscillatingOptic{}, RotatingOptic{}, ConicOptic{}, LineOptic{},
                                                         RisleyOptic{}};

/// Sampling of waveforms: `<FWFSettings>`.
struct FullWaveformSettings {
  double bin_size = 0.25e-9;       ///< `binSize_ns` [s]
  std::optional<double> window{};  ///< half width at peaks, default a quarter pulse; `winSize_ns` [s]
  int rings = 3;                   ///< of subrays, with the centre; `beamSampleQuality`
  double duration_max = 0;         ///< 0: no limit; `maxFullwaveRange_ns` [s]

  void fields(FieldIo& io) {
    io.number("binSize_ns", bin_size, units::nanosecond, 1e-4, 1e4);
    io.number("winSize_ns", window, units::nanosecond, 0, 1e6);
    io.whole("beamSampleQuality", rings, 1, 100);
    io.number("maxFullwaveRange_ns", duration_max, units::nanosecond, 0, 1e9);
    io.without_effect({"apertureDiameter_m", "minEchoWidth", "peakEnergy", "scannerEfficiency", "atmosphericVisibility",
                       "scannerWaveLength", "beamDivergence_rad", "numTimeBins", "numFullwaveBins"});
  }
  bool operator==(const FullWaveformSettings&) const = default;
};

/// Formulas of errors, by the deflection: `<deflectionError>`, `<headError>`, `<rangeError>`.
struct ErrorFormulas {
  std::string deflection{};        ///< error of the deflection [rad]; `expr` in THETA
  std::string head{};              ///< error of the head angle [rad]; `expr` in THETA
  double head_zero_threshold = 0;  ///< distance kept from 0 and pi; `zeroSinThreshold_deg` [rad]
  std::string range{};             ///< error of the range [m]; `expr` in THETA
  std::string range_noise{};       ///< noise factor, by the range t [m]; `distanceMeasurementError`

  bool operator==(const ErrorFormulas&) const = default;
};

/// One laser with its optic and receiver: `<scanner>`, or each of its `<channel>` elements. The
/// position of `beam_origin` is along the axes of the platform: the mount does not turn it.
struct ChannelSettings {
  std::string id{};                      ///< `id` of the channel; empty for the only channel
  OpticSettings optic{};                 ///< `optics` and its attributes
  double scan_angle_max = 0;             ///< half angle; `scanAngleMax_deg` [rad]
  double scan_rate_min = 0;              ///< `scanFreqMin_Hz` [Hz]
  double scan_rate_max = 0;              ///< 0: no limit; `scanFreqMax_Hz` [Hz]
  MountSettings beam_origin{};           ///< rotation in the instrument; `<beamOrigin>`
  Vec3 head_axis = axis::up;             ///< non-zero, any length; `<headRotateAxis>`
  double head_rate_max = 0;              ///< 0: fixed; `headRotatePerSecMax_deg` [rad/s]
  double divergence = 0.3e-3;            ///< full angle at 1/e^2; `beamDivergence_rad` [rad]
  double pulse_length = 4e-9;            ///< full width at half maximum; `pulseLength_ns` [s]
  double average_power = 4;              ///< `averagePower_w` [W]
  std::optional<double> beam_quality{};  ///< M^2, default a point source; `beamQualityFactor`
  double wavelength = 1064e-9;           ///< `wavelength_nm` [m]
  double efficiency = 0.99;              ///< `opticalEfficiency`
  double receiver_diameter = 0.15;       ///< `receiverDiameter_m` [m]
  double visibility = 23e3;              ///< atmospheric visibility; `atmosphericVisibility_km` [m]
  double accuracy = 0;                   ///< standard deviation of the range; `accuracy_m` [m]
  double range_min = 0;                  ///< `rangeMin_m` [m]
  double range_max = std::numeric_limits<double>::infinity();  ///< `rangeMax_m` [m]
  int returns_max = 0;                                         ///< per pulse; 0: no limit. `maxNOR`
  KeptReturns returns_kept = KeptReturns::first;               ///< which, of more; `keptReturns`
  double received_power_min = 1e-4 / 1e9;                      ///< per echo; `receivedEnergyMin_W` in nW [W]
  FullWaveformSettings waveform{};                             ///< `<FWFSettings>`
  ErrorFormulas errors{};                                      ///< `<deflectionError>`...

  void fields(FieldIo& io) {
    optic_fields(io);
    io.number("scanAngleMax_deg", scan_angle_max, units::degree, 0, 180);
    io.number("scanFreqMin_Hz", scan_rate_min, units::hertz, 0, 1e6);
    io.number("scanFreqMax_Hz", scan_rate_max, units::hertz, 0, 1e6);
    io.element("beamOrigin", [&](FieldIo& inner) { beam_origin.fields(inner); });
    io.direction("headRotateAxis", head_axis);
    io.number("headRotatePerSecMax_deg", head_rate_max, units::degree_per_second, 0, 1e6);
    io.number("beamDivergence_rad", divergence, units::radian, 1e-9, 0.5);
    io.number("pulseLength_ns", pulse_length, units::nanosecond, 1e-3, 1e4);
    io.number("averagePower_w", average_power, units::watt, 1e-12, 1e9);
    io.number("beamQualityFactor", beam_quality, units::one, 0.1, 1e3);
    if (io.reads() && beam_quality == 1.0) beam_quality.reset();  // the default of the format
    io.number("wavelength_nm", wavelength, units::nanometre, 100, 1e5);
    io.number("opticalEfficiency", efficiency, units::one, 0, 1);
    io.number("receiverDiameter_m", receiver_diameter, units::metre, 1e-6, 1e3);
    io.number("atmosphericVisibility_km", visibility, units::kilometre, 1e-3, 1e5);
    detector_fields(io);
    io.whole("maxNOR", returns_max, 0, 65535);
    io.choice("keptReturns", returns_kept, {{"first", KeptReturns::first}, {"strongest", KeptReturns::strongest}});
    io.number("receivedEnergyMin_W", received_power_min, units::nanowatt, 0, 1e12);
    io.element("FWFSettings", [&](FieldIo& inner) { waveform.fields(inner); });
  }
  /// `optics` and its attributes. Another kind than before starts from defaults.
  void optic_fields(FieldIo& io) {
    std::size_t kind = optic.index();
    io.choice("optics", kind, {{"oscillating", 0}, {"rotating", 1}, {"conic", 2}, {"line", 3}, {"risley", 4}});
    if (kind != optic.index()) optic = default_optics[kind];
    std::visit([&](auto& of_kind) { of_kind.fields(io); }, optic);
    for (const char* name :
         {"scanProduct", "scanAngleEffectiveMax_deg", "numFibers", "rotorFreq1_Hz", "rotorFreq2_Hz", "rotorFreq3_Hz",
          "angle1_deg", "angle2_deg", "angle3_deg", "refrIndex1", "refrIndex2", "refrIndex3", "refrIndex_air"})
      if (!io.knows(name)) io.without_effect({name}, "has no effect with these optics");
  }
  /// Attributes of a detector, of a scanner, a channel or a survey.
  void detector_fields(FieldIo& io) {
    io.number("accuracy_m", accuracy, units::metre, 0, 1e4);
    io.number("rangeMin_m", range_min, units::metre, 0, 1e9);
    io.number("rangeMax_m", range_max, units::metre, 0, FieldIo::any);
  }
  /// Reports limits that contradict each other.
  void check_range(const FieldIo& io) const {
    if (!(range_min < range_max))
      io.fault("rangeMax_m", "rangeMax_m is not beyond rangeMin_m: nothing could be measured");
  }
  void check_limits(const FieldIo& io) const {
    check_range(io);
    if (scan_rate_max > 0 && scan_rate_max < scan_rate_min)
      io.fault("scanFreqMax_Hz", "scanFreqMax_Hz is below scanFreqMin_Hz");
    const auto* const rotating = std::get_if<RotatingOptic>(&optic);
    if (rotating && rotating->effective_angle_max.value_or(1) == 0)
      io.fault("scanAngleEffectiveMax_deg", "scanAngleEffectiveMax_deg is 0: no pulse is emitted");
  }
  void validate() const {
    check_fields(*this);
    check_limits(FieldCheck());
  }
  bool operator==(const ChannelSettings&) const = default;
};

/// `<scanner>`, with the overrides of the survey.
struct ScannerSettings {
  std::string id{};                         ///< `id`
  std::string name{};                       ///< `name`
  std::vector<double> pulse_rates{};        ///< supported, default first; `pulseFreqs_Hz` [Hz]
  std::vector<ChannelSettings> channels{};  ///< at least one; they fire together, in order

  void validate() const {
    for (const ChannelSettings& channel : channels) channel.validate();
  }
  bool operator==(const ScannerSettings&) const = default;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
