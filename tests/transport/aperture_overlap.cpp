// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/transport/aperture_overlap.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "validation/one_pulse.hpp"

using namespace pulsecast;

namespace {

/// Share of an even beam of radius `beam` in a ring about a point at a distance, by rings about the beam's centre: the
/// arc of each ring that is in a disc follows from the law of cosines.
double by_rings(double beam, double inner, double outer, double distance) {
  const auto arc = [&](double radius, double disc) {  // share of a ring's circle in a disc
    if (radius + distance <= disc) return 1.0;
    if (std::fabs(radius - distance) >= disc) return 0.0;
    return std::acos((radius * radius + distance * distance - disc * disc) / (2 * radius * distance)) /
           std::numbers::pi;
  };
  constexpr int rings = 20'000;
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double radius = beam * (i + 0.5) / rings;
    sum += (arc(radius, outer) - arc(radius, inner)) * (2 * i + 1.0) / rings / rings;
  }
  return sum;
}

}  // namespace

TEST_CASE("the overlap of two apertures is that by quadrature within 1e-4") {
  support::Generator random(31);
  for (int i = 0; i < 300; ++i) {
    const Receiver receiver{.diameter = random.uniform(0.01, 0.2)};
    const Laser laser{.divergence = random.uniform(1e-4, 3e-3), .waist_diameter = random.uniform(0, 0.05)};
    const ApertureGeometry g{.separation = i % 3 == 0 ? 0 : random.uniform(0, 0.3),
                             .inclination = i % 2 == 0 ? 0 : random.uniform(-5e-3, 5e-3),
                             .field_of_view = random.uniform(1e-4, 5e-3),
                             .obstruction = i % 4 == 0 ? random.uniform(0, 0.1) : 0};
    const double range = random.log_uniform(0.4, 400);
    INFO("seed 31, draw ", i, ", at ", range);
    const double beam = 0.5 * std::hypot(laser.waist_diameter, laser.divergence.across * range);
    const double widening = range * std::tan(g.field_of_view / 2), view = receiver.diameter / 2 + widening;
    const double shadow = std::fmin(std::fmax(g.obstruction / 2 - widening, 0), view);
    const double surface_epsilon = std::fabs(g.separation - range * std::tan(g.inclination));
    CHECK(std::fabs(aperture_overlap(g, receiver, laser, range) - by_rings(beam, shadow, view, surface_epsilon)) <
          1e-4);
  }
}

TEST_CASE("parallel apertures see nothing at first, and all far away; coaxial ones all") {
  const Receiver receiver{.diameter = 0.05};
  const Laser laser{.divergence = 0.3e-3};
  const ApertureGeometry parallel{.separation = 0.1, .field_of_view = 2e-3}, coaxial{.field_of_view = 2e-3};
  CHECK(aperture_overlap(parallel, receiver, laser, 10) == 0);
  CHECK(aperture_overlap(parallel, receiver, laser, 500) == 1);
  for (const double range : {0.0, 0.1, 10.0, 1000.0}) CHECK(aperture_overlap(coaxial, receiver, laser, range) == 1);
}

TEST_CASE("a receiver with a table gets the share of the power that the table says") {
  Receiver receiver{.diameter = 0.05};
  const Laser laser{.divergence = 0.3e-3};
  const ApertureGeometry g{.separation = 0.1, .field_of_view = 2e-3};
  const LinkBudget all(receiver, laser);
  receiver.overlap = overlap_table(g, receiver, laser);
  receiver.validate();
  const LinkBudget part(receiver, laser);
  for (double range = 1; range < 900; range *= 1.07) {
    const double share = aperture_overlap(g, receiver, laser, range);
    CHECK(std::fabs(part.power(1, 0.5, range) / all.power(1, 0.5, range) - share) < 1e-4);
    CHECK(part.overlap_at(range) == doctest::Approx(share).epsilon(1e-3));
  }
  CHECK(part.power(1, 1, 5000) == all.power(1, 1, 5000));
}

TEST_CASE("a survey of one ray and one of many receive what the receiver sees") {
  struct Wall {
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept { return Hit{.range = 60 / ray.direction.y}; }
  };
  Receiver receiver{.diameter = 0.05, .visibility = std::numeric_limits<double>::infinity()};
  const auto received = [&](const auto& footprint) {
    return validation::one_pulse(Wall{}, footprint, {}, receiver).energy.received;
  };
  const double one = received(SingleRay{}), many = received(RingFootprint(3));
  receiver.overlap = SharedArray<OverlapAtRange>({{50, 0.0}, {70, 0.5}});
  CHECK(received(SingleRay{}) == doctest::Approx(0.25 * one).epsilon(1e-9));
  CHECK(received(RingFootprint(3)) == doctest::Approx(0.25 * many).epsilon(1e-5));
}

TEST_CASE("settings out of range are refused") {
  const Receiver receiver;
  CHECK_THROWS_AS((void)overlap_table({.separation = -1}, receiver, {}), SettingError);
  CHECK_THROWS_AS((void)overlap_table({.field_of_view = 0}, receiver, {}), SettingError);
  CHECK_THROWS_AS((void)overlap_table({}, receiver, {}, 0.1, 0.01), SettingError);
  Receiver wrong;
  wrong.overlap = SharedArray<OverlapAtRange>({{1, 0.5}, {2, 1.5}});
  CHECK_THROWS_AS(wrong.validate(), SettingError);
  wrong.overlap = SharedArray<OverlapAtRange>({{2, 0.5}, {1, 0.6}});
  CHECK_THROWS_AS(wrong.validate(), SettingError);
}
