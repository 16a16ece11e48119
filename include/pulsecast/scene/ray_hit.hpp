// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_RAY_HIT_HPP
#define PULSECAST_SCENE_RAY_HIT_HPP

#include <concepts>
#include <cstdint>
#include <optional>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/echo.hpp>
#include <pulsecast/geometry/bundle.hpp>
#include <pulsecast/geometry/triangle.hpp>
#include <pulsecast/material/material.hpp>

namespace PULSECAST_NAMESPACE {

/// Geometry whose primitives are triangles: hits on it have barycentric weights.
template <class G>
concept MadeOfTriangles = requires(const G g, PrimitiveIndex i) {
  { g.triangle(i) }
  noexcept->std::same_as<Triangle>;
};

/// Geometry with texture coordinates, by primitive and barycentric weights; empty where there are none.
template <class G>
concept Textured = MadeOfTriangles<G> && requires(const G g, PrimitiveIndex i, const Vec3& weights) {
  { g.texture(i, weights) }
  noexcept->std::same_as<std::optional<Vec2>>;
};

/// Hit of a ray in a scene.
struct RayHit {
  double range = 0;              ///< distance from the ray's origin [m]
  std::uint32_t part = 0;        ///< index of the part in the scene
  PrimitiveIndex primitive = 0;  ///< primitive of the part's geometry

  friend bool operator==(const RayHit&, const RayHit&) = default;
};

/// Surface of a scene at the hit of a ray, in the world.
struct SurfaceInteraction {
  Vec3 position{};  ///< point of the hit [m]
  Vec3 normal{};    ///< unit, towards the side of the ray's origin; zero for a surface without direction, as of leaves
  bool front = true;  ///< true if the shape's own normal is towards that side, too, as for corners seen anticlockwise
  const Material* material = nullptr;  ///< owned by the scene
  std::uint32_t material_index = 0;    ///< its index in the part's table of materials
  std::uint32_t part = 0;              ///< index of the part in the scene
  PrimitiveIndex primitive = 0;        ///< primitive of the part's geometry
  std::optional<Vec3>
      weights{};  ///< barycentric weights of a triangle's corners, not negative, of sum one; empty for other shapes
  std::optional<Vec2> texture{};     ///< texture coordinates; empty without
  Vec3 velocity{};                   ///< velocity of the surface at the ray's tick; zero unless the part moves [m/s]
  ObjectId object = 0;               ///< object id of the part
  std::uint16_t classification = 0;  ///< ASPRS class of the material
  bool foliage = false;              ///< as in `Surface`
};

/// World that tells the surface at the hit of a ray, as `Scene`, `MovingScene` and `Layered`.
template <class World>
concept TellsSurfaces = requires(const World& world, const Ray& ray) {
  { world.surface(*world.closest_hit(ray), ray) }
  noexcept->std::same_as<SurfaceInteraction>;
};

}  // namespace PULSECAST_NAMESPACE

#endif
