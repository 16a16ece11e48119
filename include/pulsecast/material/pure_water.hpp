// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_PURE_WATER_HPP
#define PULSECAST_MATERIAL_PURE_WATER_HPP

#include <numbers>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/search.hpp>

namespace PULSECAST_NAMESPACE {

/// Temperature and salinity of water at atmospheric pressure.
struct WaterState {
  double temperature_celsius = 20;  ///< temperature, from 0 to 30 [degrees Celsius]
  double salinity_permille = 35;    ///< salt, from 0 (fresh) to 35 (oceans) [g/kg]

  void validate() const {
    require_within("WaterState::temperature_celsius", temperature_celsius, 0, 30, "degrees Celsius");
    require_within("WaterState::salinity_permille", salinity_permille, 0, 35, "g/kg");
  }
};

namespace detail {

/// Index of refraction of water as a polynomial in the reciprocal wavelength: a + b/w + c/w^2 +
/// d/w^3, w in nm. Source: Quan & Fry 1995, with their ten coefficients.
struct WaterDispersion {
  double a, b;
  double c = -4382;
  double d = 1.1455e6;

  explicit WaterDispersion(const WaterState& state) noexcept {
    const double t = state.temperature_celsius;
    const double s = state.salinity_permille;
    a = 1.31405 + (1.779e-4 - 1.05e-6 * t + 1.6e-8 * t * t) * s - 2.02e-6 * t * t;
    b = 15.868 + 0.01155 * s - 0.00423 * t;
  }
};

inline void require_water(double wavelength, const WaterState& state) {
  require_within("water (wavelength)", wavelength, 0.35e-6, 1.1e-6, "m");
  state.validate();
}

struct AbsorptiveIndex {
  double micrometres;  ///< wavelength [um]
  double kappa;        ///< imaginary part of the index of refraction
};

/// Absorption of pure water at 25 degrees Celsius. Source: Segelstein 1981, all rows of this range.
// clang-format off
inline constexpr std::array<AbsorptiveIndex, 122> water_absorptive_index{{
    {0.6998,3.348e-8}, {0.7047,4.100e-8}, {0.7096,4.998e-8}, {0.7145,5.995e-8}, {0.7194,7.291e-8},
    {0.7244,9.137e-8}, {0.7295,1.150e-7}, {0.7345,1.348e-7}, {0.7396,1.458e-7}, {0.7447,1.530e-7},
    {0.7499,1.559e-7}, {0.7551,1.581e-7}, {0.7603,1.581e-7}, {0.7656,1.570e-7}, {0.7691,1.526e-7},
    {0.7745,1.478e-7}, {0.7798,1.409e-7}, {0.7852,1.339e-7}, {0.7907,1.282e-7}, {0.7943,1.258e-7},
    {0.7998,1.250e-7}, {0.8054,1.270e-7}, {0.8091,1.330e-7}, {0.8147,1.448e-7}, {0.8204,1.621e-7},
    {0.8241,1.819e-7}, {0.8299,2.041e-7}, {0.8356,2.243e-7}, {0.8395,2.459e-7}, {0.8453,2.690e-7},
    {0.8492,2.929e-7}, {0.8551,3.154e-7}, {0.8590,3.348e-7}, {0.8650,3.546e-7}, {0.8710,3.748e-7},
    {0.8750,3.906e-7}, {0.8790,4.053e-7}, {0.8851,4.234e-7}, {0.8892,4.403e-7}, {0.8954,4.622e-7},
    {0.8995,4.862e-7}, {0.9057,5.150e-7}, {0.9099,5.699e-7}, {0.9141,6.696e-7}, {0.9204,8.304e-7},
    {0.9247,1.060e-6}, {0.9290,1.368e-6}, {0.9354,1.771e-6}, {0.9397,2.169e-6}, {0.9441,2.557e-6},
    {0.9506,2.932e-6}, {0.9550,3.190e-6}, {0.9594,3.358e-6}, {0.9661,3.464e-6}, {0.9705,3.502e-6},
    {0.9750,3.480e-6}, {0.9795,3.418e-6}, {0.9840,3.337e-6}, {0.9908,3.253e-6}, {0.9954,3.131e-6},
    {1.0000,3.000e-6}, {1.0093,2.688e-6}, {1.0209,2.352e-6}, {1.0304,2.001e-6}, {1.0399,1.690e-6},
    {1.0495,1.419e-6}, {1.0593,1.299e-6}, {1.0691,1.259e-6}, {1.0789,1.329e-6}, {1.0889,1.499e-6},
    {1.0990,1.708e-6}, {1.1092,2.038e-6}, {1.1194,2.628e-6}, {1.1298,3.869e-6}, {1.1402,5.951e-6},
    {1.1508,9.306e-6}, {1.1588,1.069e-5}, {1.1695,1.119e-5}, {1.1803,1.160e-5}, {1.1912,1.181e-5},
    {1.1995,1.200e-5}, {1.2106,1.191e-5}, {1.2190,1.179e-5}, {1.2303,1.160e-5}, {1.2388,1.139e-5},
    {1.2503,1.100e-5}, {1.2589,1.079e-5}, {1.2706,1.091e-5}, {1.2794,1.139e-5}, {1.2912,1.221e-5},
    {1.3002,1.400e-5}, {1.3092,1.639e-5}, {1.3213,1.912e-5}, {1.3305,2.251e-5}, {1.3397,2.849e-5},
    {1.3490,4.047e-5}, {1.3614,4.505e-5}, {1.3709,5.803e-5}, {1.3804,7.802e-5}, {1.3900,1.060e-4},
    {1.3996,1.530e-4}, {1.4093,2.540e-4}, {1.4191,3.197e-4}, {1.4289,3.538e-4}, {1.4388,3.629e-4},
    {1.4488,3.637e-4}, {1.4588,3.604e-4}, {1.4689,3.387e-4}, {1.4791,3.018e-4}, {1.4894,2.659e-4},
    {1.4997,2.248e-4}, {1.5101,1.958e-4}, {1.5205,1.741e-4}, {1.5311,1.603e-4}, {1.5417,1.441e-4},
    {1.5488,1.348e-4}, {1.5596,1.240e-4}, {1.5704,1.140e-4}, {1.5812,1.071e-4}, {1.5885,9.940e-5},
    {1.5996,9.347e-5}, {1.6106,8.804e-5}}};
// clang-format on

}  // namespace detail

/// Index of refraction of water relative to air, for a wavelength in vacuum, from 0.35 to 1.1 um
/// [m]. Source: Quan & Fry 1995, fitted from 0.4 to 0.7 um, extrapolated as by Huibers 1997; air:
/// Zhang, Hu & He 2009. Differs from the fresh water of Daimon & Masumura 2007 by at most 3e-5 in
/// the visible, 1e-3 at 1.06 um. @throws SettingError out of range
[[nodiscard]] inline double water_index(double wavelength, const WaterState& state = {}) {
  detail::require_water(wavelength, state);
  const detail::WaterDispersion n(state);
  const double x = 1e-9 / wavelength;
  return n.a + x * (n.b + x * (n.c + x * n.d));
}

/// Speed of a pulse in air by that in water: n - w dn/dw of `water_index` n over the wavelength w.
/// From Daimon & Masumura 2007 by 5e-4 in the visible, 5e-3 at 1.06 um. @throws SettingError
[[nodiscard]] inline double water_group_index(double wavelength, const WaterState& state = {}) {
  detail::require_water(wavelength, state);
  const detail::WaterDispersion n(state);
  const double x = 1e-9 / wavelength;
  return n.a + x * (2 * n.b + x * (3 * n.c + x * 4 * n.d));
}

/// Absorption of pure water [1/m] from 0.7 to 1.6 um [m]: 4 pi kappa / wavelength, kappa linear
/// between rows; varies by some per cent. Source: Segelstein 1981. @throws SettingError
[[nodiscard]] inline double pure_water_absorption(double wavelength) {
  require_within("pure_water_absorption (wavelength)", wavelength, 0.7e-6, 1.6e-6, "m");
  using detail::AbsorptiveIndex;
  const double kappa = detail::interpolated(detail::water_absorptive_index, wavelength * 1e6,
                                            &AbsorptiveIndex::micrometres, &AbsorptiveIndex::kappa);
  return 4 * std::numbers::pi * kappa / wavelength;
}

}  // namespace PULSECAST_NAMESPACE

#endif
