// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_FILTERED_NOISE_HPP
#define PULSECAST_DETECTOR_DETAIL_FILTERED_NOISE_HPP

#include <numbers>

#include <pulsecast/base/random.hpp>

namespace PULSECAST_NAMESPACE {

/// Gaussian low-pass of a receiver: unit area, no delay.
struct LowPass {
  double deviation = 0;  ///< standard deviation of the impulse response [s]

  /// Low-pass that falls by 3 dB at a frequency [Hz]: |H(f)|^2 = exp(-(2 pi f deviation)^2).
  [[nodiscard]] static LowPass of_bandwidth(double bandwidth) noexcept {
    return {std::sqrt(std::numbers::ln2) / (2 * std::numbers::pi * bandwidth)};
  }

  /// Bandwidth of a rectangular filter that passes as much white noise, the integral of |H|^2 [Hz].
  [[nodiscard]] double noise_bandwidth() const noexcept { return std::numbers::inv_sqrtpi / (4 * deviation); }
};

/// White Gaussian noise after a `LowPass`, scaled to a deviation of 1: a function of time, whatever
/// the sampling. Impulses of heights drawn by the key and their number follow each other at 3/4 of
/// the filter's deviation, even to 1e-7. Its autocorrelation is exp(-(t / 2 deviation)^2).
class FilteredNoise {
 public:
  /// Noise of a pulse; the key's subray and part number the impulses.
  FilteredNoise(const LowPass& filter, const RandomKey& key) noexcept
      : key_(key), spacing_(0.75 * filter.deviation), scale_(std::sqrt(0.75 * std::numbers::inv_sqrtpi)) {}

  /// Value at a time [s], at least that of the call before.
  [[nodiscard]] double operator()(double time) noexcept {
    const double place = time / spacing_, middle = std::floor(place), beyond = place - middle;
    const auto first = static_cast<std::int64_t>(middle) - (reach - 1);
    for (next_ = next_ < first ? first : next_; next_ < first + 2 * reach; ++next_)
      impulses_[index(next_)] = impulse(next_);
    // weights exp(-(j - from)^2 step^2 / 2): each a factor by the last, which falls by a constant
    constexpr double square = 0.75 * 0.75, decay = 0.569782824730923;  // exp(-square)
    const double from = beyond + (reach - 1);
    double weight = exponential(-0.5 * square * from * from), factor = exponential(square * (from - 0.5)), sum = 0;
    for (std::int64_t j = 0; j < 2 * reach; ++j, weight *= factor, factor *= decay)
      sum += impulses_[index(first + j)] * weight;
    return scale_ * sum;
  }

 private:
  static constexpr std::int64_t reach = 7;  ///< impulses on either side: up to 5 deviations

  static std::size_t index(std::int64_t number) noexcept { return static_cast<std::size_t>(number & 15); }

  double impulse(std::int64_t number) noexcept {
    const auto bits = static_cast<std::uint64_t>(number);
    key_.subray = static_cast<std::uint32_t>(bits);
    key_.part = static_cast<std::uint32_t>(bits >> 32);
    return normal(key_);
  }

  RandomKey key_;
  double spacing_, scale_;
  std::int64_t next_ = INT64_MIN;
  std::array<double, 16> impulses_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
