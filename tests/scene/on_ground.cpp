// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/on_ground.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/archetypes.hpp"
#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using support::LeastGeometry;

namespace {

using Mesh = TriangleMesh<>;

/// Rises to the east by 1 in 2, as far as 100 m from the origin.
std::optional<double> slope(const Vec2& place) {
  if (std::fabs(place.x) > 100 || std::fabs(place.y) > 100) return std::nullopt;
  return 10 + place.x / 2;
}

/// A tetrahedron that stands on its tip, 1 m below its origin; 4 m wide and 3 m high.
std::shared_ptr<const Mesh> top() {
  return std::make_shared<const Mesh>(
      MeshData{{{0, 0, -1}, {2, 2, 2}, {-2, 2, 2}, {0, -2, 2}}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 2, 3}}, {}});
}

/// Height of the lowest point above the ground, of a part that stands there.
std::optional<double> height(const std::optional<Part<Mesh>>& part) {
  if (!part) return std::nullopt;
  return part->placement.translation.z;
}

}  // namespace

TEST_CASE("a part stands by its origin, by its lowest point, by the first that touches, or sunk until nothing hovers") {
  const Part<Mesh> part{.geometry = top(), .placement = {.translation = {20, 0, 500}}};
  const auto stands = [&](GroundPlacement ground_placement) {
    return height(on_ground(part, slope, ground_placement)).value();
  };
  CHECK(stands(GroundPlacement::origin) == support::relative(20, 1e-12));
  CHECK(stands(GroundPlacement::lowest_point) == support::relative(20 + 1, 1e-12));
  CHECK(height(on_ground(part, slope)).value() == stands(GroundPlacement::lowest_point));
  CHECK(stands(GroundPlacement::touching) ==
        support::relative(20 + 1, 1e-12));  // the other corners are 3 m above a ground that rises by 1 m
  CHECK(stands(GroundPlacement::sunk) ==
        support::relative(20 - 1 + 1, 1e-12));  // the lower corners of its box are over ground at 19 m
}

TEST_CASE("a part is turned and scaled first, then it stands") {
  // upside down and twice as large: its plate is below by 4 m, in the middle of which it stands
  const Part<Mesh> part{.geometry = top(), .placement = {rotation_about(axis::forward, pi), 2, {20, 0, 0}}};
  CHECK(height(on_ground(part, slope)).value() == support::relative(20 + 4, 1e-12));
}

TEST_CASE("a placement of single precision is unit on the ground and in a scene") {
  const Part<Mesh> part{.geometry = top(), .placement = {.rotation = Rotation{0.6F, 0, 0, 0.8F}}};
  CHECK(std::fabs(length(on_ground(part, slope)->placement.rotation) - 1) < 1e-15);
  CHECK(std::fabs(length(Scene<Mesh>({part}).parts()[0].placement.rotation) - 1) < 1e-15);
}

TEST_CASE("shapes without triangles stand by the corners of their box") {
  const Part<LeastGeometry> disc{.geometry = std::make_shared<const LeastGeometry>(),
                                 .placement = {.translation = {20, 0, 0}}};
  CHECK(on_ground(disc, slope, GroundPlacement::touching)->placement.translation.z == support::relative(20.5, 1e-12));
  CHECK(on_ground(disc, slope, GroundPlacement::lowest_point)->placement.translation.z == support::relative(20, 1e-12));
}

TEST_CASE("where there is no ground, nothing stands") {
  for (const GroundPlacement ground_placement :
       {GroundPlacement::origin, GroundPlacement::lowest_point, GroundPlacement::touching, GroundPlacement::sunk}) {
    CHECK_FALSE(
        on_ground(Part<Mesh>{.geometry = top(), .placement = {.translation = {200, 0, 0}}}, slope, ground_placement)
            .has_value());
    CHECK_THROWS_AS((void)on_ground(Part<Mesh>{}, slope, ground_placement), SettingError);
  }
  // at the edge, the points over the ground decide
  const Part<Mesh> edge{.geometry = top(), .placement = {.translation = {101, 0, 0}}};
  CHECK_FALSE(on_ground(edge, slope, GroundPlacement::lowest_point).has_value());
  CHECK(on_ground(edge, slope, GroundPlacement::touching).has_value());
}

TEST_CASE("any part stands on any ground as it is meant to") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double a = any.uniform(-1, 1), b = any.uniform(-1, 1), wave = any.uniform(0, 2);
    const auto hills = [&](const Vec2& p) {
      return std::optional(a * p.x + b * p.y + wave * std::sin(p.x) * std::cos(p.y));
    };
    MeshData data;
    for (int k = 0; k < 30; ++k) data.vertices.push_back(any.point(3));
    for (std::uint32_t k = 0; k < 30; ++k) data.triangles.push_back({k, (k + 1) % 30, (k + 2) % 30});
    const Part<Mesh> part{.geometry = std::make_shared<const Mesh>(data),
                          .placement = {any.rotation(), any.log_uniform(0.1, 10), any.point(50)}};
    const auto clearance = [&](const Part<Mesh>& stood, bool lowest_only) {
      double least = std::numeric_limits<double>::infinity(), lowest = least;
      for (const Vec3& v : data.vertices) {
        const Vec3 p = stood.placement.point(v);
        if (!lowest_only) least = std::min(least, p.z - hills({p.x, p.y}).value());
        if (lowest_only && p.z < lowest) {
          lowest = p.z;
          least = p.z - hills({p.x, p.y}).value();
        }
      }
      return least;
    };
    CHECK(std::fabs(clearance(on_ground(part, hills, GroundPlacement::touching).value(), false)) < 1e-9);
    CHECK(std::fabs(clearance(on_ground(part, hills, GroundPlacement::lowest_point).value(), true)) < 1e-9);
    const Part<Mesh> sunk = on_ground(part, hills, GroundPlacement::sunk).value();
    Box box;
    for (const Vec3& v : data.vertices) box.extend(sunk.placement.point(v));
    double highest = -std::numeric_limits<double>::infinity();
    for (const double x : {box.min.x, box.max.x})
      for (const double y : {box.min.y, box.max.y}) highest = std::max(highest, box.min.z - hills({x, y}).value());
    CHECK(std::fabs(highest) < 1e-9);
  }
}
