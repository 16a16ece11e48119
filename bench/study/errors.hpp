// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>

#include "bootstrap.hpp"
#include "pulses.hpp"

namespace tradeoff {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The echoes of a scenario's pulses.
struct Results {
  std::vector<std::size_t> first{0};  ///< echo of each pulse, and of the one that would follow the last
  std::vector<Echo> echoes{};
  std::vector<double> gaps{};  ///< the share of each pulse's energy that hits no plant

  [[nodiscard]] std::size_t pulses() const noexcept { return first.size() - 1; }
  [[nodiscard]] std::span<const Echo> of(std::size_t pulse) const noexcept {
    return std::span(echoes).subspan(first[pulse], first[pulse + 1] - first[pulse]);
  }
};

/// True for a class of plants: low, medium and high vegetation by ASPRS LAS 1.4 R15, table 17, and 64, here of wood.
[[nodiscard]] inline bool is_plant(std::uint16_t classification) noexcept {
  return (classification >= 3 && classification <= 5) || classification == 64;
}

/// Results of a survey that records the subrays of this footprint.
template <class AnySurvey>
[[nodiscard]] Results results_of(const AnySurvey& survey, const Pattern& footprint) {
  Results all;
  auto workspace = survey.workspace();
  for (PulseIndex i = 0; i < survey.size(); ++i) {
    const Outcome outcome = survey(i, workspace);
    all.echoes.insert(all.echoes.end(), outcome.echoes.begin(), outcome.echoes.end());
    all.first.push_back(all.echoes.size());
    double gap = 1;
    for (std::size_t j = 0; j < outcome.subrays.size(); ++j)
      if (outcome.subrays[j].met() && is_plant(outcome.subrays[j].classification)) gap -= footprint.share(j);
    all.gaps.push_back(gap);
  }
  return all;
}

/// Deviations of the echoes of a setting from those of the reference. NaN where there is nothing to compare.
struct Errors {
  double echoes = unknown;                               ///< their number, less that of the reference [%]
  double missed = unknown, invented = unknown;           ///< echoes, of those of the reference [%]
  double range_bias = unknown, range_spread = unknown;   ///< mean and standard deviation [m]
  double range_rms = unknown, range_95 = unknown;        ///< root of the mean square, 95th percentile of the size [m]
  double intensity_bias = unknown, intensity = unknown;  ///< mean, and mean size, of the mean of the reference [%]
  double width_bias = unknown, width = unknown;          ///< mean, and root of the mean square [s]
  double gap_fraction = unknown;                         ///< difference [%]
  double height_50 = unknown, height_95 = unknown,
         height_99 = unknown;  ///< percentiles of what stands on the ground, difference [m]
  Blocks blocks{};             ///< what each run of pulses adds to the errors that are drawn

  [[nodiscard]] DrawnErrors drawn() const noexcept { return {range_rms, missed + invented, intensity}; }
};

/// Echoes of one pulse that are taken for the same: those nearest to each other first, each once, none farther apart
/// than the gate [m].
inline void match(std::span<const Echo> reference, std::span<const Echo> echoes, double gate,
                  std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
  struct Pair {
    double apart;
    std::size_t r, e;
  };
  pairs.clear();
  std::vector<Pair> near;
  for (std::size_t r = 0; r < reference.size(); ++r)
    for (std::size_t e = 0; e < echoes.size(); ++e)
      if (const double apart = std::fabs(reference[r].range - echoes[e].range); apart <= gate)
        near.push_back({apart, r, e});
  std::stable_sort(near.begin(), near.end(), [](const Pair& a, const Pair& b) { return a.apart < b.apart; });
  for (const Pair& pair : near) {
    const auto taken = [&](const auto& other) { return other.first == pair.r || other.second == pair.e; };
    if (std::none_of(pairs.begin(), pairs.end(), taken)) pairs.emplace_back(pair.r, pair.e);
  }
}

[[nodiscard]] inline double percentile(std::vector<double> values, double share) {
  if (values.empty()) return unknown;
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place), values.end());
  return values[place];
}

/// Mean, and what is added up for it.
struct Mean {
  double sum = 0, squares = 0, sizes = 0;
  std::size_t count = 0;

  void add(double x) noexcept {
    sum += x;
    squares += x * x;
    sizes += std::fabs(x);
    ++count;
  }
  [[nodiscard]] double mean() const noexcept { return count == 0 ? unknown : sum / static_cast<double>(count); }
  [[nodiscard]] double rms() const noexcept {
    return count == 0 ? unknown : std::sqrt(squares / static_cast<double>(count));
  }
  [[nodiscard]] double size() const noexcept { return count == 0 ? unknown : sizes / static_cast<double>(count); }
  [[nodiscard]] double deviation() const noexcept { return std::sqrt(std::fmax(rms() * rms() - mean() * mean(), 0)); }
};

/// Quantities of forestry: the share of the sky or of the ground that plants hide, and their height.
struct Canopy {
  double gap_fraction = unknown;  ///< energy that hits no plant, of the energy sent [%]
  std::vector<double> heights{};  ///< of echoes of plants above the ground [m]
};

/// `height` gives the ground's height of a place, `stride` leaves out pulses.
[[nodiscard]] inline Canopy canopy(const Results& results, const Pulses& pulses,
                                   const std::function<double(const Vec2&)>& height, std::size_t stride = 1) {
  Canopy found;
  double gaps = 0;
  std::size_t asked = 0;
  for (std::size_t i = 0; i < results.pulses(); i += stride) {
    ++asked;
    gaps += results.gaps[i];
    const auto pulse = *pulses.pulse(i);
    for (const Echo& echo : results.of(i)) {
      if (!is_plant(echo.classification)) continue;
      const Vec3 at = pulse.origin() + echo.range * pulse.direction();
      found.heights.push_back(at.z - height({at.x, at.y}));
    }
  }
  found.gap_fraction = 100 * gaps / static_cast<double>(asked);
  return found;
}

inline void compare(const Canopy& reference, const Canopy& found, Errors& errors) {
  errors.gap_fraction = found.gap_fraction - reference.gap_fraction;
  const auto difference = [&](double share) {
    return percentile(found.heights, share) - percentile(reference.heights, share);
  };
  errors.height_50 = difference(0.5);
  errors.height_95 = difference(0.95);
  errors.height_99 = difference(0.99);
}

/// Error of a preview: n times the number of echoes of every n-th pulse, less the true number [%].
[[nodiscard]] inline double forecast_error(const Results& found, std::size_t stride) {
  std::size_t echoes = 0;
  for (std::size_t i = 0; i < found.pulses(); i += stride) echoes += found.of(i).size();
  return 100 * (static_cast<double>(echoes * stride) / static_cast<double>(found.echoes.size()) - 1);
}

/// Matches echo by echo; `gate` is how far apart the same echo may be in the two [m].
[[nodiscard]] inline Errors compare(const Results& reference, const Results& found, double gate) {
  Errors errors;
  if (reference.echoes.empty()) return errors;
  errors.blocks.resize((reference.pulses() + run_length - 1) / run_length);
  Mean range, intensity, width, level;
  std::vector<double> sizes;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < reference.pulses(); ++i) {
    match(reference.of(i), found.of(i), gate, pairs);
    Sums& block = errors.blocks[i / run_length];
    block.echoes += static_cast<double>(reference.of(i).size());
    block.wrong += static_cast<double>(reference.of(i).size() + found.of(i).size() - 2 * pairs.size());
    for (const auto& [r, e] : pairs) {
      const Echo &true_one = reference.of(i)[r], &echo = found.of(i)[e];
      block.range_squares += (echo.range - true_one.range) * (echo.range - true_one.range);
      block.matched += 1;
      block.intensity_sizes += std::fabs(echo.reflectance - true_one.reflectance);
      block.intensities += true_one.reflectance;
      range.add(echo.range - true_one.range);
      sizes.push_back(std::fabs(echo.range - true_one.range));
      intensity.add(echo.reflectance - true_one.reflectance);
      level.add(true_one.reflectance);
      if (std::isfinite(echo.width - true_one.width)) width.add(echo.width - true_one.width);
    }
  }
  const auto all = static_cast<double>(reference.echoes.size()), matched = static_cast<double>(range.count);
  errors.echoes = 100 * (static_cast<double>(found.echoes.size()) / all - 1);
  errors.missed = 100 * (all - matched) / all;
  errors.invented = 100 * (static_cast<double>(found.echoes.size()) - matched) / all;
  errors.range_bias = range.mean();
  errors.range_spread = range.deviation();
  errors.range_rms = range.rms();
  errors.range_95 = percentile(sizes, 0.95);
  errors.intensity_bias = 100 * intensity.mean() / level.mean();
  errors.intensity = 100 * intensity.size() / level.mean();
  errors.width_bias = width.mean();
  errors.width = width.rms();
  return errors;
}

}  // namespace tradeoff
