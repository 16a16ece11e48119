// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <cmath>
#include <string_view>

#include <pulsecast/base/error.hpp>

/// A condition that only a bug of the caller can break; checked in debug builds, on the hot path too.
#define PULSECAST_ASSERT(condition) assert(condition)

namespace pulsecast {

/// Refuses a setting. Apart from the checks, so that these stay small wherever they stand.
[[noreturn]] inline void throw_setting_error(std::string_view field, double value, std::string_view unit, std::string_view allowed) {
  throw SettingError(std::string(field), value, std::string(unit), std::string(allowed));
}

/// Refuses a setting that is not finite or not greater than zero.
inline void require_positive(std::string_view field, double value, std::string_view unit) {
  if (!(value > 0) || !std::isfinite(value)) throw_setting_error(field, value, unit, "finite and greater than 0");
}

/// Refuses a rate [Hz] outside (0, 1e12]: a `Tick` tells the phase of what is faster by less than a ten-thousandth of a turn.
inline void require_rate(std::string_view field, double value) {
  if (!(value > 0 && value <= 1e12)) throw_setting_error(field, value, "Hz", "greater than 0 and at most 1e12");
}

/// Refuses a setting that is not finite or less than zero.
inline void require_not_negative(std::string_view field, double value, std::string_view unit) {
  if (!(value >= 0) || !std::isfinite(value)) throw_setting_error(field, value, unit, "finite and at least 0");
}

/// Refuses a setting that is not finite.
inline void require_finite(std::string_view field, double value, std::string_view unit) {
  if (!std::isfinite(value)) throw_setting_error(field, value, unit, "finite");
}

/// Refuses a setting outside the closed interval [low, high].
inline void require_within(std::string_view field, double value, double low, double high, std::string_view unit) {
  if (value >= low && value <= high) return;
  throw_setting_error(field, value, unit, "from " + detail::to_text(low) + " to " + detail::to_text(high));
}

/// Settings with rotations: `normalize()` makes them unit, after `validate()` has let their norms pass.
template <class Settings>
concept Normalizable = requires(Settings& settings) {
  { settings.normalize() }
  noexcept;
};

/// Asks a stage's settings whether they can be, if they have a say: `void validate() const` throws a `SettingError`.
template <class Settings>
[[nodiscard]] Settings validated(Settings settings) {
  if constexpr (requires { settings.validate(); }) settings.validate();
  if constexpr (Normalizable<Settings>) settings.normalize();
  return settings;
}

}  // namespace pulsecast
