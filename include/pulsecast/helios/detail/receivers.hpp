// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_RECEIVERS_HPP
#define PULSECAST_HELIOS_DETAIL_RECEIVERS_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <pulsecast/detector/band_limited_receiver.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/helios/detail/optics.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/survey.hpp>

/// Receivers of a scanner's channels.
namespace PULSECAST_NAMESPACE::helios {

/// True if two channels have equal receivers; their lasers may differ.
[[nodiscard]] inline bool same_receiver(const ChannelSettings& a, const ChannelSettings& b) {
  return a.receiver_diameter == b.receiver_diameter && a.efficiency == b.efficiency && a.visibility == b.visibility &&
         a.accuracy == b.accuracy && a.errors.range_noise == b.errors.range_noise && a.range_min == b.range_min &&
         a.range_max == b.range_max && a.returns_max == b.returns_max && a.returns_kept == b.returns_kept &&
         a.received_power_min == b.received_power_min && a.pulse_length == b.pulse_length && a.waveform == b.waveform;
}

/// Groups of channels with equal receivers. Their indices are those in `Emitter::receiver`.
struct ReceiverGroups {
  std::vector<std::size_t> channels{};      ///< first channel of each group
  std::vector<std::uint16_t> of_channel{};  ///< group of each channel

  explicit ReceiverGroups(const ScannerSettings& scanner) {
    for (std::size_t k = 0; k < scanner.channels.size(); ++k) {
      const auto equal = [&](std::size_t other) { return same_receiver(scanner.channels[other], scanner.channels[k]); };
      const auto alike = std::find_if(channels.begin(), channels.end(), equal);
      of_channel.push_back(static_cast<std::uint16_t>(alike - channels.begin()));
      if (alike == channels.end()) channels.push_back(k);
    }
  }

  /// Receivers for `Survey`: `make(channel)` of one channel of each group. `scanner` is that of the groups; all
  /// channels of a group may have been changed in the same way.
  template <class Make>
  [[nodiscard]] auto units(const ScannerSettings& scanner, const Make& make) const {
    std::vector<decltype(make(scanner.channels.front()))> all;
    for (const std::size_t k : channels) all.push_back(make(scanner.channels[k]));
    return all;
  }
};

/// Smallest bins of the channels: all are sampled by them, as a batch has one sample interval [s].
[[nodiscard]] inline double finest_bin(const ScannerSettings& scanner) {
  double finest = std::numeric_limits<double>::infinity();
  for (const ChannelSettings& channel : scanner.channels) finest = std::min(finest, detail::limited_bin(channel));
  return finest;
}

/// Receiver of a channel for `Survey`. Noise is a quarter of the minimum power of an echo.
template <EchoWidth Width>
[[nodiscard]] ReceiverUnit<RingFootprint, FullWaveform<Width>> survey_receiver_unit(const ChannelSettings& channel,
                                                                                    const WaveformSettings& waveform,
                                                                                    bool noisy) {
  ReceiverNoise noise;
  if (noisy) noise.deviation = 0.25 * channel.received_power_min;
  return {RingFootprint(static_cast<std::size_t>(std::max(1, channel.waveform.rings))), survey_receiver(channel),
          FullWaveform<Width>(waveform, {}, noise)};
}

/// Detector of the library's physics.
template <EchoWidth Width>
using BandLimitedWaveform = FullWaveform<Width, BandLimitedReceiver<>>;

/// As above, by the library's physics: the footprint has the second moments of the beam, and the receiver the bandwidth
/// of the pulse. Noise is a sixth of the minimum power of an echo, so that false echoes are rare although the whole
/// gate is sampled.
template <EchoWidth Width>
[[nodiscard]] ReceiverUnit<RingFootprint, BandLimitedWaveform<Width>> library_receiver_unit(
    const ChannelSettings& channel, const WaveformSettings& waveform, bool noisy) {
  ReceiverChain chain;
  if (noisy)
    chain.noise_power = waveform.threshold / 6 / std::sqrt(chain.filter(channel.pulse_length).noise_bandwidth());
  return {RingFootprint(static_cast<std::size_t>(std::max(1, channel.waveform.rings)), RingMoments::whole),
          survey_receiver(channel, true), BandLimitedWaveform<Width>(waveform, {}, BandLimitedReceiver<>(chain))};
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
