// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/sensor/ouster.hpp>

#include <cmath>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>

namespace pulsecast {
namespace {

TEST_CASE("the columns of an OS1 turn to the right from behind, and pass forward at half of the turn") {
  const SpinningSource source = ouster_os1_64().source(0.1);
  CHECK(source.size() == 64 * 1024);
  const auto back = source.pulse(0), ahead = source.pulse(64 * 512), left = source.pulse(64 * 256);
  REQUIRE((back && ahead && left));
  CHECK(length(back->origin() - Vec3{0, -15.806e-3, 36.18e-3}) < 1e-15);
  CHECK(length(ahead->origin() - Vec3{0, 15.806e-3, 36.18e-3}) < 1e-15);
  CHECK(left->direction().x < -0.9);
  CHECK(source.pulse(63)->tick == back->tick);
}

TEST_CASE("lasers of an OS1 are evenly spaced from the uppermost down") {
  const SpinningSensor sensor = ouster_os1_64(2048);
  CHECK(sensor.lasers.front().elevation == doctest::Approx(21.2 * pi / 180));
  CHECK(sensor.lasers.back().elevation == doctest::Approx(-21.2 * pi / 180));
  CHECK(sensor.rings().front() == 63);
  CHECK_THROWS_AS(static_cast<void>(ouster_os1_64(100)), SettingError);
  CHECK_THROWS_AS(static_cast<void>(ouster_os1_64(1024, 15)), SettingError);
  CHECK_THROWS_WITH_AS(static_cast<void>(ouster_os1_64(2048, 20)), doctest::Contains("2048 at 10; these are 20"),
                       SettingError);
}

}  // namespace
}  // namespace pulsecast
