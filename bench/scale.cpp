// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Growth of the cost with threads, triangles, instances and subrays. Threads are measured by wall-clock time, while
// nothing else should run; the rest by processor time of one thread. A row is printed only once the accelerator has
// given the same hits as `Linear` on a sample. Rows are named by the varied quantity and its value: `--only
// 'triangles/*'`. Ten million triangles take some 2 GB.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <pulsecast/accel/linear.hpp>
#include <pulsecast/pulsecast.hpp>

#include "report.hpp"
#include "scenes.hpp"
#include "surveys.hpp"

using namespace bench;

namespace {

std::string named(const std::string& what, std::size_t number) { return what + "/" + std::to_string(number); }

void fail(const std::string& name) {
  std::printf("%s DIFFERS from Linear\n", name.c_str());
  std::exit(1);
}

void grow_threads(Report& report) {
  const unsigned most = std::thread::hardware_concurrency();
  const auto scene = scene_of(hills(866).mesh());
  const Survey survey{airplane(100'000), SunflowerFootprint{19}, scene, Receiver{}, FullWaveform{}};
  std::vector<std::string> names;
  std::vector<std::function<void()>> works;
  std::vector<Times> busy;  // processors, on average, in each go
  busy.reserve(most);
  for (unsigned n = 1; n <= most; n = n < most && 2 * n > most ? most : 2 * n) {
    if (!report.wanted(named("threads", n))) continue;
    names.push_back(named("threads", n));
    busy.emplace_back();
    works.emplace_back([&survey, &busy = busy.back(), n] {
      const double start = process_seconds(), start_wall = wall_seconds();
      run(survey, {.threads = n}, [](const EchoBatch&) {});
      busy.push_back((process_seconds() - start) / (wall_seconds() - start_wall));
    });
  }
  if (works.empty()) return;
  report.heading("an airplane over 1.5 million triangles, 19 subrays, to no file");
  const std::vector<Times> times = report.by_turns(works, wall_seconds);
  for (std::size_t i = 0; i < works.size(); ++i)
    report.row(names[i], {{"Mpulses/s", static_cast<double>(survey.size()) / median(times[i]) / 1e6},
                          {"times as fast as the first", speed_ratio(times[i], times[0])},
                          {"processors busy", median(busy[i])}});
}

void grow_triangles(Report& report) {
  const Bundles all = beams(from_the_air(), 19, 0.25_mrad), some = all.sample(8);
  bool first = true;
  for (const std::size_t number : {1'000U, 10'000U, 100'000U, 1'000'000U, 10'000'000U}) {
    const std::string name = named("triangles", number);
    if (!report.wanted(name)) continue;
    if (std::exchange(first, false)) report.heading("hills from the air, beams of 19");
    MeshData data = hills(static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(number) / 2)))).mesh();
    const double triangles = static_cast<double>(data.triangles.size());
    const auto expected = answers(TriangleMesh<Linear<>>(data), some);
    const double start = process_seconds();
    const Mesh mesh(std::move(data));
    const double built = process_seconds() - start;
    if (answers(mesh, some) != expected) fail(name);
    const auto times = report.by_turns({[&] { keep(sum_of_ranges(mesh, all)); }});
    const double each = 1e9 * median(times[0]) / static_cast<double>(all.size());
    report.row(name, {{"ns/beam", each},
                      {"ns/beam by log2(n)", each / std::log2(triangles)},
                      {"ns to build/triangle", 1e9 * built / triangles},
                      {"bytes/triangle", static_cast<double>(mesh.memory()) / triangles}});
  }
}

/// Down from 300 m, in lines of 64 pulses, 10 cm apart, that lie anywhere in a square of twice `half`.
Aims lines_over(double half, wood::Dice& dice) {
  Aims aims;
  for (std::size_t line = 0; line < 64; ++line) {
    const double width = std::min(6.4, 2 * half), x = dice.between(-half, half - width), y = dice.between(-half, half);
    for (std::size_t i = 0; i < 64; ++i)
      aims.push_back({{x + width * static_cast<double>(i) / 64, y, 300}, rotation_about(axis::right, -90_deg)});
  }
  return aims;
}

/// A wood of one tree, many times, 8 m apart, turned and sized at random, seen from above.
void grow_instances(Report& report) {
  const auto shape = std::make_shared<const Mesh>(tree());
  const auto materials = material_table(std::vector<Material>(shape->material_count()));
  bool first = true;
  for (const std::size_t number : {1U, 10U, 100U, 1'000U, 10'000U, 100'000U}) {
    const std::string name = named("instances", number);
    if (!report.wanted(name)) continue;
    if (std::exchange(first, false))
      report.heading("a wood from above, " + std::to_string(shape->size()) + " triangles a tree, beams of 19");
    const auto row = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(number))));
    const double half = 4.0 * static_cast<double>(row);
    wood::Dice dice(5, 0);
    std::vector<Scene<Mesh>::Part> parts;
    for (std::size_t i = 0; i < number; ++i) {
      const Vec3 foot{8.0 * static_cast<double>(i % row) + 4 - half, 8.0 * static_cast<double>(i / row) + 4 - half, 0};
      parts.push_back({.geometry = shape,
                       .materials = materials,
                       .placement = {rotation_about(axis::up, dice.between(0, 2 * pi)), dice.between(0.7, 1.2), foot},
                       .object = static_cast<ObjectId>(i)});
    }
    const double start = process_seconds();
    const Scene<Mesh> scene(std::move(parts));
    const double built = process_seconds() - start;

    const Bundles all = beams(lines_over(half, dice), 19, 0.3_mrad);
    std::vector<Hit> hits(RayBundle::capacity), expected(RayBundle::capacity);
    const auto check = [&](std::size_t i) {  // against all parts one by one
      const RayBundle rays = all[i];
      scene.closest(rays, hits);
      ClosestHits nearest(rays);
      for (std::size_t p = 0; p < number; ++p) {
        nearest.part = std::uint64_t{p} << 32;
        shape->closest(scene.parts()[p].placement.to_local(rays), nearest);
      }
      for (std::size_t j = 0; j < rays.size; ++j)
        if (hits[j].range != nearest.range[j] || (hits[j].met() && hits[j].object != nearest.part_of(j))) fail(name);
    };
    for (std::size_t i = 0; i < all.size(); i += all.size() / 8) check(i);
    std::size_t met = 0;
    const auto times = report.by_turns({[&] {
      met = 0;
      for (std::size_t i = 0; i < all.size(); ++i) {
        const RayBundle rays = all[i];
        scene.closest(rays, hits);
        for (std::size_t j = 0; j < rays.size; ++j) met += hits[j].met() ? 1U : 0U;
      }
    }});
    report.row(name, {{"ns/beam", 1e9 * median(times[0]) / static_cast<double>(all.size())},
                      {"% of rays meet a tree", 100 * static_cast<double>(met) / static_cast<double>(19 * all.size())},
                      {"ns to build/instance", 1e9 * built / static_cast<double>(number)},
                      {"bytes/instance",
                       static_cast<double>(scene.memory() - shape->memory()) / static_cast<double>(number)}});
  }
}

void grow_subrays(Report& report) {
  const auto measure = [&](const std::string& scene, const MeshData& data, const Aims& aims, double divergence) {
    const std::vector<std::size_t> numbers{1, 3, 7, 19, 37, 61, 127, 279};
    if (std::none_of(numbers.begin(), numbers.end(),
                     [&](std::size_t n) { return report.wanted(named("subrays/" + scene, n)); }))
      return;
    const Mesh mesh(data);
    report.heading(scene + ", " + std::to_string(mesh.size()) + " triangles");
    for (const std::size_t number : numbers) {
      const std::string name = named("subrays/" + scene, number);
      if (!report.wanted(name)) continue;
      const Bundles all = beams(aims, number, divergence), some = all.sample(8);
      if (answers(mesh, some) != answers(TriangleMesh<Linear<>>(data), some)) fail(name);
      const auto times = report.by_turns({[&] { keep(sum_of_ranges(mesh, all)); }});
      const double each = 1e9 * median(times[0]) / static_cast<double>(aims.size());
      report.row(name, {{"ns/beam", each}, {"ns/subray", each / static_cast<double>(number)}});
    }
  };
  measure("hills", hills(866).mesh(), from_the_air(), 0.25_mrad);
  const MeshData one = tree();
  measure("tree", one, from_a_tripod(bounds_of(one)), 0.3_mrad);
}

}  // namespace

int main(int count, char** words) {
  Report report("scale", count, words);
  grow_threads(report);
  grow_triangles(report);
  grow_instances(report);
  grow_subrays(report);
}
