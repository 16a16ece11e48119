// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/material/reflectance_map.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/material/retroreflector.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

using namespace pulsecast;

namespace {

const Vec2 left{0.25, 0.5}, right{0.75, 0.5};

/// Two pixels: the left one of these samples, the right one black.
Image two_pixels(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  return {2, 1, 3, std::vector<std::uint8_t>{red, green, blue, 0, 0, 0}};
}

}  // namespace

TEST_CASE("samples of a picture are linear shares of light by the curve of sRGB") {
  CHECK(detail::linear_share(0) == 0);
  CHECK(detail::linear_share(255) == 1);
  CHECK(detail::linear_share(10) == doctest::Approx(10.0 / 255 / 12.92));  // straight near black
  CHECK(detail::linear_share(188) == doctest::Approx(0.5).epsilon(0.01));  // middle grey
}

TEST_CASE("a map is linear between the wavelengths of its channels, and constant beyond") {
  const ReflectanceMap map(two_pixels(255, 188, 0));
  const double green = detail::linear_share(188);
  CHECK(map.reflectance(1064e-9, left, 0.9) == 1);
  CHECK(map.reflectance(612e-9, left, 0.9) == 1);
  CHECK(map.reflectance(549e-9, left, 0.9) == doctest::Approx(green));
  CHECK(map.reflectance((612e-9 + 549e-9) / 2, left, 0.9) == doctest::Approx((1 + green) / 2));
  CHECK(map.reflectance((549e-9 + 465e-9) / 2, left, 0.9) == doctest::Approx(green / 2));
  CHECK(map.reflectance(355e-9, left, 0.9) == 0);
  CHECK(map.reflectance(532e-9, right, 0.9) == 0);
  const ReflectanceMap grey({1, 1, 1, std::vector<std::uint8_t>{188}});
  for (const double wavelength : {355e-9, 532e-9, 1550e-9})
    CHECK(grey.reflectance(wavelength, left, 0.9) == doctest::Approx(green));
}

TEST_CASE("a pattern keeps the mean of the material's own reflectance") {
  const ReflectanceMap map = ReflectanceMap::pattern(two_pixels(188, 100, 50));
  for (const double wavelength : {450e-9, 500e-9, 532e-9, 1064e-9}) {
    CHECK(map.reflectance(wavelength, left, 0.3) == doctest::Approx(0.6));
    CHECK(map.reflectance(wavelength, right, 0.3) == 0);
    CHECK(map.reflectance(wavelength, left, 0.7) == 1);  // no more than all
  }
  CHECK_NOTHROW(ReflectanceMap::pattern(two_pixels(0, 0, 0)).validate());
}

TEST_CASE("maps out of range are refused") {
  const auto refused = [](auto change) {
    ReflectanceMap map(two_pixels(1, 2, 3));
    map.validate();
    change(map);
    CHECK_THROWS_AS(map.validate(), SettingError);
  };
  refused([](ReflectanceMap& m) { m.image.channels = 4; });
  refused([](ReflectanceMap& m) { m.wavelengths = {500e-9, 500e-9, 400e-9}; });
  refused([](ReflectanceMap& m) { m.wavelengths[0] = 0; });
  refused([](ReflectanceMap& m) { m.mean = {0.5, 0, 0.5}; });
  refused([](ReflectanceMap& m) { m.mean = {2, 1, 1}; });
}

TEST_CASE("hits of a mapped surface have the backscatter of their pixels, in a bundle and alone") {
  MeshData wall{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  wall.texture = {{{{0, 0}, {1, 0}, {1, 1}}}, {{{0, 0}, {1, 1}, {0, 1}}}};
  Material paint{.reflectance = 0.3, .law = Lambert{}};
  paint.reflectance_map = std::make_shared<const ReflectanceMap>(ReflectanceMap(two_pixels(188, 188, 188)));
  const Scene<TriangleMesh<>> scene(
      {{.geometry = std::make_shared<const TriangleMesh<>>(wall), .materials = material_table({paint})}});
  RayBundle rays;
  rays.origin = {0.5, 0.4, 10};
  rays.size = 2;
  rays.set_direction(0, normalize(Vec3{-0.02, 0, -1}));
  rays.set_direction(1, normalize(Vec3{0.02, 0, -1}));
  rays.pad();
  std::array<Hit, 2> hits;
  scene.closest(rays, hits);
  CHECK(hits[0].backscatter == doctest::Approx(detail::linear_share(188) * hits[0].cos_incidence));
  CHECK(hits[1].backscatter == 0);
  for (std::size_t j = 0; j < 2; ++j) {
    std::array<Hit, 1> alone;
    scene.closest(bundle_of(rays.ray(j)), alone);
    CHECK(alone[0].backscatter == hits[j].backscatter);
    const auto hit = scene.closest_hit(rays.ray(j));
    REQUIRE(hit);
    const SurfaceInteraction point = scene.surface(*hit, rays.ray(j));
    CHECK(point.material->reflectance_at(rays.wavelength, point.texture) ==
          doctest::Approx(j == 0 ? detail::linear_share(188) : 0));
  }
}

TEST_CASE("a map leaves to a retroreflector and a mirror their shares") {
  Material sign{.reflectance = 0.1, .law = Retroreflector<>{.coefficient = 100, .half_angle = 0.05}};
  sign.reflectance_map = std::make_shared<const ReflectanceMap>(ReflectanceMap(two_pixels(255, 255, 255)));
  sign.validate();
  CHECK(sign.reflectance_at(1e-6, left) == doctest::Approx(1 - sign.law.returned_share()));
  CHECK(sign.scattered_share(1e-6, 1, left) == doctest::Approx(1));
}
