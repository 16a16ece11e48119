// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A robot drives through a small town, with a lidar, a flat scanner and an inertial sensor. Writes a bag of ROS 2 with
// frames and truth, drive.mcap. A seed gives the same bag on any number of threads. docs/robotics.md tells its topics.

#include <cmath>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/io/drive_bag.hpp>
#include <pulsecast/platform/ground_vehicle.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/sensor/imu.hpp>
#include <pulsecast/sensor/velodyne.hpp>
#include <pulsecast/sensor_kit.hpp>

#include "command_line.hpp"
#include "street.hpp"

using namespace pulsecast;
using namespace literals;

/// Robot on springs: it follows the ground, and sways.
struct Robot {
  GroundVehicleDrive drive;
  double phase;  ///< of the sway [rad]

  Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    const auto pose = drive.at(t);
    const Rotation pitch = rotation_about(axis::right, 0.7_deg * std::sin(2 * pi * t.phase(1.1) + phase));
    const Rotation roll = rotation_about(axis::forward, 0.9_deg * std::sin(2 * pi * t.phase(0.8) + 2 * phase));
    return {normalize(pose.rotation * pitch * roll), pose.position};
  }
};

/// Robot that drives along a street at 10 m/s, from side to side.
Robot robot_in(const street::Scene& town, std::uint64_t seed) {
  street::Dice dice(seed, 9);
  std::vector<Vec2> way{{1.9, -88}};
  for (double y = -74, side = 1; y < 80; y += dice.between(14, 20), side = -side)
    way.emplace_back(1.9 + side * dice.between(0.5, 1.5), y);
  const auto ground = [&](const Vec2& place, auto... near) { return town.ground_height(place, near...); };
  return {plan_ground_vehicle(way, ground, {.acceleration = 5, .jerk = 8, .turn_radius = 30}),
          static_cast<double>(seed)};
}

/// Points in the frame of a sensor, at the time of each or, if the distortion is removed, at the start of the scan.
io::PointSettings points_of(const auto& platform, const SpinningSensor& sensor, bool removed) {
  return {.sensor = [platform](Tick t) { return platform.instrument_at(t); },
          .distortion = removed ? io::MotionDistortion::removed : io::MotionDistortion::kept,
          .axes = io::PointAxes::forward_left_up,
          .rings = sensor.rings()};
}

int main(int argc, char** argv) {
  CommandLine line("A robot drives through a small town. What its sensors measure is written as a bag of ROS 2.");
  double duration = 12;
  bool removed = false;
  line.add_number("--duration", duration, 0.1, 20, "s", "Duration of the drive");
  line.add_flag("--undistorted", removed, "Remove the distortion of scans by the robot's motion");
  return line.run(argc, argv, [&] {
    const street::Scene town = street::scene(line.seed);
    const Robot robot = robot_in(town, line.seed);
    SensorKit kit;
    io::DriveBag bag(line.output / "drive.mcap", 1.7e9);  // the clock at the start [s]
    std::vector<io::ros::TransformStamped> frames;
    const auto add_lidar = [&](const char* name, const SpinningSensor& sensor, const Mount& mount,
                               io::PointLayout layout, const io::PointGrid& grid, auto write) {
      const Platform platform{robot, mount, sensor.source(duration)};
      kit.add_scans(name, Survey{platform, SingleRay{}, town, sensor.receiver(), FirstHit{}, line.seed},
                    sensor.rotation_rate,
                    io::PointBuffer(std::move(layout), points_of(platform, sensor, removed), grid), write);
      frames.push_back(io::ros::frame_of("base_link", name, mount.pose()));
    };

    const auto points = bag.add<io::ros::PointCloud2>("/points", "lidar");
    add_lidar("lidar", velodyne_vlp_32c(), {.lever_arm = {0, 1, 1.9}}, io::layouts::velodyne(), {},
              [&](const io::PointBuffer& scan) { bag.write(points, scan, kit.time()); });

    // a scanner in a plane: 1,080 beams a turn, the first one forward, to the right
    const SpinningSensor flat{.lasers = {{}}, .sequence_rate = 40 * 1080, .rotation_rate = 40, .range_max = 30};
    const auto sweeps = bag.add<io::ros::LaserScan>("/scan", "flat");
    const io::ros::SweepSettings shape{.angle_increment = -2 * pi / 1080, .scan_time = 1.0 / 40, .gate = {0.1, 30}};
    std::vector<float> ranges;
    add_lidar("flat", flat, {.lever_arm = {0, 2.5, 0.5}}, io::ros::sweep_layout(), {1, 1080, flat.sequence_rate},
              [&](const io::PointBuffer& sweep) {
                bag.write(sweeps, io::ros::laser_scan_of(sweep, shape, ranges), sweep.scan_start(), kit.time());
              });

    const Imu imu{robot, Mount{.lever_arm = {0, 1, 1}}, mti_1(400)};
    const auto samples = bag.add<io::ros::Imu>("/imu/data", "imu");
    frames.push_back(io::ros::frame_of("base_link", "imu", imu.mount().pose()));
    kit.add_samples("imu", 400, [&](PulseIndex i, Tick t) {
      if (i == 0) return;  // samples are complete when their interval ends
      const ImuSample sample = imu.sample(i - 1);
      bag.write(samples, io::ros::imu_of(sample), sample.middle(), t);
    });

    const auto truth = bag.add<io::ros::Odometry>("/ground_truth/odom", "map", "base_link");
    kit.add_samples("truth", 100, [&](PulseIndex, Tick t) {
      const Derivatives motion = derivatives_of(robot, t);
      bag.write(truth, io::ros::odometry_of(robot.at(t), motion.velocity, motion.angular_rate), t);
    });
    bag.fix(frames);
    ThreadPool pool(line.threads);
    for (PulseIndex step = 1; Tick::of(step, 100) <= Tick::of_seconds(duration); ++step) {
      kit.step(Tick::of(step, 100), pool);
      bag.advance(kit.time());
    }
    bag.close();
    std::cout << "The results are in " << line.output.string() << ".\n";
  });
}
