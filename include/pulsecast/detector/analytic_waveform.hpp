// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_ANALYTIC_WAVEFORM_HPP
#define PULSECAST_DETECTOR_ANALYTIC_WAVEFORM_HPP

#include <pulsecast/detector/adaptor.hpp>
#include <pulsecast/detector/detail/edge_age_moments.hpp>
#include <pulsecast/detector/detail/ideal_samples.hpp>
#include <pulsecast/detector/detail/single_peak_group.hpp>

namespace PULSECAST_NAMESPACE {

/// Peak detector on the sum of the pulse shapes of all reflections, without sampling: times and
/// heights are exact. Between two leading edges the sum is a quadratic polynomial times an
/// exponential, so one pass over the reflections finds all extrema. A `SinglePeakGroup` is
/// evaluated without sorting. It finds close echoes that the bins of `FullWaveform` lose
/// (docs/tradeoff.md), which models the digitiser's bins and the receiver's noise.
///
/// Continuous returns are exact, too: between all edges, theirs included, the sum is a quadratic
/// polynomial times an exponential, and a linear one. Its extrema are bracketed in steps of a
/// quarter of tau, where it may rise. They have no part in widths.
///
/// `WaveformSettings::sample_interval` is of the record and of a fitted width.
template <EchoWidth Width = NoWidth>
class AnalyticWaveform {
 public:
  using refinements = refines<tag::SamplesWaveforms, tag::ValidatesLaser>;
  /// @throws SettingError for settings out of range, a prominence, or a timing by samples
  explicit AnalyticWaveform(WaveformSettings settings = {}, Width width = {})
      : s_(validated(settings)), width_(validated(std::move(width))) {
    require_within("AnalyticWaveform: WaveformSettings::prominence", s_.prominence, 0, 0, "W");
    if (s_.timing > EchoTiming::peak)
      throw SettingError("AnalyticWaveform: WaveformSettings::timing", static_cast<double>(s_.timing), "",
                         "true_range or peak");
  }

  [[nodiscard]] const WaveformSettings& settings() const noexcept { return s_; }
  [[nodiscard]] double sample_interval() const noexcept { return s_.sample_interval; }

  /// Refuses pulses that a record or fitted width does not resolve. @throws SettingError
  void validate(const Laser& laser) const {
    if (by_samples || s_.record_length > 0) s_.require_sampled(laser.pulse_length, detail::infinity);
  }

  [[nodiscard]] double pulse_width(const Laser& laser) const {
    validate(laser);
    const PulseShape shape(laser.pulse_length, s_.shape_divisor);
    if constexpr (by_samples) {
      const double whole = (PulseShape::peak + SampledSum::negligible) * shape.tau;
      return pulsecast::pulse_width(width_, shape, interval_of(whole));
    } else if constexpr (by_moments) {
      EdgeAgeMoments pulse;
      pulse.add(1);
      return shape.tau * width_.width(pulse.until(detail::infinity));
    } else {
      return 0;
    }
  }

  struct Workspace {
    std::vector<Peak> peaks;           ///< peaks of the current pulse
    std::vector<double> samples;       ///< samples of one echo, for a fitted width [W]
    std::vector<Echo> echoes;          ///< echoes of the current pulse
    std::vector<float> record;         ///< samples of the kept waveform [W]
    SinglePeakGroup::Workspace group;  ///< ages and weights
  };

  [[nodiscard]] Workspace workspace(std::size_t reflections) const {
    Workspace w{{}, {}, {}, {}, SinglePeakGroup::Workspace(reflections)};
    w.peaks.reserve(reflections + 64);  // some of continuous returns
    if constexpr (by_samples) w.samples.reserve(max_samples);
    w.echoes.reserve(std::min(w.peaks.capacity(), s_.returns_max));
    w.record.reserve(s_.record_capacity());
    return w;
  }

  /// Sorts the reflections by range. Drops those without power, or too far away to count samples.
  [[nodiscard]] Detection detect(const DetectorInput& input, Workspace& w) const noexcept {
    const Laser& laser = input.emitter.laser;
    const std::span<Reflection> all = input.reflections;
    w.peaks.clear();
    w.echoes.clear();
    w.record.clear();
    const PulseShape shape(laser.pulse_length, s_.shape_divisor);
    if (!by_samples && s_.record_length == 0 && input.continuous.empty()) {
      const SinglePeakGroup group(all, shape, s_.sample_interval, w.group);
      if (group.one()) {
        detect(group, shape, w.echoes);
        return {w.echoes, {}, 0};
      }
    }
    const std::span<const Reflection> reflections = in_order_of_range(all, s_.sample_interval);
    const std::span<const ContinuousReturn> continuous = input.continuous;
    if (reflections.empty() && continuous.empty()) return {};
    Finder finder{*this, shape, s_.min_separation(laser.pulse_length), w.peaks};
    if (continuous.empty())
      finder.find(reflections);
    else
      finder.find(reflections, continuous);
    keep_echoes(s_, w.peaks);
    const detail::ContinuousRises rises(continuous, detail::GammaIntegrals(shape));
    for (Peak& peak : w.peaks) {
      if constexpr (by_samples) peak.width = sampled_width(peak, reflections, shape, w.samples);
      keep_return(echo_of(peak, reflections, shape, s_.timing, rises.sources(0)), s_, w.echoes);
    }
    number_echoes(w.echoes);
    if (!continuous.empty()) return {w.echoes, w.record, record(input, reflections, w.record)};
    const double start = SampledSum::first_sample(reflections.front(), shape, s_.sample_interval);
    SampledSum sum(reflections, shape, s_.sample_interval, 0, start);
    while (w.record.size() < w.record.capacity() &&
           (!sum.all_in() || sum.time() < sum.last_peak() + SampledSum::negligible * shape.tau))
      w.record.push_back(static_cast<float>(sum.power()));
    return {w.echoes, w.record, start * s_.sample_interval};
  }

 private:
  static constexpr bool by_moments = MomentWidthMeasure<Width>;
  static constexpr bool by_samples = !by_moments && !std::same_as<Width, NoWidth>;
  static constexpr std::size_t max_samples = 4096;  ///< of one echo; longer ones get a coarser grid

  /// Appends the only echo of a group, if it reaches the threshold.
  void detect(const SinglePeakGroup& group, const PulseShape& shape, std::vector<Echo>& echoes) const noexcept {
    const double peak = group.peak(), height = group.power(simd::Doubles{} + peak)[0];
    if (height < s_.threshold) return;
    echoes.push_back(group.echo(group.last_edge() + peak * shape.tau, height, s_.timing));
    if constexpr (by_moments) echoes.back().width = shape.tau * width_.width(group.moments());
  }

  /// Search for the maxima of a waveform.
  struct Finder {
    const AnalyticWaveform& detector;
    const PulseShape& shape;
    double min_separation;     ///< see `merge_or_append` [s]
    std::vector<Peak>& peaks;  ///< those found

    EdgeAgeMoments ages{};        ///< reflections
    Peak peak{};                  ///< current peak
    WaveformMoments m{}, last{};  ///< moments since its valley, and of the last peak entered
    double since = 0;             ///< time from its valley to the current edge [tau]
    bool rising = false, met = false;

    void finish(double end) noexcept {
      peak.end = end;
      if (!met || peak.height < detector.s_.threshold) return;
      if (!merge_or_append(peak, min_separation, 0, peaks)) last = {};
      last.add(m, (peak.begin - peaks.back().begin) / shape.tau);
      if constexpr (by_moments) peaks.back().width = shape.tau * detector.width_.width(last);
    }
    void begin(double valley) noexcept {
      finish(valley);
      peak = {.begin = valley};
      m = {};
      since = 0;
      met = false;
      rising = true;
    }
    void enter(double time, double height) noexcept {
      peak.time = peak.mark = time;
      peak.height = height;
      met = true;
      rising = false;
    }

    void find(std::span<const Reflection> reflections) noexcept {
      const double per_metre = 2 / (speed_of_light * shape.tau);
      for (std::size_t k = 0; k < reflections.size(); ++k) {
        ages.add(reflections[k].power);
        const double next = k + 1 == reflections.size() ? detail::infinity
                                                        : (reflections[k + 1].range - reflections[k].range) * per_metre;
        if (next == 0) continue;
        const double edge = arrival(reflections[k]) - PulseShape::peak * shape.tau;
        double x = 0;  // time since the edge [tau]
        // An extremum that rounding puts before an edge moves to it: peaks and valleys alternate.
        if (!rising && ages.can_turn() && ages.until_valley() < next && ages.until_peak() > 0) {
          x = std::fmax(ages.until_valley(), 0);
          if constexpr (by_moments) m.add(ages.until(x), since);
          begin(edge + x * shape.tau);
          ages.advance(x);
        }
        const double rest = next - x;
        if (rising && (!ages.can_turn() || ages.until_peak() < rest)) {
          const double ahead = ages.can_turn() ? std::fmax(ages.until_peak(), 0) : 0;
          EdgeAgeMoments then = ages;
          then.advance(ahead);
          enter(edge + (x + ahead) * shape.tau, then.power());
        }
        if constexpr (by_moments) m.add(ages.until(rest), since);
        since += rest;
        ages.advance(rest);
      }
      finish(detail::infinity);
    }

    /// Reflections and continuous returns at a time.
    struct Sum {
      EdgeAgeMoments ages;               ///< of the reflections
      detail::ContinuousSum continuous;  ///< of the continuous returns
      double time;                       ///< [s]

      /// Moves on to a later time `to` [s].
      void advance(double to, double tau) noexcept {
        ages.advance((to - time) / tau);
        continuous.advance(to);
        time = to;
      }
      /// Slope of both; its zeros are those of the power.
      [[nodiscard]] double slope() const noexcept { return ages.slope() + continuous.slope(); }
      /// Sum at the zero of its slope up to a time [s]: after Dowell & Jarratt 1971.
      [[nodiscard]] Sum at_extremum(double to, double tau) const noexcept {
        Sum middle = *this;
        middle.advance(to, tau);
        double low = time, high = to, below = slope(), above = middle.slope();
        int side = 0;  // end that was moved last
        for (double before = low; std::fabs(middle.time - before) > 1e-9 * tau;) {
          before = middle.time;
          middle = *this;
          middle.advance(low + (high - low) * below / (below - above), tau);
          const double there = middle.slope();
          const bool same = (there > 0) == (below > 0);
          (same ? low : high) = middle.time;
          (same ? below : above) = there;
          if (side == (same ? 1 : 2)) (same ? above : below) *= 0.5;
          side = same ? 1 : 2;
        }
        return middle;
      }
    };

    void find(std::span<const Reflection> reflections, std::span<const ContinuousReturn> continuous) noexcept {
      detail::ContinuousRises rises(continuous, detail::GammaIntegrals(shape));
      const double to_edge = PulseShape::peak * shape.tau;
      std::size_t next = 0;
      const auto next_edge = [&] {
        return next < reflections.size() ? arrival(reflections[next]) - to_edge : detail::infinity;
      };
      double time = std::fmin(next_edge(), rises.next());
      const double only_rises = rises.first_peak() - 0.25 * shape.tau;  // before any reflection
      if (only_rises > time && next_edge() > only_rises + to_edge) time = only_rises;
      double rising_until = time;
      Sum sum{{}, detail::ContinuousSum(continuous, shape), time};
      while (time < detail::infinity) {
        for (; next_edge() <= time; ++next) {
          sum.ages.add(reflections[next].power);
          rising_until = time + to_edge;
        }
        rises.pass(time);
        const bool falls = !rising && time > rising_until && time >= rises.until();
        const double soon = std::fmin(next_edge(), rises.next()),
                     to = falls ? soon : std::fmin(soon, time + 0.25 * shape.tau);
        if (!(to < detail::infinity)) break;
        Sum then = sum;
        then.advance(to, shape.tau);
        if (!falls && !rising && then.slope() > 0)
          begin(sum.slope() < 0 ? sum.at_extremum(to, shape.tau).time : time);
        else if (rising && then.slope() <= 0) {
          const Sum top = sum.at_extremum(to, shape.tau);
          enter(top.time, top.ages.power() + top.continuous.power());
        }
        if constexpr (by_moments) m.add(sum.ages.until((to - time) / shape.tau), since);
        since += (to - time) / shape.tau;
        sum = then;
        time = to;
      }
      if constexpr (by_moments) m.add(sum.ages.until(detail::infinity), since);
      finish(detail::infinity);
    }
  };

  /// Keeps the record of a pulse with continuous returns. Returns the time of its first sample [s].
  double record(const DetectorInput& input, std::span<const Reflection> reflections,
                std::vector<float>& record) const noexcept {
    IdealSamples samples(0, 0, s_, input, reflections, 0);
    while (record.size() < record.capacity() && samples.begin_section())
      for (bool more = true; more && record.size() < record.capacity();) {
        record.resize(std::min(record.capacity(), static_cast<std::size_t>(samples.number() - samples.start()) + 1));
        record.back() = static_cast<float>(samples.power(more));
      }
    return samples.start() * s_.sample_interval;
  }

  /// Distance of the samples of an echo of a length [s].
  [[nodiscard]] double interval_of(double length) const noexcept {
    return std::fmax(s_.sample_interval, length / static_cast<double>(max_samples - 2));
  }

  /// Width of a peak from samples of the sum between its valleys [s].
  double sampled_width(const Peak& peak, std::span<const Reflection> reflections, const PulseShape& shape,
                       std::vector<double>& samples) const noexcept {
    if (reflections.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto first_from = [&](double time) { return detail::first_arrival(reflections, time); };
    const Reflection& last = reflections[std::max<std::size_t>(1, first_from(peak.end)) - 1];
    const double end = std::fmin(peak.end, arrival(last) + detail::tail_of(width_) * shape.tau);
    const double interval = interval_of(end - peak.begin);
    const double faded = peak.begin - SampledSum::negligible * shape.tau;
    SampledSum sum(reflections, shape, interval, first_from(faded), std::ceil(peak.begin / interval));
    samples.clear();
    while (sum.time() <= end) samples.push_back(sum.power());
    return width_.width(samples, interval);
  }

  WaveformSettings s_;
  Width width_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
