// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <pulsecast/base/text.hpp>

/// Kind of quantity on the command line.
struct QuantityKind {
  struct Unit {
    const char* name;
    double size;  ///< in SI
  };
  std::span<const Unit> units;
  const char* expected;  ///< description in messages
};

inline constexpr QuantityKind::Unit length_units[] = {{"um", 1e-6}, {"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}};
inline constexpr QuantityKind::Unit share_units[] = {{"%", 1e-2}, {"", 1}};
inline constexpr QuantityKind::Unit duration_units[] = {{"ms", 1e-3}, {"s", 1}, {"min", 60}, {"h", 3600}};
inline constexpr QuantityKind::Unit size_units[] = {
    {"kB", 1e3}, {"MB", 1e6}, {"GB", 1e9}, {"TB", 1e12}, {"KiB", 1024.0}, {"MiB", 1048576.0}, {"GiB", 1073741824.0}};
inline constexpr QuantityKind a_length{length_units, "a length, as in 5mm, 2cm or 0.01m"};
inline constexpr QuantityKind a_share{share_units, "a share, as in 2% or 0.02"};
inline constexpr QuantityKind a_duration{duration_units, "a duration, as in 90s, 10min or 2h"};
inline constexpr QuantityKind a_size{size_units, "a size, as in 500MB or 4GB"};

/// Parses a positive quantity to SI. The unit ignores case; a blank may precede it.
inline std::optional<double> quantity(const std::string& text, const QuantityKind& kind) {
  std::string_view unit = text;
  const auto value = pulsecast::text::take_number<double>(unit);
  if (!value || !std::isfinite(*value) || !(*value > 0)) return std::nullopt;
  unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
  for (const QuantityKind::Unit& u : kind.units)
    if (pulsecast::text::is_same_word(unit, u.name)) return *value * u.size;
  return std::nullopt;
}
