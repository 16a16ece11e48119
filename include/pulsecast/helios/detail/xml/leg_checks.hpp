// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_LEG_CHECKS_HPP
#define PULSECAST_HELIOS_DETAIL_XML_LEG_CHECKS_HPP

#include <pulsecast/helios/detail/optics.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Checks the legs of a survey. Faults: legs that never end, give no pulse, or exceed scanner or platform.
class LegChecks {
 public:
  /// `survey` must have a scanner with a channel.
  explicit LegChecks(const SurveySettings& survey) : survey_(survey) {}

  /// Checks the path of a leg; `io` is that of its `<platformSettings>`.
  void check_platform(const FieldIo& io, std::size_t i) const {
    const LegPlatformSettings& platform = survey_.legs[i].platform;
    if (survey_.platform.kind == PlatformKind::interpolated) {
      if (!platform.trajectory || platform.trajectory->file.empty())
        io.fault("trajectory",
                 "<platformSettings> has no attribute 'trajectory', which platform=\"interpolated\" follows");
      return;
    }
    if (platform.trajectory)
      io.warn("trajectory", "trajectory attributes have no effect unless platform=\"interpolated\"");
    if (survey_.platform.kind != PlatformKind::multicopter) {
      const std::string why = " has no effect with this type of platform";
      if (platform.smooth_turn) io.warn("smoothTurn", "a smooth turn" + why);
      if (platform.yaw_at_departure) io.warn("yawAtDeparture_deg", "yawAtDeparture_deg" + why);
    }
    if (legs_connect(survey_.platform.kind)) check_way(io, i);
  }

  /// Checks the `<scannerSettings>` of a leg, which `io` reads, with a `verticalResolution_deg` or 0 [rad].
  void check_scanner(const FieldIo& io, std::size_t i, double resolution = 0) const {
    if (only_ends(survey_, i)) return;
    const LegSettings& settings = survey_.legs[i];
    const LegScannerSettings& s = settings.scanner;
    const ChannelSettings& device = survey_.scanner.channels.front();
    check_head(io, device, settings, i);
    if (!s.active) return;
    check_rates(io, device, s, resolution);
    if (s.scan_angle && device.scan_angle_max >= radians(15) && is_radians({*s.scan_angle}, pi / 2))
      io.warn("scanAngle_deg", "scanAngle_deg is " + shortest(*s.scan_angle) + ", and the scanner's maximum " +
                                   shortest(device.scan_angle_max) + ": given in radians, not degrees?");
    if (s.scan_angle && scan_angle_of(device, s) < *s.scan_angle)
      io.warn("scanAngle_deg",
              "scanAngle_deg exceeds the scanner's maximum: it is limited to " + shortest(device.scan_angle_max));
    check_gate(io, device, s);
  }

 private:
  /// Computed number, to six decimals.
  [[nodiscard]] static std::string brief(double value) { return xml_number(std::round(value * 1e6) / 1e6); }

  /// Angle as documents give it.
  [[nodiscard]] static std::string shortest(double angle) { return xml_number(units::degree.number(angle)); }

  /// True for angles whose degrees are at most `largest`, not all whole.
  [[nodiscard]] static bool is_radians(std::initializer_list<double> angles, double largest) {
    const auto given = [](double angle) { return units::degree.number(angle); };
    return std::ranges::all_of(angles, [&](double angle) { return std::fabs(given(angle)) <= largest + 1e-3; }) &&
           std::ranges::any_of(angles, [&](double angle) { return given(angle) != std::round(given(angle)); });
  }

  void check_way(const FieldIo& io, std::size_t i) const {
    const LegSettings& settings = survey_.legs[i];
    const std::size_t legs = survey_.legs.size();
    const bool turns = settings.scanner.head_stop != settings.scanner.head_start;
    if (legs == 1 && !settings.duration_max && !turns)
      io.fault("maxDuration_s",
               "the only leg of a moving platform: expected another <leg> as its destination, or "
               "maxDuration_s of its stay here");
    if (only_ends(survey_, i) && settings.duration_max && settings.scanner.active)
      io.warn("",
              "the last leg of a moving platform is the end of its path, and has no pulses: to stay there for "
              "maxDuration_s, expected another <leg> at the same position");
    if (i + 1 == legs) return;
    if (stays_in_place(survey_.legs, i)) {
      if (!settings.duration_max && !turns)
        io.warn("x",
                "the next leg begins at the same position, so this one ends at once: maxDuration_s would be "
                "the duration of a stay");
    } else if (settings.platform.speed == 0) {
      io.fault("movePerSec_m", "the leg never ends: movePerSec_m is 0; expected a speed");
    }
  }

  void check_rates(const FieldIo& io, const ChannelSettings& device, const LegScannerSettings& s,
                   double resolution) const {
    const double pulse_rate = pulse_rate_of(survey_.scanner, s);
    const auto hertz = [](double value) { return xml_number(value) + " Hz"; };
    const auto limit = [&](const char* expected, const char* name, double frequency) {
      if (resolution == 0)
        return io.fault("scanFreq_hz", text::joined({"scanFreq_hz is ", hertz(s.scan_rate), ": expected ", expected,
                                                     " the scanner's ", name, ", ", hertz(frequency)}));
      const double angle = degrees(resolution);
      io.fault("verticalResolution_deg",
               text::joined({"verticalResolution_deg of ", brief(angle), " takes ", brief(s.scan_rate),
                             " lines a second at ", hertz(pulse_rate), ": expected ", expected, " ",
                             brief(angle * frequency / s.scan_rate), ", for the scanner's ", name, " is ",
                             hertz(frequency)}));
    };
    if (s.scan_rate < device.scan_rate_min) limit("at least", "scanFreqMin_Hz", device.scan_rate_min);
    if (scans_too_fast(device, s.scan_rate)) limit("at most", "scanFreqMax_Hz", device.scan_rate_max);
    if (s.scan_rate == 0 && std::holds_alternative<OscillatingOptic>(device.optic))
      io.fault("scanFreq_hz", "scanFreq_hz is 0, so the mirror does not swing: expected a frequency");
    if (s.scan_rate >= pulse_rate)
      io.fault("scanFreq_hz",
               "scanFreq_hz is " + hertz(s.scan_rate) + ": expected less than pulseFreq_hz, " + hertz(pulse_rate));
    const std::vector<double>& rates = survey_.scanner.pulse_rates;
    if (!rates.empty() && std::ranges::find(rates, pulse_rate) == rates.end())
      io.warn("pulseFreq_hz", "pulseFreq_hz of " + hertz(pulse_rate) + " is not one of the scanner's pulse rates");
  }

  void check_gate(const FieldIo& io, const ChannelSettings& device, const LegScannerSettings& s) const {
    const auto* const rotating = std::get_if<RotatingOptic>(&device.optic);
    if (!rotating) {
      if (s.vertical_angle_min || s.vertical_angle_max)
        io.warn("verticalAngleMin_deg",
                "verticalAngleMin_deg and verticalAngleMax_deg have no effect with these optics");
      return;
    }
    const auto [low, high, is_limited, is_cut] = mirror_gate(device, *rotating, s);
    const auto in_degrees = [](double angle) { return brief(degrees(angle)); };
    if (s.scan_rate > 0 && !(low < high))
      io.fault("verticalAngleMin_deg",
               text::joined({"no pulse is emitted between ", shortest(low), " and ", shortest(high),
                             " deg: expected verticalAngleMin_deg below "
                             "verticalAngleMax_deg"}));
    const double width = 2 * rotating->effective_angle_max.value_or(device.scan_angle_max);
    if (s.vertical_angle_min && s.vertical_angle_max && width >= radians(30) && is_radians({low, high}, pi))
      io.warn("verticalAngleMin_deg", text::joined({"verticalAngleMin_deg and verticalAngleMax_deg are ", shortest(low),
                                                    " and ", shortest(high), ", and the scanner has ",
                                                    in_degrees(width), " deg: given in radians, not degrees?"}));
    if (is_limited)
      io.warn("verticalAngleMin_deg",
              text::joined({"verticalAngleMin_deg and verticalAngleMax_deg are further apart than the scanner's ",
                            in_degrees(width), " deg: they are limited to ", in_degrees(low), " and ", in_degrees(high),
                            " deg"}));
  }

  void check_head(const FieldIo& io, const ChannelSettings& device, const LegSettings& settings, std::size_t i) const {
    const LegScannerSettings& s = settings.scanner;
    const double speed = head_rate(device, s);
    for (const auto& [name, angle] :
         {std::pair("headRotateStart_deg", s.head_start), std::pair("headRotateStop_deg", s.head_stop)})
      if (looks_like_radians(angle, true))
        io.warn(name, text::joined({name, " is ", shortest(angle), ": given in radians, not degrees?"}));
    if (s.head_rate != speed)
      io.warn("headRotatePerSec_deg",
              device.head_rate_max == 0
                  ? "headRotatePerSec_deg has no effect: the scanner's headRotatePerSecMax_deg is 0"
                  : "headRotatePerSec_deg exceeds the scanner's maximum: it is limited to " +
                        shortest(device.head_rate_max));
    if (turns_away(s))
      io.fault("headRotateStop_deg",
               "the head turns away from headRotateStop_deg: expected headRotatePerSec_deg of the other sign");
    if (settings.duration_max) return;
    const bool turns = s.head_stop != s.head_start;
    if (turns && speed == 0)
      io.fault("headRotateStop_deg",
               text::joined({"the leg never ends: the head does not turn",
                             device.head_rate_max == 0 ? ", as the scanner's headRotatePerSecMax_deg is 0" : "",
                             "; expected headRotatePerSec_deg, headRotateStop_deg the same as headRotateStart_deg, or "
                             "maxDuration_s"}));
    const PlatformKind kind = survey_.platform.kind;
    if (turns || !(kind == PlatformKind::stationary || is_stationary(survey_, i))) return;
    if (speed != 0)
      io.warn("headRotateStop_deg", "headRotateStop_deg equals headRotateStart_deg: the leg ends at once");
    else if (!legs_connect(kind))  // whose ends are reported already
      io.fault("maxDuration_s", "the leg never ends: neither platform nor head moves; expected maxDuration_s" +
                                    std::string(i == 0 ? "" : " for each leg"));
  }

  const SurveySettings& survey_;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
