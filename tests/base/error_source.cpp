// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/error_source.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;

namespace {

/// Displacement of a point that left the beam's exit [m].
template <class Frame>
Vec3 displaced(const PoseError<Frame>& error, const Vec3& point, const Vec3& exit) {
  return error.moved + cross(error.turned, point - error.about.value_or(exit));
}

}  // namespace

TEST_CASE("an error in the frame around is what turning and moving it there displaces") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const auto pose = random.pose<frame::Body, frame::World>(100);
    PoseError<frame::Body> error{.moved = random.point(1),
                                 .turned = random.point(0.1),
                                 .scope = ErrorScope::leg,
                                 .moved_any_way = 3,
                                 .turned_any_way = 4};
    if (random.coin()) error.about = random.point(10);
    const auto outer = pose * error;
    CHECK(outer.scope == ErrorScope::leg);
    CHECK(outer.moved_any_way == 3);  // alike along all axes, so in any frame
    CHECK(outer.turned_any_way == 4);
    CHECK(outer.about.has_value() == error.about.has_value());

    // differences of rigid motions by a small share of the error, seen in the world
    const double share = 1e-5;
    const Vec3 point = random.point(50), exit = random.point(1), about = error.about.value_or(exit);
    const auto moved_by = [&](double s) {
      const double angle = s * length(error.turned);
      const Vec3 turned = rotation_about(error.turned, angle) * (point - about) + about;
      return pose.point(turned + s * error.moved);
    };
    const Vec3 by_difference = (moved_by(share) - moved_by(-share)) / (2 * share);
    CHECK(length(displaced(outer, pose.point(point), pose.point(exit)) - by_difference) < 1e-7);
    CHECK(length(pose.direction(displaced(error, point, exit)) - by_difference) < 1e-7);
  }
}

TEST_CASE("a covariance is the sum of the outer products of what was added") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    Covariance sum, rest;
    double variance = 0;
    const Vec3 a = random.point(3), b = random.point(2), along = random.unit();
    sum.add(a);
    rest.add(b);
    rest.add(0.25);
    sum.add(rest);
    for (const Vec3& v : {a, b}) variance += dot(v, along) * dot(v, along);
    CHECK(sum.along(along) == doctest::Approx(variance + 0.25).epsilon(1e-13));
    CHECK(sum.along(axis::right) == sum.xx);
    CHECK(sum.along(axis::forward) == sum.yy);
    CHECK(sum.along(axis::up) == sum.zz);
    CHECK(sum.xy == doctest::Approx(a.x * a.y + b.x * b.y).epsilon(1e-13));
    CHECK(sum.xz == doctest::Approx(a.x * a.z + b.x * b.z).epsilon(1e-13));
    CHECK(sum.yz == doctest::Approx(a.y * a.z + b.y * b.z).epsilon(1e-13));
  }
}

TEST_CASE("in other axes a covariance is that of the turned vectors") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const Rotation turn = random.rotation();
    Covariance before, expected;
    for (int k = 0; k < 3; ++k) {
      const Vec3 v = random.point(2);
      before.add(v);
      expected.add(turn * v);
    }
    const Covariance after = before.in_axes([&](const Vec3& v) { return turn * v; });
    for (const auto member :
         {&Covariance::xx, &Covariance::yy, &Covariance::zz, &Covariance::xy, &Covariance::xz, &Covariance::yz})
      CHECK(after.*member == doctest::Approx(expected.*member).epsilon(1e-13));

    // also where axes are mirrored, or of another kind, as x forward, y left
    const Covariance rosy = before.in_axes([](const Vec3& v) { return to_forward_left_up(v); });
    CHECK(rosy.xx == before.yy);
    CHECK(rosy.yy == before.xx);
    CHECK(rosy.xy == -before.xy);
    CHECK(rosy.yz == -before.xz);
  }
}
