// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A robot drives through a small town, with a spinning lidar, a scanner in a plane and an inertial sensor. Writes what
// they measure as a bag of ROS 2, drive.mcap, with frames and truth, as SLAM programs read it, and the true path as
// truth.tum. The same seed gives the same bag, on any number of threads. docs/robotics.md explains the topics.

#include <cmath>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/io/drive_bag.hpp>
#include <pulsecast/io/trajectory.hpp>
#include <pulsecast/platform/ground_vehicle.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/sensor/imu.hpp>
#include <pulsecast/sensor/velodyne.hpp>
#include <pulsecast/sensor_kit.hpp>

#include "command_line.hpp"
#include "street.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

/// Robot on springs: it follows the ground, and sways.
struct Robot {
  GroundVehicleDrive drive;
  double phase;  ///< of the sway [rad]

  [[nodiscard]] Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    auto pose = drive.at(t);
    const Rotation pitch = rotation_about(axis::right, 0.7_deg * std::sin(2 * pi * t.phase(1.1) + phase));
    const Rotation roll = rotation_about(axis::forward, 0.9_deg * std::sin(2 * pi * t.phase(0.8) + 2 * phase));
    pose.rotation = normalize(pose.rotation * pitch * roll);
    return pose;
  }
};
static_assert(Trajectory<Robot>);

/// Way along a street, from side to side, and at the crossing into the other one [m].
std::vector<Vec2> way(std::uint64_t seed) {
  street::Dice dice(seed, 9);
  std::vector<Vec2> points{{1.9, -88}};
  double side = seed % 2 == 0 ? 1 : -1;
  for (double y = -74; y < -25; y += dice.between(14, 20), side = -side)
    points.emplace_back(1.9 + side * dice.between(0.5, 1.5), y);
  points.insert(points.end(), {{1.9, -1.9}, {58, -1.9}});
  return points;
}

int main(int argc, char** argv) {
  CommandLine line("A robot drives through a small town. What its sensors measure is written as a bag of ROS 2.");
  double duration = 15;
  bool undistorted = false;
  line.add_number("--duration", duration, 0.1, 20, "s", "Duration of the drive");
  line.add_flag("--undistorted", undistorted, "Remove the distortion of scans by the robot's motion");
  return line.run(argc, argv, [&] {
    const street::Scene town = street::scene(line.seed);
    const auto ground = [&](const Vec2& place, auto... near) { return town.ground_height(place, near...); };
    const Robot robot{plan_ground_vehicle(way(line.seed), ground, {.acceleration = 4, .jerk = 8, .turn_radius = 10}),
                      static_cast<double>(line.seed)};

    io::DriveBag bag(line.output / "drive.mcap", 1.7e9);  // the clock at the start [s]
    io::TrajectoryWriter path(line.output / "truth.tum");
    SensorKit kit;
    ThreadPool pool(line.threads);

    // adds a lidar whose scans go to a topic, in a frame of its own
    const auto add_lidar = [&](const std::string& name, const Mount& mount, const SpinningSensor& sensor,
                               io::PointLayout layout, double scans, const auto& topic, auto write) {
      const Platform platform{robot, mount, sensor.source(duration)};
      bag.fix("base_link", name, mount.pose());
      kit.add_scans(
          name, Survey{platform, SingleRay{}, town, sensor.receiver(), FirstHit{}, line.seed}, scans,
          io::PointBuffer(std::move(layout),
                          {.sensor = [platform](Tick t) { return platform.instrument_at(t); },
                           .distortion = undistorted ? io::MotionDistortion::removed : io::MotionDistortion::kept,
                           .axes = io::PointAxes::forward_left_up,
                           .rings = sensor.rings(), .start_time = 1.7e9}),
          [&, topic, write](const io::PointBuffer& scan) { write(topic, scan); });
    };
    const auto points = bag.add<io::ros::PointCloud2>("/points", "lidar");
    add_lidar("lidar", {.lever_arm = {0, 1, 1.9}}, velodyne_vlp_32c(), io::layouts::velodyne(), 10, points,
              [&](const auto& topic, const io::PointBuffer& scan) { bag.write(topic, scan, kit.time()); });

    // inertial sensor, and the truth
    const Imu imu{robot, Mount{.lever_arm = {0, 1, 1}}, mti_1()};
    const auto samples = bag.add<io::ros::Imu>("/imu/data", "imu_link");
    bag.fix("base_link", "imu_link", imu.mount().pose());
    kit.add_samples("imu", imu.settings().sample_rate, [&](PulseIndex i, Tick) {
      if (i > 0) bag.write(samples, imu.sample(i - 1));
    });
    const auto truth = bag.add<io::ros::Odometry>("/ground_truth/odom", "map", "base_link");
    kit.add_samples("truth", 100, [&](PulseIndex, Tick t) {
      const Derivatives now = derivatives_of(robot, t);
      bag.write(truth, t, robot.at(t), now.velocity, now.angular_rate);
    });

    for (std::uint64_t step = 1; Tick::of(step, 100) <= Tick::of_seconds(duration); ++step) {
      kit.step(Tick::of(step, 100), pool);
      bag.advance(Tick::of(step, 100));
    }
    bag.close();
    std::cout << "Drove " << std::round(robot.drive.driven().at(Tick::of_seconds(duration)).position)
              << " m; the bag is " << (line.output / "drive.mcap").string() << '\n';
  });
}
