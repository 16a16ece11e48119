// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Robot that drives down a street with a spinning sensor of 32 beams. Each turn of the sensor is one scan, requested as
// in a robotics program: pose in; points out, with ring, time offset and intensity. Writes robot.png.
//
// Each scan has its own clock. For scenes with moving parts, let the scanner last the whole drive, and run the slots of
// the scans in order
// (`RunOptions::first` and `end`): then time continues from scan to scan.

#include <array>
#include <chrono>
#include <cstddef>
#include <iomanip>
#include <iostream>
#include <optional>
#include <vector>

#include <pulsecast/io/png.hpp>
#include <pulsecast/pulsecast.hpp>

#include "command_line.hpp"
#include "street.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

/// One turn of the sensor: beams that fire together on a rotating head.
auto spinning_sensor(std::size_t beams, double rotation_rate, PulseIndex columns) {
  const Scanner scanner{
      .pulse_rate = rotation_rate * static_cast<double>(columns), .pulses = columns, .laser = {.wavelength = 905_nm}};
  std::vector<Deflector<FixedBeam, Scanner>> emitters;
  for (std::size_t k = 0; k < beams; ++k) {
    const double elevation = std::lerp(-25_deg, 15_deg, static_cast<double>(k) / static_cast<double>(beams - 1));
    emitters.push_back({FixedBeam{aimed_at(0, elevation)}, scanner});
  }
  return Deflector{RotatingHead{.angular_rate = -360_deg * rotation_rate}, Channels{emitters}};
}

/// Motion of the robot during one scan, at constant speed: the scan has the distortion of a real one.
struct Drive {
  Vec3 start;    ///< [m]
  double speed;  ///< to the north [m/s]

  Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    return {no_rotation, start + speed * t.seconds() * axis::forward};
  }
};
static_assert(Trajectory<Drive>);

/// Scan as columns of numbers, for the robot's program.
struct Scan {
  std::vector<std::array<float, 3>>
      points;                        ///< in the frame of the robot at the scan's start: x right, y forward, z up [m]
  std::vector<std::uint16_t> rings;  ///< beam number, from 0 at the bottom
  std::vector<float> time_offsets;   ///< since the scan's start [s]
  std::vector<float> intensities;    ///< 1 for a white surface

  void clear() {
    points.clear();
    rings.clear();
    time_offsets.clear();
    intensities.clear();
  }

  void add(const Vec3& origin, const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) {
        const Vec3 p = point_of(shot, echo) - origin;
        points.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        rings.push_back(shot.channel);
        time_offsets.push_back(static_cast<float>(shot.tick.seconds()));
        intensities.push_back(static_cast<float>(echo.reflectance));
      }
  }
};

int main(int argc, char** argv) {
  CommandLine line("A robot drives down a street and scans it with a spinning sensor, scan by scan.");
  std::size_t scans = 300, beams = 32;
  line.add_number("--scans", scans, 1, 100'000, "Number of revolutions of the sensor");
  line.add_number("--beams", beams, 2, 128, "Number of beams of the sensor");
  return line.run(argc, argv, [&] {
    const auto map = street::scene(line.seed);
    const auto sensor = spinning_sensor(beams, 10, 1024);
    io::ImageWriter image(line.output / "robot.png", {.azimuth = 0,
                                                      .elevation = 8_deg,
                                                      .field_of_view = 70_deg,
                                                      .eye = Vec3(0.5, -70, 8),
                                                      .colour_by = io::ColourBy::classification,
                                                      .point_size = 3});
    Scan scan;
    std::size_t points = 0;
    std::chrono::duration<double> spent{};
    for (std::size_t n = 0; n < scans; ++n) {
      const double y = -60 + 120 * static_cast<double>(n) / static_cast<double>(scans);
      const Vec3 pose{1.2, y, street::height({1.2, y})};
      const auto began = std::chrono::steady_clock::now();
      const Platform robot{Drive{pose, 5}, Mount{.lever_arm = {0, 0, 1.1}}, sensor};
      const Survey survey{robot, SingleRay{}, map, Receiver{.range_max = 120}, FirstHit{}, line.seed + n};
      scan.clear();
      run(survey, {.threads = line.threads}, [&](const EchoBatch& batch) { scan.add(pose, batch); });
      spent += std::chrono::steady_clock::now() - began;
      points += scan.points.size();
      if (n % 10 == 0) run(survey, {.threads = line.threads}, image);  // for the picture
    }
    image.close();
    std::cout << scans << " scans of " << beams << " beams, " << points / scans << " points each, in " << std::fixed
              << std::setprecision(2) << spent.count() << " s: " << std::setprecision(0)
              << static_cast<double>(scans) / spent.count() << " scans per second\n";
  });
}
