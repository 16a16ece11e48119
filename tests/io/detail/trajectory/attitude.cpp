// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/trajectory/attitude.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"

namespace pulsecast::io {
namespace {

constexpr Vec3 north = axis::forward, east = axis::right, down = -axis::up;
constexpr double tight = 1e-14;

bool same(const Vec3& a, const Vec3& b, double allowed = tight) { return max_norm(a - b) < allowed; }

/// The angle between two attitudes [rad].
double apart(const Rotation& a, const Rotation& b) {
  const Rotation turn = conjugate(a) * b;
  return 2 * std::asin(std::min(1.0, length(Vec3{turn.x, turn.y, turn.z})));
}

Rotation of(double roll_deg, double pitch_deg, double yaw_deg, const AngleConvention& convention) {
  return rotation_of({radians(roll_deg), radians(pitch_deg), radians(yaw_deg)}, convention);
}

/// Every order of the three angles, each about its axis in either sense, and level at some heading.
std::vector<AngleConvention> every_convention() {
  std::vector<AngleConvention> all{heading_pitch_roll, helios_arinc_705, helios_canonical, mathematical,
                                   ros_roll_pitch_yaw};
  std::array<int, 3> order{0, 1, 2};
  const std::array<Vec3, 3> axes{axis::right, axis::forward, axis::up};
  const std::array<double RollPitchYaw::*, 3> angles{&RollPitchYaw::roll, &RollPitchYaw::pitch, &RollPitchYaw::yaw};
  do {
    for (std::size_t first = 0; first < 3; ++first)
      for (unsigned signs = 0; signs < 8; ++signs) {
        AngleConvention c{.zero_heading = 0.25 * static_cast<double>(signs)};
        for (std::size_t i = 0; i < 3; ++i) {
          const auto k = static_cast<std::size_t>(order[i]);
          c.turns[i] = {angles[(k + first) % 3], axes[k] * (signs >> i & 1 ? -1.0 : 1.0)};
        }
        all.push_back(c);
      }
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

TEST_CASE("each convention turns about the axes that it names, in its order and sense, from its zero heading") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const double roll = random.uniform(-pi, pi), pitch = random.uniform(-pi, pi), yaw = random.uniform(-pi, pi);
    const Rotation wing_down = rotation_about(axis::forward, roll), nose_up = rotation_about(axis::right, pitch);
    const Rotation from_north = rotation_about(-axis::up, yaw), from_east = rotation_about(axis::up, yaw - pi / 2);
    const auto differs = [&](const AngleConvention& convention, const Rotation& expected) {
      return apart(rotation_of({roll, pitch, yaw}, convention), expected) > tight;
    };
    CHECK_FALSE(differs(heading_pitch_roll, from_north * nose_up * wing_down));
    CHECK_FALSE(differs(helios_arinc_705, from_north * wing_down * nose_up));
    CHECK_FALSE(differs(mathematical, from_east * nose_up * wing_down));
    CHECK_FALSE(differs(ros_roll_pitch_yaw, from_east * conjugate(nose_up) * wing_down));
    CHECK_FALSE(differs(helios_canonical, rotation_about(axis::right, roll) * rotation_about(axis::forward, pitch) *
                                              rotation_about(axis::up, yaw)));
  }
}

TEST_CASE("aviation's convention is the one of forward, right, down in north, east, down") {
  const Axes aviation{BodyAxes::forward_right_down, WorldAxes::north_east_down};
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const double roll = random.uniform(-pi, pi), pitch = random.uniform(-1.5, 1.5), yaw = random.uniform(-pi, pi);
    const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    const Rotation ned_from_frd = rotation_about(z, yaw) * rotation_about(y, pitch) * rotation_about(x, roll);
    CHECK(apart(aviation.from_file(ned_from_frd), rotation_of({roll, pitch, yaw}, heading_pitch_roll)) < tight);
    const Axes robot{BodyAxes::forward_left_up, WorldAxes::east_north_up};
    CHECK(apart(robot.from_file(ned_from_frd), rotation_of({roll, pitch, yaw}, ros_roll_pitch_yaw)) < tight);
  }
}

TEST_CASE("axes are what they are called") {
  const auto agree = [](const Axes& axes, const std::array<Vec3, 3>& body, const std::array<Vec3, 3>& world) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      CAPTURE(seed);
      support::Generator random(seed);
      const Rotation in_file = random.rotation();
      const Rotation rotation = axes.from_file(in_file);
      CHECK(apart(axes.to_file(rotation), in_file) < tight);
      const Vec3 p = random.point(1);  // in the file's axes
      const Vec3 turned = in_file * p;
      CHECK(same(rotation * (body[0] * p.x + body[1] * p.y + body[2] * p.z),
                 world[0] * turned.x + world[1] * turned.y + world[2] * turned.z));
      CHECK(axes.swapped(p) == world[0] * p.x + world[1] * p.y + world[2] * p.z);
      CHECK(axes.swapped(axes.swapped(p)) == p);
    }
  };
  for (const auto& [world, directions] :
       {std::pair{WorldAxes::east_north_up, std::array<Vec3, 3>{east, north, axis::up}},
        {WorldAxes::north_east_down, std::array<Vec3, 3>{north, east, down}}}) {
    agree({BodyAxes::right_forward_up, world}, {axis::right, axis::forward, axis::up}, directions);
    agree({BodyAxes::forward_right_down, world}, {axis::forward, axis::right, down}, directions);
    agree({BodyAxes::forward_left_up, world}, {axis::forward, -axis::right, axis::up}, directions);
  }
}

TEST_CASE("the angles of every attitude make that attitude again, at the poles and however near to them") {
  double worst = 0;
  std::uint64_t seed = 0;
  for (const AngleConvention& c : every_convention()) {
    CHECK_NOTHROW(c.validate());
    for (int i = 0; i < 60; ++i, ++seed) {
      CAPTURE(seed);
      support::Generator random(seed);
      Rotation rotation = random.rotation();
      if (i % 2 == 1) {
        RollPitchYaw angles{random.uniform(-pi, pi), random.uniform(-pi, pi), random.uniform(-pi, pi)};
        const double off = i % 4 == 1 ? 0 : random.log_uniform(1e-17, 1);
        angles.*c.turns[1].angle = (random.coin() ? 1 : -1) * (pi / 2 - off);
        rotation = rotation_of(angles, c);
      }
      const RollPitchYaw angles = roll_pitch_yaw(rotation, c);
      CHECK(std::fabs(angles.*c.turns[0].angle) <= pi);
      CHECK(std::fabs(angles.*c.turns[1].angle) <= pi / 2);
      CHECK(std::fabs(angles.*c.turns[2].angle) <= pi);
      worst = std::max(worst, apart(rotation_of(angles, c), rotation));
      CHECK(worst < 1e-13);
      CHECK(apart(rotation_of(roll_pitch_yaw(-rotation, c), c), rotation) < 1e-13);  // the same attitude
    }
  }
  MESSAGE("furthest apart [rad]: ", worst);
}

TEST_CASE("where two of the angles are one turn, all of it is yaw") {
  for (const double pitch_deg : {90.0, -90.0}) {
    const RollPitchYaw angles = roll_pitch_yaw(of(40, pitch_deg, 100, heading_pitch_roll), heading_pitch_roll);
    CHECK(angles.roll == 0);
    CHECK(angles.pitch == doctest::Approx(radians(pitch_deg)).epsilon(1e-14));
    CHECK(degrees(angles.yaw) == doctest::Approx(pitch_deg > 0 ? 60 : 140).epsilon(1e-13));
  }
  const RollPitchYaw canonical = roll_pitch_yaw(of(40, 90, 100, helios_canonical), helios_canonical);
  CHECK(canonical.roll == 0);
  CHECK(degrees(canonical.yaw) == doctest::Approx(140).epsilon(1e-13));
  const RollPitchYaw arinc = roll_pitch_yaw(of(90, 40, 100, helios_arinc_705), helios_arinc_705);
  CHECK(arinc.pitch == 0);
  CHECK(degrees(arinc.roll) == doctest::Approx(90).epsilon(1e-14));
  CHECK(degrees(arinc.yaw) == doctest::Approx(140).epsilon(1e-13));
}

TEST_CASE("conventions that say nothing definite are refused") {
  AngleConvention c;
  c.zero_heading = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(c.validate(), SettingError);
  c = {};
  c.turns[2].axis = axis::right;  // as the pitch's
  CHECK_THROWS_AS(c.validate(), SettingError);
  c.turns[2].axis = {0, 2, 0};
  CHECK_THROWS_AS(c.validate(), SettingError);
  c = {};
  c.turns[2].angle = &RollPitchYaw::yaw;  // twice
  CHECK_THROWS_AS(c.validate(), SettingError);
  c.turns[2].angle = nullptr;
  CHECK_THROWS_AS(c.validate(), SettingError);
}

}  // namespace
}  // namespace pulsecast::io
