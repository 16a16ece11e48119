// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Presets of air and water, as pulses find them: what is left of a wall's or a bottom's echo, and what comes back from
// before it.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/material/media.hpp>
#include <pulsecast/material/water_types.hpp>
#include <pulsecast/material/weather.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "support/light.hpp"
#include "validation/integral.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using namespace pulsecast::validation;
using support::clean;
using support::from_to;
using support::power_of;
using support::rectangle;
using support::traced;

namespace {

using World = support::LightScene;

/// What a pulse finds of a medium.
struct Found {
  double extinction;   ///< [1/m]
  double lidar_ratio;  ///< extinction by backscatter [sr]
};

/// Of the air before a wall at 40 m: from the wall's echo, and from what returns between 20 and 30 m.
Found found_in_air(const Medium& medium, double wavelength) {
  const World wall({rectangle({0, 40, 0}, 9.0 * axis::right, 9.0 * axis::up, Material{})});
  const support::Lamp lamp{.laser = {.wavelength = wavelength, .divergence = 0}};
  const auto pose = from_to({0, 0, 0}, axis::forward);
  const auto seen = traced(LightPaths{.air = Media({{.medium = medium}})}, wall, pose, SingleRay{}, lamp),
             clear = traced(LightPaths{}, wall, pose, SingleRay{}, lamp);
  const double extinction =
      std::log(power_of(clear.of(ReflectionKind::surface)) / power_of(seen.of(ReflectionKind::surface))) / (2 * 40);
  const double back = seen.between(20, 30, ReflectionKind::air).power;
  const LinkBudget budget(lamp.receiver, lamp.laser);
  const auto even = [&](double s) { return budget.power(1, pi, s) * std::exp(-2 * extinction * s); };
  return {extinction, extinction * integral(even, 20, 30, 4000) / back};
}

/// Diffuse attenuation [1/m] of water over a bottom at 2 m, from the bottom's echo.
double found_in_water(const Medium& medium, double wavelength) {
  const support::Lamp lamp{.laser = {.wavelength = wavelength, .divergence = 0}};
  const auto bottom = [&](const Medium& inside) {
    const World lake({rectangle({}, 90.0 * axis::right, 90.0 * axis::forward, clean(SmoothInterface::water(inside)), 1),
                      rectangle({0, 0, -2}, 90.0 * axis::right, 90.0 * axis::forward, Material{}, 2)});
    const auto seen = traced(LightPaths{}, lake, from_to({0, 0, 30}, {}), SingleRay{}, lamp);
    double power = 0;
    for (const Reflection& r : seen.reflections)
      if (r.object == 2) power += r.power;
    return power;
  };
  return std::log(bottom({medium.index, medium.group_index}) / bottom(medium)) / (2 * 2);
}

/// Extinction of particles [1/m]: twice their shadows, with so many per volume and diameter.
template <class Density>
double extinction_of(const Density& density, double least, double most, double wider) {
  return integral([&](double d) { return 2 * pi / 4 * std::pow(wider * d, 2) * density(d); }, least, most, 100'000);
}

}  // namespace

TEST_CASE("presets of air") {
  const auto koschmieder = [](double visibility, double wavelength, double exponent) {
    return 3.91 / visibility * std::pow(wavelength / 0.55e-6, -exponent);
  };
  const auto show = [](const std::string& name, const Found& found, double extinction, double lidar_ratio) {
    row(name + ": extinction [1/km]", 1e3 * extinction, 1e3 * found.extinction, 1e-6 * extinction * 1e3);
    row(Kind::published, name + ": lidar ratio [sr]", lidar_ratio, found.lidar_ratio, 0.005 * lidar_ratio);
  };
  // Kim 2001: no power of the wavelength below 500 m, V - 0.5 to 1 km, 0.16 V + 0.34 to 6 km, 1.3 to 50 km
  show("fog of 200 m at 905 nm", found_in_air(fog(200, 905_nm), 905_nm), koschmieder(200, 905_nm, 0), 18.8);
  show("fog of 800 m at 1550 nm", found_in_air(fog(800, 1550_nm), 1550_nm), koschmieder(800, 1550_nm, 0.3), 18.8);
  show("haze of 5 km at 532 nm", found_in_air(haze(5000, 532_nm), 532_nm), koschmieder(5000, 532_nm, 0.16 * 5 + 0.34),
       50);
  show("dust of 300 m at 1064 nm", found_in_air(dust(300, 1064_nm), 1064_nm), koschmieder(300, 0.55_um, 0), 69);
  show("smoke of 100 m at 532 nm", found_in_air(smoke(100, 532_nm), 532_nm), koschmieder(100, 532_nm, 0), 70);

  for (const double rate : {5.0, 25.0}) {
    const auto drops = [&](double d) {
      return 8e6 * std::exp(-4100 * std::pow(rate, -0.21) * d);
    };  // Marshall & Palmer 1948
    show("rain of " + std::to_string(static_cast<int>(rate)) + " mm/h at 532 nm",
         found_in_air(rain(rate, 532_nm).medium(), 532_nm), extinction_of(drops, 0.1e-3, 6e-3, 1), 20);
  }
  // Sekhon & Srivastava 1970, by the diameter of the melted flake; its shadow's area is (mass in mg / 0.012)^(2/3) mm^2
  const auto flakes = [](double d) {
    return 2.5e6 * std::pow(2.0, -0.94) * std::exp(-2290 * std::pow(2.0, -0.45) * d);
  };
  const double wider = std::sqrt(4 / pi * std::pow(pi / 6 / 0.012, 2.0 / 3));
  show("snow of 2 mm/h at 905 nm", found_in_air(snow(2, 905_nm).medium(), 905_nm),
       extinction_of(flakes, 0.1e-3, 5e-3, wider), 33);
}

TEST_CASE("presets of water") {
  struct Type {
    JerlovType type;
    const char* name;
    double at_525, at_550;  ///< published [1/m]
  };
  using enum JerlovType;
  // Austin & Petzold 1986, table VI; from 3C on Jerlov 1976, table XXVII
  const Type types[]{{oceanic_i, "I", 0.0504, 0.0640},     {oceanic_ia, "IA", 0.0545, 0.0674},
                     {oceanic_ib, "IB", 0.0596, 0.0715},   {oceanic_ii, "II", 0.0779, 0.0863},
                     {oceanic_iii, "III", 0.1120, 0.1139}, {coastal_1, "1C", 0.1461, 0.1415},
                     {coastal_3, "3C", 0.20, 0.19},        {coastal_5, "5C", 0.31, 0.30},
                     {coastal_7, "7C", 0.49, 0.46},        {coastal_9, "9C", 0.78, 0.63}};
  for (const Type& t : types) {
    const double published = t.at_525 + (532.0 - 525) / 25 * (t.at_550 - t.at_525);
    row(Kind::published,
        std::string("water of Jerlov's type ") + t.name + " at 532 nm: attenuation by a bottom's echo [1/m]", published,
        found_in_water(water(t.type, 532_nm), 532_nm), 1e-6);
  }
  row(Kind::published, "water of a Secchi depth of 5 m at 532 nm: attenuation by a bottom's echo [1/m]", 1.7 / 5,
      found_in_water(secchi_water(5, 532_nm), 532_nm), 1e-6);
}
