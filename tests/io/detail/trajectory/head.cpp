// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/trajectory/head.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/trajectory.hpp>

#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::contains;
using support::TemporaryFolder;

TrajectoryTable read(const std::string& text, const TrajectoryFormat& format = helios_format()) {
  static const TemporaryFolder folder;
  std::filesystem::remove(folder / "t.txt");
  std::ofstream(folder / "t.txt", std::ios::binary) << text;
  return read_trajectory(folder / "t.txt", format);
}

FileError error(const std::string& text, const TrajectoryFormat& format = helios_format()) {
  return support::file_error([&] { (void)read(text, format); });
}

bool same(const TimedPose& a, const TimedPose& b) {
  return max_norm(a.position - b.position) < 1e-9 &&
         max_norm(a.rotation * axis::forward - b.rotation * axis::forward) < 1e-12 &&
         max_norm(a.rotation * axis::up - b.rotation * axis::up) < 1e-12;
}

std::string line(const std::vector<std::string>& cells) {
  std::string all;
  for (const std::string& cell : cells) all += (all.empty() ? "" : ",") + cell;
  return all + "\n";
}

/// Reads a column of a name in place of another one, and checks that the pose and the start are the same.
std::vector<std::string> renamed(std::vector<std::string> names, std::size_t place, std::string_view name) {
  const bool has_quaternion = names.size() == 8;
  const std::string row = has_quaternion ? "7,1,2,3,0,0.6,0,0.8\n" : "7,1,2,3,10,20,30\n";
  const TrajectoryTable expected = read(line(names) + row);
  names[place] = name;
  const TrajectoryTable table = read(line(names) + row);
  CHECK(table.start_time == expected.start_time);
  CHECK(same(table.poses[0], expected.poses[0]));
  return table.warnings;
}

const std::vector<std::string> xyz{"time", "x", "y", "z", "roll", "pitch", "yaw"},
    up{"time", "east", "north", "up", "roll", "pitch", "yaw"},
    quaternion{"time", "x", "y", "z", "qx", "qy", "qz", "qw"};

TEST_CASE("each rule of trajectories has a file that is read, noted or refused") {
  std::vector<test::FormatCase> cases;
  const std::array<std::pair<const std::vector<std::string>*, std::size_t>, 15> places{{{&xyz, 0},
                                                                                        {&xyz, 1},
                                                                                        {&xyz, 2},
                                                                                        {&xyz, 3},
                                                                                        {&up, 1},
                                                                                        {&up, 2},
                                                                                        {&up, 3},
                                                                                        {&up, 3},
                                                                                        {&xyz, 4},
                                                                                        {&xyz, 5},
                                                                                        {&xyz, 6},
                                                                                        {&quaternion, 4},
                                                                                        {&quaternion, 5},
                                                                                        {&quaternion, 6},
                                                                                        {&quaternion, 7}}};
  for (std::size_t i = 0; i < detail::column_rules.size(); ++i) {
    const std::string_view row = detail::column_rules[i].name;
    if (row == "down" || i >= places.size()) continue;
    cases.push_back({row, [row, place = places[i]] {
                       std::vector<std::string> all;
                       for (std::string_view left = row; !left.empty();)
                         for (const std::string& warning : renamed(*place.first, place.second, text::take_word(left)))
                           all.push_back(warning);
                       return all;
                     }});
  }
  cases.push_back({"down", [] {
                     const TrajectoryTable table = read("time,east,north,down,roll,pitch,yaw\n0,1,2,3,0,0,0\n");
                     CHECK(table.poses[0].position == Vec3{1, 2, -3});
                     return table.warnings;
                   }});
  for (const char* const name : {"longitude lon", "latitude lat"})
    cases.push_back(
        {name, [] {
           TrajectoryFormat format = csv_format();
           format.projector = [](double longitude, double latitude) { return MapPoint{{10 * longitude, latitude}, 0}; };
           const TrajectoryTable table = read("time,longitude,latitude,up,roll,pitch,yaw\n0,1,2,3,0,0,0\n", format);
           CHECK(max_norm(table.poses[0].position - Vec3{10, 2, 3}) < 1e-9);
           return table.warnings;
         }});
  for (const detail::Unit& unit : detail::units)
    cases.push_back({unit.rule.name, [unit] {
                       std::vector<std::string> names = xyz;
                       const bool is_time = unit.dimension == detail::Dimension::time,
                                  is_length = unit.dimension == detail::Dimension::length;
                       names[is_time ? 0 : is_length ? 1 : 6] += " " + std::string(unit.rule.name);
                       const TrajectoryTable table = read(line(names) + "9,9,2,3,0,0,1\n");
                       const TrajectoryTable si = read("time,x,y,z,roll,pitch,yaw_rad\n9,9,2,3,0,0,1\n");
                       CHECK(table.start_time * (is_time ? unit.per_si : 1) == doctest::Approx(9));
                       CHECK(table.poses[0].position.x * (is_length ? unit.per_si : 1) == doctest::Approx(9));
                       if (unit.rule.name == "[rad]")
                         CHECK(same(table.poses[0], si.poses[0]));
                       else
                         CHECK_FALSE(same(table.poses[0], si.poses[0]));
                       return table.warnings;
                     }});
  const auto of_unit = [](const char* name, std::size_t place) {
    return [=] {
      std::vector<std::string> names = xyz;
      names[place] += std::string(" (") + name + ")";
      return read(line(names) + "7,1,2,3,10,20,30\n").warnings;
    };
  };
  cases.push_back({"[f*", of_unit("ft", 3)});
  cases.push_back({"[us*", of_unit("US ft", 3)});
  const auto named = [](const char* name, std::size_t place) {
    return [=] {
      std::vector<std::string> names = xyz;
      names[place] = name;
      return read(line(names) + "7,1,2,3,10,20,30\n").warnings;
    };
  };
  cases.push_back({"lat*", named("Latitude (dms)", 1)});
  cases.push_back({"lon*", named("lon_dms", 2)});
  cases.push_back({"omega*", named("Omega (deg)", 4)});
  cases.push_back({"phi*", named("phi", 5)});
  cases.push_back({"kappa*", named("kappa", 6)});
  cases.push_back({"roll*", named("roll_angle", 4)});
  cases.push_back({"pitch*", named("pitch_m", 5)});
  cases.push_back({"yaw*", named("yaw_angle", 6)});
  cases.push_back({"heading*", named("heading true", 6)});
  cases.push_back({"azimuth*", named("Azimuth", 6)});
  cases.push_back({"#HEADER:", [] {
                     const auto table =
                         read("#HEADER: \"x\",\"y\",\"z\",\"t\",\"roll\",\"pitch\",\"yaw\"\n1,2,3,7,0,0,0\n");
                     CHECK(table.start_time == 7);
                     CHECK(table.poses[0].position == Vec3{1, 2, 3});
                     return table.warnings;
                   }});
  cases.push_back({"#TIME_COLUMN:", [] {
                     const TrajectoryTable table = read("#TIME_COLUMN: 6\n0,0,0,1,2,3,7\n");
                     CHECK(table.start_time == 7);
                     CHECK(table.poses[0].position == Vec3{1, 2, 3});
                     return table.warnings;
                   }});
  cases.push_back(
      {"*", [] { return read("t,x,y,z,roll,pitch,yaw,Latitude,roll_rate\n7,1,2,3,0,0,0,48,9\n").warnings; }});
  test::check_rules(detail::trajectory_rules, cases);
}

TEST_CASE("the files of inertial processors are read by their names and units, after their preamble") {
  const TimedPose expected = read("400000,3,4,90,477000.25,5429000.5,310.25\n").poses[0];
  const std::string row =
      "400000.000 477000.25 5429000.5 310.25 3 4 90 1\n400000.005 477000.5 5429000.5 310.25 3 4 90 1\n";
  for (const std::string& text :
       {"Project:     yard\nProgram: Inertial Processor, Version 9.0\nEpochs: 2\nDatum: ETRS89, processed in 3 (km)\n\n"
        "   GPSTime    Easting   Northing    H-Ell    Roll   Pitch  Heading Q\n"
        "     (sec)        (m)        (m)      (m)   (deg)   (deg)    (deg)\n" +
            row,
        "GPSTime Easting Northing H-MSL Roll Pitch Heading Q\r\n[s] [m] [m] [m] [deg] [deg] [deg] []\r\n" + row,
        "GPSTime Easting Northing H-Ell Roll Pitch Heading Q\nsec m m m deg deg deg\n" + row}) {
    CAPTURE(text);
    const TrajectoryTable table = read(text);
    REQUIRE(table.poses.size() == 2);
    CHECK(table.start_time == 400000);
    CHECK(same(table.poses[0], expected));
    REQUIRE(table.warnings.size() == 1);
    CHECK(contains(table.warnings[0], "unknown columns are left out: 'Q'"));
  }
  const std::string navigation = "TIME,DISTANCE,EASTING,NORTHING,ELLIPSOID HEIGHT,ROLL,PITCH,HEADING\n";
  for (const std::string units : {"(SEC),(M),(M),(M),(M),(DEG),(DEG),(DEG)\n", ""}) {
    const TrajectoryTable table = read(navigation + units + "400000,0,477000.25,5429000.5,310.25,3,4,90\n");
    CHECK(same(table.poses[0], expected));
    CHECK(contains(table.warnings[0], "'DISTANCE'"));
  }
  const std::string radians_row =
      "GPSTime Easting Northing H-Ell Roll Pitch Heading\n(sec) (m) (m) (m) (rad) (rad) (rad)\n";
  CHECK(same(read(radians_row + "0 1 2 3 0.1 0.2 1.5\n").poses[0],
             read("time,x,y,z,roll_rad,pitch_rad,yaw_rad\n0,1,2,3,0.1,0.2,1.5\n").poses[0]));
  const FileError feet = error(
      "GPSTime Easting Northing H-Ell Roll Pitch Heading\n(sec) (ft) (ft) (ft) (deg) (deg) (deg)\n0 1 2 3 4 5 6\n");
  CHECK(feet.place() == "line 2, column 2");
  CHECK(contains(feet.problem(), "'Easting (ft)': expected metres"));
}

TEST_CASE("names in a comment count if they define a pose, as in EuRoC's files") {
  const std::string row =
      "1403636579758555392,4.5,-1.75,0.5,0.8,0,0.6,0\n1403636579763555584,4.5,-1.75,0.5,0.8,0,0.6,0\n";
  const TrajectoryTable table = read(
      "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n" + row);
  CHECK(table.warnings.empty());
  CHECK(table.start_time == doctest::Approx(1403636579.758555392).epsilon(1e-15));
  REQUIRE(table.poses.size() == 2);
  CHECK(table.poses[1].time == doctest::Approx(0.005).epsilon(1e-4));
  CHECK(same(table.poses[0], {0, {4.5, -1.75, 0.5}, rotation_about(axis::forward, 2 * std::asin(0.6))}));
  const TrajectoryTable benchmark = read("# ground truth\n# timestamp tx ty tz qx qy qz qw\n7 1 2 3 0 0.6 0 0.8\n");
  CHECK(same(benchmark.poses[0], {0, {1, 2, 3}, rotation_about(axis::forward, 2 * std::asin(0.6))}));
  CHECK(read("# t, x\n0,1,2,3,4,5,6\n").poses[0].position == Vec3{4, 5, 6});
  CHECK(contains(error("timestamp,x,y,z,roll,pitch,yaw\n" + row).problem(), "nanoseconds in a column named time_ns"));
}

TEST_CASE("names in a comment that are in another order than those of the format are refused") {
  const std::string row = "7 1 2 3 0 0.6 0 0.8\n";
  CHECK(read("# timestamp tx ty tz qx qy qz qw\n" + row, tum_format()).poses.size() == 1);
  CHECK(contains(error("# timestamp tx ty tz qw qx qy qz\n" + row, tum_format()).problem(),
                 "'qz': expected 'qw', by the order"));
  CHECK(read("# of the time x as it was driven\n" + row, tum_format()).poses.size() == 1);
  CHECK(
      contains(error("# time, easting, northing, h_ell, omega, phi, kappa\n0,1,2,3,4,5,6\n", helios_format()).problem(),
               "'h_ell': expected 'yaw'"));
}

TEST_CASE("keys of comments may be in any case, after blanks") {
  for (const char* key : {"#HEADER:", "# HEADER:", "#header:"})
    CHECK(read(key + std::string(" t,x,y,z,roll,pitch,yaw\n0,1,2,3,4,5,6\n"), helios_format()).poses[0].position ==
          Vec3{1, 2, 3});
}

TEST_CASE("of several lines before the rows, the one most like names is blamed") {
  const FileError wrong = error("by hand\nt,x,y,height_of,roll,pitch,yaw\nthe end\n0,1,2,3,4,5,6\n");
  CHECK(wrong.place() == "line 2");
  CHECK(contains(wrong.problem(), "not understood: 'height_of'"));
  CHECK(error("by hand\n").place() == "line 1");
}

TEST_CASE("damaged heads and rows of trajectories are explained, or read") {
  const std::string head = "GPSTime Easting Northing H-Ell Roll Pitch Heading\n", rows = "0 1 2 3 4 5 6\n";
  std::string wide = "t,x,y,z,roll,pitch,yaw";
  std::string many = "0,1,2,3,4,5,6";
  for (int i = 0; i < 500'000; ++i) {
    wide += ",c";
    many += ",7";
  }
  std::vector<std::string> damaged{"",
                                   "\n",
                                   " ",
                                   "#",
                                   "#\n",
                                   "##\n#HEADER\n",
                                   "#HEADER:\n",
                                   "#HEADER: ,,,\n0,1,2\n",
                                   "#HEADER: \"\"\n0\n",
                                   "#TIME_COLUMN:\n0,1,2,3,4,5,6\n",
                                   "#TIME_COLUMN: -1\n",
                                   "#TIME_COLUMN: 1e3\n0\n",
                                   "#TIME_COLUMN: nan\n",
                                   head,
                                   head + "(sec)\n",
                                   head + "(sec)\n(m)\n",
                                   head + "(sec) (m) (m) (m) (deg) (deg) (deg) (m)\n" + rows,
                                   head + "() () () () () () ()\n" + rows,
                                   head + "[ [ [ [ [ [ [\n" + rows,
                                   head + "(m) (m) (m) (m) (deg) (deg) (deg)\n" + rows,
                                   head + head + rows,
                                   head + "0 1 2 3 4 5\n",
                                   head + "0 1 2 3 4 5 6 7 8\n",
                                   head + "nan 1 2 3 4 5 6\n",
                                   head + "0 1 2 inf 4 5 6\n",
                                   head + "1e300 1 2 3 4 5 6\n",
                                   head + "1e13 1 2 3 4 5 6\n",
                                   head + "0 1e13 2 3 4 5 6\n",
                                   head + "5 1 2 3 4 5 6\n4 1 2 3 4 5 6\n-3 1 2 3 4 5 6\n",
                                   "\xEF\xBB\xBF" + head + rows,
                                   "\xFF\xFE" + head + rows,
                                   head + rows + "0 1",
                                   head + std::string("0 1 2\0 3", 8),
                                   "t;;;;;;\n0;1;2;3;4;5;6\n",
                                   ",,,,,,\n0,1,2,3,4,5,6\n",
                                   "time,x,y,z,roll,pitch,yaw,,\n0,1,2,3,4,5,6,,\n",
                                   "\"\",\"\"\n",
                                   "(sec) (m)\n" + rows,
                                   wide + "\n" + many + "\n",
                                   "# " + wide + "\n" + many + "\n",
                                   many + "\n",
                                   std::string(1'000'000, '#') + "\n" + rows,
                                   std::string(1'000'000, 'x') + "\n" + rows,
                                   "time,x,y,z,roll,pitch,yaw\r0,1,2,3,4,5,6\r",
                                   "604800,0,0,0,1,2,3\n0,0,0,0,1,2,3\n604800,0,0,0,1,2,3\n0,0,0,0,1,2,3\n"};
  std::string preamble;
  for (int i = 0; i < 100'000; ++i) preamble += "no row\n";
  damaged.push_back(preamble + rows);
  std::size_t explained = 0;
  for (std::size_t i = 0; i < damaged.size(); ++i)
    for (const TrajectoryFormat& format : {helios_format(), csv_format(), helios_output_format(), tum_format()}) {
      CAPTURE(i);
      try {
        for (const TimedPose& pose : read(damaged[i], format).poses) CHECK((finite(pose.position) && pose.time >= 0));
      } catch (const FileError& problem) {
        ++explained;
        CAPTURE(problem.problem().substr(0, 200));
        CHECK(problem.problem().size() > 20);
      }
    }
  CHECK(damaged.size() >= 40);
  CHECK(explained > 100);
}

}  // namespace
}  // namespace pulsecast::io
