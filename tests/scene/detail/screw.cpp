// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/detail/screw.hpp>

#include <cmath>
#include <cstdint>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;
using detail::Periods;
using detail::RotationParts;
using detail::Screw;

TEST_CASE("a rigid motion done n times is that motion after itself") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    static constexpr double angles[] = {0, 1e-15, 1e-9, 1e-3, 1, pi};
    const Rotation turn = any.coin() ? any.rotation() : rotation_about(any.unit(), angles[any.whole(6)]);
    const Screw once{turn, any.point(3)};
    Screw expected{};
    const Vec3 p = any.point(10);
    for (std::int64_t n = 0; n <= 200; ++n) {
      const Screw all = repeated(once, n);
      REQUIRE(length(all.point(p) - expected.point(p)) < 1e-10);
      expected = then(expected, once);
    }
  }
}

TEST_CASE("a full circle in many steps ends where it began, after any number of rounds") {
  // a polygon of 1000 corners around a point 5 m away
  const Vec3 centre{3, 4, 0};
  const Rotation turn = rotation_about(axis::up, 2 * pi / 1000);
  const Screw once{turn, centre - turn * centre};
  CHECK(length(repeated(once, 1000).point({}) - Vec3{}) < 1e-11);
  CHECK(length(repeated(once, 1'000'000'000).point({}) - Vec3{}) < 1e-5);
  CHECK(length(repeated(once, 500).point({}) - 2.0 * centre) < 1e-11);
}

TEST_CASE("a rotation has an axis and an angle up to half a turn") {
  for (const double angle : {0.0, 1e-12, 0.5, 3.0, 3.5}) {
    CAPTURE(angle);
    const RotationParts found(rotation_about({0, 0, 2}, angle));
    CHECK(std::fabs(found.angle - (angle <= pi ? angle : 2 * pi - angle)) < 1e-14);
    if (angle > 0) CHECK(length(found.axis - (angle <= pi ? axis::up : -axis::up)) < 1e-12);
  }
}

TEST_CASE("a time is so many periods and a rest, as exact after a year as in the first second") {
  const Tick year{31'536'000, 0.25};
  CHECK(Periods(year, 0.5).whole == 63'072'000);
  CHECK(Periods(year, 0.5).rest == Tick{0, 0.25});
  CHECK(Periods({7, 0.5}, 2.5).whole == 3);
  CHECK(Periods({7, 0.5}, 2.5).rest == Tick{0, 0});
  CHECK(Periods({1, 0.75}, 10).whole == 0);
  CHECK(Periods({1, 0.75}, 10).rest == Tick{1, 0.75});
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double period = any.log_uniform(1e-6, 1e4);
    const Tick time{static_cast<std::int64_t>(any.whole(100'000'000)), any.uniform()};
    const Periods p(time, period);
    REQUIRE(p.rest.seconds() >= 0);
    REQUIRE(p.rest.seconds() < period);
    const double whole = static_cast<double>(p.whole) * period,
                 lost = std::fma(static_cast<double>(p.whole), period, -whole);
    const double second = static_cast<double>(time.second);
    REQUIRE(std::fabs((second - whole) + (time.fraction - p.rest.seconds()) - lost) < 1e-15 * (1 + period));
  }
}

TEST_CASE("from one tick to a later one is the time between, less no fraction") {
  CHECK(detail::since({3, 0.75}, {5, 0.25}) == Tick{1, 0.5});
  CHECK(detail::since({3, 0.25}, {5, 0.75}) == Tick{2, 0.5});
  CHECK(detail::since({3, 0.5}, {3, 0.5}) == Tick{});
  CHECK(detail::since({0, 1e-20}, {1, 0}) == Tick{1, 0});
}
