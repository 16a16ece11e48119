// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_UNITS_HPP
#define PULSECAST_BASE_UNITS_HPP

#include <numbers>

#include <pulsecast/base/namespace.hpp>

/// Literals that give SI units and radians: `100_kHz`, `0.3_mrad`, `20_deg`.
namespace PULSECAST_NAMESPACE::literals {

#define PULSECAST_UNIT(name, value)                                                       \
  consteval double operator""##name(long double v) { return static_cast<double>(value); } \
  consteval double operator""##name(unsigned long long v) { return static_cast<double>(value); }
PULSECAST_UNIT(_m, v)
PULSECAST_UNIT(_km, v * 1e3L)
PULSECAST_UNIT(_cm, v * 1e-2L)
PULSECAST_UNIT(_mm, v * 1e-3L)
PULSECAST_UNIT(_um, v * 1e-6L)
PULSECAST_UNIT(_nm, v * 1e-9L)
PULSECAST_UNIT(_s, v)
PULSECAST_UNIT(_ms, v * 1e-3L)
PULSECAST_UNIT(_us, v * 1e-6L)
PULSECAST_UNIT(_ns, v * 1e-9L)
PULSECAST_UNIT(_Hz, v)
PULSECAST_UNIT(_kHz, v * 1e3L)
PULSECAST_UNIT(_MHz, v * 1e6L)
PULSECAST_UNIT(_rad, v)
PULSECAST_UNIT(_mrad, v * 1e-3L)
PULSECAST_UNIT(_deg, (v * 3.14159265358979323846264338327950288L) / 180.0L)  // libc++'s long double pi is a double's
PULSECAST_UNIT(_W, v)
PULSECAST_UNIT(_mW, v * 1e-3L)
PULSECAST_UNIT(_nW, v * 1e-9L)
#undef PULSECAST_UNIT

}  // namespace PULSECAST_NAMESPACE::literals

namespace PULSECAST_NAMESPACE {

/// Speed of light in vacuum [m/s]. Source: SI, exact by definition of the metre (17th CGPM, 1983).
inline constexpr double speed_of_light = 299792458.0;
/// Planck constant [J s]. Source: SI, exact by definition of the kilogram (26th CGPM, 2018).
inline constexpr double planck_constant = 6.62607015e-34;
/// Standard acceleration of gravity [m/s^2]. Source: 3rd CGPM, 1901.
inline constexpr double standard_gravity = 9.80665;

/// Converts degrees, as in files and user input, to radians.
[[nodiscard]] constexpr double radians(double angle_deg) noexcept { return angle_deg * (std::numbers::pi / 180); }

/// Converts radians to degrees, as in files and user output.
[[nodiscard]] constexpr double degrees(double angle) noexcept { return angle * (180 / std::numbers::pi); }

}  // namespace PULSECAST_NAMESPACE

#endif
