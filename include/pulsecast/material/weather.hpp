// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_WEATHER_HPP
#define PULSECAST_MATERIAL_WEATHER_HPP

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <pulsecast/base/extinction.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/material/medium.hpp>
#include <pulsecast/material/pure_water.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Air with particles of an extinction coefficient [1/m], a share of it that is scattered, and a
/// ratio of it to the backscatter [sr].
[[nodiscard]] inline Medium hazy_air(double extinction, double albedo, double lidar_ratio) noexcept {
  return {.index = 1,
          .group_index = 1,
          .absorption = (1 - albedo) * extinction,
          .scattering = albedo * extinction,
          .backscatter = extinction / lidar_ratio};
}

/// Integral of x^(order-1) exp(-x) from 0 to y for an order from 1 to 3: the series of positive
/// terms for small y, else its closed form.
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

/// Integral of D^2 exp(-slope D) over diameters D from `least` to `most` [m^3]; `slope` is positive [1/m].
[[nodiscard]] inline double second_moment(double slope, double least, double most) noexcept {
  const double y = slope * (most - least);
  const double shifted =
      least * least * lower_gamma<1>(y) + 2 * least / slope * lower_gamma<2>(y) + lower_gamma<3>(y) / (slope * slope);
  return std::exp(-slope * least) / slope * shifted;
}

}  // namespace detail

/// Fog of a visibility, from 1 m to 1 km [m], for a wavelength from 0.4 to 1.6 um [m]. Extinction: `extinction` by Kim
/// 2001, the same at all wavelengths below 500 m. Lidar ratio: 18.8 sr (O'Connor, Illingworth & Hogan 2004, droplets of
/// stratocumulus at 0.905 um); droplets of radii from 2 to 20 um have from 18 to 21 sr from 0.53 to 1.55 um by Mie's
/// series. All is scattered: they absorb less than 1 %.
/// @throws SettingError out of range
[[nodiscard]] inline Medium fog(double visibility, double wavelength) {
  require_within("fog (visibility)", visibility, 1, 1e3, "m");
  require_within("fog (wavelength)", wavelength, 0.4e-6, 1.6e-6, "m");
  return detail::hazy_air(extinction(wavelength, visibility), 1, 18.8);
}

/// Haze of a visibility, from 1 to 100 km [m], for a wavelength from 0.4 to 1.6 um [m]. Extinction:
/// `extinction` by Kim 2001. Lidar ratio: 50 sr, of polluted continental air at 0.532 um (Li et al.
/// 2022, 20 sr and more below the 70 sr of CALIPSO's version 4); unverified at other wavelengths.
/// Scattered: 0.94 (Narasimhan & Satheesh 2013, mean over India). @throws SettingError out of range
[[nodiscard]] inline Medium haze(double visibility, double wavelength) {
  require_within("haze (visibility)", visibility, 1e3, 1e5, "m");
  require_within("haze (wavelength)", wavelength, 0.4e-6, 1.6e-6, "m");
  return detail::hazy_air(extinction(wavelength, visibility), 0.94, 50);
}

/// Mineral dust of a visibility, from 1 m to 100 km [m], for a wavelength from 0.4 to 1.6 um [m]. Extinction: that at
/// 0.55 um, 3.91 by the visibility, at every wavelength, as pure dust falls with less than the power 0.4 of it (Shin et
/// al. 2018). Lidar ratio: 50 sr to 0.532 um, 69 sr from 1.064 um, linear between them (Haarig et al. 2022, Saharan
/// dust); from 35 sr for other deserts (Shin et al. 2018). Absorption is left out: all is scattered. @throws
/// SettingError out of range
[[nodiscard]] inline Medium dust(double visibility, double wavelength) {
  require_within("dust (visibility)", visibility, 1, 1e5, "m");
  require_within("dust (wavelength)", wavelength, 0.4e-6, 1.6e-6, "m");
  const double share = std::clamp((wavelength - 0.532e-6) / (1.064e-6 - 0.532e-6), 0.0, 1.0);
  return detail::hazy_air(extinction(0.55e-6, visibility), 1, 50 + share * (69 - 50));
}

/// Smoke of fires of a visibility, from 1 m to 100 km [m], for a wavelength from 0.4 to 1.6 um [m]. Extinction:
/// `extinction` by Kim 2001, measured in haze and fog, not smoke. Lidar ratio: 70 sr at 0.532 um (Li et al. 2022, from
/// 65 to 75 sr over the Atlantic); unverified at other wavelengths. Scattered: 0.92 at 0.55 um, from 0.88 for grass to
/// 0.97 for boreal forest (Sayer et al. 2014). @throws SettingError out of range
[[nodiscard]] inline Medium smoke(double visibility, double wavelength) {
  require_within("smoke (visibility)", visibility, 1, 1e5, "m");
  require_within("smoke (wavelength)", wavelength, 0.4e-6, 1.6e-6, "m");
  return detail::hazy_air(extinction(wavelength, visibility), 0.92, 70);
}

/// Falling particles, in number per volume and diameter D: N(D) = density exp(-slope D) between two diameters, none
/// beyond. Much larger than the wavelength: each takes twice its shadow pi/4 D^2 out of the beam, half of it by
/// diffraction into a cone of about wavelength / D, which wide receivers take for light that was not lost (van de Hulst
/// 1957). All that is lost counts as scattered.
struct Precipitation {
  double density = 0;            ///< N(D) extrapolated to D = 0: number per volume and diameter [1/m^4]
  double slope = 1;              ///< decline of the distribution with diameter, from 1e-3 to 1e9 [1/m]
  double diameter_min = 0.1e-3;  ///< minimum diameter [m]
  double diameter_max = 6e-3;    ///< maximum diameter [m]
  double lidar_ratio = 20;       ///< extinction by backscatter of particles that absorb nothing, at least 1 [sr]
  double absorption = 0;   ///< decline of the light from inside a particle with its diameter: exp(-absorption D) [1/m]
  double reflectance = 0;  ///< share reflected by a particle's front at normal incidence, at most 8 pi / lidar_ratio

  void validate() const {
    require_not_negative("Precipitation::density", density, "1/m^4");
    require_within("Precipitation::slope", slope, 1e-3, 1e9, "1/m");
    require_not_negative("Precipitation::diameter_min", diameter_min, "m");
    require_positive("Precipitation::diameter_max (above diameter_min)", diameter_max - diameter_min, "m");
    require_within("Precipitation::lidar_ratio", lidar_ratio, 1, std::numeric_limits<double>::max(), "sr");
    require_not_negative("Precipitation::absorption", absorption, "1/m");
    require_within("Precipitation::reflectance", reflectance, 0, std::min(1.0, 8 * std::numbers::pi / lidar_ratio), "");
  }

  /// Particles per volume [1/m^3].
  [[nodiscard]] double number() const noexcept {
    return density / slope * std::exp(-slope * diameter_min) *
           detail::lower_gamma<1>(slope * (diameter_max - diameter_min));
  }
  /// Diameter of a particle [m] for a uniform number in [0, 1]: inverse of the cumulative distribution.
  [[nodiscard]] double diameter(double uniform) const noexcept {
    return std::clamp(
        diameter_min - std::log1p(-uniform * detail::lower_gamma<1>(slope * (diameter_max - diameter_min))) / slope,
        diameter_min, diameter_max);
  }

  /// Differential cross section for scattering straight back of a particle of a diameter [m]
  /// [m^2/sr]: by the shadow, of its front, reflectance / (4 pi), that of a mirror sphere; of its
  /// inside, the rest to `lidar_ratio`, weakened by absorption.
  [[nodiscard]] double backscatter_cross_section(double diameter) const noexcept {
    return std::numbers::pi / 4 * diameter * diameter * (front() + inside() * std::exp(-absorption * diameter));
  }

  /// Extinction coefficient [1/m].
  [[nodiscard]] double extinction() const noexcept {
    return std::numbers::pi / 2 * density * detail::second_moment(slope, diameter_min, diameter_max);
  }
  /// Backscatter coefficient [1/(m sr)].
  [[nodiscard]] double backscatter() const noexcept {
    return std::numbers::pi / 4 * density *
           (front() * detail::second_moment(slope, diameter_min, diameter_max) +
            inside() * detail::second_moment(slope + absorption, diameter_min, diameter_max));
  }

  /// Air with the mean of the particles, without their grain.
  [[nodiscard]] Medium medium() const noexcept {
    return {.index = 1, .group_index = 1, .absorption = 0, .scattering = extinction(), .backscatter = backscatter()};
  }

 private:
  /// By the shadow [1/sr].
  [[nodiscard]] double front() const noexcept { return reflectance / (4 * std::numbers::pi); }
  /// By the shadow, if nothing is absorbed [1/sr].
  [[nodiscard]] double inside() const noexcept { return 2 / lidar_ratio - front(); }
};

/// Rain of a rate from 0.1 to 300 mm/h, for a wavelength from 0.4 to 1.6 um [m]: drops from 0.1 to 6 mm by Marshall &
/// Palmer 1948, whose fit holds from 1 to 23 mm/h and has too many drops below 1 mm. Extinction by all of them, if not
/// cut: 0.365 rate^0.63 per km. Lidar ratio: 20 sr where water is clear, as spheres by Mie's series have from 23 to 25
/// sr at 0.532 um. From 0.9 to 1.1 um they have from 4 to 21 sr, by a glory that varies with the third decimal of the
/// index. Flattened drops are not to be taken for spheres (Nousiainen & Muinonen 1999). There the figure is good to a
/// factor of some 4. Absorption: of the light from inside along six diameters, fitted to Mie's series at 1.55 um to 30
/// %. So much less light comes back from large drops at 1.55 um than at 0.9 um (Westbrook, Hogan, O'Connor &
/// Illingworth 2010). @throws SettingError out of range
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

/// Snow of a rate from 0.1 to 10 mm of melted water per hour, for a wavelength from 0.4 to 1.1 um [m]. Melted diameters
/// from 0.1 to 5 mm by Sekhon & Srivastava 1970. Diameters here are those of discs of the shadow of a flake, 3.97 times
/// as large: area in mm^2 = (mass in mg / 0.012)^(2/3), the mean of flakes in Hokuriku (Papers in Meteorology and
/// Geophysics 31, 1980). Lidar ratio: 33 sr, of thin cirrus at 0.532 um (Josset et al. 2012). Beyond 1.1 um ice absorbs
/// and no figure is known. @throws SettingError out of range
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
