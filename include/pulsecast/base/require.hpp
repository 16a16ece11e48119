// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_REQUIRE_HPP
#define PULSECAST_BASE_REQUIRE_HPP

#include <cassert>
#include <cmath>
#include <string_view>

#include <pulsecast/base/error.hpp>

/// Asserts a condition that only a bug of the caller can break; checked in debug builds, on the hot path too.
#define PULSECAST_ASSERT(condition) assert(condition)

namespace pulsecast {

/// Throws a `SettingError`. Separate from the checks, so that these stay small when inlined.
[[noreturn]] inline void throw_setting_error(std::string_view field, double value, std::string_view unit, std::string_view allowed) {
  throw SettingError(std::string(field), value, std::string(unit), std::string(allowed));
}

/// Throws a `SettingError` unless the value is finite and greater than zero.
inline void require_positive(std::string_view field, double value, std::string_view unit) {
  if (!(value > 0) || !std::isfinite(value)) throw_setting_error(field, value, unit, "finite and greater than 0");
}

/// Throws a `SettingError` unless the rate [Hz] is in (0, 1e12]: a `Tick` resolves the phase of 1e12 Hz to some 1e-4 of a cycle.
inline void require_rate(std::string_view field, double value) {
  if (!(value > 0 && value <= 1e12)) throw_setting_error(field, value, "Hz", "greater than 0 and at most 1e12");
}

/// Throws a `SettingError` unless the value is finite and at least zero.
inline void require_not_negative(std::string_view field, double value, std::string_view unit) {
  if (!(value >= 0) || !std::isfinite(value)) throw_setting_error(field, value, unit, "finite and at least 0");
}

/// Throws a `SettingError` unless the value is finite.
inline void require_finite(std::string_view field, double value, std::string_view unit) {
  if (!std::isfinite(value)) throw_setting_error(field, value, unit, "finite");
}

namespace detail {
[[noreturn]] inline void refuse_outside(std::string_view field, double value, double low, double high, std::string_view unit) {
  throw_setting_error(field, value, unit, std::string("from ").append(to_text(low)).append(" to ").append(to_text(high)));
}
}  // namespace detail

/// Throws a `SettingError` unless the value is in the closed interval [low, high].
inline void require_within(std::string_view field, double value, double low, double high, std::string_view unit) {
  if (!(value >= low && value <= high)) detail::refuse_outside(field, value, low, high, unit);
}

/// Settings with rotations: `normalize()` makes them unit after `validate()` has accepted their norms.
template <class Settings>
concept Normalizable = requires(Settings& settings) {
  { settings.normalize() }
  noexcept;
};

/// Settings of a stage, validated by their `void validate() const` if they have one, and normalized. Throws a `SettingError`.
template <class Settings>
[[nodiscard]] Settings validated(Settings settings) {
  if constexpr (requires { settings.validate(); }) settings.validate();
  if constexpr (Normalizable<Settings>) settings.normalize();
  return settings;
}

}  // namespace pulsecast

#endif
