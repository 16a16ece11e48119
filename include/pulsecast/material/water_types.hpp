// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_WATER_TYPES_HPP
#define PULSECAST_MATERIAL_WATER_TYPES_HPP

#include <algorithm>
#include <optional>

#include <pulsecast/material/medium.hpp>
#include <pulsecast/material/pure_water.hpp>

namespace PULSECAST_NAMESPACE {

/// Optical types of sea water by Jerlov, from the clearest to the most turbid. Source: Jerlov 1976.
enum class JerlovType : std::uint8_t {
  oceanic_i,    ///< I: clearest ocean
  oceanic_ia,   ///< IA
  oceanic_ib,   ///< IB
  oceanic_ii,   ///< II
  oceanic_iii,  ///< III: most turbid of the open ocean
  coastal_1,    ///< 1C: clearest of the coasts
  coastal_3,    ///< 3C
  coastal_5,    ///< 5C
  coastal_7,    ///< 7C
  coastal_9,    ///< 9C: most turbid of the coasts
};

/// Type by its name, as Jerlov writes it: "IB" or "3C"; empty for another text.
[[nodiscard]] inline std::optional<JerlovType> jerlov_type(std::string_view name) noexcept {
  constexpr std::string_view names[]{"I", "IA", "IB", "II", "III", "1C", "3C", "5C", "7C", "9C"};
  const auto found = std::find(std::begin(names), std::end(names), name);
  if (found == std::end(names)) return std::nullopt;
  return static_cast<JerlovType>(found - std::begin(names));
}

namespace detail {

inline constexpr std::size_t jerlov_type_count = 10;
inline constexpr double jerlov_shortest = 0.35e-6;  ///< wavelength of the first row [m]
inline constexpr double jerlov_longest = 0.7e-6;    ///< wavelength of the last row [m]
inline constexpr double jerlov_step = 25e-9;        ///< wavelength from row to row [m]

/// Diffuse attenuation of downward irradiance [1/m] by wavelength (row) and type. Source: I (pure)
/// to 1C by Austin & Petzold 1986, table VI, for Jerlov's; 3C to 9C: Jerlov 1976, table XXVII.
// clang-format off
inline constexpr std::array<std::array<double, jerlov_type_count>, 15> jerlov_attenuation{{
    {0.0510, 0.0632, 0.0782, 0.1325, 0.2335, 0.3345, 1.70, 2.30, 3.00, 3.90},
    {0.0302, 0.0412, 0.0546, 0.1031, 0.1935, 0.2839, 1.10, 1.60, 2.10, 3.00},
    {0.0217, 0.0316, 0.0438, 0.0878, 0.1697, 0.2516, 0.78, 1.10, 1.60, 2.40},
    {0.0185, 0.0280, 0.0395, 0.0814, 0.1594, 0.2374, 0.54, 0.78, 1.20, 1.90},
    {0.0176, 0.0257, 0.0355, 0.0714, 0.1381, 0.2048, 0.39, 0.56, 0.89, 1.60},
    {0.0184, 0.0250, 0.0330, 0.0620, 0.1160, 0.1700, 0.29, 0.43, 0.71, 1.23},
    {0.0280, 0.0332, 0.0396, 0.0627, 0.1056, 0.1486, 0.22, 0.36, 0.58, 0.99},
    {0.0504, 0.0545, 0.0596, 0.0779, 0.1120, 0.1461, 0.20, 0.31, 0.49, 0.78},
    {0.0640, 0.0674, 0.0715, 0.0863, 0.1139, 0.1415, 0.19, 0.30, 0.46, 0.63},
    {0.0931, 0.0960, 0.0995, 0.1122, 0.1359, 0.1596, 0.21, 0.33, 0.46, 0.58},
    {0.2408, 0.2437, 0.2471, 0.2595, 0.2826, 0.3057, 0.33, 0.40, 0.48, 0.60},
    {0.3174, 0.3206, 0.3245, 0.3389, 0.3655, 0.3922, 0.40, 0.48, 0.54, 0.65},
    {0.3559, 0.3601, 0.3652, 0.3837, 0.4181, 0.4525, 0.46, 0.54, 0.63, 0.76},
    {0.4372, 0.4410, 0.4457, 0.4626, 0.4942, 0.5257, 0.56, 0.65, 0.78, 0.92},
    {0.6513, 0.6530, 0.6550, 0.6623, 0.6760, 0.6896, 0.71, 0.80, 0.92, 1.10}}};
// clang-format on

/// Attenuation of a type [1/m] at a wavelength of the table, linear between its rows.
[[nodiscard]] inline double tabulated_attenuation(std::size_t type, double wavelength) noexcept {
  constexpr std::size_t last = jerlov_attenuation.size() - 1;
  const double row = std::clamp((wavelength - jerlov_shortest) / jerlov_step, 0.0, double{last});
  const std::size_t i = std::min(static_cast<std::size_t>(row), last - 1);
  const double here = jerlov_attenuation[i][type], next = jerlov_attenuation[i + 1][type];
  return here + (row - static_cast<double>(i)) * (next - here);
}

inline constexpr double green = 0.532e-6;  ///< wavelength of `particle_scattering` [m]

/// Scattering by water molecules [1/(m sr)]: at 90 degrees, straight back; to the backward half
/// space [1/m]. Source: Morel 1974 as in Boss & Pegau 2001, eqs. 4, 5; depolarization 0.09.
struct MolecularScattering {
  double sideways;
  static constexpr double anisotropy = (1 - 0.09) / (1 + 0.09);

  MolecularScattering(double wavelength, double salinity_permille) noexcept
      : sideways(1.38e-4 * std::pow(wavelength / 0.5e-6, -4.32) * (1 + 0.3 * salinity_permille / 37)) {}
  [[nodiscard]] double straight_back() const noexcept { return sideways * (1 + anisotropy); }
  [[nodiscard]] double backward() const noexcept { return 2 * std::numbers::pi * sideways * (1 + anisotropy / 3); }
  [[nodiscard]] double total() const noexcept { return 2 * backward(); }
};

/// Shares scattered by particles: straight back [1/sr], and to the backward half space. Means of
/// San Diego Harbor at 0.53 um. Source: Petzold 1972, extrapolated from 170 degrees.
inline constexpr double particles_straight_back = 3.17e-3;
inline constexpr double particles_backward = 0.018;

/// Scattering coefficient of the particles at 0.532 um [1/m] for an attenuation there [1/m]: linear
/// between measured types, none in pure sea water, beyond 5C in proportion to what is above that.
/// Source: Williamson & Hollins 2022 for IB, II, III, 1C, 3C, 5C; the others lie on these lines.
[[nodiscard]] inline double particle_scattering(double attenuation) noexcept {
  struct Measured {
    JerlovType type;
    double scattering;  ///< of water and particles [1/m]
  };
  using enum JerlovType;
  constexpr Measured table[]{{oceanic_ib, 0.124}, {oceanic_ii, 0.179}, {oceanic_iii, 0.290},
                             {coastal_1, 0.432},  {coastal_3, 0.651},  {coastal_5, 1.21}};
  const double water = MolecularScattering(green, 35).total();
  const double pure = tabulated_attenuation(0, green);
  if (!(attenuation > pure)) return 0;
  double before = pure;
  double below = 0;
  for (const auto& [type, scattering] : table) {
    const double here = tabulated_attenuation(static_cast<std::size_t>(type), green);
    const double value = scattering - water;
    if (attenuation <= here) return below + (value - below) * (attenuation - before) / (here - before);
    before = here;
    below = value;
  }
  return below * (attenuation - pure) / (before - pure);
}

/// Water of an attenuation, and of one at 0.532 um that says how much particles scatter.
[[nodiscard]] inline Medium natural_water(double attenuation, double attenuation_at_green, double wavelength,
                                          const WaterState& state) {
  const MolecularScattering water(wavelength, state.salinity_permille);
  const double particles = particle_scattering(attenuation_at_green) * std::pow(wavelength / green, -0.3);
  const double backward = water.backward() + particles_backward * particles;
  return {.index = water_index(wavelength, state),
          .group_index = water_group_index(wavelength, state),
          .absorption = attenuation - backward,
          .scattering = backward,
          .backscatter = water.straight_back() + particles_straight_back * particles};
}

}  // namespace detail

/// Diffuse attenuation coefficient of a type of water [1/m] for a wavelength from 0.35 to 1.1 um
/// [m]. To 0.7 um linear between the rows of Austin & Petzold 1986 and Jerlov 1976. Beyond, not
/// tabulated: absorption of pure water (7 1/m at 0.905 um, 15 1/m at 1.064 um), and what the type
/// has above it at 0.7 um: 0.05 1/m for I to 0.5 1/m for 9C. @throws SettingError out of range
[[nodiscard]] inline double water_attenuation(JerlovType type, double wavelength) {
  using namespace detail;
  const auto column = static_cast<std::size_t>(type);
  require_within("water_attenuation (type)", column, 0, jerlov_type_count - 1, "");
  require_within("water_attenuation (wavelength)", wavelength, jerlov_shortest, 1.1e-6, "m");
  if (wavelength <= jerlov_longest) return tabulated_attenuation(column, wavelength);
  return pure_water_absorption(wavelength) + tabulated_attenuation(column, jerlov_longest) -
         pure_water_absorption(jerlov_longest);
}

/// Water of a type, for a laser's wavelength in vacuum, from 0.35 to 1.1 um [m]. Absorption and
/// scattering, to the backward half space, sum to the diffuse attenuation: light scattered forwards
/// stays in view. Holds for receivers that see a spot some 5 mean free paths in water wide (Gordon
/// 1982); narrower ones lose more, up to the beam attenuation. Backscatter is that of the molecules
/// and of as many particles as scatter like the type at 0.532 um, with the power -0.3 of the
/// wavelength (Haltrin 1999, large particles) and the phase function of Petzold 1972: good to a
/// factor of some 2, less so for IA, 7C and 9C, without known scattering. @throws SettingError
[[nodiscard]] inline Medium water(JerlovType type, double wavelength, const WaterState& state = {}) {
  const double at_green = water_attenuation(type, detail::green);
  return detail::natural_water(water_attenuation(type, wavelength), at_green, wavelength, state);
}

/// Water of a measured diffuse attenuation [1/m] and backscatter coefficient [1/(m sr)] at a
/// laser's wavelength in vacuum, from 0.35 to 1.1 um [m]. It scatters as particles by Petzold 1972
/// with this backscatter. @throws SettingError out of range, or if this exceeds the attenuation
[[nodiscard]] inline Medium measured_water(double attenuation, double backscatter, double wavelength,
                                           const WaterState& state = {}) {
  require_positive("measured_water (attenuation)", attenuation, "1/m");
  const double backward = detail::particles_backward / detail::particles_straight_back;
  require_within("measured_water (backscatter)", backscatter, 0, attenuation / backward, "1/(m sr)");
  return {.index = water_index(wavelength, state),
          .group_index = water_group_index(wavelength, state),
          .absorption = attenuation - backward * backscatter,
          .scattering = backward * backscatter,
          .backscatter = backscatter};
}

/// Water of a Secchi depth, from 0.1 to 80 m [m], for a green laser, from 0.49 to 0.57 um [m],
/// about what the eye sees of the disk. Attenuation: 1.7 / depth (Poole & Atkins 1929; in turbid
/// water down to 1.4), at least that of type I. Scattering and backscatter as in `water`, for a
/// type of this attenuation. @throws SettingError out of range
[[nodiscard]] inline Medium secchi_water(double depth, double wavelength, const WaterState& state = {}) {
  require_within("secchi_water (depth)", depth, 0.1, 80, "m");
  require_within("secchi_water (wavelength)", wavelength, 0.49e-6, 0.57e-6, "m");
  const double attenuation = std::max(1.7 / depth, detail::tabulated_attenuation(0, wavelength));
  return detail::natural_water(attenuation, 1.7 / depth, wavelength, state);
}

}  // namespace PULSECAST_NAMESPACE

#endif
