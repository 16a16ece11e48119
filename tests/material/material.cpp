// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/material.hpp>

#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/accel/linear.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {
constexpr double nir = 1.064e-6;
}

TEST_CASE("a Lambertian surface sends back its reflectance times the cosine of the incidence") {
  const Material m{.reflectance = 0.4};
  CHECK(m.backscatter(1, nir) == 0.4);
  CHECK(m.backscatter(0.5, nir) == support::relative(0.2, 1e-15));
  CHECK(m.backscatter(0, nir) == 0);
}

TEST_CASE(
    "a surface by Phong's law has a glossy lobe about the mirror direction, which ends at 45 degrees of incidence") {
  const Material m{.reflectance = 0.5, .scattering = Scattering::phong, .specular_share = 0.3, .specular_exponent = 10};
  CHECK(m.backscatter(1, nir) == support::relative(0.5, 1e-15));
  // 0.5 (0.7 cos 20 + 0.3 cos^10 40)
  CHECK(m.backscatter(std::cos(20_deg), nir) == support::relative(0.339330744918639, 1e-14));
  // from 45 degrees on, the lobe adds nothing: 0.5 * 0.7 cos 45, and cos 60
  CHECK(m.backscatter(std::cos(45_deg), nir) == support::relative(0.247487373415292, 1e-14));
  CHECK(m.backscatter(std::cos(60_deg), nir) == support::relative(0.175, 1e-14));
  CHECK(m.backscatter(0, nir) == 0);
}

TEST_CASE("rays of a bundle see the glossy lobes that single rays see, beside surfaces without, and beside nothing") {
  const Material glossy{.scattering = Scattering::phong, .specular_share = 0.4, .specular_exponent = 30},
      matt{.reflectance = 0.3};
  const Material dull{
      .reflectance = 0.9, .scattering = Scattering::phong, .specular_share = 0.7, .specular_exponent = 2.5};
  const auto strip = [](double x, const Material& material) {
    return Part<TriangleMesh<Linear<>>>{
        .geometry = std::make_shared<const TriangleMesh<Linear<>>>(MeshData{
            .vertices = {{x, -9, 0}, {x + 1, -9, 0}, {x + 1, 9, 0}, {x, 9, 0}}, .triangles = {{0, 1, 2}, {0, 2, 3}}}),
        .materials = material_table({material})};
  };
  const Scene<TriangleMesh<Linear<>>> scene({strip(0, glossy), strip(1, matt), strip(2, dull), strip(4, glossy)});
  for (std::size_t size = 2; size <= RayBundle::capacity; ++size) {
    RayBundle rays;
    rays.origin = {2.5, 0, 2};
    rays.size = size;
    for (std::size_t j = 0; j < size; ++j) {
      const double aside = -2.49 + 4.98 * static_cast<double>(j) / static_cast<double>(size - 1),
                   length = std::hypot(aside, 2);
      rays.set_direction(j, {aside / length, 0, -2 / length});
    }
    rays.pad();
    std::vector<Hit> hits(size);
    scene.closest(rays, hits);
    for (std::size_t j = 0; j < size; ++j) {
      CAPTURE(size);
      CAPTURE(j);
      const double x = 2.5 + 2 * rays.x[j] / -rays.z[j];
      if (x > 3 && x < 4) {
        REQUIRE(!hits[j].met());
        continue;
      }
      const Material& material = x < 1 || x > 4 ? glossy : x < 2 ? matt : dull;
      const double c = hits[j].cos_incidence, lobe = std::pow(std::fmax(2 * c * c - 1, 0), material.specular_exponent);
      const double share = material.scattering == Scattering::phong ? material.specular_share : 0;
      REQUIRE(hits[j].backscatter == support::relative(material.reflectance * ((1 - share) * c + share * lobe), 1e-13));
      REQUIRE(hits[j].backscatter == material.backscatter(c, nir));
    }
  }
}

TEST_CASE("Phong's law without a glossy share is Lambert's") {
  const Material phong{.reflectance = 0.5, .scattering = Scattering::phong, .specular_share = 0},
      lambert{.reflectance = 0.5};
  for (double cosine = 0; cosine <= 1; cosine += 0.05)
    CHECK(phong.backscatter(cosine, nir) == lambert.backscatter(cosine, nir));
}

TEST_CASE("a direction-independent surface sends back its reflectance from everywhere") {
  const Material m{.reflectance = 0.4, .scattering = Scattering::direction_independent};
  for (const double cosine : {0.0, 0.3, 1.0}) CHECK(m.backscatter(cosine, nir) == 0.4);
}

TEST_CASE("no surface sends back more than its reflectance") {
  for (const Scattering law : {Scattering::lambert, Scattering::phong, Scattering::direction_independent})
    for (const double share : {0.0, 0.3, 1.0})
      for (const double exponent : {0.0, 1.0, 10.0, 1000.0}) {
        const Material m{.reflectance = 0.8, .scattering = law, .specular_share = share, .specular_exponent = exponent};
        for (double cosine = 0; cosine <= 1; cosine += 0.01) {
          REQUIRE(m.backscatter(cosine, nir) >= 0);
          REQUIRE(m.backscatter(cosine, nir) <= 0.8);
        }
      }
}

TEST_CASE("a material with a spectrum answers for the wavelength of the light, by the same angular laws") {
  const auto spectrum = std::make_shared<const Spectrum>(std::vector<SpectralSample>{{0.5e-6, 0.1}, {1.5e-6, 0.7}});
  for (const Scattering law : {Scattering::lambert, Scattering::phong, Scattering::direction_independent})
    for (const double wavelength : {0.3e-6, 0.532e-6, 1.064e-6, 1.55e-6}) {
      const Material coloured{.reflectance = 0.9, .scattering = law, .specular_share = 0.3, .spectrum = spectrum};
      const Material grey{.reflectance = spectrum->reflectance(wavelength), .scattering = law, .specular_share = 0.3};
      CHECK(coloured.reflectance_at(wavelength) == grey.reflectance);
      for (const double cosine : {0.0, 0.3, 0.9, 1.0})
        CHECK(coloured.backscatter(cosine, wavelength) == grey.backscatter(cosine, nir));
    }
}

TEST_CASE("a material refuses what no surface can do") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(Material{}.validate());
  for (const double bad : {-0.1, 1.1, nan}) {
    CHECK_THROWS_AS(Material{.reflectance = bad}.validate(), SettingError);
    CHECK_THROWS_AS(Material{.specular_share = bad}.validate(), SettingError);
  }
  for (const double bad : {-1.0, nan}) CHECK_THROWS_AS(Material{.specular_exponent = bad}.validate(), SettingError);
}

TEST_CASE("the lobe of normalized Phong holds its share of the energy, by quadrature over the hemisphere") {
  for (const double exponent : {0.0, 1.0, 7.5, 30.0, 100.0})
    for (const double share : {0.2, 1.0}) {
      const Material m{.reflectance = 0.6,
                       .scattering = Scattering::normalized_phong,
                       .specular_share = share,
                       .specular_exponent = exponent};
      // Source: Lafortune & Willems 1994: reflectance ((1 - share) / pi + share (n + 2) / 2 pi cos^n of the angle to
      // the mirror direction)
      const auto brdf = [&](double cos_to_mirror) {
        return 0.6 *
               ((1 - share) / pi + share * (exponent + 2) / (2 * pi) * std::pow(std::fmax(cos_to_mirror, 0), exponent));
      };
      for (const double incidence : {0.0, 0.3, 0.6}) {
        CHECK(m.backscatter(std::cos(incidence), nir) ==
              support::relative(pi * brdf(std::cos(2 * incidence)) * std::cos(incidence), 1e-13));
        double energy = 0;
        constexpr int n = 400;
        for (int i = 0; i < n; ++i)
          for (int k = 0; k < n; ++k) {
            const double zenith = pi / 2 * (i + 0.5) / n, azimuth = 2 * pi * (k + 0.5) / n;
            const double to_mirror =
                std::sin(zenith) * std::cos(azimuth) * std::sin(incidence) + std::cos(zenith) * std::cos(incidence);
            energy += brdf(to_mirror) * std::cos(zenith) * std::sin(zenith) * (pi / 2 / n) * (2 * pi / n);
          }
        INFO("exponent ", exponent, ", incidence ", incidence);
        CHECK(energy < 0.6 * (1 + 1e-4));
        if (incidence == 0) CHECK(energy == support::relative(0.6, 1e-4));
      }
    }
}

TEST_CASE("a retroreflector has its coefficient at normal incidence, and half of its light at its half angle") {
  Material m{.reflectance = 0.1,
             .scattering = Scattering::retroreflective,
             .retroreflection = 70,
             .retroreflection_half_angle = 30_deg};
  CHECK(m.backscatter(1, nir) == support::relative(0.1 + 70 * pi, 1e-13));
  CHECK(m.backscatter(std::cos(30_deg), nir) == support::relative(0.1 * std::cos(30_deg) + 35 * pi, 1e-13));
  CHECK(m.backscatter(0, nir) == 0);
  m.retroreflection = 1 / pi;  // as a white surface
  m.retroreflection_half_angle = 60_deg;
  m.reflectance = 0;
  CHECK(m.backscatter(std::cos(40_deg), nir) == support::relative(std::cos(40_deg), 1e-13));
}

TEST_CASE("measured backscatter is linear in the angle between the rows, and constant beyond") {
  const Material m{
      .reflectance = 0.5,
      .scattering = Scattering::tabulated,
      .backscatter_table = SharedArray<BackscatterAtIncidence>({{10_deg, 3.0}, {20_deg, 1.0}, {60_deg, 0.5}})};
  CHECK(m.backscatter(1, nir) == support::relative(1.5, 1e-13));
  CHECK(m.backscatter(std::cos(15_deg), nir) == support::relative(1, 1e-13));
  CHECK(m.backscatter(std::cos(40_deg), nir) == support::relative(0.375, 1e-13));
  CHECK(m.backscatter(0, nir) == support::relative(0.25, 1e-13));
}

TEST_CASE("a table without rows, which validation refuses, is black") {
  CHECK(Material{.scattering = Scattering::tabulated}.backscatter(0.7, nir) == 0);
  CHECK(Material{.scattering = static_cast<Scattering>(200)}.backscatter(0.7, nir) == 0);  // as from a forged file
}

TEST_CASE("lanes have the backscatter of one, by every law") {
  const Material laws[]{
      {.scattering = Scattering::normalized_phong, .specular_share = 0.4, .specular_exponent = 12.5},
      {.scattering = Scattering::retroreflective, .retroreflection = 200},
      {.scattering = Scattering::tabulated,
       .backscatter_table = SharedArray<BackscatterAtIncidence>({{0.0, 3.0}, {0.3, 1.0}, {1.2, 0.5}})}};
  for (const Material& m : laws) {
    const Backscatter law = m.backscatter(nir);
    for (double cosine = 0; cosine < 0.9; cosine += 0.01) {
      const simd::Doubles cosines =
          simd::generate([&](std::size_t lane) { return cosine + 0.02 * static_cast<double>(lane); });
      const simd::Doubles all = law.glossy(cosines);
      for (std::size_t lane = 0; lane < simd::lane_count; ++lane) CHECK(all[lane] == law(cosines[lane]));
    }
  }
}

TEST_CASE("cube corners return light by their open area, up to an angle, and prisms up to that inside") {
  Material m{.reflectance = 0,
             .scattering = Scattering::retroreflective,
             .retroreflection = 1 / pi,
             .retroreflector = RetroreflectorKind::cube_corner};
  CHECK(m.backscatter(1, 1e-6) == doctest::Approx(1));
  CHECK(m.backscatter(std::cos(35.2_deg), 1e-6) > 0);
  CHECK(m.backscatter(std::cos(35.3_deg), 1e-6) == 0);
  double before = 1;
  for (int degrees = 1; degrees < 36; ++degrees) {
    const double now = m.backscatter(std::cos(degrees * 1_deg), 1e-6);
    CHECK(now < before);
    before = now;
  }
  // Source: lens of two equal circles, shifted by sqrt(2) tan(a) of their radius; in projection
  const double a = 20_deg, t = std::sqrt(2.0) * std::tan(a);
  CHECK(m.backscatter(std::cos(a), 1e-6) ==
        doctest::Approx(std::cos(a) * 2 / pi * (std::acos(t) - t * std::sqrt(1 - t * t))).epsilon(1e-12));
  m.retroreflector = RetroreflectorKind::prisms;
  m.retroreflection_index = 1.455;
  const double limit = std::asin(1.455 * std::sin(std::atan(std::sqrt(0.5))));
  CHECK(m.backscatter(std::cos(limit - 0.001), 1e-6) > 0);
  CHECK(m.backscatter(std::cos(limit + 0.001), 1e-6) == 0);
  CHECK(degrees(limit) == doctest::Approx(57.1).epsilon(0.01));
  m.retroreflection = 300;
  m.retroreflection_width = 0.03;
  CHECK(m.retroreflected_share() == doctest::Approx(300 * pi * 0.03 * 0.03 / 2));
  CHECK_NOTHROW(m.validate());
  m.retroreflection_width = 0.06;  // more light than there is
  CHECK_THROWS_AS(m.validate(), SettingError);
}

TEST_CASE("rough facets add their glint to what is scattered under them") {
  const Material m{.reflectance = 0.4, .scattering = Scattering::microfacet, .roughness = 0.3};
  for (const double angle : {0.0, 0.3, 0.9, 1.4}) {
    const double c = std::cos(angle), facets = m.facets().reflected(c);
    CHECK(m.backscatter(c, 1e-6) == doctest::Approx(m.facets().backscatter(c) + (1 - facets) * 0.4 * c));
    CHECK(m.scattered_share(1e-6, c) == doctest::Approx(facets + (1 - facets) * 0.4));
    const Vec3 from{std::sin(angle), 0, c}, to{0, 0.6, 0.8};
    CHECK(m.scattered(from, to, axis::up, 1e-6) ==
          doctest::Approx(pi * m.facets().scattered(from, to, axis::up) + (1 - facets) * 0.4 * 0.8));
  }
  CHECK(Material{.reflectance = 0.4}.scattered({0, 0, 1}, {0, 0.6, 0.8}, axis::up, 1e-6) == doctest::Approx(0.32));
  CHECK(Material{.reflectance = 0.4}.scattered({0, 0, 1}, {0, 0.6, -0.8}, axis::up, 1e-6) == 0);
  CHECK(Material{.reflectance = 0.4}.scattered({0, 0, 1}, {0, 0.6, -0.8}, Vec3{}, 1e-6) == doctest::Approx(0.1));
  CHECK_THROWS_AS(Material{.roughness = 0}.validate(), SettingError);
}

TEST_CASE("retroreflectors and tables that cannot be are refused") {
  CHECK_THROWS_AS(Material{.retroreflection = -1}.validate(), SettingError);
  CHECK_THROWS_AS(Material{.retroreflection_half_angle = 0}.validate(), SettingError);
  CHECK_THROWS_AS(Material{.scattering = Scattering::tabulated}.validate(), SettingError);
  const auto table = [](std::vector<BackscatterAtIncidence> rows) {
    return Material{.scattering = Scattering::tabulated,
                    .backscatter_table = SharedArray<BackscatterAtIncidence>(std::move(rows))};
  };
  CHECK_NOTHROW(table({{0.1, 1}}).validate());
  CHECK_THROWS_AS(table({{0.2, 1}, {0.1, 1}}).validate(), SettingError);
  CHECK_THROWS_AS(table({{0.2, -1}}).validate(), SettingError);
  CHECK_THROWS_AS(table({{2, 1}}).validate(), SettingError);
}
