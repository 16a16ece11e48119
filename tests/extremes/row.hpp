// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstdio>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>

#include "validation/table.hpp"

namespace pulsecast::extremes {

/// Checks a figure found at an extreme of an axis against the right one, and prints both as a row of the table of
/// extremes in docs/tables/extremes.md. The bound is in the unit of the figures, which `what` names.
inline void row(const std::string& axis, const std::string& what, double expected, double found, double bound) {
  validation::detail::check_and_print(axis + " | " + what, expected, found, bound);
}

/// Checks that a refusal names the setting, and prints it as a row of the same table.
inline void refused(const std::string& axis, const std::string& what, const SettingError& error) {
  std::printf("| %s | %s | refused | %s | | |\n", axis.c_str(), what.c_str(), error.what());
  CAPTURE(what);
  CHECK_FALSE(error.field().empty());
  CHECK(std::string(error.what()).starts_with(error.field() + " is "));
}

/// The same of an attempt that must be refused: `refused("power", "1e301 W", [] { return validated(Scanner{...}); })`.
template <std::invocable Attempt>
void refused(const std::string& axis, const std::string& what, const Attempt& attempt) {
  CAPTURE(what);
  try {
    static_cast<void>(attempt());
  } catch (const SettingError& error) {
    return refused(axis, what, error);
  }
  FAIL_CHECK("is not refused");
}

}  // namespace pulsecast::extremes
