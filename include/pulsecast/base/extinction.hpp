// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_EXTINCTION_HPP
#define PULSECAST_BASE_EXTINCTION_HPP

#include <cmath>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE {

/// Dependence of aerosol scattering on wavelength for a visibility below 6 km.
enum class AerosolModel : std::uint8_t {
  kim,    ///< little in haze, none in fog. Source: Kim, McArthur & Korevaar 2001
  kruse,  ///< as in clear air; of HELIOS++. Source: Kruse, McGlauchlin & McQuistan 1962
};

/// Extinction coefficient of aerosols [1/m] for a wavelength, from 0.4 to 1.6 um [m], and a
/// visibility [m]; 0 for an infinite visibility: 3.91/V (lambda / 0.55 um)^-q per km, V in km. As
/// published, both models jump at 50 km: by -27 % at 1,550 nm, by -14 % at 905 nm.
[[nodiscard]] inline double extinction(double wavelength, double visibility,
                                       AerosolModel model = AerosolModel::kim) noexcept {
  const double v = visibility * 1e-3;
  const double kim = v > 1 ? 0.16 * v + 0.34 : v > 0.5 ? v - 0.5 : 0;
  const double haze = model == AerosolModel::kruse ? 0.585 * std::cbrt(v) : kim;
  const double q = v > 50 ? 1.6 : v > 6 ? 1.3 : haze;
  return 3.91 / v * std::pow(wavelength / 0.55e-6, -q) * 1e-3;
}

/// True if `extinction` is within what was measured: wavelengths from 0.4 to 1.6 um, and, below a
/// visibility of 6 km, the model of Kim.
[[nodiscard]] inline bool extinction_is_valid(double wavelength, double visibility, AerosolModel model) noexcept {
  const bool measured = wavelength >= 0.4e-6 && wavelength <= 1.6e-6;
  return std::isinf(visibility) || (measured && (visibility >= 6e3 || model == AerosolModel::kim));
}

}  // namespace PULSECAST_NAMESPACE

#endif
