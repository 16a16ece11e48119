// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HIT_HPP
#define PULSECAST_HIT_HPP

#include <optional>

#include <pulsecast/geometry/bundle.hpp>

/// Results of intersecting a ray: `Hit` of any map, `RayHit` of a scene, and the `SurfaceInteraction` there.
namespace PULSECAST_NAMESPACE {

struct Material;

/// User's number of an object of the scene.
using ObjectId = std::uint32_t;

/// Hit of one subray: numbers only, so that any map can provide it.
struct Hit {
  double range =
      std::numeric_limits<double>::infinity();  ///< distance from the pulse's origin; infinite for a miss [m]
  double cos_incidence = 1;                     ///< cosine of the angle between beam and surface normal, in [0, 1]
  double backscatter =
      1;  ///< reflectance times the angular law, cosine included: 1 for a white Lambertian surface at normal incidence
  ObjectId object = 0;               ///< number of the object hit
  std::uint16_t classification = 0;  ///< class of the material hit
  /// Share of the light that the surface scatters, into all directions; NaN: that of Lambert's law for `backscatter`.
  double scattered_share = std::numeric_limits<double>::quiet_NaN();

  /// True for a hit.
  [[nodiscard]] bool met() const noexcept { return range < std::numeric_limits<double>::infinity(); }
};

/// Hit of a ray in a scene, by number.
struct RayHit {
  double range = 0;              ///< distance from the ray's origin [m]
  std::uint32_t part = 0;        ///< index of the part in the scene
  PrimitiveIndex primitive = 0;  ///< primitive of the part's geometry
  std::uint32_t layer = 0;       ///< scene of a `Layered` that was hit; 0 of others

  friend bool operator==(const RayHit&, const RayHit&) = default;
};

/// Surface at the hit of a ray. A geometry sets the first three members, in its own frame, and may leave the others to
/// the scene, which sets all, in the world.
struct SurfaceInteraction {
  Vec3 normal{};  ///< unit; of a geometry to either side, of a scene towards the ray's origin; zero for a surface
                  ///< without direction
  std::uint32_t material_index = 0;  ///< index in the part's table of materials
  bool foliage = false;  ///< true for one of many leaves of all directions, whose mean incidence the normal gives
  bool front =
      true;  ///< true if the geometry's own normal is towards the ray's origin, as for corners seen anticlockwise
  std::uint16_t classification = 0;    ///< ASPRS class of the material
  ObjectId object = 0;                 ///< object id of the part
  std::uint32_t part = 0;              ///< index of the part in the scene
  PrimitiveIndex primitive = 0;        ///< primitive of the part's geometry
  const Material* material = nullptr;  ///< owned by the scene
  Vec3 position{};                     ///< point of the hit [m]
  Vec3 velocity{};                     ///< velocity of the surface at the ray's tick; zero unless the part moves [m/s]
  std::optional<Vec2> texture{};       ///< texture coordinates; empty without
  std::optional<Vec3>
      weights{};  ///< barycentric weights of a triangle's corners, not negative, of sum one; empty for other shapes
};

}  // namespace PULSECAST_NAMESPACE

#endif
