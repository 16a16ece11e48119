// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETAIL_SAMPLE_STATISTICS_HPP
#define PULSECAST_DETAIL_SAMPLE_STATISTICS_HPP

#include <pulsecast/sample.hpp>

namespace PULSECAST_NAMESPACE {

/// Estimate with limits that contain the true value 19 times in 20.
struct Estimate {
  double value = 0, low = 0, high = 0;  ///< estimate, lower and upper limit
};

namespace detail {

/// Slots of equal cost.
struct SlotKind {
  enum Value : std::uint8_t { blocked, missed, hit };
  static constexpr std::size_t count = 3;  ///< number of kinds

  [[nodiscard]] static Value of(Fate fate) {
    return fate == Fate::blocked ? blocked : fate == Fate::missed ? missed : hit;
  }
};
using BySlotKind = std::array<double, SlotKind::count>;

/// Total over a survey of `size` slots from a sample in order. The variance is from differences of neighbours. Source:
/// Cochran 1977, sections 5.3 and 5A.12.
[[nodiscard]] inline Estimate total_of(std::span<const double> sample, std::uint64_t size) {
  if (sample.empty()) return {};
  double sum = 0, differences = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    sum += sample[i];
    if (i > 0) differences += std::pow(sample[i] - sample[i - 1], 2);
  }
  const double n = static_cast<double>(sample.size()), all = static_cast<double>(size), each = all / n,
               value = sum * each;
  const double deviation = n < 2 ? 0 : each * std::sqrt((1 - n / all) * n * differences / (2 * (n - 1)));
  // Upper limit after n trials without success: 3 in n. Source: Hanley & Lippman-Hand 1983.
  const double none = sample.size() == size ? 0 : 3 * each;
  return {value, std::max(sum, value - 2 * deviation), sum > 0 ? value + 2 * deviation : none};
}

/// Element of a list by golden-section steps: any number of first steps is spread over the whole list. Source: Weyl
/// 1916.
[[nodiscard]] inline PulseIndex spread_over(std::span<const PulseIndex> list, std::uint64_t number, double start) {
  const double at = start + static_cast<double>(number) * 0.6180339887498949;
  return list[std::min(list.size() - 1,
                       static_cast<std::size_t>((at - std::floor(at)) * static_cast<double>(list.size())))];
}

[[nodiscard]] inline double dot(const BySlotKind& a, const BySlotKind& b) {
  double sum = 0;
  for (std::size_t i = 0; i < SlotKind::count; ++i) sum += a[i] * b[i];
  return sum;
}

/// Number of slots in a block by kind.
[[nodiscard]] inline BySlotKind kinds_in(const Sample& sample) {
  BySlotKind n{};
  for (std::size_t f = 0; f < fate_count; ++f)
    n[SlotKind::of(static_cast<Fate>(f))] += static_cast<double>(sample.counts.fates[f]);
  return n;
}

/// Cost of a slot of each kind [s], calibrated to the total of all slots: weighted least squares over blocks. A cost
/// may be below zero, as costs vary within a kind and blocks mix kinds. Source: Sarndal, Swensson & Wretman 1992, Model
/// Assisted Survey Sampling, chapter 6, the regression estimator.
[[nodiscard]] inline BySlotKind cost_of_kinds(std::span<const Sample> kinds, std::span<const Sample> times,
                                              std::span<const double> weights) {
  std::array<std::array<double, SlotKind::count + 1>, SlotKind::count> m{};
  for (std::size_t b = 0; b < kinds.size(); ++b) {
    const BySlotKind n = kinds_in(kinds[b]);
    for (std::size_t i = 0; i < SlotKind::count; ++i) {
      for (std::size_t j = 0; j < SlotKind::count; ++j) m[i][j] += weights[b] * n[i] * n[j];
      m[i][SlotKind::count] += weights[b] * n[i] * times[b].seconds;
    }
  }
  double trace = 0;
  for (std::size_t i = 0; i < SlotKind::count; ++i) trace += m[i][i];
  for (std::size_t i = 0; i < SlotKind::count; ++i) m[i][i] += 1e-9 * trace;
  for (std::size_t i = 0; i < SlotKind::count; ++i)  // Gaussian elimination; the matrix is positive definite
    for (std::size_t row = 0; row < SlotKind::count; ++row) {
      if (row == i || !(m[i][i] > 0)) continue;
      const double factor = m[row][i] / m[i][i];
      for (std::size_t j = i; j <= SlotKind::count; ++j) m[row][j] -= factor * m[i][j];
    }
  BySlotKind cost{};
  for (std::size_t i = 0; i < SlotKind::count; ++i) cost[i] = m[i][i] > 0 ? m[i][SlotKind::count] / m[i][i] : 0;
  return cost;
}

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE

#endif
