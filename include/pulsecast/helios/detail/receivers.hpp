// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_RECEIVERS_HPP
#define PULSECAST_HELIOS_DETAIL_RECEIVERS_HPP

#include <pulsecast/detector/band_limited_receiver.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/helios/detail/optics.hpp>
#include <pulsecast/survey.hpp>

namespace PULSECAST_NAMESPACE::helios {

namespace detail {

/// Bins of a channel, of at most a pulse; that has `WaveformSettings::max_samples` at most [s].
[[nodiscard]] inline double limited_bin(const ChannelSettings& channel) {
  constexpr double most = WaveformSettings::max_samples;
  const double bin = channel.waveform.bin_size, length = channel.pulse_length;
  return bin > length ? length : length > most * bin ? std::nextafter(length / most, length) : bin;
}

/// Range noise by a formula, as a table: for powers of the range, it errs by less than 1e-4.
[[nodiscard]] inline RangeErrors range_noise(const ChannelSettings& channel) {
  const Formula times(channel.errors.range_noise, "t");
  const double first = std::max(channel.range_min, 0.01),
               last = std::isfinite(channel.range_max) ? channel.range_max : 1e6;
  constexpr int rows = 2000;
  std::vector<DeviationAtRange> table;
  for (int i = 0; i <= rows && (i == 0 || first < last); ++i) {
    const double range = first * std::pow(last / first, i / static_cast<double>(rows)),
                 deviation = channel.accuracy * std::fabs(times(range));
    if (!std::isfinite(deviation))
      throw SettingError("distanceMeasurementError at t", range, "m",
                         "a formula with a finite value from rangeMin_m to rangeMax_m");
    table.push_back({range, deviation});
  }
  return {.deviations = std::move(table)};
}

}  // namespace detail

/// Receiver of a channel. @throws SettingError, std::invalid_argument for an invalid noise formula
[[nodiscard]] inline Receiver survey_receiver(const ChannelSettings& channel, bool library_physics = false) {
  const bool by_formula = !channel.errors.range_noise.empty();
  const RangeErrors errors = by_formula ? detail::range_noise(channel) : RangeErrors{.deviation = channel.accuracy};
  return {.diameter = channel.receiver_diameter,
          .efficiency = channel.efficiency,
          .visibility = channel.visibility,
          .aerosols = library_physics ? AerosolModel::kim : AerosolModel::kruse,
          .range_min = channel.range_min,
          .range_max = channel.range_max,
          .range_errors = errors};
}

/// Warning about light of a wavelength [m] for which extinction was not measured; or empty.
[[nodiscard]] inline std::string air_warning(double wavelength, const Receiver& receiver) {
  if (extinction_is_valid(wavelength, receiver.visibility, receiver.aerosols)) return {};
  return "light of " + text::to_text(std::round(wavelength * 1e10) / 10) + " nm in air of a visibility of " +
         text::to_text(receiver.visibility / 1e3) + " km: the formula of its extinction holds from 400 to 1600 nm" +
         (receiver.aerosols == AerosolModel::kim ? ""
                                                 : ", and from 6 km on; --libraryPhysics has one for haze and fog");
}

/// Waveform settings of a channel; `record_length` is the length kept [s]. `winSize_ns` and `maxFullwaveRange_ns` are
/// one-way times of light and count twice; `binSize_ns` is two-way time. Echoes are timed by true ranges, but with the
/// library's physics or multi-bounce light by peaks: a mean range between water and its bottom is meaningless. The
/// library's threshold replaces that of HELIOS++, which is less than a photon.
[[nodiscard]] inline WaveformSettings survey_waveform(const ChannelSettings& channel, double record_length = 0,
                                                      bool library_physics = false, bool follows_light = false) {
  const FullWaveformSettings& s = channel.waveform;
  WaveformSettings out;
  out.sample_interval = detail::limited_bin(channel);
  if (!library_physics || channel.received_power_min != ChannelSettings{}.received_power_min)
    out.threshold = channel.received_power_min;
  if (!library_physics) {
    if (!follows_light) out.timing = EchoTiming::true_range;
    out.shape_divisor = 3.5;
  }
  out.window = 2 * s.window.value_or(channel.pulse_length / 4);
  out.returns_max = channel.returns_max > 0 ? static_cast<std::size_t>(std::min(channel.returns_max, 255)) : 255;
  out.returns_kept = channel.returns_kept;
  out.record_length = s.duration_max > 0 ? std::min(record_length, 2 * s.duration_max) : record_length;
  return out;
}

/// Maximum range of a channel, to 1 %: that of its gate, or that of the echo of a white surface [m].
[[nodiscard]] inline double range_of(const ChannelSettings& channel, bool library_physics) {
  const LinkBudget budget(survey_receiver(channel, library_physics), survey_laser(channel, {}));
  const double least = survey_waveform(channel, 0, library_physics).threshold;
  double range = 1;
  while (range < channel.range_max && range < 1e8 && budget.power(1, 1, range) > least) range *= 1.01;
  return std::min(range, channel.range_max);
}

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

  /// Receivers for `Survey`: `make(channel)` of a channel of each group. `scanner` may differ, but not within a group.
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

template <EchoWidth Width>
using BandLimitedWaveform = FullWaveform<Width, BandLimitedReceiver<>>;

/// The same by the library's physics: the footprint has the second moments of the beam, the
/// receiver the bandwidth of the pulse. Noise deviates by a sixth of the minimum power: false echoes are rare.
template <EchoWidth Width>
[[nodiscard]] ReceiverUnit<RingFootprint, BandLimitedWaveform<Width>> library_receiver_unit(
    const ChannelSettings& channel, const WaveformSettings& waveform, bool noisy) {
  ReceiverChain chain;
  if (noisy) {  // samples are calibrated by what the low-pass leaves of a pulse's height
    const LowPass filter = chain.filter(channel.pulse_length);
    const ReceivedPulse pulse(GammaPulse{}, channel.pulse_length, filter, waveform.sample_interval);
    chain.noise_power = waveform.threshold / 6 * pulse.gain() / std::sqrt(filter.noise_bandwidth());
  }
  return {RingFootprint(static_cast<std::size_t>(std::max(1, channel.waveform.rings)), RingMoments::whole),
          survey_receiver(channel, true), BandLimitedWaveform<Width>(waveform, {}, BandLimitedReceiver<>(chain))};
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
