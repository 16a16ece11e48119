// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/leaf_angles.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

static_assert(std::is_copy_constructible_v<LeafAngles>);

namespace {

Vec3 at_zenith(double zenith) { return {std::sin(zenith), 0, std::cos(zenith)}; }

using Density = double (*)(double);
struct Named {
  const char* name;
  LeafAngles leaves;
  Density density;
};

/// de Wit's six, with the densities that they are made from.
std::vector<Named> six() {
  return {{"spherical", LeafAngles::spherical(), [](double t) { return std::sin(t); }},
          {"uniform", LeafAngles::uniform(), [](double) { return 2 / pi; }},
          {"planophile", LeafAngles::planophile(), [](double t) { return 2 / pi * (1 + std::cos(2 * t)); }},
          {"erectophile", LeafAngles::erectophile(), [](double t) { return 2 / pi * (1 - std::cos(2 * t)); }},
          {"plagiophile", LeafAngles::plagiophile(), [](double t) { return 2 / pi * (1 - std::cos(4 * t)); }},
          {"extremophile", LeafAngles::extremophile(), [](double t) { return 2 / pi * (1 + std::cos(4 * t)); }}};
}

/// G by its definition, without any closed form: leaves of all inclinations and azimuths, seen from the direction.
double by_definition(Density density, double zenith) {
  const int inclinations = 2000, azimuths = 2000;
  double sum = 0;
  for (int i = 0; i < inclinations; ++i) {
    const double t = pi / 2 * (i + 0.5) / inclinations;
    double facing = 0;
    for (int j = 0; j < azimuths; ++j) {
      const double azimuth = pi * (j + 0.5) / azimuths;
      facing += std::fabs(std::cos(zenith) * std::cos(t) + std::sin(zenith) * std::sin(t) * std::cos(azimuth));
    }
    sum += density(t) * facing / azimuths;
  }
  return sum * pi / 2 / inclinations;
}

/// Mean over the sphere of directions, by Simpson's rule.
double mean(const LeafAngles& leaves) {
  const int n = 20000;
  double sum = 0;
  for (int i = 0; i <= n; ++i) {
    const double zenith = pi / 2 * i / n;
    sum += (i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2) * leaves.projection(at_zenith(zenith)) * std::sin(zenith);
  }
  return sum * pi / 2 / n / 3;
}

std::string refusal(std::vector<LeafProjection> entries) {
  try {
    return std::to_string(LeafAngles::table(std::move(entries)).memory());
  } catch (const SettingError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("G has its closed values along the vertical and the horizontal") {
  struct Value {
    LeafAngles leaves;
    double vertical, horizontal;
  };
  // the integrals of density times cos t, and of density times 2/pi sin t
  const Value values[] = {{LeafAngles::spherical(), 0.5, 0.5},
                          {LeafAngles::uniform(), 2 / pi, 4 / (pi * pi)},
                          {LeafAngles::planophile(), 8 / (3 * pi), 8 / (3 * pi * pi)},
                          {LeafAngles::erectophile(), 4 / (3 * pi), 16 / (3 * pi * pi)},
                          {LeafAngles::plagiophile(), 32 / (15 * pi), 64 / (15 * pi * pi)},
                          {LeafAngles::extremophile(), 28 / (15 * pi), 56 / (15 * pi * pi)},
                          {LeafAngles::ellipsoidal(1), 0.5, 0.5}};
  for (const Value& value : values) {
    CHECK(std::fabs(value.leaves.projection(axis::up) - value.vertical) < 1e-12);
    CHECK(std::fabs(value.leaves.projection(axis::right) - value.horizontal) < 1e-12);
  }
}

TEST_CASE("G of six distributions is the integral over their leaves to 1e-6") {
  for (const Named& named : six()) {
    CAPTURE(named.name);
    for (const double zenith : {0.0003, 0.2, 0.7, 1.1, 1.5705}) {
      CAPTURE(zenith);
      CHECK(std::fabs(named.leaves.projection(at_zenith(zenith)) - by_definition(named.density, zenith)) < 1e-6);
    }
  }
}

TEST_CASE("however leaves stand, G has the mean 1/2 over all directions") {
  for (const Named& named : six()) {
    CAPTURE(named.name);
    CHECK(std::fabs(mean(named.leaves) - 0.5) < 3e-7);
  }
  for (const double chi : {0.01, 0.3, 0.999, 1.0, 1.001, 2.5, 20.0}) {
    CAPTURE(chi);
    CHECK(std::fabs(mean(LeafAngles::ellipsoidal(chi)) - 0.5) < 1e-7);
  }
}

TEST_CASE("ellipsoidal leaves agree with the fit of Campbell's, and reach their limits") {
  for (const double chi : {0.1, 0.5, 1.0, 1.7, 3.0, 10.0}) {
    const double fit = chi + 1.774 * std::pow(chi + 1.182, -0.733);  // Source: Campbell 1986
    const LeafAngles leaves = LeafAngles::ellipsoidal(chi);
    for (const double zenith : {0.0, 0.4, 1.0, 1.5}) {
      const double expected = std::hypot(chi * std::cos(zenith), std::sin(zenith)) / fit;
      CHECK(std::fabs(leaves.projection(at_zenith(zenith)) / expected - 1) < 0.015);
    }
  }
  CHECK(std::fabs(LeafAngles::ellipsoidal(1e-6).projection(axis::right) - 2 / pi) < 1e-5);
  CHECK(std::fabs(LeafAngles::ellipsoidal(1e6).projection(axis::up) - 1) < 1e-5);
  CHECK(std::fabs(LeafAngles::ellipsoidal(1 + 1e-12).projection(axis::up) - 0.5) < 1e-9);
  CHECK_THROWS_AS((void)LeafAngles::ellipsoidal(0), SettingError);
  CHECK_THROWS_AS((void)LeafAngles::ellipsoidal(std::nan("")), SettingError);
}

TEST_CASE("G depends on neither length, nor azimuth, nor sense of the direction") {
  Generator random(401);
  const LeafAngles all[] = {LeafAngles::planophile(), LeafAngles::ellipsoidal(3)};
  for (int i = 0; i < 1000; ++i) {
    const Vec3 d = random.unit();
    const Vec3 other = rotation_about(axis::up, random.uniform(0, 6)) * (d * (random.coin() ? -1.0 : 1.0)) *
                       random.log_uniform(1e-3, 1e3);
    for (const LeafAngles& leaves : all) CHECK(std::fabs(leaves.projection(d) - leaves.projection(other)) < 1e-12);
  }
}

TEST_CASE("a table is read in any order, linearly in between") {
  std::vector<LeafProjection> entries;
  for (int i = 18; i >= 0; --i) entries.push_back({i * pi / 36, 0.9 - 0.03 * i});
  const LeafAngles leaves = LeafAngles::table(entries);
  CHECK(std::fabs(leaves.projection(axis::up) - 0.9) < 1e-15);
  CHECK(std::fabs(leaves.projection(-axis::up) - 0.9) < 1e-15);
  CHECK(std::fabs(leaves.projection(axis::right) - 0.36) < 1e-15);
  for (const double zenith : {0.0, 0.01, 0.5, 1.2, 1.55})
    CHECK(std::fabs(leaves.projection(at_zenith(zenith)) - (0.9 - 0.03 * zenith * 36 / pi)) < 1e-12);
  std::vector<LeafProjection> inner(entries.begin() + 1, entries.end() - 1);
  CHECK(std::fabs(LeafAngles::table(inner).projection(axis::up) - 0.87) < 1e-15);
  CHECK(std::fabs(LeafAngles::table(inner).projection(axis::right) - 0.39) < 1e-15);
}

TEST_CASE("a table with a hole, a repeated angle or an impossible number is refused") {
  std::vector<LeafProjection> whole;
  for (int i = 0; i <= 9; ++i) whole.push_back({i * pi / 18, 0.5});
  CHECK(refusal(whole) == "160");
  const auto with = [&](auto change) {
    auto entries = whole;
    change(entries);
    return refusal(entries);
  };
  const std::string hole = "rad, but must be followed by another within 0.1745 rad";
  CHECK(with([](auto& e) { e.clear(); }).find(hole) != std::string::npos);
  CHECK(with([](auto& e) { e.erase(e.begin() + 4); }).find(hole) != std::string::npos);
  CHECK(with([](auto& e) { e = std::vector<LeafProjection>(e.begin() + 2, e.end()); }).find("zenith is 0 " + hole) !=
        std::string::npos);
  CHECK(with([](auto& e) { e.resize(8); }).find(hole) != std::string::npos);
  CHECK(with([](auto& e) { e.push_back(e[4]); }).find("unique") != std::string::npos);
  CHECK(with([](auto& e) { e[3].zenith = -0.1; }).find("LeafProjection::zenith is -0.1 rad") != std::string::npos);
  CHECK(with([](auto& e) { e[3].zenith = 1.6; }).find("LeafProjection::zenith is 1.6 rad") != std::string::npos);
  CHECK(with([](auto& e) { e[3].g = 1.01; }) == "LeafProjection::g is 1.01, but must be from 0 to 1");
  CHECK(with([](auto& e) { e[3].g = std::nan(""); }).find("LeafProjection::g is nan") != std::string::npos);
}

TEST_CASE("leaves send back as their mean squared cosine by their mean cosine, of any density") {
  for (const Named& named : six()) {
    CAPTURE(named.name);
    for (const double zenith : {0.0, 0.3, pi / 4, 1.2, pi / 2}) {
      constexpr int inclinations = 1000, azimuths = 1000;
      double first = 0, second = 0;
      for (int i = 0; i < inclinations; ++i) {
        const double t = pi / 2 * (i + 0.5) / inclinations;
        for (int j = 0; j < azimuths; ++j) {
          const double azimuth = pi * (j + 0.5) / azimuths;
          const double cosine = std::cos(zenith) * std::cos(t) + std::sin(zenith) * std::sin(t) * std::cos(azimuth);
          first += named.density(t) * std::fabs(cosine);
          second += named.density(t) * cosine * cosine;
        }
      }
      CAPTURE(zenith);
      CHECK(named.leaves.incidence_cosine(at_zenith(zenith)) == doctest::Approx(second / first).epsilon(1e-4));
      CHECK(named.leaves.incidence_cosine(-7.0 * at_zenith(zenith)) ==
            named.leaves.incidence_cosine(7.0 * at_zenith(zenith)));
    }
  }
  CHECK(LeafAngles::spherical().incidence_cosine(axis::up) == doctest::Approx(2.0 / 3).epsilon(1e-12));
}

TEST_CASE("leaves that are all level or all upright send back as those do") {
  // Source: of level ones G and its mean square are cos and cos^2; of upright ones (2/pi) sin and sin^2 / 2
  for (const double zenith : {0.2, 0.7, 1.3}) {
    CHECK(LeafAngles::ellipsoidal(1e5).incidence_cosine(at_zenith(zenith)) ==
          doctest::Approx(std::cos(zenith)).epsilon(2e-3));
    CHECK(LeafAngles::ellipsoidal(1e-5).incidence_cosine(at_zenith(zenith)) ==
          doctest::Approx(pi / 4 * std::sin(zenith)).epsilon(2e-3));
  }
  // G of spherical leaves as a table
  CHECK(LeafAngles::table({{0, 0.5},
                           {0.15, 0.5},
                           {0.3, 0.5},
                           {0.45, 0.5},
                           {0.6, 0.5},
                           {0.75, 0.5},
                           {0.9, 0.5},
                           {1.05, 0.5},
                           {1.2, 0.5},
                           {1.35, 0.5},
                           {1.5, 0.5}})
            .incidence_cosine(axis::right) == doctest::Approx(2.0 / 3).epsilon(1e-6));
}
