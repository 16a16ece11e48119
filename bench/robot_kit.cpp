// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A robot in a street with 12 moving vehicles, physics at 100 Hz: a VLP-16 at ten turns a second, rotating prisms at
// 200 kHz in ten frames a second, a 2D scanner of 1,081 points at 40 Hz, and inertial samples at 400 Hz. How many times
// faster than real time it is: the median over ten seconds of the drive, and the least of them; processor time and
// allocations of a step after the first second.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/deflector/risley_prisms.hpp>
#include <pulsecast/io/point_records.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/sensor/imu.hpp>
#include <pulsecast/sensor/velodyne.hpp>
#include <pulsecast/sensor_kit.hpp>

#include "../examples/traffic.hpp"
#include "report.hpp"

namespace {
std::atomic<std::size_t> allocations = 0;
}
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

using namespace bench;
using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

constexpr std::size_t seconds = 10, rate = 100;

/// A robot's kit, and what its sensors gave.
struct Robot {
  traffic::Vehicle vehicle{.from = {1.9, -street::half_size.x}, .along = {0, 1}, .speed = 5};
  SensorKit kit{};
  std::size_t points = 0, samples = 0;

  template <class Source, class World>
  void add(const std::string& name, const Source& source, const World& world, const Receiver& receiver, double scans) {
    const Platform platform{traffic::LivePath{&vehicle}, Mount{.lever_arm = {0, 0, 1.9}}, source};
    io::PointBuffer buffer(io::layouts::velodyne(), {.sensor = [platform](Tick t) { return platform.instrument_at(t); },
                                                     .axes = io::PointAxes::forward_left_up});
    kit.add_scans(name, Survey{platform, SingleRay{}, world, receiver, FirstHit{}, 1}, scans, std::move(buffer),
                  [this](const io::PointBuffer& scan) { points += scan.size(); });
  }
};

void drive(Report& report, const street::Scene& town, unsigned threads) {
  const std::string name = "kit, " + std::to_string(threads) + " threads";
  if (!report.wanted(name)) return;
  std::vector<traffic::Vehicle> cars = traffic::cars(12, street::Dice(1, 7));
  std::vector<Placement> placements;
  street::Scene moving = traffic::scene_of(cars), unused = moving;
  const Layered world{town, moving};

  Robot robot;
  const SpinningSensor spinning = velodyne_vlp_16();
  const SpinningSensor flat{.lasers = {{}}, .sequence_rate = 40 * 1081 * 4 / 3.0, .rotation_rate = 40, .range_max = 30};
  const Deflector prisms{RisleyPrisms{.prisms = {{.wedge = 29.7_deg, .rotation_rate = -121.57},
                                                 {.wedge = 29.7_deg, .rotation_rate = 77.73, .inclined_exit = true}}},
                         Scanner{.pulse_rate = 200_kHz, .pulses = PulseIndex{1} << 40}};
  robot.add("spinning", spinning.source(1e6), world, spinning.receiver(), 10);
  robot.add("prisms", prisms, world, {.range_min = 0.05, .range_max = 260}, 10);
  robot.add("flat", flat.source(1e6), world, flat.receiver(), 40);
  const Imu imu{StraightLine{.to = {0, 100, 0}, .speed = 5}, Mount{.lever_arm = {0, 0, 1.9}}, stim_300(400)};
  robot.kit.add_samples("imu", 400, [&](PulseIndex i, Tick) {
    keep(imu.sample(i).velocity_increment.x);
    ++robot.samples;
  });

  ThreadPool pool(threads);
  Times times;
  times.reserve(seconds);
  std::size_t before = 0;
  double processor = 0;
  for (std::size_t step = 0; step < seconds * rate; ++step) {
    if (step == rate) {
      before = allocations;
      processor = process_seconds();
    }
    const double began = wall_seconds();
    const Tick start = Tick::of(step, static_cast<double>(rate)), end = Tick::of(step + 1, static_cast<double>(rate));
    robot.vehicle.begin_step(start.seconds());
    for (traffic::Vehicle& car : cars) car.begin_step(start.seconds());
    traffic::place(cars, 0.5 * (start.seconds() + end.seconds()), placements);
    street::Scene next = moving.with_placements(placements, std::move(unused), pool);
    unused = std::exchange(moving, std::move(next));
    robot.kit.step(end, pool);
    if (step % rate == 0) times.push_back(0);
    times.back() += wall_seconds() - began;
  }
  const double steps = (seconds - 1) * rate, of_step = 1e3 * (process_seconds() - processor) / steps;
  const double allocated = static_cast<double>(allocations - before) / steps;
  report.row(name, {{"times real time", 1 / median(times)},
                    {"slowest second", 1 / *std::max_element(times.begin(), times.end())},
                    {"ms of processor a step", of_step},
                    {"allocations a step", allocated},
                    {"points/s of the drive", static_cast<double>(robot.points / seconds)},
                    {"inertial samples/s", static_cast<double>(robot.samples / seconds)}});
}

}  // namespace

int main(int words_count, char** words) {
  Report report("robot_kit", words_count, words);
  report.heading("a drive of " + std::to_string(seconds) + " s");
  const street::Scene town = street::scene(1);
  for (const unsigned threads : {2U, 1U}) drive(report, town, threads);
}
