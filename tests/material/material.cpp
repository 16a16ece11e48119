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
#include <pulsecast/material/phong.hpp>
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
  const Material m{.reflectance = 0.5, .law = Phong{0.3, 10}};
  CHECK(m.backscatter(1, nir) == support::relative(0.5, 1e-15));
  // 0.5 (0.7 cos 20 + 0.3 cos^10 40)
  CHECK(m.backscatter(std::cos(20_deg), nir) == support::relative(0.339330744918639, 1e-14));
  // from 45 degrees on, the lobe adds nothing: 0.5 * 0.7 cos 45, and cos 60
  CHECK(m.backscatter(std::cos(45_deg), nir) == support::relative(0.247487373415292, 1e-14));
  CHECK(m.backscatter(std::cos(60_deg), nir) == support::relative(0.175, 1e-14));
  CHECK(m.backscatter(0, nir) == 0);
}

TEST_CASE("rays of a bundle see the glossy lobes that single rays see, beside surfaces without, and beside nothing") {
  const Material glossy{.law = Phong{0.4, 30}}, matt{.reflectance = 0.3};
  const Material dull{.reflectance = 0.9, .law = Phong{0.7, 2.5}};
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
      const Phong* phong = material.law.get<Phong>();
      const double c = hits[j].cos_incidence, lobe = phong ? std::pow(std::fmax(2 * c * c - 1, 0), phong->exponent) : 0;
      const double share = phong ? phong->share : 0;
      REQUIRE(hits[j].backscatter == support::relative(material.reflectance * ((1 - share) * c + share * lobe), 1e-13));
      REQUIRE(hits[j].backscatter == material.backscatter(c, nir));
    }
  }
}

TEST_CASE("Phong's law without a glossy share is Lambert's") {
  const Material phong{.reflectance = 0.5, .law = Phong{0}}, lambert{.reflectance = 0.5};
  for (double cosine = 0; cosine <= 1; cosine += 0.05)
    CHECK(phong.backscatter(cosine, nir) == lambert.backscatter(cosine, nir));
}

TEST_CASE("a direction-independent surface sends back its reflectance from everywhere") {
  const Material m{.reflectance = 0.4, .law = DirectionIndependent{}};
  for (const double cosine : {0.0, 0.3, 1.0}) CHECK(m.backscatter(cosine, nir) == 0.4);
}

TEST_CASE("no surface sends back more than its reflectance") {
  for (const double share : {0.0, 0.3, 1.0})
    for (const double exponent : {0.0, 1.0, 10.0, 1000.0})
      for (const SurfaceLaw& law :
           {SurfaceLaw{}, SurfaceLaw{Phong{share, exponent}}, SurfaceLaw{DirectionIndependent{}}}) {
        const Material m{.reflectance = 0.8, .law = law};
        for (double cosine = 0; cosine <= 1; cosine += 0.01) {
          REQUIRE(m.backscatter(cosine, nir) >= 0);
          REQUIRE(m.backscatter(cosine, nir) <= 0.8);
        }
      }
}

TEST_CASE("a material with a spectrum answers for the wavelength of the light, by the same angular laws") {
  const auto spectrum = std::make_shared<const Spectrum>(std::vector<SpectralSample>{{0.5e-6, 0.1}, {1.5e-6, 0.7}});
  for (const SurfaceLaw& law : {SurfaceLaw{}, SurfaceLaw{Phong{0.3}}, SurfaceLaw{DirectionIndependent{}}})
    for (const double wavelength : {0.3e-6, 0.532e-6, 1.064e-6, 1.55e-6}) {
      const Material coloured{.reflectance = 0.9, .law = law, .spectrum = spectrum};
      const Material grey{.reflectance = spectrum->reflectance(wavelength), .law = law};
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
    CHECK_THROWS_AS(Material{.law = Phong{bad}}.validate(), SettingError);
  }
  for (const double bad : {-1.0, nan}) CHECK_THROWS_AS((Material{.law = Phong{0, bad}}.validate()), SettingError);
}
