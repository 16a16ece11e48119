// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include <doctest/doctest.h>

namespace pulsecast::validation {

/// A number to a tenth of a tolerance: what is below, compilers may round differently.
[[nodiscard]] inline std::string to_a_tenth(double value, double tolerance) {
  const int digits = static_cast<int>(std::fmax(0, 1 - std::floor(std::log10(tolerance) + 1e-9)));
  const double step = std::pow(10.0, -digits);
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, std::fabs(value) < step / 2 ? 0.0 : value);
  return text;
}

/// Checks a simulated figure against its closed form, and prints both as a row of the table in docs/validation.md. The tolerance is in the
/// unit of the figures, which `what` names.
inline void row(const std::string& what, double closed_form, double simulated, double tolerance) {
  char allowed[32];
  std::snprintf(allowed, sizeof allowed, "%g", tolerance);
  std::printf("| %s | %s | %s | %s |\n", what.c_str(), to_a_tenth(closed_form, tolerance).c_str(), to_a_tenth(simulated, tolerance).c_str(),
              allowed);
  CAPTURE(what);
  CAPTURE(closed_form);
  CAPTURE(simulated);
  CHECK(std::fabs(simulated - closed_form) <= tolerance);
}

}  // namespace pulsecast::validation
