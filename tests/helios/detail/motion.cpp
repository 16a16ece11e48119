// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/motion.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"

namespace pulsecast::helios {
namespace {

/// Where a step takes a place.
Vec3 moved(const MotionStep& step, const Vec3& place) {
  return step.move.position + step.sign * (step.move.rotation * place);
}

constexpr Vec3 centre{10, 20, 30};

TEST_CASE("a motion is relative to the centre of the scene, or to the origin of the world if it is corrected by it") {
  const RotationMotion quarter{.axis = axis::up, .angle = pi / 2};
  CHECK(length(moved(motion_step({quarter}, centre), Vec3{11, 20, 5}) - Vec3{10, 21, 5}) < 1e-12);
  CHECK(length(moved(motion_step({quarter, false, 1}, centre), Vec3{1, 0, 5}) - Vec3{0, 1, 5}) < 1e-12);
  CHECK(length(moved(motion_step({quarter, true}, centre), Vec3{1, 0, 5}) - Vec3{0, 1, 5}) < 1e-12);
  CHECK(moved(motion_step({TranslationMotion{{1, 2, 3}}}, centre), Vec3{1, 1, 1}) == Vec3{2, 3, 4});
  const RotationMotion screw{.axis = 2.0 * axis::up, .angle = pi, .glide = 3};
  CHECK(length(moved(motion_step({screw, false, 1}, centre), Vec3{1, 2, 3}) - Vec3{-1, -2, 9}) < 1e-12);
}

TEST_CASE("a reflection leaves its plane where it is, and two are a way") {
  const ReflectionMotion mirror{.normal = axis::right};
  CHECK(length(moved(motion_step({mirror}, centre), Vec3{12, 5, 6}) - Vec3{8, 5, 6}) < 1e-12);
  CHECK(motion_step({mirror}, centre).sign == -1);
  const RotoreflectionMotion flip{.axis = axis::up, .angle = pi / 2};
  CHECK(length(moved(motion_step({flip, false, 1}, centre), Vec3{1, 0, 5}) - Vec3{0, 1, -5}) < 1e-12);
  MotionSequenceSettings twice{
      .motions = {{mirror}, {ReflectionMotion{.normal = axis::right, .shift = Vec3{0, 2, 0}}}}};
  const MotionSteps steps = motion_steps(twice, centre);
  REQUIRE(steps.all);
  CHECK_FALSE(steps.own);
  CHECK(steps.all->sign == 1);
  CHECK(steps.all->settled().rotation == no_rotation);
  CHECK(length(moved(*steps.all, Vec3{1, 2, 3}) - Vec3{1, 4, 3}) < 1e-12);
  CHECK(motion_problem(twice).empty());
}

TEST_CASE("steps one after the other are those of each") {
  support::Generator random(7);
  for (int round = 0; round < 100; ++round) {
    const auto vector = [&] { return Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}; };
    const MotionSettings a{RotationMotion{.axis = vector(), .angle = random.uniform(-3, 3), .center = vector()}};
    const MotionSettings b{RotoreflectionMotion{.axis = vector(), .angle = random.uniform(-3, 3)}};
    const MotionSettings c{TranslationMotion{vector()}};
    const Vec3 place = vector();
    const MotionSteps all = motion_steps({.motions = {a, b, c}}, centre);
    const Vec3 expected =
        moved(motion_step(c, centre), moved(motion_step(b, centre), moved(motion_step(a, centre), place)));
    CHECK(length(moved(*all.all, place) - expected) < 1e-12);
  }
}

}  // namespace
}  // namespace pulsecast::helios
