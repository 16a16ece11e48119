// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_ANALYTIC_WAVEFORM_HPP
#define PULSECAST_DETECTOR_ANALYTIC_WAVEFORM_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/simd.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/detector/echo_width.hpp>
#include <pulsecast/detector/peaks.hpp>
#include <pulsecast/detector/pulse_shape.hpp>
#include <pulsecast/detector/pulse_sum.hpp>
#include <pulsecast/detector/single_peak_group.hpp>
#include <pulsecast/detector/waveform_settings.hpp>

namespace PULSECAST_NAMESPACE {

/// Sum of the pulse shapes of all reflections whose leading edges have passed, in closed form until the next edge.
///
/// An edge of age u [tau] contributes P u^2 e^-u. Weight each age by P e^-u; let W be the sum of the weights, m the mean and v the variance
/// of the ages. The sum of pulses is W (m^2 + v), and W e^-x ((m + x)^2 + v) a time x later. Its slope is zero at the ages m + x = 1 -
/// sqrt(1 - v), a valley, and 1 + sqrt(1 - v), a peak; nowhere for v > 1. Derived from `PulseShape`.
class EdgeAgeMoments {
 public:
  /// Adds a pulse whose leading edge arrives now.
  void add(double power) noexcept {
    const double sum = weight_ + power, share = power / sum;
    variance_ = (1 - share) * (variance_ + share * mean_ * mean_);
    mean_ *= 1 - share;
    weight_ = sum;
  }

  /// Advances by a time [tau].
  void advance(double x) noexcept {
    weight_ *= std::exp(-x);
    mean_ += x;
  }

  /// True if the slope of the sum has zeros, passed or to come.
  [[nodiscard]] bool can_turn() const noexcept { return variance_ < 1; }
  [[nodiscard]] double until_valley() const noexcept { return 1 - std::sqrt(1 - variance_) - mean_; }  ///< negative if passed [tau]
  [[nodiscard]] double until_peak() const noexcept { return 1 + std::sqrt(1 - variance_) - mean_; }    ///< negative if passed [tau]

  /// Sum of pulses now [W].
  [[nodiscard]] double power() const noexcept { return weight_ * (mean_ * mean_ + variance_) * PulseShape::to_unit_peak; }

  /// Moments of the sum over a time x from now on, about now [tau].
  [[nodiscard]] WaveformMoments until(double x) const noexcept {
    std::array<double, 5> g{};  // integrals of t^k e^-t from 0 to x, by parts
    const double rest = std::exp(-x);
    double term = rest;  // x^k e^-x
    g[0] = 1 - rest;
    for (std::size_t k = 1; k < g.size(); ++k) {
      if (term > 0) term *= x;  // 0 for an infinite x
      g[k] = static_cast<double>(k) * g[k - 1] - term;
    }
    const double c0 = mean_ * mean_ + variance_, c1 = 2 * mean_, w = weight_ * PulseShape::to_unit_peak;
    return {w * (c0 * g[0] + c1 * g[1] + g[2]), w * (c0 * g[1] + c1 * g[2] + g[3]), w * (c0 * g[2] + c1 * g[3] + g[4])};
  }

 private:
  double weight_ = 0, mean_ = 0, variance_ = 0;
};

/// Peak detector on the sum of the pulse shapes of all reflections, without sampling: times and heights are exact. Between two leading
/// edges the sum is a quadratic polynomial times one exponential, so its extrema are roots of a quadratic. One pass over the reflections
/// finds them all. A `SinglePeakGroup` is evaluated without sorting.
/// Pareto-optimal in docs/tradeoff.md: takes less time than `FullWaveform`, and is as exact or more so. `FullWaveform` models the
/// digitiser's bins and the receiver's noise.
///
/// `WaveformSettings::sample_interval` is that of the record, and of the grid on which a fitted width samples the sum; moments are exact.
template <EchoWidth Width = NoWidth>
class AnalyticWaveform {
 public:
  /// @throws SettingError for settings out of range, a prominence, or a timing that is read from samples
  explicit AnalyticWaveform(WaveformSettings settings = {}, Width width = {})
      : s_(validated(settings)), width_(validated(std::move(width))) {
    require_within("AnalyticWaveform: WaveformSettings::prominence", s_.prominence, 0, 0, "W");
    if (s_.timing > EchoTiming::peak)
      throw SettingError("AnalyticWaveform: WaveformSettings::timing", static_cast<double>(s_.timing), "", "true_range or peak");
  }

  /// Settings, as validated.
  [[nodiscard]] const WaveformSettings& settings() const noexcept { return s_; }
  [[nodiscard]] double sample_interval() const noexcept { return s_.sample_interval; }

  /// Refuses pulses that samples do not resolve, if a record or a fitted width takes samples. @throws SettingError
  void validate(const Laser& laser) const {
    if (by_samples || s_.record_length > 0) s_.require_sampled(laser.pulse_length, infinity);
  }

  /// Width of a laser's outgoing pulse, by the measure of its echoes [s]. @throws SettingError as `validate`
  [[nodiscard]] double pulse_width(const Laser& laser) const {
    validate(laser);
    const PulseShape shape(laser.pulse_length, s_.shape_divisor);
    if constexpr (by_samples) {
      const double whole = (PulseShape::peak + SampledSum::negligible) * shape.tau;
      return pulsecast::pulse_width(width_, shape, std::fmax(s_.sample_interval, whole / static_cast<double>(max_samples - 2)));
    } else if constexpr (by_moments) {
      EdgeAgeMoments pulse;
      pulse.add(1);
      return shape.tau * width_.width(pulse.until(infinity));
    } else {
      return 0;
    }
  }

  /// Scratch memory of one worker.
  struct Workspace {
    std::vector<Peak> peaks;           ///< peaks of the current pulse
    std::vector<double> samples;       ///< samples of one echo, for a fitted width [W]
    std::vector<Echo> echoes;          ///< echoes of the current pulse
    std::vector<float> record;         ///< samples of the kept waveform [W]
    SinglePeakGroup::Workspace group;  ///< ages and weights
  };

  /// Scratch memory for pulses of up to `reflections` reflections.
  [[nodiscard]] Workspace workspace(std::size_t reflections) const {
    Workspace w{{}, {}, {}, {}, SinglePeakGroup::Workspace(reflections)};
    w.peaks.reserve(reflections);
    if constexpr (by_samples) w.samples.reserve(max_samples);
    w.echoes.reserve(std::min(reflections, s_.returns_max));
    w.record.reserve(s_.record_capacity());
    return w;
  }

  /// Sorts the reflections by range. Drops those without power, and those too far away for their samples to be counted.
  [[nodiscard]] Detection detect(const Heard& heard, Workspace& w) const noexcept {
    const Laser& laser = heard.emitter.laser;
    const std::span<Reflection> all = heard.reflections;
    w.peaks.clear();
    w.echoes.clear();
    w.record.clear();
    const PulseShape shape(laser.pulse_length, s_.shape_divisor);
    if (!by_samples && s_.record_length == 0) {
      const SinglePeakGroup group(all, shape, s_.sample_interval, w.group);
      if (group.one()) {
        detect(group, shape, w.echoes);
        return {w.echoes, {}, 0};
      }
    }
    const std::span<const Reflection> reflections = in_order_of_range(all, s_.sample_interval);
    if (reflections.empty()) return {};
    find_peaks(reflections, shape, s_.min_separation(laser.pulse_length), w);
    keep_echoes(s_, w.peaks);
    for (Peak& peak : w.peaks) {
      if constexpr (by_samples) peak.width = sampled_width(peak, reflections, shape, w.samples);
      w.echoes.push_back(echo_of(peak, reflections, shape, s_.timing));
    }
    const double start = SampledSum::first_sample(reflections.front(), shape, s_.sample_interval);
    SampledSum sum(reflections, shape, s_.sample_interval, 0, start);
    while (w.record.size() < w.record.capacity() && (!sum.all_in() || sum.time() < sum.last_peak() + SampledSum::negligible * shape.tau))
      w.record.push_back(static_cast<float>(sum.power()));
    return {w.echoes, w.record, start * s_.sample_interval};
  }

 private:
  static_assert(detail::MomentWidthMeasureCheck<Width>::passed);
  static constexpr bool by_moments = MomentWidthMeasure<Width>;
  static constexpr bool by_samples = !by_moments && !std::same_as<Width, NoWidth>;
  static constexpr std::size_t max_samples = 4096;  ///< samples of one echo; a longer echo gets a coarser grid
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Appends the only echo of a group, if it reaches the threshold.
  void detect(const SinglePeakGroup& group, const PulseShape& shape, std::vector<Echo>& echoes) const noexcept {
    const double peak = group.peak(), height = group.power(simd::Doubles{} + peak)[0];
    if (height < s_.threshold) return;
    echoes.push_back(group.echo(group.last_edge() + peak * shape.tau, height, s_.timing));
    if constexpr (by_moments) echoes.back().width = shape.tau * width_.width(group.moments());
  }

  void find_peaks(std::span<const Reflection> reflections, const PulseShape& shape, double min_separation, Workspace& w) const noexcept {
    const double per_metre = 2 / (speed_of_light * shape.tau);
    EdgeAgeMoments ages;
    Peak peak;             // current peak
    WaveformMoments m;     // moments since its valley
    WaveformMoments last;  // moments of the last peak entered
    double since = 0;      // time from its valley to the current edge [tau]
    bool rising = false, met = false;
    const auto finish = [&](double end) {
      peak.end = end;
      if (!met || peak.height < s_.threshold) return;
      if (!merge_or_append(peak, min_separation, 0, w.peaks)) last = {};
      last.add(m, (peak.begin - w.peaks.back().begin) / shape.tau);
      if constexpr (by_moments) w.peaks.back().width = shape.tau * width_.width(last);
    };
    for (std::size_t k = 0; k < reflections.size(); ++k) {
      ages.add(reflections[k].power);
      const double next = k + 1 == reflections.size() ? infinity : (reflections[k + 1].range - reflections[k].range) * per_metre;
      if (next == 0) continue;
      const double edge = arrival(reflections[k]) - PulseShape::peak * shape.tau;
      double x = 0;  // time since the edge [tau]
      // An extremum that rounding puts just before the edge is moved to it, so that peaks and valleys alternate.
      if (!rising && ages.can_turn() && ages.until_valley() < next && ages.until_peak() > 0) {
        x = std::fmax(ages.until_valley(), 0);
        if constexpr (by_moments) m.add(ages.until(x), since);
        finish(edge + x * shape.tau);
        peak = {.begin = peak.end};
        m = {};
        since = 0;
        met = false;
        rising = true;
        ages.advance(x);
      }
      const double rest = next - x;
      if (rising && (!ages.can_turn() || ages.until_peak() < rest)) {
        const double ahead = ages.can_turn() ? std::fmax(ages.until_peak(), 0) : 0;
        EdgeAgeMoments then = ages;
        then.advance(ahead);
        peak.time = peak.mark = edge + (x + ahead) * shape.tau;
        peak.height = then.power();
        met = true;
        rising = false;
      }
      if constexpr (by_moments) m.add(ages.until(rest), since);
      since += rest;
      ages.advance(rest);
    }
    finish(infinity);
  }

  /// Width of a peak from samples of the sum between its valleys [s].
  double sampled_width(const Peak& peak, std::span<const Reflection> reflections, const PulseShape& shape,
                       std::vector<double>& samples) const noexcept {
    const auto before = [](double limit) { return [limit](const Reflection& r) { return arrival(r) < limit; }; };
    const auto last = std::partition_point(reflections.begin() + 1, reflections.end(), before(peak.end)) - 1;
    const double end = std::fmin(peak.end, arrival(*last) + tail_of(width_) * shape.tau);
    const double interval = std::fmax(s_.sample_interval, (end - peak.begin) / static_cast<double>(max_samples - 2));
    const double faded = peak.begin - SampledSum::negligible * shape.tau;
    const auto first = std::partition_point(reflections.begin(), reflections.end(), before(faded));
    SampledSum sum(reflections, shape, interval, static_cast<std::size_t>(first - reflections.begin()), std::ceil(peak.begin / interval));
    samples.clear();
    while (sum.time() <= end) samples.push_back(sum.power());
    return width_.width(samples, interval);
  }

  WaveformSettings s_;
  Width width_;
};

static_assert(Detector<AnalyticWaveform<>> && Detector<AnalyticWaveform<MomentWidth>>);

}  // namespace PULSECAST_NAMESPACE

#endif
