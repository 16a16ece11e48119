// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>

namespace pulsecast::validation {

/// A number to a tenth of a tolerance: what is below, compilers may round differently. In full if there is no tolerance; by a power of ten
/// if there would be too many digits before or behind the point.
[[nodiscard]] inline std::string to_a_tenth(double value, double tolerance) {
  const auto exponent = [](double size) { return static_cast<int>(std::floor(std::log10(size) + 1e-9)); };
  if (tolerance == 0 || !std::isfinite(value)) return pulsecast::detail::written(value);
  const int last = exponent(tolerance) - 1;  // of the last digit
  if (std::fabs(value) < 0.5 * std::pow(10.0, last)) value = 0;
  const bool plain = last >= -16 && std::fabs(value) < 1e15;
  const int digits = plain ? -last : value == 0 ? 0 : exponent(std::fabs(value)) - last;  // behind the point
  char text[64];
  std::snprintf(text, sizeof text, plain || value == 0 ? "%.*f" : "%.*e", digits < 0 ? 0 : digits, value);
  return text;
}

/// Checks a simulated figure against its closed form, and prints both as a row of a table in docs/validation.md. The tolerance is in the
/// unit of the figures, which `what` names.
inline void row(const std::string& what, double closed_form, double simulated, double tolerance) {
  char allowed[32];
  std::snprintf(allowed, sizeof allowed, "%g", tolerance);
  std::printf("| %s | %s | %s | %s |\n", what.c_str(), to_a_tenth(closed_form, tolerance).c_str(), to_a_tenth(simulated, tolerance).c_str(),
              allowed);
  CAPTURE(what);
  CAPTURE(closed_form);
  CAPTURE(simulated);
  CHECK((simulated == closed_form || std::fabs(simulated - closed_form) <= tolerance));
}

}  // namespace pulsecast::validation
