// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iomanip>
#include <sstream>
#include <string>

#include <pulsecast/detail/sample_statistics.hpp>

/// Three significant digits, without an exponent, and at most so many decimals.
inline std::string digits(double x, double (*rounded)(double) = std::nearbyint, int decimals = 9) {
  if (!std::isfinite(x)) return "unknown";
  const int before = x == 0 ? 3 : static_cast<int>(std::floor(std::log10(std::fabs(x)))) + 1,
            after = std::clamp(3 - before, 0, decimals);
  const double unit = std::pow(10.0, after);
  std::ostringstream out;
  out << std::fixed << std::setprecision(after) << rounded(x * unit) / unit;
  return out.str();
}

struct Unit {
  double size;
  const char* name;
};

/// Largest unit not above the value; else the first.
inline Unit unit_of(double x, std::initializer_list<Unit> units) {
  Unit best = *units.begin();
  for (const Unit& unit : units)
    if (x >= unit.size) best = unit;
  return best;
}

inline Unit time_unit(double x) { return x < 120 ? Unit{1, "s"} : unit_of(x / 2, {{60, "min"}, {3600, "h"}}); }
inline Unit bytes_unit(double x) { return unit_of(x, {{1e3, "kB"}, {1e6, "MB"}, {1e9, "GB"}, {1e12, "TB"}}); }
inline Unit length_unit(double x) { return unit_of(x, {{1e-3, "mm"}, {1, "m"}}); }
inline constexpr Unit one{1, ""}, percent{1e-2, "%"};

/// `12.3 s (11.0 to 13.5)`; the interval is rounded outwards.
inline std::string text_of(const pulsecast::Estimate& e, const Unit& unit, int decimals = 9) {
  if (!std::isfinite(e.high)) return "unknown";
  return digits(e.value / unit.size, std::nearbyint, decimals) + (*unit.name ? " " : "") + unit.name + " (" +
         digits(e.low / unit.size, std::floor, decimals) + " to " + digits(e.high / unit.size, std::ceil, decimals) +
         ')';
}
