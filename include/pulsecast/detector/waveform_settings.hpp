// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <pulsecast/base/require.hpp>

namespace pulsecast {

/// What of an echo is timed: where on it its range is.
enum class EchoTiming : std::uint8_t {
  /// The mean of the reflections between its valleys, weighted by power: without bias, however the echo is drawn out. It is taken from the
  /// true ranges of the subrays, which no instrument knows: an oracle, not a model of one.
  energy,
  peak,  ///< its highest point: on a slope later than the mean, by a tau of `PulseShape` or so, as pulses rise faster than they fall
};

/// Settings of the waveform detectors. All times are two-way.
///
/// A peak of the waveform is an echo if it passes, in this order: it reaches the threshold; it is not closer than `separation` to a peak
/// before it, with which it would be one; it is the highest within the window; it comes after the dead time of the echo before it; it is
/// among the first `returns_max`.
///
/// Of all bins, these are on the front of docs/tradeoff.md, to within a few percent: at a sixteenth of a pulse they cost hardly more than
/// wider ones, which lose echoes that are close to each other, and narrower ones gain little. Widths of echoes cost more than any other
/// setting here, but for moments of `AnalyticWaveform`; so there are none unless they are asked for.
struct WaveformSettings {
  double sample_interval = 0.25e-9;  ///< of the digitiser: one bin, from 1e-16 to 1; no longer than a pulse, where samples matter [s]
  double threshold = 1e-12;          ///< weaker peaks are no echoes [W]
  double separation = 0;             ///< peaks that are closer to each other are one, as high as the highest of them [s]
  double window = 1e-9;              ///< an echo is the highest within this time before and after it [s]
  double dead_time = 0;              ///< so long after the peak of an echo, there is no other [s]
  std::size_t returns_max = 15;      ///< the first so many in order of range; at least 1
  EchoTiming timing = EchoTiming::energy;
  double record_length = 0;    ///< how much of the waveform is kept, from its first sample on, at most 1e7 bins; 0 for none [s]
  double shape_divisor = 3.5;  ///< full width at half maximum of the pulse by its tau, see `PulseShape`; from 1 to 10

  void validate() const {
    require_within("WaveformSettings::sample_interval", sample_interval, 1e-16, 1, "s");
    require_not_negative("WaveformSettings::threshold", threshold, "W");
    require_not_negative("WaveformSettings::separation", separation, "s");
    require_not_negative("WaveformSettings::window", window, "s");
    require_not_negative("WaveformSettings::dead_time", dead_time, "s");
    require_within("WaveformSettings::returns_max", static_cast<double>(returns_max), 1, 255, "");
    require_within("WaveformSettings::record_length", record_length, 0, max_kept * sample_interval, "s");
    require_within("WaveformSettings::shape_divisor", shape_divisor, 1, 10, "");
  }

  static constexpr double max_kept = 1e7;     ///< samples of a record
  static constexpr double max_samples = 1e4;  ///< in the length of a pulse, that `FullWaveform` takes

  /// Refuses bins that are longer than a pulse [s], which would fall between two samples, or so short that it has more than so many.
  void require_sampled(double pulse_length, double most) const {
    if (sample_interval <= pulse_length && pulse_length <= most * sample_interval) return;
    throw SettingError("WaveformSettings::sample_interval", sample_interval, "s",
                       "from " + detail::to_text(pulse_length / most) + " to " + detail::to_text(pulse_length) + " for such a pulse");
  }

  /// Peaks closer than this are one echo, for which all that is between its outer valleys counts: the separation; or else, as nobody tells
  /// the lower from the flank of the higher, the window, unless it is wider than the pulse is long [s].
  [[nodiscard]] double min_separation(double pulse_length) const noexcept { return std::fmax(separation, std::fmin(window, pulse_length)); }

  /// The most samples that a record can have.
  [[nodiscard]] std::size_t record_capacity() const noexcept {
    return static_cast<std::size_t>(std::ceil(record_length / sample_interval));
  }
};

}  // namespace pulsecast
