// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/leaf_angles.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "support/data_folder.hpp"
#include "support/file_errors.hpp"
#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::TemporaryFolder;

LeafAngles read(const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder / "g.txt", std::ios::binary) << text;
  return read_leaf_angles(folder / "g.txt");
}

FileError error(const std::string& text) {
  return support::file_error([&] { (void)read(text); });
}

std::string row(double zenith_deg, double g, double azimuth = 0) {
  const double zenith = radians(zenith_deg);
  char text[100];
  std::snprintf(text, sizeof text, "%.6f,%.6f,%.6f,%.6f\n", std::sin(zenith) * std::cos(azimuth),
                std::sin(zenith) * std::sin(azimuth), std::cos(zenith), g);
  return text;
}

/// Every `step` degrees from `from` to `to`, with G = 0.3 + 0.004 times the zenith angle in degrees.
std::string rows(int from, int to, int step) {
  std::string text;
  for (int zenith = from; zenith <= to; zenith += step) text += row(zenith, 0.3 + 0.004 * zenith);
  return text;
}

double g(const LeafAngles& leaves, double zenith_deg, double azimuth = 0) {
  const double zenith = radians(zenith_deg);
  return leaves.projection(
      {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)});
}

TEST_CASE("the table of spherical leaf angles is 1/2 everywhere, as the closed form") {
  const LeafAngles leaves = read_leaf_angles(support::data_folder / "spherical.txt");
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    const Vec3 direction = support::Generator(seed).unit();
    CHECK(leaves.projection(direction) == 0.5);
    CHECK(leaves.projection(direction) == LeafAngles::spherical().projection(direction));
  }
}

TEST_CASE("G is linear in the zenith angle between the rows, whatever their order, and alike in all azimuths") {
  for (const std::string& text : {rows(0, 90, 5), rows(50, 90, 5) + rows(0, 45, 5), "# x y z G\n" + rows(0, 90, 10)}) {
    const LeafAngles leaves = read(text);
    for (const double zenith : {0.0, 2.5, 40.0, 41.0, 89.0, 90.0, 120.0, 180.0})
      for (const double azimuth : {0.0, 1.0, 4.0}) {
        CAPTURE(zenith);
        CHECK(std::fabs(g(leaves, zenith, azimuth) - (0.3 + 0.004 * (zenith > 90 ? 180 - zenith : zenith))) < 2e-6);
      }
  }
}

TEST_CASE("directions of all azimuths and of both hemispheres make one table") {
  std::string text;
  for (int zenith = 0; zenith <= 180; zenith += 5)
    for (int azimuth = 0; azimuth < 6; ++azimuth)
      text += row(zenith, 0.3 + 0.004 * (zenith > 90 ? 180 - zenith : zenith), azimuth);
  CHECK(std::fabs(g(read(text), 37) - (0.3 + 0.004 * 37)) < 2e-6);
}

TEST_CASE("a table that depends on more than the zenith angle is refused, with both lines") {
  const FileError azimuth = error(rows(0, 90, 5) + row(45, 0.9, 2));
  CHECK(azimuth.place() == "line 20");
  CHECK(azimuth.problem() ==
        "differs in G from line 10, at the same zenith angle: expected one G for each zenith angle");
  CHECK(error(row(135, 0.1) + rows(0, 90, 5)).place() == "line 11");
}

TEST_CASE("a table with a hole is refused, and says where") {
  CHECK_NOTHROW((void)read(rows(10, 80, 10)));
  CHECK_NOTHROW((void)read(row(9.9999, 0.5) + rows(20, 70, 10) + row(80.0001, 0.5)));
  CHECK(error(rows(0, 30, 5) + rows(45, 90, 5)).problem() ==
        "has no row between 30 and 45 degrees from the vertical: expected one every 10 degrees at least");
  CHECK(error(rows(15, 90, 5)).problem().starts_with("has no row between 0 and 15 degrees"));
  CHECK(error(rows(0, 75, 5)).problem().starts_with("has no row between 75 and 90 degrees"));
  CHECK(error(row(45, 0.5)).problem().starts_with("has no row between 0 and 45 degrees"));
}

TEST_CASE("rows that cannot be right are refused, with line and column") {
  const std::string good = rows(0, 90, 5);
  CHECK(error("").problem() == "is empty: expected a table of leaf projections, x,y,z,G");
  CHECK(error("# nothing\n").problem() == "has no rows: expected a table of leaf projections, x,y,z,G");
  CHECK(error(good + "0,0,1\n").problem() == "has 3 columns: expected x, y, z and G");
  CHECK(error(good + "0,0,1\n").place() == "line 20");
  CHECK(error(good + "0,0,1,0.5,1\n").problem() == "has 5 columns: expected x, y, z and G");
  CHECK(error(good + "0,0,nan,0.5\n").place() == "line 20, column 3");
  CHECK(error(good + "0,0,1,nan\n").place() == "line 20, column 4");
  CHECK(error(good + "0,0,1,-0.1\n").problem() ==
        "'-0.1': expected G, the mean projection of unit leaf area, from 0 to 1");
  CHECK(error(good + "0,0,1,3.1416\n").place() == "line 20, column 4");
  CHECK(error(good + "2,0,0,0.5\n").problem() == "'2': expected a component of a unit direction, from -1 to 1");
  CHECK(error(good + "0,0,0.5,0.5\n").problem() == "the direction has the length 0.5: expected 1, within 1e-3");
  CHECK(error(good + "0,0,0,0.5\n").place() == "line 20");
  CHECK(error(good + "x,y,z,G\n").place() == "line 20, column 1");
}

}  // namespace
}  // namespace pulsecast::io
