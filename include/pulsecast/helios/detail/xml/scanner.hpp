// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_SCANNER_HPP
#define PULSECAST_HELIOS_DETAIL_XML_SCANNER_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/helios/detail/formula.hpp>
#include <pulsecast/helios/detail/receivers.hpp>
#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>
#include <pulsecast/helios/settings.hpp>

/// `<scanner>` and its children.
namespace PULSECAST_NAMESPACE::helios::xml {

template <class Io>
void fields(Io& io, Of<Io, FullWaveformSettings>& waveform) {
  io.number("binSize_ns", waveform.bin_size, units::nanosecond, 1e-4, 1e4);
  io.number("winSize_ns", waveform.window, units::nanosecond, 0, 1e6);
  io.whole("beamSampleQuality", waveform.rings, 1, 100);
  io.number("maxFullwaveRange_ns", waveform.duration_max, units::nanosecond, 0, 1e9);
  io.without_effect({"apertureDiameter_m", "minEchoWidth", "peakEnergy", "scannerEfficiency", "atmosphericVisibility",
                     "scannerWaveLength", "beamDivergence_rad", "numTimeBins", "numFullwaveBins"});
}

template <class Io>
void fields(Io& io, Of<Io, OscillatingOptic>& optic) {
  io.number("scanProduct", optic.scan_product_max, units::degree_hertz, 1e-3, 1e12);
}

template <class Io>
void fields(Io& io, Of<Io, RotatingOptic>& optic) {
  io.number("scanAngleEffectiveMax_deg", optic.effective_angle_max, units::degree, 0, 180);
}

template <class Io>
void fields(Io&, Of<Io, ConicOptic>&) {}

template <class Io>
void fields(Io& io, Of<Io, LineOptic>& optic) {
  io.whole("numFibers", optic.fibers, 1, 1'000'000);
}

template <class Io>
void fields(Io& io, Of<Io, RisleyOptic>& optic) {
  static constexpr std::array rates{"rotorFreq1_Hz", "rotorFreq2_Hz", "rotorFreq3_Hz"};
  static constexpr std::array angles{"angle1_deg", "angle2_deg", "angle3_deg"};
  static constexpr std::array indices{"refrIndex1", "refrIndex2", "refrIndex3"};
  for (std::size_t i = 0; i < optic.prisms.size(); ++i) {
    io.number(rates[i], optic.prisms[i].rotation_rate, units::hertz, -1e5, 1e5);
    io.number(angles[i], optic.prisms[i].angle, units::degree, -89, 89);
    io.number(indices[i], optic.prisms[i].refractive_index, units::one, 0.1, 10);
  }
  io.number("refrIndex_air", optic.air_refractive_index, units::one, 0.1, 10);
  direction(io, "incidentBeam", optic.incident_beam);
}

/// Default optic of a kind.
template <std::size_t... I>
OpticSettings optic_of(std::size_t kind, std::index_sequence<I...>) {
  OpticSettings optic;
  ((kind == I ? void(optic.emplace<I>()) : void()), ...);
  return optic;
}

/// `optics` and its attributes. Another kind than before starts from defaults.
template <class Io>
void fields(Io& io, Of<Io, OpticSettings>& optic) {
  std::size_t kind = optic.index();
  io.choice("optics", kind,
            XmlWords<std::size_t>{{"oscillating", 0}, {"rotating", 1}, {"conic", 2}, {"line", 3}, {"risley", 4}});
  if constexpr (Io::reads)
    if (kind != optic.index()) optic = optic_of(kind, std::make_index_sequence<std::variant_size_v<OpticSettings>>());
  std::visit([&](auto& of_kind) { fields(io, of_kind); }, optic);
  if constexpr (Io::reads) {
    for (const char* name :
         {"scanProduct", "scanAngleEffectiveMax_deg", "numFibers", "rotorFreq1_Hz", "rotorFreq2_Hz", "rotorFreq3_Hz",
          "angle1_deg", "angle2_deg", "angle3_deg", "refrIndex1", "refrIndex2", "refrIndex3", "refrIndex_air"})
      if (!io.knows(name)) io.without_effect({name}, "has no effect with these optics");
  }
}

/// Reports a formula that is invalid, or not finite between two values of its variable.
template <class Io>
void check_formula(const Io& io, const char* name, const std::string& text, const char* variable, double low,
                   double high) {
  constexpr int places = 256;
  try {
    if (text.empty()) return;
    const Formula formula(text, variable);
    for (int i = 0; i < places; ++i)
      if (std::isfinite(formula(low + (high - low) * (i + 0.518) / places))) return;
    io.fault(name, XmlInput::said(name, text) + " is not finite for any " + variable +
                       ": expected a formula with a finite value");
  } catch (const std::invalid_argument& error) {
    io.fault(name, error.what());
  }
}

/// Optional element with a formula.
template <class Io, class More>
void formula(Io& io, const char* name, Of<Io, std::string>& text, More more) {
  const auto all = [&](auto& inner) {
    inner.require({"expr"});
    inner.text("expr", text);
    check_formula(inner, "expr", text, "THETA", -std::numbers::pi, std::numbers::pi);
    more(inner);
  };
  if constexpr (Io::reads) {
    if (io.child(name, all) && text.empty())
      io.report().warn(io.place(), "<" + std::string(name) + "> has an empty formula, and no effect");
  } else if (!text.empty()) {
    io.child(name, all);
  }
}

template <class Io>
void fields(Io& io, Of<Io, ErrorFormulas>& errors) {
  const auto nothing = [](auto&) {};
  formula(io, "deflectionError", errors.deflection, nothing);
  formula(io, "headError", errors.head, [&](auto& inner) {
    inner.number("zeroSinThreshold_deg", errors.head_zero_threshold, units::degree, 0, 180);
  });
  formula(io, "rangeError", errors.range, nothing);
}

/// Attributes of a detector, of a scanner, a channel or a survey.
template <class Io>
void detector_fields(Io& io, Of<Io, ChannelSettings>& channel) {
  io.number("accuracy_m", channel.accuracy, units::metre, 0, 1e4);
  io.number("rangeMin_m", channel.range_min, units::metre, 0, 1e9);
  io.number("rangeMax_m", channel.range_max, units::metre, 0, any);
}

/// Factor of the noise, after `detector_fields`.
template <class Io>
void range_noise(Io& io, Of<Io, ChannelSettings>& channel) {
  static constexpr const char* name = "distanceMeasurementError";
  if (Io::reads || !channel.errors.range_noise.empty()) io.text(name, channel.errors.range_noise);
  if (channel.errors.range_noise.empty()) return;
  [[maybe_unused]] std::size_t faults = 0;
  if constexpr (Io::reads) faults = io.report().faults();
  check_formula(io, name, channel.errors.range_noise, "t", channel.range_min, std::min(channel.range_max, 1e6));
  if constexpr (Io::reads)
    if (io.report().faults() != faults) return;
  if (!(channel.range_min < channel.range_max)) return;
  try {
    (void)survey_receiver(channel);
  } catch (const SettingError& error) {
    io.fault(name, error.what());
  }
}

/// Note on bins that are limited; empty for others.
inline std::string bin_note(const ChannelSettings& channel) {
  const double bin = channel.waveform.bin_size, length = channel.pulse_length, limited = detail::limited_bin(channel);
  const auto ns = [](double seconds) { return xml_number(units::nanosecond.number(seconds)) + " ns"; };
  return bin == limited ? ""
                        : "binSize_ns is " + ns(bin) + ", and pulses are " + ns(length) + " long: it is limited to " +
                              ns(limited) + "; expected bins from " + ns(length / WaveformSettings::max_samples) +
                              " to " + ns(length);
}

/// Attributes of a scanner or of each of its channels.
template <class Io>
void fields(Io& io, Of<Io, ChannelSettings>& channel) {
  fields(io, channel.optic);
  io.number("scanAngleMax_deg", channel.scan_angle_max, units::degree, 0, 180);
  io.number("scanFreqMin_Hz", channel.scan_rate_min, units::hertz, 0, 1e6);
  io.number("scanFreqMax_Hz", channel.scan_rate_max, units::hertz, 0, 1e6);
  io.child("beamOrigin", [&](auto& inner) { fields(inner, channel.beam_origin); });
  direction(io, "headRotateAxis", channel.head_axis);
  io.number("headRotatePerSecMax_deg", channel.head_rate_max, units::degree, 0, 1e6);
  io.number("beamDivergence_rad", channel.divergence, units::radian, 1e-9, 0.5);
  io.number("pulseLength_ns", channel.pulse_length, units::nanosecond, 1e-3, 1e4);
  io.number("averagePower_w", channel.average_power, units::watt, 1e-12, 1e9);
  io.number("beamQualityFactor", channel.beam_quality, units::one, 0.1, 1e3);
  if constexpr (Io::reads)
    if (channel.beam_quality == 1.0) channel.beam_quality.reset();  // the format's default says nothing
  io.number("wavelength_nm", channel.wavelength, units::nanometre, 100, 1e5);
  io.number("opticalEfficiency", channel.efficiency, units::one, 0, 1);
  io.number("receiverDiameter_m", channel.receiver_diameter, units::metre, 1e-6, 1e3);
  io.number("atmosphericVisibility_km", channel.visibility, units::kilometre, 1e-3, 1e5);
  detector_fields(io, channel);
  io.whole("maxNOR", channel.returns_max, 0, 65535);
  io.choice("keptReturns", channel.returns_kept,
            {{"first", KeptReturns::first}, {"strongest", KeptReturns::strongest}});
  io.number("receivedEnergyMin_W", channel.received_power_min, units::nanowatt, 0, 1e12);
  io.child("FWFSettings", [&](auto& inner) { fields(inner, channel.waveform); });
  fields(io, channel.errors);
  range_noise(io, channel);  // extension: a survey has it in <detectorSettings>
}

/// Checks limits against each other.
template <class Io>
void check(Io& io, Of<Io, ChannelSettings>& channel) {
  if (!(channel.range_min < channel.range_max))
    io.fault("rangeMax_m", "rangeMax_m is not beyond rangeMin_m: nothing could be measured");
  if (channel.scan_rate_max > 0 && channel.scan_rate_max < channel.scan_rate_min)
    io.fault("scanFreqMax_Hz", "scanFreqMax_Hz is below scanFreqMin_Hz");
  const auto* const rotating = std::get_if<RotatingOptic>(&channel.optic);
  if (!rotating && (!channel.errors.deflection.empty() || !channel.errors.head.empty())) {
    io.warn("optics", "<deflectionError> and <headError> have no effect with these optics");
    if constexpr (Io::reads) channel.errors.deflection = channel.errors.head = "";
  }
  if (rotating && rotating->effective_angle_max.value_or(1) == 0)
    io.fault("scanAngleEffectiveMax_deg", "scanAngleEffectiveMax_deg is 0: no pulse is emitted");
  const auto* const risley = std::get_if<RisleyOptic>(&channel.optic);
  if (risley && risley->prisms[0].angle == 0 && risley->prisms[1].angle == 0 && risley->prisms[2].angle == 0)
    io.warn("optics", "no prism has an angle: the beam is not deflected");
}

inline constexpr double least_rate = 1e-3, most_rate = 1e8;  ///< pulse rates of a scanner [Hz]
inline constexpr std::size_t most_rates = 1000;              ///< number of them

/// `pulseFreqs_Hz`: numbers separated by commas.
template <class Io>
void pulse_rates(Io& io, Of<Io, std::vector<double>>& rates) {
  if constexpr (Io::reads) {
    const auto text = io.value("pulseFreqs_Hz");
    if (!text) return;
    for (std::string_view rest = *text;;) {
      const std::size_t end = rest.find(',');
      const std::string_view one = rest.substr(0, end);
      const bool is_last = end == std::string_view::npos;
      const auto rate = number_of(one);
      if (one.find_first_not_of(" \t\r\n") == std::string_view::npos && !(is_last && rates.empty()))
        io.warn("pulseFreqs_Hz",
                XmlInput::said("pulseFreqs_Hz", *text) + ": there is no number between two commas or at the end");
      else if (!rate || !(*rate >= least_rate && *rate <= most_rate) || rates.size() == most_rates)
        return io.fault("pulseFreqs_Hz", XmlInput::said("pulseFreqs_Hz", *text) + ": expected numbers from " +
                                             xml_number(least_rate) + " to " + xml_number(most_rate) +
                                             " Hz, with commas between");
      else
        rates.push_back(*rate);
      if (is_last) return;
      rest.remove_prefix(end + 1);
    }
  } else {
    std::string text;
    require_within("pulseFreqs_Hz (number)", static_cast<double>(rates.size()), 0, most_rates, "");
    for (const double rate : rates) require_within("pulseFreqs_Hz", rate, least_rate, most_rate, "Hz");
    for (const double rate : rates) text.append(text.empty() ? "" : ",").append(xml_number(rate));
    io.text("pulseFreqs_Hz", text);
  }
}

template <class Io>
void fields(Io& io, Of<Io, ScannerSettings>& scanner) {
  io.require({"id", "optics", "pulseFreqs_Hz"});
  io.text("id", scanner.id);
  io.text("name", scanner.name);
  pulse_rates(io, scanner.pulse_rates);
  if constexpr (Io::reads) {
    ChannelSettings common;
    fields(io, common);
    const bool has_channels = io.child("channels", [&](auto& list) {
      list.children("channel", scanner.channels, [&](auto& inner, ChannelSettings& channel) {
        channel = common;
        channel.id = std::to_string(scanner.channels.size() - 1);
        inner.text("id", channel.id);
        fields(inner, channel);
        check(inner, channel);
      });
      if (scanner.channels.empty())
        list.report().warn(list.place(), "<channels> holds no <channel>: the scanner has one");
    });
    if (!has_channels || scanner.channels.empty()) check(io, scanner.channels.emplace_back(std::move(common)));
  } else if (scanner.channels.size() == 1 && scanner.channels.front().id.empty()) {
    fields(io, scanner.channels.front());
    check(io, scanner.channels.front());
  } else {
    if (!scanner.channels.empty())
      fields(io, optic_of(scanner.channels.front().optic.index(),
                          std::make_index_sequence<std::variant_size_v<OpticSettings>>()));
    io.child("channels", [&](auto& list) {
      list.children("channel", scanner.channels, [](auto& inner, const ChannelSettings& channel) {
        inner.text("id", channel.id);
        fields(inner, channel);
        check(inner, channel);
      });
    });
  }
}

}  // namespace PULSECAST_NAMESPACE::helios::xml

#endif
