// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/geometry/detail/ray_sheaf.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/accel/linear.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/generators.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using detail::RaySheaf;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Mesh = TriangleMesh<>;
using Plain = TriangleMesh<Linear<>>;  // which takes no sheaves
using Still = Scene<Mesh, Plain>;
using Moving = MovingScene<Mesh, Plain>;

SingleRayPacket ray(const Vec3& origin, const Vec3& direction) {
  return SingleRayPacket(Ray{.origin = origin, .direction = direction});
}

bool encloses(std::span<const SingleRayPacket> rays) {
  RaySheaf sheaf;
  for (const SingleRayPacket& r : rays) sheaf.push_back(r, infinity);
  return sheaf.enclose();
}

/// A few parts about the origin, of all scales; some move.
template <class Scene>
std::vector<typename Scene::Part> parts(support::Generator& any, double reach) {
  std::vector<typename Scene::Part> all;
  for (std::uint64_t n = 1 + any.whole(4); all.size() < n;) {
    const double scale = any.coin() ? 1 : any.log_uniform(1e-3, 1e3);
    MeshData data = support::soup(any, 1 + any.whole(60), reach / scale);
    typename Scene::Part part;
    part.materials = material_table({{.reflectance = any.uniform()}});
    part.object = static_cast<ObjectId>(all.size());
    if (any.whole(3) > 0)
      part.geometry = std::make_shared<const Mesh>(std::move(data));
    else
      part.geometry = std::make_shared<const Plain>(std::move(data));
    if (scale != 1 || any.coin()) part.placement = {any.rotation(), scale, any.point(reach)};
    all.push_back(std::move(part));
  }
  return all;
}

/// Rays of nearby origins and about one direction, with ticks of their own.
RaySheaf any_sheaf(support::Generator& any, double reach) {
  RaySheaf sheaf;
  const Vec3 origin = any.point(2 * reach), axis = normalize(any.point(reach) - origin);
  const double apart = any.log_uniform(1e-6, 0.05), wide = any.log_uniform(1e-6, 0.04);
  while (sheaf.size < RaySheaf::capacity) {
    Ray one{.origin = origin + any.point(apart), .direction = normalize(axis + any.point(wide))};
    if (any.whole(8) == 0) one.near = any.uniform(0, 2 * reach);
    one.tick = Tick::of_seconds(any.uniform(0, 10));
    sheaf.push_back(SingleRayPacket(one), any.coin() ? infinity : any.uniform(0, 4 * reach));
  }
  return sheaf;
}

/// Number of the sheaf's hits; each must be that of a bundle of its ray alone, to the bit.
std::size_t hits_alike(const auto& scene, const RaySheaf& sheaf) {
  constexpr double wavelength = 905e-9;
  std::array<Hit, RaySheaf::capacity> hits;
  std::array<Hit, 1> alone;
  scene.closest(sheaf, wavelength, hits);
  std::size_t met = 0;
  for (std::size_t j = 0; j < sheaf.size; ++j) {
    const SingleRayPacket& one = sheaf.rays[j];
    RayBundle bundle = bundle_of(one, sheaf.far[j]);
    bundle.wavelength = wavelength;
    scene.closest(bundle, alone);
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    CHECK(bits(hits[j].range) == bits(alone[0].range));
    CHECK(bits(hits[j].cos_incidence) == bits(alone[0].cos_incidence));
    CHECK(bits(hits[j].backscatter) == bits(alone[0].backscatter));
    CHECK(bits(hits[j].scattered_share) == bits(alone[0].scattered_share));
    CHECK(hits[j].object == alone[0].object);
    met += hits[j].met();
  }
  return met;
}

}  // namespace

TEST_CASE("a sheaf encloses its rays, and refuses those that are few, far apart, wide or not finite") {
  const Vec3 y{0, 1, 0};
  const std::vector<SingleRayPacket> rays{ray({1, 2, 3}, y), ray({1.05, 2, 3}, {0.05, 0.9, 0}), ray({1, 2, 3.02}, y)};
  RaySheaf sheaf;
  for (const SingleRayPacket& r : rays) sheaf.push_back(r, infinity);
  REQUIRE(sheaf.enclose());
  CHECK(sheaf.origin.x == doctest::Approx(1.025));
  CHECK(sheaf.origin_reach.x == doctest::Approx(0.025));
  CHECK(sheaf.origin_reach.z == doctest::Approx(0.01));
  CHECK(sheaf.direction_min(0) == 0);
  CHECK(sheaf.direction_max(0) == 0.05);
  CHECK(sheaf.direction_min(1) == 0.9);
  for (const SingleRayPacket& r : rays)
    for (int k = 0; k < 3; ++k) {
      CHECK(sheaf.origin[k] - sheaf.origin_reach[k] <= r.origin[k]);
      CHECK(sheaf.origin[k] + sheaf.origin_reach[k] >= r.origin[k]);
    }
  CHECK_FALSE(encloses(std::span(rays).first(2)));
  auto with = [&](const Vec3& origin, const Vec3& direction) {
    std::vector<SingleRayPacket> more = rays;
    more.push_back(ray(origin, direction));
    return encloses(more);
  };
  CHECK(with({1, 2, 3}, y));
  CHECK_FALSE(with({1.11, 2, 3}, y));
  CHECK_FALSE(with({1, 2, 3}, {0.11, 0.9, 0}));
  CHECK_FALSE(with({1, 2, std::numeric_limits<double>::quiet_NaN()}, y));
  CHECK_FALSE(with({1, 2, 3}, {0, 1, std::numeric_limits<double>::quiet_NaN()}));
  CHECK_FALSE(with({1, infinity, 3}, y));
}

TEST_CASE("the hits of a sheaf are those of each ray alone, to the bit, in scenes still, moving and layered") {
  std::size_t met = 0, moved = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double reach = any.log_uniform(0.01, 1e3);
    const Still still(parts<Still>(any, reach));
    auto movers = parts<Moving>(any, reach);
    for (auto& part : movers)
      if (any.coin()) part.motion = std::make_shared<const PartMotion>(SteadyMotion{.velocity = any.point(reach)});
    const Moving moving(movers, {.to = 10});
    const Layered world{still, moving};
    for (int n = 0; n < 6; ++n) {
      RaySheaf sheaf = any_sheaf(any, reach);
      if (!sheaf.enclose()) continue;
      met += hits_alike(still, sheaf);
      moved += hits_alike(moving, sheaf);
      hits_alike(world, sheaf);
    }
  }
  CHECK(met > 500);
  CHECK(moved > 300);
}
