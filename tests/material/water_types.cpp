// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/water_types.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>

#include <doctest/doctest.h>

#include "support/refused_field.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using support::refused_field;
using support::relative;

namespace {

const double infinity = std::numeric_limits<double>::infinity();
const double nan_value = std::numeric_limits<double>::quiet_NaN();

using enum JerlovType;
constexpr std::array<JerlovType, 10> types{oceanic_i, oceanic_ia, oceanic_ib, oceanic_ii, oceanic_iii,
                                           coastal_1, coastal_3,  coastal_5,  coastal_7,  coastal_9};

}  // namespace

TEST_CASE("the attenuation of a type is that of the published tables, and linear between their rows") {
  CHECK(water_attenuation(oceanic_i, 475e-9) == relative(0.0184, 1e-12));
  CHECK(water_attenuation(oceanic_ii, 550e-9) == relative(0.0863, 1e-12));
  CHECK(water_attenuation(oceanic_iii, 400e-9) == relative(0.1697, 1e-12));
  CHECK(water_attenuation(coastal_1, 625e-9) == relative(0.3922, 1e-12));
  CHECK(water_attenuation(coastal_3, 500e-9) == relative(0.22, 1e-12));
  CHECK(water_attenuation(coastal_9, 475e-9) == relative(1.23, 1e-12));
  CHECK(water_attenuation(coastal_9, 700e-9) == relative(1.1, 1e-12));
  CHECK(water_attenuation(coastal_7, 350e-9) == relative(3.0, 1e-12));
  CHECK(water_attenuation(oceanic_ib, 532e-9) == relative(0.0596 + 0.28 * (0.0715 - 0.0596), 1e-12));
  // Jerlov's own figures at 475 nm, which Austin & Petzold kept
  const std::array<double, 10> jerlov{0.018, 0.025, 0.033, 0.062, 0.116, 0.17, 0.29, 0.43, 0.71, 1.23};
  for (std::size_t i = 0; i < types.size(); ++i)
    CHECK(std::fabs(water_attenuation(types[i], 475e-9) - jerlov[i]) < 5e-4);
}

TEST_CASE("a type is known by its name") {
  CHECK(jerlov_type("I") == JerlovType::oceanic_i);
  CHECK(jerlov_type("III") == JerlovType::oceanic_iii);
  CHECK(jerlov_type("1C") == JerlovType::coastal_1);
  CHECK(jerlov_type("9C") == JerlovType::coastal_9);
  CHECK(!jerlov_type("2C"));
  CHECK(!jerlov_type(""));
}

TEST_CASE("a more turbid type weakens more at every wavelength, and none less than pure water") {
  for (double w = 0.35e-6; w <= 1.1e-6; w += 1e-9) {
    CAPTURE(w);
    for (std::size_t i = 1; i < types.size(); ++i)
      REQUIRE(water_attenuation(types[i], w) > water_attenuation(types[i - 1], w));
    if (w >= 0.7e-6) REQUIRE(water_attenuation(oceanic_i, w) > pure_water_absorption(w));
  }
}

TEST_CASE("infrared attenuation continues the visible, and is that of pure water with the rest of the type") {
  for (const JerlovType type : types) {
    CHECK(water_attenuation(type, 0.7e-6 * (1 + 1e-12)) == relative(water_attenuation(type, 0.7e-6), 1e-9));
    const double excess = water_attenuation(type, 1.064e-6) - pure_water_absorption(1.064e-6);
    CHECK(excess > 0.04);
    CHECK(excess < 0.51);
  }
  CHECK(water_attenuation(oceanic_i, 1.064e-6) == relative(15.2, 0.01));
}

TEST_CASE("the light that a type of water absorbs and scatters is its attenuation") {
  for (const JerlovType type : types)
    for (double w = 0.35e-6; w <= 1.1e-6; w += 10e-9) {
      const Medium medium = water(type, w);
      CAPTURE(w);
      REQUIRE_NOTHROW(medium.validate());
      REQUIRE(medium.extinction() == relative(water_attenuation(type, w), 1e-12));
      REQUIRE(medium.absorption > 0);
      REQUIRE(medium.index == water_index(w));
      REQUIRE(medium.group_index == water_group_index(w));
    }
  const WaterState lake{.temperature_celsius = 5, .salinity_permille = 0};
  CHECK(water(coastal_5, 532e-9, lake).index == water_index(532e-9, lake));
  CHECK(water(coastal_5, 532e-9, lake).group_index == water_group_index(532e-9, lake));
  CHECK(water(coastal_5, 532e-9, lake).backscatter < water(coastal_5, 532e-9).backscatter);  // salt scatters
}

TEST_CASE("pure sea water scatters back as its molecules do") {
  // Morel 1974: at 500 nm 1.38e-4 1/(m sr) at 90 degrees from fresh water, 1.3 times as much from water of 37 g/kg
  const WaterState fresh{.temperature_celsius = 20, .salinity_permille = 0};
  CHECK(water(oceanic_i, 500e-9, fresh).backscatter == relative(1.38e-4 * (1 + 0.91 / 1.09), 1e-12));
  CHECK(water(oceanic_i, 500e-9).backscatter == relative(1.38e-4 * (1 + 0.3 * 35 / 37) * (1 + 0.91 / 1.09), 1e-12));
  // half of the scattering coefficient 8/3 pi beta(90) (2 + delta) / (1 + delta)
  CHECK(water(oceanic_i, 500e-9, fresh).scattering ==
        relative(0.5 * 8 * std::numbers::pi / 3 * 1.38e-4 * 2.09 / 1.09, 1e-12));
  CHECK(water(oceanic_i, 400e-9).backscatter / water(oceanic_i, 500e-9).backscatter ==
        relative(std::pow(0.8, -4.32), 1e-12));
}

TEST_CASE("particles scatter as was measured in each type") {
  const std::array<double, 6> measured{0.124, 0.179, 0.290,
                                       0.432, 0.651, 1.21};  // Williamson & Hollins 2022, water and particles, 532 nm
  const std::array<JerlovType, 6> of{oceanic_ib, oceanic_ii, oceanic_iii, coastal_1, coastal_3, coastal_5};
  const double molecules = 2 * water(oceanic_i, 532e-9).scattering;
  for (std::size_t i = 0; i < of.size(); ++i)
    CHECK(detail::particle_scattering(water_attenuation(of[i], 532e-9)) == relative(measured[i] - molecules, 1e-12));
  CHECK(detail::particle_scattering(water_attenuation(oceanic_i, 532e-9)) == 0);
  // between and beyond the types measured, in proportion to what the attenuation exceeds that of a neighbour
  const double pure = water_attenuation(oceanic_i, 532e-9);
  const auto excess = [&](JerlovType type) { return water_attenuation(type, 532e-9) - pure; };
  CHECK(detail::particle_scattering(water_attenuation(oceanic_ia, 532e-9)) ==
        relative((0.124 - molecules) * excess(oceanic_ia) / excess(oceanic_ib), 1e-12));
  CHECK(detail::particle_scattering(water_attenuation(coastal_9, 532e-9)) ==
        relative((1.21 - molecules) * excess(coastal_9) / excess(coastal_5), 1e-12));
}

TEST_CASE("the phase function of particles is the mean of Petzold's in San Diego Harbor, less the water's own") {
  struct Station {
    double scattering, straight_back, backward_share;
  };
  const std::array<Station, 3> stations{
      {{1.583, 6.2107e-3, 0.019}, {1.824, 5.6857e-3, 0.020}, {1.205, 3.5956e-3, 0.018}}};
  const detail::MolecularScattering sea(530e-9, 35);
  double straight_back = 0;
  double backward = 0;
  for (const Station& s : stations) {
    const double particles = s.scattering - sea.total();
    straight_back += (s.straight_back - sea.straight_back()) / particles / 3;
    backward += (s.backward_share * s.scattering - sea.backward()) / particles / 3;
  }
  CHECK(detail::particles_straight_back == relative(straight_back, 0.01));
  CHECK(detail::particles_backward == relative(backward, 0.03));
}

TEST_CASE("the lidar ratio of sea water is some 100 sr in the green") {
  for (const JerlovType type :
       {oceanic_ib, oceanic_ii, oceanic_iii, coastal_1, coastal_3, coastal_5, coastal_7, coastal_9}) {
    const Medium medium = water(type, 532e-9);
    CHECK(medium.extinction() / medium.backscatter > 65);
    CHECK(medium.extinction() / medium.backscatter < 105);
  }
  const Medium clear = water(oceanic_i, 532e-9);
  CHECK(clear.extinction() / clear.backscatter == relative(218, 0.01));
}

TEST_CASE("measured water has the attenuation and the backscatter that were measured") {
  const Medium medium = measured_water(0.3, 2e-3, 515e-9);
  CHECK_NOTHROW(medium.validate());
  CHECK(medium.extinction() == relative(0.3, 1e-14));
  CHECK(medium.backscatter == 2e-3);
  CHECK(medium.index == water_index(515e-9));
  CHECK(medium.group_index == water_group_index(515e-9));
  CHECK(measured_water(0.3, 0, 515e-9).scattering == 0);
  CHECK_NOTHROW(measured_water(0.1, 0.1 * 3.17e-3 / 0.018 * (1 - 1e-12), 515e-9).validate());  // all is scattered
}

TEST_CASE("water of a Secchi depth weakens by 1.7 over that depth, but not less than pure sea water") {
  CHECK(secchi_water(5, 532e-9).extinction() == relative(0.34, 1e-12));
  CHECK(secchi_water(0.1, 550e-9).extinction() == relative(17, 1e-12));
  CHECK(secchi_water(80, 532e-9).extinction() == relative(water_attenuation(oceanic_i, 532e-9), 1e-12));
  const double like_5c = 1.7 / water_attenuation(coastal_5, 532e-9);
  CHECK(secchi_water(like_5c, 532e-9).backscatter == relative(water(coastal_5, 532e-9).backscatter, 1e-9));
  double before = 0;
  for (double depth = 80; depth > 0.1; depth *= 0.95) {
    const Medium medium = secchi_water(depth, 532e-9);
    REQUIRE_NOTHROW(medium.validate());
    REQUIRE(medium.absorption > 0);
    REQUIRE(medium.backscatter >= before);
    before = medium.backscatter;
  }
}

TEST_CASE("water that cannot be, or of which nothing is known, is refused by the name of its setting") {
  for (const double bad : {0.349e-6, 1.101e-6, 532.0, nan_value}) {
    CHECK(refused_field([&] { (void)water_attenuation(oceanic_i, bad); }) == "water_attenuation (wavelength)");
    CHECK(refused_field([&] { (void)water(oceanic_i, bad); }) == "water_attenuation (wavelength)");
    CHECK(refused_field([&] { (void)measured_water(0.1, 1e-3, bad); }) == "water (wavelength)");
  }
  CHECK(refused_field([] { (void)water(static_cast<JerlovType>(10), 532e-9); }) == "water_attenuation (type)");
  CHECK(refused_field([] { (void)water(oceanic_i, 532e-9, {.salinity_permille = 36}); }) ==
        "WaterState::salinity_permille");
  for (const double bad : {0.0, -0.1, nan_value, infinity})
    CHECK(refused_field([&] { (void)measured_water(bad, 0, 532e-9); }) == "measured_water (attenuation)");
  for (const double bad : {-1e-9, 0.1 * 3.17e-3 / 0.018 * 1.001, nan_value})
    CHECK(refused_field([&] { (void)measured_water(0.1, bad, 532e-9); }) == "measured_water (backscatter)");
  for (const double bad : {0.09, 80.1, -1.0, nan_value})
    CHECK(refused_field([&] { (void)secchi_water(bad, 532e-9); }) == "secchi_water (depth)");
  for (const double bad : {0.489e-6, 0.571e-6, 1.064e-6, nan_value})
    CHECK(refused_field([&] { (void)secchi_water(5, bad); }) == "secchi_water (wavelength)");
}
