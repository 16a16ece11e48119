// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_UNITS_HPP
#define PULSECAST_BASE_UNITS_HPP

#include <numbers>

#include <pulsecast/base/namespace.hpp>

/// Literals that give SI units and radians: `100_kHz`, `0.3_mrad`, `20_deg`.
namespace PULSECAST_NAMESPACE::literals {

// clang-format off
consteval double operator""_m(long double v)    { return static_cast<double>(v); }
consteval double operator""_km(long double v)   { return static_cast<double>(v * 1e3L); }
consteval double operator""_cm(long double v)   { return static_cast<double>(v * 1e-2L); }
consteval double operator""_mm(long double v)   { return static_cast<double>(v * 1e-3L); }
consteval double operator""_um(long double v)   { return static_cast<double>(v * 1e-6L); }
consteval double operator""_nm(long double v)   { return static_cast<double>(v * 1e-9L); }
consteval double operator""_s(long double v)    { return static_cast<double>(v); }
consteval double operator""_ms(long double v)   { return static_cast<double>(v * 1e-3L); }
consteval double operator""_us(long double v)   { return static_cast<double>(v * 1e-6L); }
consteval double operator""_ns(long double v)   { return static_cast<double>(v * 1e-9L); }
consteval double operator""_Hz(long double v)   { return static_cast<double>(v); }
consteval double operator""_kHz(long double v)  { return static_cast<double>(v * 1e3L); }
consteval double operator""_MHz(long double v)  { return static_cast<double>(v * 1e6L); }
consteval double operator""_rad(long double v)  { return static_cast<double>(v); }
consteval double operator""_mrad(long double v) { return static_cast<double>(v * 1e-3L); }
consteval double operator""_deg(long double v)  { return static_cast<double>(v * std::numbers::pi_v<long double> / 180.0L); }
consteval double operator""_W(long double v)    { return static_cast<double>(v); }
consteval double operator""_mW(long double v)   { return static_cast<double>(v * 1e-3L); }
consteval double operator""_nW(long double v)   { return static_cast<double>(v * 1e-9L); }

consteval double operator""_m(unsigned long long v)    { return static_cast<double>(v); }
consteval double operator""_km(unsigned long long v)   { return static_cast<double>(v * 1e3L); }
consteval double operator""_cm(unsigned long long v)   { return static_cast<double>(v * 1e-2L); }
consteval double operator""_mm(unsigned long long v)   { return static_cast<double>(v * 1e-3L); }
consteval double operator""_um(unsigned long long v)   { return static_cast<double>(v * 1e-6L); }
consteval double operator""_nm(unsigned long long v)   { return static_cast<double>(v * 1e-9L); }
consteval double operator""_s(unsigned long long v)    { return static_cast<double>(v); }
consteval double operator""_ms(unsigned long long v)   { return static_cast<double>(v * 1e-3L); }
consteval double operator""_us(unsigned long long v)   { return static_cast<double>(v * 1e-6L); }
consteval double operator""_ns(unsigned long long v)   { return static_cast<double>(v * 1e-9L); }
consteval double operator""_Hz(unsigned long long v)   { return static_cast<double>(v); }
consteval double operator""_kHz(unsigned long long v)  { return static_cast<double>(v * 1e3L); }
consteval double operator""_MHz(unsigned long long v)  { return static_cast<double>(v * 1e6L); }
consteval double operator""_rad(unsigned long long v)  { return static_cast<double>(v); }
consteval double operator""_mrad(unsigned long long v) { return static_cast<double>(v * 1e-3L); }
consteval double operator""_deg(unsigned long long v)  { return static_cast<double>(v * std::numbers::pi_v<long double> / 180.0L); }
consteval double operator""_W(unsigned long long v)    { return static_cast<double>(v); }
consteval double operator""_mW(unsigned long long v)   { return static_cast<double>(v * 1e-3L); }
consteval double operator""_nW(unsigned long long v)   { return static_cast<double>(v * 1e-9L); }
// clang-format on

}  // namespace PULSECAST_NAMESPACE::literals

namespace PULSECAST_NAMESPACE {

/// Speed of light in vacuum [m/s]. Source: SI, exact by definition of the metre (17th CGPM, 1983).
inline constexpr double speed_of_light = 299792458.0;
/// Planck constant [J s]. Source: SI, exact by definition of the kilogram (26th CGPM, 2018).
inline constexpr double planck_constant = 6.62607015e-34;

/// Converts degrees, as in files and user input, to radians.
[[nodiscard]] constexpr double radians(double angle_deg) noexcept { return angle_deg * (std::numbers::pi / 180.0); }

/// Converts radians to degrees, as in files and user output.
[[nodiscard]] constexpr double degrees(double angle) noexcept { return angle * (180.0 / std::numbers::pi); }

}  // namespace PULSECAST_NAMESPACE

#endif
