// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Many rays at once: batches of poses in a street of some 50,000 triangles and over hills of 1.5 million, on all
// threads, and on one beside single rays of Embree 3; and `closest_hits` beside single rays in the street, on one
// thread. Rows are named after rays by channels and columns; `differ` counts hits that are not the same.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/closest_hits.hpp>
#include <pulsecast/scene/run_batch.hpp>

#include "report.hpp"
#include "scenes.hpp"
#include "surveys.hpp"
#ifdef PULSECAST_BENCH_EMBREE
#include "embree.hpp"
#endif

using namespace bench;

namespace {

using Poses = std::vector<Pose<frame::Instrument, frame::World>>;

/// Rays of a spinning head, column by column, over a height of `fan` about the horizon.
std::vector<Ray> lidar(int channels, int columns, double fan) {
  std::vector<Ray> rays;
  for (int column = 0; column < columns; ++column)
    for (int channel = 0; channel < channels; ++channel) {
      const double up = fan * (static_cast<double>(channel) / (channels - 1) - 0.5);
      rays.push_back({.direction = rotation_about(axis::up, 2 * pi * column / columns) *
                                   rotation_about(axis::right, up) * axis::forward});
    }
  return rays;
}

/// Rays of a camera, line by line.
std::vector<Ray> camera(int width, int height, double pixel) {
  std::vector<Ray> rays;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      rays.push_back({.direction = normalize(Vec3{pixel * (x - width / 2), 1, pixel * (y - height / 2)})});
  return rays;
}

/// Poses along both streets, 1.8 m above the ground, with headings all around.
Poses places(std::size_t count) {
  Poses all;
  for (std::size_t p = 0; p < count; ++p) {
    const double along = -60 + 120 * static_cast<double>(p) / static_cast<double>(count);
    const Vec2 at = p % 2 == 0 ? Vec2{2, along} : Vec2{along, 2};
    all.push_back({rotation_about(axis::up, 0.37 * static_cast<double>(p)), street::on(at) + Vec3{0, 0, 1.8}});
  }
  return all;
}

/// Poses all over the hills, 1.8 m above the ground.
Poses places_on(const Scene<Mesh>& hills, std::size_t count) {
  Poses all;
  for (std::size_t p = 0; p < count; ++p) {
    const double turn = 2.4 * static_cast<double>(p),
                 radius = 400 * std::sqrt(static_cast<double>(p) / static_cast<double>(count));
    const Vec3 sky{radius * std::cos(turn), radius * std::sin(turn), 200};
    const auto ground = hills.closest_hit({.origin = sky, .direction = -axis::up});
    all.push_back({rotation_about(axis::up, turn), sky - (ground->range - 1.8) * axis::up});
  }
  return all;
}

struct Sensor {
  std::string name;
  std::vector<Ray> rays;
};

/// A batch on all threads and on one, and there beside Embree's single rays.
void measure_batch(Report& report, const std::string& scene_name, const Scene<Mesh>& scene, const Sensor& sensor,
                   const Poses& poses) {
  const std::string name = scene_name + ", " + std::to_string(poses.size()) + " poses, " + sensor.name;
  if (!report.wanted(name)) return;
  std::vector<float> ranges(poses.size() * sensor.rays.size());
  const double rays = static_cast<double>(ranges.size());
  const std::vector<Times> wall =
      report.by_turns({[&] { run_batch(scene, poses, sensor.rays, ranges); }}, wall_seconds);
  Figures figures{{"scans/s", static_cast<double>(poses.size()) / median(wall[0])},
                  {"Mrays/s", rays / median(wall[0]) / 1e6}};
  std::vector<std::function<void()>> works{[&] { run_batch(scene, poses, sensor.rays, ranges, {{}, 1}); }};
#ifdef PULSECAST_BENCH_EMBREE
  Bundles bundles;
  for (const auto& pose : poses)
    for (const Ray& ray : sensor.rays)
      bundles.add(bundle_of({.origin = pose.position, .direction = pose.direction(ray.direction)}));
  EmbreeRays<1> theirs(bundles, true);
  bundles = {};
  const MeshData flat = flattened(scene);
  const EmbreeMesh medium(flat, RTC_BUILD_QUALITY_MEDIUM, false), high(flat, RTC_BUILD_QUALITY_HIGH, false);
  for (const EmbreeMesh* mesh : {&medium, &high})
    works.emplace_back([&theirs, mesh] { keep(theirs.sum_of_ranges(*mesh)); });
#endif
  const std::vector<Times> times = report.by_turns(works);
  figures.emplace_back("Mrays/s on 1 thread", rays / median(times[0]) / 1e6);
#ifdef PULSECAST_BENCH_EMBREE
  const Times& best = median(times[1]) < median(times[2]) ? times[1] : times[2];
  figures.emplace_back(embree_name(), rays / median(best) / 1e6);
  figures.emplace_back("of " + embree_name(), speed_ratio(times[0], best));
#endif
  report.row(name, figures);
}

}  // namespace

int main(int count, char** words) {
  Report report("batch", count, words);
  const street::Scene scene = street::scene(1);
  const Scene<Mesh> ground = scene_of(hills(866).mesh());
  const Sensor vlp{"16 x 125", lidar(16, 125, 30_deg)}, spinning{"32 x 1,024", lidar(32, 1024, 40_deg)};
  const Sensor wide{"camera of 50 x 40", camera(50, 40, 1.8_deg)};
  report.heading("batches");
  measure_batch(report, "street", scene, vlp, places(256));
  measure_batch(report, "street", scene, spinning, places(16));
  measure_batch(report, "hills", ground, vlp, places_on(ground, 256));
  measure_batch(report, "hills", ground, wide, places_on(ground, 256));

  report.heading("many rays beside single rays, in the street");
  const Sensor streams[] = {
      vlp, spinning, {"64 x 2,048", lidar(64, 2048, 30_deg)}, {"camera of 640 x 480", camera(640, 480, 2.5e-3)}};
  for (const Sensor& sensor : streams) {
    const std::string name = sensor.name + " stream";
    if (!report.wanted(name)) continue;
    std::vector<Ray> rays = sensor.rays;
    for (Ray& ray : rays) ray.origin = places(64)[10].position;
    std::vector<std::optional<RayHit>> alone(rays.size()), together(rays.size());
    const std::vector<Times> times =
        report.by_turns({[&] {
                           std::transform(rays.begin(), rays.end(), alone.begin(),
                                          [&](const Ray& ray) { return scene.closest_hit(ray); });
                         },
                         [&] { closest_hits<street::Scene>(scene, rays, together); }});
    std::size_t differ = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) differ += alone[i] == together[i] ? 0U : 1U;
    const double per_ray = 1e9 / static_cast<double>(rays.size());
    report.row(name, {{"alone ns", per_ray * median(times[0])},
                      {"stream ns", per_ray * median(times[1])},
                      {"faster", speed_ratio(times[1], times[0])},
                      {"differ", static_cast<double>(differ)}});
  }
}
