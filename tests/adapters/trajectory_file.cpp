// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/adapters/trajectory_file.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::adapters {
namespace {

using support::content;
using support::TemporaryFolder;

/// Goes east at 2 m/s with a constant attitude.
struct East {
  Rotation rotation = no_rotation;
  [[nodiscard]] Pose<frame::Body, frame::World> at(Tick tick) const noexcept { return {rotation, {2 * tick.seconds(), 10, 100}}; }
};
static_assert(Trajectory<East>);

std::string written(const TemporaryFolder& folder, const Trajectory auto& trajectory, Tick start, Tick duration, double interval,
                    TrajectoryFileSettings settings = {}) {
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
  const std::string text = written(folder, East{}, {}, {0, 0.9}, 0.3);  // three times the double 0.3 is less than the double 0.9
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
  CHECK(turned(folder, rotation_about(up, radians(90))) == "0.0000 0.0000 90.0000\n");    // heads west
  CHECK(turned(folder, rotation_about(up, radians(-90))) == "0.0000 0.0000 270.0000\n");  // heads east
  CHECK(turned(folder, rotation_about(right, radians(20))) == "20.0000 0.0000 0.0000\n");
  CHECK(turned(folder, rotation_about(forward, radians(-20))) == "0.0000 -20.0000 0.0000\n");
  CHECK(turned(folder, rotation_about(right, radians(10)) * rotation_about(forward, radians(-20)) * rotation_about(up, radians(200))) ==
        "10.0000 -20.0000 200.0000\n");
}

TEST_CASE("yaw stays below 360 as written, and no zero has a sign") {
  const TemporaryFolder folder;
  CHECK(turned(folder, rotation_about(up, radians(-0.00001))) == "0.0000 0.0000 0.0000\n");
  CHECK(turned(folder, rotation_about(up, radians(-0.00006))) == "0.0000 0.0000 359.9999\n");
  CHECK(turned(folder, rotation_about(right, radians(-0.00001)) * rotation_about(forward, radians(-0.00001))) == "0.0000 0.0000 0.0000\n");
}

TEST_CASE("where roll and yaw are one turn, all of it is yaw") {
  const TemporaryFolder folder;
  CHECK(turned(folder, rotation_about(forward, radians(90))) == "0.0000 90.0000 0.0000\n");
  CHECK(turned(folder, rotation_about(forward, radians(-90)) * rotation_about(up, radians(30))) == "0.0000 -90.0000 30.0000\n");
  CHECK(turned(folder, rotation_about(right, radians(30)) * rotation_about(forward, radians(90))) == "0.0000 90.0000 30.0000\n");
}

TEST_CASE("the angles of every rotation make that rotation again, near and at the poles too") {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    Rotation rotation = random.rotation();
    if (seed % 3 == 1) {  // within 1e-12 to 1 of a pole
      const double pitch = (random.coin() ? 1 : -1) * (pi / 2 - random.log_uniform(1e-12, 1));
      rotation =
          rotation_about(right, random.uniform(-pi, pi)) * rotation_about(forward, pitch) * rotation_about(up, random.uniform(-pi, pi));
    }
    const RollPitchYaw angles = roll_pitch_yaw(rotation);
    CHECK(std::fabs(angles.roll) <= pi);
    CHECK(std::fabs(angles.pitch) <= pi / 2);
    CHECK(std::fabs(angles.yaw) <= pi);
    const Rotation again = rotation_about(right, angles.roll) * rotation_about(forward, angles.pitch) * rotation_about(up, angles.yaw);
    const double allowed = seed % 3 == 1 ? 1e-7 : 1e-12;  // 6e-6 deg, less than is written, and rounding
    for (const Vec3& axis : {right, forward, up}) CHECK(max_norm(again * axis - rotation * axis) < allowed);
  }
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

}  // namespace
}  // namespace pulsecast::adapters
