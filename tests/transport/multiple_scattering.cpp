// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/any_target.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/survey.hpp>
#include <pulsecast/transport/direct_light.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/light.hpp"
#include "support/scattering_laws.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using support::from_to;
using support::power_of;
using support::rectangle;
using support::traced;

namespace {

using World = support::LightScene;

/// Scattering of so many orders by so many paths, all seen that is ahead.
LightPaths to_and_fro(std::size_t orders, std::size_t paths) {
  return {.spread_planes = false, .scattering = {.orders = orders, .paths = paths, .field_of_view = pi}};
}

}  // namespace

TEST_CASE(
    "in a sphere a flat aperture in the middle gets a quarter of each order, which is the wall's reflectance of the "
    "one before") {
  const double albedo = 0.8;
  const Scene<support::UnitBall> sphere({{.geometry = std::make_shared<const support::UnitBall>(),
                                          .materials = material_table({{.reflectance = albedo}}),
                                          .placement = {.scale = 7}}});
  constexpr double paths = 20'000;
  const auto seen = traced(to_and_fro(6, 20'000), sphere, from_to({0, 0, 0}, {1, 2, 3}), RingFootprint(2));
  const double first = power_of(seen.of(ReflectionKind::surface));
  for (const Reflection& r : seen.of(ReflectionKind::multiple)) {
    // from the middle to the wall and back, and chords between
    CHECK(r.range >= 7 - 1e-9);
    CHECK(r.cos_incidence == doctest::Approx(1));
  }
  // Each order lights the wall evenly. Of all directions, the mean of the cosine is 1/4 where it is positive, its
  // variance 1/6 - 1/16.
  double expected = 0, variance = 0;
  for (int k = 1; k < 6; ++k) {
    expected += 0.25 * std::pow(albedo, k);
    variance += std::pow(albedo, 2 * k) * (1.0 / 6 - 1.0 / 16) / paths;
  }
  CHECK(std::fabs(power_of(seen.of(ReflectionKind::multiple)) / first - expected) < 4 * std::sqrt(variance));
  CHECK(seen.result.energy.received <= seen.result.energy.scattered);
}

namespace {

/// Lambert's law; draws directions evenly over the hemisphere.
struct EvenlyDrawn : Lambert {
  SampledDirection sample(const Vec3&, const Vec3& normal, double u, double v) const noexcept {
    const Vec3 x = normalize(cross(normal, std::fabs(normal.z) < 0.9 ? axis::up : axis::right)), y = cross(normal, x);
    const double r = std::sqrt(1 - u * u);
    return {r * std::cos(2 * pi * v) * x + r * std::sin(2 * pi * v) * y + u * normal, 1 / (2 * pi)};
  }
};

/// Tells of light back to its source alone.
struct BackOnly {
  double backscatter(double cosine, double) const noexcept { return 0.5 * cosine; }
  double scattered_share(double, double) const noexcept { return 0.5; }
};

}  // namespace

TEST_CASE("directions that a law draws give the same light as those by the cosine") {
  CHECK(support::scattering_laws(EvenlyDrawn{}) == "");
  const auto ratio = [](const SurfaceLaw& law) {
    const Scene<support::UnitBall> sphere({{.geometry = std::make_shared<const support::UnitBall>(),
                                            .materials = material_table({{.reflectance = 0.8, .law = law}}),
                                            .placement = {.scale = 7}}});
    const auto seen = traced(to_and_fro(3, 20'000), sphere, from_to({0, 0, 0}, {1, 2, 3}), RingFootprint(2));
    return power_of(seen.of(ReflectionKind::multiple)) / power_of(seen.of(ReflectionKind::surface));
  };
  // A quarter of each order; drawn evenly, the weight 2 cos of a chord has the variance 1/3, more than that of the
  // cosines.
  CHECK(ratio(EvenlyDrawn{}) == doctest::Approx(0.25 * (0.8 + 0.64)).epsilon(0.03));
  CHECK(ratio(EvenlyDrawn{}) != ratio(Lambert{}));
}

TEST_CASE("a law without light between directions is refused by name when a survey is made, in any target") {
  const Scene<TriangleMesh<>> snow({rectangle({0, 5, 0}, {1, 0, 0}, {0, 0, 1}, {.name = "snow", .law = BackOnly{}})});
  const MovingScene<TriangleMesh<>> moving({snow.parts().begin(), snow.parts().end()}, {.to = 1});
  const AnyTarget<Scene<TriangleMesh<>>, MovingScene<TriangleMesh<>>> any{snow};
  const Scene<TriangleMesh<>> plain({rectangle({0, 6, 0}, {1, 0, 0}, {0, 0, 1}, {})});
  const Layered both{plain, snow};
  const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 1}}};
  const auto survey = [&](const auto& target, std::size_t orders) {
    const LightPaths light{.scattering = {.orders = orders}};
    return Survey{source, SingleRay{}, target, light, Receiver{}, FirstHit{}}.size();
  };
  const char* const problem =
      "MultipleScattering::orders above 1 need laws with scattered(in, out, normal, wavelength), which material 'snow' "
      "has not";
  CHECK_THROWS_WITH_AS(survey(snow, 2), problem, SettingError);
  CHECK_THROWS_WITH_AS(survey(moving, 2), problem, SettingError);
  CHECK_THROWS_WITH_AS(survey(any, 2), problem, SettingError);
  CHECK_THROWS_WITH_AS(survey(both, 2), problem, SettingError);
  CHECK(survey(plain, 2) == 1);
  CHECK(survey(snow, 1) == 1);
  CHECK(survey(both, 1) == 1);
}

TEST_CASE("a receiver sees by default 2 mrad, or what its beam lights") {
  const Scene<support::UnitBall> sphere({{.geometry = std::make_shared<const support::UnitBall>(),
                                          .materials = material_table({Material{}}),
                                          .placement = {.scale = 7}}});
  const LightPaths light{.spread_planes = false, .scattering = {.orders = 2, .paths = 20'000}};
  const auto pose = from_to({0, 0, 0}, {1, 2, 3});
  CHECK(traced(light, sphere, pose, SingleRay{}).of(ReflectionKind::multiple).size() < 3);  // 2.5e-7 of the sphere
  const double half = 0.2, share = 0.5 * (1 - std::cos(half));                              // of the sphere
  const auto wide = traced(light, sphere, pose, SingleRay{}, support::Lamp{.laser = {.divergence = 2 * half}});
  CHECK(std::fabs(static_cast<double>(wide.of(ReflectionKind::multiple).size()) - 20'000 * share) <
        4 * std::sqrt(20'000 * share));
}

TEST_CASE("the first order is that of direct light, bit for bit") {
  support::Generator any(2);
  MeshData mesh;
  for (int k = 0; k < 300; ++k) {
    const Vec3 at = Vec3{0, 20, 0} + any.point(4);
    support::add_triangle(mesh, {at, at + any.unit(), at + any.unit()});
  }
  const World scene({{.geometry = std::make_shared<const TriangleMesh<>>(mesh)}});
  std::size_t more = 0;
  for (int k = 0; k < 50; ++k) {
    const auto pose = from_to({0, 0, 0}, Vec3{0, 20, 0} + any.point(3));
    const support::Lamp lamp{.laser = {.divergence = 0.02}};
    const auto seen = traced(to_and_fro(4, 20), scene, pose, RingFootprint(5), lamp),
               direct = traced(DirectLight{.spread_planes = false}, scene, pose, RingFootprint(5), lamp);
    const auto first = seen.of(ReflectionKind::surface);
    REQUIRE(first.size() == direct.reflections.size());
    for (std::size_t j = 0; j < first.size(); ++j) {
      CHECK(first[j].range == direct.reflections[j].range);
      CHECK(first[j].power == direct.reflections[j].power);
    }
    more += seen.of(ReflectionKind::multiple).size();
  }
  CHECK(more > 100);
}

TEST_CASE("what a receiver of a narrow view does not see is left out") {
  const World corner({rectangle({0, 10, 0}, 30.0 * axis::right, 30.0 * axis::up, Material{}),
                      rectangle({5, 10, 0}, 30.0 * axis::forward, 30.0 * axis::up, Material{})});
  LightPaths light = to_and_fro(2, 2000);
  const auto all = traced(light, corner, from_to({0, 0, 0}, {0, 10, 0}), SingleRay{});
  light.scattering.field_of_view = 0.2;
  const auto some = traced(light, corner, from_to({0, 0, 0}, {0, 10, 0}), SingleRay{});
  light.scattering.field_of_view = 1.2;
  const auto most = traced(light, corner, from_to({0, 0, 0}, {0, 10, 0}), SingleRay{});
  CHECK(some.of(ReflectionKind::multiple).empty());
  CHECK(most.of(ReflectionKind::multiple).size() > 10);
  CHECK(most.of(ReflectionKind::multiple).size() < all.of(ReflectionKind::multiple).size());
}

TEST_CASE("light that is scattered to and fro keeps the laws of transports") {
  support::Generator any(9);
  std::vector<World::Part> parts;
  for (int k = 0; k < 20; ++k)
    parts.push_back(
        rectangle(any.point(15), 6.0 * any.unit(), 6.0 * any.unit(), Material{.reflectance = any.uniform()}));
  std::vector<Pose<frame::Beam, frame::World>> poses;
  for (int k = 0; k < 60; ++k) poses.push_back({any.rotation(), any.point(10)});
  const World scene(std::move(parts));
  CHECK(support::transport_laws(to_and_fro(3, 5), scene, poses) == "");
  CHECK(support::transport_laws(to_and_fro(3, 100), scene, poses, {.range_min = 2, .range_max = 20}) == "");
  CHECK_THROWS_AS(to_and_fro(0, 1).validate(), SettingError);
  CHECK_THROWS_AS(to_and_fro(2, 0).validate(), SettingError);
}
