// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/rotation_list.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// Whether the two turn everything alike.
bool same(const Rotation& a, const Rotation& b) {
  return length(a * axis::right - b * axis::right) < 1e-14 && length(a * axis::forward - b * axis::forward) < 1e-14;
}

}  // namespace

TEST_CASE("turns about fixed axes follow each other in the frame outside") {
  const Rotation r = extrinsic({{axis::right, -90_deg}, {axis::up, 90_deg}});
  CHECK(length(r * axis::forward + axis::up) < 1e-15);  // down, and a turn about up leaves it there
  CHECK(length(r * axis::right - axis::forward) < 1e-15);
  CHECK(length(r * axis::up + axis::right) < 1e-15);  // tilted to forward, then turned left
}

TEST_CASE("turns about moving axes follow each other in what is turned") {
  const Rotation r = intrinsic({{axis::right, -90_deg}, {axis::up, 90_deg}});
  CHECK(length(r * axis::right + axis::up) <
        1e-15);  // its own up looks forward by now: the second turn takes right to where forward was, down
  CHECK(length(r * axis::forward + axis::right) < 1e-15);
  CHECK(length(r * axis::up - axis::forward) < 1e-15);
}

TEST_CASE("no turns are no rotation, and a single turn is itself about either axes") {
  CHECK(extrinsic({}) == no_rotation);
  CHECK(intrinsic({}) == no_rotation);
  CHECK(same(extrinsic({{{0, 3, 4}, 1.5}}), rotation_about({0, 0.6, 0.8}, 1.5)));
  CHECK(same(intrinsic({{{0, 3, 4}, 1.5}}), rotation_about({0, 0.6, 0.8}, 1.5)));
}

TEST_CASE("turns about moving axes are those about fixed axes in reverse, and the rotation is unit") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<AxisAngle> turns;
    for (std::uint64_t n = any.whole(8); turns.size() < n;)
      turns.push_back({any.log_uniform(1e-3, 1e3) * any.unit(), any.uniform(-2 * pi, 2 * pi)});
    const Rotation moving = intrinsic(turns);
    std::reverse(turns.begin(), turns.end());
    CHECK(same(moving, extrinsic(turns)));
    CHECK(std::fabs(length(moving) - 1) < 1e-15);
  }
}

TEST_CASE("a turn refuses an axis without length and an angle that is not finite") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS((void)extrinsic({{axis::right, 1}, {Vec3{}, 0}}), SettingError);
  CHECK_THROWS_AS((void)intrinsic({{axis::right, nan}}), SettingError);
  CHECK_THROWS_AS((void)intrinsic({{{nan, 0, 0}, 1}}), SettingError);
}
