// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_PEAKS_HPP
#define PULSECAST_DETECTOR_DETAIL_PEAKS_HPP

#include <pulsecast/detector/detail/pulse_sum.hpp>
#include <pulsecast/detector/waveform_settings.hpp>

namespace PULSECAST_NAMESPACE {

/// Peak of a waveform between its two valleys. Times are two-way.
struct Peak {
  double time = 0;         ///< time of the maximum [s]
  double height = 0;       ///< power at the maximum [W]
  double begin = 0;        ///< time of the valley before it [s]
  double end = 0;          ///< time of the valley after it [s]
  double before = 0;       ///< power in the valley before it [W]
  double after = 0;        ///< power in the valley after it [W]
  double mark = 0;         ///< time that defines the range, by `EchoTiming` [s]
  double width = 0;        ///< as in `Echo` [s]
  bool dominated = false;  ///< true if a higher peak is within the window
};

/// Appends a peak after those before it, within the capacity. Merges it with the last one and
/// returns true if they are closer than `min_separation` [s], or if the lower of the two rises by
/// less than `prominence` [W] above the valley between them.
inline bool merge_or_append(const Peak& peak, double min_separation, double prominence,
                            std::vector<Peak>& peaks) noexcept {
  if (!peaks.empty()) {
    Peak& one = peaks.back();
    const double valley = std::fmin(one.after, peak.before), lower = std::fmin(one.height, peak.height);
    if (peak.time - one.time < min_separation || lower - valley < prominence) {
      if (peak.height > one.height) {
        one.time = peak.time;
        one.height = peak.height;
        one.mark = peak.mark;
      }
      one.end = peak.end;
      one.after = peak.after;
      return true;
    }
  }
  if (peaks.size() < peaks.capacity()) peaks.push_back(peak);
  return false;
}

/// True if a higher peak, or an earlier one as high, is in the window of peak i, in order of time.
[[nodiscard]] inline bool is_dominated(std::size_t i, const WaveformSettings& s,
                                       const std::vector<Peak>& peaks) noexcept {
  const Peak& peak = peaks[i];
  for (std::size_t j = i; j-- > 0 && peak.time - peaks[j].time <= s.window;)
    if (peaks[j].height >= peak.height) return true;
  for (std::size_t j = i; ++j < peaks.size() && peaks[j].time - peak.time <= s.window;)
    if (peaks[j].height > peak.height) return true;
  return false;
}

/// Time from peak i to the nearest one that is not dominated [s].
[[nodiscard]] inline double distance_of_echoes(std::size_t i, const WaveformSettings& s,
                                               const std::vector<Peak>& peaks) noexcept {
  std::size_t before = i, after = i + 1;
  while (before > 0 && is_dominated(before - 1, s, peaks)) --before;
  while (after < peaks.size() && is_dominated(after, s, peaks)) ++after;
  double nearest = std::numeric_limits<double>::infinity();
  if (before > 0) nearest = peaks[i].time - peaks[before - 1].time;
  return after < peaks.size() ? std::fmin(nearest, peaks[after].time - peaks[i].time) : nearest;
}

/// Keeps the peaks that are echoes by window and dead time. Requires order of time.
inline void keep_echoes(const WaveformSettings& s, std::vector<Peak>& peaks) noexcept {
  for (std::size_t i = 0; i < peaks.size(); ++i) peaks[i].dominated = is_dominated(i, s, peaks);
  std::size_t kept = 0;
  for (const Peak& peak : peaks) {
    if (peak.dominated) continue;
    if (kept > 0 && peak.time - peaks[kept - 1].time < s.dead_time) continue;
    peaks[kept++] = peak;
  }
  peaks.resize(kept);
}

/// Keeps an echo, the farthest so far, unless `s.returns_max` others go before.
inline void keep_return(const Echo& echo, const auto& s, std::vector<Echo>& echoes) noexcept {
  if (echoes.size() == s.returns_max) {
    const auto of_air = [](const Echo& e) { return e.kind == ReflectionKind::air; };
    const auto weaker = [](const Echo& a, const Echo& b) { return a.amplitude < b.amplitude; };
    auto out = echoes.end();
    if (s.returns_kept == KeptReturns::strongest) {
      out = std::min_element(echoes.begin(), echoes.end(), weaker);
      if (!weaker(*out, echo)) return;
    } else {
      if (of_air(echo)) return;
      while (out != echoes.begin() && !of_air(*--out)) continue;
      if (!of_air(*out)) return;
    }
    echoes.erase(out);
  }
  echoes.push_back(echo);
}

/// The only maximum of the samples of a pulse.
struct OnlyPeak {
  double time;                            ///< less the receiver's delay [s]
  double height;                          ///< power [W]
  const Reflection* strongest = nullptr;  ///< reflection with the greatest share of it
};

/// Echo of a peak of the sum of reflections, sorted by range. `shape(t)` is the pulse at lanes of times t since
/// its peak, from `shape.begin()` to `shape.end()` [s]. `continuous(peak, solid, met)` gives the
/// continuous return that it is of, or none, by the power of reflections in it [W] and if any are.
[[nodiscard]] Echo echo_of(const Peak& peak, std::span<const Reflection> reflections, const auto& shape,
                           EchoTiming timing, const auto& continuous) noexcept {
  const Reflection* const end = reflections.data() + reflections.size();
  const auto from = [&](double time) noexcept { return reflections.data() + detail::first_arrival(reflections, time); };
  Echo echo{.range = range_at(peak.mark), .amplitude = peak.height, .width = peak.width};
  double strongest = 0, solid = 0;
  const Reflection* most = nullptr;
  for (auto r = from(peak.time - shape.end()), last = from(peak.time - shape.begin()); r < last;) {
    const auto size = std::min<std::size_t>(simd::lane_count, static_cast<std::size_t>(last - r));
    const auto of = [&](double Reflection::*member) noexcept { return detail::lanes_of(r, size, member); };
    const simd::Doubles powers =
        of(&Reflection::power) * shape(simd::Doubles(peak.time - 2 * of(&Reflection::range) / speed_of_light));
    for (std::size_t lane = 0; lane < size; ++lane, ++r) {
      if (!continuous.needs_sum() && !(r->power > strongest)) continue;  // power is its maximum
      solid += powers[lane];
      if (!(powers[lane] > strongest)) continue;
      strongest = powers[lane];
      most = r;
    }
  }
  if (most) {
    echo.cos_incidence = most->cos_incidence;
    echo.object = most->object;
    echo.classification = most->classification;
    echo.kind = most->kind;
  }
  if (const ContinuousReturn* const r = continuous(peak, solid, strongest > 0)) {
    echo.cos_incidence = 1;
    echo.object = r->object;
    echo.classification = r->classification;
    echo.kind = r->kind;
    return echo;
  }
  if (timing == EchoTiming::true_range) {
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
