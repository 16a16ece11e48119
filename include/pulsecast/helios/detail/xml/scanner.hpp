// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_SCANNER_HPP
#define PULSECAST_HELIOS_DETAIL_XML_SCANNER_HPP

#include <pulsecast/helios/detail/receivers.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>

/// `<scanner>` and its children.
namespace PULSECAST_NAMESPACE::helios::xml {

/// Reports a formula that is invalid, or finite nowhere between two values of its variable.
inline void check_formula(const FieldIo& io, const char* name, const std::string& text, const char* variable,
                          double low, double high) {
  constexpr int places = 256;
  try {
    if (text.empty()) return;
    const Formula formula(text, variable);
    for (int i = 0; i < places; ++i)
      if (std::isfinite(formula(low + (high - low) * (i + 0.518) / places))) return;
    io.fault(name, text::joined({said(name, text), " is not finite for any ", variable,
                                 ": expected a formula with a finite value"}));
  } catch (const std::invalid_argument& error) {
    io.fault(name, error.what());
  }
}

/// Optional element with a formula.
inline void formula(FieldIo& io, const char* name, std::string& text, double* zero_threshold = nullptr) {
  if (!io.reads() && text.empty()) return;
  const bool is_there = io.element(name, [&](FieldIo& inner) {
    inner.require({"expr"});
    inner.text("expr", text);
    check_formula(inner, "expr", text, "THETA", -std::numbers::pi, std::numbers::pi);
    if (zero_threshold) inner.number("zeroSinThreshold_deg", *zero_threshold, units::degree, 0, 180);
  });
  if (is_there && text.empty()) io.warn("", "<" + std::string(name) + "> has an empty formula, and no effect");
}

/// Factor of the noise, after `detector_fields`.
inline void range_noise(FieldIo& io, ChannelSettings& channel) {
  static constexpr const char* name = "distanceMeasurementError";
  if (io.reads() || !channel.errors.range_noise.empty()) io.text(name, channel.errors.range_noise);
  if (channel.errors.range_noise.empty()) return;
  const std::size_t faults = io.reads() ? input(io).report().faults() : 0;
  check_formula(io, name, channel.errors.range_noise, "t", channel.range_min, std::min(channel.range_max, 1e6));
  if (io.reads() && input(io).report().faults() != faults) return;
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
  if (bin == limited) return "";
  return text::joined({"binSize_ns is ", ns(bin), ", and pulses are ", ns(length), " long: it is limited to ",
                       ns(limited), "; expected bins from ", ns(length / WaveformSettings::max_samples), " to ",
                       ns(length)});
}

/// Attributes of a scanner or of each of its channels.
inline void fields(FieldIo& io, ChannelSettings& channel) {
  channel.fields(io);
  formula(io, "deflectionError", channel.errors.deflection);
  formula(io, "headError", channel.errors.head, &channel.errors.head_zero_threshold);
  formula(io, "rangeError", channel.errors.range);
  range_noise(io, channel);  // extension: a survey has it in <detectorSettings>
}

/// Checks limits against each other.
inline void check(FieldIo& io, ChannelSettings& channel) {
  channel.check_limits(io);
  if (!std::holds_alternative<RotatingOptic>(channel.optic) &&
      (!channel.errors.deflection.empty() || !channel.errors.head.empty())) {
    io.warn("optics", "<deflectionError> and <headError> have no effect with these optics");
    if (io.reads()) channel.errors.deflection = channel.errors.head = "";
  }
  const auto is_absent = [](const RisleyPrism& prism) { return prism.angle == 0; };
  const auto* const risley = std::get_if<RisleyOptic>(&channel.optic);
  if (risley && std::ranges::all_of(risley->prisms, is_absent))
    io.warn("optics", "no prism has an angle: the beam is not deflected");
}

inline constexpr double least_rate = 1e-3, most_rate = 1e8;  ///< pulse rates of a scanner [Hz]
inline constexpr std::size_t most_rates = 1000;              ///< number of them

/// Reads `pulseFreqs_Hz`: numbers separated by commas.
inline void pulse_rates(XmlInput& io, std::vector<double>& rates) {
  const auto text = io.value("pulseFreqs_Hz");
  if (!text) return;
  const std::string given = said("pulseFreqs_Hz", *text);
  for (std::size_t at = 0, end = 0; end != text->npos; at = end + 1) {
    end = text->find(',', at);
    const std::string one = text->substr(at, end - at);
    const auto rate = number_of(one);
    if (one.find_first_not_of(" \t\r\n") == one.npos && !(end == text->npos && rates.empty()))
      io.warn("pulseFreqs_Hz", given + ": there is no number between two commas or at the end");
    else if (!rate || !(*rate >= least_rate && *rate <= most_rate) || rates.size() == most_rates)
      return io.fault("pulseFreqs_Hz", given + ": expected numbers from " + xml_number(least_rate) + " to " +
                                           xml_number(most_rate) + " Hz, with commas between");
    else
      rates.push_back(*rate);
  }
}
inline void pulse_rates(XmlOutput& io, const std::vector<double>& rates) {
  std::string text;
  require_within("pulseFreqs_Hz (number)", rates.size(), 0, most_rates, "");
  for (const double rate : rates) {
    require_within("pulseFreqs_Hz", rate, least_rate, most_rate, "Hz");
    text.append(text.empty() ? "" : ",").append(xml_number(rate));
  }
  io.put("pulseFreqs_Hz", text);
}

/// The lasers of a scanner that is read.
inline void channels(XmlInput& io, ScannerSettings& scanner) {
  ChannelSettings common;
  fields(io, common);
  const bool has_channels = io.child("channels", [&](XmlInput& list) {
    list.children("channel", scanner.channels, [&](FieldIo& inner, ChannelSettings& channel) {
      channel = common;
      channel.id = std::to_string(scanner.channels.size() - 1);
      inner.text("id", channel.id);
      fields(inner, channel);
      check(inner, channel);
    });
    if (scanner.channels.empty()) list.warn("", "<channels> holds no <channel>: the scanner has one");
  });
  if (!has_channels || scanner.channels.empty()) check(io, scanner.channels.emplace_back(std::move(common)));
}
/// Those of one that is written.
inline void channels(XmlOutput& io, ScannerSettings& scanner) {
  if (scanner.channels.size() == 1 && scanner.channels.front().id.empty()) {
    fields(io, scanner.channels.front());
    return check(io, scanner.channels.front());
  }
  if (!scanner.channels.empty())
    ChannelSettings{.optic = default_optics[scanner.channels.front().optic.index()]}.optic_fields(io);
  io.child("channels", "", [&](XmlOutput& list) {
    list.children("channel", scanner.channels, [](FieldIo& inner, ChannelSettings& channel) {
      inner.text("id", channel.id);
      fields(inner, channel);
      check(inner, channel);
    });
  });
}

inline void fields(FieldIo& io, ScannerSettings& scanner) {
  io.require({"id", "optics", "pulseFreqs_Hz"});
  io.text("id", scanner.id);
  io.text("name", scanner.name);
  const auto rest = [&](auto& known) {
    pulse_rates(known, scanner.pulse_rates);
    channels(known, scanner);
  };
  io.reads() ? rest(input(io)) : rest(output(io));
}

}  // namespace PULSECAST_NAMESPACE::helios::xml

#endif
