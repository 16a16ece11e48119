// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/sensor_kit.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/scratch_memory.hpp>
#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/deflector/risley_prisms.hpp>
#include <pulsecast/io/point_records.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/sensor/spinning_sensor.hpp>

#include "support/allocations.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

using BodyPose = Pose<frame::Body, frame::World>;
using Room = Scene<TriangleMesh<>>;

/// Inner sides of a box about the origin.
std::shared_ptr<const TriangleMesh<>> box(const Vec3& half) {
  MeshData mesh;
  for (unsigned k = 0; k < 8; ++k)
    mesh.vertices.push_back({(k & 1 ? 1 : -1) * half.x, (k & 2 ? 1 : -1) * half.y, (k & 4 ? 1 : -1) * half.z});
  mesh.triangles = {{0, 1, 2}, {1, 2, 3}, {4, 5, 6}, {5, 6, 7}, {0, 1, 4}, {1, 4, 5},
                    {2, 3, 6}, {3, 6, 7}, {0, 2, 4}, {2, 4, 6}, {1, 3, 5}, {3, 5, 7}};
  return std::make_shared<const TriangleMesh<>>(mesh);
}
const Room room({{.geometry = box({20, 30, 5})}});

/// Drive in a circle, as a function of time.
struct Circle {
  BodyPose at(Tick t) const noexcept {
    const double angle = 0.4 * t.seconds();
    return {level(angle), {5 * std::sin(angle), 5 * std::cos(angle), 0.1 * std::sin(3 * angle)}};
  }
};
/// Pose that a program sets between steps.
struct Live {
  const BodyPose* pose;
  BodyPose at(Tick) const noexcept { return *pose; }
};
/// Pose after so many jumps.
BodyPose jump(int k) {
  return {rotation_about(axis::up, 0.7 * k), {9 * std::sin(k), 12 * std::cos(2 * k), std::sin(3 * k)}};
}

const SpinningSensor spinning{.lasers = {{-0.1, 0, 0, 0}, {0, 0.01, 0, 20e-6}, {0.1, 0, 0.02, 40e-6}},
                              .sequence_rate = 4321};
const SpinningSensor flat{.lasers = {{0, 0, 0, 0}}, .sequence_rate = 40 * 270, .rotation_rate = 40};
const Deflector prisms{RisleyPrisms{.prisms = {{.wedge = 18.7_deg, .rotation_rate = -121.6},
                                               {.wedge = 18.0_deg, .rotation_rate = 77.7, .inclined_exit = true}}},
                       Scanner{.pulse_rate = 7013, .pulses = 7013 * 60}};

/// Record of all calls of a kit's user.
struct Log {
  struct Call {
    std::string name;
    Tick due;
    std::vector<std::byte> data;
    bool operator==(const Call&) const = default;
  };
  std::vector<Call> calls;

  void add(std::string name, Tick due, std::span<const std::byte> data) {
    calls.push_back({std::move(name), due, {data.begin(), data.end()}});
  }
};

template <class Path, class Source, class Map>
void add_scans(SensorKit& kit, Log& log, const std::string& name, double rate, const Path& path, const Source& source,
               const Map& map, io::MotionDistortion distortion = io::MotionDistortion::kept) {
  const Platform platform{path, Mount{.lever_arm = {0.2, 0.1, 0.5}}, source};
  const Survey survey{platform, SingleRay{}, map, Receiver{.range_errors = {.deviation = 0.01}}, FirstHit{}, 7};
  io::PointBuffer buffer(io::layouts::velodyne(), {.sensor = [platform](Tick t) { return platform.instrument_at(t); },
                                                   .distortion = distortion});
  kit.add_scans(name, survey, rate, std::move(buffer), [&log, name, rate](const io::PointBuffer& scan) {
    log.add(name, scan.scan_start() + Tick::of_seconds(1 / rate), scan.records());
  });
}

/// Three scanners, poses, and a clock of a rate that divides nothing.
template <class Path, class Map>
void add_all(SensorKit& kit, Log& log, const Path& path, const Map& map) {
  add_scans(kit, log, "spinning", 10, path, spinning.source(60), map);
  add_scans(kit, log, "prisms", 9.7, path, prisms, map, io::MotionDistortion::removed);
  kit.add_samples("pose", 100, [&log, path](PulseIndex, Tick t) {
    const BodyPose pose = path.at(t);
    log.add("pose", t, std::as_bytes(std::span(&pose.position, 1)));
  });
  add_scans(kit, log, "flat", 40, path, flat.source(60), map);
  kit.add_samples("clock", 33.3,
                  [&log](PulseIndex i, Tick t) { log.add("clock", t, std::as_bytes(std::span(&i, 1))); });
}

/// Calls of a kit that is stepped to one second in steps of a rate.
Log stepped(double steps_per_second, const Workers& workers = {1}) {
  Log log;
  SensorKit kit;
  add_all(kit, log, Circle{}, room);
  for (PulseIndex i = 1; kit.time() < Tick{1, 0}; ++i)
    kit.step(std::min(Tick{1, 0}, Tick::of(i, steps_per_second)), workers);
  return log;
}

/// Executors of a user: as in the cookbook, and one that needs no threads.
struct ThreadPerTask {
  ScratchMemory kept{};
  unsigned threads() const { return 3; }
  void for_each(std::size_t count, const IndexTask& task) {
    std::vector<std::jthread> all;
    for (std::size_t i = 0; i < count; ++i) all.emplace_back([&task, i] { task(i); });
  }
  ScratchMemory& memory() { return kept; }
};
struct LastTaskFirst {
  ScratchMemory kept{};
  unsigned threads() const { return 3; }
  void for_each(std::size_t count, const IndexTask& task) {
    while (count-- > 0) task(count);
  }
  ScratchMemory& memory() { return kept; }
};
static_assert(MemoryKeepingExecutor<ThreadPerTask> && MemoryKeepingExecutor<LastTaskFirst>);

/// Kit of a robot that jumps between steps, and of a world that changes with it.
struct JumpingRobot {
  Log log{};
  BodyPose pose = jump(0);
  Room moving = Room({{.geometry = box({1, 1, 1})}, {.geometry = box({0.5, 2, 1})}}), unused = moving;
  Layered<Room, Room> world{room, moving};
  SensorKit kit{};
  std::vector<Placement> placements{2};

  JumpingRobot() { add_all(kit, log, Live{&pose}, world); }
  void do_step(int k, const Workers& workers) {
    pose = jump(k);
    placements[0].translation = {15, 3.0 * std::sin(k), 0};
    placements[1].translation = {-12, 20 * std::cos(k), 1};
    Room next = moving.with_placements(placements, std::move(unused), {1});
    unused = std::exchange(moving, std::move(next));
    kit.step(Tick::of(static_cast<PulseIndex>(k) + 1, 60), workers);
  }
};

Log of_jumps(const Workers& workers) {
  JumpingRobot robot;
  for (int k = 0; k < 60; ++k) robot.do_step(k, workers);
  return robot.log;
}

}  // namespace

TEST_CASE("a kit gives every scan and sample once, at the time at which it is due, then in the order of adding") {
  const Log log = stepped(100);
  const auto count = [&](const char* name) {
    return std::count_if(log.calls.begin(), log.calls.end(), [&](const Log::Call& call) { return call.name == name; });
  };
  CHECK(count("spinning") == 10);
  CHECK(count("prisms") == 9);
  CHECK(count("flat") == 40);
  CHECK(count("pose") == 101);
  CHECK(count("clock") == 34);
  for (std::size_t i = 1; i < log.calls.size(); ++i)
    CHECK((log.calls[i].due - log.calls[i - 1].due).seconds() > -1e-12);
  const auto due_at = [&](double time) {
    std::string names;
    for (const Log::Call& call : log.calls)
      if (std::fabs(call.due.seconds() - time) < 1e-12) names += call.name + " ";
    return names;
  };
  CHECK(due_at(0) == "pose clock ");
  CHECK(due_at(0.05) == "pose flat ");
  CHECK(due_at(0.1) == "spinning pose flat ");
  CHECK(due_at(1 / 9.7) == "prisms ");
}

TEST_CASE("a kit gives the same data for steps of any length, where poses are functions of time") {
  const Log all = stepped(1);
  CHECK(all.calls.size() == 10 + 9 + 40 + 101 + 34);
  for (const double rate : {2.0, 7.0, 100.0, 977.0, 4321 / 3.0, 4321.0}) {
    CAPTURE(rate);
    CHECK((stepped(rate).calls == all.calls));
  }
}

TEST_CASE("the scans of a kit are those of runs over their slots") {
  const Log log = stepped(100);
  const Platform platform{Circle{}, Mount{.lever_arm = {0.2, 0.1, 0.5}}, spinning.source(60)};
  const Survey survey{platform, SingleRay{}, room, Receiver{.range_errors = {.deviation = 0.01}}, FirstHit{}, 7};
  io::PointBuffer buffer(io::layouts::velodyne(), {.sensor = [&](Tick t) { return platform.instrument_at(t); }});
  PulseIndex number = 0;
  for (const Log::Call& call : log.calls) {
    if (call.name != "spinning") continue;
    const Tick from = Tick::of(number, 10), to = Tick::of(++number, 10);
    buffer.begin_scan(from);
    run(survey, {.first = survey.slot_from(from), .end = survey.slot_from(to)}, buffer);
    CHECK(buffer.size() > 1000);
    CHECK(std::ranges::equal(call.data, buffer.records()));
  }
}

TEST_CASE("the data of a robot that jumps between steps are the same for any executor and number of threads") {
  const Log one = of_jumps({1});
  CHECK(one.calls.size() > 180);
  ThreadPool of_one(1), of_two(2), of_three(3);
  ThreadPerTask own;
  LastTaskFirst alone;
  CHECK((of_jumps({3}).calls == one.calls));
  CHECK((of_jumps(of_one).calls == one.calls));
  CHECK((of_jumps(of_two).calls == one.calls));
  CHECK((of_jumps(of_three).calls == one.calls));
  CHECK((of_jumps(own).calls == one.calls));
  CHECK((of_jumps(alone).calls == one.calls));
}

TEST_CASE("points of a scan over several steps are in the sensor's frame of each step, or of the scan's first") {
  // a wall of the room, seen by one beam from a robot that jumps sidewards and towards it
  for (const auto distortion : {io::MotionDistortion::kept, io::MotionDistortion::removed}) {
    BodyPose pose;
    const Platform platform{Live{&pose}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulse_rate = 100, .pulses = 1000}}};
    const Survey survey{platform, SingleRay{}, room, Receiver{}, FirstHit{}};
    std::vector<double> forward;
    SensorKit kit;
    io::PointBuffer buffer(io::layouts::xyzi(),
                           {.sensor = [&](Tick t) { return platform.instrument_at(t); }, .distortion = distortion});
    kit.add_scans("beam", survey, 10, buffer, [&](const io::PointBuffer& scan) {
      for (std::size_t i = 0; i < scan.size(); ++i) forward.push_back(scan.number(i, scan.layout().fields[1]));
    });
    std::vector<double> expected;
    for (int k = 0; k < 6; ++k) {  // steps of 0.05 s, so that a scan has two
      pose.position.y = 3.0 * k;
      kit.step(Tick::of(static_cast<PulseIndex>(k) + 1, 20));
      const double seen_from = distortion == io::MotionDistortion::kept ? 3.0 * k : 3.0 * (k - k % 2);
      expected.insert(expected.end(), 5, 30 - seen_from);
    }
    REQUIRE(forward.size() == expected.size());
    for (std::size_t i = 0; i < forward.size(); ++i) CHECK(forward[i] == doctest::Approx(expected[i]).epsilon(1e-6));
  }
}

TEST_CASE("a kit with a pool, or another executor with memory, allocates nothing after its first second") {
  ThreadPool of_one(1), of_two(2);
  LastTaskFirst own;
  for (const Workers& workers : {Workers(of_one), Workers(of_two), Workers(own)}) {
    JumpingRobot robot;
    SensorKit kit;
    Log unused;
    std::size_t points = 0, samples = 0;
    const auto add = [&](const std::string& name, const auto& source, double rate) {
      const Platform platform{Live{&robot.pose}, Mount{}, source};
      const Survey survey{platform, SingleRay{}, robot.world, Receiver{}, FirstHit{}};
      kit.add_scans(name, survey, rate,
                    io::PointBuffer(io::layouts::velodyne(),
                                    {.sensor = [platform](Tick t) { return platform.instrument_at(t); }}),
                    [&](const io::PointBuffer& scan) { points += scan.size(); });
    };
    add("spinning", spinning.source(60), 10);
    add("prisms", prisms, 10);
    add("flat", flat.source(60), 40);
    kit.add_samples("pose", 400, [&](PulseIndex, Tick) { ++samples; });
    std::size_t before = 0;
    for (int k = 0; k < 240; ++k) {
      if (k == 80) before = support::allocations;
      robot.pose = jump(k % 8);
      kit.step(Tick::of(static_cast<PulseIndex>(k) + 1, 60), workers);
    }
    CHECK(support::allocations == before);
    CHECK(points > 50'000);
    CHECK(samples == 1601);
  }
}

TEST_CASE("a sensor that is added late begins with its next whole scan, and gives what it would have given then") {
  const Log all = stepped(100);
  Log log;
  SensorKit kit;
  kit.step(Tick::of(234, 1000));
  add_all(kit, log, Circle{}, room);
  CHECK(kit.time() == Tick::of(234, 1000));
  kit.step({1, 0});
  std::vector<Log::Call> expected;
  for (const Log::Call& call : all.calls) {
    const double rate = call.name == "spinning" ? 10 : call.name == "prisms" ? 9.7 : call.name == "flat" ? 40 : 0;
    if (call.due.seconds() - (rate > 0 ? 1 / rate : 0) > 0.234 - 1e-9) expected.push_back(call);
  }
  CHECK((log.calls == expected));

  Log of_begin;
  SensorKit resumed(Tick::of(234, 1000));  // a drive that goes on from there
  add_all(resumed, of_begin, Circle{}, room);
  resumed.step({1, 0});
  CHECK((of_begin.calls == expected));
}

TEST_CASE("a sensor gives no scan that begins after its survey, and its last one in full time") {
  Log log;
  SensorKit kit;
  add_scans(kit, log, "short", 10, Circle{}, flat.source(0.25), room);
  kit.step({0, 0.26});
  CHECK(log.calls.size() == 2);
  kit.step({1, 0});
  REQUIRE(log.calls.size() == 3);
  CHECK(log.calls[2].data.size() < log.calls[1].data.size());
  CHECK(log.calls[2].data.size() > 0);
}

TEST_CASE("a kit refuses a step backwards, rates out of range, names that it has, and surveys without slots of times") {
  SensorKit kit;
  const auto nothing = [](PulseIndex, Tick) {};
  kit.add_samples("imu", 400, nothing);
  CHECK_THROWS_WITH_AS(kit.add_samples("imu", 400, nothing),
                       "sensor 'imu' has the name of another: expected one of its own", SettingError);
  CHECK_THROWS_WITH_AS(kit.add_samples("clock", 0, nothing),
                       "sensor 'clock': rate is 0 Hz, but must be from 0.001 to 1e+06", SettingError);
  kit.step({1, 0.5});
  kit.step({1, 0.5});
  CHECK_THROWS_WITH_AS(kit.step({1, 0.25}),
                       "SensorKit::step (until) is 1.25 s, but must be at least 1.5, the time of the last step",
                       SettingError);
  struct Timeless : Deflector<FixedBeam, Scanner> {
    PulseIndex slot_from(Tick) const noexcept = delete;
  };
  const Platform platform{Circle{}, Mount{}, Timeless{{FixedBeam{}, Scanner{}}}};
  const Survey survey{platform, SingleRay{}, room, Receiver{}, FirstHit{}};
  CHECK_THROWS_WITH_AS(
      kit.add_scans("old", survey, 10, io::PointBuffer(io::layouts::xyzi()), [](const io::PointBuffer&) {}),
      "sensor 'old' has a survey that finds no slots: expected a source with slot_from(tick)", SettingError);
}

TEST_CASE("callbacks may add sensors and throw, and begin no step; a sink may add sensors") {
  SensorKit kit;
  Log log;
  int calls = 0;
  kit.add_samples("clock", 10, [&](PulseIndex i, Tick t) {
    ++calls;
    CHECK_THROWS_WITH_AS(kit.step(t + Tick{1, 0}), doctest::Contains("is called in a step"), SettingError);
    if (i == 1) throw std::runtime_error("mine");
  });
  struct Adds {
    SensorKit* kit;
    int scans = 0;
    void begin_scan(Tick) {
      for (int k = 0; k < 20; ++k)
        kit->add_samples("late" + std::to_string(scans) + "," + std::to_string(k), 7, [](PulseIndex, Tick) {});
      ++scans;
    }
    void operator()(const EchoBatch&) const {}
  };
  const Platform platform{Circle{}, Mount{}, flat.source(60)};
  int scans = 0;
  kit.add_scans("adds", Survey{platform, SingleRay{}, room, Receiver{}, FirstHit{}}, 10, Adds{&kit},
                [&](const Adds&) { ++scans; });
  CHECK_THROWS_WITH_AS(kit.step({1, 0}), "mine", std::runtime_error);
  CHECK(calls == 2);
  kit.step({1, 0});
  CHECK(calls == 11);
  CHECK(scans == 10);
}

TEST_CASE("an error of a sensor's pose ends the step, as it ends a run") {
  Log log;
  SensorKit kit;
  BodyPose pose;
  add_scans(kit, log, "flat", 40, Live{&pose}, flat.source(60), room);
  kit.step({0, 0.5});
  pose.position.x = std::nan("");
  CHECK_THROWS_AS(kit.step({1, 0}), std::runtime_error);
}
