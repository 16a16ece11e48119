// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <pulsecast/pulsecast.hpp>

/// Uncertainty of the errors that are drawn, which a sample of pulses leaves.
namespace tradeoff {

using namespace pulsecast;

/// Root mean square of the range [m], echoes missed and invented [%], mean size of the intensity's error [%].
using DrawnErrors = std::array<double, 3>;

/// Sums over pulses, from which the errors come.
struct Sums {
  double range_squares = 0, matched = 0;  ///< over pairs of echoes [m^2]
  double wrong = 0, echoes = 0;           ///< echoes missed and invented, and those of the reference
  double intensity_sizes = 0,
         intensities = 0;  ///< over pairs of echoes: size of the difference, and reflectance of the reference

  void add(const Sums& other, double times) noexcept {
    range_squares += times * other.range_squares;
    matched += times * other.matched;
    wrong += times * other.wrong;
    echoes += times * other.echoes;
    intensity_sizes += times * other.intensity_sizes;
    intensities += times * other.intensities;
  }
  [[nodiscard]] DrawnErrors errors() const noexcept {
    return {std::sqrt(range_squares / matched), 100 * wrong / echoes, 100 * intensity_sizes / intensities};
  }
};

/// Sums of each block of pulses that follow each other.
using Blocks = std::vector<Sums>;

struct Interval {
  double low = std::numeric_limits<double>::quiet_NaN(), high = low;
};
using Intervals = std::array<Interval, 3>;

/// Bootstrap by blocks: successive pulses hit the same objects, so blocks of them are drawn with replacement, not
/// pulses. All settings get the same draws, so that two of them are compared pulse by pulse. Intervals hold 95 % of the
/// draws. Source: Efron & Tibshirani 1993, sec. 8.6 and 13.3; Kuensch 1989 for blocks.
class Bootstrap {
 public:
  explicit Bootstrap(std::size_t blocks) : times_(draws, std::vector<double>(blocks)) {
    for (std::size_t draw = 0; draw < draws; ++draw)
      for (std::size_t k = 0; k < blocks; ++k) {
        const double u =
            uniform({.seed = 41, .pulse = draw, .subray = static_cast<std::uint32_t>(k), .purpose = Purpose{128}});
        times_[draw][static_cast<std::size_t>(u * static_cast<double>(blocks))] += 1;
      }
  }

  [[nodiscard]] Intervals of(const Blocks& blocks) const {
    return intervals([&](const auto& times) { return sum(blocks, times).errors(); });
  }

  /// Of the errors of a setting by those of another one: 1 in draws in which neither has any, infinite where the other
  /// has none.
  [[nodiscard]] Intervals of_ratio(const Blocks& blocks, const Blocks& other) const {
    return intervals([&](const auto& times) {
      DrawnErrors ratio = sum(blocks, times).errors();
      const DrawnErrors by = sum(other, times).errors();
      for (std::size_t k = 0; k < 3; ++k) ratio[k] = ratio[k] == by[k] ? 1 : ratio[k] / by[k];
      return ratio;
    });
  }

 private:
  static constexpr std::size_t draws = 1000;

  [[nodiscard]] static Sums sum(const Blocks& blocks, const std::vector<double>& times) noexcept {
    Sums all;
    for (std::size_t k = 0; k < blocks.size(); ++k) all.add(blocks[k], times[k]);
    return all;
  }

  template <class ErrorsOf>
  [[nodiscard]] Intervals intervals(const ErrorsOf& errors_of) const {
    std::array<std::vector<double>, 3> found;
    for (const std::vector<double>& times : times_) {
      const DrawnErrors errors = errors_of(times);
      for (std::size_t k = 0; k < 3; ++k) found[k].push_back(errors[k]);
    }
    Intervals result;
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::any_of(found[k].begin(), found[k].end(), [](double x) { return std::isnan(x); }))
        continue;  // nothing to compare
      std::sort(found[k].begin(), found[k].end());
      result[k] = {found[k][draws / 40], found[k][draws - 1 - draws / 40]};
    }
    return result;
  }

  std::vector<std::vector<double>> times_;  ///< how often a draw has each block
};

}  // namespace tradeoff
