// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_LEG_RATES_HPP
#define PULSECAST_HELIOS_DETAIL_LEG_RATES_HPP

#include <algorithm>

#include <pulsecast/base/require.hpp>
#include <pulsecast/helios/settings.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Pulse rate of a leg; by default the scanner's first [Hz]. Throws a `SettingError` if there is none.
[[nodiscard]] inline double pulse_rate_of(const ScannerSettings& scanner, const LegScannerSettings& leg) {
  const double rate = leg.pulse_rate > 0 || scanner.pulse_rates.empty() ? leg.pulse_rate : scanner.pulse_rates.front();
  require_positive("pulseFreq_hz", rate, "Hz");
  return rate;
}

/// Turning rate of the head in a leg, within the limits of the device [rad/s].
[[nodiscard]] inline double head_rate(const ChannelSettings& channel, const LegScannerSettings& leg) noexcept {
  return std::clamp(leg.head_rate, -channel.head_rate_max, channel.head_rate_max);
}

/// True if the head turns away from its stop angle.
[[nodiscard]] inline bool turns_away(const LegScannerSettings& leg) noexcept {
  return (leg.head_rate > 0 && leg.head_stop < leg.head_start) || (leg.head_rate < 0 && leg.head_stop > leg.head_start);
}

/// True if a leg waits for a head that does not turn.
[[nodiscard]] inline bool head_never_stops(const ChannelSettings& channel, const LegSettings& leg) noexcept {
  return !leg.duration_max && head_rate(channel, leg.scanner) == 0 && leg.scanner.head_stop != leg.scanner.head_start;
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
