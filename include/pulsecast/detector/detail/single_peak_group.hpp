// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_SINGLE_PEAK_GROUP_HPP
#define PULSECAST_DETECTOR_DETAIL_SINGLE_PEAK_GROUP_HPP

#include <pulsecast/detector/echo_timing.hpp>
#include <pulsecast/detector/echo_width.hpp>

namespace PULSECAST_NAMESPACE {

/// Sum of the pulse shapes of reflections within 2 tau, in any order: the last leading edge arrives
/// before the first pulse has peaked. All pulses rise until then, so the sum has a single peak.
///
/// An edge that passed an age u [tau] before the last one contributes P (u + x)^2 e^-(u + x) a time
/// x after it. Let M0, M1 and M2 be the sums of the weights P e^-u times u^0, u and u^2. The sum of
/// pulses is e^-x (M2 + 2 M1 x + M0 x^2). Its slope is zero at x = 1 + sqrt(1 - v) - m, with the
/// mean m = M1 / M0 and the variance v = M2 / M0 - m^2 of the ages. Derived from `PulseShape`.
class SinglePeakGroup {
 public:
  /// Ages and weights, one per reflection, padded to whole SIMD vectors.
  struct Workspace {
    std::vector<double> ages, weights;  ///< one per reflection: age [tau], weight [W]
    /// Allocates memory for `reflections` reflections, at most 2048: more are rarely within 2 tau.
    explicit Workspace(std::size_t reflections)
        : ages(std::min<std::size_t>(reflections, 2048) + simd::lane_count), weights(ages) {}
  };

  /// Computes ages and weights in a workspace that outlives it. `one()` is false for reflections
  /// that are none, too far apart or away, too many, or without power; then call nothing else.
  SinglePeakGroup(std::span<const Reflection> reflections, const PulseShape& shape, double sample_interval,
                  Workspace& w) noexcept
      : reflections_(reflections), ages_(w.ages.data()), weights_(w.weights.data()), per_tau_(1 / shape.tau) {
    if (reflections.empty() || reflections.size() + simd::lane_count > w.ages.size()) return;
    const std::size_t n = reflections.size();
    simd::Doubles low = simd::Doubles{} + std::numeric_limits<double>::infinity(), high{};
    simd::Mask useless{};
    std::array<const Reflection*, simd::lane_count> from;
    for (std::size_t lane = 0; lane < from.size(); ++lane) from[lane] = &reflections[lane < n ? lane : 0];
    for (std::size_t next = 0; next < n; next += simd::lane_count) {
      const std::size_t j = n < simd::lane_count ? 0 : std::min(next, n - simd::lane_count);  // the last ones overlap
      const auto of = [&](double Reflection::*member) noexcept {
        return simd::generate([&](std::size_t lane) noexcept { return from[lane][j].*member; });
      };
      const simd::Doubles range = of(&Reflection::range), power = of(&Reflection::power);
      low = simd::min(range, low);
      high = simd::max(range, high);
      useless |= ~can_count(power, range, sample_interval);
      simd::store(range, ages_[j]);
      simd::store(power, weights_[j]);
    }
    const double nearest = simd::min(low), farthest = simd::max(high);
    const double per_metre = 2 / (speed_of_light * shape.tau);
    one_ = simd::bits(useless) == 0 && (farthest - nearest) * per_metre < PulseShape::peak;
    if (!one_) return;
    last_edge_ = 2 * farthest / speed_of_light - PulseShape::peak * shape.tau;

    std::fill_n(ages_ + n, simd::lane_count, farthest);  // idle lanes
    std::fill_n(weights_ + n, simd::lane_count, 0.0);
    double all_power = 0, all_before = 0;
    for (std::size_t part = 0; part < simd::sum_stride; part += simd::lane_count) {
      simd::Doubles power{}, before{}, zeroth{}, first{}, second{};
      for (std::size_t j = part; j < n; j += simd::sum_stride) {
        const simd::Doubles distance = farthest - simd::load<simd::Doubles>(ages_[j]);
        const auto p = simd::load<simd::Doubles>(weights_[j]);
        const simd::Doubles age = distance * per_metre, weight = p * exponential(simd::Doubles(-age));
        power += p;
        before += p * distance;
        zeroth += weight;
        first += weight * age;
        second += weight * age * age;
        simd::store(age, ages_[j]);
        simd::store(weight, weights_[j]);
      }
      simd::add_lanes(all_power, power);
      simd::add_lanes(all_before, before);
      simd::add_lanes(zeroth_, zeroth);
      simd::add_lanes(first_, first);
      simd::add_lanes(second_, second);
    }
    mean_range_ = farthest - all_before / all_power;
  }

  [[nodiscard]] bool one() const noexcept { return one_; }
  /// Two-way travel time, origin of the times below [s].
  [[nodiscard]] double last_edge() const noexcept { return last_edge_; }
  /// Power-weighted mean of the reflections [m].
  [[nodiscard]] double mean_range() const noexcept { return mean_range_; }

  /// Time of the sum's peak since the last edge [tau].
  [[nodiscard]] double peak() const noexcept {
    const double mean = first_ / zeroth_, variance = second_ / zeroth_ - mean * mean;
    return 1 + (variance < 1 ? std::sqrt(1 - variance) : 0) - mean;  // rounding may bring it to 1
  }

  /// Sum at times [tau] since the last edge [W].
  [[nodiscard]] simd::Doubles power(const simd::Doubles& x) const noexcept {
    return PulseShape::to_unit_peak * exponential(simd::Doubles(-x)) * (second_ + x * (2 * first_ + x * zeroth_));
  }

  /// Integrals over the whole sum, about the last edge [tau].
  [[nodiscard]] WaveformMoments moments() const noexcept {
    double sum = 0, first = 0, second = 0;
    for (std::size_t j = 0; j < reflections_.size(); ++j) {
      const double p = reflections_[j].power, age = ages_[j];
      sum += p;
      first += p * age;
      second += p * age * age;
    }
    // the moments of u^2 e^-u from 0 on are 2, 6 and 24
    constexpr double c = PulseShape::to_unit_peak;
    return {c * 2 * sum, c * (6 * sum - 2 * first), c * (24 * sum - 12 * first + 2 * second)};
  }

  /// Reflection of the greatest share of the sum at a time since the last edge [tau].
  [[nodiscard]] const Reflection& strongest(double x) const noexcept {
    simd::Doubles most{}, number{}, best{};
    for (std::size_t lane = 0; lane < simd::lane_count; ++lane) number[lane] = static_cast<double>(lane);
    for (std::size_t j = 0; j < reflections_.size(); j += simd::lane_count) {
      const simd::Doubles u = simd::load<simd::Doubles>(ages_[j]) + x;
      const simd::Doubles power = simd::load<simd::Doubles>(weights_[j]) * u * u;
      best = power > most ? number : best;
      most = simd::max(power, most);
      number += simd::lane_count;
    }
    std::size_t first = 0;
    for (std::size_t lane = 1; lane < simd::lane_count; ++lane)
      if (most[lane] > most[first] || (most[lane] == most[first] && best[lane] < best[first])) first = lane;
    return reflections_[static_cast<std::size_t>(best[first])];
  }

  /// The only echo of the group, for a peak at a two-way time [s] and of a height [W].
  [[nodiscard]] Echo echo(double time, double height, EchoTiming timing) const noexcept {
    const Reflection& most = strongest((time - last_edge_) * per_tau_);
    return echo_from(most, timing == EchoTiming::true_range ? mean_range_ : range_at(time), height);
  }

 private:
  std::span<const Reflection> reflections_;
  double *ages_, *weights_;
  bool one_ = false;
  double per_tau_, last_edge_ = 0, mean_range_ = 0;
  double zeroth_ = 0, first_ = 0, second_ = 0;
};

}  // namespace PULSECAST_NAMESPACE

#endif
