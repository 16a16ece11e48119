// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_PULSE_FORM_HPP
#define PULSECAST_DETECTOR_PULSE_FORM_HPP

#include <algorithm>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/search.hpp>
#include <pulsecast/detector/pulse_shape.hpp>

namespace PULSECAST_NAMESPACE {

/// Power of a laser pulse over time. `power(t, length)` is that at t since the pulse's peak [s], by
/// the peak's, for a full width at half maximum of `length` [s]. It is smooth between
/// `begin(length)` and `end(length)` [s], and 0 or negligible outside.
template <class F>
concept PulseForm = std::copyable<F> && requires(const F form, double time, double length) {
  { form.power(time, length) }
  noexcept->std::same_as<double>;
  { form.begin(length) }
  noexcept->std::same_as<double>;
  { form.end(length) }
  noexcept->std::same_as<double>;
};

/// Gamma distribution of order 3. Source: Carlsson, Steinvall & Letalick 2001, eq. 4.5.
struct GammaPulse {
  double divisor = PulseShape::divisor;  ///< as in `PulseShape`

  [[nodiscard]] double power(double time, double length) const noexcept { return PulseShape(length, divisor)(time); }
  [[nodiscard]] double begin(double length) const noexcept { return -PulseShape::peak * length / divisor; }
  [[nodiscard]] double end(double length) const noexcept { return 30 * length / divisor; }
};

/// Gaussian pulse.
struct GaussianPulse {
  [[nodiscard]] double power(double time, double length) const noexcept {
    const double halves = 2 * time / length;
    return exponential(-std::numbers::ln2 * halves * halves);
  }
  [[nodiscard]] double begin(double length) const noexcept { return -3 * length; }  // 1e-11 left
  [[nodiscard]] double end(double length) const noexcept { return 3 * length; }
};

/// Constant power; its peak is its middle.
struct RectangularPulse {
  [[nodiscard]] double power(double time, double length) const noexcept {
    return std::fabs(time) <= 0.5 * length ? 1 : 0;
  }
  [[nodiscard]] double begin(double length) const noexcept { return -0.5 * length; }
  [[nodiscard]] double end(double length) const noexcept { return 0.5 * length; }
};

/// Sample of a measured pulse.
struct PulseSample {
  double time = 0;   ///< any origin [s]
  double power = 0;  ///< in any unit, at least 0
};

/// Measured pulse, linear in its table, 0 outside, and of its length, whatever the laser's.
class MeasuredPulse {
 public:
  /// `samples`: at least two, by increasing time. @throws SettingError for others, or without power
  explicit MeasuredPulse(std::vector<PulseSample> samples) : samples_(std::move(samples)) {
    require_within("MeasuredPulse (number of samples)", samples_.size(), 2, 1e6, "");
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      require_within("MeasuredPulse: time", samples_[i].time, -1, 1, "s");
      require_not_negative("MeasuredPulse: power", samples_[i].power, "");
      if (i > 0 && !(samples_[i].time > samples_[i - 1].time))
        throw SettingError("MeasuredPulse: time", samples_[i].time, "s", "later than the sample before");
    }
    const PulseSample peak = *std::ranges::max_element(samples_, {}, &PulseSample::power);
    require_positive("MeasuredPulse: greatest power", peak.power, "");
    for (PulseSample& sample : samples_) sample = {sample.time - peak.time, sample.power / peak.power};
  }

  [[nodiscard]] double power(double time, double) const noexcept {
    if (!(time >= samples_.front().time && time <= samples_.back().time)) return 0;
    return detail::interpolated(samples_, time, &PulseSample::time, &PulseSample::power);
  }
  [[nodiscard]] double begin(double) const noexcept { return samples_.front().time; }
  [[nodiscard]] double end(double) const noexcept { return samples_.back().time; }

 private:
  std::vector<PulseSample> samples_;  ///< about the peak, relative to it
};

}  // namespace PULSECAST_NAMESPACE

#endif
