// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scanner/subray_directions.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <doctest/doctest.h>

#include <pulsecast/scanner/beam.hpp>
#include <pulsecast/scanner/footprint.hpp>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

namespace {

double radius(const Vec2& offset) { return std::hypot(offset.x, offset.y); }

}  // namespace

TEST_CASE("a subray of an elliptical beam leaves at half the divergence of its axis") {
  const Divergence divergence{2e-3, 6e-3};
  CHECK(subray_direction({1, 0}, divergence).x == support::relative(std::sin(1e-3), 1e-13));
  CHECK(subray_direction({0, 1}, divergence).z == support::relative(std::sin(3e-3), 1e-13));
  CHECK(subray_direction({0, 0}, divergence) == axis::forward);
  const Vec3 aslant = subray_direction({0.6, 0.8}, divergence);
  CHECK(aslant.z / aslant.x == support::relative(0.8 * 3 / 0.6, 1e-13));
}

TEST_CASE("the subrays of a beam with a waist make up the hyperboloid that it is, at every range") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double across = any.log_uniform(1e-5, 1e-2), aspect = any.coin() ? 1 : any.uniform(0.2, 5);
    const Laser laser{.divergence = {across, across * aspect},
                      .waist_diameter = any.coin() ? any.log_uniform(1e-3, 0.1) : 0,
                      .waist_range = any.coin() ? any.uniform(-50, 50) : 0};
    const Vec2 offset{any.uniform(-1, 1), any.uniform(-1, 1)};
    const Vec3 exit = subray_exit(offset, laser), direction = subray_direction(offset, laser.divergence);
    CHECK(std::fabs(exit.y) < 1e-13);
    for (const double range : {0.0, 10.0, any.log_uniform(1, 1e4), laser.waist_range}) {
      const Vec3 at = exit + direction * (range / direction.y);
      const Vec2 w = beam_radius(laser, range);
      // in units of the beam's radius it is as far from the axis as in the footprint, to the square of the angle
      if (w.x > 0) CHECK(std::hypot(at.x / w.x, at.z / w.y) == support::relative(radius(offset), 3e-4));
    }
  }
  CHECK(subray_exit({0.3, 0.4}, Laser{}) == Vec3{});
  CHECK(length(subray_exit({1, 0}, Laser{.divergence = 0, .waist_diameter = 4e-3}) - Vec3{0, 0, 2e-3}) < 1e-18);
}

TEST_CASE("subrays are unit, and without divergence all go along the axis") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Vec2 offset{any.uniform(-2, 2), any.uniform(-2, 2)};
    const double divergence = any.log_uniform(1e-6, 0.5);
    const Vec3 d = subray_direction(offset, divergence);
    CHECK(length(d) == support::relative(1, 1e-15));
    CHECK(std::atan2(std::hypot(d.x, d.z), d.y) == support::relative(radius(offset) * divergence / 2, 1e-12));
    CHECK(subray_direction(offset, 0) == axis::forward);
  }
}

TEST_CASE("the subrays of an emitter are those of its footprint, scaled, in any bundle of the world") {
  const SunflowerFootprint footprint{70};
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Emitter emitter{.laser = {.divergence = any.log_uniform(1e-5, 1e-2), .waist_diameter = any.coin() ? 0.1 : 0},
                          .footprint_scale = any.uniform(0, 3)};
    const SubrayDirections subrays(footprint, emitter);
    CHECK(subrays.from_a_point() == emitter.laser.from_a_point());
    const Rotation turn = any.rotation();
    RayBundle rays;
    for (std::size_t first = 0; first < 70; first += rays.size) {
      rays.size = std::min<std::size_t>(70 - first, 1 + any.whole(RayBundle::capacity));
      subrays.to_world(matrix_of(turn), first, rays);
      for (std::size_t k = 0; k < rays.size; ++k) {
        const std::size_t j = first + k;
        const Vec2 offset = emitter.footprint_scale * footprint.offset(j);
        CHECK(subrays.shares[j] == footprint.share(j));
        CHECK(length(rays.direction(k) - turn * subray_direction(offset, emitter.laser.divergence)) < 1e-14);
        if (!subrays.from_a_point()) CHECK(subrays.exits[j] == subray_exit(offset, emitter.laser));
      }
    }
  }
}

TEST_CASE("emitters have equal subrays if beam and scale are equal") {
  const auto equal = [](const Emitter& other) { return SubrayDirections::equal({}, other); };
  CHECK(equal({.laser = {.wavelength = 532e-9, .peak_power = 1, .pulse_length = 1e-9}, .receiver = 1, .channel = 2}));
  CHECK_FALSE(equal({.laser = {.divergence = 1e-3}}));
  CHECK_FALSE(equal({.laser = {.divergence = {0.3e-3, 1e-3}}}));
  CHECK_FALSE(equal({.laser = {.waist_diameter = 1e-3}}));
  CHECK_FALSE(equal({.laser = {.waist_range = 1}}));
  CHECK_FALSE(equal({.footprint_scale = 2}));
}
