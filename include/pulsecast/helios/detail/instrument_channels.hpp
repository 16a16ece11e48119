// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_INSTRUMENT_CHANNELS_HPP
#define PULSECAST_HELIOS_DETAIL_INSTRUMENT_CHANNELS_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/helios/detail/optics.hpp>
#include <pulsecast/helios/detail/receivers.hpp>
#include <pulsecast/helios/instrument.hpp>
#include <pulsecast/helios/settings.hpp>

/// Channels of a scanner in a leg.
namespace PULSECAST_NAMESPACE::helios {

namespace detail {

[[nodiscard]] inline std::vector<SurveyChannel> instrument_channels(const ScannerSettings& scanner,
                                                                    const LegScannerSettings& settings, double duration,
                                                                    const InstrumentOptions& options) {
  if (scanner.channels.empty()) throw SettingError("channels (number)", 0, "", "at least 1");
  scanner.validate();
  settings.validate();
  const double rate = pulse_rate_of(scanner, settings);
  require_within("Instrument::duration", duration, 0, 1e15, "s");
  require_within("Instrument::duration (pulses)", duration * rate, 0, 1e15, "");
  const auto slots = static_cast<PulseIndex>(std::max(0.0, std::ceil(duration * rate - 1e-6)));
  const bool fires = slots > 0 && settings.active;  // otherwise, optics are never called
  const ReceiverGroups receivers(scanner);
  std::vector<SurveyChannel> channels;
  for (std::size_t c = 0; c < scanner.channels.size(); ++c) {
    const ChannelSettings& channel = scanner.channels[c];
    SurveyOptic optic;
    if (fires) optic = survey_optic(channel, settings, rate, options.boresight, {options.optic_time});
    channels.emplace_back(std::move(optic), Scanner{.pulse_rate = rate,
                                                    .pulses = slots,
                                                    .laser = survey_laser(channel, settings),
                                                    .receiver = receivers.of_channel[c]});
  }
  return channels;
}

}  // namespace detail

PULSECAST_INLINE Instrument::Instrument(const ScannerSettings& scanner, const LegScannerSettings& settings,
                                        double duration, const InstrumentOptions& options)
    : channels_(detail::instrument_channels(scanner, settings, duration, options)) {}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
