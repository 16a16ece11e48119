// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/weather.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <pulsecast/base/random.hpp>

#include <doctest/doctest.h>

#include "support/refused_field.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using support::refused_field;
using support::relative;

namespace {

const double infinity = std::numeric_limits<double>::infinity();
const double nan_value = std::numeric_limits<double>::quiet_NaN();
const double pi = std::numbers::pi;

/// Area that a particle of a diameter takes out of a beam: twice its shadow (van de Hulst 1957).
double extinction_cross_section(double diameter) { return pi / 2 * diameter * diameter; }

/// Integral over the diameters of a precipitation by Gauss and Legendre with five points in each of 2000 intervals.
template <class Function>
double quadrature(const Precipitation& p, const Function& f) {
  const std::array<double, 5> nodes{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                    0.9061798459386640};
  const std::array<double, 5> weights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                      0.2369268850561891};
  const int count = 2000;
  const double half = (p.diameter_max - p.diameter_min) / (2 * count);
  double sum = 0;
  for (int i = 0; i < count; ++i)
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const double d = p.diameter_min + half * (2 * i + 1 + nodes[k]);
      sum += weights[k] * half * f(d) * p.density * std::exp(-p.slope * d);
    }
  return sum;
}

/// Rain of drops that absorb, snow, and distributions that are narrow, wide, steep and flat.
const std::vector<Precipitation> precipitations{
    rain(1, 0.532e-6),
    rain(10, 1.064e-6),
    rain(50, 1.55e-6),
    snow(0.5, 0.905e-6),
    snow(5, 0.532e-6),
    {.density = 3, .slope = 1e-3, .diameter_min = 1, .diameter_max = 2, .absorption = 0.5, .reflectance = 0.5},
    {.density = 1e7, .slope = 2e3, .diameter_min = 1e-3, .diameter_max = 1.001e-3},
    {.density = 1e7, .slope = 1, .diameter_min = 0, .diameter_max = 1e-3, .absorption = 1e3, .reflectance = 0.03},
};

/// Light lost by and scattered straight back from a sphere, by its cross section and 1 sr.
struct Sphere {
  double extinction, scattering, backscatter;
};

/// Sphere of a size, pi times its diameter by the wavelength, and an index of refraction, by Mie's series. Source:
/// Bohren & Huffman 1983.
Sphere sphere(double size, std::complex<double> index) {
  using Complex = std::complex<double>;
  const Complex inner = size * index;
  const auto count = static_cast<std::size_t>(size + 4.05 * std::cbrt(size) + 2);
  const std::size_t first = std::max(count, static_cast<std::size_t>(std::abs(inner))) + 16;
  std::vector<Complex> derivative(first + 1);
  for (std::size_t n = first; n > 0; --n) {
    const Complex term = static_cast<double>(n) / inner;
    derivative[n - 1] = term - 1.0 / (derivative[n] + term);
  }
  Complex before(std::cos(size), std::sin(size));  // psi - i chi of the two orders before
  Complex last(std::sin(size), -std::cos(size));
  Sphere all{};
  Complex back;
  for (std::size_t n = 1; n <= count; ++n) {
    const double order = static_cast<double>(n);
    const Complex here = (2 * order - 1) / size * last - before;
    const Complex a = derivative[n] / index + order / size;
    const Complex b = derivative[n] * index + order / size;
    const Complex electric = (a * here.real() - last.real()) / (a * here - last);
    const Complex magnetic = (b * here.real() - last.real()) / (b * here - last);
    all.extinction += (2 * order + 1) * (electric + magnetic).real();
    all.scattering += (2 * order + 1) * (std::norm(electric) + std::norm(magnetic));
    back += (2 * order + 1) * (n % 2 == 0 ? 1.0 : -1.0) * (electric - magnetic);
    before = last;
    last = here;
  }
  const double by_area = 2 / (size * size);
  return {by_area * all.extinction, by_area * all.scattering, std::norm(back) / (4 * pi * size * size)};
}

/// Sum over spheres of diameters drawn evenly in their logarithm, with weights by diameter.
template <class Weight>
Sphere spheres(double least, double most, int count, double wavelength, std::complex<double> index,
               const Weight& weight) {
  Sphere sum{};
  for (int i = 0; i < count; ++i) {
    const double share = (i + uniform({.seed = 7, .pulse = static_cast<PulseIndex>(i)})) / count;
    const double d = least * std::pow(most / least, share);
    const Sphere s = sphere(pi * d / wavelength, index);
    const double w = weight(d) * d * d * d;  // the area, and the width of an interval
    sum.extinction += w * s.extinction;
    sum.scattering += w * s.scattering;
    sum.backscatter += w * s.backscatter;
  }
  return sum;
}

}  // namespace

TEST_CASE("fog, haze and smoke weaken by Kim's law, dust as at the wavelength of the definition of visibility") {
  for (const double w : {0.532e-6, 0.905e-6, 1.064e-6, 1.55e-6}) {
    CHECK(fog(200, w).extinction() == relative(3.91 / 200, 1e-14));  // by hand
    CHECK(fog(800, w).extinction() == relative(extinction(w, 800), 1e-14));
    CHECK(haze(5e3, w).extinction() == relative(extinction(w, 5e3), 1e-14));
    CHECK(smoke(2e3, w).extinction() == relative(extinction(w, 2e3), 1e-14));
    CHECK(dust(2e3, w).extinction() == relative(3.91 / 2e3, 1e-14));
    for (const Medium& medium : {fog(1, w), haze(1e5, w), smoke(1, w), dust(1e5, w)}) CHECK_NOTHROW(medium.validate());
  }
}

TEST_CASE("the lidar ratios of fog, haze, dust and smoke are those published") {
  const auto ratio = [](const Medium& medium) { return medium.extinction() / medium.backscatter; };
  CHECK(ratio(fog(100, 0.905e-6)) == relative(18.8, 1e-12));
  CHECK(ratio(haze(5e3, 0.532e-6)) == relative(50, 1e-12));
  CHECK(ratio(smoke(1e3, 0.532e-6)) == relative(70, 1e-12));
  CHECK(ratio(dust(1e3, 0.45e-6)) == relative(50, 1e-12));
  CHECK(ratio(dust(1e3, 0.532e-6)) == relative(50, 1e-12));
  CHECK(ratio(dust(1e3, 0.798e-6)) == relative(59.5, 1e-12));
  CHECK(ratio(dust(1e3, 1.064e-6)) == relative(69, 1e-12));
  CHECK(ratio(dust(1e3, 1.55e-6)) == relative(69, 1e-12));
  CHECK(haze(5e3, 0.532e-6).scattering == relative(0.94 * haze(5e3, 0.532e-6).extinction(), 1e-14));
  CHECK(smoke(5e3, 0.532e-6).scattering == relative(0.92 * smoke(5e3, 0.532e-6).extinction(), 1e-14));
  CHECK(fog(100, 1.55e-6).absorption == 0);
  CHECK(dust(100, 1.55e-6).absorption == 0);
}

TEST_CASE("droplets of fog have the lidar ratio of fog, and absorb hardly, by Mie's series") {
  struct Water {
    double wavelength;
    std::complex<double> index;  // Segelstein 1981
  };
  const std::array<Water, 4> waters{{{0.532e-6, {1.3337, 1.5e-9}},
                                     {0.905e-6, {1.3235, 5.1e-7}},
                                     {1.064e-6, {1.3205, 1.28e-6}},
                                     {1.55e-6, {1.3109, 1.336e-4}}}};
  for (const Water& water : waters) {
    CAPTURE(water.wavelength);
    const auto by_size = [](double d) {  // most droplets have radii about 5 um
      const double um = d / 2e-6;
      return std::pow(um, 6) * std::exp(-1.2 * um);
    };
    const Sphere drops = spheres(4e-6, 40e-6, 4000, water.wavelength, water.index, by_size);
    CHECK(drops.extinction / drops.backscatter == relative(18.8, 0.12));
    CHECK(drops.scattering / drops.extinction > 0.99);
  }
}

TEST_CASE("rain is Marshall and Palmer's") {
  const Precipitation p = rain(10, 0.905e-6);
  CHECK(p.density == relative(8000 * 1e3, 1e-14));                     // 8000 /(m^3 mm)
  CHECK(p.slope == relative(4.1 * std::pow(10, -0.21) * 1e3, 1e-14));  // per m
  CHECK(rain(1, 0.905e-6).slope == relative(4100, 1e-14));
  Precipitation whole = p;
  whole.diameter_min = 0;
  whole.diameter_max = 1;
  CHECK(whole.extinction() * 1e3 == relative(0.365 * std::pow(10, 0.63), 1e-3));  // pi n0 / slope^3, per km
  CHECK(whole.number() == relative(p.density / p.slope, 1e-12));
  CHECK(p.extinction() > 0.98 * whole.extinction());  // what is cut off hardly counts
}

TEST_CASE("rain has the lidar ratio of drops by Mie's series in the green, and at 1.55 um, where water absorbs") {
  const auto marshall_palmer = [](double rate) {
    return [slope = rain(rate, 1e-6).slope](double d) { return std::exp(-slope * d); };
  };
  for (const double rate : {1.0, 10.0}) {
    CAPTURE(rate);
    const Sphere green = spheres(0.1e-3, 6e-3, 1000, 0.532e-6, {1.3337, 1.5e-9}, marshall_palmer(rate));
    const Precipitation clear = rain(rate, 0.532e-6);
    CHECK(clear.extinction() / clear.backscatter() == relative(green.extinction / green.backscatter, 0.3));
    const Sphere infrared = spheres(0.1e-3, 6e-3, 1000, 1.55e-6, {1.3109, 1.336e-4}, marshall_palmer(rate));
    const Precipitation absorbing = rain(rate, 1.55e-6);
    CHECK(absorbing.extinction() / absorbing.backscatter() ==
          relative(infrared.extinction / infrared.backscatter, 0.3));
    CHECK(infrared.extinction / infrared.backscatter > 250);
  }
}

TEST_CASE(
    "one drop scatters back as by Mie's series at 1.55 um, from drizzle to drops that only their front reflects") {
  for (const double d : {0.1e-3, 0.2e-3, 0.5e-3, 1e-3, 2e-3}) {
    CAPTURE(d);
    const Sphere s = spheres(0.9 * d, 1.1 * d, 1000, 1.55e-6, {1.3109, 1.336e-4}, [](double) { return 1.0; });
    const Precipitation p = rain(1, 1.55e-6);
    const double ratio = extinction_cross_section(d) / p.backscatter_cross_section(d);
    CHECK(ratio == relative(s.extinction / s.backscatter, 0.4));
  }
  const double reflectance = std::pow((1.33 - 1) / (1.33 + 1), 2);  // Fresnel
  CHECK(rain(1, 1.55e-6).reflectance == relative(reflectance, 0.01));
}

TEST_CASE("snow is Sekhon and Srivastava's, of flakes with the area of their mass") {
  const Precipitation p = snow(2, 0.905e-6);
  const double flake = p.diameter_min / 0.1e-3;
  CHECK(flake == relative(3.97, 1e-3));
  CHECK(p.density * flake ==
        relative(2.5e3 * std::pow(2, -0.94) * 1e3, 1e-13));  // of melted diameters, 2500 R^-0.94 /(m^3 mm)
  CHECK(p.slope * flake == relative(22.9 * std::pow(2, -0.45) * 1e2, 1e-13));  // 22.9 R^-0.45 /cm
  const double melted = 2;                                                     // mm
  const double mass = pi / 6 * std::pow(melted, 3);                            // mg
  const double area = pi / 4 * std::pow(flake * melted, 2);                    // mm^2
  CHECK(mass == relative(0.012 * std::pow(area, 1.5), 1e-12));
  CHECK(p.extinction() / p.backscatter() == relative(33, 1e-12));
}

TEST_CASE("the means of precipitation in closed form are those of numerical integration") {
  for (const Precipitation& p : precipitations) {
    CAPTURE(p.density);
    REQUIRE_NOTHROW(p.validate());
    CHECK(p.number() == relative(quadrature(p, [](double) { return 1.0; }), 1e-9));
    CHECK(p.extinction() == relative(quadrature(p, [&](double d) { return extinction_cross_section(d); }), 1e-9));
    CHECK(p.backscatter() == relative(quadrature(p, [&](double d) { return p.backscatter_cross_section(d); }), 1e-9));
  }
}

TEST_CASE("precipitation as a medium is the mean of its particles") {
  for (const Precipitation& p : precipitations) {
    const Medium medium = p.medium();
    CHECK_NOTHROW(medium.validate());
    CHECK(medium.index == 1);
    CHECK(medium.delay() == 1);
    CHECK(medium.extinction() == p.extinction());
    CHECK(medium.backscatter == p.backscatter());
    double extinction_sum = 0;
    double backscatter_sum = 0;
    const int count = 100000;  // one drop of each equally likely stretch of diameters
    for (int i = 0; i < count; ++i) {
      const double d = p.diameter((i + 0.5) / count);
      extinction_sum += extinction_cross_section(d);
      backscatter_sum += p.backscatter_cross_section(d);
    }
    CHECK(medium.extinction() == relative(p.number() * extinction_sum / count, 1e-3));
    CHECK(medium.backscatter == relative(p.number() * backscatter_sum / count, 1e-3));
  }
}

TEST_CASE("a drop's backscatter without absorption is its extinction by the lidar ratio, whatever its front reflects") {
  for (const double reflectance : {0.0, 0.02, 1.0}) {
    const Precipitation p{.density = 1e6, .slope = 1e3, .lidar_ratio = 20, .reflectance = reflectance};
    for (const double d : {0.1e-3, 1e-3, 5e-3})
      CHECK(p.backscatter_cross_section(d) == relative(extinction_cross_section(d) / 20, 1e-14));
  }
  // a sphere that absorbs all that enters reflects as a mirror sphere of radius r: reflectance r^2 / 4
  const Precipitation black{.density = 1e6, .slope = 1e3, .lidar_ratio = 20, .absorption = 1e9, .reflectance = 0.02};
  CHECK(black.backscatter_cross_section(2e-3) == relative(0.02 * 1e-6 / 4, 1e-12));
}

TEST_CASE("the diameter of a uniform number is the inverse of the cumulative distribution") {
  for (const Precipitation& p : precipitations) {
    CHECK(p.diameter(0) == p.diameter_min);
    CHECK(p.diameter(1) == relative(p.diameter_max, 1e-12));
    CHECK(p.diameter(1) <= p.diameter_max);
    for (double u = 0.01; u < 1; u += 0.01) {
      const double d = p.diameter(u);
      REQUIRE(d > p.diameter_min);
      REQUIRE(d < p.diameter_max);
      Precipitation part = p;
      part.diameter_max = d;
      REQUIRE(part.number() == relative(u * p.number(), 1e-9));
    }
  }
}

TEST_CASE("weather out of range is refused by the name of its setting") {
  for (const double bad : {0.399e-6, 1.601e-6, 905.0, nan_value}) {
    CHECK(refused_field([&] { (void)fog(100, bad); }) == "fog (wavelength)");
    CHECK(refused_field([&] { (void)haze(5e3, bad); }) == "haze (wavelength)");
    CHECK(refused_field([&] { (void)dust(5e3, bad); }) == "dust (wavelength)");
    CHECK(refused_field([&] { (void)smoke(5e3, bad); }) == "smoke (wavelength)");
    CHECK(refused_field([&] { (void)rain(5, bad); }) == "rain (wavelength)");
  }
  for (const double bad : {0.99, 1000.1, -1.0, nan_value})
    CHECK(refused_field([&] { (void)fog(bad, 1e-6); }) == "fog (visibility)");
  for (const double bad : {999.0, 100001.0, nan_value})
    CHECK(refused_field([&] { (void)haze(bad, 1e-6); }) == "haze (visibility)");
  for (const double bad : {0.99, 100001.0, nan_value}) {
    CHECK(refused_field([&] { (void)dust(bad, 1e-6); }) == "dust (visibility)");
    CHECK(refused_field([&] { (void)smoke(bad, 1e-6); }) == "smoke (visibility)");
  }
  for (const double bad : {0.0, 0.09, 300.1, nan_value})
    CHECK(refused_field([&] { (void)rain(bad, 1e-6); }) == "rain (rate)");
  for (const double bad : {0.0, 0.09, 10.1, nan_value})
    CHECK(refused_field([&] { (void)snow(bad, 1e-6); }) == "snow (rate)");
  for (const double bad : {0.399e-6, 1.101e-6, 1.55e-6, nan_value})
    CHECK(refused_field([&] { (void)snow(1, bad); }) == "snow (wavelength)");
}

TEST_CASE("precipitation that cannot be is refused by the name of its setting") {
  const auto refused = [](const Precipitation& p) { return refused_field([&] { p.validate(); }); };
  CHECK(refused({}) == "");
  for (const double bad : {-1.0, nan_value, infinity}) {
    CHECK(refused({.density = bad}) == "Precipitation::density");
    CHECK(refused({.diameter_min = bad}) == "Precipitation::diameter_min");
    CHECK(refused({.absorption = bad}) == "Precipitation::absorption");
  }
  for (const double bad : {0.0, 0.9e-3, 1.1e9, -1.0, nan_value, infinity})
    CHECK(refused({.slope = bad}) == "Precipitation::slope");
  for (const double bad : {1e-4, 0.9e-4, nan_value, infinity})
    CHECK(refused({.diameter_max = bad}) == "Precipitation::diameter_max (above diameter_min)");
  for (const double bad : {0.99, -20.0, nan_value, infinity})
    CHECK(refused({.lidar_ratio = bad}) == "Precipitation::lidar_ratio");
  for (const double bad : {-0.01, 1.01, nan_value})
    CHECK(refused({.reflectance = bad}) == "Precipitation::reflectance");
  CHECK(refused({.lidar_ratio = 1000, .reflectance = 0.025}) == "");
  CHECK(refused({.lidar_ratio = 1000, .reflectance = 0.026}) ==
        "Precipitation::reflectance");  // more than all that comes back
}
