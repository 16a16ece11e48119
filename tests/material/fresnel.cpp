// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/fresnel.hpp>

#include <cmath>
#include <cstdint>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>

#include "support/generators.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

TEST_CASE("the face between two media splits light as Fresnel's equations say, in their form by angles") {
  for (const double n : {1.0 / 1.5, 1 / 1.33, 1.33, 1.5, 2.4})
    for (int degrees = 1; degrees < 90; ++degrees) {
      const double a = degrees * 1_deg, sine = std::sin(a) / n;
      const FresnelSplit split = fresnel_split(std::cos(a), n);
      if (sine >= 1) {
        CHECK(split.reflected == 1);
        continue;
      }
      const double b = std::asin(sine);
      const double s = std::sin(a - b) / std::sin(a + b), p = std::tan(a - b) / std::tan(a + b);
      CHECK(std::fabs(split.perpendicular - s * s) < 1e-12);
      CHECK(std::fabs(split.parallel - p * p) < 1e-12);
      CHECK(std::fabs(split.reflected - (s * s + p * p) / 2) < 1e-12);
      CHECK(std::fabs(split.cos_refracted - std::cos(b)) < 1e-12);
      const FresnelSplit back = fresnel_split(std::cos(b), 1 / n);  // the same, the other way round
      CHECK(std::fabs(back.reflected - split.reflected) < 1e-12);
    }
  CHECK(fresnel_split(1, 1.5).reflected == doctest::Approx(0.04).epsilon(1e-12));
  CHECK(fresnel_split(1, 1).reflected == 0);
  CHECK(fresnel_split(0, 1.5).reflected == 1);
  CHECK(fresnel_split(0, 1).reflected == 1);
  CHECK(fresnel_split(std::cos(std::atan(1.5)), 1.5).parallel < 1e-30);  // Brewster's angle
}

TEST_CASE("refracted and mirrored directions are unit, in the plane of incidence, and obey Snell's law") {
  support::Generator any(7);
  for (int k = 0; k < 2000; ++k) {
    CAPTURE(k);
    const Vec3 normal = any.unit();
    Vec3 d = any.unit();
    if (dot(d, normal) > 0) d = -d;
    const double n = any.uniform(0.4, 2.5), cosine = -dot(d, normal);
    const FresnelSplit split = fresnel_split(cosine, n);
    const Vec3 back = mirrored(d, normal);
    CHECK(std::fabs(length(back) - 1) < 1e-14);
    CHECK(std::fabs(dot(back, normal) - cosine) < 1e-14);
    if (split.reflected >= 1) continue;
    const Vec3 on = refracted(d, normal, n, split);
    CHECK(std::fabs(length(on) - 1) < 1e-13);
    CHECK(length(cross(d, normal) - n * cross(on, normal)) < 1e-13);
    CHECK(std::fabs(dot(on, normal) + split.cos_refracted) < 1e-13);
  }
}

TEST_CASE("a pane shifts rays, delays them, and keeps the energy") {
  const SmoothInterface pane{
      .kind = InterfaceKind::pane, .thickness = 0.02, .inside = {.index = 1.5, .group_index = 1.53}};
  for (int degrees = 0; degrees < 90; ++degrees) {
    const double a = degrees * 1_deg, b = std::asin(std::sin(a) / 1.5);
    const PaneSplit split = pane_split(std::cos(a), pane);
    CHECK(std::fabs(split.reflected + split.transmitted - 1) < 1e-12);
    CHECK(std::fabs(split.shift * std::sin(a) - 0.02 * std::sin(a - b) / std::cos(b)) < 1e-12);
    // the way between the faces, and then the rest of the way to a plane one metre behind the first
    const double through = 1.53 * 0.02 / std::cos(b) + (1 - 0.02) / std::cos(a);
    const double shifted = (1 - split.shift) / std::cos(a) + split.delay;
    CHECK(std::fabs(through - shifted) < 1e-12);
  }
  const double r = 0.04;
  CHECK(pane_split(1, pane).reflected == doctest::Approx(2 * r / (1 + r)));
}

TEST_CASE("a pane's light is that of all ways between its faces, summed one by one") {
  SmoothInterface pane = SmoothInterface::pane(0.006);
  pane.inside.absorption = 30;
  for (const double degrees : {0.0, 30.0, 56.0, 80.0}) {
    const double cosine = std::cos(degrees * 1_deg);
    const FresnelSplit face = fresnel_split(cosine, pane.inside.index);
    const double pass = std::exp(-30 * 0.006 / face.cos_refracted);
    double reflected = 0, transmitted = 0;
    for (const double r : {face.perpendicular, face.parallel}) {
      reflected += r / 2;
      double inside = (1 - r) * pass / 2;
      for (int k = 0; k < 100; ++k) {
        (k % 2 == 0 ? transmitted : reflected) += inside * (1 - r);
        inside *= r * pass;
      }
    }
    const PaneSplit split = pane_split(cosine, pane);
    CHECK(split.reflected == doctest::Approx(reflected).epsilon(1e-12));
    CHECK(split.transmitted == doctest::Approx(transmitted).epsilon(1e-12));
  }
}

TEST_CASE("all of the light that grazes a pane is reflected, down to the least cosine") {
  for (const double cosine : {1e-15, 1e-16, 1e-17, 1e-300, 0.0}) {
    const PaneSplit split = pane_split(cosine, SmoothInterface::pane(0.004));
    CHECK(split.reflected == doctest::Approx(1));
    CHECK(split.transmitted < 1e-12);
  }
}
