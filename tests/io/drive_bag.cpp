// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/drive_bag.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>

#include "support/allocations.hpp"
#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::Generator;
using support::TemporaryFolder;

template <class Number>
Number number(const std::string& bytes, std::size_t at) {
  Number value;
  std::memcpy(&value, bytes.substr(at, sizeof value).data(), sizeof value);
  return value;
}

struct Message {
  std::uint16_t channel;
  std::uint64_t log_time, publish_time;
  std::string data;
};

/// Messages in the order of the file; mcap_foreign reads all of it.
std::vector<Message> messages_of(const std::filesystem::path& path) {
  std::vector<Message> all;
  const std::string file = content(path);
  for (std::size_t at = 8; at + 8 < file.size();) {
    const auto length = static_cast<std::size_t>(number<std::uint64_t>(file, at + 1));
    if (file[at] == 5)
      all.push_back({number<std::uint16_t>(file, at + 9), number<std::uint64_t>(file, at + 15),
                     number<std::uint64_t>(file, at + 23), file.substr(at + 31, length - 22)});
    at += file[at] == 6 ? 49 : 9 + length;  // into a chunk
  }
  return all;
}

const Pose<frame::Instrument, frame::Body> mount{no_rotation, {0.5, 1, 2}};

TEST_CASE("messages are in order of the times when they were complete, and then of writing") {
  const TemporaryFolder folder;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    DriveBag bag(folder / "a.mcap", 1000);
    const auto imu = bag.add<ros::Imu>("/imu", "imu_link");
    const auto points = bag.add<ros::PointCloud2>("/points", "lidar");
    std::vector<std::pair<std::uint64_t, std::string>> expected;
    PointBuffer scan(layouts::xyzi());
    for (int step = 0; step < 10; ++step) {
      for (std::uint64_t left = any.whole(20); left > 0; --left) {
        const Tick tick{step + static_cast<std::int64_t>(any.whole(3)), 0.125 * static_cast<double>(any.whole(8))};
        if (any.coin()) {
          bag.write(imu, ros::Imu{}, tick);
        } else {
          scan.begin_scan({step, 0.5});
          bag.write(points, scan, tick);
        }
        expected.emplace_back(ros::stamp_ns(1000, tick), "");
      }
      bag.advance({step + 1, 0});
      expected.emplace_back(ros::stamp_ns(1000, {step + 1, 0}), "clock");
      if (any.coin()) continue;
      CHECK_THROWS_WITH_AS(bag.write(imu, ros::Imu{}, {step, 0.999}), doctest::Contains("of the last advance"),
                           SettingError);
    }
    bag.close();
    const std::vector<Message> found = messages_of(folder / "a.mcap");
    REQUIRE(found.size() == expected.size());
    std::ranges::stable_sort(expected, {}, &std::pair<std::uint64_t, std::string>::first);
    for (std::size_t i = 0; i < found.size(); ++i) {
      CHECK(found[i].log_time == expected[i].first);
      CHECK((found[i].channel == 0) == (expected[i].second == "clock"));
      const auto stamp = number<std::uint32_t>(found[i].data, 4) * std::uint64_t{1'000'000'000} +
                         number<std::uint32_t>(found[i].data, 8);
      CHECK(found[i].publish_time == stamp);
    }
  }
}

TEST_CASE("a bag does not go back, and points with the time by the clock have its clock") {
  const TemporaryFolder folder;
  DriveBag bag(folder / "a.mcap", 1000);
  const auto points = bag.add<ros::PointCloud2>("/points", "lidar");
  bag.advance({5, 0});
  bag.advance({5, 0});
  CHECK_THROWS_WITH_AS(bag.advance({3, 0}), doctest::Contains("DriveBag::advance (end) is 3 s"), SettingError);
  bag.write(points, PointBuffer(layouts::velodyne()), {6, 0});
  bag.write(points, PointBuffer(layouts::hesai(), {.start_time = 1000}), {6, 0});
  for (const PointLayout& layout : {layouts::hesai(), layouts::livox()})
    CHECK_THROWS_WITH_AS(bag.write(points, PointBuffer(layout), {6, 0}),
                         "PointSettings::start_time is 0 s, but must be that of the bag, 1000", SettingError);
}

TEST_CASE("all fixed frames are in one message, which reaches late subscribers") {
  const TemporaryFolder folder;
  DriveBag bag(folder / "a.mcap", 1000);
  bag.fix({ros::frame_of("base_link", "lidar", mount), ros::frame_of("base_link", "imu_link", mount)});
  bag.close();
  const std::vector<Message> found = messages_of(folder / "a.mcap");
  REQUIRE(found.size() == 1);
  CHECK((found[0].channel == 2 && number<std::uint32_t>(found[0].data, 4) == 2));
  const std::string file = content(folder / "a.mcap");
  CHECK(file.find("/tf_static") != file.npos);
  CHECK(file.find("durability: 1\n") != file.npos);
  CHECK(file.find("rosbag2") != file.npos);
}

TEST_CASE("frames that tf2 refuses are refused") {
  const support::TemporaryFolder folder;
  io::DriveBag bag(folder / "drive.mcap");
  CHECK_THROWS_WITH_AS(static_cast<void>(bag.add<io::ros::Imu>("/imu", "/imu_link")),
                       "DriveBag (frame) is '/imu_link': expected a name that begins without /", SettingError);
  CHECK_THROWS_AS(static_cast<void>(bag.add<io::ros::Odometry>("/odom", "map", "/base_link")), SettingError);
  CHECK_THROWS_AS(bag.fix({io::ros::frame_of("base_link", "/lidar", Pose<frame::Body, frame::Body>{})}), SettingError);
  CHECK_THROWS_AS(bag.move(io::ros::frame_of("/base_link", "lidar", Pose<frame::Body, frame::Body>{}), {}),
                  SettingError);
}

TEST_CASE("odometry has both of its frames, and a Livox the time of its scan") {
  const TemporaryFolder folder;
  DriveBag bag(folder / "a.mcap", 1000);
  const auto truth = bag.add<ros::Odometry>("/truth", "map", "base_link");
  const auto livox = bag.add<ros::CustomMsg>("/livox", "livox_frame");
  bag.write(truth, ros::Odometry{}, {1, 0});
  bag.write(livox, ros::CustomMsg{}, {1, 0}, {2, 0});
  bag.close();
  const std::vector<Message> found = messages_of(folder / "a.mcap");
  REQUIRE(found.size() == 2);
  CHECK((found[0].data.find("map") != std::string::npos && found[0].data.find("base_link") != std::string::npos));
  CHECK(number<std::uint64_t>(found[1].data, 4 + 8 + 4 + 12) == 1'001'000'000'000);
  CHECK((found[1].publish_time == 1'001'000'000'000 && found[1].log_time == 1'002'000'000'000));
}

TEST_CASE("after the first steps a bag allocates nothing but its index, and two bags are the same") {
  const TemporaryFolder folder;
  const auto drive = [&](const char* name, std::size_t& allocations) {
    DriveBag bag(folder / name, 1000, {.chunk_size = std::size_t{1} << 30});
    const auto imu = bag.add<ros::Imu>("/imu/of/a/long/name/on/the/robot", "a frame of a long name on the robot");
    const auto points = bag.add<ros::PointCloud2>("/points", "another frame of a long name");
    const auto sweeps = bag.add<ros::LaserScan>("/scan", "laser");
    const auto truth = bag.add<ros::Odometry>("/ground_truth/odom", "map", "base_link");
    PointBuffer scan(layouts::xyzi(), {}, {.rows = 16, .columns = 100, .column_rate = 1000});
    PointBuffer sweep(ros::sweep_layout(), {}, {.rows = 1, .columns = 100, .column_rate = 1000});
    const Pose<frame::Body, frame::World> pose{};
    std::vector<float> memory;
    for (int step = 0; step < 64; ++step) {
      const std::size_t before = support::allocations;
      const Tick end{step + 1, 0};
      bag.write(points, scan, end);
      for (PulseIndex i = 0; i < 10; ++i) bag.write(imu, ros::Imu{}, Tick{step, 0} + Tick::of(i, 10));
      bag.write(sweeps, ros::laser_scan_of(sweep, {}, memory), {step, 0}, end);
      bag.write(truth, ros::odometry_of(pose, {1, 2, 3}, {}), end);
      bag.move(ros::frame_of("odom", "base_link", pose), end);
      bag.advance(end);
      if (step > 0) allocations += support::allocations - before;
    }
    bag.close();
  };
  std::size_t first = 0, second = 0;
  drive("a.mcap", first);
  drive("b.mcap", second);
  CHECK(first < 64);  // growth of the index of each channel, by doubling
  CHECK(first == second);
  CHECK(content(folder / "a.mcap") == content(folder / "b.mcap"));
}

TEST_CASE("times that ROS does not hold are refused, and without close there is no file") {
  const TemporaryFolder folder;
  {
    DriveBag bag(folder / "a.mcap", -5);
    const auto imu = bag.add<ros::Imu>("/imu", "imu_link");
    CHECK_THROWS_WITH_AS(bag.write(imu, ros::Imu{}, {4, 0}), doctest::Contains("DriveBag::start_time + tick is -1 s"),
                         SettingError);
    CHECK_THROWS_AS(bag.advance({2'147'483'653, 0}), SettingError);
    bag.write(imu, ros::Imu{}, {5, 0});
  }
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::io
