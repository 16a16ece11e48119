// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/scattering_law.hpp>

#include <doctest/doctest.h>

#include <pulsecast/material/lambert.hpp>
#include <pulsecast/material/phong.hpp>

using namespace pulsecast;

namespace {

struct Least {
  double backscatter(double cosine, double) const noexcept { return cosine; }
  double scattered_share(double, double) const noexcept { return 1; }
};
struct Between : Least {
  using refinements = refines<tag::ScattersBetween>;
  double scattered(const Vec3&, const Vec3& out, const Vec3& normal, double) const noexcept { return dot(out, normal); }
};
struct Throwing : Least {
  double scattered_share(double, double) const { return 1; }
};

static_assert(ScatteringLaw<Least> && ScatteringLaw<Lambert> && !ScatteringLaw<Throwing> && !ScatteringLaw<int>);
static_assert(!detail::TakesSurfaceLight<Least> && detail::TakesSurfaceLight<Lambert>);
static_assert(!ScattersBetween<Least> && ScattersBetween<Between> && detail::members_checked<Between>);
static_assert(ScattersInLanes<Phong> && !ScattersInLanes<Lambert> && !ScattersInLanes<Least>);
static_assert(!SamplesDirections<Between> && !Retroreflects<Between> && !ReflectsInterface<Between>);

}  // namespace

TEST_CASE("a law is told the light of the surface, or its wavelength alone") {
  const SurfaceLight light{1e-6, 0.3, 1.33};
  CHECK(&detail::taken_by<Lambert>(light) == &light);
  CHECK(detail::taken_by<Least>(light) == 1e-6);
  CHECK(SurfaceLight{1e-6}.reflectance == 1);
}
