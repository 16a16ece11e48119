// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/moving_scene.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/cloud.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/survey.hpp>

#include "support/archetypes.hpp"
#include "support/counting_executor.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using support::LeastGeometry;

namespace {

using Mesh = TriangleMesh<>;
using Disc = Part<LeastGeometry>;
using Discs = MovingScene<LeastGeometry>;

static_assert(BundleTarget<Discs> && BundleTarget<MovingScene<LeastGeometry, Mesh>>);

std::shared_ptr<const PartMotion> moving(const SteadyMotion& motion) {
  return std::make_shared<const PartMotion>(motion);
}

Disc disc(const Placement& placement, ObjectId object, std::shared_ptr<const PartMotion> motion = nullptr) {
  static const auto shape = std::make_shared<const LeastGeometry>();
  return {shape, material_table(), placement, object, {}, std::move(motion)};
}

template <class Map>
Hit ask(const Map& map, const Ray& ray, const Tick& tick = {}) {
  RayBundle rays = bundle_of(ray);
  rays.tick = tick;
  std::array<Hit, 1> hits;
  map.closest(rays, hits);
  return hits[0];
}

/// The cube about the origin with sides of 2 m.
MeshData cube() {
  MeshData data;
  for (const Vec3& corner : detail::corners({{-1, -1, -1}, {1, 1, 1}})) data.vertices.push_back(corner);
  data.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
  return data;
}

/// A motion of any kind.
std::shared_ptr<const PartMotion> any_motion(support::Generator& any) {
  if (any.whole(4) == 0) {
    std::vector<TimedPose> poses;
    for (double t = any.uniform(0, 2); poses.size() < 5; t += any.uniform(0.2, 5))
      poses.push_back({t, any.point(10), any.rotation()});
    return std::make_shared<const PartMotion>(poses, any.coin() ? AfterLastPose::rest : AfterLastPose::start_again);
  }
  std::vector<MotionSequence> sequences(1 + any.whole(2));
  for (MotionSequence& s : sequences) {
    s.times = 1 + any.whole(4);
    for (std::uint64_t n = 1 + any.whole(3); s.motions.size() < n;) {
      SteadyMotion m{.velocity = any.point(any.log_uniform(0.01, 20)),
                     .axis = any.unit(),
                     .angular_rate = any.uniform(-2, 2),
                     .duration = any.uniform(0.3, 3)};
      if (any.coin()) m.centre = any.point(10);
      s.motions.push_back(m);
    }
  }
  if (any.coin()) return std::make_shared<const PartMotion>(sequences, 0);
  return std::make_shared<const PartMotion>(sequences);
}

}  // namespace

TEST_CASE("a motion comes on top of the placement, and turns about the part's own centre if it has none of its own") {
  // twice as large, upright, facing north; it turns about up
  const Discs scene({disc({rotation_about(axis::right, pi / 2), 2, {7, 8, 9}}, 1, moving({.angular_rate = pi / 2}))},
                    {.to = 5});
  CHECK(ask(scene, {{7, 0, 9}, axis::forward}, {0, 0}).range == support::relative(8, 1e-12));
  CHECK(ask(scene, {{7, 0, 9}, axis::forward}, {0, 0}).cos_incidence == support::relative(1, 1e-12));
  CHECK(ask(scene, {{7, 0, 10.9}, axis::forward}, {0, 0.5}).cos_incidence == support::relative(std::sqrt(0.5), 1e-12));
  CHECK_FALSE(ask(scene, {{7, 0, 11.1}, axis::forward}, {0, 0.5}).met());
  CHECK(ask(scene, {{0, 8, 9}, axis::right}, {1, 0}).range == support::relative(7, 1e-12));
}

TEST_CASE("a scene of moving parts answers as one of still parts that stand where they are at that tick") {
  const auto mesh = std::make_shared<const Mesh>(cube());
  std::size_t met_moving = 0, met_still = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Part<Mesh, LeastGeometry>> parts;
    for (ObjectId k = 0; k < 12; ++k) {
      Part<Mesh, LeastGeometry> part{
          .geometry = mesh, .placement = {any.rotation(), any.log_uniform(0.2, 4), any.point(15)}, .object = k};
      if (any.coin()) part.geometry = std::make_shared<const LeastGeometry>();
      if (any.whole(3) > 0) part.motion = any_motion(any);
      parts.push_back(part);
    }
    const MovingScene<Mesh, LeastGeometry> scene(parts, {0, any.log_uniform(1, 100), std::size_t{1} << any.whole(14)});
    for (int k = 0; k < 40; ++k) {
      const double seconds = any.coin() ? any.uniform(0, 5) : any.uniform(0, 120);
      CAPTURE(seconds);
      const Tick tick = Tick::of_seconds(seconds);
      auto still = parts;
      for (std::size_t i = 0; i < still.size(); ++i) {
        still[i].placement = scene.placement(i, tick);
        still[i].motion = nullptr;
      }
      const Scene<Mesh, LeastGeometry> expected(still);
      const std::size_t aim = any.whole(parts.size());
      const Vec3 from = any.point(40), to = still[aim].placement.translation + any.point(0.3);
      RayBundle rays = any.cone(from, normalize(to - from), any.log_uniform(1e-4, 0.1), 1 + any.whole(20));
      rays.tick = tick;
      std::array<Hit, RayBundle::capacity> a, b;
      scene.closest(rays, a);
      expected.closest(rays, b);
      for (std::size_t j = 0; j < rays.size; ++j) {
        REQUIRE(a[j].range == b[j].range);
        REQUIRE(a[j].object == b[j].object);
        REQUIRE(a[j].cos_incidence == b[j].cos_incidence);
        REQUIRE(a[j].backscatter == b[j].backscatter);
        if (a[j].met()) ++(parts[a[j].object].motion ? met_moving : met_still);
      }
    }
  }
  CHECK(met_moving > 5000);
  CHECK(met_still > 2000);
}

TEST_CASE("of parts in the same place the first in the list is met, moving or not") {
  for (int moves = 0; moves < 8; ++moves) {
    CAPTURE(moves);
    std::vector<Disc> parts;
    for (ObjectId k = 0; k < 3; ++k)
      parts.push_back(disc({}, 10 + k, moves >> k & 1 ? moving({.velocity = {0.25, 0, 0}}) : nullptr));
    CHECK(ask(Discs(parts, {.to = 5}), {{0, 0, 10}, -axis::up}, {1, 0}).object == 10);
  }
}

TEST_CASE("a scene refuses parts that move, and a moving scene the same parts as a scene") {
  CHECK_THROWS_AS(Scene<LeastGeometry>({disc({}, 1, moving({}))}), SettingError);
  CHECK_THROWS_AS(Discs({disc({.scale = 0}, 1, moving({}))}, {.to = 1}), SettingError);
  CHECK_THROWS_AS(Discs({Disc{nullptr}}, {.to = 1}), SettingError);
  CHECK_THROWS_AS(Discs({disc({}, 1, moving({}))}, {.from = 1, .to = 0}), SettingError);
}

TEST_CASE("what moves is no ground") {
  Disc car = disc({.translation = {0, 0, 1}}, 1, moving({.velocity = {0.1, 0, 0}})), soil = disc({.scale = 5}, 2);
  car.materials = soil.materials = material_table({{.ground = true}});
  const Discs scene({car, soil}, {.to = 1});
  CHECK(scene.ground_height({0, 0}).value() == 0);
  CHECK(scene.ground_height({0, 0}, -5).value() == 0);
  CHECK_FALSE(Discs({car}, {.to = 1}).ground_height({0, 0}).has_value());
  CHECK(Discs({car}, {.to = 1}).bounds().min.z == support::relative(1, 1e-5));
}

TEST_CASE("a part that rests in the pose of its motion costs one box, however long the time") {
  const auto resting = std::make_shared<const PartMotion>(std::vector<TimedPose>{{0, {5, 0, 1}, no_rotation}});
  std::vector<Disc> parts;
  for (ObjectId k = 0; k < 100; ++k) parts.push_back(disc({.translation = {0, 3.0 * k, 0}}, k, resting));
  const Discs hour(parts, {0, 3600}, 1);
  CHECK(hour.memory() == Discs(parts, {0, 1}).memory());
  for (const double seconds : {-1.0, 0.0, 7.5, 3600.0, 1e6}) {
    CAPTURE(seconds);
    const auto hit =
        hour.closest_hit({.origin = {5, 30, 10}, .direction = {0, 0, -1}, .tick = Tick::of_seconds(seconds)});
    REQUIRE(hit.has_value());
    CHECK(hit->part == 10);
    CHECK(hit->range == 9);
  }
}

TEST_CASE("the memory of a moving scene counts its boxes, and motions once") {
  const auto motion = moving({.velocity = {10, 0, 0}});
  std::vector<Disc> parts;
  for (ObjectId k = 0; k < 100; ++k) parts.push_back(disc({.translation = {0, 3.0 * k, 0}}, k, motion));
  const std::size_t short_time = Discs(parts, {0, 1}).memory(), long_time = Discs(parts, {0, 100}).memory();
  CHECK(long_time > 10 * short_time);
  std::vector<Disc> with_own = parts;
  for (Disc& part : with_own) part.motion = moving({.velocity = {10, 0, 0}});
  CHECK(Discs(with_own, {0, 1}).memory() == short_time + 99 * motion->memory());
  CHECK(Discs(parts, {0, 1e6, 10000}).memory() < 10000 * 200 + 100 * 300);
}

TEST_CASE("every point of a survey lies on what it met, where that was at its own time, whatever the threads") {
  // Around a tripod, a ball orbits, a cube spins while it drifts, and a floor rises.
  const double orbit = 1.3, spin = 2.1, climb = 0.5;
  const Vec3 drift{0.7, 0.4, 0}, start{-8, -6, 0};
  const auto ball = std::make_shared<const support::UnitBall>();
  const auto box = std::make_shared<const Mesh>(cube());
  const auto floor = std::make_shared<const LeastGeometry>();
  const MovingScene<support::UnitBall, Mesh, LeastGeometry> scene(
      {{.geometry = ball,
        .placement = {.translation = {10, 0, 0}},
        .object = 1,
        .motion = moving({.angular_rate = orbit, .centre = Vec3{}})},
       {.geometry = box,
        .placement = {.translation = start},
        .object = 2,
        .motion = moving({.velocity = drift, .angular_rate = spin})},
       {.geometry = floor,
        .placement = {.scale = 30, .translation = {0, 0, -9}},
        .object = 3,
        .motion = moving({.velocity = {0, 0, climb}})}},
      {.to = 4});
  const Scanner laser{.pulse_rate = 25e3, .pulses = 100'000};
  const Platform platform{
      Tripod{}, Mount{},
      Deflector{RotatingHead{.angular_rate = 4 * pi}, Deflector{PolygonMirror{.line_rate = 300}, laser}}};
  const Survey survey{platform, SingleRay{}, scene, Receiver{}, FirstHit{}};
  Cloud cloud, threads;
  run(survey, {.threads = 1}, cloud);
  run(survey, {.threads = 3}, threads);
  CHECK(cloud.points == threads.points);
  std::array<std::size_t, 4> met{};
  std::array<double, 4> worst{};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double t = cloud.ticks[i].seconds();
    const Vec3& p = cloud.points[i];
    const ObjectId object = cloud.echoes[i].object;
    const double off = object == 1   ? length(p - 10.0 * Vec3{std::cos(orbit * t), std::sin(orbit * t), 0}) - 1
                       : object == 2 ? max_norm(rotation_about(axis::up, -spin * t) * (p - start - t * drift)) - 1
                                     : p.z - (-9 + climb * t);
    ++met[object];
    worst[object] = std::max(worst[object], std::fabs(off));
  }
  for (const std::size_t object : {1U, 2U, 3U}) {
    CAPTURE(object);
    CHECK(met[object] > 100);
    CHECK(worst[object] < 1e-9);
  }
}

TEST_CASE("the user's threads build both indices of a moving scene, which is the same on any") {
  for (const bool moves : {false, true}) {
    CAPTURE(moves);
    support::CountingExecutor executor;
    support::Generator any(12);
    std::vector<Disc> discs;
    for (ObjectId k = 0; k < 10'000; ++k)
      discs.push_back(
          disc({.scale = 5, .translation = any.point(200)}, k, moves ? moving({.velocity = any.point(1)}) : nullptr));
    const Discs alone(discs, {.to = 1}, 1), shared(discs, {.to = 1}, executor);
    CHECK(executor.calls() > 0);
    int met = 0;
    for (int k = 0; k < 500; ++k) {
      const Ray ray{any.point(200), any.unit()};
      const Hit hit = ask(alone, ray, {0, 0.5}), other = ask(shared, ray, {0, 0.5});
      REQUIRE(other.range == hit.range);
      REQUIRE(other.object == hit.object);
      met += hit.met();
    }
    CHECK(met > 100);
  }
}

TEST_CASE("no ray meets anything at the tick of a cone that is said to meet nothing") {
  const auto mesh = std::make_shared<const Mesh>(cube());
  std::size_t missed = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Part<Mesh>> parts;
    for (std::uint64_t k = any.whole(6); k < 8; ++k) {
      Part<Mesh> part{.geometry = mesh, .placement = {any.rotation(), any.log_uniform(0.2, 2), any.point(15)}};
      if (seed % 3 == 0 || any.coin()) part.motion = any_motion(any);
      parts.push_back(part);
    }
    const MovingScene<Mesh> scene(parts, {0, 8});  // the cones' times go on to 12 s
    CHECK(support::cone_laws(scene, support::cones_from(30, seed, 1000), missed) == "");
  }
  CHECK(missed > 10000);
}

TEST_CASE("a cone meets a part while it passes, and outside of the time it may meet any") {
  const auto mesh = std::make_shared<const Mesh>(cube());
  const MovingScene<Mesh> scene(
      {{.geometry = mesh, .placement = {.translation = {-50, 0, 0}}, .motion = moving({.velocity = {10, 0, 0}})}},
      {0, 10});
  RayCone cone{.origin = {0, -20, 0}, .spread = 1e-3};
  for (const double seconds : {0.0, 2.0, 4.0, 6.0, 8.0}) {
    cone.tick = Tick::of_seconds(seconds);
    CHECK(scene.misses_cone(cone));
  }
  cone.tick = Tick::of_seconds(5);
  CHECK_FALSE(scene.misses_cone(cone));
  cone.tick = Tick::of_seconds(11);
  CHECK_FALSE(scene.misses_cone(cone));
}
