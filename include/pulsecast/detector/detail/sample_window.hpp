// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_SAMPLE_WINDOW_HPP
#define PULSECAST_DETECTOR_DETAIL_SAMPLE_WINDOW_HPP

#include <pulsecast/detector/detail/peaks.hpp>
#include <pulsecast/detector/echo_width.hpp>

namespace PULSECAST_NAMESPACE {

/// Samples of a waveform as they arrive, in a window of bounded size, and the peaks in it.
template <EchoWidth Width>
class SampleWindow {
 public:
  struct Search {
    const WaveformSettings& settings;  ///< of the detector
    const Width& width;                ///< measure of widths
    double min_separation = 0;         ///< closer peaks merge [s]
    double delay = 0;                  ///< from a pulse's arrival to its maximum in the samples [s]
    bool by_sample = false;            ///< true if a sample itself must reach the threshold
    double reach = 0;                  ///< time beside a maximum that places it; 0: five samples [s]
  };

  static constexpr std::size_t capacity = 262'144;  ///< samples: the longest pulse

  SampleWindow() { samples_.reserve(capacity); }

  void clear() noexcept { samples_.clear(); }
  [[nodiscard]] std::vector<double>& samples() noexcept { return samples_; }  ///< in the window [W]

  [[nodiscard]] bool empty() const noexcept { return samples_.empty(); }  ///< true without samples

  /// Takes the next sample, a power [W]. Appends the peaks of a full window to `peaks`.
  void take(double number, double power, bool more, const Search& search, std::vector<Peak>& peaks) noexcept {
    samples_.push_back(power);
    if (more && samples_.size() == capacity) {
      const std::size_t cut = last_valley();  // a cut between two echoes
      find_peaks(number, cut, search, peaks);
      samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(cut - 2));
    }
    if (!more) find_peaks(number, samples_.size() - 2, search, peaks);
  }

 private:
  /// End of the last complete echo; two samples before the end if there is no valley.
  [[nodiscard]] std::size_t last_valley() const noexcept {
    const std::vector<double>& y = samples_;
    for (std::size_t i = y.size() - 2; i > 4; --i)
      if (y[i] < y[i - 1] && y[i] <= y[i + 1]) return i;
    return y.size() - 2;
  }

  /// First sample from i on, not before 1, that is above the one before and not below the next; `end`, which is not the
  /// last, or later if there is none.
  [[nodiscard]] std::size_t next_maximum(std::size_t i, std::size_t end) const noexcept {
    const double* const y = samples_.data();
    for (; i + simd::lane_count <= end; i += simd::lane_count) {
      const auto at = simd::load<simd::Doubles>(y[i]);
      const unsigned maxima =
          simd::bits((at > simd::load<simd::Doubles>(y[i - 1])) & (at >= simd::load<simd::Doubles>(y[i + 1])));
      if (maxima != 0) return i + static_cast<std::size_t>(std::countr_zero(maxima));
    }
    while (i < end && !(y[i] > y[i - 1] && y[i] >= y[i + 1])) ++i;
    return i;
  }

  [[nodiscard]] std::size_t last_of_plateau(std::size_t i) const noexcept {
    while (i + 1 < samples_.size() && samples_[i + 1] == samples_[i]) ++i;
    return i;
  }

  /// Maximum about a plateau of samples: between samples, unless it is longer than two.
  [[nodiscard]] detail::Vertex top_of(std::size_t first, std::size_t last) const noexcept {
    if (last > first + 1) return {0.5 * static_cast<double>(last - first), samples_[first]};
    return detail::vertex(&samples_[first]);
  }

  /// Appends every peak before index `end` of the window, whose last sample has the number `last`.
  void find_peaks(double last, std::size_t end, const Search& search, std::vector<Peak>& peaks) const noexcept {
    const WaveformSettings& s = search.settings;
    const std::vector<double>& y = samples_;
    const double start = last - static_cast<double>(y.size() - 1);
    const auto time = [&](std::size_t i) {
      return (start + static_cast<double>(i)) * s.sample_interval - search.delay;
    };
    const auto valley = [&](std::size_t i) {
      const bool turns = i >= 2 && i + 2 < y.size() && y[i] < y[i - 1] && y[i] <= y[i + 1];
      if (!turns) return time(i);
      const std::array<double, 5> below{-y[i - 2], -y[i - 1], -y[i], -y[i + 1], -y[i + 2]};
      return time(i) + detail::vertex(&below[2]).offset * s.sample_interval;
    };
    std::size_t entered = peaks.size();
    for (std::size_t i = next_maximum(2, end); i < end; i = next_maximum(i + 1, end)) {
      const std::size_t plateau_end = last_of_plateau(i);
      if (plateau_end + 1 < y.size() && y[plateau_end + 1] > y[i]) continue;  // a step of the rise
      const detail::Vertex top = top_of(i, plateau_end);
      if ((search.by_sample ? y[i] : top.height) < s.threshold) continue;
      std::size_t from = i, to = plateau_end > i + 1 ? plateau_end : i;
      while (from > 0 && y[from - 1] < y[from]) --from;
      while (to + 1 < y.size() && y[to + 1] < y[to]) ++to;
      Peak peak{.time = time(i) + top.offset * s.sample_interval,
                .height = top.height,
                .begin = valley(from),
                .end = valley(to),
                .before = y[from],
                .after = y[to]};
      peak.mark = peak.time;
      if (s.timing > EchoTiming::peak) {
        const double at = detail::echo_time(s.timing, y, i, top, s.threshold, s.fraction);
        peak.mark = (start + at) * s.sample_interval - search.delay;
      }
      merge_or_append(peak, search.min_separation, s.prominence, peaks);
    }
    const auto place = [&](double t) { return (t + search.delay) / s.sample_interval - start; };
    if (search.reach > 0) {
      for (std::size_t k = entered; k < peaks.size(); ++k) {
        Peak& peak = peaks[k];
        if (is_dominated(k, s, peaks)) continue;
        const double reach = std::fmin(search.reach, 0.5 * distance_of_echoes(k, s, peaks)), at = place(peak.time);
        peak.mark += (detail::filtered_top(y, at, reach / s.sample_interval) - at) * s.sample_interval;
      }
    }
    if constexpr (!std::same_as<Width, NoWidth>) {
      for (; entered < peaks.size(); ++entered) {
        Peak& peak = peaks[entered];
        if (is_dominated(entered, s, peaks)) continue;
        const auto index = [&](double t) { return static_cast<std::size_t>(std::lround(place(t))); };
        const std::size_t from = index(peak.begin), to = index(peak.end);
        peak.width = search.width.width(std::span(y).subspan(from, to - from + 1), s.sample_interval);
      }
    }
  }

  std::vector<double> samples_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
