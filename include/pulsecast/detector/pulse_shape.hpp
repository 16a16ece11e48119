// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_PULSE_SHAPE_HPP
#define PULSECAST_DETECTOR_PULSE_SHAPE_HPP

#include <cmath>
#include <numbers>

#include <pulsecast/base/exponential.hpp>

namespace PULSECAST_NAMESPACE {

/// Laser pulse in time: (t/tau)^2 exp(-t/tau) from its leading edge on, with a peak of 1.
/// Source: Carlsson, Steinvall & Letalick 2001, eq. 4.5; the literature has a divisor of 3.5.
struct PulseShape {
  double tau;  ///< time constant [s]

  static constexpr double divisor = 3.394680670846503;  ///< full width at half maximum by tau

  /// `by_tau`: full width at half maximum by tau, if it is another.
  explicit PulseShape(double pulse_length, double by_tau = divisor) noexcept : tau(pulse_length / by_tau) {}

  static constexpr double peak = 2;  ///< time of the peak since the leading edge [tau]
  static constexpr double to_unit_peak = std::numbers::e * std::numbers::e / 4;  ///< to a peak of 1

  /// Standard deviation in time [s]: the shape is a gamma distribution of order 3.
  [[nodiscard]] double deviation() const noexcept { return std::numbers::sqrt3 * tau; }

  /// Upper bound of the time since the peak at which a share of the power is left [tau]. As u^2
  /// e^(-u/2) is at most 16/e^2, the shape is at most 4 e^(-u/2), with u = t/tau.
  [[nodiscard]] static double fallen_to(double share) noexcept { return 2 * std::log(4 / share) - peak; }

  [[nodiscard]] double begin() const noexcept { return -peak * tau; }  ///< leading edge [s]
  /// Time since the peak when 1e-22 of a pulse is left [s].
  [[nodiscard]] double end() const noexcept { return 60 * tau; }

  /// Power at time t since the peak [s]; 1 at t = 0.
  [[nodiscard]] double operator()(double t) const noexcept { return at(t); }
  /// As above, at times of lanes.
  [[nodiscard]] simd::Doubles operator()(const simd::Doubles& t) const noexcept { return at(t); }

 private:
  template <class Number>
  [[nodiscard]] Number at(const Number& t) const noexcept {
    const Number u = t / tau + peak;
    return u > 0 ? u * u * exponential(Number(-u)) * to_unit_peak : Number{};
  }
};

namespace detail {

/// Integrals of a pulse of peak 1 up to a time since its arrival [s], and times that [s^2].
struct PulseIntegrals {
  double zeroth = 0, first = 0;
};

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE

#endif
