// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETAIL_CLUSTER_STATISTICS_HPP
#define PULSECAST_DETAIL_CLUSTER_STATISTICS_HPP

#include <pulsecast/detail/sample_statistics.hpp>

/// Limits that respect clusters: what is drawn at random is a cluster, not an echo.
namespace PULSECAST_NAMESPACE::detail {

/// Quantile of Student's t that 95 % are within, to 3 % from 2 degrees of freedom on. Source: Abramowitz & Stegun
/// 1964, 26.7.5.
[[nodiscard]] inline double student_t(double freedom) {
  const double x = 1.959964, g1 = (std::pow(x, 3) + x) / 4,
               g2 = (5 * std::pow(x, 5) + 16 * std::pow(x, 3) + 3 * x) / 96,
               g3 = (3 * std::pow(x, 7) + 19 * std::pow(x, 5) + 17 * std::pow(x, 3) - 15 * x) / 384;
  return x + (g1 + (g2 + g3 / freedom) / freedom) / freedom;
}

/// Sum of a variable over a cluster, and of the variable that it is divided by.
struct ClusterSums {
  double part = 0, whole = 0;  ///< both not negative
};

/// Ratio of two totals from a sample of clusters in their order. The variance is that of the linearised ratio, by
/// differences of neighbours. Sources: Cochran 1977, sections 5A.12, 6.4; Satterthwaite 1946 for the freedom.
struct ClusterRatio {
  double value = 0, deviation = 0;  ///< ratio and its standard deviation
  double t = 1.959964;              ///< quantile of Student's t for them
  double clusters = 0;              ///< clusters where the ratio is defined, more for a large part of the population
  ClusterRatio(std::span<const ClusterSums> sample, double sampled_share) {
    double part = 0, whole = 0;
    for (const ClusterSums& c : sample) {
      part += c.part;
      whole += c.whole;
      clusters += c.whole > 0 ? 1 : 0;
    }
    const double left = std::max(1e-12, 1 - sampled_share);  // finite population correction
    clusters /= left;
    if (whole > 0) value = part / whole;
    double squares = 0, fourths = 0, before = 0;
    for (std::size_t i = 0; i < sample.size(); ++i) {
      const double rest = sample[i].part - value * sample[i].whole, d = rest - std::exchange(before, rest);
      if (i == 0) continue;
      squares += d * d;
      fourths += d * d * d * d;
    }
    const double n = static_cast<double>(sample.size());
    if (n < 2 || !(squares > 0)) return;
    deviation = std::sqrt(left * n / (2 * (n - 1)) * squares) / whole;
    t = student_t(std::max(2.0, 4.0 / 3 / std::max(1e-12, fourths / (squares * squares) - 1 / n)));
  }

  /// Number of independent trials of a share that give this deviation; if only 0 or 1 was seen, one in each cluster.
  [[nodiscard]] double trials() const {
    return deviation > 0 ? value * (1 - value) / (deviation * deviation) : clusters;
  }

  /// Ratio as a share of the whole. Source: Wilson 1927.
  [[nodiscard]] Estimate share() const {
    if (!(clusters > 0)) return {0, 0, 1};
    const double z = t * t / trials(), middle = (value + z / 2) / (1 + z),
                 margin = std::sqrt(z * (value * (1 - value) + z / 4)) / (1 + z);
    return {value, std::max(0.0, middle - margin), std::min(1.0, middle + margin)};
  }
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
