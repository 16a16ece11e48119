// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_OPTICS_HPP
#define PULSECAST_HELIOS_DETAIL_OPTICS_HPP

#include <pulsecast/helios/detail/survey_optic.hpp>
#include <pulsecast/helios/settings.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Pulse rate of a leg; by default the scanner's first [Hz]. @throws SettingError if there is none
[[nodiscard]] inline double pulse_rate_of(const ScannerSettings& scanner, const LegScannerSettings& leg) {
  const bool by_default = !(leg.pulse_rate > 0) && !scanner.pulse_rates.empty();
  const double rate = by_default ? scanner.pulse_rates.front() : leg.pulse_rate;
  require_positive("pulseFreq_hz", rate, "Hz");
  return rate;
}

/// Turning rate of the head in a leg, within the limits of the device [rad/s].
[[nodiscard]] inline double head_rate(const ChannelSettings& channel, const LegScannerSettings& leg) noexcept {
  return std::clamp(leg.head_rate, -channel.head_rate_max, channel.head_rate_max);
}

/// True if the head turns away from its stop angle.
[[nodiscard]] inline bool turns_away(const LegScannerSettings& leg) noexcept {
  return leg.head_rate * (leg.head_stop - leg.head_start) < 0;
}

[[nodiscard]] inline double scan_angle_of(const ChannelSettings& channel, const LegScannerSettings& leg) {
  const double angle = leg.scan_angle.value_or(channel.scan_angle_max);
  return channel.scan_angle_max > 0 ? std::min(angle, channel.scan_angle_max) : angle;
}

/// Vertical limits of the pulses of a polygon mirror [rad].
struct MirrorGate {
  double low = 0, high = 0;
  bool is_limited = false;  ///< the leg requests a wider gate than the device has
  bool is_cut = false;      ///< the leg requests a gate beyond the sweep of the mirror
};

/// Gate of a leg: too wide, it is cut to the sweep of the mirror, then to the width of the device about its centre.
[[nodiscard]] inline MirrorGate mirror_gate(const ChannelSettings& channel, const RotatingOptic& optic,
                                            const LegScannerSettings& leg) {
  const double sweep = channel.scan_angle_max, effective = optic.effective_angle_max.value_or(sweep);
  const double half = std::min(effective, scan_angle_of(channel, leg));
  MirrorGate gate{leg.vertical_angle_min.value_or(-half), leg.vertical_angle_max.value_or(half)};
  gate.is_limited = gate.high - gate.low > 2 * effective + 1e-9;
  gate.is_cut = gate.low < -sweep - 1e-9 || gate.high > sweep + 1e-9;
  if (!gate.is_limited) return gate;
  gate.low = std::max(gate.low, -sweep);
  gate.high = std::min(gate.high, sweep);
  const double middle = (gate.low + gate.high) / 2;
  if (gate.high - gate.low > 2 * effective) {
    gate.low = middle - effective;
    gate.high = middle + effective;
  }
  return gate;
}

[[nodiscard]] inline bool scans_too_fast(const ChannelSettings& channel, double rate) {
  return channel.scan_rate_max > 0 && rate > channel.scan_rate_max;
}

inline void require_scan_rate(const ChannelSettings& channel, double rate) {
  const double least = channel.scan_rate_min, most = channel.scan_rate_max;
  if (rate < least || scans_too_fast(channel, rate))
    throw SettingError("scanFreq_hz", rate, "Hz",
                       text::joined({"within the limits of the device, ", text::to_text(least), " to ",
                                     most > 0 ? text::to_text(most) : "any", " Hz"}));
}

/// Rate of an oscillating mirror, within `scan_product_max` and in cycles of whole pulses [Hz].
[[nodiscard]] inline double oscillation_rate(const ChannelSettings& channel, const OscillatingOptic& optic,
                                             const LegScannerSettings& leg, double pulse_rate) {
  const double angle = scan_angle_of(channel, leg), most = optic.scan_product_max;
  const double f = angle * leg.scan_rate > most ? most / angle : leg.scan_rate;
  const double pulses = std::floor(pulse_rate / f);
  return pulses >= 2 ? pulse_rate / pulses : f;
}

/// Number for messages, rounded to three digits after the point.
[[nodiscard]] inline std::string brief(double value) { return text::to_text(std::round(value * 1e3) / 1e3); }

namespace detail {

/// Notes on rates and angles that channel `c` rounds or cuts, without plain limits of the first.
[[nodiscard]] inline std::vector<std::string> limit_notes(const ScannerSettings& scanner, std::size_t c,
                                                          const LegScannerSettings& leg, double pulse_rate) {
  const ChannelSettings& channel = scanner.channels[c];
  std::vector<std::string> notes;
  const auto note = [&](const std::string& text) {
    notes.push_back((c > 0 ? "channel " + std::to_string(c) + ": " : "") + text);
  };
  const auto deg = [](double angle) { return brief(degrees(angle)); };
  const double sweep = channel.scan_angle_max, asked = leg.scan_rate;
  if (const auto* const mirror = std::get_if<OscillatingOptic>(&channel.optic); mirror && asked > 0) {
    const double f = oscillation_rate(channel, *mirror, leg, pulse_rate);
    const bool by_product = scan_angle_of(channel, leg) * asked > mirror->scan_product_max;
    if (std::fabs(f - asked) > 1e-4 * asked)
      note(text::joined({"scanFreq_hz of ", brief(asked), " is taken as ", brief(f),
                         by_product ? ", for the scanner's scanProduct, and" : ",",
                         " for a cycle is a whole number of pulses, here ", brief(pulse_rate / f)}));
  }
  if (const auto* const mirror = std::get_if<RotatingOptic>(&channel.optic); mirror && asked > 0 && sweep > 0) {
    const MirrorGate gate = mirror_gate(channel, *mirror, leg);
    const std::string angles = "verticalAngleMin_deg and verticalAngleMax_deg ",
                      within = deg(std::max(gate.low, -sweep)) + " to " + deg(std::min(gate.high, sweep)) + " deg";
    if (gate.is_cut && !gate.is_limited)
      note(text::joined({angles, "reach beyond the mirror's sweep, -", deg(sweep), " to ", deg(sweep),
                         " deg: pulses leave from ", within}));
    if (gate.is_limited && c > 0) note(angles + "are limited to " + within);
  }
  if (c == 0) return notes;
  if (leg.scan_angle && scan_angle_of(channel, leg) < *leg.scan_angle)
    note("scanAngle_deg is limited to " + deg(sweep));
  if (head_rate(channel, leg) != head_rate(scanner.channels[0], leg))
    note("headRotatePerSec_deg is limited to " + deg(channel.head_rate_max) + ", unlike that of the first channel");
  return notes;
}

}  // namespace detail

/// Builds the optic of a channel. `tilt` is added to the mount of the channel.
struct OpticBuilder {
  const ChannelSettings& channel;
  const LegScannerSettings& leg;
  double pulse_rate;
  double active;          ///< running time since the last start [s]
  double ahead = active;  ///< result [s]
  double tilt = 0;        ///< result [rad]

  [[nodiscard]] SurveyOptic::AnyOptic operator()(const OscillatingOptic& optic) {
    if (!(leg.scan_rate > 0))
      throw SettingError("scanFreq_hz", leg.scan_rate, "Hz", "greater than 0 for an oscillating mirror");
    const double f = oscillation_rate(channel, optic, leg, pulse_rate);
    return OscillatingMirror{.cycle_rate = f,
                             .half_angle = scan_angle_of(channel, leg),
                             .turning_time = std::min(100 / pulse_rate, 0.5 / f)};  // 100 pulses
  }

  [[nodiscard]] SurveyOptic::AnyOptic operator()(const RotatingOptic& optic) {
    const double sweep = channel.scan_angle_max, f = leg.scan_rate;
    ahead = 0;
    if (!(f > 0) || !(sweep > 0)) return FixedBeam{};  // sensors that scan by their head
    const auto [low, high, is_limited, is_cut] = mirror_gate(channel, optic, leg);
    if (high < low) throw SettingError("verticalAngleMax_deg", degrees(high), "deg", "at least verticalAngleMin_deg");
    ahead = 0.5 / f;  // a leg begins in the middle of a facet
    return PolygonMirror{
        .line_rate = f, .sweep = std::min(sweep, pi), .angle_min = std::max(low, -pi), .angle_max = std::min(high, pi)};
  }

  [[nodiscard]] SurveyOptic::AnyOptic operator()(const ConicOptic&) {
    const double f = leg.scan_rate > 0 ? leg.scan_rate : channel.scan_rate_max;
    if (!(f > 0)) throw SettingError("scanFreq_hz", f, "Hz", "greater than 0 for a Palmer mirror");
    return PalmerMirror{.rotation_rate = f, .half_angle = scan_angle_of(channel, leg)};
  }

  /// Fibres divide the full scan angle evenly, each at the lower end of its share.
  [[nodiscard]] SurveyOptic::AnyOptic operator()(const LineOptic& optic) {
    const double angle = scan_angle_of(channel, leg), n = optic.fibers;
    tilt = optic.fibers > 1 ? -angle / n : 0;
    return FiberArray{.fibers = static_cast<std::uint32_t>(optic.fibers),
                      .fiber_rate = pulse_rate,
                      .half_angle = angle * (n - 1) / n};
  }

  [[nodiscard]] SurveyOptic::AnyOptic operator()(const RisleyOptic& optic) {
    RisleyPrisms out{.surrounding_index = optic.air_refractive_index, .incident = optic.incident_beam};
    for (const RisleyPrism& p : optic.prisms)
      if (std::fabs(p.angle) > radians(1e-6))
        out.prisms.push_back({.wedge = std::fabs(p.angle),
                              .rotation_rate = p.rotation_rate,
                              .refractive_index = p.refractive_index,
                              .inclined_exit = p.angle < 0});
    if (out.prisms.empty()) return FixedBeam{aimed_along(normalize(optic.incident_beam))};
    return out;
  }
};

/// Error formula; none if the text is empty. @throws SettingError if it is not finite at one of 64
/// angles of the optic: poles between pass, as no beam reaches them
[[nodiscard]] inline std::shared_ptr<const Formula> error_formula(const char* field, const std::string& text,
                                                                  const SurveyOptic::AnyOptic& optic) {
  if (text.empty()) return nullptr;
  const auto error = std::make_shared<const Formula>(text, "THETA");
  const auto* const mirror = std::get_if<PolygonMirror>(&optic);  // others have no deflection angle
  const double low = mirror ? mirror->angle_min : 0, high = mirror ? mirror->angle_max : 0;
  constexpr int places = 64;
  for (int i = 0; i < places; ++i) {
    const double angle = low + (high - low) * (i + 0.518) / places, value = (*error)(angle);
    if (!std::isfinite(value))  // drops the sign that some platforms give NaN
      throw SettingError(field, std::isnan(value) ? std::fabs(value) : value, "",
                         "a formula with a finite value, also for a THETA of " + text::to_text(angle));
  }
  return error;
}

/// Optic of a channel in a leg. The beam origin is along the axes of the platform, like that of the mount: they add up,
/// and `boresight` (instrument on the body) does not turn it. @throws SettingError with the attribute at fault
[[nodiscard]] inline SurveyOptic survey_optic(const ChannelSettings& channel, const LegScannerSettings& leg,
                                              double pulse_rate, const Rotation& boresight = no_rotation,
                                              double active = 0) {
  if (leg.active) require_scan_rate(channel, leg.scan_rate);
  OpticBuilder build{channel, leg, pulse_rate, active};
  SurveyOptic out{.optic = std::visit(build, channel.optic)};
  out.ahead = Tick::of_seconds(build.ahead + leg.warm_up);
  out.emitter = {channel.beam_origin.rotation.rotation() * aimed_above(build.tilt).rotation,
                 conjugate(boresight) * channel.beam_origin.position};
  const double rate = head_rate(channel, leg), start = leg.head_start + rate * leg.warm_up;
  out.head = {.angular_rate = rate, .start = start, .axis = channel.head_axis};
  const ErrorFormulas& errors = channel.errors;
  out.deflection_error = error_formula("deflectionError", errors.deflection, out.optic);
  out.head_error = error_formula("headError", errors.head, out.optic);
  out.range_error = error_formula("rangeError", errors.range, out.optic);
  out.head_zero_threshold = errors.head_zero_threshold;
  return out;
}

/// Laser of a channel in a leg. A beam quality puts the waist at the exit.
[[nodiscard]] inline Laser survey_laser(const ChannelSettings& channel, const LegScannerSettings& leg) {
  const double divergence = leg.divergence.value_or(channel.divergence);
  Laser laser{.wavelength = channel.wavelength,
              .peak_power = channel.average_power,
              .pulse_length = channel.pulse_length,
              .divergence = divergence};
  if (channel.beam_quality)  // Source: ISO 11146-1:2005, M^2 = pi d0 theta / (4 lambda)
    laser.waist_diameter = 4 * *channel.beam_quality * channel.wavelength / (pi * divergence);
  return laser;
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
