// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/terrain_following.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

namespace {

const Vec3 utm{512345.678, 5403210.987, 1234.5};

double steepest(const Waypoints& path) {
  double slope = 0;
  const auto& points = path.points();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec3 way = points[i].position - points[i - 1].position;
    slope = std::max(slope, std::fabs(way.z) / std::hypot(way.x, way.y));
  }
  return slope;
}

}  // namespace

TEST_CASE("over an inclined plane the path is parallel to it, at its height and speed") {
  const StraightLine line{.from = utm, .to = utm + Vec3{300, 400, 77}, .speed = 20};
  const auto ground = [](const Vec2& p) { return 0.1 * (p.x - utm.x) + 50; };
  const Waypoints path = plan_terrain_following(line, ground, {.height = 80, .step = 7});
  for (double share = 0; share <= 1; share += 0.01) {
    const auto pose = path.at(Tick::of_seconds(share * path.duration().seconds()));
    CHECK(length(pose.position - Vec3{utm.x + 300 * share, utm.y + 400 * share, 130 + 30 * share}) < 1e-6);
    CHECK(length(pose.direction(axis::forward) - Vec3{0.6, 0.8, 0}) < 1e-9);
  }
  CHECK(path.duration().seconds() == support::relative(std::hypot(500.0, 30.0) / 20, 1e-9));
}

TEST_CASE("before a cliff the path climbs as steeply as it may, no sooner than it must") {
  const StraightLine line{.from = {0, 0, 0}, .to = {1000, 0, 0}};
  const auto cliff = [](const Vec2& p) { return p.x < 500 ? 0.0 : 60.0; };
  const Waypoints path = plan_terrain_following(line, cliff, {.height = 40, .step = 5, .slope = 0.3});
  for (const TimedPose& p : path.points()) {
    const double x = p.position.x;
    CHECK(p.position.z == support::relative(x < 300 ? 40 : x < 500 ? 40 + 0.3 * (x - 300) : 100, 1e-9));
  }
}

TEST_CASE("over any ground the path keeps its height and its slope") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double bumps = any.log_uniform(0.1, 100), tall = any.log_uniform(0.1, 300);
    const auto ground = [&](const Vec2& p) { return tall * std::sin(p.x / bumps) * std::cos(0.7 * p.y / bumps); };
    const TerrainFollowing settings{
        .height = any.uniform(-5, 200), .step = any.log_uniform(0.5, 50), .slope = any.log_uniform(0.01, 3)};
    const Vec3 from = any.point(1000);
    const Waypoints path = plan_terrain_following({.from = from, .to = from + any.point(2000)}, ground, settings);
    CHECK(steepest(path) <= settings.slope * (1 + 1e-9));
    for (const TimedPose& p : path.points())
      CHECK(p.position.z >= ground({p.position.x, p.position.y}) + settings.height - 1e-9);
  }
}

TEST_CASE("where the ground is not known, the last height counts") {
  const StraightLine line{.from = {0, 0, 7}, .to = {1000, 0, 7}};
  const auto patch = [](const Vec2& p) -> std::optional<double> {
    if (p.x < 300 || p.x > 600) return std::nullopt;
    return 0.1 * p.x;
  };
  const Waypoints path = plan_terrain_following(line, patch, {.height = 50, .step = 10});
  CHECK(path.points().front().position.z == support::relative(80, 1e-9));
  CHECK(path.points().back().position.z == support::relative(110, 1e-9));
  const Waypoints own = plan_terrain_following(line, [](const Vec2&) { return std::optional<double>(); });
  CHECK(own.at({}).position == line.from);
  CHECK(own.at(own.duration()).position == line.to);
}

TEST_CASE("a line that is vertical or goes nowhere gives a place above the ground") {
  for (const Vec3& way : {Vec3{}, Vec3{0, 0, 100}, Vec3{1e-12, 0, 0}, Vec3{0, 1e-3, -100}}) {
    const Waypoints path =
        plan_terrain_following({.from = utm, .to = utm + way}, [](const Vec2&) { return 12.0; }, {.height = 30});
    const std::vector<Tick> ticks{{}, {0, 1e-7}, path.duration(), {10, 0}};
    CHECK(support::motion_laws(path, ticks) == "");
    CHECK(length(path.at({10, 0}).position - Vec3{utm.x, utm.y, 42}) < 2e-3);
  }
}

TEST_CASE("terrain following refuses what cannot be") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto flat = [](const Vec2&) { return 0.0; };
  const StraightLine line{};
  CHECK_THROWS_AS((void)plan_terrain_following(line, flat, {.height = nan}), SettingError);
  CHECK_THROWS_AS((void)plan_terrain_following(line, flat, {.step = 0}), SettingError);
  CHECK_THROWS_AS((void)plan_terrain_following(line, flat, {.step = 1e-9}), SettingError);
  CHECK_THROWS_AS((void)plan_terrain_following(line, flat, {.slope = 0}), SettingError);
  CHECK_THROWS_AS((void)plan_terrain_following(line, [&](const Vec2&) { return nan; }), SettingError);
  CHECK_THROWS_AS((void)plan_terrain_following({.speed = 0}, flat), SettingError);
}
