// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Ten robots with a VLP-16 each, ten turns a second, in one street with 20 moving cars: the loop of
// examples/robot_loop.cpp, step by step at 60 Hz, on all threads. How many times faster than real time it is: the
// median over ten seconds of the drive, and the least of them; with the street in its parts, and as one mesh.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/io/point_records.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/sensor/velodyne.hpp>

#include "../examples/traffic.hpp"
#include "report.hpp"
#include "surveys.hpp"

using namespace bench;

namespace {

constexpr std::size_t count = 10, seconds = 10, rate = 60;

void drive(Report& report, const std::string& name, const street::Scene& town) {
  if (!report.wanted(name)) return;
  std::vector<traffic::Vehicle> cars = traffic::cars(20, street::Dice(1, 7)), robots(count);
  std::vector<Placement> placements;
  street::Scene moving = traffic::scene_of(cars), unused = moving;
  const Layered world{town, moving};

  const SpinningSensor sensor = velodyne_vlp_16();
  const auto survey_of = [&](const traffic::Vehicle& robot, std::uint64_t seed) {
    const Platform platform{traffic::LivePath{&robot}, Mount{.lever_arm = {0, 0, 1.9}}, sensor.source(1e6)};
    return Survey{platform, SingleRay{}, world, sensor.receiver(), FirstHit{}, seed};
  };
  std::vector<decltype(survey_of(robots[0], 0))> surveys;
  std::vector<io::PointBuffer> scans;
  for (std::size_t k = 0; k < count; ++k) {
    robots[k] = {.from = {1.9, -street::half_size.x}, .along = {0, 1}, .way = 12 * static_cast<double>(k), .speed = 5};
    surveys.push_back(survey_of(robots[k], k));
    const auto pose = [platform = surveys.back().source()](Tick t) { return platform.instrument_at(t); };
    scans.emplace_back(
        io::layouts::velodyne(),
        io::PointSettings{.sensor = pose, .axes = io::PointAxes::forward_left_up, .rings = sensor.rings()});
  }

  ThreadPool pool;
  Times times;
  std::size_t points = 0;
  for (std::size_t step = 0; step < seconds * rate; ++step) {
    const double began = wall_seconds();
    const Tick start = Tick::of(step, static_cast<double>(rate)), end = Tick::of(step + 1, static_cast<double>(rate));
    for (traffic::Vehicle& car : cars) car.begin_step(start.seconds());
    traffic::place(cars, 0.5 * (start.seconds() + end.seconds()), placements);
    street::Scene next = moving.with_placements(placements, std::move(unused), pool);
    unused = std::exchange(moving, std::move(next));
    std::atomic<std::size_t> found = 0;
    const auto scan = [&](std::size_t k) {  // a robot on one thread, as there are more robots than threads
      robots[k].begin_step(start.seconds());
      if (step % (rate / 10) == 0) scans[k].begin_scan(start);
      const RunOptions options{
          .threads = 1, .executor = pool, .first = sensor.slot_from(start), .end = sensor.slot_from(end)};
      found += run(surveys[k], options, scans[k]).echoes;
    };
    pool.for_each(count, scan);
    points += found;
    if (step % rate == 0) times.push_back(0);
    times.back() += wall_seconds() - began;
  }
  report.row(name, {{"times real time", 1 / median(times)},
                    {"slowest second", 1 / *std::max_element(times.begin(), times.end())},
                    {"points/s of the drive", static_cast<double>(points / seconds)}});
}

}  // namespace

int main(int words_count, char** words) {
  Report report("robots", words_count, words);
  report.heading("a drive of " + std::to_string(seconds) + " s");
  const street::Scene town = street::scene(1);
  drive(report, "ten VLP-16", town);
  drive(report, "ten VLP-16, street as one mesh", scene_of(flattened(town)));
}
