// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/trajectory/table.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/data_folder.hpp"
#include "support/file_errors.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::contains;
using support::TemporaryFolder;

TrajectoryTable read(const std::string& text, const TrajectoryFormat& format = csv_format(),
                     const TimeWindow& window = {}) {
  static const TemporaryFolder folder;
  std::filesystem::remove(folder / "t.csv");
  std::ofstream(folder / "t.csv", std::ios::binary) << text;
  return read_trajectory(folder / "t.csv", format, window);
}

FileError error(const std::string& text, const TrajectoryFormat& format = csv_format(), const TimeWindow& window = {}) {
  return support::file_error([&] { (void)read(text, format, window); });
}

bool same(const Rotation& a, const Rotation& b, double allowed = 1e-14) {
  return max_norm(a * axis::forward - b * axis::forward) < allowed && max_norm(a * axis::up - b * axis::up) < allowed;
}

const std::string head = "time_s,x_m,y_m,z_m,roll_deg,pitch_deg,heading_deg\n";

/// Map whose units are degrees, turned by 30 degrees.
MapPoint turned(double longitude, double latitude) {
  if (latitude > 80) throw FileError("map", "", "has no place there: expected less");
  return {{1000 * longitude, 2000 * latitude}, radians(30)};
}

TEST_CASE("a longitude and a latitude are projected, heights kept, and true north becomes grid north") {
  TrajectoryFormat format = csv_format();
  format.projector = turned;
  const TrajectoryTable table = read(
      "time_s,latitude_deg,longitude_deg,height_m,roll_deg,pitch_deg,heading_deg\n1,50.5,9.25,120.5,3,4,40\n", format);
  CHECK(max_norm(table.poses[0].position - Vec3{9250, 101'000, 120.5}) < 1e-9);
  const TrajectoryTable expected =
      read(head + "1,0,0,0,3,4,70\n");  // the grid's north is 30 degrees before the true one
  CHECK(same(table.poses[0].rotation, expected.poses[0].rotation));
  CHECK(table.warnings.empty());
  format.angle_unit = AngleUnit::radian;
  const TrajectoryTable in_radians = read("time,lon,lat,altitude,heading\n1,0.1,0.2,7,0\n", format);
  CHECK(max_norm(in_radians.poses[0].position - Vec3{1000 * degrees(0.1), 2000 * degrees(0.2), 7}) < 1e-9);
}

TEST_CASE("degrees without a map, beyond it, or beside metres are refused or left out") {
  const std::string degrees = "time_s,lat,lon,height\n1,50,9,100\n2,85,9,100\n";
  CHECK(contains(error(degrees).what(), "line 2: has a longitude and a latitude: expected east and north"));
  TrajectoryFormat format = csv_format();
  format.projector = turned;
  CHECK(contains(error(degrees, format).what(), "line 3: cannot be projected: map: has no place there"));
  CHECK(contains(error("time_s,lat,height\n1,50,100\n", format).what(), "do not define one position"));
  CHECK(contains(error("time_s,lat,east,height\n1,50,1,100\n", format).what(), "do not define one position"));
  CHECK(contains(error("time_s,lat,lon,x,y,z\n1,50,9,1,2,3\n", format).what(), "do not define one position"));
  format.more_columns = true;
  const TrajectoryTable metres = read("time_s,lat,lon,east,north,height\n1,50,9,1,2,3\n", format);
  CHECK(metres.poses[0].position == Vec3{1, 2, 3});
  CHECK(contains(metres.warnings.at(0), "unknown columns are left out: 'lat', 'lon'"));
}

TEST_CASE("a table with named columns is read as it stands") {
  const TrajectoryTable table = read(head + "10,1,2,3,0,0,90\n10.5,1.5,-2,1e2,0,20,0\n");
  CHECK(table.warnings.empty());
  CHECK(table.start_time == 10);
  REQUIRE(table.poses.size() == 2);
  CHECK(table.poses[0].time == 0);
  CHECK(table.poses[0].position == Vec3{1, 2, 3});
  CHECK(same(table.poses[0].rotation, rotation_about(-axis::up, radians(90))));
  CHECK(table.poses[1].time == 0.5);
  CHECK(table.poses[1].position == Vec3{1.5, -2, 100});
  CHECK(same(table.poses[1].rotation, rotation_about(axis::right, radians(20))));
}

TEST_CASE("the order of columns, the separator, the units and the line ends do not matter") {
  const TrajectoryTable expected = read(head + "1,477000.25,5429000,200,3,-4,275\n2,477001,5429001,201,4,-3,276\n");
  for (const std::string& text : {
           std::string("heading_deg;z_m;y_m;x_m;time_s;pitch_deg;roll_deg\n275;200;5429000;477000.25;1;-4;3\n276;201;"
                       "5429001;477001;2;-3;4\n"),
           std::string(
               "# by hand\r\nTime "
               "[ms]\tEasting\tNorthing\tHeight\troll\tpitch\tyaw\r\n\r\n1000\t477000.25\t5429000\t200\t3\t-4\t275\r\n"
               "# between\r\n2000\t477001\t5429001\t201\t4\t-3\t276\r\n"),
           std::string(
               "  t north_km  east_mm down_m  roll_deg pitch_deg heading_deg\n 1 5429 477000250 -200  3 -4 275\n"
               "2  5429.001 477001000 -201   4 -3 276\n"),
       }) {
    CAPTURE(text);
    const TrajectoryTable table = read(text);
    CHECK(table.warnings.empty());
    CHECK(table.start_time == 1);
    REQUIRE(table.poses.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(max_norm(table.poses[i].position - expected.poses[i].position) < 1e-8);
      CHECK(same(table.poses[i].rotation, expected.poses[i].rotation));
    }
  }
  const TrajectoryTable radian = read("time_s,x,y,z,roll_rad,pitch_rad,heading_rad\n1,0,0,0,0.1,0.2,0.3\n");
  CHECK(same(radian.poses[0].rotation, rotation_of({0.1, 0.2, 0.3}, heading_pitch_roll)));
}

TEST_CASE("what was read is what Waypoints take") {
  const Waypoints flight(read(head + "100,0,0,50,0,0,350\n102,0,20,50,0,0,10\n").poses);
  const auto pose = flight.at({1, 0});
  CHECK(max_norm(pose.position - Vec3{0, 10, 50}) < 1e-12);
  CHECK(same(pose.rotation, no_rotation));  // across north, not around
  CHECK(flight.duration() == Tick{2, 0});
}

TEST_CASE("a convention of angles and of axes is heeded") {
  TrajectoryFormat format = csv_format();
  format.angles = ros_roll_pitch_yaw;
  CHECK(same(read(head + "0,1,2,3,0,0,90\n", format).poses[0].rotation, no_rotation));
  format.axes = {BodyAxes::forward_right_down, WorldAxes::north_east_down};
  CHECK(read(head + "0,1,2,3,0,0,90\n", format).poses[0].position == Vec3{2, 1, -3});
  format.columns = {"t", "x", "y", "z", "qx", "qy", "qz", "qw"};
  CHECK(same(read("t,x,y,z,qx,qy,qz,qw\n0,1,2,3,0,0,0,1\n", format).poses[0].rotation, no_rotation));
  // 90 degrees about down: heads east
  CHECK(same(read("t,x,y,z,qx,qy,qz,qw\n0,1,2,3,0,0,0.7071067811865476,0.7071067811865476\n", format).poses[0].rotation,
             rotation_about(axis::up, radians(-90))));
}

TEST_CASE("names and the place of the time may stand in comments") {
  const std::filesystem::path data = support::data_folder / "flight.trj";
  const TrajectoryTable table = read_trajectory(data, helios_format());
  CHECK(table.warnings.empty());
  CHECK(table.start_time == 0);
  REQUIRE(table.poses.size() == 6);
  CHECK(table.poses[1].time == 0.2);
  CHECK(table.poses[1].position == Vec3{476212, 5474301.1993, 600.5960});
  const Rotation expected = rotation_about(-axis::up, radians(270.4992)) *
                            rotation_about(axis::forward, radians(0.596)) *
                            rotation_about(axis::right, radians(1.9804));
  CHECK(same(table.poses[1].rotation, expected));
  TrajectoryFormat other = helios_format();
  other.angles = helios_canonical;
  const Rotation canonical = rotation_about(axis::right, radians(0.596)) *
                             rotation_about(axis::forward, radians(1.9804)) *
                             rotation_about(axis::up, radians(270.4992));
  CHECK(same(read_trajectory(data, other).poses[1].rotation, canonical));
}

TEST_CASE("comments that say less leave the usual order, and those that contradict it are heeded or refused") {
  const TrajectoryTable expected = read("0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n", helios_format());
  CHECK(expected.poses[0].position == Vec3{4, 5, 6});
  for (const char* text :
       {"#TIME_COLUMN: 3\n1,2,3,0,4,5,6\n1,2,3,1,4,5,6\n",
        "# by hand\n#HEADER: \"x\", \"y\",\"z\" , \"roll\", \"t\", \"pitch\", \"yaw\"\n4,5,6,1,0,2,3\n4,5,6,1,1,2,3\n",
        "#HEADER: \"clock\",\"x\",\"y\",\"z\",\"roll\",\"pitch\",\"yaw\"\n#TIME_COLUMN: "
        "0\n0,4,5,6,1,2,3\n1,4,5,6,1,2,3\n"}) {
    CAPTURE(text);
    const TrajectoryTable table = read(text, helios_format());
    REQUIRE(table.poses.size() == 2);
    CHECK(table.poses[1].time == 1);
    CHECK(table.poses[0].position == Vec3{4, 5, 6});
    CHECK(same(table.poses[0].rotation, expected.poses[0].rotation));
  }
  CHECK(contains(error("#TIME_COLUMN: 7\n1,2,3,4,5,6,7\n", helios_format()).problem(),
                 "expected the index, from 0, of one of"));
  CHECK(error("#TIME_COLUMN: two\n1,2,3,4,5,6,7\n", helios_format()).place() == "line 1");
  CHECK(error("0,1,2,3,4,5\n", helios_format()).problem() == "has 6 columns: expected 7");
  CHECK(error("#HEADER: \"t\",\"x\",\"y\",\"z\",\"roll\",\"quality\",\"roll\"\n0,1,2,3,4,5,6\n", helios_format())
            .place() == "line 2, column 7");
  TrajectoryFormat radian = helios_format();
  radian.angle_unit = AngleUnit::radian;
  CHECK(same(read("0,0.1,0.2,0.3,4,5,6\n", radian).poses[0].rotation, rotation_of({0.1, 0.2, 0.3}, helios_arinc_705)));
}

TEST_CASE("a first line of names counts without its #, and is no row where columns are agreed") {
  const TrajectoryTable expected = read("0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n", helios_format());
  const TrajectoryTable named =
      read("Time [s];easting;northing;height;roll;pitch;heading\n0;4;5;6;1;2;3\n1;4;5;6;1;2;3\n", helios_format());
  REQUIRE(named.poses.size() == 2);
  CHECK(named.poses[1].position == Vec3{4, 5, 6});
  CHECK(same(named.poses[1].rotation, expected.poses[1].rotation));
  TrajectoryFormat agreed = helios_format();
  agreed.names = ColumnNames::nowhere;
  CHECK(read("when,r,p,y,e,n,h\n0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n", agreed).poses.size() == 2);
  CHECK(contains(error("when,x,y,z\n0,1,2,3\n", helios_format()).problem(), "no column is the time"));
  CHECK(error("0,1,2,3,4,5,6\nt,roll,pitch,yaw,x,y,z\n", helios_format()).place() == "line 2, column 1");
}

TEST_CASE("time, position and quaternion of a robot: its x is forward") {
  const TrajectoryTable table = read(
      "# timestamp tx ty tz qx qy qz qw\n1305031102.1758 1.5 2.5 3.5 0 0 0 1\n1305031103 0 0 0 0 0 0.7071067811865476 "
      "0.7071067811865476\n",
      tum_format());
  CHECK(table.warnings.empty());
  CHECK(table.start_time == 1305031102.1758);
  REQUIRE(table.poses.size() == 2);
  CHECK(table.poses[0].position == Vec3{1.5, 2.5, 3.5});
  CHECK(max_norm(table.poses[0].rotation * axis::forward - axis::right) < 1e-14);  // along the world's x, which is east
  CHECK(max_norm(table.poses[1].rotation * axis::forward - axis::forward) < 1e-14);
  CHECK(table.poses[1].time == doctest::Approx(0.8242).epsilon(1e-6));
}

TEST_CASE(
    "a quaternion is made a unit, silently if six decimals explain it, with a warning up to 1/1000, and refused "
    "beyond") {
  CHECK(read("0 0 0 0 0 0 0.707107 0.707107\n", tum_format()).warnings.empty());
  const TrajectoryTable table = read("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1.0009\n2 0 0 0 0 0 0 0.9995\n", tum_format());
  REQUIRE(table.warnings.size() == 1);
  CHECK(contains(table.warnings[0], "line 2: has a quaternion that is not unit, the first of 2"));
  CHECK(length(table.poses[1].rotation) == doctest::Approx(1).epsilon(1e-15));
  for (const char* q : {"0 0 0 1.0011", "0 0 0 0", "0 0 0 0.99", "1e11 0 0 0"}) {
    CAPTURE(q);
    CHECK(error(std::string("0 0 0 0 ") + q + "\n", tum_format()).place() == "line 1");
  }
}

TEST_CASE("poses out of order are sorted, and those that stand twice count once") {
  const TrajectoryTable table = read(head + "3,3,0,0,0,0,0\n1,1,0,0,0,0,0\n2,2,0,0,0,0,0\n2,2,0,0,0,0,0\n");
  REQUIRE(table.poses.size() == 3);
  CHECK(table.start_time == 1);
  for (std::size_t i = 0; i < 3; ++i) CHECK(table.poses[i].position.x == 1 + table.poses[i].time);
  REQUIRE(table.warnings.size() == 2);
  CHECK(contains(table.warnings[0], "line 3: is earlier than the previous pose, the first of 1"));
  CHECK(contains(table.warnings[1], "line 5: repeats a pose"));
}

TEST_CASE(
    "poses at one time are a jump: a window that ends there ends before it, and one that begins there begins after "
    "it") {
  const std::string text =
      head + "10,0,0,0,0,0,0\n12,20,0,0,0,0,0\n12,99,0,0,0,0,0\n12,50,0,0,0,0,0\n14,70,0,0,0,0,0\n";
  const TrajectoryTable whole = read(text);
  REQUIRE(whole.poses.size() == 5);
  REQUIRE(whole.warnings.size() == 1);
  CHECK(contains(
      whole.warnings[0],
      "t.csv, line 4: repeats the time of the previous pose at another pose, the first of 2: a jump of the platform"));
  const Waypoints path(whole.poses);
  CHECK(path.at(Tick::of_seconds(1.999)).position.x == doctest::Approx(19.99));
  CHECK(path.at({2, 0}).position.x == 50);
  struct Part {
    TimeWindow window;
    double first, last;
    std::size_t poses, warnings;
  };
  for (const Part& part :
       {Part{{.end = 12}, 0, 20, 2, 0}, Part{{.start = 12}, 50, 70, 2, 0}, Part{{.start = 12, .end = 12}, 50, 50, 1, 0},
        Part{{.start = 11, .end = 13}, 10, 60, 5, 1}, Part{{.start = 11, .end = 12}, 10, 20, 2, 0}}) {
    const TrajectoryTable table = read(text, csv_format(), part.window);
    REQUIRE(table.poses.size() == part.poses);
    CHECK(table.poses.front().position.x == doctest::Approx(part.first));
    CHECK(table.poses.back().position.x == doctest::Approx(part.last));
    CHECK(table.warnings.size() == part.warnings);
  }
  const TrajectoryTable ends = read(head + "1,1,0,0,0,0,0\n1,2,0,0,0,0,0\n3,4,0,0,0,0,0\n3,5,0,0,0,0,0\n");
  REQUIRE(ends.poses.size() == 2);
  CHECK(ends.poses[0].position.x == 2);
  CHECK(ends.poses[1].position.x == 4);
  CHECK(ends.warnings.empty());
}

TEST_CASE("poses closer than a microsecond are as good as others, and what a number cannot tell apart is a jump") {
  const TrajectoryTable close =
      read(head + "100,0,0,0,0,0,0\n101,1,0,0,0,0,0\n101.0000001,2,0,0,0,0,0\n102,3,0,0,0,0,0\n");
  CHECK(close.warnings.empty());
  CHECK(Waypoints(close.poses).at(Tick::of_seconds(1.00000005)).position.x == doctest::Approx(1.5));
  const TrajectoryTable far = read(head + "-1e12,1,2,3,0,0,0\n1e-9,1,2,3,0,0,0\n2e-9,5,2,3,0,0,0\n1,5,2,3,0,0,0\n");
  CHECK(Waypoints(far.poses).at(Tick::of_seconds(1e12)).position.x == 5);
}

TEST_CASE("a window begins and ends at its times") {
  const std::string text = head + "10,0,0,0,0,0,0\n11,10,0,0,0,0,20\n12,20,0,0,0,0,40\n13,30,0,0,0,0,60\n";
  const TrajectoryTable table = read(text, csv_format(), {.start = 10.25, .end = 12.5});
  CHECK(table.warnings.empty());
  CHECK(table.start_time == 10.25);
  REQUIRE(table.poses.size() == 4);
  const std::array<double, 4> times{0, 0.75, 1.75, 2.25};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(table.poses[i].time == times[i]);
    const double passed = 0.25 + times[i];
    CHECK(table.poses[i].position.x == doctest::Approx(10 * passed));
    CHECK(same(table.poses[i].rotation, rotation_about(-axis::up, radians(20 * passed)), 1e-12));
  }
  CHECK(read(text, csv_format(), {.start = 11, .end = 12}).poses.size() == 2);
  CHECK(read(text, csv_format(), {.start = 11.5, .end = 11.5}).poses.size() == 1);
  CHECK(read(text, csv_format(), {.start = 12}).poses.size() == 2);
  CHECK(read(text, csv_format(), {.end = 10}).poses.size() == 1);
  const TrajectoryTable wide = read(text, csv_format(), {.start = 0, .end = 99});
  CHECK(wide.poses.size() == 4);
  CHECK(wide.warnings.size() == 2);
  CHECK(contains(error(text, csv_format(), {.start = 14}).problem(),
                 "has poses from 10 s to 13 s: expected some from 14 s"));
  CHECK_THROWS_AS(read(text, csv_format(), {.start = 12, .end = 11}), SettingError);
  CHECK_THROWS_AS(read(text, csv_format(), {.start = NAN}), SettingError);
}

TEST_CASE("one pose is a trajectory, and angles that no column gives are 0, with a warning") {
  const TrajectoryTable table = read("time_s,x,y,z,heading_deg\n7,1,2,3,90");
  REQUIRE(table.poses.size() == 1);
  CHECK(same(table.poses[0].rotation, rotation_about(-axis::up, radians(90))));
  REQUIRE(table.warnings.size() == 3);
  CHECK(contains(table.warnings[0], "line 2: has no line end"));
  CHECK(contains(table.warnings[1], "no column for the roll"));
}

TEST_CASE("what cannot be right is told with its place, and what was expected") {
  struct Case {
    std::string text;
    const char* place;
    const char* problem;
  };
  for (const Case& c : {
           Case{"", "", "is empty: expected a trajectory"},
           {"\n \n", "", "holds no pose"},
           {head, "", "holds no pose"},
           {"0,1,2,3,4,5,6\n", "line 1", "expected the names of the columns"},
           {"0,1,2\n", "line 1", "expected the names of the columns"},
           {"time_s,x_m,y_m,z_m,rol_deg\n", "line 1, column 5",
            "'rol_deg' is not a known column: did you mean 'roll_deg'"},
           {"time_s,x_m,y_m\n", "line 1", "do not define one position"},
           {head + "0,1,2,3,4,5,6\n1,2,3\n", "line 3", "has 3 columns: expected 7"},
           {head + "0,1,2,3,4,5,6,7\n", "line 2", "has 8 columns: expected 7"},
           {head + "0,1,2,3,4,five,6\n", "line 2, column 6", "'five' in column pitch_deg: expected a finite number"},
           {head + "0,1,2,nan,4,5,6\n", "line 2, column 4", "'nan' in column z_m"},
           {head + "0,1,2,,4,5,6\n", "line 2, column 4", "'' in column z_m"},
           {head + "0,1,2,1e13,4,5,6\n", "line 2, column 4", "within 1e12"},
           {"time_s;x;y;z;yaw\n0;1,5;2;3;4\n", "line 2, column 2", "with a decimal point"},
       }) {
    CAPTURE(c.text);
    const FileError e = error(c.text);
    CHECK(e.place() == c.place);
    CHECK_MESSAGE(contains(e.problem(), c.problem), e.problem());
  }
  CHECK_THROWS_WITH_AS((void)read_trajectory("no/such.csv"), doctest::Contains("no/such.csv: does not exist"),
                       FileError);
  CHECK(error("0 0 0 0 0 0 1\n", tum_format()).problem() == "has 7 columns: expected 8");
}

TEST_CASE("numbers have a sign, a point and an exponent, and nothing else") {
  for (const char* cell : {"+2", "2.", "0.2e1", "200e-2"}) {
    CAPTURE(cell);
    CHECK(read(head + "0," + cell + ",.5,-0,0,0,0\n").poses.at(0).position == Vec3{2, 0.5, 0});
  }
  for (const char* cell : {"-inf", "1.5x", "0x10", "1e", "1e999", "--1", "+-1", "++1", "1 1", "e5", "."}) {
    CAPTURE(cell);
    CHECK(error(head + "0," + cell + ",2,3,4,5,6\n").place() == "line 2, column 2");
  }
  const std::string longest(80, 'x');  // of a long cell, an error shows the beginning
  CHECK(contains(error(head + "0," + longest + ",2,3,4,5,6\n").problem(), "'" + longest + "' in column x_m"));
  CHECK(contains(error(head + "0," + longest + "x,2,3,4,5,6\n").problem(), "'" + longest + "...' in column x_m"));
  CHECK(contains(error(head + "0,1,2\x01,3,4,5,6\n").problem(), "binary data"));
}

TEST_CASE("names that no column has, units of something else, and columns that make no pose are refused") {
  for (const char* name : {"_", "tim", "x_deg", "roll_m", "qw_m", "roll_grad", "xyz", "\xC2\xB0"}) {
    CAPTURE(name);
    CHECK(error("t,x,y,z," + std::string(name) + "\n0,1,2,3,4\n").place() == "line 1, column 5");
  }
  CHECK(error("t,x,y,z,heading,yaw\n0,1,2,3,4,5\n").place() == "line 1, column 6");
  for (const char* names : {"x,y,z", "t,x,y", "t,east,north", "t,east,north,up,down", "t,x,y,z,up", "t,x,y,z,qx,qy,qz",
                            "t,x,y,z,qx,qy,qz,qw,roll"}) {
    CAPTURE(names);
    CHECK(error(names + std::string("\n")).place() == "line 1");
  }
  CHECK(read("timestamp_ns,\"Easting (m)\",NORTHING [mm],height_km,PITCH_RAD\n1e9,2,3,4,0.5\n").start_time == 1);
}

TEST_CASE("impossible formats are refused") {
  const auto refused = [](auto change) {
    TrajectoryFormat format;
    change(format);
    CHECK_THROWS_AS(format.validate(), SettingError);
  };
  refused([](TrajectoryFormat& f) { f.separator = '.'; });
  refused([](TrajectoryFormat& f) { f.angles.turns[0].axis = axis::right; });
  refused([](TrajectoryFormat& f) { f.columns = {"t"}; });
  for (const char* name : {"rol_deg", "roll,deg", "roll;deg", "#roll_deg", "roll\n_deg", "\"roll_deg\""}) {
    CAPTURE(name);
    refused([&](TrajectoryFormat& f) { f.columns[4] = name; });
  }
  refused([](TrajectoryFormat& f) {
    f.columns[4] = "Roll [deg]";
    f.separator = ' ';
  });
  TrajectoryFormat format;
  format.columns[4] = "rol_deg";
  format.left_out = {"rol_deg"};
  format.columns[5] = "Roll [deg]";
  CHECK_NOTHROW(format.validate());
}

TEST_CASE("columns that are no matter may be left out by name") {
  TrajectoryFormat format;
  format.left_out = {"Satellites", "qx"};
  const TrajectoryTable table = read("time_s,satellites,x,y,z,roll,pitch,yaw,qx\n0,many,1,2,3,0,0,0,nan\n", format);
  CHECK(table.warnings.empty());
  CHECK(table.poses[0].position == Vec3{1, 2, 3});
}

TEST_CASE("a name that ends in height is a height, and columns that were not understood are told") {
  const std::string row = "\n400000,1,2,50,0,0,90\n";
  for (const char* name : {"ELLIPSOID HEIGHT", "Ellipsoid Height (m)", "orthometric_height"}) {
    CAPTURE(name);
    const auto table =
        read("TIME,EASTING,NORTHING," + std::string(name) + ",ROLL,PITCH,HEADING" + row, helios_format());
    CHECK(table.warnings.empty());
    REQUIRE(table.poses.size() == 1);
    CHECK(table.poses[0].position == Vec3{1, 2, 50});
  }
  CHECK(error("TIME,EASTING,NORTHING,H-GEO,ROLL,PITCH,HEADING" + row, helios_format())
            .problem()
            .ends_with("up or down; not understood: 'H-GEO'; a survey may give columns by number, as with zIndex"));
  CHECK(
      contains(error("TIME,EASTING,NORTHING,ELLIPSOID HEIGHT (ft),ROLL,PITCH,HEADING" + row, helios_format()).problem(),
               "'ELLIPSOID HEIGHT (ft)': expected metres"));
  CHECK(contains(error("t,east,north,ellipsoid height,height,x" + row).problem(), "duplicates column 4"));
}

TEST_CASE(
    "further columns do not count where the file or the format says which ones are which, if the format allows for "
    "them") {
  const std::string named = "#HEADER: \"t\", \"quality\", \"roll\", \"pitch\", \"yaw\", \"x\", \"y\", \"z\"\n";
  const TrajectoryTable table = read(named + "7,good,1,2,3,4,5,6,more,and more\n", helios_format());
  REQUIRE(table.poses.size() == 1);
  CHECK(table.poses[0].position == Vec3{4, 5, 6});
  REQUIRE(table.warnings.size() == 2);
  CHECK(contains(table.warnings[0], "unknown columns are left out: 'quality'"));
  CHECK(contains(table.warnings[1], "line 2: has more columns than names, the first of 1: the last ones are left out"));
  CHECK(read(named + "7,good,1,2,3,4,5,6,\n", helios_format()).warnings.size() == 1);  // an end is no column
  CHECK(contains(error(named + "7,good,1,2,3,4,5\n", helios_format()).problem(), "has 7 columns: expected 8"));
  CHECK(contains(error("0,1,2,3,4,5,6,7\n", helios_format()).problem(), "has 8 columns: expected 7"));  // which ones?
  TrajectoryFormat format = helios_format();
  format.names = ColumnNames::nowhere;
  CHECK(read("7,1,2,3,4,5,6,more\n", format).warnings.empty());
  format.more_columns = false;
  CHECK(contains(error("7,1,2,3,4,5,6,more\n", format).problem(), "has 8 columns: expected 7"));
  CHECK(contains(error(named + "7,good,1,2,3,4,5,6\n",
                       [] {
                         TrajectoryFormat strict = helios_format();
                         strict.more_columns = false;
                         return strict;
                       }())
                     .problem(),
                 "'quality' is not a known column"));
}

TEST_CASE("a separator is found, unless it is fixed") {
  TrajectoryFormat format = helios_format();
  const std::string text =
      "#HEADER: \"t\", \"roll\", \"pitch\", \"yaw\", \"x\", \"y\", \"z\"\n0,1,2,3,4,5,6,fixed;float\n";
  CHECK(contains(error(text, format).problem(), "has 2 columns: expected 7"));
  format.fixed_separator = true;
  CHECK(read(text, format).poses.at(0).position == Vec3{4, 5, 6});
  format.separator = ';';
  CHECK(read("0;1;2;3;4;5;6\n", format).poses.at(0).position == Vec3{4, 5, 6});
  CHECK(contains(error("0,1,2,3,4,5,6\n", format).problem(), "has 1 columns: expected 7"));
}

TEST_CASE("longitudes and latitudes that are radians get a note") {
  TrajectoryFormat format = csv_format();
  format.projector = [](double east, double north) { return MapPoint{{east, north}, 0}; };
  const std::string names = "time,longitude,latitude,height,roll,pitch,yaw\n";
  CHECK(contains(read(names + "1,0.157,0.8464,300,0,0,0\n", format).warnings.at(0), "given in radians? Name such"));
  CHECK(read(names + "1,9,48.5,300,0,0,0\n", format).warnings.empty());
}

}  // namespace
}  // namespace pulsecast::io
