// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_ECHO_WIDTH_HPP
#define PULSECAST_DETECTOR_ECHO_WIDTH_HPP

#include <pulsecast/detector/detail/pulse_sum.hpp>

namespace PULSECAST_NAMESPACE {

/// Moments of a section of waveform about a reference time: integrals of power times 1, t and t^2.
struct WaveformMoments {
  double energy = 0, first = 0, second = 0;  ///< moments of order 0, 1 and 2

  /// Adds a section whose reference time is later by `later`.
  void add(const WaveformMoments& m, double later) noexcept {
    energy += m.energy;
    first += m.first + later * m.energy;
    second += m.second + later * (2 * m.first + later * m.energy);
  }

  /// Standard deviation in time, in the time unit of the moments; 0 without energy or spread.
  [[nodiscard]] double deviation() const noexcept {
    if (!(energy > 0)) return 0;
    const double mean = first / energy;
    const double variance = second / energy - mean * mean;
    return variance > 0 ? std::sqrt(variance) : 0;
  }
};

/// No width measured: 0.
struct NoWidth {
  [[nodiscard]] double width(std::span<const double>, double) const noexcept { return 0; }
};

/// Width by the second central moment of the waveform.
struct MomentWidth {
  using refinements = refines<tag::MomentWidthMeasure>;
  [[nodiscard]] double width(std::span<const double> samples, double interval) const noexcept {
    WaveformMoments m;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double t = static_cast<double>(i);
      m.energy += samples[i];
      m.first += samples[i] * t;
      m.second += samples[i] * t * t;
    }
    return interval * m.deviation();
  }

  [[nodiscard]] double width(const WaveformMoments& moments) const noexcept { return moments.deviation(); }
};

namespace detail {

/// Time after the peak of its last pulse up to which a waveform affects a width [tau].
template <EchoWidth Width>
[[nodiscard]] double tail_of(const Width& width) noexcept {
  static_assert(detail::members_checked<Width, tag::MomentWidthMeasure, tag::TruncatedWidthMeasure>);
  if constexpr (TruncatedWidthMeasure<Width>)
    return std::fmin(SampledSum::negligible, PulseShape::fallen_to(width.min_share()));
  else
    return std::same_as<Width, NoWidth> ? 0 : SampledSum::negligible;
}

}  // namespace detail

/// Width of the outgoing pulse by the measure of its echoes [s], sampled every `interval` [s].
[[nodiscard]] double pulse_width(const EchoWidth auto& width, const PulseShape& shape, double interval) {
  std::vector<double> samples;
  for (double t = -PulseShape::peak * shape.tau; t < SampledSum::negligible * shape.tau; t += interval)
    samples.push_back(shape(t));
  return width.width(samples, interval);
}

}  // namespace PULSECAST_NAMESPACE

#endif
