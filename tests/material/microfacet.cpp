// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/microfacet.hpp>

#include <cmath>
#include <cstdint>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/material/material.hpp>

#include "support/generators.hpp"
#include "support/scattering_laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(ScattersBetween<Microfacet> && ReflectsInterface<Microfacet>);

namespace {

/// Integral over the hemisphere about z, of a function of a direction.
template <class F>
double over_hemisphere(const F& f, int steps = 400) {
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double angle = (i + 0.5) / steps * pi / 2;
    for (int k = 0; k < steps; ++k) {
      const double turn = (k + 0.5) / steps * 2 * pi;
      sum += f(Vec3{std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)}) *
             std::sin(angle);
    }
  }
  return sum * pi / 2 / steps * 2 * pi / steps;
}

Vec3 at_angle(double angle) { return {std::sin(angle), 0, std::cos(angle)}; }

}  // namespace

TEST_CASE("the facets' normals fill the plane, with the variance of their slope") {
  for (const double slope : {0.05, 0.2, 0.5, 1.0}) {
    const detail::Microfacets rough{.slope = slope};
    CHECK(over_hemisphere([&](const Vec3& n) { return rough.density(n.z) * n.z; }, 2000) ==
          doctest::Approx(1).epsilon(1e-3));
    const double variance = over_hemisphere(
        [&](const Vec3& n) { return rough.density(n.z) * n.z * (n.x * n.x + n.y * n.y) / (n.z * n.z); }, 2000);
    CHECK(variance == doctest::Approx(slope * slope).epsilon(2e-3));
  }
}

TEST_CASE("the area of facets that is seen from a direction is that of the plane") {
  // Smith's condition: the projected area of facets that face a direction, less what is hidden, is the cosine
  for (const double slope : {0.1, 0.4, 0.8})
    for (const double angle : {0.0, 0.5, 1.0, 1.4}) {
      const detail::Microfacets rough{.slope = slope};
      const Vec3 to = at_angle(angle);
      const double facing =
          over_hemisphere([&](const Vec3& n) { return rough.density(n.z) * std::max(0.0, dot(n, to)); }, 1500);
      CHECK(facing / (1 + rough.hidden(to.z)) == doctest::Approx(to.z).epsilon(2e-3));
    }
}

TEST_CASE("facets scatter no more than they reflect, and the same both ways") {
  support::Generator any(3);
  for (const double slope : {0.1, 0.3, 0.7}) {
    const detail::Microfacets rough{.slope = slope, .index = 1.5};
    for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
      const Vec3 from = at_angle(degrees * 1_deg);
      const double all = over_hemisphere([&](const Vec3& to) { return rough.scattered(from, to, axis::up); });
      CHECK(all <= 1.001);
      if (slope < 0.2 && degrees <= 60) CHECK(all == doctest::Approx(rough.reflected(from.z)).epsilon(0.1));
      CHECK(all > 0.2 * rough.reflected(from.z));
    }
  }
  for (int k = 0; k < 1000; ++k) {
    CAPTURE(k);
    const detail::Microfacets rough{.slope = any.uniform(0.05, 1), .index = any.uniform(1.1, 3)};
    Vec3 a = any.unit(), b = any.unit();
    a.z = std::fabs(a.z);
    b.z = std::fabs(b.z);
    CHECK(rough.scattered(a, b, axis::up) * a.z ==
          doctest::Approx(rough.scattered(b, a, axis::up) * b.z).epsilon(1e-9));
  }
}

TEST_CASE("what returns to its source is the lobe's value there, up to what hides a facet both ways") {
  for (const double slope : {0.1, 0.4})
    for (const double angle : {0.0, 0.2, 0.6, 1.2}) {
      const detail::Microfacets rough{.slope = slope, .index = 1.33};
      const Vec3 to = at_angle(angle);
      const double hidden = rough.hidden(to.z),
                   once = pi * rough.scattered(to, to, axis::up) * (1 + 2 * hidden) / (1 + hidden);
      CHECK(rough.backscatter(to.z) == doctest::Approx(once).epsilon(1e-9));
    }
  CHECK(detail::Microfacets{}.backscatter(0) == 0);
  CHECK(detail::Microfacets{.slope = 0.1}.backscatter(1) == doctest::Approx(0.04 / (4 * 0.01)));  // F / (4 s^2)
}

TEST_CASE("rough facets add their glint to what is scattered under them") {
  const Material m{.reflectance = 0.4, .law = Microfacet{0.3}};
  for (const double angle : {0.0, 0.3, 0.9, 1.4}) {
    const double c = std::cos(angle), facets = detail::Microfacets{0.3, 1.5}.reflected(c);
    CHECK(m.backscatter(c, 1e-6) ==
          doctest::Approx(detail::Microfacets{0.3, 1.5}.backscatter(c) + (1 - facets) * 0.4 * c));
    CHECK(m.scattered_share(1e-6, c) == doctest::Approx(facets + (1 - facets) * 0.4));
    const Vec3 from{std::sin(angle), 0, c}, to{0, 0.6, 0.8};
    CHECK(m.scattered(from, to, axis::up, 1e-6) ==
          doctest::Approx(pi * detail::Microfacets{0.3, 1.5}.scattered(from, to, axis::up) + (1 - facets) * 0.4 * 0.8));
  }
  CHECK(Material{.reflectance = 0.4}.scattered({0, 0, 1}, {0, 0.6, 0.8}, axis::up, 1e-6) == doctest::Approx(0.32));
  CHECK(Material{.reflectance = 0.4}.scattered({0, 0, 1}, {0, 0.6, -0.8}, axis::up, 1e-6) == 0);
  CHECK(Material{.reflectance = 0.4}.scattered({0, 0, 1}, {0, 0.6, -0.8}, Vec3{}, 1e-6) == doctest::Approx(0.1));
  CHECK_THROWS_AS((Material{.law = Microfacet{0}}.validate()), SettingError);
}

TEST_CASE("rough facets keep the laws of scattering, but for light that facets hide") {
  CHECK(support::scattering_laws(Microfacet{0.3}, {.peaked = true, .loses = true, .one_way = true}) == "");
}
