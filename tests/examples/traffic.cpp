// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include "../../examples/traffic.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/io/point_records.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/sensor/velodyne.hpp>

#include "support/allocations.hpp"

using namespace pulsecast;

namespace {

/// Loop of examples/robot_loop.cpp: town, 20 cars, and a robot that drives at 8 m/s.
struct Loop {
  street::Scene town = street::scene(1);
  std::vector<traffic::Vehicle> cars = traffic::cars(20, street::Dice(1, 7));
  std::vector<Placement> placements{};
  street::Scene moving = traffic::scene_of(cars), unused = moving;
  Layered<street::Scene, street::Scene> world{town, moving};
  traffic::Vehicle robot{.from = {1.9, -50}, .along = {0, 1}, .speed = 8};
  SpinningSensor sensor = velodyne_vlp_16();
  Platform<traffic::LivePath, SpinningSource> platform{{&robot}, Mount{.lever_arm = {0, 0, 1.9}}, sensor.source(1000)};
  Survey<decltype(platform), SingleRay, decltype(world), FirstHit> survey{platform,          SingleRay{}, world,
                                                                          sensor.receiver(), FirstHit{},  1};
  io::PointBuffer scan{io::layouts::velodyne(), {.sensor = [this](Tick t) { return platform.instrument_at(t); }}};
  PulseIndex slot = 0;

  void do_step(std::size_t step, bool moves, ThreadPool& pool) { do_step(step, moves, pool, {.executor = pool}); }
  void do_step(std::size_t step, bool moves, ThreadPool& pool, RunOptions options) {
    const Tick start = Tick::of(step, 60), end = Tick::of(step + 1, 60);
    if (moves) {
      robot.begin_step(start.seconds());
      for (traffic::Vehicle& car : cars) car.begin_step(start.seconds());
      traffic::place(cars, start.seconds(), placements);
      street::Scene next = moving.with_placements(placements, std::move(unused), pool);
      unused = std::exchange(moving, std::move(next));
    }
    if (step % 6 == 0) scan.begin_scan(start);
    options.first = slot;
    options.end = slot = sensor.slot_from(end);
    run(survey, options, scan);
  }
};

TEST_CASE("vehicles of the traffic go on from step to step without a jump, until they begin anew") {
  for (traffic::Vehicle car : traffic::cars(40, street::Dice(3, 7))) {
    const Vec3 expected = car.at(0.5).position;
    car.begin_step(0.5);
    const Vec2 off{car.pose.position.x - expected.x, car.pose.position.y - expected.y};
    CHECK((length(off) < 1e-9 || length(off) == doctest::Approx(2 * street::half_size.x)));
    CHECK(car.pose.position.z == street::height({car.pose.position.x, car.pose.position.y}));
    CHECK(car.at(0.5 + 1).position.z == car.pose.position.z);
    CHECK(length(car.at(1.5).position - car.pose.position) == doctest::Approx(car.speed));
  }
}

TEST_CASE("a sensor spins on between steps: the points of six steps are those of one run over a turn") {
  ThreadPool pool(2);
  Loop loop;
  loop.robot.speed = 0;
  for (std::size_t step = 0; step < 12; ++step) loop.do_step(step, false, pool);
  const std::vector<std::byte> records(loop.scan.records().begin(), loop.scan.records().end());
  CHECK(loop.scan.size() > 20'000);
  loop.scan.begin_scan(Tick::of(6, 60));
  run(loop.survey, {.first = loop.sensor.slot_from(Tick::of(6, 60)), .end = loop.sensor.slot_from(Tick::of(12, 60))},
      loop.scan);
  CHECK(std::equal(records.begin(), records.end(), loop.scan.records().begin(), loop.scan.records().end()));
}

TEST_CASE(
    "the scans of a robot that drives, brakes and is set back are the same with and without a pool, to the byte") {
  const auto scans = [](const auto& in_step) {
    Loop loop;
    std::vector<std::byte> all;
    for (std::size_t step = 0; step < 60; ++step) {
      loop.robot.speed = step % 4 == 3 ? 0 : 8.0 + static_cast<double>(step);
      if (step % 10 == 9) loop.robot.way = 7;
      in_step(loop, step);
      if (step % 6 == 5) all.insert(all.end(), loop.scan.records().begin(), loop.scan.records().end());
    }
    return all;
  };
  ThreadPool pool(2), builder(1);
  const auto with_pool = scans([&](Loop& loop, std::size_t step) { loop.do_step(step, true, pool); });
  const auto without = scans([&](Loop& loop, std::size_t step) { loop.do_step(step, true, builder, {.threads = 1}); });
  CHECK(with_pool.size() > 4'000'000);
  CHECK(with_pool == without);
}

TEST_CASE("the loop of a robot allocates nothing after its first second") {
  ThreadPool pool(2);
  Loop loop;
  std::size_t points = 0;
  for (std::size_t step = 0; step < 60; ++step) {
    loop.do_step(step, true, pool);
    points = std::max(points, loop.scan.size());
  }
  const std::size_t before = support::allocations;
  for (std::size_t step = 60; step < 180; ++step) loop.do_step(step, true, pool);
  CHECK(support::allocations == before);
  CHECK(points > 20'000);
}

}  // namespace
