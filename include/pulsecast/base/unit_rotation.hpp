// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_UNIT_ROTATION_HPP
#define PULSECAST_BASE_UNIT_ROTATION_HPP

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>

/// Rotations in settings: in single precision or with few decimals, unit only up to rounding.
namespace PULSECAST_NAMESPACE {

/// Throws a `SettingError` unless the norm of a rotation is within 1e-3 of 1.
inline void require_rotation(std::string_view field, const Rotation& rotation) {
  const double norm = length(rotation);
  if (!(norm >= 0.999 && norm <= 1.001))
    throw_setting_error(std::string(field) + " (norm)", norm, "", "from 0.999 to 1.001");
}

/// Normalized rotation; bit-identical to its argument where the norm is within 1e-9 of 1.
[[nodiscard]] inline Rotation unit(const Rotation& rotation) noexcept {
  return std::fabs(length(rotation) - 1) <= 1e-9 ? rotation : normalize(rotation);
}

}  // namespace PULSECAST_NAMESPACE

#endif
