// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_PEAKS_HPP
#define PULSECAST_DETECTOR_PEAKS_HPP

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <pulsecast/base/search.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/detector/pulse_shape.hpp>
#include <pulsecast/detector/pulse_sum.hpp>
#include <pulsecast/detector/waveform_settings.hpp>

namespace PULSECAST_NAMESPACE {

/// Peak of a waveform between its two valleys. Times are two-way.
struct Peak {
  double time = 0;         ///< time of the maximum [s]
  double height = 0;       ///< power at the maximum [W]
  double begin = 0;        ///< time of the valley before it [s]
  double end = 0;          ///< time of the valley after it [s]
  double width = 0;        ///< as in `Echo` [s]
  bool dominated = false;  ///< true if a higher peak is within the window
};

/// Appends a peak after those before it, within the capacity. Merges it with the last one and returns true if they are closer than
/// `min_separation` [s].
inline bool merge_or_append(const Peak& peak, double min_separation, std::vector<Peak>& peaks) noexcept {
  if (!peaks.empty() && peak.time - peaks.back().time < min_separation) {
    Peak& one = peaks.back();
    if (peak.height > one.height) {
      one.time = peak.time;
      one.height = peak.height;
    }
    one.end = peak.end;
    return true;
  }
  if (peaks.size() < peaks.capacity()) peaks.push_back(peak);
  return false;
}

/// True if a higher peak, or an earlier one as high, is within the window of peak i. Requires peaks in order of time.
[[nodiscard]] inline bool is_dominated(std::size_t i, const WaveformSettings& s, const std::vector<Peak>& peaks) noexcept {
  const Peak& peak = peaks[i];
  for (std::size_t j = i; j-- > 0 && peak.time - peaks[j].time <= s.window;)
    if (peaks[j].height >= peak.height) return true;
  for (std::size_t j = i; ++j < peaks.size() && peaks[j].time - peak.time <= s.window;)
    if (peaks[j].height > peak.height) return true;
  return false;
}

/// Keeps the peaks that are echoes by window, dead time and number. Requires order of time.
inline void keep_echoes(const WaveformSettings& s, std::vector<Peak>& peaks) noexcept {
  for (std::size_t i = 0; i < peaks.size(); ++i) peaks[i].dominated = is_dominated(i, s, peaks);
  std::size_t kept = 0;
  for (const Peak& peak : peaks) {
    if (peak.dominated || kept == s.returns_max) continue;
    if (kept > 0 && peak.time - peaks[kept - 1].time < s.dead_time) continue;
    peaks[kept++] = peak;
  }
  peaks.resize(kept);
}

/// Echo of a peak; reflections are sorted by range.
[[nodiscard]] inline Echo echo_of(const Peak& peak, std::span<const Reflection> reflections, const PulseShape& shape, EchoTiming timing,
                                  std::size_t number) noexcept {
  const Reflection* const end = reflections.data() + reflections.size();
  const auto from = [&](double time) noexcept {
    return reflections.data() + detail::first_not(reflections.size(), [&](std::size_t i) { return arrival(reflections[i]) < time; });
  };

  Echo echo{.range = 0.5 * speed_of_light * peak.time,
            .amplitude = peak.height,
            .width = peak.width,
            .number = static_cast<std::uint8_t>(number)};
  constexpr double faded = 60;  // 60 tau after its peak, 1e-22 of a pulse is left
  double strongest = 0;
  for (auto r = from(peak.time - faded * shape.tau); r != end && arrival(*r) < peak.time + PulseShape::peak * shape.tau; ++r) {
    if (!(r->power > strongest)) continue;  // its share at this time is at most its power
    const double power = r->power * shape(peak.time - arrival(*r));
    if (!(power > strongest)) continue;
    strongest = power;
    echo.cos_incidence = r->cos_incidence;
    echo.object = r->object;
    echo.classification = r->classification;
  }
  if (timing == EchoTiming::energy) {
    const auto first = from(peak.begin);
    double sum = 0, beyond = 0;
    for (auto r = first; r != end && arrival(*r) < peak.end; ++r) {
      sum += r->power;
      beyond += r->power * (r->range - first->range);
    }
    if (sum > 0) echo.range = first->range + beyond / sum;
  }
  return echo;
}

}  // namespace PULSECAST_NAMESPACE

#endif
