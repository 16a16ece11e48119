// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/kitti.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>

#include "support/file_errors.hpp"
#include "support/random_pulses.hpp"
#include "support/refused_field.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using namespace literals;
using support::content;
using support::file_error;
using support::RandomPulses;
using support::refused_field;
using support::TemporaryFolder;

using SensorPose = Pose<frame::Instrument, frame::World>;

/// Numbers of a binary file.
template <class Number>
std::vector<Number> numbers(const std::filesystem::path& path) {
  const std::string bytes = content(path);
  CHECK(bytes.size() % sizeof(Number) == 0);
  std::vector<Number> all(bytes.size() / sizeof(Number));
  std::memcpy(all.data(), bytes.data(), all.size() * sizeof(Number));
  return all;
}

/// Sensor that faces west and drives north at 10 m/s.
SensorPose facing_west(Tick t) { return {rotation_about(axis::up, 90_deg), {100, 10 * t.seconds(), 2}}; }

/// Echoes in the scans that begin at 0 s and 0.1 s, a scan at 0.3 s that has a pulse without echoes, and none at 0.2 s.
struct ThreeScans {
  std::array<Shot, 4> shots{
      {{.tick = {0, 0}, .origin = {100, 0, 2}, .direction = -axis::right, .echoes = 1},
       {.tick = {0, 0.05}, .origin = {100, 0.5, 2}, .direction = axis::forward, .first_echo = 1, .echoes = 2},
       {.tick = {0, 0.1}, .origin = {100, 1, 2}, .direction = axis::up, .first_echo = 3, .echoes = 1},
       {.tick = {0, 0.375}, .origin = {100, 3.75, 2}, .direction = axis::up, .first_echo = 4}}};
  std::array<Echo, 4> echoes{{{.range = 8, .reflectance = 0.25, .object = 7, .classification = 2},
                              {.range = 4, .reflectance = 3, .object = 65'535, .classification = 6},
                              {.range = 16, .reflectance = -1, .object = 65'536 * 9 + 5, .classification = 64},
                              {.range = 32, .reflectance = 1, .object = 1, .classification = 65}}};

  [[nodiscard]] EchoBatch batch() const { return {.shots = shots, .echoes = echoes, .samples = {}}; }
};

void write(const std::filesystem::path& folder, const EchoBatch& batch, const KittiSettings& settings) {
  KittiWriter writer(folder, settings);
  writer(batch);
  writer.close();
}

TEST_CASE("a scan has points with x forward and y left of the sensor, and a reflectance from 0 to 1") {
  const TemporaryFolder folder;
  write(folder / "00", ThreeScans().batch(), {.points = {.sensor = facing_west}});
  const std::vector<float> points = numbers<float>(folder / "00/velodyne/000000.bin");
  const std::array<float, 12> expected{8, 0, 0, 0.25, 0, -4, 0, 1, 0, -16, 0, 0};
  REQUIRE(points.size() == expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) CHECK(std::fabs(points[k] - expected[k]) < 1e-6F);
  CHECK(numbers<float>(folder / "00/velodyne/000001.bin").at(2) == 32);
  CHECK(content(folder / "00/velodyne/000002.bin").empty());
  CHECK_FALSE(std::filesystem::exists(folder / "00/velodyne/000003.bin"));
}

TEST_CASE("a label is the object, modulo 65536, above the class by the table, where others are unlabeled") {
  const TemporaryFolder folder;
  KittiSettings settings{.points = {.sensor = facing_west}};
  settings.classes[64] = 252;
  write(folder / "00", ThreeScans().batch(), settings);
  CHECK((numbers<std::uint32_t>(folder / "00/labels/000000.label") ==
         std::vector<std::uint32_t>{0x0007'0048, 0xFFFF'0032, 0x0005'00FC}));
  CHECK((numbers<std::uint32_t>(folder / "00/labels/000001.label") == std::vector<std::uint32_t>{0x0001'0000}));
  CHECK(content(folder / "00/labels/000002.label").empty());
}

TEST_CASE("points of classes without an entry are counted by class, and classes can be the labels as they are") {
  const TemporaryFolder folder;
  ThreeScans scans;
  scans.echoes[0].classification = 1;
  KittiWriter by_table(folder / "00", {.points = {.sensor = facing_west}});
  by_table(scans.batch());
  by_table.close();
  CHECK((by_table.unlabelled() == std::map<std::uint16_t, std::uint64_t>{{64, 1}, {65, 1}}));
  KittiSettings settings{.points = {.sensor = facing_west}};
  for (std::uint16_t own = 0; own < 100; ++own) settings.classes[own] = own;
  KittiWriter own(folder / "01", settings);
  own(scans.batch());
  own.close();
  CHECK(own.unlabelled().empty());
  CHECK((numbers<std::uint32_t>(folder / "01/labels/000000.label") ==
         std::vector<std::uint32_t>{0x0007'0001, 0xFFFF'0006, 0x0005'0040}));
}

TEST_CASE("times count from the first scan, and poses are of the starts of scans in the frame of the first") {
  const TemporaryFolder folder;
  write(folder / "00", ThreeScans().batch(), {.points = {.sensor = facing_west}});
  CHECK(content(folder / "00/times.txt") == "0.000000000\n0.100000000\n0.300000000\n");
  CHECK(content(folder / "00/calib.txt") == "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  std::istringstream poses(content(folder / "00/poses.txt"));
  for (const double y : {0.0, -1.0, -3.0})  // north is to the right of a sensor that faces west
    for (const double expected : {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, y, 0.0, 0.0, 1.0, 0.0}) {
      double number = 0;
      REQUIRE(static_cast<bool>(poses >> number));
      CHECK(number == doctest::Approx(expected));
    }
  ThreeScans late;
  for (Shot& shot : late.shots) shot.tick = shot.tick + Tick{5, 0};
  write(folder / "01", late.batch(), {.points = {.sensor = facing_west}});
  CHECK(content(folder / "01/times.txt") == content(folder / "00/times.txt"));
  CHECK(content(folder / "01/poses.txt") == content(folder / "00/poses.txt"));
}

TEST_CASE("poses of a body are written as those of the scans") {
  const TemporaryFolder folder;
  write(folder / "00", ThreeScans().batch(), {.points = {.sensor = facing_west}});
  std::vector<TimedPose> truth;
  for (const double time : {0.0, 0.1, 0.3}) {
    const SensorPose pose = facing_west(Tick::of_seconds(time));
    truth.push_back({time, pose.position, pose.rotation});
  }
  write_kitti_poses(folder / "poses.txt", truth);
  std::istringstream found(content(folder / "poses.txt")), expected(content(folder / "00/poses.txt"));
  double a = 0, b = 0;
  for (int k = 0; k < 36; ++k) {
    REQUIRE((static_cast<bool>(found >> a) && static_cast<bool>(expected >> b)));
    CHECK(std::fabs(a - b) < 1e-9);
  }
  CHECK_FALSE(static_cast<bool>(found >> a));
  truth[1].position.x = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH_AS(write_kitti_poses(folder / "b.txt", truth), doctest::Contains("pose 1"), FileError);
  CHECK_FALSE(std::filesystem::exists(folder / "b.txt"));
}

TEST_CASE("poses bring the points of undistorted scans of any motion into the frame of the first") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const Vec3 start = random.point(1e3), speed = random.point(30), spin = random.unit();
    const Rotation turned = random.rotation();
    const double rate = random.uniform(-3, 3);
    const auto sensor = [=](Tick t) {
      return SensorPose{turned * rotation_about(spin, rate * t.seconds()), start + speed * t.seconds()};
    };
    const RandomPulses pulses(500, seed);
    const TemporaryFolder folder;
    write(folder.path(), pulses.batch(), {.points = {.sensor = sensor, .distortion = MotionDistortion::removed}});
    std::istringstream poses(content(folder / "poses.txt"));
    double worst = 0;
    for (int scan = 0; scan < 5; ++scan) {
      std::array<double, 12> m;
      for (double& number : m) REQUIRE(static_cast<bool>(poses >> number));
      const std::vector<float> points = numbers<float>(folder / ("velodyne/00000" + std::to_string(scan) + ".bin"));
      std::size_t i = 0;
      for (const Shot& shot : pulses.batch().shots.subspan(static_cast<std::size_t>(100 * scan), 100))
        for (const Echo& echo : pulses.batch().echoes_of(shot)) {
          const Vec3 world = point_of(shot, echo), expected = to_forward_left_up(sensor({}).inverse().point(world));
          REQUIRE(i + 4 <= points.size());
          const Vec3 p{points[i], points[i + 1], points[i + 2]};
          i += 4;
          const Vec3 found{m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
                           m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
          worst = std::max(worst, length(found - expected) / (1000 + length(expected)));
        }
      CHECK(i == points.size());
    }
    CHECK(worst < 3e-7);  // of single precision
    double more = 0;
    CHECK_FALSE(static_cast<bool>(poses >> more));
  }
}

TEST_CASE("the table knows ground, vegetation, buildings, roads and noise") {
  const KittiClasses classes = kitti_classes();
  CHECK((classes.at(2) == 72 && classes.at(3) == 70 && classes.at(5) == 70 && classes.at(6) == 50 &&
         classes.at(11) == 40));
  CHECK((classes.at(7) == 1 && classes.at(18) == 1 && classes.count(0) == 0 && classes.count(1) == 0 &&
         classes.count(9) == 0));
}

TEST_CASE("a scan rate of its own divides scans") {
  const TemporaryFolder folder;
  write(folder.path(), ThreeScans().batch(), {.scan_rate = 2, .points = {.sensor = facing_west}});
  CHECK(numbers<float>(folder / "velodyne/000000.bin").size() == 16);
  CHECK(content(folder / "times.txt") == "0.000000000\n");
}

TEST_CASE("without close there are no times and poses, and scans of a former sequence are not mixed with others") {
  const TemporaryFolder folder;
  {
    KittiWriter writer(folder.path(), {.points = {.sensor = facing_west}});
    writer(ThreeScans().batch());
  }
  CHECK(std::filesystem::exists(folder / "velodyne/000001.bin"));
  CHECK_FALSE(std::filesystem::exists(folder / "velodyne/000002.bin"));  // it could still go on
  for (const char* const name : {"times.txt", "poses.txt", "calib.txt"})
    CHECK_FALSE(std::filesystem::exists(folder / name));
  const FileError error = file_error([&] { KittiWriter(folder.path(), {.points = {.sensor = facing_west}}); });
  CHECK(error.path() == (folder / "velodyne").string());
  CHECK(support::contains(error.problem(), "without scans"));
  std::ofstream(folder / "file") << "no folder";
  CHECK_THROWS_AS(KittiWriter(folder / "file", {.points = {.sensor = facing_west}}), FileError);
}

TEST_CASE("settings out of range are refused, and leave no folder") {
  const TemporaryFolder folder;
  const auto refused = [&](const KittiSettings& settings) {
    return refused_field([&] { KittiWriter(folder / "00", settings); });
  };
  CHECK(refused({}) == "PointSettings::sensor (poses)");
  CHECK(refused({.scan_rate = 0, .points = {.sensor = facing_west}}) == "KittiSettings::scan_rate");
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(refused({.points = {.sensor = facing_west, .start_time = infinity}}) == "PointSettings::start_time");
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::io
