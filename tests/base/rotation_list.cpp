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
  return length(a * right - b * right) < 1e-14 && length(a * forward - b * forward) < 1e-14;
}

}  // namespace

TEST_CASE("turns about fixed axes follow each other in the frame outside") {
  const Rotation r = fixed_axes({{right, -90_deg}, {up, 90_deg}});
  CHECK(length(r * forward + up) < 1e-15);  // down, and a turn about up leaves it there
  CHECK(length(r * right - forward) < 1e-15);
  CHECK(length(r * up + right) < 1e-15);  // tilted to forward, then turned left
}

TEST_CASE("turns about moving axes follow each other in what is turned") {
  const Rotation r = moving_axes({{right, -90_deg}, {up, 90_deg}});
  CHECK(length(r * right + up) < 1e-15);  // its own up looks forward by now: the second turn takes right to where forward was, down
  CHECK(length(r * forward + right) < 1e-15);
  CHECK(length(r * up - forward) < 1e-15);
}

TEST_CASE("no turns are no rotation, and a single turn is itself about either axes") {
  CHECK(fixed_axes({}) == no_rotation);
  CHECK(moving_axes({}) == no_rotation);
  CHECK(same(fixed_axes({{{0, 3, 4}, 1.5}}), rotation_about({0, 0.6, 0.8}, 1.5)));
  CHECK(same(moving_axes({{{0, 3, 4}, 1.5}}), rotation_about({0, 0.6, 0.8}, 1.5)));
}

TEST_CASE("turns about moving axes are those about fixed axes in reverse, and the rotation is unit") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Turn> turns;
    for (std::uint64_t n = any.whole(8); turns.size() < n;)
      turns.push_back({any.log_uniform(1e-3, 1e3) * any.unit(), any.uniform(-10, 10)});
    const Rotation moving = moving_axes(turns);
    std::reverse(turns.begin(), turns.end());
    CHECK(same(moving, fixed_axes(turns)));
    CHECK(std::fabs(length(moving) - 1) < 1e-15);
  }
}

TEST_CASE("a turn refuses an axis without length and an angle that is not finite") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS((void)fixed_axes({{right, 1}, {Vec3{}, 0}}), SettingError);
  CHECK_THROWS_AS((void)moving_axes({{right, nan}}), SettingError);
  CHECK_THROWS_AS((void)moving_axes({{{nan, 0, 0}, 1}}), SettingError);
}
