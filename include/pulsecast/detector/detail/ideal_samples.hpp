// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_IDEAL_SAMPLES_HPP
#define PULSECAST_DETECTOR_DETAIL_IDEAL_SAMPLES_HPP

#include <pulsecast/detector/detail/continuous_waveform.hpp>

namespace PULSECAST_NAMESPACE {

/// Samples of a receiver of infinite bandwidth: the sum of all pulses, with independent noise.
/// Samples come in sections, with gaps where there is no light or no maximum. With noise, they
/// begin with the first light and last for the length of the record, or as long as light arrives.
class IdealSamples {
 public:
  /// For reflections sorted by range. `deviation` is that of the noise [W], `background` a mean
  /// that is not in the samples [W]. `width_tail`: time that a width or centroid needs [tau].
  IdealSamples(double deviation, double background, const WaveformSettings& s, const DetectorInput& input,
               std::span<const Reflection> reflections, double width_tail) noexcept
      : reflections_(reflections),
        shape_(input.emitter.laser.pulse_length, s.shape_divisor),
        continuous_(input.continuous, shape_),
        rises_(input.continuous, detail::GammaIntegrals(shape_)),
        key_(input.key.with(Purpose::receiver_noise)),
        interval_(s.sample_interval),
        record_size_(static_cast<double>(s.record_capacity())),
        deviation_(deviation),
        background_(background) {
    if (reflections.empty() && continuous_.empty()) return;
    died_away_ = SampledSum::negligible * shape_.tau;
    tail_ = noisy() || record_size_ > 0 ? died_away_ : std::fmax(3 * interval_, width_tail * shape_.tau);
    start_ = std::fmin(reflections.empty() ? detail::infinity : first_sample(0), before(rises_.start()));
    if ((noisy() || record_size_ > 0) && !continuous_.empty()) heard_until_ = rises_.end();
    peaks_only_ = !noisy() && record_size_ == 0 && width_tail == 0 && s.timing <= EchoTiming::peak;
  }

  /// Shape of a reflection's pulse in the samples, about its peak.
  [[nodiscard]] const PulseShape& shape() const noexcept { return shape_; }
  /// Number of the first sample.
  [[nodiscard]] double start() const noexcept { return start_; }
  /// Delay of a pulse's maximum in the samples [s].
  [[nodiscard]] double delay() const noexcept { return 0; }
  [[nodiscard]] double background() const noexcept { return background_; }
  /// True if samples have noise of their own each.
  [[nodiscard]] bool independent_noise() const noexcept { return noisy(); }

  /// Begins the next section; false if there is none.
  [[nodiscard]] bool begin_section() noexcept {
    const double solid = next_ == reflections_.size() ? detail::infinity : first_sample(next_);
    const double rise = before(rises_.next()), late = before(rises_.first_peak());
    const double first = std::fmin(solid, peaks_only_ && late < solid ? std::fmax(late, rise) : rise);
    if (!(first < detail::infinity)) return false;
    sum_.emplace(reflections_, shape_, interval_, next_, first);
    falling_ = 0;
    return true;
  }

  /// Continuous returns in a peak, as `echo_of` takes them.
  [[nodiscard]] auto continuous() const noexcept { return rises_.sources(0); }

  /// Appends samples of reflections alone, after which the section goes on, to `y`.
  void append(std::vector<double>& y) noexcept {
    if (continuous_.empty() && !noisy() && record_size_ == 0) sum_->append(y, tail_, died_away_ / interval_);
  }

  /// Number of the next sample of the section.
  [[nodiscard]] double number() const noexcept { return sum_->sample(); }

  /// Next sample [W]; sets `more` if the section continues after it.
  [[nodiscard]] double power(bool& more) noexcept {
    const double n = sum_->sample(), t = sum_->time();
    double power = sum_->power();
    next_ = sum_->next();
    const bool may_rise = !continuous_.empty() && add_continuous(t, power);
    if (noisy()) {
      const auto number = static_cast<std::uint64_t>(n - start_);
      key_.subray = static_cast<std::uint32_t>(number);
      key_.part = static_cast<std::uint32_t>(number >> 32);
      power += deviation_ * normal(key_);
    }
    const bool silent = next_ == 0 || t > sum_->last_peak() + tail_;
    const bool listening = noisy() && n - start_ < record_size_;
    more = !silent || listening || may_rise ||
           (next_ < reflections_.size() && first_sample(next_) <= n + died_away_ / interval_);
    return power;
  }

 private:
  static constexpr int fallen = 4;  ///< falling samples after a maximum

  /// Adds the continuous returns at a time [s]; true if samples are needed after it.
  bool add_continuous(double t, double& power) noexcept {
    rises_.pass(t);
    continuous_.advance(t);
    const double now = continuous_.power();
    falling_ = now <= last_ ? falling_ + 1 : 0;
    last_ = now;
    power += now;
    const double number = sum_->sample() - start_;  // of the next sample
    return falling_ < fallen || t <= rises_.until() + tail_ || before(rises_.next()) <= sum_->sample() ||
           (t < heard_until_ && (noisy() || number < record_size_));
  }

  /// Number of the first sample that light needs from a time on [s].
  [[nodiscard]] double before(double time) const noexcept { return std::floor(time / interval_) - 2; }

  [[nodiscard]] bool noisy() const noexcept { return deviation_ > 0; }
  [[nodiscard]] double first_sample(std::size_t r) const noexcept {
    return SampledSum::first_sample(reflections_[r], shape_, interval_);
  }

  std::span<const Reflection> reflections_;
  PulseShape shape_;
  detail::ContinuousSum continuous_;
  detail::ContinuousRises<detail::GammaIntegrals> rises_;
  RandomKey key_;
  double interval_, record_size_, deviation_, background_;
  double died_away_ = 0, tail_ = 0, start_ = 0;
  double heard_until_ = 0;   ///< time up to which continuous returns are sampled everywhere [s]
  double last_ = 0;          ///< their last sample [W]
  int falling_ = 0;          ///< samples since they rose
  bool peaks_only_ = false;  ///< true if nothing but maxima is of interest
  std::size_t next_ = 0;
  std::optional<SampledSum> sum_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
