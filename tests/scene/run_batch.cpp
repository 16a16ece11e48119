// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/run_batch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/allocations.hpp"
#include "support/generators.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;

namespace {

using SensorPose = Pose<frame::Instrument, frame::World>;
constexpr float none = std::numeric_limits<float>::infinity();

/// The plane z = 0.
struct Floor {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double range = -ray.origin.z / ray.direction.z;
    if (!(range > ray.near && range <= ray.far)) return {};
    return Hit{.range = range};
  }
};

std::vector<SensorPose> random_poses(support::Generator& random, std::size_t count) {
  std::vector<SensorPose> poses;
  for (std::size_t p = 0; p < count; ++p) poses.push_back(random.pose<frame::Instrument, frame::World>(5));
  return poses;
}

}  // namespace

TEST_CASE("sensors at several heights and attitudes measure their distance from a floor") {
  const double half = std::numbers::sqrt2 / 2;
  const std::vector<SensorPose> poses{{{1, 0, 0, 0}, {0, 0, 2}},                                  // level
                                      {{half, -half, 0, 0}, {7, -3, 5}},                          // nose down
                                      {{std::cos(pi / 8), -std::sin(pi / 8), 0, 0}, {1, 1, 1}}};  // half way
  const std::vector<Ray> rays{
      {.direction = axis::forward}, {.direction = -axis::up}, {.origin = {0, 0, 1}, .direction = -axis::up}};
  std::vector<float> ranges(9);
  run_batch(Floor{}, poses, rays, ranges);
  const float slant = std::numbers::sqrt2_v<float>;
  const std::array<float, 9> expected{none, 2, 3, 5, none, none, slant, slant, slant + 1};
  for (std::size_t k = 0; k < 9; ++k) {
    CAPTURE(k);
    if (k == 0)
      CHECK(ranges[k] == none);
    else if (k == 4 || k == 5)  // along the floor, up to rounding
      CHECK(ranges[k] > 1e15F);
    else
      CHECK(ranges[k] == doctest::Approx(expected[k]));
  }
}

TEST_CASE("a batch gives the ranges that single rays and the pulses of a platform give, for any number of threads") {
  const std::uint64_t seed = 7;
  CAPTURE(seed);
  support::Generator random(seed);
  MeshData mesh;
  for (int i = 0; i < 300; ++i) support::add_triangle(mesh, {random.point(20), random.point(20), random.point(20)});
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(mesh)}});
  const Deflector sensor{RotatingHead{.angular_rate = 36'000},
                         Deflector{PolygonMirror{.line_rate = 1000, .angle_min = -1, .angle_max = 1},
                                   Scanner{.pulse_rate = 100'000, .pulses = 700}}};
  const std::vector<Ray> rays = sensor_rays(sensor);
  const std::vector<SensorPose> poses = random_poses(random, 20);
  std::vector<float> ranges(20 * 700), again(20 * 700);
  run_batch(scene, poses, rays, ranges, 1);
  ThreadPool pool(3);
  run_batch(scene, poses, rays, again, pool);
  CHECK(ranges == again);
  std::size_t met = 0, blocked = 0;
  for (std::size_t p = 0; p < poses.size(); ++p) {
    const Platform at{Tripod{.position = poses[p].position}, Mount{.boresight = poses[p].rotation}, sensor};
    for (std::size_t i = 0; i < 700; ++i) {
      const auto pulse = at.pulse(i);
      const auto hit =
          pulse ? scene.closest_hit({.origin = pulse->pose.position, .direction = pulse->pose.direction(axis::forward)})
                : std::optional<RayHit>{};
      CAPTURE(p);
      CAPTURE(i);
      if (hit)
        CHECK(ranges[p * 700 + i] == doctest::Approx(hit->range).epsilon(1e-6));
      else
        CHECK(ranges[p * 700 + i] == none);
      met += hit ? 1U : 0U;
      blocked += pulse ? 0U : 1U;
    }
  }
  CHECK(met > 1000);
  CHECK(blocked > 1000);
}

TEST_CASE("rays of a batch have their own times, near and far ends") {
  const MeshData door{.vertices = {{-1, 10, -1}, {1, 10, -1}, {0, 10, 2}}, .triangles = {{0, 1, 2}}};
  const auto slide = std::make_shared<const PartMotion>(SteadyMotion{.velocity = {0, 2, 0}});
  const MovingScene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(door), .motion = slide}},
                                          MovingIndexSettings{.to = 10});
  const std::vector<Ray> rays{
      {}, {.tick = Tick::of_seconds(3)}, {.far = 9.5}, {.near = 10.5}, {.near = 10.5, .tick = Tick::of_seconds(3)}};
  std::vector<float> ranges(5);
  run_batch(scene, std::vector<SensorPose>(1), rays, ranges);
  CHECK(ranges == std::vector<float>{10, 16, none, none, 16});
}

TEST_CASE("sensors in scenes of their own, which share a wall, measure what each does in its scene alone") {
  const MeshData wall{.vertices = {{-1, 0, -1}, {1, 0, -1}, {0, 0, 2}}, .triangles = {{0, 1, 2}}};
  using World = Scene<TriangleMesh<>>;
  const auto shape = std::make_shared<const TriangleMesh<>>(wall);
  const World near({{.geometry = shape, .placement = {.translation = {0, 3, 0}}}});
  const std::vector<Placement> further{{.translation = {0, 8, 0}}};
  const std::vector<World> scenes{near, near.with_placements(further), near.without([](const auto&) { return true; })};
  const std::vector<std::uint32_t> scene_of{1, 0, 2, 1};
  const std::vector<SensorPose> poses{{}, {{1, 0, 0, 0}, {0, 1, 0}}, {}, {{1, 0, 0, 0}, {0, 5, 0}}};
  std::vector<float> ranges(8);
  const std::vector<Ray> rays{{.direction = axis::forward}, {.direction = -axis::forward}};
  run_batch<World>(scenes, scene_of, poses, rays, ranges, 1);
  CHECK(ranges == std::vector<float>{8, none, 2, none, none, none, 3, none});

  const std::uint64_t seed = 3;
  CAPTURE(seed);
  support::Generator random(seed);
  std::vector<World> worlds;
  for (int w = 0; w < 5; ++w) {
    MeshData mesh;
    for (int i = 0; i < 100; ++i) support::add_triangle(mesh, {random.point(20), random.point(20), random.point(20)});
    worlds.push_back(World({{.geometry = std::make_shared<const TriangleMesh<>>(mesh)}}));
  }
  const std::vector<SensorPose> many = random_poses(random, 30);
  std::vector<Ray> beams;  // 1,307: blocks of tasks end within poses
  while (beams.size() < 1307) beams.push_back({.direction = random.unit()});
  std::vector<std::uint32_t> of;
  for (std::size_t p = 0; p < many.size(); ++p) of.push_back(static_cast<std::uint32_t>(p * 7 % 5));
  std::vector<float> together(many.size() * beams.size()), again(together.size()), alone(beams.size());
  run_batch<World>(worlds, of, many, beams, together, 1);
  ThreadPool pool(3);
  run_batch<World>(worlds, of, many, beams, again, pool);
  CHECK(together == again);
  for (std::size_t p = 0; p < many.size(); ++p) {
    run_batch(worlds[of[p]], std::span(many).subspan(p, 1), beams, alone, 1);
    CAPTURE(p);
    CHECK(std::equal(alone.begin(), alone.end(), together.begin() + static_cast<std::ptrdiff_t>(p * beams.size())));
  }
}

TEST_CASE("a batch allocates nothing, also with a pool of threads") {
  const std::vector<SensorPose> poses(100, SensorPose{{1, 0, 0, 0}, {0, 0, 2}});
  const std::vector<Ray> rays(100, Ray{.direction = -axis::up});
  std::vector<float> ranges(10'000);
  ThreadPool pool(2);
  run_batch(Floor{}, poses, rays, ranges, pool);
  const std::size_t before = support::allocations;
  run_batch(Floor{}, poses, rays, ranges, pool);
  CHECK(support::allocations == before);
  CHECK(ranges == std::vector<float>(10'000, 2));
}

TEST_CASE("wrong sizes and poses that are not rigid are refused; empty batches are not") {
  const std::vector<SensorPose> poses(2);
  const std::vector<Ray> rays(3);
  std::vector<float> ranges(6), few(5);
  CHECK_THROWS_WITH_AS(run_batch(Floor{}, poses, rays, few), doctest::Contains("run_batch: ranges (number)"),
                       SettingError);
  for (const SensorPose& wrong : {SensorPose{{2, 0, 0, 0}, {}}, SensorPose{{1, 0, 0, 0}, {0, std::nan(""), 0}}}) {
    const std::vector<SensorPose> spoilt{{}, wrong};
    CHECK_THROWS_WITH_AS(run_batch(Floor{}, spoilt, rays, ranges), doctest::Contains("run_batch: pose 1"),
                         SettingError);
  }
  const std::vector<Floor> floors(2);
  CHECK_THROWS_WITH_AS(run_batch<Floor>(floors, std::vector<std::uint32_t>{0}, poses, rays, ranges),
                       doctest::Contains("run_batch: indices of targets (number)"), SettingError);
  CHECK_THROWS_WITH_AS(run_batch<Floor>(floors, std::vector<std::uint32_t>{1, 2}, poses, rays, ranges),
                       doctest::Contains("index of the target of pose 1"), SettingError);
  run_batch<Floor>({}, {}, {}, rays, {});
  run_batch(Floor{}, {}, rays, {});
  run_batch(Floor{}, poses, {}, {});
}
