// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/trajectory.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::TemporaryFolder;

/// Goes east at 2 m/s with a constant attitude.
struct East {
  Rotation rotation = no_rotation;
  [[nodiscard]] Pose<frame::Body, frame::World> at(Tick tick) const noexcept {
    return {rotation, {2 * tick.seconds(), 10, 100}};
  }
};
static_assert(Trajectory<East>);

std::string written(const TemporaryFolder& folder, const Trajectory auto& trajectory, Tick start, Tick duration,
                    double interval, TrajectoryFileSettings settings = {}) {
  TrajectoryWriter writer(folder / "trajectory.txt", settings);
  writer.add(trajectory, start, duration, interval);
  writer.close();
  return content(folder / "trajectory.txt");
}

std::string turned(const TemporaryFolder& folder, const Rotation& rotation) {
  return written(folder, East{rotation}, {}, {}, 1).substr(std::string("0.0000 10.0000 100.0000 0.000000000 ").size());
}

TEST_CASE("records stand at every interval and at the end, which is not written twice") {
  const TemporaryFolder folder;
  CHECK(written(folder, East{}, {}, {1, 0}, 0.5) ==
        "0.0000 10.0000 100.0000 0.000000000 0.0000 0.0000 0.0000\n"
        "1.0000 10.0000 100.0000 0.500000000 0.0000 0.0000 0.0000\n"
        "2.0000 10.0000 100.0000 1.000000000 0.0000 0.0000 0.0000\n");
  CHECK(written(folder, East{}, {100, 0.5}, {0, 0.75}, 0.5, {.start_time = 1000}) ==
        "0.0000 10.0000 100.0000 1100.500000000 0.0000 0.0000 0.0000\n"
        "1.0000 10.0000 100.0000 1101.000000000 0.0000 0.0000 0.0000\n"
        "1.5000 10.0000 100.0000 1101.250000000 0.0000 0.0000 0.0000\n");
  CHECK(written(folder, East{}, {}, {}, 0.5) == "0.0000 10.0000 100.0000 0.000000000 0.0000 0.0000 0.0000\n");
  for (const double interval : {0.1, 0.01, 0.3, 1.0 / 7}) {  // steps that no double holds exactly
    const std::string text = written(folder, East{}, {}, Tick::of_seconds(interval * 21), interval);
    CHECK(std::count(text.begin(), text.end(), '\n') == 22);
  }
  const std::string text =
      written(folder, East{}, {}, {0, 0.9}, 0.3);  // three times the double 0.3 is less than the double 0.9
  CHECK(std::count(text.begin(), text.end(), '\n') == 4);
}

TEST_CASE("legs stand one after the other in one file") {
  const TemporaryFolder folder;
  TrajectoryWriter writer(folder / "t.txt");
  writer.add(East{}, {}, {1, 0}, 1);
  writer.add(East{}, {1, 0.5}, {1, 0}, 1);
  writer.close();
  CHECK(content(folder / "t.txt") ==
        "0.0000 10.0000 100.0000 0.000000000 0.0000 0.0000 0.0000\n"
        "2.0000 10.0000 100.0000 1.000000000 0.0000 0.0000 0.0000\n"
        "0.0000 10.0000 100.0000 1.500000000 0.0000 0.0000 0.0000\n"
        "2.0000 10.0000 100.0000 2.500000000 0.0000 0.0000 0.0000\n");
}

TEST_CASE("yaw counts counter-clockwise from north, roll about x, pitch about y") {
  const TemporaryFolder folder;
  CHECK(turned(folder, rotation_about(axis::up, radians(90))) == "0.0000 0.0000 90.0000\n");    // heads west
  CHECK(turned(folder, rotation_about(axis::up, radians(-90))) == "0.0000 0.0000 270.0000\n");  // heads east
  CHECK(turned(folder, rotation_about(axis::right, radians(20))) == "20.0000 0.0000 0.0000\n");
  CHECK(turned(folder, rotation_about(axis::forward, radians(-20))) == "0.0000 -20.0000 0.0000\n");
  CHECK(turned(folder, rotation_about(axis::right, radians(10)) * rotation_about(axis::forward, radians(-20)) *
                           rotation_about(axis::up, radians(200))) == "10.0000 -20.0000 200.0000\n");
}

TEST_CASE("yaw stays below 360 as written, and no zero has a sign") {
  const TemporaryFolder folder;
  CHECK(turned(folder, rotation_about(axis::up, radians(-0.00001))) == "0.0000 0.0000 0.0000\n");
  CHECK(turned(folder, rotation_about(axis::up, radians(-0.00006))) == "0.0000 0.0000 359.9999\n");
  CHECK(turned(folder, rotation_about(axis::right, radians(-0.00001)) *
                           rotation_about(axis::forward, radians(-0.00001))) == "0.0000 0.0000 0.0000\n");
}

TEST_CASE("where roll and yaw are one turn, all of it is yaw") {
  const TemporaryFolder folder;
  CHECK(turned(folder, rotation_about(axis::forward, radians(90))) == "0.0000 90.0000 0.0000\n");
  CHECK(turned(folder, rotation_about(axis::forward, radians(-90)) * rotation_about(axis::up, radians(30))) ==
        "0.0000 -90.0000 30.0000\n");
  CHECK(turned(folder, rotation_about(axis::right, radians(30)) * rotation_about(axis::forward, radians(90))) ==
        "0.0000 90.0000 30.0000\n");
}

TEST_CASE("a pose that is no pose is an error, and impossible settings are refused") {
  const TemporaryFolder folder;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  {
    TrajectoryWriter writer(folder / "t.txt");
    CHECK_THROWS_AS(writer.add({}, {no_rotation, {0, nan, 0}}), FileError);
    CHECK_THROWS_AS(writer.close(), FileError);
    TrajectoryWriter other(folder / "t.txt");
    CHECK_THROWS_AS(other.add({}, {Rotation{nan, 0, 0, 0}, {}}), FileError);
    for (const double interval : {0.0, -1.0, nan}) {
      TrajectoryWriter third(folder / "t.txt");
      CHECK_THROWS_AS(third.add(East{}, {}, {1, 0}, interval), SettingError);
    }
    CHECK_THROWS_AS(TrajectoryWriter(folder / "t.txt", {.start_time = nan}), SettingError);
  }
  CHECK(folder.empty());
}

/// The angle between two attitudes [rad].
double apart(const Rotation& a, const Rotation& b) {
  const Rotation turn = conjugate(a) * b;
  return 2 * std::asin(std::min(1.0, length(Vec3{turn.x, turn.y, turn.z})));
}

/// Poses anywhere on Earth; of every four attitudes, one is at a pole of the convention and one is near to it.
std::vector<TimedPose> poses(std::uint64_t seed, const AngleConvention& convention) {
  support::Generator random(seed);
  std::vector<TimedPose> result;
  double time = 0;
  for (int i = 0; i < 40; ++i, time += random.log_uniform(0.5, 10)) {
    Rotation rotation = random.rotation();
    if (i % 2 == 1) {
      RollPitchYaw angles{random.uniform(-pi, pi), random.uniform(-pi, pi), random.uniform(-pi, pi)};
      angles.*convention.turns[1].angle =
          (random.coin() ? 1 : -1) * (pi / 2 - (i % 4 == 1 ? 0 : random.log_uniform(1e-17, 1)));
      rotation = rotation_of(angles, convention);
    }
    result.push_back({time, random.point(6e6), rotation});
  }
  return result;
}

TEST_CASE("a gap of more than 20 times the median interval gets a note, with its times") {
  const TemporaryFolder folder;
  const auto warnings = [&](const std::vector<double>& times, const TimeWindow& window = {}) {
    std::vector<TimedPose> written;
    for (const double time : times) written.push_back({time, {time, 0, 0}, no_rotation});
    write_trajectory(folder / "t.csv", written);
    return read_trajectory(folder / "t.csv", csv_format(), window).warnings;
  };
  CHECK(warnings({0, 1, 2, 3, 23}).empty());
  CHECK(warnings({0, 1, 100}).empty());  // too few for a median
  const std::vector<std::string> two = warnings({0, 1, 2, 3, 30, 31, 32, 33, 90, 91});
  REQUIRE(two.size() == 1);
  CHECK(two[0].find("t.csv: no pose between 33 s and 90 s, the longest of 2 gaps of more than 20 times the median") !=
        std::string::npos);
  CHECK(warnings({0, 1, 2, 3, 30, 31, 32, 33, 90, 91}, {4, 29}).empty());
  CHECK(warnings({0, 1, 2, 3, 30, 31, 32, 33, 90, 91}, {30, 33}).empty());
}

/// Warnings of rows of `time,x,y,z,roll,pitch,yaw`.
std::vector<std::string> notes(const std::string& rows, const TrajectoryFormat& format = csv_format()) {
  const TemporaryFolder folder;
  std::ofstream(folder / "t.csv", std::ios::binary) << "time,x,y,z,roll,pitch,yaw\n" << rows;
  return read_trajectory(folder / "t.csv", format).warnings;
}

TEST_CASE("times count on where those of a GPS week begin anew, with a note") {
  const TemporaryFolder folder;
  std::ofstream(folder / "t.csv") << "time,x,y,z,roll,pitch,yaw\n604799,0,0,0,0,0,0\n604799.5,1,0,0,0,0,0\n"
                                     "0,2,0,0,0,0,0\n0.5,3,0,0,0,0,0\n";
  const TrajectoryTable table = read_trajectory(folder / "t.csv");
  REQUIRE(table.poses.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(table.poses[i].time == 0.5 * static_cast<double>(i));
    CHECK(table.poses[i].position.x == static_cast<double>(i));
  }
  REQUIRE(table.warnings.size() == 1);
  CHECK(table.warnings[0].find("line 4: begins a GPS week, the first of 1: times count on, beyond 604800 s") !=
        std::string::npos);
  CHECK(notes("604799,0,0,0,0,0,0\n604801,1,0,0,0,0,0\n").empty());
  for (const char* unsorted : {"700000,0,0,0,0,0,0\n95201,1,0,0,0,0,0\n", "604799,0,0,0,0,0,0\n3601,1,0,0,0,0,0\n"}) {
    REQUIRE(notes(unsorted).size() == 1);
    CHECK(notes(unsorted)[0].find("is earlier than the previous pose") != std::string::npos);
  }
}

TEST_CASE("angles that fit the course as radians get a note, and those of a course near north do not") {
  const auto flight = [](double heading, double factor, double course) {
    std::string rows;
    for (int i = 0; i < 9; ++i) {
      const double way = 10 * i;
      std::ostringstream row;
      row << i << ',' << way * std::sin(course) << ',' << way * std::cos(course) << ",50,0.01,-0.02,"
          << heading * factor << '\n';
      rows += row.str();
    }
    return rows;
  };
  const double degree = degrees(1);
  for (const double heading : {0.5, 1.5, 3.1, -2.0}) {
    CAPTURE(heading);
    CHECK(notes(flight(heading, degree, heading)).empty());
    const std::vector<std::string> found = notes(flight(heading, 1, heading));
    REQUIRE(found.size() == 1);
    CHECK(found[0].find("given in radians? Name such columns roll_rad") != std::string::npos);
    TrajectoryFormat radian = csv_format();
    radian.angle_unit = AngleUnit::radian;
    CHECK(notes(flight(heading, 1, heading), radian).empty());
  }
  CHECK(notes(flight(0.02, degree, 0.02)).empty());
  CHECK(notes(flight(0.05, degree, 0.05)).empty());
  CHECK(notes(flight(0, 1, 1.5)).empty());  // no attitude in the file
}

TEST_CASE("poses that are a thousand seconds apart may be nanoseconds apart, which a note says") {
  const std::string rows = "0,0,0,0,0,0,0\n5000000,1,0,0,0,0,0\n10000000,2,0,0,0,0,0\n15000000,3,0,0,0,0,0\n";
  const std::vector<std::string> found = notes(rows + "20000000,4,0,0,0,0,0\n");
  REQUIRE(found.size() == 1);
  CHECK(found[0].find("name their column time_ns") != std::string::npos);
}

TEST_CASE("what is written is read: every format, convention, axis and separator") {
  const TemporaryFolder folder;
  std::vector<TrajectoryFormat> formats{csv_format(), helios_format(), helios_output_format(), tum_format()};
  for (const AngleConvention& angles :
       {heading_pitch_roll, helios_arinc_705, helios_canonical, mathematical, ros_roll_pitch_yaw})
    for (const TrajectoryFormat& format : {csv_format(), helios_format()}) {
      formats.push_back(format);
      formats.back().angles = angles;
      formats.back().columns = {"pitch", "x_mm", "roll", "time_ms", "y_km", "yaw", "z_m"};
      formats.back().angle_unit = formats.size() % 4 < 2 ? AngleUnit::degree : AngleUnit::radian;
    }
  for (const BodyAxes body : {BodyAxes::right_forward_up, BodyAxes::forward_right_down, BodyAxes::forward_left_up})
    for (const WorldAxes world : {WorldAxes::east_north_up, WorldAxes::north_east_down}) {
      formats.push_back(tum_format());
      formats.back().axes = {body, world};
      formats.push_back(csv_format());
      formats.back().axes = {body, world};
      formats.push_back(csv_format());
      formats.back().columns = {"time_s", "north_m", "east_m", "down_m", "qw", "qx", "qy", "qz"};
      formats.back().axes = {body, world};
    }
  for (const char separator : {';', '\t', ' '}) {
    formats.push_back(csv_format());
    formats.back().separator = separator;
  }
  double worst = 0;
  for (std::size_t k = 0; k < formats.size(); ++k) {
    CAPTURE(k);
    const std::vector<TimedPose> written = poses(k, formats[k].angles);
    write_trajectory(folder / "t.txt", written, formats[k], 1000);
    const TrajectoryTable table = read_trajectory(folder / "t.txt", formats[k]);
    CHECK(table.warnings.empty());
    CHECK(table.start_time == 1000);
    REQUIRE(table.poses.size() == written.size());
    for (std::size_t i = 0; i < written.size(); ++i) {
      CAPTURE(i);
      CHECK(std::fabs(table.poses[i].time - written[i].time) < 1e-12);
      CHECK(max_norm(table.poses[i].position - written[i].position) < 2e-9);
      worst = std::max(worst, apart(table.poses[i].rotation, written[i].rotation));
    }
    CHECK(worst < 1e-12);
  }
  MESSAGE("furthest apart [rad]: ", worst);
}

TEST_CASE("metres and seconds come back to the last digit") {
  const TemporaryFolder folder;
  for (const TrajectoryFormat& format : {csv_format(), helios_format(), tum_format()}) {
    const std::vector<TimedPose> written = poses(7, format.angles);
    write_trajectory(folder / "t.txt", written, format);
    const TrajectoryTable table = read_trajectory(folder / "t.txt", format);
    for (std::size_t i = 0; i < written.size(); ++i) {
      CHECK(table.poses[i].time == written[i].time);
      CHECK(table.poses[i].position == written[i].position);
    }
  }
}

TEST_CASE("a written trajectory looks like its format") {
  const TemporaryFolder folder;
  const std::vector<TimedPose> east{{0, {476200, 5474300.5, 600}, rotation_about(-axis::up, radians(90))},
                                    {0.5, {476230, 5474300.5, 600}, no_rotation}};
  const auto text = [&](const TrajectoryFormat& format) {
    write_trajectory(folder / "t.txt", east, format, 10);
    return content(folder / "t.txt");
  };
  CHECK(text(csv_format()) ==
        "time_s,x_m,y_m,z_m,roll_deg,pitch_deg,heading_deg\n10,476200,5474300.5,600,0,0,90\n10.5,476230,5474300.5,600,"
        "0,0,0\n");
  CHECK(text(helios_format()) ==
        "#TIME_COLUMN: 0\n#HEADER: \"t\", \"roll\", \"pitch\", \"yaw\", \"x\", \"y\", \"z\"\n"
        "10,0,0,90,476200,5474300.5,600\n10.5,0,0,0,476230,5474300.5,600\n");
  const std::vector<TimedPose> west{{0, {}, rotation_about(axis::up, radians(90))}};
  write_trajectory(folder / "t.txt", west, helios_output_format());
  CHECK(content(folder / "t.txt") == "0 0 0 0 0 0 90\n");
  write_trajectory(folder / "t.txt", west, {.columns = {"t", "x", "y", "z", "heading"}});
  CHECK(content(folder / "t.txt") == "t,x,y,z,heading\n0,0,0,0,270\n");
  CHECK(text(tum_format()).starts_with("10 476200 5474300.5 600 "));
}

TEST_CASE("ground truth at ticks is written for TUM in axes of robots, by the clock") {
  const TemporaryFolder folder;
  const std::vector<Tick> ticks{{0, 0}, {0, 0.5}, {2, 0.25}};
  write_trajectory(folder / "t.txt", timed_poses(East{level(pi / 2)}, ticks), tum_format(), 1000);
  std::istringstream found(content(folder / "t.txt"));
  for (const Tick& tick : ticks)
    for (const double expected : {1000 + tick.seconds(), 2 * tick.seconds(), 10.0, 100.0, 0.0, 0.0, 0.0, 1.0}) {
      double number = 0;
      REQUIRE(static_cast<bool>(found >> number));
      CHECK(std::fabs(number - expected) < 1e-12);
    }
}

TEST_CASE("a jump, and a rotation of single precision, are written and read") {
  const TemporaryFolder folder;
  const Rotation rounded{0.6F, 0, 0, 0.8F};
  const std::vector<TimedPose> jump{
      {0, {}, rounded}, {1, axis::right, rounded}, {1, axis::up, no_rotation}, {2, {}, no_rotation}};
  write_trajectory(folder / "t.txt", jump, tum_format(), 5);
  const TrajectoryTable table = read_trajectory(folder / "t.txt", tum_format());
  REQUIRE(table.poses.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(table.poses[k].time == jump[k].time);
    CHECK(table.poses[k].position == jump[k].position);
    CHECK(apart(table.poses[k].rotation, jump[k].rotation) < 1e-7);
  }
  CHECK_THROWS_AS(
      write_trajectory(folder / "t.txt", std::vector<TimedPose>{{0, {}}, {1e-9, axis::right}}, csv_format(), 1e10),
      FileError);
}

TEST_CASE("what could not be read back is not written, and no file is left") {
  const TemporaryFolder folder;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<TimedPose>& bad :
       std::vector<std::vector<TimedPose>>{{},
                                           {{nan, {}, no_rotation}},
                                           {{0, {0, nan, 0}, no_rotation}},
                                           {{0, {0, 2e12, 0}, no_rotation}},
                                           {{0, {}, Rotation{2, 0, 0, 0}}},
                                           {{0, {}, Rotation{nan, 0, 0, 0}}},
                                           {{1, {}, no_rotation}, {0, {}, no_rotation}}})
    CHECK_THROWS_AS(write_trajectory(folder / "t.txt", bad), FileError);
  const std::vector<TimedPose> good{{0, {}, no_rotation}};
  TrajectoryFormat format;
  format.columns = {"t"};
  CHECK_THROWS_AS(write_trajectory(folder / "t.txt", good, format), SettingError);
  CHECK_THROWS_AS(write_trajectory(folder / "t.txt", good, csv_format(), nan), SettingError);
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::io
