// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/transport/light_paths.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/material/retroreflector.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/motion.hpp>
#include <pulsecast/survey.hpp>
#include <pulsecast/transport/direct_light.hpp>

#include "support/archetypes.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/light.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using support::clean;
using support::from_to;
using support::rectangle;
using support::traced;

namespace {

using World = support::LightScene;
using Mesh = TriangleMesh<>;
constexpr double infinity = std::numeric_limits<double>::infinity();

static_assert(Transport<LightPaths, World> && TracesVelocity<LightPaths, World>);
static_assert(SceneQueries<World> && SceneQueries<MovingScene<Mesh>> && !SceneQueries<support::LeastRayTarget>);
static_assert(!Transport<LightPaths, support::LeastRayTarget>);  // a map that tells no materials

Vec3 any_across(support::Generator& any, const Vec3& d) { return normalize(cross(d, any.unit())); }

/// Leaves in a ball.
MeshData leaves(support::Generator& any, const Vec3& centre, double radius, double size, std::size_t count) {
  MeshData mesh;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 at = centre + radius * std::cbrt(any.uniform()) * any.unit();
    support::add_triangle(mesh, {at, at + size * any.unit(), at + size * any.unit()});
  }
  return mesh;
}

MeshData mirrored_at(MeshData mesh, const Vec3& point, const Vec3& normal) {
  for (Vec3& v : mesh.vertices) v -= 2 * dot(v - point, normal) * normal;
  return mesh;
}

World::Part part(const MeshData& mesh, double reflectance, ObjectId object = 0) {
  return {.geometry = std::make_shared<const Mesh>(mesh),
          .materials = material_table({{.reflectance = reflectance}}),
          .object = object};
}

}  // namespace

TEST_CASE("a scene without smooth surfaces gives the reflections of direct light, bit for bit") {
  support::Generator any(1);
  const World scene({part(leaves(any, {0, 20, 0}, 3, 0.5, 400), 0.4), part(leaves(any, {0, 25, 0}, 9, 4, 100), 1)});
  for (int k = 0; k < 200; ++k) {
    CAPTURE(k);
    const auto pose = from_to({0, 0, 0}, Vec3{0, 20, 0} + any.point(4));
    support::Lamp lamp{.laser = {.divergence = 0.02}};
    lamp.index = static_cast<PulseIndex>(k);
    const auto same = [&](const auto& footprint) {
      const auto direct = traced(DirectLight{}, scene, pose, footprint, lamp),
                 paths = traced(LightPaths{}, scene, pose, footprint, lamp);
      REQUIRE(direct.reflections.size() == paths.reflections.size());
      for (std::size_t j = 0; j < direct.reflections.size(); ++j) {
        CHECK(direct.reflections[j].range == paths.reflections[j].range);
        CHECK(direct.reflections[j].power == paths.reflections[j].power);
        CHECK(direct.reflections[j].cos_incidence == paths.reflections[j].cos_incidence);
        CHECK(paths.reflections[j].kind == ReflectionKind::surface);
      }
      CHECK(direct.result.fate == paths.result.fate);
      CHECK(std::fabs(direct.result.energy.missed - paths.result.energy.missed) < 1e-9 * paths.result.energy.sent);
      CHECK(std::fabs(paths.imbalance()) < 1e-9);
    };
    same(SingleRay{});
    same(LatticeFootprint(19));
    same(RingFootprint(9));
  }
}

TEST_CASE("a mirror shows what stands before it at the mirrored place, with the mirror's share twice") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Vec3 normal = any.unit(), at = normal * -any.uniform(20, 60), side = any_across(any, normal);
    const Vec3 centre = any.uniform(5, 40) * normal + any.uniform(15, 40) * side;
    const MeshData before = leaves(any, centre, 10, 2, 200);
    const double reflectance = any.uniform(0.3, 1);
    const World real(
        {rectangle(at, 100.0 * side, 100.0 * cross(normal, side), clean(SmoothInterface::mirror(reflectance))),
         part(before, 0.5, 3)});
    const World image({part(mirrored_at(before, at, normal), 0.5, 3)}), objects({part(before, 0.5, 3)});
    std::size_t ghosts = 0;
    for (int k = 0; k < 50; ++k) {
      CAPTURE(k);
      const auto pose = from_to({0, 0, 0}, centre - 2 * dot(centre - at, normal) * normal + any.point(10));
      const support::Lamp lamp{.laser = {.divergence = 5e-3}};
      const LatticeFootprint footprint(19);
      if (!traced(LightPaths{}, objects, pose, footprint, lamp).reflections.empty()) continue;  // hides the mirror
      const LightPaths light{.spread_planes = false};
      auto seen = traced(light, real, pose, footprint, lamp), expected = traced(light, image, pose, footprint, lamp);
      CHECK(std::fabs(seen.imbalance()) < 1e-9);
      REQUIRE(seen.reflections.size() == expected.reflections.size());
      for (std::size_t j = 0; j < seen.reflections.size(); ++j) {
        const Reflection &ghost = seen.reflections[j], &there = expected.reflections[j];
        CHECK(ghost.kind == ReflectionKind::mirror);
        CHECK(ghost.object == 3);
        CHECK(std::fabs(ghost.range - there.range) < 1e-9);
        CHECK(std::fabs(ghost.power / there.power - reflectance * reflectance) < 1e-9);
        CHECK(std::fabs(ghost.cos_incidence - there.cos_incidence) < 1e-9);
        ++ghosts;
      }
    }
    CHECK(ghosts > 0);
  }
}

TEST_CASE("subrays that are passed on together return what each does alone, also past what stands close to the glass") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<World::Part> parts;
    for (ObjectId k = 0; k < 4; ++k) {
      const Vec3 normal = any.unit(), side = any_across(any, normal), centre = any.point(12) + Vec3{0, 25, 0};
      const SmoothInterface smooth = k % 2 == 0 ? SmoothInterface::mirror(0.8) : SmoothInterface::pane(0.03);
      parts.push_back(rectangle(centre, 15.0 * side, 15.0 * cross(normal, side),
                                Material{.reflectance = k == 1 ? 0.1 : 0.0, .smooth = smooth}, k));
      for (const double side_of : {-1.0, 1.0})  // leaves on the glass
        parts.push_back(part(leaves(any, centre + side_of * 0.5 * normal, 6, 0.5, 100), 0.3, 10 + k));
    }
    const World scene(std::move(parts));
    const RingFootprint footprint(4);
    const support::Lamp lamp{.laser = {.divergence = 0.02}};
    const SubrayDirections beam(footprint, Emitter{.laser = lamp.laser});
    for (int k = 0; k < 20; ++k) {
      CAPTURE(k);
      const auto pose = from_to(any.point(1), Vec3{0, 25, 0} + any.point(10));
      const LightPaths light{.passages = 4, .spread_planes = false};
      auto together = traced(light, scene, pose, footprint, lamp);
      CHECK(std::fabs(together.imbalance()) < 1e-9);
      CHECK(together.result.energy.received <= together.result.energy.scattered);
      std::vector<Reflection> alone;
      for (std::size_t j = 0; j < footprint.size(); ++j) {
        const Vec3 direction = matrix_of(pose.rotation) * Vec3{beam.x[j], beam.y[j], beam.z[j]};
        auto one = traced(light, scene, from_to(pose.position, pose.position + direction), SingleRay{},
                          {.laser = {.divergence = 0}, .receiver = lamp.receiver});
        for (Reflection& r : one.reflections) {
          r.power *= beam.shares[j];
          alone.push_back(r);
        }
      }
      REQUIRE(together.reflections.size() == alone.size());
      const auto nearer = [](const Reflection& a, const Reflection& b) { return a.range < b.range; };
      std::sort(together.reflections.begin(), together.reflections.end(), nearer);
      std::sort(alone.begin(), alone.end(), nearer);
      for (std::size_t j = 0; j < alone.size(); ++j) {
        CHECK(std::fabs(together.reflections[j].range - alone[j].range) < 1e-6);
        CHECK(together.reflections[j].power == doctest::Approx(alone[j].power).epsilon(1e-5));
      }
    }
  }
}

TEST_CASE("a wall behind a pane is seen through it: later by the group index, shifted, and dimmer") {
  const double d = 0.03;
  const SmoothInterface pane = SmoothInterface::pane(d);
  const Material wall{.reflectance = 0.8};
  for (int degrees = 0; degrees < 85; degrees += 5) {
    CAPTURE(degrees);
    const double a = degrees * 1_deg, b = std::asin(std::sin(a) / pane.inside.index);
    // the pane is turned about the vertical by a, and the wall slants to the left, so that a shift to the side changes
    // the range
    const Vec3 normal{std::sin(a), -std::cos(a), 0}, slant = normalize(Vec3{0.6, -1, 0});
    const World scene({rectangle({0, 10, 0}, 3.0 * cross(normal, axis::up), 3.0 * axis::up, clean(pane)),
                       rectangle({0, 30, 0}, 20.0 * cross(slant, axis::up), 20.0 * axis::up, wall, 5)});
    const auto seen = traced(LightPaths{}, scene, from_to({0, 0, 0}, axis::forward), SingleRay{});
    const auto through = seen.of(ReflectionKind::glass);
    REQUIRE(through.size() == 1);
    const Vec3 inside = normalize(std::cos(b) * -normal +
                                  std::sin(b) * normalize(axis::forward - std::cos(a) * -normal + Vec3{1e-300, 0, 0}));
    const Vec3 exit = Vec3{0, 10, 0} + d / std::cos(b) * (degrees > 0 ? inside : axis::forward);
    const double behind = dot(Vec3{0, 30, 0} - exit, slant) / dot(axis::forward, slant);
    CHECK(std::fabs(exit.x) == doctest::Approx(d * std::sin(a - b) / std::cos(b)));
    CHECK(std::fabs(through[0].range - (10 + pane.inside.group_index * d / std::cos(b) + behind)) < 1e-9);
    const PaneSplit split = pane_split(std::cos(a), pane);
    const auto open =
        traced(LightPaths{},
               World({rectangle(exit + behind * axis::forward, 20.0 * cross(slant, axis::up), 20.0 * axis::up, wall)}),
               from_to({0, 0, 0}, axis::forward), SingleRay{});
    CHECK(through[0].power / open.reflections[0].power ==
          doctest::Approx(split.transmitted * split.transmitted).epsilon(0.01));
    CHECK(std::fabs(seen.imbalance()) < 1e-9);
  }
}

TEST_CASE("a block of glass does what a pane of its thickness does") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double d = any.uniform(0.005, 0.05), a = any.uniform(0, 1.2);
    const Vec3 normal{std::sin(a), -std::cos(a), 0}, right = 50.0 * cross(normal, axis::up), up = 50.0 * axis::up;
    const SmoothInterface glass = SmoothInterface::glass(), pane = SmoothInterface::pane(d);
    const Material wall{.reflectance = 0.8}, body = clean(glass);
    const auto far_wall =
        rectangle({0, 40, 0}, 30.0 * normalize(Vec3{1, any.uniform(-1, 1), 0}), 30.0 * axis::up, wall, 5);
    World::Part front = rectangle({0, 10, 0}, right, up, body),
                back = rectangle(Vec3{0, 10, 0} - d * normal, right, up, body);
    back.materials = front.materials;
    const auto pose = from_to(any.point(1), {0, 10, 0});
    const auto thick = traced(LightPaths{}, World({front, back, far_wall}), pose, SingleRay{});
    const auto thin =
        traced(LightPaths{}, World({rectangle({0, 10, 0}, right, up, clean(pane)), far_wall}), pose, SingleRay{});
    CHECK(std::fabs(thick.imbalance()) < 1e-9);
    const auto through = thick.of(ReflectionKind::glass), expected = thin.of(ReflectionKind::glass);
    REQUIRE(through.size() == 1);
    REQUIRE(expected.size() == 1);
    CHECK(std::fabs(through[0].range - expected[0].range) < 1e-9);
    // once through both faces; the pane counts all orders
    const double cosine = -dot(pose.rotation * axis::forward, normal), n = glass.inside.index;
    const double once = std::pow(fresnel_split(cosine, n).refracted(), 2), all = pane_split(cosine, pane).transmitted;
    CHECK(through[0].power / expected[0].power == doctest::Approx(once * once / (all * all)).epsilon(2e-3));
  }
}

TEST_CASE("light refracted into water returns from the bottom as the equation of bathymetry says") {
  const Medium water{.index = 1.33, .group_index = 1.36, .absorption = 0.05};
  const SmoothInterface surface{.kind = InterfaceKind::water, .inside = water};
  const Material bottom{.reflectance = 0.3};
  const double height = 100, depth = 5;
  const World scene({rectangle({0, 0, 0}, 500.0 * axis::right, 500.0 * axis::forward, clean(surface)),
                     rectangle({0, 0, -depth}, 500.0 * axis::right, 500.0 * axis::forward, bottom, 2)});
  for (int degrees = 0; degrees <= 60; degrees += 5) {
    CAPTURE(degrees);
    const double a = degrees * 1_deg, b = std::asin(std::sin(a) / 1.33);
    const support::Lamp lamp;
    const auto seen =
        traced(LightPaths{}, scene, from_to({0, 0, height}, {height * std::tan(a), 0, 0}), SingleRay{}, lamp);
    const auto from_bottom = seen.of(ReflectionKind::water);
    REQUIRE(from_bottom.size() == 1);
    CHECK(from_bottom[0].object == 2);
    const double above = height / std::cos(a), below = depth / std::cos(b);
    CHECK(from_bottom[0].range == doctest::Approx(above + 1.36 * below).epsilon(1e-12));
    // spread across and along the plane of incidence. Source: Guenther 1985, (n H + D)^2 at nadir
    const double across = 1.33 * above + below, along = 1.33 * above + below * std::pow(std::cos(a) / std::cos(b), 2);
    const double spread2 = across * along * std::pow(std::cos(b) / std::cos(a), 2);
    const double pass = std::pow(fresnel_split(std::cos(a), 1.33).refracted(), 2) * std::exp(-2 * 0.05 * below);
    const double expected = lamp.laser.peak_power * std::pow(lamp.receiver.diameter / 2, 2) * lamp.receiver.efficiency *
                            0.3 * std::cos(b) * pass / spread2;
    CHECK(from_bottom[0].power == doctest::Approx(expected).epsilon(1e-6));
    CHECK(std::fabs(seen.imbalance()) < 1e-9);
  }
}

TEST_CASE("light that meets the edge of a body from inside is reflected in full beyond the critical angle") {
  // into a block from above, at its side face beyond the critical angle, and out below
  const Material body = clean(SmoothInterface::glass());
  World::Part top = rectangle({0, 0, 0}, 1.0 * axis::right, 1.0 * axis::forward, body);
  World::Part side = rectangle({0.2, 0, -1}, 1.0 * axis::forward, 1.0 * axis::up, body);
  World::Part base = rectangle({0, 0, -2}, 1.0 * axis::right, 1.0 * axis::forward, body);
  side.materials = base.materials = top.materials;
  const World scene({top, side, base,
                     rectangle({0, 0, -3}, 9.0 * axis::right, 9.0 * axis::forward, Material{.reflectance = 0.5}, 8)});
  const auto seen = traced(LightPaths{}, scene, from_to({-2, 0, 2}, {0, 0, 0}), SingleRay{});
  CHECK(std::fabs(seen.imbalance()) < 1e-9);
  const double b = std::asin(std::sqrt(0.5) / 1.5129);
  REQUIRE(seen.of(ReflectionKind::mirror).size() >= 1);
  const auto ghosts = seen.of(ReflectionKind::mirror);
  const Reflection& strongest =
      *std::max_element(ghosts.begin(), ghosts.end(), [](const auto& x, const auto& y) { return x.power < y.power; });
  CHECK(strongest.object == 8);
  CHECK(strongest.range ==
        doctest::Approx(2 * std::sqrt(2.0) + 1.5271 * 2 / std::cos(b) + std::sqrt(2.0)).epsilon(1e-12));
}

TEST_CASE("between mirrors light goes on until its number of passages or its share is used up") {
  const auto room = [](double reflectance) {
    return World(
        {rectangle({0, 10, 0}, 50.0 * axis::right, 5.0 * axis::up, clean(SmoothInterface::mirror(reflectance))),
         rectangle({0, -10, 0}, 50.0 * axis::right, 5.0 * axis::up, clean(SmoothInterface::mirror(reflectance)))});
  };
  const auto pose = from_to({0, 0, 0}, {0.5, 10, 0});
  for (std::size_t passages = 0; passages < 10; ++passages) {
    const auto seen = traced(LightPaths{.passages = passages, .share_min = 0}, room(0.9), pose, SingleRay{});
    CHECK(seen.result.energy.cut / seen.result.energy.sent == doctest::Approx(std::pow(0.9, passages + 1)));
    CHECK(std::fabs(seen.imbalance()) < 1e-12);
  }
  const auto dim = traced(LightPaths{.passages = 32, .share_min = 0.01}, room(0.5), pose, SingleRay{});
  CHECK(dim.result.energy.cut / dim.result.energy.sent == doctest::Approx(std::pow(0.5, 7)));
  CHECK(dim.reflections.empty());
  CHECK(dim.result.fate == Fate::absorbed);
}

TEST_CASE("a mirror that faces the scanner sends the light back into its aperture") {
  for (const double tilt : {0.0, 0.5e-3, 2e-3}) {
    const Vec3 normal{0, -std::cos(tilt), std::sin(tilt)};
    const World scene(
        {rectangle({0, 50, 0}, 1.0 * axis::right, cross(axis::right, normal), clean(SmoothInterface::mirror(0.9)))});
    const support::Lamp lamp{.laser = {.divergence = 0},
                             .receiver = {.diameter = 0.15, .efficiency = 0.8, .visibility = infinity}};
    const auto seen = traced(LightPaths{}, scene, from_to({0, 0, 0}, axis::forward), SingleRay{}, lamp);
    CHECK(std::fabs(seen.imbalance()) < 1e-12);
    if (tilt < 0.075 / 100) {
      REQUIRE(seen.reflections.size() == 1);
      CHECK(seen.reflections[0].range == doctest::Approx(50).epsilon(1e-6));
      CHECK(seen.reflections[0].power == doctest::Approx(lamp.laser.peak_power * 0.9 * 0.8));
      CHECK(seen.result.energy.missed == 0);
    } else {
      CHECK(seen.reflections.empty());
      CHECK(seen.result.energy.missed == doctest::Approx(0.9 * seen.result.energy.sent));
    }
  }
}

TEST_CASE("dirt on glass scatters, and is not passed on") {
  Material dirty{.reflectance = 0.3, .smooth = SmoothInterface::pane()};
  const World scene({rectangle({0, 10, 0}, 1.0 * axis::right, 1.0 * axis::up, dirty, 1),
                     rectangle({0, 20, 0}, 5.0 * axis::right, 5.0 * axis::up, Material{.reflectance = 1}, 2)});
  const auto seen = traced(LightPaths{}, scene, from_to({0.1, 0, 0}, {0.3, 10, 0}), SingleRay{});
  REQUIRE(seen.reflections.size() == 2);
  CHECK(seen.reflections[0].kind == ReflectionKind::surface);
  CHECK(seen.reflections[0].object == 1);
  CHECK(seen.reflections[1].kind == ReflectionKind::glass);
  const PaneSplit split = pane_split(std::cos(std::atan(0.02)), dirty.smooth);
  CHECK(seen.result.energy.scattered / seen.result.energy.sent == doctest::Approx(0.3 + 0.7 * split.transmitted));
  CHECK(seen.result.energy.missed / seen.result.energy.sent == doctest::Approx(0.7 * split.reflected));
}

TEST_CASE("an aperture catches no more of a narrow retroreflector's light than there is, also through a body") {
  const Material sign{.reflectance = 0,
                      .law = Retroreflector<CubeCorners>{.coefficient = 700, .half_angle = 2e-3, .optics = {1.5}}};
  Material wide = sign;
  wide.law = Retroreflector<CubeCorners>{.coefficient = 700, .optics = {1.5}};
  const SmoothInterface of_air{.kind = InterfaceKind::dielectric, .inside = {}};  // what a body of it does is nothing
  for (const double y : {10.0, 40.0, 160.0}) {
    CAPTURE(y);
    const auto target = [&](const Material& m) { return rectangle({0, y, 0}, 3.0 * axis::right, 3.0 * axis::up, m); };
    const auto face = [&](double at) {
      return rectangle({0, at, 0}, 3.0 * axis::right, 3.0 * axis::up, clean(of_air));
    };
    const auto power = [&](std::vector<World::Part> parts) {
      return support::power_of(
          traced(LightPaths{}, World(std::move(parts)), from_to({0, 0, 0}, axis::forward), SingleRay{}).reflections);
    };
    const double x = 2 * std::pow(0.075 / (2e-3 * y), 2),
                 aperture_fraction = (1 - std::exp(-x)) / x;  // of a Gaussian lobe, by its middle
    CHECK(power({target(sign)}) == doctest::Approx(aperture_fraction * power({target(wide)})).epsilon(1e-12));
    CHECK(power({face(5), face(6), target(sign)}) == doctest::Approx(power({target(sign)})).epsilon(1e-9));
  }
}

TEST_CASE("the range gate takes surfaces, not what passes light on") {
  const World scene({rectangle({0, 1, 0}, 1.0 * axis::right, 1.0 * axis::up,
                               Material{.reflectance = 0.1, .smooth = SmoothInterface::pane()}),
                     rectangle({0, 20, 0}, 50.0 * axis::right, 5.0 * axis::up, Material{.reflectance = 0.6})});
  const support::Lamp gated{.receiver = {.range_min = 2}}, nearer{.receiver = {.range_max = 15}};
  const auto seen = traced(LightPaths{}, scene, from_to({0.2, 0, 0}, {0.9, 1, 0}), SingleRay{}, gated);
  CHECK(seen.reflections.size() == 1);
  CHECK(seen.result.energy.out_of_range / seen.result.energy.sent == doctest::Approx(0.1));
  CHECK(std::fabs(seen.imbalance()) < 1e-12);
  const auto other = traced(LightPaths{}, scene, from_to({0.2, 0, 0}, {0.9, 1, 0}), SingleRay{}, nearer);
  CHECK(other.reflections.size() == 1);
  CHECK(other.reflections[0].range < 2);
  CHECK(std::fabs(other.imbalance()) < 1e-12);
}

TEST_CASE("light paths keep the laws of transports") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    support::Generator any(seed);
    std::vector<World::Part> parts;
    const std::array kinds{
        SmoothInterface::mirror(0.5), SmoothInterface::pane(0.1), SmoothInterface::glass(),
        SmoothInterface{.kind = InterfaceKind::water, .inside = {.index = 1.33, .absorption = 0.1, .scattering = 0.1}}};
    for (int k = 0; k < 12; ++k) {
      const Vec3 normal = any.unit(), side = any_across(any, normal);
      parts.push_back(
          rectangle(any.point(20), any.uniform(2, 12) * side, 5.0 * cross(normal, side),
                    Material{.reflectance = any.uniform(0, 0.5), .smooth = kinds[static_cast<std::size_t>(k) % 4]}));
    }
    parts.push_back(part(leaves(any, {}, 30, 3, 60), 0.5));
    std::vector<Pose<frame::Beam, frame::World>> poses;
    for (int k = 0; k < 40; ++k) poses.push_back({any.rotation(), any.point(3)});
    const World scene(std::move(parts));
    for (const LightPaths& light :
         {LightPaths{}, LightPaths{.passages = 2}, LightPaths{.passages = 0}, LightPaths{.share_min = 0.1}}) {
      CHECK(support::transport_laws(light, scene, poses) == "");
      CHECK(support::transport_laws(light, scene, poses, {.range_min = 5, .range_max = 40}) == "");
    }
  }
}

namespace {

MovingScene<Mesh>::Part moving(const World::Part& still, const Vec3& velocity) {
  MovingScene<Mesh>::Part part{.geometry = still.geometry, .materials = still.materials, .object = still.object};
  part.motion = std::make_shared<const PartMotion>(SteadyMotion{.velocity = velocity});
  return part;
}

}  // namespace

TEST_CASE("the velocity of a ghost is that of the image, in a mirror that moves") {
  const Vec3 normal = normalize(Vec3{1, -1, 0.2}), side = normalize(cross(normal, axis::up)), of_mirror{1, 2, 3},
             of_wall{-4, 1, 2};
  const MovingScene<Mesh> scene(
      {moving(rectangle({0, 10, 0}, 9.0 * side, 9.0 * cross(normal, side), clean(SmoothInterface::mirror())),
              of_mirror),
       moving(rectangle({30, 10, 0}, 90.0 * axis::forward, 90.0 * axis::up, Material{.reflectance = 0.5}), of_wall),
       moving(rectangle(Vec3{0.5, 11, 1.5} - 0.01 * normal - 0.5 * Vec3{9, 9, 9}, 9.0 * side, 9.0 * cross(normal, side),
                        Material{}),
              {9, 9, 9})},  // behind the mirror by then
      {.to = 10});
  const auto pose = from_to({0, 0, 0}, {0.3, 10, 0.1});
  const Vec3 image = mirrored(of_wall, normal) + 2 * dot(of_mirror, normal) * normal;
  const auto check = [&](const auto& footprint, const Laser& laser) {
    const auto seen = traced<true>(LightPaths{.passages = 1}, scene, pose, footprint,
                                   support::Lamp{.laser = laser, .tick = Tick::of_seconds(0.5)});
    REQUIRE(seen.reflections.size() == footprint.size());
    const SubrayDirections beam(footprint, Emitter{.laser = laser});
    for (std::size_t j = 0; j < footprint.size(); ++j)
      CHECK(seen.reflections[j].velocity ==
            doctest::Approx(dot(image, pose.rotation * Vec3{beam.x[j], beam.y[j], beam.z[j]})).epsilon(1e-9));
  };
  check(SingleRay{}, {.divergence = 0});
  check(SingleRay{}, {.divergence = 1e-3, .waist_diameter = 0.01});
  check(LatticeFootprint(19), {.divergence = 0.1});
}

TEST_CASE("glass that grows towards the target delays its light, and so does water that rises") {
  // the optical path from the scanner to a wall at rest, through a block whose faces move
  const double n = SmoothInterface::glass().inside.index;
  const World::Part front = rectangle({0, 5, 0}, 9.0 * axis::right, 9.0 * axis::up, clean(SmoothInterface::glass()));
  World::Part back = rectangle({0, 6, 0}, 9.0 * axis::right, 9.0 * axis::up, Material{});
  back.materials = front.materials;
  const World::Part wall = rectangle({0, 9, 0}, 9.0 * axis::right, 9.0 * axis::up, Material{});
  const MovingScene<Mesh> scene({moving(front, {0, -0.3, 0}), moving(back, {0, 0.5, 0}), moving(wall, {0, 0, 0.1})},
                                {.to = 1});
  const auto seen =
      traced<true>(LightPaths{}, scene, from_to({1, 0, 0}, {1, 10, 0}), SingleRay{}, {.tick = Tick::of_seconds(0.1)});
  const auto through = seen.of(ReflectionKind::glass);
  REQUIRE(through.size() == 1);
  CHECK(through[0].velocity == doctest::Approx((n - 1) * 0.8).epsilon(1e-12));
}

TEST_CASE("settings out of range are refused") {
  CHECK_THROWS_WITH_AS(LightPaths{.passages = 33}.validate(), "LightPaths::passages is 33, but must be from 0 to 32",
                       SettingError);
  CHECK_THROWS_AS(LightPaths{.share_min = -0.1}.validate(), SettingError);
  CHECK_THROWS_AS((void)material_table({{.reflectance = 0.5, .smooth = SmoothInterface::mirror(0.6)}}), SettingError);
  CHECK_THROWS_AS((void)material_table({{.smooth = SmoothInterface::pane(-1)}}), SettingError);
  SmoothInterface thin = SmoothInterface::glass();
  thin.inside.index = 0.9;
  CHECK_THROWS_AS((void)material_table({{.smooth = thin}}), SettingError);
  thin.inside = {.index = 1.5, .absorption = -1};
  CHECK_THROWS_AS((void)material_table({{.smooth = thin}}), SettingError);
}
