// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/shape/water_surface.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <concepts>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <pulsecast/scene/closest_hits.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/shape/wind_waves.hpp>

#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

static_assert(TimeDependentGeometry<WaterSurface>);
using namespace pulsecast::support;

static_assert(std::copyable<WaterSurface> && !UniformGeometry<WaterSurface> && DeterministicGeometry<WaterSurface>);
static_assert(Scene<WaterSurface>::time_dependent && Scene<TriangleMesh<>, WaterSurface>::time_dependent &&
              !Scene<TriangleMesh<>>::time_dependent);

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// Waves about 12 m above datum, over 200 m by 200 m.
WaterSurface water(std::vector<SineWave> waves) {
  return WaterSurface({{-100, -100}, {100, 100}, 12}, WaveField(std::move(waves)));
}

/// Closest hit of a ray; -1 if there is none.
double range_of(const WaterSurface& surface, const Ray& ray) {
  const RayBundle rays = bundle_of(ray);
  ClosestHits nearest(rays);
  surface.closest(rays, nearest);
  return nearest.met(0) ? nearest.range[0] : -1;
}

Vec3 normal_of(const WaterSurface& surface, const Ray& ray) {
  const RayBundle rays = bundle_of(ray);
  ClosestHits nearest(rays);
  surface.closest(rays, nearest);
  REQUIRE(nearest.met(0));
  const SurfaceInteraction found = surface.surface(nearest.primitive_of(0), rays, 0);
  CHECK(found.material == 0);
  return found.normal;
}

std::vector<AllHits::Entry> hits_of(const WaterSurface& surface, const Ray& ray) {
  AllHits hits(ray.near, ray.far);
  surface.closest(SingleRayPacket(ray), hits);
  return {hits.hits().begin(), hits.hits().end()};
}

/// First range at which a ray is on the other side of the waves than at its near end, by steps, and by bisection of the
/// step; -1 if none.
double searched(const WaterSurface& surface, const Ray& ray, double step) {
  const Box& box = surface.bounds();
  const double level = box.min.z + surface.waves().highest();
  const auto above = [&](double t) {
    const Vec3 p = ray.origin + t * ray.direction;
    return p.z - level - surface.waves().height({p.x, p.y}, ray.tick) > 0;
  };
  double begin = ray.near, end = ray.far;
  for (int k = 0; k < 3; ++k) {
    const double a = (box.min[k] - ray.origin[k]) / ray.direction[k],
                 b = (box.max[k] - ray.origin[k]) / ray.direction[k];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(begin < end)) return -1;
  const bool side = above(begin);
  for (double t = begin; t < end;) {
    double low = t, high = t = std::min(t + step, end);
    if (above(high) == side) continue;
    while (high - low > 1e-12) {
      const double middle = 0.5 * (low + high);
      (above(middle) == side ? low : high) = middle;
    }
    return high;
  }
  return -1;
}

/// Ray that comes near the mean level at a place around the origin, from above or from below, at any slant.
Ray some_ray(Generator& random, double level, double highest) {
  const Vec3 aim{random.uniform(-20, 20), random.uniform(-20, 20), level + random.uniform(-0.5, 0.5) * highest};
  Vec3 direction = random.unit();
  if (random.coin()) direction = normalize(Vec3{direction.x, direction.y, direction.z * random.log_uniform(0.02, 1)});
  Ray ray{aim - random.uniform(0, 20) * direction, direction};
  ray.tick = Tick::of_seconds(random.uniform(0, 1000));
  return ray;
}

}  // namespace

TEST_CASE("without waves the surface is a plane, met exactly") {
  const WaterSurface calm = water({});
  CHECK(calm.bounds() == Box{{-100, -100, 12}, {100, 100, 12}});
  CHECK(calm.memory() == 0);
  CHECK(calm.material_count() == 1);
  CHECK(range_of(calm, {{3, 4, 20}, -axis::up}) == 8);
  CHECK(range_of(calm, {{3, 4, 2}, axis::up}) == 10);
  CHECK(range_of(calm, {{3, 4, 20}, axis::up}) == -1);
  CHECK(range_of(calm, {{0, 0, 13}, normalize(Vec3{3, 4, -12})}) == relative(13.0 / 12, 1e-15));
  CHECK(range_of(calm, {{100, -100, 13}, -axis::up}) == 1);  // a corner
  CHECK(range_of(calm, {{100.001, 0, 13}, -axis::up}) == -1);
  CHECK(range_of(calm, {{0, 0, 13}, axis::forward}) == -1);
  CHECK(range_of(calm, {{3, 4, 20}, -axis::up, 7.9, 8}) == 8);
  CHECK(range_of(calm, {{3, 4, 20}, -axis::up, 8, 9}) == -1);
  CHECK(range_of(calm, {{3, 4, 20}, -axis::up, 0, 7.9}) == -1);
  CHECK(normal_of(calm, {{3, 4, 2}, axis::up}) == axis::up);
}

TEST_CASE("a vertical ray meets the waves at their height, at every time") {
  const WaterSurface surface = water(waves_of({.wind_speed = 4}));
  Generator random(1);
  for (int time = 0; time < 500; ++time) {
    const Vec2 place{random.uniform(-100, 100), random.uniform(-100, 100)};
    const Tick t = Tick::of_seconds(random.uniform(0, 1e6));
    const double height = 12 + surface.waves().height(place, t);
    const Vec2 slope = surface.waves().slope(place, t);
    for (const double from : {112.0, -88.0}) {
      Ray ray{{place.x, place.y, from}, from > 0 ? -axis::up : axis::up};
      ray.tick = t;
      CHECK(std::fabs(range_of(surface, ray) - std::fabs(from - height)) < 1e-9);
      CHECK(length(normal_of(surface, ray) - normalize(Vec3{-slope.x, -slope.y, 1})) < 1e-6);
    }
  }
}

TEST_CASE("a level ray through the crests of a wave meets each of its flanks") {
  // z = 12 + sin(2 pi x / 8 - frequency t) / 2, met at half the amplitude
  const WaterSurface surface = water({{.amplitude = 0.5, .wavelength = 8}});
  CHECK(surface.bounds() == Box{{-100, -100, 11.5}, {100, 100, 12.5}});
  const double frequency = wave_frequency(2 * pi / 8);
  for (const double seconds : {0.0, 0.3, 7.0}) {
    CAPTURE(seconds);
    Ray ray{{0, 3, 12.25}, axis::right, 0, 40};
    ray.tick = Tick::of_seconds(seconds);
    std::vector<double> expected;
    for (int wave = -10; wave < 10; ++wave)
      for (const double phase : {pi / 6, 5 * pi / 6})
        if (const double x = (phase + 2 * pi * wave + frequency * seconds) * 8 / (2 * pi); x > 0 && x <= 40)
          expected.push_back(x);
    const auto found = hits_of(surface, ray);
    REQUIRE(found.size() == expected.size());
    for (std::size_t n = 0; n < found.size(); ++n) {
      CHECK(std::fabs(found[n].range - expected[n]) < 1e-9);
      const double slope = 0.5 * 2 * pi / 8 * std::cos(2 * pi * expected[n] / 8 - frequency * seconds);
      const Vec3 normal = surface.surface(static_cast<PrimitiveIndex>(found[n].id), SingleRayPacket(ray), 0).normal;
      CHECK(length(normal - normalize(Vec3{-slope, 0, 1})) < 1e-6);
    }
    CHECK(range_of(surface, ray) == found[0].range);
    // each hit is the closest one after that before it, bit for bit, and none is met twice
    for (std::size_t n = 0; n < found.size(); ++n) {
      ray.near = found[n].range;
      CHECK(range_of(surface, ray) == (n + 1 < found.size() ? found[n + 1].range : -1));
      ray.near = std::nextafter(found[n].range, 0.0);
      CHECK(range_of(surface, ray) == found[n].range);
      ray.near = 0;
      ray.far = found[n].range;
      CHECK(hits_of(surface, ray).size() == n + 1);
      ray.far = 40;
    }
  }
}

TEST_CASE("a ray that touches no crest passes, and one that touches a crest does not") {
  const WaterSurface surface =
      water({{.amplitude = 0.5, .wavelength = 8}, {.amplitude = 0.001, .wavelength = 0.01, .toward = 1}});
  CHECK(range_of(surface, {{-99, 3, 12.5011}, axis::right}) == -1);
  CHECK(range_of(surface, {{-99, 3, 12.4985}, axis::right}) > 0);
  const WaterSurface smooth = water({{.amplitude = 0.5, .wavelength = 8}});
  for (const double depth : {1e-6, 1e-9, 1e-12}) {
    CAPTURE(depth);
    const auto found = hits_of(smooth, {{0, 3, 12.5 - depth}, axis::right, 0, 4});
    REQUIRE(found.size() == 2);  // the crest is at x = 2, and sqrt(2 depth / curvature) wide to both sides
    const double half = std::sqrt(2 * depth / 0.5) * 8 / (2 * pi);
    CHECK(std::fabs(found[0].range - (2 - half)) < 1e-9 + 1e-15 / std::sqrt(depth));
    CHECK(std::fabs(found[1].range - (2 + half)) < 1e-9 + 1e-15 / std::sqrt(depth));
  }
}

TEST_CASE("hits are those of a search by fine steps, from above and from below, steep and grazing") {
  struct Case {
    std::vector<SineWave> waves;
    double step;
  };
  std::vector<SineWave> steep;
  Generator any(77);
  for (int i = 0; i < 20; ++i) {
    const double wavelength = any.log_uniform(0.05, 20);
    steep.push_back({0.06 * wavelength, wavelength, any.uniform(-pi, pi), any.uniform(0, 2 * pi)});
  }
  const std::vector<Case> cases{
      {waves_of({.wind_speed = 2, .shortest = 0.02, .components = 32}), 1e-3},
      {waves_of({.wind_speed = 8, .fetch = 500, .shortest = 0.05, .components = 48, .seed = 3}), 1e-3},
      {steep, 2e-3},
      {{{.amplitude = 0.5, .wavelength = 2}}, 1e-2},
      {{{.amplitude = 0.5, .wavelength = 2}, {.amplitude = 0.3, .wavelength = 1.3, .toward = 1}}, 1e-2}};
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const WaterSurface surface = water(cases[c].waves);
    int met = 0, below = 0;
    for (std::uint64_t seed = 0; seed < 250; ++seed) {
      CAPTURE(c);
      CAPTURE(seed);
      Generator random(seed);
      const Ray ray = some_ray(random, 12, surface.waves().highest());
      const double expected = searched(surface, ray, cases[c].step), found = range_of(surface, ray);
      if (std::fabs(expected - found) < 1e-9) {
        met += found > 0 ? 1 : 0;
        below += found > 0 && ray.direction.z > 0 ? 1 : 0;
        continue;
      }
      // the steps of the other search passed over a crest: two hits within one of them
      const auto hits = hits_of(surface, ray);
      REQUIRE(hits.size() >= 2);
      REQUIRE(hits[0].range == found);
      REQUIRE(hits[1].range - hits[0].range < cases[c].step);
      REQUIRE(found > 0);
      REQUIRE((expected < 0 || found < expected));
      const Vec3 p = ray.origin + found * ray.direction;
      CHECK(std::fabs(p.z - 12 - surface.waves().height({p.x, p.y}, ray.tick)) < 1e-9);
    }
    CHECK(met > 100);
    CHECK(below > 40);
  }
}

TEST_CASE("hits lie on the surface, nothing is between the ends of a ray and its hits, whatever the wind") {
  for (const double speed : {1.0, 7.0, 15.0, 30.0}) {
    const WaterSurface surface({{-1000, -1000}, {1000, 1000}, 12}, WaveField(waves_of({.wind_speed = speed})));
    Generator random(static_cast<std::uint64_t>(speed));
    for (int time = 0; time < 60; ++time) {
      CAPTURE(speed);
      CAPTURE(time);
      Ray ray = some_ray(random, 12, 0.3 * surface.waves().highest());
      ray.far = 60;
      const auto above = [&](double t) {
        const Vec3 p = ray.origin + t * ray.direction;
        return p.z - 12 - surface.waves().height({p.x, p.y}, ray.tick);
      };
      const double found = range_of(surface, ray);
      if (found > 0) CHECK(std::fabs(above(found)) < 1e-9);
      for (int k = 1; k <= 300; ++k) {
        const double t = (found > 0 ? found * (1 - 1e-9) : 60) * k / 300;
        REQUIRE((above(t) > 0) == (above(0) > 0));
      }
    }
  }
}

TEST_CASE("bundles, single rays and searches for any hit agree to the last bit") {
  const WaterSurface surface = water(waves_of({.wind_speed = 6, .fetch = 1e4, .seed = 2}));
  Generator random(21);
  for (int time = 0; time < 60; ++time) {
    CAPTURE(time);
    const Ray ray = some_ray(random, 12, 2 * surface.waves().highest());
    RayBundle rays = random.cone(ray.origin, ray.direction, 0.3, 1 + random.whole(64));
    rays.tick = ray.tick;
    rays.near = random.coin() ? 0 : random.uniform(0, 10);
    rays.far = random.coin() ? endless : random.uniform(5, 40);
    ClosestHits nearest(rays);
    surface.closest(rays, nearest);
    for (std::size_t j = 0; j < rays.size; ++j) {
      const SingleRayPacket one(rays.ray(j));
      ClosestHit hit(rays.far);
      surface.closest(one, hit);
      AnyHit any(rays.far);
      surface.closest(one, any);
      AllHits all(rays.near, rays.far);
      surface.closest(one, all);
      REQUIRE(hit.range[0] == nearest.range[j]);
      REQUIRE(hit.id[0] == nearest.id[j]);
      REQUIRE(any.found == hit.met(0));
      REQUIRE(all.hits().empty() != hit.met(0));
      if (!hit.met(0)) continue;
      REQUIRE(hit.range[0] > rays.near);
      REQUIRE(hit.range[0] <= rays.far);
      REQUIRE(all.hits()[0] == AllHits::Entry{hit.range[0], hit.id[0]});
      const Vec3 normal = surface.surface(hit.primitive_of(0), one, 0).normal;
      REQUIRE(normal == surface.surface(nearest.primitive_of(j), rays, j).normal);
      REQUIRE(length(normal) == relative(1, 1e-14));
      REQUIRE(normal.z > 0);
      const Vec3 p = rays.origin + hit.range[0] * rays.direction(j);
      const Vec2 slope = surface.waves().slope({p.x, p.y}, rays.tick);
      REQUIRE(length(normal - normalize(Vec3{-slope.x, -slope.y, 1})) < 1e-5);
    }
  }
}

TEST_CASE("hits are pure, and those of a copy") {
  const WaterSurface surface = water(waves_of({.wind_speed = 5, .seed = 8}));
  std::vector<Ray> rays;
  Generator random(5);
  for (int k = 0; k < 100; ++k) rays.push_back(some_ray(random, 12, surface.waves().highest()));
  const auto range = [&](const WaterSurface& w, std::size_t k) { return range_of(w, rays[k]); };
  CHECK(support::detail::purity_laws(surface, rays.size(), range) == "");
}

TEST_CASE("a ray that starts on the surface does not meet it there") {
  const WaterSurface surface = water({{.amplitude = 0.5, .wavelength = 8}});
  REQUIRE(surface.waves().height({0, 3}, {}) == 0);
  CHECK(std::fabs(range_of(surface, {{0, 3, 12}, axis::right}) - 4) < 1e-9);
  CHECK(range_of(surface, {{0, 3, 12}, axis::up}) == -1);
}

TEST_CASE("a ray that leaves through a wall before it comes to the waves meets nothing") {
  const WaterSurface surface =
      water({{.amplitude = 0.5, .wavelength = 60}, {.amplitude = 0.5, .wavelength = 50, .toward = pi / 2}});
  Generator random(12);
  int met = 0, passed = 0;
  for (int time = 0; time < 500; ++time) {
    CAPTURE(time);
    const Vec3 aim{100 + random.uniform(-0.05, 0.05), random.uniform(-99, 99), 12 + random.uniform(-1, 1)};
    const Vec3 direction = normalize(Vec3{random.uniform(-0.3, 0.3), 0.01, random.coin() ? 1 : -1});
    const Ray ray{aim - 3.0 * direction, direction};
    const double expected = searched(surface, ray, 0.01);
    CHECK(std::fabs(range_of(surface, ray) - expected) < 1e-9);
    (expected > 0 ? met : passed) += 1;
  }
  CHECK(met > 100);
  CHECK(passed > 100);
}

TEST_CASE("two areas side by side are met as one") {
  const WaveField waves(waves_of({.wind_speed = 5}));
  const WaterSurface both({{-50, -50}, {50, 50}}, waves), west({{-50, -50}, {0.3, 50}}, waves),
      east({{0.3, -50}, {50, 50}}, waves);
  Generator random(4);
  int met = 0;
  for (int time = 0; time < 400; ++time) {
    CAPTURE(time);
    const Ray ray = some_ray(random, 0, waves.highest());
    const double w = range_of(west, ray), e = range_of(east, ray), whole = range_of(both, ray);
    const double first = w < 0 ? e : e < 0 ? w : std::min(w, e);
    CHECK(std::fabs(first - whole) < 1e-9);
    met += whole > 0 ? 1 : 0;
  }
  CHECK(met > 200);
}

TEST_CASE("a placed and scaled surface is met at ranges of the world") {
  const auto shape = std::make_shared<const WaterSurface>(water(waves_of({.wind_speed = 3})));
  using WaterScene = Scene<WaterSurface>;
  for (const double scale : {0.1, 1.0, 7.0}) {
    CAPTURE(scale);
    WaterScene::Part part;
    part.geometry = shape;
    part.placement = {.rotation = rotation_about(Vec3{1, 2, 3}, 0.8), .scale = scale, .translation = {5, 6, 7}};
    const WaterScene scene({part});
    Generator random(6);
    int met = 0;
    for (int time = 0; time < 200; ++time) {
      const Ray local = some_ray(random, 12, shape->waves().highest());
      Ray ray = local;
      ray.origin = part.placement.point(local.origin);
      ray.direction = part.placement.rotation * local.direction;
      const double expected = range_of(*shape, local);
      const auto hit = scene.closest_hit(ray);
      REQUIRE(hit.has_value() == (expected > 0));
      if (!hit) continue;
      ++met;
      CHECK(std::fabs(hit->range - expected * scale) < 1e-9 * std::max(1.0, scale));
    }
    CHECK(met > 100);
  }
}

TEST_CASE("rays of a batch meet the waves of their own time each") {
  Scene<WaterSurface>::Part part;
  part.geometry = std::make_shared<const WaterSurface>(water(waves_of({.wind_speed = 5})));
  const Scene<WaterSurface> scene({part});
  std::vector<Ray> rays;
  for (int k = 0; k < 64; ++k) {
    rays.push_back({{0, 0, 100}, normalize(Vec3{1e-4 * k, 0, -1})});
    rays.back().tick = Tick::of_seconds(k);
  }
  std::vector<std::optional<RayHit>> hits(rays.size());
  closest_hits(scene, rays, std::span(hits));
  for (std::size_t k = 0; k < rays.size(); ++k) {
    REQUIRE(hits[k].has_value());
    CHECK(hits[k]->range == range_of(*part.geometry, rays[k]));
  }
}

TEST_CASE("rays that are not numbers meet nothing and spoil nothing") {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  for (const WaterSurface& surface : {water({}), water(waves_of({.wind_speed = 5}))}) {
    RayBundle rays = bundle_of({{12, 18, 100}, -axis::up});
    rays.size = 4;
    rays.set_direction(1, {nothing, nothing, nothing});
    rays.set_direction(2, {0, endless, 0});
    rays.set_direction(3, {0, 0, 0});
    rays.pad();
    ClosestHits nearest(rays);
    surface.closest(rays, nearest);
    CHECK(nearest.met(0));
    for (const std::size_t j : {1U, 2U, 3U}) CHECK_FALSE(nearest.met(j));
    for (const double bad : {nothing, endless}) {
      CHECK(range_of(surface, {{bad, 18, 100}, -axis::up}) == -1);
      CHECK(range_of(surface, {{12, 18, bad}, -axis::up}) == -1);
      CHECK(range_of(surface, {{12, 18, 100}, {bad, 0, -1}}) == -1);
      CHECK(range_of(surface, {{12, 18, 100}, -axis::up, bad}) == -1);
    }
    CHECK(range_of(surface, {{12, 18, 12}, {0, 0, 0}}) == -1);
  }
}

TEST_CASE("areas out of range are refused") {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(WaterSurface({{0, 0}, {0, 0}, 0}));
  for (const WaterArea& bad :
       {WaterArea{{1, 0}, {0, 1}, 0}, WaterArea{{0, 1}, {1, 0}, 0}, WaterArea{{nothing, 0}, {1, 1}, 0},
        WaterArea{{0, 0}, {1, endless}, 0}, WaterArea{{0, 0}, {1, 1}, nothing}, WaterArea{{0, 0}, {1, 1}, 2e9}})
    CHECK_THROWS_AS(WaterSurface{bad}, SettingError);
}
