// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/leg_paths.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"

namespace pulsecast::helios {
namespace {

using support::relative;

std::optional<double> flat(const Vec2&) { return 7; }

SurveySettings survey_of(PlatformKind kind, const std::vector<Vec3>& places, double speed = 10) {
  SurveySettings s;
  s.platform.kind = kind;
  for (const Vec3& place : places) s.legs.push_back({.platform = {.position = place, .speed = speed}});
  return s;
}

TEST_CASE("legs go to where the next one begins, in as long as that takes") {
  const SurveySettings s = survey_of(PlatformKind::linear_path, {{0, 0, 9}, {30, 0, 9}, {30, 40, 9}});
  const SurveyBuildOptions options;
  const LegPaths paths(s, flat, options);
  CHECK(paths[0].duration == relative(3, 1e-12));
  CHECK(paths[1].duration == relative(4, 1e-12));
  CHECK(paths[2].duration == 0);
  CHECK(length(paths[1].path.at(Tick::of_seconds(1)).position - Vec3{30, 10, 9}) < 1e-12);
  CHECK(paths.leg_name(2) == "leg 2");
  const SurveyBuildOptions placed{.leg_places = {"a.xml:1:2"}};
  CHECK(LegPaths(s, flat, placed).leg_name(0) == "a.xml:1:2: leg 0");
  CHECK_THROWS_AS(LegPaths(SurveySettings{}, flat, options), SettingError);
}

TEST_CASE("a place may be on the ground, and beside where it should be by chance, alike for the same seed") {
  SurveySettings s = survey_of(PlatformKind::stationary, {{1, 2, 3}, {1, 2, 3}});
  s.legs[1].platform.on_ground = true;
  const SurveyBuildOptions options{.seed = 5};
  const LegPaths exact(s, flat, options);
  CHECK(exact[0].path.at({}).position == Vec3{1, 2, 3});
  CHECK(exact[1].path.at({}).position == Vec3{1, 2, 7});
  CHECK_FALSE(exact.is_stationary(0));
  s.leg_offset = LegOffsetSettings{.mean = 0, .deviation = 0.1};
  const LegPaths a(s, flat, options), b(s, flat, options);
  CHECK(a[0].path.at({}).position == b[0].path.at({}).position);
  CHECK(a[0].path.at({}).position != exact[0].path.at({}).position);
}

TEST_CASE("a place is finite, whatever the platform, and may get its height from the ground") {
  for (const PlatformKind kind :
       {PlatformKind::stationary, PlatformKind::linear_path, PlatformKind::multicopter, PlatformKind::ground_vehicle})
    for (const double bad : {std::nan(""), HUGE_VAL}) {
      CAPTURE(static_cast<int>(kind));
      CAPTURE(bad);
      CHECK_THROWS_WITH_AS(LegPaths(survey_of(kind, {{0, 0, 9}, {bad, 0, 9}}), flat, {}), doctest::Contains("leg 1: position"),
                           SettingError);
    }
  SurveySettings s = survey_of(PlatformKind::stationary, {{0, 0, std::nan("")}});
  s.legs[0].platform.on_ground = true;
  CHECK(LegPaths(s, flat, {})[0].path.at({}).position == Vec3{0, 0, 7});
}

TEST_CASE("a multicopter that hovers before, between and after ways looks along them, or where it is told to") {
  SurveySettings s = survey_of(PlatformKind::multicopter, {{0, 0, 40}, {0, 0, 40}, {40, 0, 40}, {40, 0, 40}, {40, -40, 40}}, 5);
  const SurveyBuildOptions options;
  const auto looks = [&](std::size_t k) { return LegPaths(s, flat, options)[k].path.at({}).direction(axis::forward); };
  CHECK(length(looks(0) - axis::right) < 1e-9);
  CHECK(length(looks(2) + axis::forward) < 1e-9);
  CHECK(LegPaths(s, flat, options)[2].duration == 0);
  s.legs[0].platform.yaw_at_departure = radians(30);
  s.legs[2].platform.yaw_at_departure = radians(0);
  CHECK(length(looks(0) - rotation_about(axis::up, radians(30)) * axis::forward) < 1e-9);
  CHECK(length(looks(1) - rotation_about(axis::up, radians(30)) * axis::forward) < 1e-9);  // it turns as it begins
  CHECK(length(looks(2) - axis::forward) < 1e-9);
  const LegPaths paths(s, flat, options);
  CHECK(length(paths[1].path.at(Tick::of_seconds(paths[1].duration)).direction(axis::forward) - axis::forward) < 1e-6);
}

TEST_CASE("a flight of smooth turns goes from place to place, however often its ways cross") {
  std::vector<Vec3> places;
  support::Generator any(1);
  for (int k = 0; k < 40; ++k) places.push_back({any.uniform(-300, 300), any.uniform(-300, 300), any.uniform(30, 60)});
  SurveySettings s = survey_of(PlatformKind::multicopter, places, 8);
  for (LegSettings& leg : s.legs) leg.platform.smooth_turn = true;
  const SurveyBuildOptions options;
  const LegPaths paths(s, flat, options);
  double way = 0, time = 0;
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    CAPTURE(k);
    CHECK(paths[k].duration > 1);
    CHECK(std::fabs(paths[k].path.start.seconds() - time) < 1e-6);
    way += length(places[k + 1] - places[k]);
    time += paths[k].duration;
    double nearest = 1e9;  // to where the leg begins, until it begins
    const double since = k > 0 ? paths[k - 1].duration : 0;
    for (double t = -since; t <= 0; t += 0.02)
      nearest = std::min(nearest, length(paths[k].path.at(Tick::of_seconds(t)).position - places[k]));
    CHECK(nearest < 0.3);
  }
  CHECK(time > way / 8);
  CHECK(time < way / 8 + 40 * 5);
}

TEST_CASE("a vehicle parks as it came, or as it will leave, on the ground") {
  const SurveySettings s = survey_of(PlatformKind::ground_vehicle, {{0, 0, 0}, {0, 0, 0}, {0, 30, 0}, {0, 30, 0}, {0, 90, 0}}, 5);
  const auto slope = [](const Vec2& at) -> std::optional<double> { return 0.1 * at.y; };
  const SurveyBuildOptions options;
  const LegPaths paths(s, slope, options);
  for (const std::size_t k : {0U, 2U}) {
    CAPTURE(k);
    const auto pose = paths[k].path.at({}), later = paths[k].path.at(Tick::of_seconds(9)), leaves = paths[k + 1].path.at({});
    CHECK(pose.position == later.position);
    CHECK(length(pose.position - leaves.position) < 0.01);
    CHECK(std::fabs(pose.position.z - (k == 0 ? 0 : 3)) < 0.05);
    CHECK(pose.direction(axis::forward).z > 0.09);
  }
}

}  // namespace
}  // namespace pulsecast::helios
