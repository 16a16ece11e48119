// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Many rays at once in a street of some 50,000 triangles: batches of poses, on all threads, and `closest_hits` beside
// single rays, on one. Rows of batches are named after rays by channels and columns; `differ` counts hits that are not
// the same.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/closest_hits.hpp>
#include <pulsecast/scene/run_batch.hpp>

#include "report.hpp"
#include "scenes.hpp"

using namespace bench;

namespace {

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
std::vector<Pose<frame::Instrument, frame::World>> places(std::size_t count) {
  std::vector<Pose<frame::Instrument, frame::World>> all;
  for (std::size_t p = 0; p < count; ++p) {
    const double along = -60 + 120 * static_cast<double>(p) / static_cast<double>(count);
    const Vec2 at = p % 2 == 0 ? Vec2{2, along} : Vec2{along, 2};
    all.push_back({rotation_about(axis::up, 0.37 * static_cast<double>(p)), street::on(at) + Vec3{0, 0, 1.8}});
  }
  return all;
}

}  // namespace

int main(int count, char** words) {
  Report report("batch", count, words);
  const street::Scene scene = street::scene(1);

  struct Sensor {
    std::string name;
    std::vector<Ray> rays;
    std::size_t poses;
  };
  const std::vector<Sensor> sensors{{"16 x 125", lidar(16, 125, 30_deg), 4096},
                                    {"32 x 1,024", lidar(32, 1024, 40_deg), 64}};
  std::vector<float> ranges;
  report.heading("batches");
  for (const Sensor& sensor : sensors) {
    if (!report.wanted(sensor.name)) continue;
    const auto poses = places(sensor.poses);
    ranges.resize(poses.size() * sensor.rays.size());
    const std::vector<Times> times =
        report.by_turns({[&] { run_batch(scene, poses, sensor.rays, ranges); }}, wall_seconds);
    const double seconds = median(times[0]);
    report.row(sensor.name, {{"seconds", seconds},
                             {"scans/s", static_cast<double>(sensor.poses) / seconds},
                             {"Mrays/s", static_cast<double>(ranges.size()) / seconds / 1e6}});
  }

  report.heading("many rays beside single rays");
  const std::vector<Sensor> streams{
      sensors[0], sensors[1], {"64 x 2,048", lidar(64, 2048, 30_deg), 1}, {"camera", camera(640, 480, 2.5e-3), 1}};
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
