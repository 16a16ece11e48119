// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_IDEAL_SAMPLES_HPP
#define PULSECAST_DETECTOR_IDEAL_SAMPLES_HPP

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <pulsecast/base/random.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/detector/pulse_shape.hpp>
#include <pulsecast/detector/pulse_sum.hpp>
#include <pulsecast/detector/waveform_settings.hpp>

namespace PULSECAST_NAMESPACE {

/// Samples of a receiver of infinite bandwidth: the sum of the pulses of all reflections, with independent noise of each sample. Samples
/// come in sections, with gaps where nothing is heard. With noise, it listens from the first reflection on, for the length of the record
/// and as long as reflections arrive.
class IdealSamples {
 public:
  /// For reflections sorted by range. `deviation` is that of the noise [W]; the mean of the background is not in the samples [W].
  /// `width_tail` is the time after the last pulse's peak that a width or a centroid needs [tau].
  IdealSamples(double deviation, double background, const WaveformSettings& s, const Heard& heard, std::span<const Reflection> reflections,
               double width_tail) noexcept
      : reflections_(reflections),
        shape_(heard.emitter.laser.pulse_length, s.shape_divisor),
        key_(heard.key),
        interval_(s.sample_interval),
        record_size_(static_cast<double>(s.record_capacity())),
        deviation_(deviation),
        background_(background) {
    key_.purpose = Purpose::receiver_noise;
    if (reflections.empty()) return;
    died_away_ = SampledSum::negligible * shape_.tau;
    tail_ = noisy() || record_size_ > 0 ? died_away_ : std::fmax(3 * interval_, width_tail * shape_.tau);
    start_ = first_sample(0);
  }

  /// Shape of a reflection's pulse in the samples, about its peak.
  [[nodiscard]] const PulseShape& shape() const noexcept { return shape_; }
  /// Number of the first sample.
  [[nodiscard]] double start() const noexcept { return start_; }

  [[nodiscard]] double delay() const noexcept { return 0; }                  ///< of a pulse's maximum in the samples [s]
  [[nodiscard]] double background() const noexcept { return background_; }   ///< mean that is not in the samples [W]
  [[nodiscard]] bool independent_noise() const noexcept { return noisy(); }  ///< true if samples have noise of their own each

  /// Begins the next section; false if there is none.
  [[nodiscard]] bool begin_section() noexcept {
    if (next_ == reflections_.size()) return false;
    sum_.emplace(reflections_, shape_, interval_, next_, first_sample(next_));
    return true;
  }

  /// Number of the next sample of the section.
  [[nodiscard]] double number() const noexcept { return sum_->sample(); }

  /// Next sample [W]; sets `more` if the section goes on behind it.
  [[nodiscard]] double power(bool& more) noexcept {
    const double n = sum_->sample(), t = sum_->time();
    double power = sum_->power();
    next_ = sum_->next();
    if (noisy()) {
      const auto number = static_cast<std::uint64_t>(n - start_);
      key_.subray = static_cast<std::uint32_t>(number);
      key_.part = static_cast<std::uint32_t>(number >> 32);
      power += deviation_ * normal(key_);
    }
    const bool silent = next_ > 0 && t > sum_->last_peak() + tail_;
    const bool listening = noisy() && n - start_ < record_size_;
    more = !silent || listening || (next_ < reflections_.size() && first_sample(next_) <= n + died_away_ / interval_);
    return power;
  }

 private:
  [[nodiscard]] bool noisy() const noexcept { return deviation_ > 0; }
  [[nodiscard]] double first_sample(std::size_t r) const noexcept { return SampledSum::first_sample(reflections_[r], shape_, interval_); }

  std::span<const Reflection> reflections_;
  PulseShape shape_;
  RandomKey key_;
  double interval_, record_size_, deviation_, background_;
  double died_away_ = 0, tail_ = 0, start_ = 0;
  std::size_t next_ = 0;
  std::optional<SampledSum> sum_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
