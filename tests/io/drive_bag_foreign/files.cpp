// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Writes the bag of a random drive, and beside it what others should read in it: a JSON object a line, a message each,
// in the order of their times, with all fields by the rules of ROS and REP 103, 117 and 118, computed here anew. Usage:
// files FOLDER SEED.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/io/drive_bag.hpp>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
namespace fs = std::filesystem;

namespace {

constexpr std::int64_t start_time = 1'700'000'000;  // [s]

/// Number in JSON, where those that are not finite are words.
template <class Number>
std::string json(Number value) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  const auto number = static_cast<double>(value);
  if (std::isfinite(number))
    text << +value;
  else
    text << (std::isnan(number) ? "\"NaN\"" : number > 0 ? "\"Infinity\"" : "\"-Infinity\"");
  return text.str();
}
std::string json(const Vec3& v) {
  return R"({"x":)" + json(v.x) + R"(,"y":)" + json(v.y) + R"(,"z":)" + json(v.z) + '}';
}
template <class Sequence>
std::string list(const Sequence& all) {
  std::string text = "[";
  for (const auto& each : all) text += (text.size() > 1 ? "," : "") + json(each);
  return text + ']';
}
std::string json(Tick tick) {  // multiples of 1/128 s
  return R"({"sec":)" + json(start_time + tick.second) + R"(,"nsec":)" + json(std::llround(tick.fraction * 1e9)) + '}';
}
std::string header(Tick tick, const std::string& frame) {
  return R"("header":{"stamp":)" + json(tick) + R"(,"frame_id":")" + frame + "\"}";
}
std::string zeros(std::size_t count, double first = 0) {
  std::vector<double> all(count);
  all[0] = first;
  return list(all);
}

/// Rotation from x forward, y left, z up of the body to x right, y forward, z up.
const Rotation robot{std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
std::string json(const Rotation& q) {
  return R"({"x":)" + json(q.x) + R"(,"y":)" + json(q.y) + R"(,"z":)" + json(q.z) + R"(,"w":)" + json(q.w) + '}';
}
Vec3 robots(const Vec3& v) { return {v.y, -v.x, v.z}; }

class Drive {
 public:
  Drive(const fs::path& folder, std::uint64_t seed)
      : any_(seed), bag_(folder / "drive.mcap", start_time), told_(folder / "drive.jsonl") {}

  void run() {
    fix();
    for (int step = 0; step < 20; ++step) {
      for (std::uint64_t left = any_.whole(12); left > 0; --left) write_any(any_tick(step));
      bag_.advance({step + 1, 0});
      tell({step + 1, 0}, {step + 1, 0}, "/clock", R"("clock":)" + json(Tick{step + 1, 0}));
    }
    bag_.close();
    for (const auto& [time, line] : lines_) told_ << line << '\n';
    told_.close();
  }

 private:
  Tick any_tick(int step) { return {step, static_cast<double>(any_.whole(128)) / 128}; }
  Vec3 any_vector() { return {any_.normal(), any_.normal(), any_.normal()}; }
  std::string word(std::uint64_t length) {
    std::string text;
    while (text.size() < length) text += static_cast<char>('a' + any_.whole(26));
    return text;
  }

  void tell(Tick complete, Tick tick, const std::string& topic, const std::string& fields) {
    const auto ns = [](Tick t) {
      return std::to_string((start_time + t.second) * 1'000'000'000 + std::llround(t.fraction * 1e9));
    };
    lines_.emplace(complete, R"({"topic":")" + topic + R"(","logTime":")" + ns(complete) + R"(","publishTime":")" +
                                 ns(tick) + R"(","message":{)" + fields + "}}");
  }

  static std::string transform(Tick tick, const std::string& parent, const std::string& child, const Vec3& at,
                               const Rotation& rotation) {
    return '{' + header(tick, parent) + R"(,"child_frame_id":")" + child + R"(","transform":{"translation":)" +
           json(at) + R"(,"rotation":)" + json(rotation) + "}}";
  }

  void fix() {
    const Pose<frame::Instrument, frame::Body> lidar{any_.rotation(), any_.point(3)},
        imu{any_.rotation(), any_.point(3)};
    bag_.fix({ros::frame_of("base_link", "lidar", lidar), ros::frame_of("base_link", "imu_link", imu)});
    const auto told = [](const std::string& child, const auto& pose) {
      return transform({}, "base_link", child, robots(pose.position), conjugate(robot) * pose.rotation * robot);
    };
    tell({}, {}, "/tf_static", R"("transforms":[)" + told("lidar", lidar) + ',' + told("imu_link", imu) + ']');
  }

  void write_any(Tick tick) {
    switch (any_.whole(6)) {
      case 0:
        return write_imu(tick);
      case 1:
        return write_odometry(tick);
      case 2:
        return write_frame(tick);
      case 3:
        return write_sweep(tick);
      case 4:
        return write_livox(tick);
      default:
        return write_depths(tick);
    }
  }

  void write_imu(Tick tick) {
    const ImuSample sample{
        .tick = tick, .interval = 1, .angle_increment = any_vector(), .velocity_increment = any_vector()};
    bag_.write(imu_, ros::imu_of(sample), tick);
    tell(tick, tick, "/imu/data",
         header(tick, imu_.frame_id) + R"(,"orientation":{"x":0,"y":0,"z":0,"w":1},"orientation_covariance":)" +
             zeros(9, -1) + R"(,"angular_velocity":)" + json(robots(sample.mean_angular_rate())) +
             R"(,"angular_velocity_covariance":)" + zeros(9) + R"(,"linear_acceleration":)" +
             json(robots(sample.mean_specific_force())) + R"(,"linear_acceleration_covariance":)" + zeros(9));
  }

  void write_odometry(Tick tick) {
    const Pose<frame::Body, frame::World> pose{any_.rotation(), any_.point(1e6)};
    const Vec3 velocity = any_vector(), rate = any_vector();
    bag_.write(truth_, ros::odometry_of(pose, velocity, rate), tick);
    tell(tick, tick, "/ground_truth/odom",
         header(tick, "map") + R"(,"child_frame_id":"base_link","pose":{"pose":{"position":)" + json(pose.position) +
             R"(,"orientation":)" + json(pose.rotation * robot) + R"(},"covariance":)" + zeros(36) +
             R"(},"twist":{"twist":{"linear":)" + json(robots(conjugate(pose.rotation) * velocity)) + R"(,"angular":)" +
             json(robots(rate)) + R"(},"covariance":)" + zeros(36) + '}');
  }

  void write_frame(Tick tick) {
    const Pose<frame::Body, frame::World> pose{any_.rotation(), any_.point(1e3)};
    const std::string parent = word(any_.whole(10)), child = word(any_.whole(10));
    bag_.move(ros::frame_of(parent, child, pose), tick);
    tell(tick, tick, "/tf",
         R"("transforms":[)" + transform(tick, parent, child, pose.position, pose.rotation * robot) + ']');
  }

  /// Adds a shot forward, or to the side by an angle.
  void add(PointBuffer& points, PulseIndex index, Tick tick, std::uint16_t channel, double range, double left = 0) {
    const Shot shot{.index = index,
                    .tick = tick,
                    .direction = {-std::sin(left), std::cos(left), 0},
                    .channel = channel,
                    .echoes = 1};
    const Echo echo{.range = range, .reflectance = 0.5};
    points({.shots = {&shot, 1}, .echoes = {&echo, 1}, .samples = {}});
  }

  void write_sweep(Tick tick) {
    const auto beams = static_cast<std::uint32_t>(1 + any_.whole(9));
    PointBuffer sweep(ros::sweep_layout(), {}, {.rows = 1, .columns = beams, .column_rate = 64});
    sweep.begin_scan(tick);
    std::vector<float> ranges(beams, std::numeric_limits<float>::infinity()), intensities(beams);
    for (std::uint32_t i = 0; i < beams; ++i) {
      if (any_.coin()) continue;
      const double range = any_.log_uniform(0.1, 30);
      ranges[i] = static_cast<float>(range);
      intensities[i] = 50;
      add(sweep, i, tick + Tick{0, i / 64.0}, 0, range);
    }
    const Tick complete = tick + Tick{0, 0.25};
    std::vector<float> memory;
    bag_.write(sweep_, ros::laser_scan_of(sweep, {-0.5, 0.25, 0.125, {0.0625, 30}}, memory), tick, complete);
    tell(
        complete, tick, "/scan",
        header(tick, sweep_.frame_id) + R"(,"angle_min":-0.5,"angle_max":)" + json(-0.5 + 0.25 * (beams - 1)) +
            R"(,"angle_increment":0.25,"time_increment":0.015625,"scan_time":0.125,"range_min":0.0625,"range_max":30,"ranges":)" +
            list(ranges) + R"(,"intensities":)" + list(intensities));
  }

  void write_livox(Tick tick) {
    PointBuffer scan(ros::livox_layout(), {.axes = PointAxes::forward_left_up});
    scan.begin_scan(tick);
    std::string points;
    const std::uint64_t count = any_.whole(6);
    for (std::uint64_t i = 0; i < count; ++i) {
      const double range = any_.log_uniform(0.1, 100);
      const auto line = static_cast<std::uint16_t>(any_.whole(6));
      add(scan, i, tick + Tick{0, static_cast<double>(i) / 512}, line, range);
      points += (points.empty() ? "" : ",") +
                (R"({"offset_time":)" + json(std::llround(1e9 * static_cast<double>(i) / 512))) + R"(,"x":)" +
                json(static_cast<float>(range)) + R"(,"y":0,"z":0,"reflectivity":50,"tag":0,"line":)" + json(line) +
                '}';
    }
    bag_.write(livox_, ros::livox_of(scan), tick);
    const auto base = (start_time + tick.second) * 1'000'000'000 + std::llround(tick.fraction * 1e9);
    tell(tick, tick, "/livox/lidar",
         header(tick, livox_.frame_id) + R"(,"timebase":")" + std::to_string(base) + R"(","point_num":)" +
             std::to_string(count) + R"(,"lidar_id":0,"rsvd":[0,0,0],"points":[)" + points + ']');
  }

  void write_depths(Tick tick) {
    const auto at_origin = [](Tick) { return Pose<frame::Instrument, frame::World>{}; };
    PointBuffer grid(layouts::xyzi(), {.sensor = at_origin, .axes = PointAxes::forward_left_up},
                     {.rows = 3, .columns = 4});
    grid.begin_scan(tick);
    std::array<float, 12> depths;
    depths.fill(std::numeric_limits<float>::infinity());
    for (PulseIndex i = 0; i < depths.size(); ++i) {
      if (any_.coin()) continue;
      const double range = any_.log_uniform(0.1, 100);
      depths[i] = static_cast<float>(range);
      add(grid, 24 + i, tick, 0, range);
    }
    std::vector<int> bytes;
    for (const std::byte b : std::as_bytes(std::span(depths))) bytes.push_back(static_cast<int>(b));
    std::vector<float> memory;
    bag_.write(depths_, ros::depth_image_of(grid, memory), tick);
    tell(tick, tick, "/depth/image",
         header(tick, "") + R"(,"height":3,"width":4,"encoding":"32FC1","is_bigendian":0,"step":16,"data":)" +
             list(bytes));
  }

  support::Generator any_;
  DriveBag bag_;
  std::ofstream told_;
  std::multimap<Tick, std::string> lines_;  // those of equal times in the order of writing
  BagTopic<ros::Imu> imu_ = bag_.add<ros::Imu>("/imu/data", word(any_.whole(12)));
  BagTopic<ros::Odometry> truth_ = bag_.add<ros::Odometry>("/ground_truth/odom", "map", "base_link");
  BagTopic<ros::LaserScan> sweep_ = bag_.add<ros::LaserScan>("/scan", word(any_.whole(12)));
  BagTopic<ros::CustomMsg> livox_ = bag_.add<ros::CustomMsg>("/livox/lidar", word(any_.whole(12)));
  BagTopic<ros::Image> depths_ = bag_.add<ros::Image>("/depth/image", "");
};

}  // namespace

int main(int count, char** words) {
  if (count != 3) return 2;
  Drive(words[1], std::stoull(words[2])).run();
}
