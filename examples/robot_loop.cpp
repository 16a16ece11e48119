// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Loop of a robot in traffic: physics at 60 Hz, and a VLP-16 that spins on from step to step, ten turns a second. The
// poses of the cars are known at each step only. Each turn is a scan in the sensor's frame, by which the robot brakes.
// Writes the last scan to scan.ply. docs/robotics.md explains the loop.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <iostream>
#include <utility>
#include <vector>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/io/ply.hpp>
#include <pulsecast/io/point_records.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/sensor/velodyne.hpp>

#include "command_line.hpp"
#include "street.hpp"
#include "traffic.hpp"

using namespace pulsecast;

/// Distance to the nearest point of a scan in the lane ahead, at most 40 m [m].
double free_way(const io::PointBuffer& scan) {
  const std::vector<io::PointField>& fields = scan.layout().fields;
  double nearest = 40;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double forward = scan.number(i, fields[0]), left = scan.number(i, fields[1]), up = scan.number(i, fields[2]);
    if (forward > 2.5 && std::fabs(left) < 1 && up > -1.4) nearest = std::min(nearest, forward);
  }
  return nearest;
}

int main(int argc, char** argv) {
  CommandLine line("A robot drives through traffic, step by step, and brakes for what its sensor sees.");
  std::size_t steps = 600, others = 20;
  bool undistorted = false;
  line.add_number("--steps", steps, 120, 1'000'000, "Number of steps of the physics, 60 a second");
  line.add_number("--cars", others, 1, 1000, "Number of cars");
  line.add_flag("--undistorted", undistorted, "Remove the distortion of scans by the robot's motion");
  return line.run(argc, argv, [&] {
    // the world: a town that stands still, and cars that are placed anew at each step
    const street::Scene town = street::scene(line.seed);
    std::vector<traffic::Vehicle> cars = traffic::cars(others, street::Dice(line.seed, 7));
    std::vector<Placement> placements;
    street::Scene moving = traffic::scene_of(cars), unused = moving;
    const Layered world{town, moving};

    // the robot: it keeps to its lane; the trajectory of its sensor reads its position
    traffic::Vehicle robot{.from = {1.9, -street::half_size.x}, .along = {0, 1}};
    const SpinningSensor sensor = velodyne_vlp_16();
    const Platform platform{traffic::LivePath{&robot}, Mount{.lever_arm = {0, 0, 1.9}}, sensor.source(1e6)};
    const Survey survey{platform, SingleRay{}, world, sensor.receiver(), FirstHit{}, line.seed};
    const auto layout = io::layouts::velodyne();
    io::PointBuffer scan(layout,
                         {.sensor = [&](Tick t) { return platform.instrument_at(t); },
                          .distortion = undistorted ? io::MotionDistortion::removed : io::MotionDistortion::kept,
                          .axes = io::PointAxes::forward_left_up,
                          .rings = sensor.rings()});

    ThreadPool pool(line.threads);
    std::vector<double> step_ms;
    step_ms.reserve(steps);
    std::size_t points = 0;
    PulseIndex slot = 0;  // next one of the sensor
    for (std::size_t step = 0; step < steps; ++step) {
      const auto began = std::chrono::steady_clock::now();
      const Tick start = Tick::of(step, 60), end = Tick::of(step + 1, 60);
      robot.begin_step(start.seconds());
      if (step % 6 == 0) {  // a turn was completed
        if (step > 0) robot.speed += std::clamp(0.5 * (free_way(scan) - 6) - robot.speed, -0.8, 0.3);
        scan.begin_scan(start);
      }
      for (traffic::Vehicle& car : cars) car.begin_step(start.seconds());
      traffic::place(cars, 0.5 * (start.seconds() + end.seconds()), placements);
      street::Scene next = moving.with_placements(placements, std::move(unused), pool);
      unused = std::exchange(moving, std::move(next));

      const PulseIndex next_slot = sensor.slot_from(end);
      points += run(survey, {.executor = pool, .first = slot, .end = next_slot}, scan).echoes;
      slot = next_slot;
      step_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count());
    }

    io::PlyWriter ply(line.output / "scan.ply", {.layout = layout});
    ply.add(scan);
    ply.close();
    std::sort(step_ms.begin() + 60, step_ms.end());  // without the first second
    std::cout << steps << " steps with " << points / steps << " points each; a step takes " << std::fixed
              << std::setprecision(2) << step_ms[(60 + steps) / 2] << " ms, the longest after the first second "
              << step_ms.back() << " ms\n";
  });
}
