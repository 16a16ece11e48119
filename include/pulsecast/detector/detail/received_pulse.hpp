// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_RECEIVED_PULSE_HPP
#define PULSECAST_DETECTOR_DETAIL_RECEIVED_PULSE_HPP

#include <pulsecast/detector/detail/filtered_noise.hpp>
#include <pulsecast/detector/pulse_form.hpp>

namespace PULSECAST_NAMESPACE {

/// Pulse after a receiver's low-pass, scaled to a peak of 1, as a table from which samples of any
/// phase are interpolated to 1e-6 of the peak. All samples of a pulse have the same weights: the
/// pulses of many reflections between two samples cost one sum of rows, one row per phase.
class ReceivedPulse {
 public:
  /// For pulses of a full width at half maximum of `length` [s], and samples every `interval` [s].
  ReceivedPulse(const PulseForm auto& form, double length, const LowPass& filter, double interval)
      : interval_(interval) {
    const double margin = 6 * filter.deviation, start = form.begin(length) - margin, end = form.end(length) + margin;
    phases_ = static_cast<std::size_t>(std::ceil(16 * interval / filter.deviation));
    step_ = interval / static_cast<double>(phases_);
    auto size = static_cast<std::size_t>(std::ceil((end - start) / step_));
    std::vector<double> values(size);
    for (std::size_t i = 0; i < size; ++i)
      values[i] = filtered(form, length, filter, start + static_cast<double>(i) * step_);
    const auto top = static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
    const auto value = [&](std::size_t i) { return i < values.size() ? values[i] : 0; };
    const double slope = 0.5 * (value(top + 1) - value(top - 1));
    const double bend = value(top - 1) - 2 * value(top) + value(top + 1);
    const double beyond = bend < 0 ? -slope / bend : 0;
    gain_ = value(top) + 0.5 * slope * beyond;
    peak_ = start + (static_cast<double>(top) + beyond) * step_;
    concave_ = concave_about(values, top) * step_;
    const auto high = [&](double v) { return v >= 0.5 * gain_; };
    width_ = step_ * static_cast<double>(std::count_if(values.begin(), values.end(), high));
    begin_ = start;
    while (size > top && values[size - 1] < negligible * gain_) --size;
    values.resize(size);
    count_ = size / phases_ + 1;
    stride_ = (count_ + simd::lane_count) / simd::lane_count * simd::lane_count;
    rows_.assign((phases_ + 3) * stride_, 0);
    for (std::size_t q = 0; q < phases_ + 3; ++q)
      for (std::size_t k = 0; k < stride_; ++k)
        if (const std::size_t i = k * phases_ + q; i > 0) rows_[q * stride_ + k] = value(i - 1) / gain_;
    points_.resize(count_ * phases_ + 1);
    for (std::size_t i = 0; i < points_.size(); ++i) points_[i].value = value(i) / gain_;
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) points_[i + 1].integrals = until(i, 1);
  }

  /// Time of the table's first value since the peak of the pulse before the low-pass [s].
  [[nodiscard]] double begin() const noexcept { return begin_; }
  /// Time of the table's last value [s].
  [[nodiscard]] double end() const noexcept { return begin_ + static_cast<double>(count_ * phases_) * step_; }
  /// Time of the maximum after the low-pass since the peak before it [s].
  [[nodiscard]] double peak() const noexcept { return peak_; }
  /// Time on either side of the maximum within which the pulse is concave, less a sample of the
  /// table; 0 for a pulse with another maximum. Closer pulses have one maximum [s].
  [[nodiscard]] double concave() const noexcept { return concave_; }
  /// Full width at half maximum [s].
  [[nodiscard]] double width() const noexcept { return width_; }
  /// Value at a time since the peak before the low-pass [s], between the two nearest of the table.
  [[nodiscard]] double operator()(double time) const noexcept {
    const double place = (time - begin_) / step_;
    if (!(place >= 0 && place < static_cast<double>(count_ * phases_))) return 0;
    const auto i = static_cast<std::size_t>(place);
    const double* const value = rows_.data() + (i % phases_ + 1) * stride_ + i / phases_;
    return value[0] + (place - static_cast<double>(i)) * (value[stride_] - value[0]);
  }
  /// Integrals up to a time since the peak before the low-pass [s].
  [[nodiscard]] detail::PulseIntegrals until(double time) const noexcept {
    const double place = (time - begin_) / step_;
    if (!(place > 0)) return {};
    if (!(place < static_cast<double>(count_ * phases_))) return points_.back().integrals;
    const auto i = static_cast<std::size_t>(place);
    return until(i, place - static_cast<double>(i));
  }
  /// Number of samples of a pulse, at most.
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  /// Height of the peak before it is scaled to 1: that of a pulse of peak 1 after the low-pass.
  [[nodiscard]] double gain() const noexcept { return gain_; }
  /// Number of the first sample of a pulse whose peak arrives before the low-pass at a time [s].
  [[nodiscard]] double first_sample(double arrival) const noexcept { return std::ceil((arrival + begin_) / interval_); }

  /// Number of rows: phases of the samples, and three more for the interpolation.
  [[nodiscard]] std::size_t rows() const noexcept { return phases_ + 3; }
  /// Samples of a pulse of one phase: `stride()` numbers, 0 after the pulse.
  [[nodiscard]] const double* row(std::size_t q) const noexcept { return rows_.data() + q * stride_; }
  [[nodiscard]] std::size_t stride() const noexcept { return stride_; }  ///< of whole registers

  /// Weights of the four rows whose sum are the samples of a pulse from `first_sample` on.
  struct Phase {
    std::size_t first;              ///< number of the first row
    std::array<double, 4> weights;  ///< Lagrange's polynomial
  };
  /// Those of a pulse whose peak arrives before the low-pass at a time [s].
  [[nodiscard]] Phase phase(double arrival) const noexcept {
    const double place = (first_sample(arrival) * interval_ - arrival - begin_) / step_;
    const double whole = std::min(std::floor(place), static_cast<double>(phases_ - 1)), x = place - whole;
    return {static_cast<std::size_t>(whole),
            {-x * (x - 1) * (x - 2) / 6, (x + 1) * (x - 1) * (x - 2) / 2, -(x + 1) * x * (x - 2) / 2,
             (x + 1) * x * (x - 1) / 6}};
  }

 private:
  /// Integrals up to a share x of the way from value i to the next.
  [[nodiscard]] detail::PulseIntegrals until(std::size_t i, double x) const noexcept {
    const auto& [before, from] = points_[i];
    const double rise = points_[i + 1].value - from, time = begin_ + static_cast<double>(i) * step_, way = step_ * x;
    const double zeroth = way * (from + 0.5 * x * rise), first = way * way * (0.5 * from + 1.0 / 3 * x * rise);
    return {before.zeroth + zeroth, before.first + time * zeroth + first};
  }

  static double concave_about(const std::vector<double>& values, std::size_t top) noexcept {
    for (std::size_t i = 1; i < values.size(); ++i)
      if (i <= top ? values[i] < values[i - 1] : values[i] > values[i - 1]) return 0;
    std::size_t reach = 0;
    const auto bends_down = [&](std::size_t i) { return values[i - 1] - 2 * values[i] + values[i + 1] < 0; };
    while (top > reach + 1 && top + reach + 2 < values.size() && bends_down(top - reach) && bends_down(top + reach))
      ++reach;
    return reach < 2 ? 0 : static_cast<double>(reach - 2);
  }

  /// Convolution at a time, by Simpson's rule over the part of the pulse that the filter reaches.
  static double filtered(const PulseForm auto& form, double length, const LowPass& filter, double time) {
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

  static constexpr double negligible = 1e-8;  ///< share of the peak at which the table ends

  double interval_, step_ = 0, begin_ = 0, gain_ = 1, peak_ = 0, concave_ = 0, width_ = 0;
  std::size_t phases_ = 1, count_ = 0, stride_ = 0;
  struct Point {
    detail::PulseIntegrals integrals{};  ///< up to there
    double value = 0;
  };
  std::vector<Point> points_;
  std::vector<double> rows_;  ///< value i - 1 is number i / phases of row i % phases
};

}  // namespace PULSECAST_NAMESPACE

#endif
