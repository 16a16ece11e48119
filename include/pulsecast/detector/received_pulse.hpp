// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_RECEIVED_PULSE_HPP
#define PULSECAST_DETECTOR_RECEIVED_PULSE_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <pulsecast/base/exponential.hpp>
#include <pulsecast/detector/filtered_noise.hpp>
#include <pulsecast/detector/pulse_form.hpp>

namespace PULSECAST_NAMESPACE {

/// Pulse behind a receiver's low-pass, scaled to a peak of 1, as a table from which samples of any phase are interpolated: to 1e-6 of
/// the peak, with the same weights for all samples of a pulse.
class ReceivedPulse {
 public:
  /// For pulses of a full width at half maximum of `length` [s], and samples every `interval` [s].
  template <PulseForm Form>
  ReceivedPulse(const Form& form, double length, const LowPass& filter, double interval) : interval_(interval) {
    const double margin = 6 * filter.deviation, start = form.begin(length) - margin, end = form.end(length) + margin;
    phases_ = static_cast<std::size_t>(std::ceil(16 * interval / filter.deviation));
    step_ = interval / static_cast<double>(phases_);
    const auto size = static_cast<std::size_t>(std::ceil((end - start) / step_));
    table_.resize(size + 4);
    for (std::size_t i = 0; i < size; ++i) table_[i + 1] = filtered(form, length, filter, start + static_cast<double>(i) * step_);
    const auto top = std::max_element(table_.begin(), table_.end());
    const double slope = 0.5 * (top[1] - top[-1]), bend = top[-1] - 2 * *top + top[1];
    gain_ = bend < 0 ? *top - 0.5 * slope * slope / bend : *top;
    for (double& value : table_) value /= gain_;
    begin_ = start;
    count_ = size / phases_ + 1;
  }

  /// Time of the table's first value since the peak of the pulse before the low-pass [s].
  [[nodiscard]] double begin() const noexcept { return begin_; }
  /// Number of samples of a pulse, at most.
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// Height of the peak before it is scaled to 1: that of a pulse of peak 1 behind the low-pass.
  [[nodiscard]] double gain() const noexcept { return gain_; }
  /// Number of the first sample of a pulse whose peak arrives before the low-pass at a time [s].
  [[nodiscard]] double first_sample(double arrival) const noexcept { return std::ceil((arrival + begin_) / interval_); }

  /// Calls `add(k, value)` with the value of sample `first_sample(arrival) + k`, for all k below `count()`.
  template <class Add>
  void sample(double arrival, const Add& add) const noexcept {
    const double place = (first_sample(arrival) * interval_ - arrival - begin_) / step_;
    const double whole = std::min(std::floor(place), static_cast<double>(phases_ - 1)), x = place - whole;
    // Lagrange's polynomial through four values
    const std::array<double, 4> weights{-x * (x - 1) * (x - 2) / 6, (x + 1) * (x - 1) * (x - 2) / 2, -(x + 1) * x * (x - 2) / 2,
                                        (x + 1) * x * (x - 1) / 6};
    const double* value = table_.data() + static_cast<std::size_t>(whole);
    const double* const end = table_.data() + table_.size() - 3;
    for (std::size_t k = 0; value < end; ++k, value += phases_)
      add(k, weights[0] * value[0] + weights[1] * value[1] + weights[2] * value[2] + weights[3] * value[3]);
  }

 private:
  /// Convolution at a time, by Simpson's rule over the part of the pulse that the filter reaches.
  template <PulseForm Form>
  static double filtered(const Form& form, double length, const LowPass& filter, double time) {
    const double reach = 6 * filter.deviation;
    const double from = std::max(form.begin(length), time - reach), to = std::min(form.end(length), time + reach);
    if (!(from < to)) return 0;
    constexpr int intervals = 256;
    const double width = (to - from) / intervals;
    double sum = 0;
    for (int i = 0; i <= intervals; ++i) {
      const double at = i == intervals ? to : from + i * width, u = (time - at) / filter.deviation;
      const double weight = i == 0 || i == intervals ? 1 : i % 2 == 1 ? 4 : 2;
      sum += weight * form.power(at, length) * exponential(-0.5 * u * u);
    }
    return sum * width / (3 * filter.deviation * std::sqrt(2 * std::numbers::pi));
  }

  double interval_, step_ = 0, begin_ = 0, gain_ = 1;
  std::size_t phases_ = 1, count_ = 0;
  std::vector<double> table_;  ///< a value before the first and three after the last are 0
};

}  // namespace PULSECAST_NAMESPACE

#endif
