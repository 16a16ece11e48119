// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <pulsecast/base/random.hpp>

#include "truth.hpp"

/// Errors of echoes against true ones, one score of them, and their uncertainty.
namespace tradeoff {

/// Sums over pulses, from which the errors come.
struct Sums {
  double cost = 0;                  ///< of echoes, see `add` [m]
  double echoes = 0;                ///< true ones
  double lost = 0, invented = 0;    ///< echoes
  double squares = 0, pairs = 0;    ///< of the errors of ranges [m^2]; pairs of a true and a found echo
  double brighter = 0, bright = 0;  ///< sizes of the errors of intensities, and true intensities, of pairs

  void add(const Sums& o, double times) noexcept {
    for (auto member : {&Sums::cost, &Sums::echoes, &Sums::lost, &Sums::invented, &Sums::squares, &Sums::pairs,
                        &Sums::brighter, &Sums::bright})
      this->*member += times * o.*member;
  }

  /// Adds a pulse. True and found echoes are paired in order so that the sum of the costs is least: a pair costs the
  /// size of its error, an echo that is lost or invented half the resolution of the pulse [m]. An echo farther off than
  /// the resolution thus costs as much as one lost and one invented: no setting gains by losing what it measures badly.
  /// Source: GOSPA metric with p = 1 and alpha = 2, Rahmathullah, Garcia-Fernandez & Svensson 2017.
  void add(const Points& truth, const Points& found, double resolution, std::vector<double>& sizes) {
    const std::size_t n = truth.size(), m = found.size();
    const double charge = resolution / 2;
    std::vector<double> least((n + 1) * (m + 1));
    const auto at = [&](std::size_t i, std::size_t j) -> double& { return least[i * (m + 1) + j]; };
    const auto apart = [&](std::size_t i, std::size_t j) { return std::fabs(truth[i].range - found[j].range); };
    for (std::size_t i = n + 1; i-- > 0;)
      for (std::size_t j = m + 1; j-- > 0;) {
        if (i == n && j == m) continue;
        at(i, j) = std::min(i < n ? at(i + 1, j) + charge : infinite, j < m ? at(i, j + 1) + charge : infinite);
        if (i < n && j < m) at(i, j) = std::min(at(i, j), at(i + 1, j + 1) + apart(i, j));
      }
    cost += at(0, 0);
    echoes += static_cast<double>(n);
    for (std::size_t i = 0, j = 0; i < n || j < m;) {
      if (i < n && j < m && at(i, j) == at(i + 1, j + 1) + apart(i, j)) {
        squares += apart(i, j) * apart(i, j);
        pairs += 1;
        brighter += std::fabs(truth[i].intensity - found[j].intensity);
        bright += truth[i].intensity;
        sizes.push_back(apart(i++, j++));
      } else if (i < n && at(i, j) == at(i + 1, j) + charge) {
        lost += 1;
        ++i;
      } else {
        invented += 1;
        ++j;
      }
    }
  }

  [[nodiscard]] double score() const noexcept { return cost / echoes; }                     ///< [m] an echo
  [[nodiscard]] double range() const noexcept { return std::sqrt(squares / pairs); }        ///< [m]
  [[nodiscard]] double wrong() const noexcept { return 100 * (lost + invented) / echoes; }  ///< [%]
  [[nodiscard]] double intensity() const noexcept { return 100 * brighter / bright; }       ///< [%]

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();
};

/// Sums of each cluster of pulses: those of one object, or of neighbours that hit the same.
using Clusters = std::vector<Sums>;

struct Interval {
  double middle = 0, low = 0, high = 0;
  /// True if a ratio is below 1, or above, beyond doubt.
  [[nodiscard]] bool less() const noexcept { return high < 1; }
  [[nodiscard]] bool more() const noexcept { return low > 1; }
};

[[nodiscard]] inline double percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

/// Bootstrap by clusters, drawn with replacement, as pulses of one cluster are no independent ones. Settings share the
/// draws of a scene, so that ratios are of the same pulses. Intervals hold 95 % of the draws. Source: Efron &
/// Tibshirani 1993, sec. 8.6 and 13.3.
class Bootstrap {
 public:
  static constexpr std::size_t draws = 1000;

  Bootstrap(std::size_t clusters, std::uint32_t scene) : times_(draws, std::vector<double>(clusters)) {
    for (std::size_t draw = 0; draw < draws; ++draw)
      for (std::size_t k = 0; k < clusters; ++k) {
        const auto drawn = static_cast<std::uint32_t>(k + (std::size_t{scene} << 16));
        const double u = uniform({.seed = 41, .pulse = draw, .subray = drawn, .purpose = Purpose{128}});
        times_[draw][static_cast<std::size_t>(u * static_cast<double>(clusters))] += 1;
      }
  }

  /// The figure of all clusters, and that of each draw: `figure(sums)`.
  template <class Figure>
  [[nodiscard]] std::vector<double> operator()(const Clusters& clusters, const Figure& figure) const {
    const auto of = [&](const auto& times) {
      Sums all;
      for (std::size_t k = 0; k < clusters.size(); ++k) all.add(clusters[k], times(k));
      return figure(all);
    };
    std::vector<double> found{of([](std::size_t) { return 1.0; })};
    for (const auto& times : times_) found.push_back(of([&](std::size_t k) { return times[k]; }));
    return found;
  }

 private:
  std::vector<std::vector<double>> times_;  ///< how often a draw has each cluster
};

/// Of a figure and its draws.
[[nodiscard]] inline Interval interval_of(const std::vector<double>& found) {
  const std::vector<double> drawn(found.begin() + 1, found.end());
  return {found[0], percentile(drawn, 0.025), percentile(drawn, 0.975)};
}

/// Of the median of independent repetitions, by their order. Source: Conover 1999, sec. 3.2; with the normal
/// distribution for the binomial.
[[nodiscard]] inline Interval median_of(const std::vector<double>& repeated) {
  const auto n = static_cast<double>(repeated.size());
  const double off = 0.98 / std::sqrt(n);  // 1.96 standard deviations of a share of a half
  return {percentile(repeated, 0.5), percentile(repeated, std::fmax(0.5 - off, 0)),
          percentile(repeated, std::fmin(0.5 + off, 1))};
}

}  // namespace tradeoff
