// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_EDGE_AGE_MOMENTS_HPP
#define PULSECAST_DETECTOR_DETAIL_EDGE_AGE_MOMENTS_HPP

#include <pulsecast/detector/echo_width.hpp>

namespace PULSECAST_NAMESPACE {

/// Sum of the pulse shapes whose leading edges have passed, in closed form until the next edge.
///
/// An edge of age u [tau] contributes P u^2 e^-u. Weight each age by P e^-u; let W be the sum of
/// the weights, m the mean and v the variance of the ages. The sum of pulses is W (m^2 + v), and W
/// e^-x ((m + x)^2 + v) a time x later. Its slope is zero at the ages m + x = 1 - sqrt(1 - v), a
/// valley, and 1 + sqrt(1 - v), a peak; nowhere for v > 1. Derived from `PulseShape`.
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
  // times to these zeros, negative if passed [tau]
  [[nodiscard]] double until_valley() const noexcept { return 1 - std::sqrt(1 - variance_) - mean_; }
  [[nodiscard]] double until_peak() const noexcept { return 1 + std::sqrt(1 - variance_) - mean_; }

  /// Sum of pulses now [W].
  [[nodiscard]] double power() const noexcept {
    return weight_ * (mean_ * mean_ + variance_) * PulseShape::to_unit_peak;
  }

  /// Slope of the sum now [W/tau].
  [[nodiscard]] double slope() const noexcept {
    return weight_ * (2 * mean_ - mean_ * mean_ - variance_) * PulseShape::to_unit_peak;
  }

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

}  // namespace PULSECAST_NAMESPACE

#endif
