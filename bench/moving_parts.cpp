// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of moving parts: cars drive around on a plain of 2 km by 2 km while a scanner on a mast turns. Time a pulse with
// 2 and with 2,000 of them, alternating. Rows are named duration/cars, and printed only once every hit of a sample is
// on its part's place at that time.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/motion.hpp>
#include <pulsecast/scene/moving_scene.hpp>

#include "../examples/tree.hpp"
#include "report.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

using Mesh = TriangleMesh<>;
using Cars = MovingScene<Mesh>;

/// A box of the size of a car, about the middle of its floor.
MeshData car() {
  MeshData data;
  for (int i = 0; i < 8; ++i) data.vertices.push_back({i & 1 ? 0.9 : -0.9, i & 2 ? 2.2 : -2.2, i & 4 ? 1.5 : 0.2});
  data.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
  return data;
}

/// A plain, and cars that go around blocks at 5 m/s to 15 m/s.
Cars plain(std::size_t cars, double seconds) {
  const MeshData ground{.vertices = {{-1000, -1000, 0}, {1000, -1000, 0}, {1000, 1000, 0}, {-1000, 1000, 0}},
                        .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const auto shape = std::make_shared<const Mesh>(car());
  std::vector<Cars::Part> parts{{.geometry = std::make_shared<const Mesh>(ground)}};
  wood::Dice dice(7, 0);
  for (std::size_t i = 0; i < cars; ++i) {
    const double speed = dice.between(5, 15), block = dice.between(30, 150), heading = dice.between(0, 2 * pi);
    const Vec3 way{speed * std::sin(-heading), speed * std::cos(-heading), 0};
    MotionSequence round;
    for (int side = 0; side < 4; ++side) {
      round.motions.push_back({.velocity = rotation_about(axis::up, side * pi / 2) * way, .duration = block / speed});
      round.motions.push_back({.angular_rate = pi / 2, .duration = 1});
    }
    parts.push_back(
        {.geometry = shape,
         .placement = {rotation_about(axis::up, heading), 1, {dice.between(-900, 900), dice.between(-900, 900), 0}},
         .object = static_cast<ObjectId>(i + 1),
         .motion = std::make_shared<const PartMotion>(std::vector<MotionSequence>{round}, 0)});
  }
  return Cars(std::move(parts), {0, seconds});
}

/// The pulses of a scanner of some lines on a mast; single rays, spread over the time.
std::vector<RayBundle> pulses(std::size_t count, double seconds) {
  std::vector<RayBundle> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count);
    const double elevation = -25_deg + 1.5_deg * static_cast<double>(i % 16);
    RayBundle ray = bundle_of(
        {{0, 0, 12},
         rotation_about(axis::up, 200 * pi * share) * rotation_about(axis::right, elevation) * axis::forward});
    ray.tick = Tick::of_seconds(share * seconds);
    all.push_back(ray);
  }
  return all;
}

double sum_of_ranges(const Cars& scene, const std::vector<RayBundle>& all) {
  std::array<Hit, 1> hits;
  double sum = 0;
  for (const RayBundle& ray : all) {
    scene.closest(ray, hits);
    if (hits[0].met()) sum += hits[0].range;
  }
  return sum;
}

/// Checks a sample of hits against a scene in which every part rests where it is at that time. Returns the number of
/// hits on cars.
std::size_t check(const Cars& scene, const std::vector<RayBundle>& all) {
  std::size_t met = 0;
  for (std::size_t i = 0; i < all.size(); i += all.size() / 200) {
    std::vector<Cars::Part> still(scene.parts().begin(), scene.parts().end());
    for (std::size_t k = 0; k < still.size(); ++k) {
      still[k].placement = scene.placement(k, all[i].tick);
      still[k].motion = nullptr;
    }
    std::array<Hit, 1> hit, expected;
    scene.closest(all[i], hit);
    Scene<Mesh>(std::move(still)).closest(all[i], expected);
    if (hit[0].range != expected[0].range || hit[0].object != expected[0].object) {
      std::printf("pulse %zu DIFFERS from parts at rest\n", i);
      std::exit(1);
    }
    met += hit[0].object > 0 ? 1 : 0;
  }
  return met;
}

void measure(bench::Report& report, double seconds) {
  const auto all = pulses(100'000, seconds);
  const std::array<std::size_t, 2> cars{2, 2000};
  std::vector<Cars> scenes;
  std::vector<double> built;
  std::vector<std::function<void()>> works;
  for (const std::size_t number : cars) {
    const double start = bench::process_seconds();
    scenes.push_back(plain(number, seconds));
    built.push_back(bench::process_seconds() - start);
  }
  for (const Cars& scene : scenes) works.emplace_back([&] { bench::keep(sum_of_ranges(scene, all)); });
  const std::vector<bench::Times> times = report.by_turns(works);
  report.heading("a survey of " + std::to_string(std::lround(seconds)) + " s");
  for (std::size_t k = 0; k < cars.size(); ++k)
    report.row(std::to_string(std::lround(seconds)) + "/" + std::to_string(cars[k]),
               {{"ns/pulse", 1e9 * bench::median(times[k]) / static_cast<double>(all.size())},
                {"times as fast as the first", bench::speed_ratio(times[k], times[0])},
                {"s to build", built[k]},
                {"MB", static_cast<double>(scenes[k].memory()) / 1e6},
                {"of 200 pulses on cars", static_cast<double>(check(scenes[k], all))}});
}

}  // namespace

int main(int count, char** words) {
  bench::Report report("moving_parts", count, words);
  measure(report, 60);
  measure(report, 3600);
}
