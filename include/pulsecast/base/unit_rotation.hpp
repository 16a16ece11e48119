// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>

/// Rotations of settings: those that were written in single precision, or with few decimals, are unit but for rounding.
namespace pulsecast {

/// Refuses a rotation whose norm is off by more than a thousandth.
inline void require_rotation(std::string_view field, const Rotation& rotation) {
  const double norm = length(rotation);
  if (!(norm >= 0.999 && norm <= 1.001)) throw_setting_error(std::string(field) + " (norm)", norm, "", "from 0.999 to 1.001");
}

/// The unit rotation next to one that `require_rotation` lets pass; the same bits where the norm is off by no more than 1e-9.
[[nodiscard]] inline Rotation unit(const Rotation& rotation) noexcept {
  return std::fabs(length(rotation) - 1) <= 1e-9 ? rotation : normalize(rotation);
}

}  // namespace pulsecast
