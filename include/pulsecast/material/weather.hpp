// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_WEATHER_HPP
#define PULSECAST_MATERIAL_WEATHER_HPP

#include <algorithm>

#include <pulsecast/base/extinction.hpp>
#include <pulsecast/material/medium.hpp>
#include <pulsecast/material/pure_water.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Air with particles: extinction [1/m], share scattered, and its ratio to the backscatter [sr].
[[nodiscard]] inline Medium hazy_air(double extinction, double albedo, double lidar_ratio) noexcept {
  return {.group_index = 1,
          .absorption = (1 - albedo) * extinction,
          .scattering = albedo * extinction,
          .backscatter = extinction / lidar_ratio};
}

/// Integral of x^(order-1) exp(-x) from 0 to y, order 1 to 3: a series for small y, or closed.
template <int order>
[[nodiscard]] double lower_gamma(double y) noexcept {
  if constexpr (order == 1) return -std::expm1(-y);
  if (y > 1) return order == 2 ? 1 - std::exp(-y) * (1 + y) : 2 - std::exp(-y) * (2 + y * (2 + y));
  double term = std::pow(y, order) * std::exp(-y) / order;
  double sum = 0;
  for (int k = order + 1; term > sum * 1e-17; ++k) {
    sum += term;
    term *= y / k;
  }
  return sum;
}

/// Integral of D^2 exp(-slope D) from `least` to `most` [m^3]; `slope` is positive [1/m].
[[nodiscard]] inline double second_moment(double slope, double least, double most) noexcept {
  const double y = slope * (most - least);
  const double first = least * least * lower_gamma<1>(y), second = 2 * least / slope * lower_gamma<2>(y);
  const double shifted = first + second + lower_gamma<3>(y) / (slope * slope);
  return std::exp(-slope * least) / slope * shifted;
}

}  // namespace detail

/// Fog of a visibility, from 1 m to 1 km [m], for a wavelength from 0.4 to 1.6 um [m]. Extinction:
/// `extinction` by Kim 2001, even below 500 m. Lidar ratio: 18.8 sr (O'Connor, Illingworth & Hogan
/// 2004, stratocumulus at 0.905 um); by Mie's series droplets of radii of 2 to 20 um have 18 to 21
/// sr from 0.53 to 1.55 um. All is scattered: they absorb below 1 %. @throws SettingError
[[nodiscard]] inline Medium fog(double visibility, double wavelength) {
  require_within("fog (visibility)", visibility, 1, 1e3, "m");
  require_within("fog (wavelength)", wavelength, 0.4e-6, 1.6e-6, "m");
  return detail::hazy_air(extinction(wavelength, visibility), 1, 18.8);
}

/// Haze of a visibility, from 1 to 100 km [m], for a wavelength from 0.4 to 1.6 um [m]. Extinction:
/// `extinction` by Kim 2001. Lidar ratio: 50 sr, of polluted continental air at 0.532 um (Li et al.
/// 2022; 70 sr in CALIPSO's version 4); unverified elsewhere. Scattered: 0.94 (Narasimhan &
/// Satheesh 2013, mean over India). @throws SettingError out of range
[[nodiscard]] inline Medium haze(double visibility, double wavelength) {
  require_within("haze (visibility)", visibility, 1e3, 1e5, "m");
  require_within("haze (wavelength)", wavelength, 0.4e-6, 1.6e-6, "m");
  return detail::hazy_air(extinction(wavelength, visibility), 0.94, 50);
}

/// Mineral dust of a visibility, from 1 m to 100 km [m], for a wavelength from 0.4 to 1.6 um [m].
/// Extinction: at every wavelength that at 0.55 um, as pure dust falls with less than its power 0.4
/// (Shin et al. 2018). Lidar ratio: 50 sr to 0.532 um, 69 sr from 1.064 um, linear between (Haarig
/// et al. 2022, Saharan dust); from 35 sr for other deserts (Shin et al. 2018). Absorption is left
/// out: all is scattered. @throws SettingError out of range
[[nodiscard]] inline Medium dust(double visibility, double wavelength) {
  require_within("dust (visibility)", visibility, 1, 1e5, "m");
  require_within("dust (wavelength)", wavelength, 0.4e-6, 1.6e-6, "m");
  const double share = std::clamp((wavelength - 0.532e-6) / (1.064e-6 - 0.532e-6), 0.0, 1.0);
  return detail::hazy_air(extinction(0.55e-6, visibility), 1, 50 + share * (69 - 50));
}

/// Smoke of fires of a visibility, from 1 m to 100 km [m], for a wavelength from 0.4 to 1.6 um [m].
/// Extinction: `extinction` by Kim 2001, of haze and fog. Lidar ratio: 70 sr at 0.532 um (Li et al.
/// 2022, 65 to 75 sr over the Atlantic); unverified elsewhere. Scattered: 0.92 at 0.55 um, 0.88 for
/// grass to 0.97 for boreal forest (Sayer et al. 2014). @throws SettingError
[[nodiscard]] inline Medium smoke(double visibility, double wavelength) {
  require_within("smoke (visibility)", visibility, 1, 1e5, "m");
  require_within("smoke (wavelength)", wavelength, 0.4e-6, 1.6e-6, "m");
  return detail::hazy_air(extinction(wavelength, visibility), 0.92, 70);
}

/// Falling particles, in number per volume and diameter D: N(D) = density exp(-slope D) between two
/// diameters. Much larger than the wavelength: each takes twice its shadow pi/4 D^2 out of the
/// beam, half of it by diffraction into a cone of about wavelength / D, which wide receivers do not
/// take for lost (van de Hulst 1957). All that is lost counts as scattered.
struct Precipitation {
  double density = 0;            ///< N(0), extrapolated: per volume and diameter [1/m^4]
  double slope = 1;              ///< decline with the diameter, from 1e-3 to 1e9 [1/m]
  double diameter_min = 0.1e-3;  ///< minimum diameter [m]
  double diameter_max = 6e-3;    ///< maximum diameter [m]
  double lidar_ratio = 20;       ///< extinction by backscatter without absorption, at least 1 [sr]
  double absorption = 0;         ///< light from inside a particle declines by exp(-absorption D) [1/m]
  double reflectance = 0;        ///< of a particle's front at normal incidence, at most 8 pi / lidar_ratio

  void validate() const {
    require_not_negative("Precipitation::density", density, "1/m^4");
    require_within("Precipitation::slope", slope, 1e-3, 1e9, "1/m");
    require_not_negative("Precipitation::diameter_min", diameter_min, "m");
    require_positive("Precipitation::diameter_max (above diameter_min)", diameter_max - diameter_min, "m");
    require_within("Precipitation::lidar_ratio", lidar_ratio, 1, std::numeric_limits<double>::max(), "sr");
    require_not_negative("Precipitation::absorption", absorption, "1/m");
    const double most = std::min(1.0, 8 * std::numbers::pi / lidar_ratio);
    require_within("Precipitation::reflectance", reflectance, 0, most, "");
  }

  /// Particles per volume [1/m^3].
  [[nodiscard]] double number() const noexcept { return density / slope * std::exp(-slope * diameter_min) * within(); }
  /// Diameter of a particle [m] for a uniform number in [0, 1], by the inverse of the distribution.
  [[nodiscard]] double diameter(double uniform) const noexcept {
    return std::clamp(diameter_min - std::log1p(-uniform * within()) / slope, diameter_min, diameter_max);
  }

  /// Differential cross section of a particle of a diameter [m] straight back [m^2/sr]: of its
  /// front, as of a mirror sphere; of its inside, the rest to `lidar_ratio`, with absorption.
  [[nodiscard]] double backscatter_cross_section(double diameter) const noexcept {
    const double shadow = std::numbers::pi / 4 * diameter * diameter;
    return shadow * (front() + inside() * std::exp(-absorption * diameter));
  }

  /// Extinction coefficient [1/m].
  [[nodiscard]] double extinction() const noexcept { return std::numbers::pi / 2 * density * squares(slope); }
  /// Backscatter coefficient [1/(m sr)].
  [[nodiscard]] double backscatter() const noexcept {
    return std::numbers::pi / 4 * density * (front() * squares(slope) + inside() * squares(slope + absorption));
  }

  /// Air with the mean of the particles, without their grain.
  [[nodiscard]] Medium medium() const noexcept {
    return {.group_index = 1, .scattering = extinction(), .backscatter = backscatter()};
  }

 private:
  [[nodiscard]] double squares(double decline) const noexcept {
    return detail::second_moment(decline, diameter_min, diameter_max);
  }
  /// Share of the distribution from the minimum diameter on that is below the maximum.
  [[nodiscard]] double within() const noexcept { return detail::lower_gamma<1>(slope * (diameter_max - diameter_min)); }
  /// By the shadow [1/sr].
  [[nodiscard]] double front() const noexcept { return reflectance / (4 * std::numbers::pi); }
  /// By the shadow, if nothing is absorbed [1/sr].
  [[nodiscard]] double inside() const noexcept { return 2 / lidar_ratio - front(); }
};

/// Rain of a rate from 0.1 to 300 mm/h, for a wavelength from 0.4 to 1.6 um [m]: drops from 0.1 to
/// 6 mm by Marshall & Palmer 1948, fitted from 1 to 23 mm/h, with too many drops below 1 mm.
/// Extinction by all of them, if not cut: 0.365 rate^0.63 per km. Lidar ratio: 20 sr where water is
/// clear; spheres by Mie's series have 23 to 25 sr at 0.532 um, and 4 to 21 sr from 0.9 to 1.1 um,
/// by a glory that varies with the third decimal of the index. As drops are flattened (Nousiainen &
/// Muinonen 1999), it is good there to a factor of some 4. Absorption: of the light from inside
/// along six diameters, fitted to Mie's series at 1.55 um to 30 %: large drops return less there
/// than at 0.9 um (Westbrook, Hogan, O'Connor & Illingworth 2010). @throws SettingError
[[nodiscard]] inline Precipitation rain(double rate_mm_per_hour, double wavelength) {
  require_within("rain (rate)", rate_mm_per_hour, 0.1, 300, "mm/h");
  require_within("rain (wavelength)", wavelength, 0.4e-6, 1.6e-6, "m");
  return {.density = 8e6,
          .slope = 4100 * std::pow(rate_mm_per_hour, -0.21),
          .diameter_min = 0.1e-3,
          .diameter_max = 6e-3,
          .lidar_ratio = 20,
          .absorption = wavelength < 0.7e-6 ? 0 : 6 * pure_water_absorption(wavelength),
          .reflectance = 0.02};
}

/// Snow of a rate from 0.1 to 10 mm of melted water per hour, for 0.4 to 1.1 um [m]. Melted
/// diameters from 0.1 to 5 mm by Sekhon & Srivastava 1970; diameters here are of discs of a flake's
/// shadow, 3.97 times as large: area in mm^2 = (mass in mg / 0.012)^(2/3), the mean in Hokuriku
/// (Papers in Meteorology and Geophysics 31, 1980). Lidar ratio: 33 sr, thin cirrus at 0.532 um
/// (Josset et al. 2012). Beyond 1.1 um ice absorbs; no figure is known. @throws SettingError
[[nodiscard]] inline Precipitation snow(double rate_mm_per_hour, double wavelength) {
  require_within("snow (rate)", rate_mm_per_hour, 0.1, 10, "mm/h");
  require_within("snow (wavelength)", wavelength, 0.4e-6, 1.1e-6, "m");
  const double flake = std::sqrt(4 / std::numbers::pi) * std::cbrt(std::numbers::pi / 6 / 0.012);
  return {.density = 2.5e6 * std::pow(rate_mm_per_hour, -0.94) / flake,
          .slope = 2290 * std::pow(rate_mm_per_hour, -0.45) / flake,
          .diameter_min = 0.1e-3 * flake,
          .diameter_max = 5e-3 * flake,
          .lidar_ratio = 33,
          .absorption = 0,
          .reflectance = 0};
}

}  // namespace PULSECAST_NAMESPACE

#endif
