// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_ECHO_TIMING_HPP
#define PULSECAST_DETECTOR_ECHO_TIMING_HPP

#include <algorithm>
#include <cmath>
#include <span>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE {

/// Point of an echo that defines its range. All but `true_range` are read from samples, as
/// instruments do, and corrected by what they are for a flat target at normal incidence. Sources:
/// Wagner et al. 2004, ISPRS Archives 35-B3 (a comparison); Jutzi & Stilla 2006.
enum class EchoTiming : std::uint8_t {
  /// Power-weighted mean of the true ranges between the echo's valleys, which no instrument knows:
  /// unbiased for any length. Media do not count; their echo has the range of its peak.
  true_range,
  /// Maximum: on a slope later than the mean, as pulses rise faster than they fall. With a
  /// bandwidth or the steps of a digitiser it is that after a filter about as wide as the pulse.
  peak,
  leading_edge,       ///< first rise to the threshold: earlier for stronger echoes (range walk)
  constant_fraction,  ///< first rise to `WaveformSettings::fraction` of the maximum
  centroid,           ///< centre of mass of what exceeds a tenth of the maximum
};

namespace detail {

/// Maximum of a waveform between its samples.
struct Vertex {
  double offset, height;  ///< offset from the middle sample [samples]; power [W]
};

/// Maximum of the quartic through five samples about a peak, `y[-2]` to `y[2]`, by Newton's method
/// from the vertex of the parabola through three; that vertex if there is none.
[[nodiscard]] inline Vertex vertex(const double* y) noexcept {
  const double c1 = (8 * (y[1] - y[-1]) - (y[2] - y[-2])) / 12;
  const double c2 = (16 * (y[1] + y[-1]) - (y[2] + y[-2]) - 30 * y[0]) / 24;
  const double c3 = ((y[2] - y[-2]) - 2 * (y[1] - y[-1])) / 12;
  const double c4 = ((y[2] + y[-2]) - 4 * (y[1] + y[-1]) + 6 * y[0]) / 24;
  const double middle = 0.5 * (y[-1] - y[1]) / (y[-1] - 2 * y[0] + y[1]);
  double x = middle;
  for (int step = 0; step < 3; ++step) {
    const double slope = c1 + x * (2 * c2 + x * (3 * c3 + x * 4 * c4)), bend = 2 * c2 + x * (6 * c3 + x * 12 * c4);
    if (!(bend < 0)) break;
    x = std::clamp(x - slope / bend, -1.0, 1.0);
  }
  const double height = y[0] + x * (c1 + x * (c2 + x * (c3 + x * c4)));
  return height >= y[0] ? Vertex{x, height} : Vertex{middle, y[0] + 0.25 * middle * (y[1] - y[-1])};
}

/// Place [samples] of the rise to a level before the peak at index i: on the cubic through four
/// samples. The lowest place before the peak, if they do not fall below the level there.
[[nodiscard]] inline double rise_before(std::span<const double> y, std::size_t i, double level) noexcept {
  std::size_t above = i;
  while (above > 0 && y[above - 1] >= level && y[above - 1] <= y[i]) --above;
  if (above == 0 || y[above - 1] > y[i]) return static_cast<double>(above);
  const std::size_t j = above - 1;  // the last sample below the level
  double x = (level - y[j]) / (y[above] - y[j]);
  if (j >= 1 && above + 1 < y.size()) {
    const double a = y[j - 1], b = y[j], c = y[above], d = y[above + 1];
    const double c1 = c - b / 2 - a / 3 - d / 6, c2 = (a + c) / 2 - b, c3 = (d - a) / 6 + (b - c) / 2;
    for (int step = 0; step < 3; ++step) {
      const double slope = c1 + x * (2 * c2 + x * 3 * c3);
      if (!(slope > 0)) break;
      x = std::clamp(x - (b + x * (c1 + x * (c2 + x * c3)) - level) / slope, 0.0, 1.0);
    }
  }
  return static_cast<double>(j) + x;
}

/// Centre of mass of what exceeds a level about the peak at index i [samples].
[[nodiscard]] inline double centroid_about(std::span<const double> y, std::size_t i, double level) noexcept {
  std::size_t from = i, to = i;
  while (from > 0 && y[from - 1] > level) --from;
  while (to + 1 < y.size() && y[to + 1] > level) ++to;
  double sum = 0, first = 0;
  for (std::size_t j = from; j <= to; ++j) {
    const double above = y[j] - level;
    sum += above;
    first += above * (static_cast<double>(j) - static_cast<double>(i));
  }
  return static_cast<double>(i) + (sum > 0 ? first / sum : 0);
}

/// Maximum about a place [samples] after a filter (1 - u^2)^2 that reaches `reach` samples either
/// side, by Newton's method. With a reach of 0.6 of the width of the gamma pulse it errs by 1.3
/// times the Cramer-Rao bound of white noise, and parts closer echoes than the best, of 0.75.
/// Source: biweight, Beaton & Tukey 1974; the factor by integrals of slope and filter.
[[nodiscard]] inline double filtered_top(std::span<const double> y, double place, double reach) noexcept {
  for (int step = 0; step < 12 && reach > 2; ++step) {
    const auto end =
        static_cast<std::size_t>(std::clamp(std::floor(place + reach) + 1, 0.0, static_cast<double>(y.size())));
    double slope = 0, bend = 0;
    for (auto i = static_cast<std::size_t>(std::max(std::ceil(place - reach), 0.0)); i < end; ++i) {
      const double u = (static_cast<double>(i) - place) / reach;
      slope += y[i] * u * (1 - u * u);
      bend += y[i] * (1 - 3 * u * u);
    }
    if (!(bend > 0)) break;
    const double to = reach * std::clamp(slope / bend, -0.5, 0.5);
    place += to;
    if (std::fabs(to) < 1e-9 * reach) break;
  }
  return place;
}

inline constexpr double centroid_level = 0.1;  ///< share of the maximum for `centroid`

/// Time of an echo by its samples [samples], with the peak at index i and `top` between samples:
/// `threshold` [W] is that of a leading edge, `fraction` the share of the maximum.
[[nodiscard]] inline double echo_time(EchoTiming timing, std::span<const double> y, std::size_t i, const Vertex& top,
                                      double threshold, double fraction) noexcept {
  if (timing == EchoTiming::leading_edge) return rise_before(y, i, threshold);
  if (timing == EchoTiming::constant_fraction) return rise_before(y, i, fraction * top.height);
  if (timing == EchoTiming::centroid) return centroid_about(y, i, centroid_level * top.height);
  return static_cast<double>(i) + top.offset;
}

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE

#endif
