// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/frame.hpp>

#include <concepts>

#include <limits>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {
struct A {};
struct B {};
struct C {};
struct D {};

double distance(const Vec3& a, const Vec3& b) { return length(a - b); }

template <class Outer, class Inner>
concept Compose = requires(const Outer outer, const Inner inner) {
  outer* inner;
};
}  // namespace

static_assert(Compose<Pose<B, C>, Pose<A, B>>);
static_assert(!Compose<Pose<A, B>, Pose<B, C>>, "the inner frame stands on the right");
static_assert(!Compose<Pose<B, C>, Pose<A, C>>, "frames must touch");
static_assert(std::same_as<decltype(Pose<B, C>{} * Pose<A, B>{}), Pose<A, C>>);
static_assert(std::same_as<decltype(Pose<A, B>{}.inverse()), Pose<B, A>>);

TEST_CASE("a pose as made changes nothing") {
  const Pose<A, B> same;
  CHECK(same.point({1, -2, 3}) == Vec3{1, -2, 3});
  CHECK(same.direction({1, -2, 3}) == Vec3{1, -2, 3});
}

TEST_CASE("a pose turns first and moves then, and a direction only turns") {
  const Pose<A, B> b_from_a{rotation_about(axis::up, pi / 2), {10, 20, 30}};
  CHECK(distance(b_from_a.point({1, 0, 0}), {10, 21, 30}) < 1e-14);
  CHECK(distance(b_from_a.direction({1, 0, 0}), {0, 1, 0}) < 1e-15);
}

TEST_CASE("composition of random poses is applying one after the other, and is associative") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double reach = any.log_uniform(1e-3, 1e7);
    const auto b_from_a = any.pose<A, B>(reach);
    const auto c_from_b = any.pose<B, C>(reach);
    const auto d_from_c = any.pose<C, D>(reach);
    const Vec3 p = any.point(reach);
    CHECK(distance((c_from_b * b_from_a).point(p), c_from_b.point(b_from_a.point(p))) <= 1e-14 * reach);
    CHECK(distance(((d_from_c * c_from_b) * b_from_a).point(p), (d_from_c * (c_from_b * b_from_a)).point(p)) <=
          2e-14 * reach);
  }
}

TEST_CASE("the inverse of a random pose undoes it from both sides") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double reach = any.log_uniform(1e-3, 1e7);
    const auto b_from_a = any.pose<A, B>(reach);
    const Pose<B, A> a_from_b = b_from_a.inverse();
    const Vec3 p = any.point(reach), d = any.unit();
    CHECK(distance(a_from_b.point(b_from_a.point(p)), p) <= 1e-14 * reach);
    CHECK(distance(b_from_a.point(a_from_b.point(p)), p) <= 1e-14 * reach);
    CHECK(distance(a_from_b.direction(b_from_a.direction(d)), d) <= 1e-14);
    CHECK(length((a_from_b * b_from_a).position) <= 1e-14 * reach);
  }
}

TEST_CASE("what is ahead is x in forward-left-up axes, and what is right is negative y") {
  CHECK(to_forward_left_up(axis::forward) == Vec3{1, 0, 0});
  CHECK(to_forward_left_up(axis::right) == Vec3{0, -1, 0});
  CHECK(to_forward_left_up(axis::up) == Vec3{0, 0, 1});
}

TEST_CASE("the conversions to and from forward-left-up axes undo each other and keep handedness") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Vec3 a = any.point(1e6), b = any.point(1e6);
    CHECK(from_forward_left_up(to_forward_left_up(a)) == a);
    CHECK(to_forward_left_up(from_forward_left_up(a)) == a);
    CHECK(cross(to_forward_left_up(a), to_forward_left_up(b)) == to_forward_left_up(cross(a, b)));
  }
}

TEST_CASE("a pose is finite if all of its numbers are") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  CHECK(Pose<frame::Body, frame::World>{no_rotation, {1e100, -1e100, 0}}.finite());
  for (const double odd : {nan, infinity, -infinity})
    for (int k = 0; k < 7; ++k) {
      CAPTURE(odd);
      CAPTURE(k);
      Pose<frame::Body, frame::World> pose;
      double* const numbers[] = {&pose.position.x, &pose.position.y, &pose.position.z, &pose.rotation.w,
                                 &pose.rotation.x, &pose.rotation.y, &pose.rotation.z};
      *numbers[k] = odd;
      CHECK_FALSE(pose.finite());
      CHECK_FALSE(pose.rigid());
    }
}

TEST_CASE("a heading counts clockwise from north, whatever the slope") {
  CHECK(heading_of({0, 3, 0}) == 0);
  CHECK(heading_of({2, 0, -5}) == support::relative(90_deg, 1e-15));
  CHECK(heading_of({-1, -1, 7}) == support::relative(-135_deg, 1e-15));
  CHECK(heading_of({0, -1e-200, 1}) == support::relative(180_deg, 1e-15));
}

TEST_CASE("what has no heading is given another") {
  CHECK(heading_of({0, 0, 5}) == 0);
  CHECK(heading_of({0, 0, -5}, 1.5) == 1.5);
  CHECK(heading_of({-0.0, 0.0, 0}, 1.5) == 1.5);
}

TEST_CASE("a level body looks where its heading says, and its right is a quarter turn clockwise of it") {
  for (const double heading : {-3.0, -1.0, 0.001, 0.5, 1.5, 3.1}) {
    CAPTURE(heading);
    const Rotation r = level(heading);
    CHECK(heading_of(r * axis::forward) == support::relative(heading, 1e-14));
    CHECK(length(r * axis::right - Vec3{std::cos(heading), -std::sin(heading), 0}) < 1e-15);
    CHECK(length(r * axis::up - axis::up) < 1e-15);
  }
}
