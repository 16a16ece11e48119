// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Robot that drives down a street with a spinning sensor of 32 beams. Each turn of the sensor is one scan, requested as
// in a robotics program: pose in; point records out, with ring, time offset and intensity. Writes robot.png.
//
// Each scan has its own clock. For scenes with moving parts, let the sensor's source last the whole drive, and run the
// slots of the scans in order, as examples/robot_loop.cpp does: then time continues from scan to scan.

#include <chrono>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <iostream>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/io/png.hpp>
#include <pulsecast/io/point_records.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/sensor/spinning_sensor.hpp>

#include "command_line.hpp"
#include "street.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

/// Sensor of 1,024 columns a turn, whose beams fire together.
SpinningSensor spinning_sensor(std::size_t beams, double rotation_rate) {
  SpinningSensor sensor{.sequence_rate = 1024 * rotation_rate,
                        .rotation_rate = rotation_rate,
                        .beam = {.wavelength = 905_nm},
                        .range_max = 120};
  for (std::size_t k = 0; k < beams; ++k)
    sensor.lasers.push_back(
        {.elevation = std::lerp(-25_deg, 15_deg, static_cast<double>(k) / static_cast<double>(beams - 1))});
  return sensor;
}

/// Motion of the robot during one scan, at constant speed, from where the robot's program has it.
struct Drive {
  const Vec3* start;  ///< [m]
  double speed;       ///< to the north [m/s]

  Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    return {no_rotation, *start + speed * t.seconds() * axis::forward};
  }
};
static_assert(Trajectory<Drive>);

int main(int argc, char** argv) {
  CommandLine line("A robot drives down a street and scans it with a spinning sensor, scan by scan.");
  std::size_t scans = 300, beams = 32;
  line.add_number("--scans", scans, 1, 100'000, "Number of revolutions of the sensor");
  line.add_number("--beams", beams, 2, 128, "Number of beams of the sensor");
  return line.run(argc, argv, [&] {
    const auto map = street::scene(line.seed);
    const SpinningSensor sensor = spinning_sensor(beams, 10);
    Vec3 pose{};
    const Platform robot{Drive{&pose, 5}, Mount{.lever_arm = {0, 0, 1.1}}, sensor.source(0.1)};
    const Survey survey{robot, SingleRay{}, map, sensor.receiver(), FirstHit{}, line.seed};
    // points in the frame of the sensor at the scan's start
    io::PointBuffer scan(io::layouts::velodyne(), {.sensor = [&](Tick t) { return robot.instrument_at(t); },
                                                   .distortion = io::MotionDistortion::removed,
                                                   .rings = sensor.rings()});
    io::ImageWriter image(line.output / "robot.png", {.azimuth = 0,
                                                      .elevation = 8_deg,
                                                      .field_of_view = 70_deg,
                                                      .eye = Vec3(0.5, -70, 8),
                                                      .colour_by = io::ColourBy::classification,
                                                      .point_size = 3});
    ThreadPool pool(line.threads);
    std::size_t points = 0;
    std::chrono::duration<double> spent{};
    for (std::size_t n = 0; n < scans; ++n) {
      const double y = -60 + 120 * static_cast<double>(n) / static_cast<double>(scans);
      pose = {1.2, y, street::height({1.2, y})};
      const auto began = std::chrono::steady_clock::now();
      scan.begin_scan({});
      run(survey, {.executor = pool}, scan);
      spent += std::chrono::steady_clock::now() - began;
      points += scan.size();
      if (n % 10 == 0) run(survey, {.executor = pool}, image);  // for the picture
    }
    image.close();
    std::cout << scans << " scans of " << beams << " beams, " << points / scans << " points each, in " << std::fixed
              << std::setprecision(2) << spent.count() << " s: " << std::setprecision(0)
              << static_cast<double>(scans) / spent.count() << " scans per second\n";
  });
}
