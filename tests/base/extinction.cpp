// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/extinction.hpp>

#include <cmath>
#include <initializer_list>
#include <limits>

#include <doctest/doctest.h>

#include "support/relative.hpp"

using namespace pulsecast;

TEST_CASE("the extinction of haze and fog is Kim's, without jumps") {
  for (const double wavelength : {0.532e-6, 1.064e-6, 1.55e-6})
    for (const double edge : {500.0, 1000.0, 6000.0})
      CHECK(extinction(wavelength, edge * (1 - 1e-12)) ==
            support::relative(extinction(wavelength, edge * (1 + 1e-12)), 1e-10));
  CHECK(extinction(1.55e-6, 200) == support::relative(3.91 / 200, 1e-14));  // fog: of any wavelength
  CHECK(extinction(0.532e-6, 200) == extinction(1.55e-6, 200));
  CHECK(extinction(1.064e-6, 2e3) == support::relative(3.91 / 2e3 * std::pow(1.064 / 0.55, -0.66), 1e-14));
  CHECK(extinction(1.064e-6, 23e3) == extinction(1.064e-6, 23e3, AerosolModel::kruse));
}

TEST_CASE("models of extinction say where they hold") {
  CHECK(extinction_is_valid(1.55e-6, 23e3, AerosolModel::kruse));
  CHECK(extinction_is_valid(1.55e-6, 500, AerosolModel::kim));
  CHECK_FALSE(extinction_is_valid(1.55e-6, 500, AerosolModel::kruse));
  CHECK_FALSE(extinction_is_valid(10.6e-6, 23e3, AerosolModel::kim));
  CHECK_FALSE(extinction_is_valid(0.3e-6, 23e3, AerosolModel::kim));
  CHECK(extinction_is_valid(10.6e-6, std::numeric_limits<double>::infinity(), AerosolModel::kim));
}

TEST_CASE("the extinction of the air is Kruse's, by hand for each of its three stretches") {
  CHECK(extinction(1.064e-6, 23e3) == support::relative(7.20935317364042e-05, 1e-14));   // q = 1.3
  CHECK(extinction(1.55e-6, 60e3) == support::relative(1.2418670181727339e-05, 1e-14));  // q = 1.6
  CHECK(extinction(0.532e-6, 2e3, AerosolModel::kruse) ==
        support::relative(0.0020035397746925934, 1e-14));  // q = 0.585 V^(1/3)
  CHECK(extinction(0.55e-6, 10e3) ==
        support::relative(3.91e-4, 1e-14));  // at 0.55 um, the definition of visibility itself
}
