// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/lanes.hpp>

#include <bit>
#include <cmath>
#include <cstdint>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;

namespace {

/// Slots of rates for which the quotient rounds to a whole second, or does not.
struct Slot {
  PulseIndex i;
  double rate;
};
Slot drawn(support::Generator& any, int k) {
  const double rate = k % 3 == 0 ? std::round(any.log_uniform(1, 1e6)) : any.log_uniform(1, 1e12);
  const double seconds = k % 2 == 0 ? std::round(any.log_uniform(1, 1e6)) : any.log_uniform(1e-3, 1e9);
  return {static_cast<PulseIndex>(std::fmin(0x1p51, std::round(seconds * rate))), rate};
}

}  // namespace

TEST_CASE("slots and phases in lanes are those of a tick, to the last bit") {
  constexpr std::uint64_t seed = 4;
  support::Generator any(seed);
  CAPTURE(seed);
  for (int k = 0; k < 20'000; ++k) {
    const Slot slot = drawn(any, k);
    const PulseIndex i = slot.i;
    const double rate = slot.rate;
    const double frequency = (k % 5 == 0 ? -1 : 1) * any.log_uniform(1e-6, 1e12);
    const TickLanes ticks = TickLanes::of(i, rate), later = ticks + Tick{3, 0.75};
    const simd::Doubles phases = ticks.phase(frequency), seconds = ticks.seconds();
    CAPTURE(i);
    CAPTURE(rate);
    CAPTURE(frequency);
    for (std::size_t lane = 0; lane < simd::lane_count; ++lane) {
      const Tick t = Tick::of(i + lane, rate);
      REQUIRE(ticks[lane] == t);
      REQUIRE(later[lane] == t + Tick{3, 0.75});
      REQUIRE(seconds[lane] == t.seconds());
      REQUIRE(std::fabs(phases[lane] - t.phase(frequency)) <= 0x1p-52);  // equal unless the compiler contracts
    }
  }
}

TEST_CASE("a product and its error are the exact product") {
  support::Generator any(5);
  for (int k = 0; k < 20'000; ++k) {
    const double a = any.log_uniform(1e-9, 1e15), b = any.log_uniform(1e-12, 1e12);
    const simd::Doubles as = simd::Doubles{} + a, bs = simd::Doubles{} + b, product = as * bs;
    CHECK(detail::product_error(as, bs, product)[0] == std::fma(a, b, -(a * b)));
  }
}

TEST_CASE("poses in lanes compose and turn as poses do") {
  support::Generator any(6);
  for (int k = 0; k < 500; ++k) {
    PoseLanes<frame::Body, frame::World> outer;
    PoseLanes<frame::Instrument, frame::Body> inner;
    for (std::size_t lane = 0; lane < simd::lane_count; ++lane) {
      outer.set(lane, {rotation_about(any.unit(), any.uniform(-3, 3)), any.point(1e3)});
      inner.set(lane, {rotation_about(any.unit(), any.uniform(-3, 3)), any.point(10)});
    }
    const auto both = outer * inner;
    const Vec3 from = any.unit();
    const Vec3Lanes turned = outer.rotation * Vec3Lanes(from), summed = outer.position + inner.position;
    for (std::size_t lane = 0; lane < simd::lane_count; ++lane) {
      const auto expected = outer[lane] * inner[lane];
      CHECK(length(both[lane].position - expected.position) < 1e-12);
      CHECK(length(both[lane].rotation - expected.rotation) < 1e-15);
      CHECK(length(turned[lane] - outer[lane].direction(from)) < 1e-15);
      CHECK(summed[lane] == outer[lane].position + inner[lane].position);
    }
  }
}

TEST_CASE("rotations about an axis and unit vectors in lanes") {
  const simd::Doubles angle = simd::generate([](std::size_t lane) { return 0.3 + static_cast<double>(lane); });
  const RotationLanes about = RotationLanes::about(axis::up, angle);
  const Vec3Lanes longer = angle * Vec3Lanes(Vec3{3, 0, 4});
  const RotationLanes unit = normalize(RotationLanes{2 * about.w, 2 * about.x, 2 * about.y, 2 * about.z});
  for (std::size_t lane = 0; lane < simd::lane_count; ++lane) {
    CHECK(length(about[lane] - rotation_about(axis::up, angle[lane])) < 1e-15);
    CHECK(length(unit[lane] - about[lane]) < 1e-15);
    CHECK(length(normalize(longer)[lane] - Vec3{0.6, 0, 0.8}) < 1e-15);
    CHECK(dot(longer, longer)[lane] == doctest::Approx(25 * angle[lane] * angle[lane]));
    CHECK(length(cross(Vec3Lanes(axis::right), Vec3Lanes(axis::forward))[lane] - axis::up) == 0);
  }
}

TEST_CASE("masks of lanes, and poses that are not rigid") {
  CHECK(simd::bits(all_lanes()) == (1U << simd::lane_count) - 1);
  CHECK(simd::bits(first_lanes(0)) == 0);
  CHECK(simd::bits(first_lanes(1)) == 1);
  CHECK(simd::bits(first_lanes(simd::lane_count)) == simd::bits(all_lanes()));
  PoseLanes<frame::Body, frame::World> poses;
  CHECK(rigid_lanes(poses, all_lanes()));
  poses.set(1, {Rotation{2, 0, 0, 0}, {}});
  CHECK(!rigid_lanes(poses, all_lanes()));
  CHECK(rigid_lanes(poses, first_lanes(1)));
  poses.set(1, {no_rotation, {std::nan(""), 0, 0}});
  CHECK(rigid_lanes(poses, all_lanes()));
}
