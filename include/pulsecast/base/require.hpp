// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_REQUIRE_HPP
#define PULSECAST_BASE_REQUIRE_HPP

#include <cassert>
#include <cmath>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/optional_member.hpp>

/// Asserts a condition that only a bug of the caller can break, in debug builds.
#define PULSECAST_ASSERT(condition) assert(condition)

namespace PULSECAST_NAMESPACE {

/// Limit of angles [rad]: one turn, and room for rounding.
inline constexpr double max_angle = 6.2831854;

/// Throws a `SettingError`. Asks about the unit for angles beyond a turn and rates below 1 Hz.
/// Separate from the checks, so that these stay small when inlined.
[[noreturn]] inline void throw_setting_error(std::string_view field, double value, std::string_view unit,
                                             std::string_view allowed) {
  const bool degrees = unit == "rad" && std::isfinite(value) && std::fabs(value) > max_angle;
  const bool period = unit == "Hz" && value > 0 && value < 1;
  throw SettingError(std::string(field), value, std::string(unit),
                     text::joined({allowed, degrees  ? ": given in degrees?"
                                            : period ? ": a period?"
                                                     : ""}));
}

/// Throws a `SettingError` unless the value is finite and greater than zero.
inline void require_positive(std::string_view field, double value, std::string_view unit) {
  if (!(value > 0) || !std::isfinite(value)) throw_setting_error(field, value, unit, "finite and greater than 0");
}

/// Throws a `SettingError` unless the rate [Hz] is in (0, 1e12]: a `Tick` has 1e-4 of a cycle.
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
[[noreturn]] inline void refuse_outside(std::string_view field, double value, double low, double high,
                                        std::string_view unit) {
  throw_setting_error(field, value, unit, text::joined({"from ", text::to_text(low), " to ", text::to_text(high)}));
}
}  // namespace detail

/// Throws a `SettingError` unless the value is in the closed interval [low, high].
inline void require_within(std::string_view field, double value, double low, double high, std::string_view unit) {
  if (!(value >= low && value <= high)) detail::refuse_outside(field, value, low, high, unit);
}

/// As above, of a count.
void require_within(std::string_view field, std::integral auto value, auto low, auto high, std::string_view unit = "") {
  require_within(field, static_cast<double>(value), static_cast<double>(low), static_cast<double>(high), unit);
}

/// Throws a `SettingError` unless the angle is within a turn: in [-2 pi, 2 pi].
inline void require_angle(std::string_view field, double value) {
  if (!(std::fabs(value) <= max_angle)) throw_setting_error(field, value, "rad", "from -2 pi to 2 pi");
}

struct Laser;

/// Settings that refuse values out of range, by a `SettingError` when their stage is made.
template <class Settings>
concept Validated = requires(const Settings& settings) {
  { settings.validate() } -> std::same_as<void>;
};

/// Detector that refuses lasers, by a `SettingError` when a survey is made.
template <class Instrument>
concept ValidatesLaser = requires(const Instrument& detector, const Laser& laser) {
  { detector.validate(laser) } -> std::same_as<void>;
};

/// Settings with rotations: `normalize()` makes them unit, after `validate()`.
template <class Settings>
concept Normalizable = requires(Settings& settings) {
  { settings.normalize() }
  noexcept->std::same_as<void>;
};

PULSECAST_OPTIONAL_MEMBER(Validated, "void validate() const", validate, (), &&!pulsecast::ValidatesLaser<T>)
PULSECAST_OPTIONAL_MEMBER(ValidatesLaser, "void validate(const Laser&) const", validate, (std::declval<const Laser&>()),
                          &&!pulsecast::Validated<T>)
PULSECAST_OPTIONAL_MEMBER(Normalizable, "void normalize() noexcept", normalize, ())

namespace detail {

/// Validates settings in place, and normalizes them. Throws a `SettingError`.
template <class Settings>
void validate_in_place(Settings& settings) {
  static_assert(detail::members_checked<Settings, tag::Validated, tag::Normalizable>);
  if constexpr (Validated<Settings>) settings.validate();
  if constexpr (Normalizable<Settings>) settings.normalize();
}

}  // namespace detail

/// Settings of a stage, validated and normalized. Throws a `SettingError`.
template <class Settings>
[[nodiscard]] Settings validated(Settings settings) {
  detail::validate_in_place(settings);
  return settings;
}

}  // namespace PULSECAST_NAMESPACE

#endif
