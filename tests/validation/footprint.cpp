// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// How the energy of a beam lies over its footprint: over a hole, over an edge, in an ellipse, about a waist.

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/scanner/beam.hpp>

#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

constexpr double range = 100;
constexpr Laser laser{.divergence = 1e-3};
constexpr double w = 0.5e-3 * range;  ///< the beam's radius there [m]

/// A wall with a round hole in it.
struct Hole {
  double radius;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const Vec3 p = ray.origin + ray.direction * (range / ray.direction.y);
    return std::hypot(p.x, p.z) < radius ? std::nullopt : std::optional(Hit{range / ray.direction.y, 1, 1, 0, 0});
  }
};

/// A wall that ends in an edge, and is behind it: to the left of `x` or below `z`.
struct Edge {
  double at, along_x = 1;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const Vec3 p = ray.origin + ray.direction * (range / ray.direction.y);
    return (along_x > 0 ? p.x : p.z) < at ? std::optional(Hit{range / ray.direction.y, 1, 1, 0, 0}) : std::nullopt;
  }
};

/// A wall without end.
struct Wall {
  double at;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept { return Hit{at / ray.direction.y, 1, 1, 0, 0}; }
};

/// Of a Gaussian beam, on the near side of an edge. Source: irradiance exp(-2 r^2 / w^2), integrated
double before_edge(double at, double radius) { return 0.5 * (1 + std::erf(std::sqrt(2.0) * at / radius)); }

const SunflowerFootprint sunflower(2001);

}  // namespace

TEST_CASE("footprint over a hole") {
  for (const double radius : {0.25, 0.5, 1.0, 1.5}) {
    const std::string text = std::to_string(radius).substr(0, 4);
    // Source: irradiance exp(-2 r^2 / w^2), integrated
    row("hole of " + text + " of the beam's radius: share of energy that passes", 1 - std::exp(-2 * radius * radius),
        one_pulse(Hole{radius * w}, sunflower, laser).energy.share(&EnergyLedger::missed), 0.01);
  }
}

TEST_CASE("footprint over an edge") {
  for (const double at : {-1.0, -0.5, 0.0, 0.5, 1.0})
    row("edge " + std::to_string(at).substr(0, at < 0 ? 4 : 3) +
            " of the beam's radius from its axis: share of energy that meets the wall",
        before_edge(at, 1), one_pulse(Edge{at * w}, sunflower, laser).energy.share(&EnergyLedger::scattered), 0.01);
  double worst = 0;
  for (int k = -200; k <= 200; ++k) {
    const double at = k * 0.01;
    worst =
        std::fmax(worst, std::fabs(one_pulse(Edge{at * w}, sunflower, laser).energy.share(&EnergyLedger::scattered) -
                                   before_edge(at, 1)));
  }
  row("edge at 401 places from 0 to 100 %: largest error of the share", 0, worst, 0.01);
}

TEST_CASE("elliptical footprint over an edge") {
  const Laser ellipse{.divergence = {0.5e-3, 2e-3}};
  row("ellipse of 0.5 by 2 mrad: share left of its radius across", before_edge(1, 1),
      one_pulse(Edge{0.25e-3 * range, 1}, sunflower, ellipse).energy.share(&EnergyLedger::scattered), 0.01);
  row("ellipse of 0.5 by 2 mrad: share below its radius up", before_edge(1, 1),
      one_pulse(Edge{1e-3 * range, -1}, sunflower, ellipse).energy.share(&EnergyLedger::scattered), 0.01);
}

TEST_CASE("radius of a focused beam") {
  const double w0 = 5e-3, focus = 50, quality = 3, wavelength = 1.55e-6;
  const Laser focused =
      gaussian_beam({.diameter = 2 * w0, .focus = focus, .quality = quality}, Laser{.wavelength = wavelength});
  for (const double at : {2.0, 10.0, 40.0, 100.0, 1000.0}) {
    double sum = 0;
    for (const SubrayRecord& hit : one_pulse(Wall{at}, sunflower, focused).subrays)
      sum += (hit.point.x * hit.point.x + hit.point.z * hit.point.z) / 2001;
    // the mean square of the radius is w^2 / 2. Source: Carlsson et al. 2001 for w
    const double closed = w0 * std::hypot(1 - at / focus, quality * wavelength * at / (pi * w0 * w0));
    row("beam of 10 mm, M^2 = 3, focus at 50 m: radius at " + std::to_string(static_cast<int>(at)) + " m [mm]",
        closed * 1e3, std::sqrt(2 * sum) * 1e3, closed > 0.1 ? 1 : 0.01);
  }
}
