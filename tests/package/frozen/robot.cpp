// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A robot drives down a street with a spinning sensor. Each turn is a scan in the sensor's frame, while other cars
// move.
#include <array>
#include <iostream>
#include <memory>
#include <utility>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/io/point_records.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/sensor/velodyne.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

struct Robot {
  const double* y;  // [m]
  Pose<frame::Body, frame::World> at(Tick) const noexcept { return {.position = {0, *y, 0}}; }
};
static_assert(Trajectory<Robot>);

int main() {
  const MeshData road{.vertices = {{-40, -90, 0}, {40, -90, 0}, {40, 90, 0}, {-40, 90, 0}},
                      .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const MeshData board{.vertices = {{-1, 0, 0}, {1, 0, 0}, {1, 0, 2}, {-1, 0, 2}}, .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const auto asphalt = material_table({{.name = "asphalt", .reflectance = 0.2, .classification = 11}});
  const Scene<TriangleMesh<>> street(
      {{.geometry = std::make_shared<const TriangleMesh<>>(road), .materials = asphalt}});
  Scene<TriangleMesh<>> cars({{.geometry = std::make_shared<const TriangleMesh<>>(board), .object = 7}});
  Scene<TriangleMesh<>> unused = cars;
  const Layered world{street, cars};

  double y = 0;
  const SpinningSensor sensor = velodyne_vlp_16();
  const Platform platform{Robot{&y}, Mount{.lever_arm = {0, 0, 1.9}}, sensor.source(1e6)};
  const Survey survey{platform, SingleRay{}, world, sensor.receiver(), FirstHit{}};
  io::PointBuffer scan(io::layouts::velodyne(), {.sensor = [&](Tick t) { return platform.instrument_at(t); },
                                                 .axes = io::PointAxes::forward_left_up,
                                                 .rings = sensor.rings()});
  ThreadPool pool(2);
  PulseIndex slot = 0;
  for (std::uint64_t turn = 0; turn < 3; ++turn) {
    const std::array placements{Placement{.translation = {1.5, 12 + y, 0}}};
    Scene<TriangleMesh<>> next = cars.with_placements(placements, std::move(unused), pool);
    unused = std::exchange(cars, std::move(next));
    scan.begin_scan(Tick::of(turn, 10));
    const PulseIndex end = sensor.slot_from(Tick::of(turn + 1, 10));
    const RunSummary summary = run(survey, {.executor = pool, .first = slot, .end = end}, scan);
    slot = end;
    double sum = 0;
    for (std::size_t i = 0; i < scan.size(); ++i)
      for (const io::PointField& field : scan.layout().fields) sum += scan.number(i, field);
    std::cout << std::hexfloat << summary.echoes << ' ' << scan.size() << ' ' << sum << '\n';
    y += 0.5;
  }
}
