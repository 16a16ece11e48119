// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/settings.hpp>

#include <variant>

#include <doctest/doctest.h>

using namespace pulsecast;
using namespace pulsecast::helios;

TEST_CASE("turns about fixed axes and about moving axes are composed as the reference's golden numbers say") {
  // Mount list (x -90, z 90), heading 30 degrees to the left, deflector 10 degrees up: HELIOS++ behaviour reference,
  // appendix A8.
  const RotationList fixed{.turns = {{Axis::x, radians(-90)}, {Axis::z, radians(90)}}},
      moving{.turns = fixed.turns, .local = true};
  const Rotation heading = rotation_about(axis::up, radians(30)), deflection = rotation_about(axis::right, radians(10));
  const Vec3 by_fixed = heading * fixed.rotation() * deflection * axis::forward,
             by_moving = heading * moving.rotation() * deflection * axis::forward;
  CHECK(length(by_fixed - Vec3(-0.150383733180435, -0.086824088833465, -0.984807753012208)) < 1e-14);
  CHECK(length(by_moving - Vec3(-0.939692620785909, -0.342020143325669, 0)) < 1e-14);
}

TEST_CASE("no turns are no rotation, and every axis is its own") {
  CHECK(RotationList{}.rotation() == no_rotation);
  const auto turned = [](Axis axis, const Vec3& v) {
    return RotationList{.turns = {{axis, radians(90)}}}.rotation() * v;
  };
  CHECK(length(turned(Axis::x, axis::forward) - axis::up) < 1e-15);
  CHECK(length(turned(Axis::y, axis::up) - axis::right) < 1e-15);
  CHECK(length(turned(Axis::z, axis::right) - axis::forward) < 1e-15);
}

TEST_CASE("settings are equal if all that they hold is") {
  const auto make = [] {
    return SurveySettings{
        .name = "a",
        .scanner = {.channels = {{.optic = RisleyOptic{}}}},
        .scene = {.parts = {{.source = VoxelSource{}, .motions = {{.motions = {{.kind = RotationMotion{}}}}}}}},
        .legs = {{.platform = {.trajectory = TrajectorySettings{}}}}};
  };
  const SurveySettings survey = make();
  CHECK(survey == make());
  const auto differs = [&](auto change) {
    SurveySettings other = make();
    change(other);
    return other != survey;
  };
  CHECK(differs([](SurveySettings& s) { s.seed = 0; }));
  CHECK(differs([](SurveySettings& s) { s.scanner.channels[0].optic = LineOptic{}; }));
  CHECK(differs([](SurveySettings& s) { std::get<RisleyOptic>(s.scanner.channels[0].optic).prisms[2].angle = 1; }));
  CHECK(differs([](SurveySettings& s) { std::get<VoxelSource>(s.scene.parts[0].source).material.name = "x"; }));
  CHECK(differs(
      [](SurveySettings& s) { std::get<RotationMotion>(s.scene.parts[0].motions[0].motions[0].kind).glide = 0; }));
  CHECK(differs([](SurveySettings& s) { s.legs[0].platform.trajectory->columns.emplace(); }));
  CHECK(differs([](SurveySettings& s) { s.platform.attitude_noise[1].emplace(); }));
  CHECK(differs([](SurveySettings& s) { s.legs[0].scanner.divergence = 0; }));
}

TEST_CASE("the last leg of a platform that goes from leg to leg only says where the one before it ends") {
  SurveySettings s;
  s.legs.resize(3);
  s.legs[1].platform.position = s.legs[2].platform.position = {5, 0, 0};
  for (const PlatformKind kind : {PlatformKind::linear_path, PlatformKind::multicopter, PlatformKind::ground_vehicle}) {
    s.platform.kind = kind;
    CHECK(legs_connect(kind));
    CHECK_FALSE(only_ends(s, 1));
    CHECK(only_ends(s, 2));
    CHECK_FALSE(is_stationary(s, 0));
    CHECK(is_stationary(s, 1));
    CHECK_FALSE(is_stationary(s, 2));
  }
  for (const PlatformKind kind : {PlatformKind::stationary, PlatformKind::interpolated}) {
    s.platform.kind = kind;
    CHECK_FALSE(legs_connect(kind));
    CHECK_FALSE(only_ends(s, 2));
    CHECK_FALSE(is_stationary(s, 1));
  }
  s.platform.kind = PlatformKind::multicopter;
  s.legs.resize(1);
  CHECK_FALSE(only_ends(s, 0));
  CHECK(is_stationary(s, 0));
}

TEST_CASE("the first pulse rate is that of a leg, then of the scanner, then 100 kHz") {
  SurveySettings s;
  s.legs.resize(2);
  CHECK(first_pulse_rate(s) == 100e3);
  s.scanner.pulse_rates = {7e3, 8e3};
  CHECK(first_pulse_rate(s) == 7e3);
  s.legs[1].scanner.pulse_rate = 9e3;
  CHECK(first_pulse_rate(s) == 9e3);
}
