// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_WAVEFORM_SETTINGS_HPP
#define PULSECAST_DETECTOR_WAVEFORM_SETTINGS_HPP

#include <pulsecast/base/require.hpp>
#include <pulsecast/detector/detail/kept_returns.hpp>
#include <pulsecast/detector/echo_timing.hpp>
#include <pulsecast/detector/pulse_shape.hpp>

namespace PULSECAST_NAMESPACE {

/// Settings of the waveform detectors. All times are two-way.
///
/// A peak of the waveform is an echo if it passes these tests, in this order:
/// - it reaches the threshold;
/// - it is at least `separation` from the peak before it, and rises by at least `prominence` above
///   the valley between them, else the two merge;
/// - it is the highest within the window;
/// - it is later than the dead time of the echo before it;
/// - it is among the `returns_max` that are kept.
///
/// The default bin is 1/16 of a pulse of 4 ns: wider ones lose more close echoes, and save
/// hardly any time; narrower ones lose fewer, and take more (docs/tradeoff.md).
struct WaveformSettings {
  double sample_interval = 0.25e-9;               ///< from 1e-16 to 1, at most a pulse [s]
  double threshold = 1e-9;                        ///< of a peak: 21 photons of 1064 nm in 4 ns [W]
  double separation = 0;                          ///< closer peaks merge into the higher [s]
  double prominence = 0;                          ///< least rise from the valley between two [W]
  double window = 1e-9;                           ///< no higher peak this near [s]
  double dead_time = 0;                           ///< no other echo this long after one [s]
  std::size_t returns_max = 15;                   ///< echoes kept, in order; from 1 to 255
  KeptReturns returns_kept = KeptReturns::first;  ///< which ones, of more
  EchoTiming timing = EchoTiming::peak;           ///< definition of an echo's range
  double fraction = 0.5;                          ///< of `constant_fraction`; from 0.01 to 0.99
  double record_length = 0;                       ///< of waveform kept, at most 1e7 bins [s]
  double shape_divisor = PulseShape::divisor;     ///< as in `PulseShape`; from 1 to 10

  void validate() const {
    require_within("WaveformSettings::sample_interval", sample_interval, 1e-16, 1, "s");
    require_not_negative("WaveformSettings::threshold", threshold, "W");
    require_not_negative("WaveformSettings::separation", separation, "s");
    require_not_negative("WaveformSettings::prominence", prominence, "W");
    require_not_negative("WaveformSettings::window", window, "s");
    require_within("WaveformSettings::fraction", fraction, 0.01, 0.99, "");
    require_not_negative("WaveformSettings::dead_time", dead_time, "s");
    require_within("WaveformSettings::returns_max", returns_max, 1, 255, "");
    require_within("WaveformSettings::record_length", record_length, 0, max_kept * sample_interval, "s");
    require_within("WaveformSettings::shape_divisor", shape_divisor, 1, 10, "");
  }

  static constexpr double max_kept = 1e7;     ///< samples of a record
  static constexpr double max_samples = 1e4;  ///< samples in a pulse length, for `FullWaveform`

  /// Refuses bins longer than a pulse, or of which it has more than `most`. @throws SettingError
  void require_sampled(double pulse_length, double most) const {
    if (sample_interval <= pulse_length && pulse_length <= most * sample_interval) return;
    const std::string from = text::to_text(pulse_length / most), to = text::to_text(pulse_length);
    throw SettingError("WaveformSettings::sample_interval", sample_interval, "s",
                       text::joined({"from ", from, " to ", to, " for this pulse length"}));
  }

  /// Least separation of two echoes [s]: the greater of `separation` and the shorter of window and
  /// pulse length. A lower peak closer than that is as the flank of a higher one.
  [[nodiscard]] double min_separation(double pulse_length) const noexcept {
    return std::fmax(separation, std::fmin(window, pulse_length));
  }

  /// Greatest number of samples of a record.
  [[nodiscard]] std::size_t record_capacity() const noexcept {
    return static_cast<std::size_t>(std::ceil(record_length / sample_interval));
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
