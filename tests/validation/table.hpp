// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>

namespace pulsecast::validation {

/// Where the expected figure of a row comes from.
enum class Kind : std::uint8_t {
  closed_form,            ///< from a formula that stands in the test and does not use the code it tests
  second_implementation,  ///< from another part of the library that does the same
  consistency,            ///< a sum that must come out, or a figure that holds by construction
  bound,                  ///< there is none but 0, an error: the tolerance is all that is promised
  peer,                   ///< from HELIOS++
  published,              ///< printed in a paper
};

[[nodiscard]] inline const char* name_of(Kind kind) {
  constexpr const char* names[]{"closed form", "second implementation", "consistency", "bound", "peer", "published"};
  return names[static_cast<std::size_t>(kind)];
}

/// A number to two digits, in scientific notation; 0 only if it is 0.
[[nodiscard]] inline std::string to_two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value == 0 ? "%g" : "%.1e", value);
  return text;
}

/// A number to a tenth of a tolerance: what is below, compilers may round differently. In full if there is no
/// tolerance; by a power of ten if there would be too many digits before or behind the point, or none but zeros.
[[nodiscard]] inline std::string to_a_tenth(double value, double tolerance) {
  const auto exponent = [](double size) { return static_cast<int>(std::floor(std::log10(size) + 1e-9)); };
  if (tolerance == 0 || !std::isfinite(value)) return text::to_text(value);
  const int last = exponent(tolerance) - 1;  // of the last digit
  if (value != 0 && std::fabs(value) < 0.5 * std::pow(10.0, last)) return to_two_digits(value);
  const bool plain = last >= -16 && std::fabs(value) < 1e15;
  const int digits = plain ? -last : value == 0 ? 0 : exponent(std::fabs(value)) - last;  // behind the point
  char text[64];
  std::snprintf(text, sizeof text, plain || value == 0 ? "%.*f" : "%.*e", digits < 0 ? 0 : digits, value);
  return text;
}

namespace detail {
/// Checks a figure against the expected one, and prints both, how far they are apart, and the tolerance as the cells of
/// a row after `head`.
inline void check_and_print(const std::string& head, double expected, double found, double tolerance) {
  char allowed[32];
  std::snprintf(allowed, sizeof allowed, "%g", tolerance);
  const double error = found == expected ? 0 : std::fabs(found - expected);
  std::printf("| %s | %s | %s | %s | %s |\n", head.c_str(), to_a_tenth(expected, tolerance).c_str(),
              to_a_tenth(found, tolerance).c_str(), to_two_digits(error).c_str(), allowed);
  CAPTURE(head);
  CAPTURE(expected);
  CAPTURE(found);
  CHECK(error <= tolerance);
}
}  // namespace detail

/// Checks a simulated figure against the expected one, and prints both as a row of docs/tables/validation.md. The
/// tolerance is in the unit of the figures, which `what` names.
inline void row(Kind kind, const std::string& what, double expected, double simulated, double tolerance) {
  detail::check_and_print(what + " | " + name_of(kind), expected, simulated, tolerance);
}

/// The same of a closed form.
inline void row(const std::string& what, double closed_form, double simulated, double tolerance) {
  row(Kind::closed_form, what, closed_form, simulated, tolerance);
}

}  // namespace pulsecast::validation
