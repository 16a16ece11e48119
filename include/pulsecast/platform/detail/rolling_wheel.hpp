// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_DETAIL_ROLLING_WHEEL_HPP
#define PULSECAST_PLATFORM_DETAIL_ROLLING_WHEEL_HPP

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Lowest point [m] that a wheel of a radius `r` [m] reaches as it rolls along a profile: the
/// closing of the profile with the wheel's disc, which is the ground itself wherever that bends
/// less than the wheel. `at(way)` is the height a way ahead [m], minus infinity without ground;
/// `below` is that at the wheel. Source: ISO 16610-41:2015, closing with a disk.
[[nodiscard]] std::optional<double> lowest_of_wheel(double r, const auto& at, const std::optional<double>& below) {
  constexpr double nothing = -std::numeric_limits<double>::infinity();
  if (below) {
    const std::array<double, 4> places{-0.9 * r, -0.5 * r, 0.5 * r, 0.9 * r},
        heights{at(places[0]), at(places[1]), at(places[2]), at(places[3])};
    const double slope = heights[1] > nothing && heights[2] > nothing ? (heights[2] - heights[1]) / r : 0;
    bool touched = true;  // the ground stays below a parabola of half the wheel's curvature
    for (std::size_t k = 0; k < 4; ++k)
      touched = touched && heights[k] <= *below + slope * places[k] + places[k] * places[k] / (4 * r);
    if (touched) return below;
  }
  constexpr int n = 12;  // samples of a radius
  std::array<double, 4 * n + 1> profile{};
  for (int k = -2 * n; k <= 2 * n; ++k)
    profile[static_cast<std::size_t>(k + 2 * n)] = k == 0 ? below.value_or(nothing) : at(k * r / n);
  const auto disc = [&](int k) { return r * std::sqrt(1 - static_cast<double>(k * k) / (n * n)); };
  double lowest = std::numeric_limits<double>::infinity();
  for (int axle = -n; axle <= n; ++axle) {
    double centre = nothing;
    for (int k = -n; k <= n; ++k)
      centre = std::fmax(centre, profile[static_cast<std::size_t>(axle + k + 2 * n)] + disc(k));
    lowest = std::fmin(lowest, centre - disc(axle));
  }
  return lowest > nothing ? std::optional(lowest) : below;
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
