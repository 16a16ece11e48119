// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/surface_law.hpp>

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/material/material.hpp>
#include <pulsecast/material/normalized_phong.hpp>
#include <pulsecast/material/retroreflector.hpp>
#include <pulsecast/material/tabulated.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

constexpr double nir = 1.064e-6;

/// User-defined law that takes the wavelength alone.
struct Snow {
  double albedo = 0.9;
  double backscatter(double cosine, double wavelength) const noexcept { return albedo * cosine * wavelength / nir; }
  double scattered_share(double, double) const noexcept { return albedo; }
};

}  // namespace

TEST_CASE("a user-defined law is called as it is, whatever the reflectance of its material") {
  const Material m{.reflectance = 0.1, .law = Snow{}};
  CHECK(m.backscatter(0.5, nir) == 0.45);
  CHECK(m.backscatter(0.5, 2 * nir) == 0.9);
  CHECK(m.scattered_share(nir, 0.5) == 0.9);
  REQUIRE(m.law.get<Snow>());
  CHECK(m.law.get<Snow>()->albedo == 0.9);
  CHECK_FALSE(m.law.get<Lambert>());
  CHECK_FALSE(m.law.model()->scatters_between);
}

TEST_CASE("the linear laws have no model, and are told apart") {
  CHECK_FALSE(SurfaceLaw{}.model());
  CHECK(SurfaceLaw{}.get<Lambert>());
  CHECK_FALSE(SurfaceLaw{}.get<DirectionIndependent>());
  CHECK(SurfaceLaw{DirectionIndependent{}}.get<DirectionIndependent>());
  CHECK_FALSE(SurfaceLaw{DirectionIndependent{}}.get<Lambert>());
}

TEST_CASE("a run of hits has the backscatter and share of one by one, by every law") {
  const Material laws[]{{.law = NormalizedPhong{0.4, 12.5}},
                        {.law = Retroreflector<>{200}},
                        {.law = Snow{}},
                        {.law = Tabulated{SharedArray<BackscatterAtIncidence>({{0.0, 3.0}, {0.3, 1.0}, {1.2, 0.5}})}}};
  for (const Material& m : laws) {
    for (std::size_t count = 1; count < 2 * simd::lane_count + 3; ++count) {
      std::vector<Hit> hits(count);
      for (std::size_t j = 0; j < count; ++j) hits[j].cos_incidence = 1 - 0.07 * static_cast<double>(j);
      m.law.model()->scatter_at(hits, m.light(nir));
      for (const Hit& hit : hits) {
        CHECK(hit.backscatter == m.backscatter(hit.cos_incidence, nir));
        CHECK(hit.scattered_share == m.scattered_share(nir, hit.cos_incidence));
      }
    }
  }
}

TEST_CASE("a law that breaks its laws is refused when a material is made") {
  struct Wrong {
    double back, share;
    double backscatter(double, double) const noexcept { return back; }
    double scattered_share(double, double) const noexcept { return share; }
  };
  const double nan = std::nan("");
  CHECK_NOTHROW(Material{.law = Wrong{0.5, 1}}.validate());
  CHECK_THROWS_WITH_AS((Material{.law = Wrong{0.5, 1.7}}.validate()),
                       doctest::Contains("Material::law (scattered_share) is 1.7"), SettingError);
  CHECK_THROWS_AS((Material{.law = Wrong{0.5, nan}}.validate()), SettingError);
  CHECK_THROWS_AS((Material{.law = Wrong{-1, 0.5}}.validate()), SettingError);
  CHECK_THROWS_AS((Material{.law = Wrong{nan, 0.5}}.validate()), SettingError);
}
