// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/without_object.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/scene/moving_scene.hpp>

#include "support/generators.hpp"
#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

using Mesh = TriangleMesh<>;
using Robots = Scene<Mesh>;
using Moving = MovingScene<Mesh>;

static_assert(BundleTarget<WithoutObject<Robots>> && SceneQueries<WithoutObject<Robots>>);
static_assert(BundleTarget<WithoutObject<Moving>> && SceneQueries<WithoutObject<Moving>>);
static_assert(detail::TracesSheaves<WithoutObject<Robots>>);
static_assert(!std::is_constructible_v<WithoutObject<Robots>, Robots, ObjectId>);

/// Cube of sides of 2 m about the origin.
std::shared_ptr<const Mesh> cube() {
  MeshData data;
  for (const Vec3& corner : detail::corners({{-1, -1, -1}, {1, 1, 1}})) data.vertices.push_back(corner);
  data.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
  return std::make_shared<const Mesh>(data);
}

Robots::Part at(const Vec3& place, ObjectId object) {
  static const auto shape = cube();
  return {.geometry = shape, .placement = {.translation = place}, .object = object};
}

/// Range and object of the first hit forward.
template <class Map>
std::pair<double, ObjectId> forward(const Map& map, const Vec3& from) {
  std::array<Hit, 1> hits;
  map.closest(bundle_of({.origin = from, .direction = axis::forward}), hits);
  return {hits[0].range, hits[0].object};
}

using Answer = std::pair<double, ObjectId>;

const Deflector all_around{RotatingHead{.angular_rate = 20 * 360_deg},
                           Deflector{OscillatingMirror{.cycle_rate = 200, .half_angle = 60_deg},
                                     Scanner{.pulse_rate = 20_kHz, .pulses = 4000}}};

/// Echoes of a survey of all around, by beams of one ray, or of several.
template <class Beam, class Map>
std::vector<Echo> echoes_in(const Map& map, const Beam& beam) {
  const Platform platform{Tripod{.position = {0.1, 0.2, 0.3}}, Mount{}, all_around};
  const Survey survey{platform, beam, map, Receiver{}, FirstHit{}};
  Cloud cloud;
  run(survey, {.threads = 1}, cloud);
  return cloud.echoes;
}

bool equal(const std::vector<Echo>& a, const std::vector<Echo>& b) {
  const auto same = [](const Echo& x, const Echo& y) {
    return x.range == y.range && x.amplitude == y.amplitude && x.cos_incidence == y.cos_incidence &&
           x.object == y.object;
  };
  return std::ranges::equal(a, b, same);
}

}  // namespace

TEST_CASE("a sensor in its own body sees what is behind this, and others see the body") {
  // two robots in a row, a sensor in each, and a wall
  const Robots robots({at({0, 0, 0}, 7), at({0, 5, 0}, 8), at({0, 20, 0}, 1)});
  const WithoutObject first(robots, 7), second(robots, 8);
  CHECK(forward(robots, {}) == Answer{1, 7});
  CHECK(forward(first, {}) == Answer{4, 8});
  CHECK(forward(second, {}) == Answer{1, 7});
  CHECK(forward(second, {0, 5, 0}) == Answer{14, 1});
  CHECK(forward(first, {0, 5, 0}) == Answer{1, 8});
  CHECK(forward(WithoutObject(robots, 99), {}) == Answer{1, 7});  // no such object

  const Ray ray{.direction = axis::forward};
  CHECK(first.closest_hit(ray)->range == 4);
  CHECK(first.surface(*first.closest_hit(ray), ray).object == 8);
  CHECK(first.occluded(ray));
  CHECK(first.occluded(ray, 4.5));
  CHECK_FALSE(first.occluded(ray, 3.5));
  CHECK(robots.occluded(ray, 3.5));
}

TEST_CASE("the near gate of a receiver does not see through the body: the beam ends there") {
  const Robots robots({at({0, 0, 0}, 7), at({0, 5, 0}, 8)});
  const Platform platform{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 1}}};
  Cloud gated, ignoring;
  run(Survey{platform, SingleRay{}, robots, Receiver{.range_min = 1.5}, FirstHit{}}, {}, gated);
  const WithoutObject others(robots, 7);
  run(Survey{platform, SingleRay{}, others, Receiver{.range_min = 1.5}, FirstHit{}}, {}, ignoring);
  CHECK(gated.size() == 0);
  REQUIRE(ignoring.size() == 1);
  CHECK(ignoring.echoes[0].range == doctest::Approx(4));
}

TEST_CASE("an ignored body that touches another surface does not hide this") {
  const Robots robots({at({0, 0, 0}, 7), at({2, 0, 0}, 7), at({0, 0, 0}, 8), at({0, 2, 0}, 9)});
  CHECK(forward(robots, {0, -3, 0}) == Answer{2, 7});
  CHECK(forward(WithoutObject(robots, 7), {0, -3, 0}) == Answer{2, 8});  // at the same place
  CHECK(forward(WithoutObject(robots, 8), {0, -3, 0}) == Answer{2, 7});
  const Robots one({at({0, 0, 0}, 7)});
  CHECK(forward(WithoutObject(one, 7), {0, -3, 0}).first == detail::infinity);
  CHECK(forward(WithoutObject(one, 8), {0, -3, 0}) == Answer{2, 7});
}

TEST_CASE("a scene may be assigned anew behind the sensor that ignores an object of it") {
  Robots robots({at({0, 0, 0}, 7), at({0, 5, 0}, 8)});
  const WithoutObject others(robots, 7);
  const Robots wall({at({0, 30, 0}, 1)});
  const Layered world(wall, others);
  CHECK(forward(world, {}) == Answer{4, 8});
  robots = robots.with_placements(std::vector<Placement>{{}, {.translation = {0, 11, 0}}});
  CHECK(forward(world, {}) == Answer{10, 8});
}

TEST_CASE("hits without an object are those of a scene without its parts, to the bit") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Robots::Part> parts;
    for (int k = 0; k < 40; ++k) {
      Robots::Part part = at({}, static_cast<ObjectId>(any.whole(5)));
      part.placement = {any.rotation(), any.uniform(0.2, 2), any.point(12)};
      if (any.whole(6) == 0) part.placement = {};
      parts.push_back(part);
    }
    const auto is_own = [](const Robots::Part& part) { return part.object == 3; };
    const Robots all(parts), others = all.without(is_own);
    const WithoutObject seen(all, 3);
    const std::vector<Echo> expected = echoes_in(others, SingleRay{});
    CHECK(expected.size() > 100);
    CHECK(equal(echoes_in(seen, SingleRay{}), expected));
    CHECK(equal(echoes_in(seen, LatticeFootprint{3}), echoes_in(others, LatticeFootprint{3})));
    for (int k = 0; k < 100; ++k) {
      const Ray ray{.origin = any.point(12), .direction = any.unit()};
      const auto hit = seen.closest_hit(ray), right = others.closest_hit(ray);
      REQUIRE(hit.has_value() == right.has_value());
      CHECK(seen.occluded(ray) == right.has_value());
      if (!hit) continue;
      CHECK(hit->range == right->range);
      CHECK(seen.surface(*hit, ray).object == others.surface(*right, ray).object);
    }

    std::vector<Moving::Part> moving(parts.begin(), parts.end()), moving_others;
    for (Moving::Part& part : moving)
      if (any.coin()) part.motion = std::make_shared<const PartMotion>(SteadyMotion{.velocity = any.point(20)});
    std::ranges::copy_if(moving, std::back_inserter(moving_others), [&](auto& part) { return !is_own(part); });
    const Moving moving_all(moving, {.to = 1}), without(moving_others, {.to = 1});
    const WithoutObject moving_seen(moving_all, 3);
    CHECK(equal(echoes_in(moving_seen, SingleRay{}), echoes_in(without, SingleRay{})));
    CHECK(equal(echoes_in(moving_seen, LatticeFootprint{3}), echoes_in(without, LatticeFootprint{3})));
  }
}
