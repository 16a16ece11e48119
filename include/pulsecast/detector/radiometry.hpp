// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include <pulsecast/base/exponential.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/search.hpp>
#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/base/simd.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/pulse.hpp>

namespace pulsecast {

/// Extinction of the air [1/m] for a wavelength [m] and a visibility [m]; none if the visibility is infinite.
/// Source: Kruse, McGlauchlin & McQuistan 1962: 3.91/V (lambda / 0.55 um)^-q per km, V in km.
[[nodiscard]] inline double extinction(double wavelength, double visibility) noexcept {
  const double v = visibility * 1e-3;
  const double q = v > 50 ? 1.6 : v > 6 ? 1.3 : 0.585 * std::cbrt(v);
  return 3.91 / v * std::pow(wavelength / 0.55e-6, -q) * 1e-3;
}

/// One row of a table of how an instrument errs.
struct DeviationAtRange {
  double range = 0;      ///< [m]
  double deviation = 0;  ///< standard deviation of the noise there [m]
};

/// How an instrument errs about ranges: not at all, unless told otherwise.
struct RangeErrors {
  double bias = 0;                    ///< reported less true [m]
  double deviation = 0;               ///< standard deviation of the noise, at any range [m]
  double deviation_per_metre = 0;     ///< by which it grows with range
  bool grows_with_incidence = false;  ///< divided by the cosine of the incidence. Source: Soudarissanane et al. 2011
  /// If it has rows, in place of the two deviations above: a straight line from row to row, and level beyond them. Ranges ascend.
  SharedArray<DeviationAtRange> deviations{};

  void validate() const {
    require_finite("RangeErrors::bias", bias, "m");
    require_not_negative("RangeErrors::deviation", deviation, "m");
    require_not_negative("RangeErrors::deviation_per_metre", deviation_per_metre, "");
    for (std::size_t i = 0; i < deviations.size(); ++i) {
      require_finite("RangeErrors::deviations (range)", deviations[i].range, "m");
      require_not_negative("RangeErrors::deviations (deviation)", deviations[i].deviation, "m");
      if (i > 0) require_positive("RangeErrors::deviations (from range to range)", deviations[i].range - deviations[i - 1].range, "m");
    }
  }

  [[nodiscard]] bool none() const noexcept { return bias == 0 && deviation == 0 && deviation_per_metre == 0 && deviations.size() == 0; }

  /// Standard deviation of the noise at a range, faced squarely [m].
  [[nodiscard]] double deviation_at(double range) const noexcept {
    if (deviations.size() == 0) return deviation + deviation_per_metre * range;
    const std::size_t i = detail::first_not(deviations.size(), [&](std::size_t n) noexcept { return !(range < deviations[n].range); });
    if (i == 0) return deviations[0].deviation;
    const DeviationAtRange& from = deviations[i - 1];
    if (i == deviations.size()) return from.deviation;
    const DeviationAtRange& to = deviations[i];
    return from.deviation + (to.deviation - from.deviation) * (range - from.range) / (to.range - from.range);
  }

  /// Reported less true range [m] of an echo at a range [m], for a draw from the standard normal distribution.
  [[nodiscard]] double at(double range, double cos_incidence, double draw) const noexcept {
    constexpr double min_cosine = 0.01;  // an edge-on surface has no noise without bound
    const double slant = grows_with_incidence ? (cos_incidence > min_cosine ? cos_incidence : min_cosine) : 1;
    return bias + draw * deviation_at(range) / slant;
  }
};

/// The receiving half of an instrument, and the air before it.
struct Receiver {
  double diameter = 0.15;                                      ///< of the aperture, from 0.1 mm to 1 km [m]
  double efficiency = 0.99;                                    ///< of the optics, both ways
  double visibility = 23e3;                                    ///< meteorological; infinite for no atmosphere [m]
  double range_min = 0;                                        ///< nearer than this, nothing is received [m]
  double range_max = std::numeric_limits<double>::infinity();  ///< farther than this, nothing is received [m]
  RangeErrors range_errors{};

  void validate() const {
    require_within("Receiver::diameter", diameter, 1e-4, 1e3, "m");  // its square is a factor of every received power
    require_within("Receiver::efficiency", efficiency, 0, 1, "");
    require_within("Receiver::visibility", visibility, 1, std::numeric_limits<double>::infinity(), "m");
    require_not_negative("Receiver::range_min", range_min, "m");
    range_errors.validate();
    require_within("Receiver::range_max", range_max, range_min, std::numeric_limits<double>::infinity(), "m");
  }

  [[nodiscard]] bool in_gate(double range) const noexcept { return range >= range_min && range <= range_max; }
};

/// From the power of a pulse to the power that a subray brings back.
/// Source: laser radar equation for an extended target, Jelalian 1992; in the form of Winiwarter et al. 2022. Near by, an aperture on the
/// axis holds sin^2 of half the angle that it subtends, of what a Lambertian surface scatters: D^2 / (4 R^2 + D^2) in place of D^2 / (4
/// R^2).
class LinkBudget {
 public:
  LinkBudget(const Receiver& receiver, const Laser& laser) noexcept
      : gain_(laser.peak_power * receiver.diameter * receiver.diameter * receiver.efficiency / 4),
        near_(receiver.diameter * receiver.diameter / 4),
        both_ways_(-2 * extinction(laser.wavelength, receiver.visibility)) {}

  /// Received power [W] of a subray with this share of the pulse's energy, from a surface of this backscatter (as in `Hit`) at a range [m].
  /// At a range of 0, all that comes back.
  [[nodiscard]] double power(double share, double backscatter, double range) const noexcept { return of(share, backscatter, range); }

  /// The same of several subrays.
  [[nodiscard]] simd::Doubles power(const simd::Doubles& share, const simd::Doubles& backscatter,
                                    const simd::Doubles& range) const noexcept {
    return of(share, backscatter, range);
  }

 private:
  template <class Number>
  [[nodiscard]] Number of(const Number& share, const Number& backscatter, const Number& range) const noexcept {
    return gain_ * share * backscatter / (range * range + near_) * exponential(Number(both_ways_ * range));
  }

  double gain_;       ///< received power at 1 m by the inverse square of the range, of a white surface in vacuum [W m^2]
  double near_;       ///< square of half the aperture's diameter [m^2]
  double both_ways_;  ///< by which the logarithm of the power grows with the range [1/m]
};

}  // namespace pulsecast
