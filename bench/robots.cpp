// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Ten robots with a VLP-16 each, ten turns a second, in one street with 20 moving cars: the loop of
// examples/robot_loop.cpp, step by step at 60 Hz. Prints how many times faster than real time it is: the median over
// ten seconds of the drive, and the least of them. Usage: bench_robots [ROBOTS [THREADS]]

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/io/point_records.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/sensor/velodyne.hpp>

#include "../examples/traffic.hpp"
#include "report.hpp"

using namespace pulsecast;

/// The parts of a scene as one mesh, without their materials and objects.
street::Scene flat(const street::Scene& scene) {
  MeshData all;
  for (const street::Scene::Part& part : scene.parts())
    for (std::size_t i = 0; i < part.geometry->size(); ++i) {
      const Triangle t = part.geometry->triangle(static_cast<PrimitiveIndex>(i));
      const auto first = static_cast<std::uint32_t>(all.vertices.size());
      for (const Vec3& corner : {t.a, t.b, t.c}) all.vertices.push_back(part.placement.point(corner));
      all.triangles.push_back({first, first + 1, first + 2});
    }
  return street::Scene({{std::make_shared<const street::Mesh>(all), material_table(), {}, 0, "street", {}}});
}

int main(int argc, char** argv) {
  const bool is_flat = argc > 1 && std::string_view(argv[1]) == "--flat";
  argc -= is_flat ? 1 : 0;
  argv += is_flat ? 1 : 0;
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 10, seconds = 10, rate = 60;
  const unsigned threads = argc > 2 ? static_cast<unsigned>(std::strtoul(argv[2], nullptr, 10)) : 0;
  const street::Scene town = is_flat ? flat(street::scene(1)) : street::scene(1);
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

  ThreadPool pool(threads);
  bench::Times times;
  std::size_t points = 0;
  for (std::size_t step = 0; step < seconds * rate; ++step) {
    const double began = bench::wall_seconds();
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
    times.back() += bench::wall_seconds() - began;
  }
  std::printf("%zu robots, %u threads, %zu points a second: %.2f times real time, the slowest second %.2f times\n",
              count, pool.threads(), points / seconds, 1 / bench::median(times),
              1 / *std::max_element(times.begin(), times.end()));
}
