// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_LIGHT_PATH_HPP
#define PULSECAST_TRANSPORT_DETAIL_LIGHT_PATH_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/material/fresnel.hpp>
#include <pulsecast/material/material.hpp>

/// Contract: light on its way. A `CoaxialRays` is the subrays of a pulse that still seem to come
/// from one point, a `LightPath` a subray that was refracted.
namespace PULSECAST_NAMESPACE::detail {

inline constexpr double surface_epsilon = 1e-6;  ///< nearer surfaces are one [m]

/// Normal of a plane that a ray meets, towards the ray.
[[nodiscard]] inline Vec3 towards(const Vec3& normal, const Vec3& direction) noexcept {
  return dot(normal, direction) > 0 ? -normal : normal;
}

/// Rays in air that seem to come from one point, the pulse's exit or its image in mirrors and
/// panes, from where ranges are counted: lengths of the whole way.
struct CoaxialRays {
  StaggeredBundle rays{};                       ///< with the range from which each exists
  alignas(64) RayBundle::Column sent;           ///< share of the pulse's energy on its way
  alignas(64) RayBundle::Column two_way_share;  ///< the same times the share that passes back
  RayBundle::Column delay;                      ///< optical path so far less the range [m]
  RayBundle::Column path_rate;                  ///< growth of the optical path so far [m/s]
  unsigned passages = 0;                        ///< surfaces that passed the light on
  ReflectionKind kind = ReflectionKind::surface;
};

/// Surface that a ray hit, as far as light is followed from there.
struct PathVertex {
  const Material* material = nullptr;  ///< as in `SurfaceInteraction`, as all
  Vec3 normal{};
  bool foliage = false;
  std::optional<Vec2> texture{};
};

/// Subray after it entered a body, with the derivatives of place and direction by the angles at the
/// pulse's exit. Source: Igehy 1999, Tracing ray differentials.
struct LightPath {
  Ray ray{};                 ///< from the last surface on
  double sent = 0;           ///< share of the pulse's energy on its way
  double two_way_share = 0;  ///< the same times the share that passes the same way back
  double optical = 0;        ///< optical path up to the ray's origin [m]
  double air = 0;            ///< way in air up to the ray's origin [m]
  double path_rate = 0;      ///< as in `CoaxialRays` [m/s]
  unsigned passages = 0;     ///< as in `CoaxialRays`
  ReflectionKind kind = ReflectionKind::surface;
  std::array<Vec3, 2> place{}, turn{};      ///< derivatives of origin [m/rad] and direction
  std::array<const Material*, 4> bodies{};  ///< bodies that it is in, the outermost first
  std::size_t depth = 0;                    ///< number of bodies

  /// Starts along a ray whose way so far was straight.
  void start(const Ray& from) noexcept {
    ray = from;
    const Vec3& d = from.direction;
    const Vec3 across = std::fabs(d.z) < 0.9 ? axis::up : axis::right;
    turn[0] = normalize(cross(d, across));
    turn[1] = cross(d, turn[0]);
  }

  /// Medium around the ray.
  [[nodiscard]] const Medium& medium() const noexcept {
    static constexpr Medium air_{};
    return depth > 0 ? bodies[depth - 1]->smooth.inside : air_;
  }
  /// Medium behind a surface of a material: inside its body, or outside, if the ray is in it.
  [[nodiscard]] const Medium& behind(const Material& body) const noexcept {
    LightPath after = *this;
    after.cross_face(body);
    return after.depth > 0 ? after.bodies[after.depth - 1]->smooth.inside : LightPath{}.medium();
  }
  /// Enters a body, told by its material, or leaves it. The innermost of too many is forgotten.
  void cross_face(const Material& body) noexcept {
    const auto end = bodies.begin() + static_cast<std::ptrdiff_t>(depth), at = std::find(bodies.begin(), end, &body);
    if (at != end) {
      std::copy(at + 1, end, at);
      --depth;
    } else {
      depth = std::min(depth + 1, bodies.size());
      bodies[depth - 1] = &body;
    }
  }

  /// Goes on to a plane, at a distance along the ray [m].
  void advance(double distance, const Vec3& normal) noexcept {
    ray.origin += distance * ray.direction;
    optical += distance * medium().delay();
    if (depth == 0) air += distance;
    const double slope = dot(ray.direction, normal);
    for (std::size_t k = 0; k < 2; ++k) {
      place[k] += distance * turn[k];
      if (slope != 0) place[k] -= dot(place[k], normal) / slope * ray.direction;
    }
  }
  /// Range in air over which light would spread as far and return as weak, at a distance [m].
  [[nodiscard]] double spread(double distance = 0) const noexcept {
    return medium().index * std::sqrt(std::fabs(dot(cross(place[0] + distance * turn[0], place[1] + distance * turn[1]),
                                                    ray.direction)));
  }

  void keep(double share) noexcept {
    sent *= share;
    two_way_share *= share * share;
  }
  void reflect(const Vec3& normal) noexcept {
    ray.direction = mirrored(ray.direction, normal);
    for (Vec3& t : turn) t = mirrored(t, normal);
  }
  /// Continues behind the face of a body; `normal` is towards the ray.
  void refract(const Vec3& normal, double relative_index, const FresnelSplit& split) noexcept {
    const double per = 1 / relative_index, cosine = -dot(ray.direction, normal);
    ray.direction = refracted(ray.direction, normal, relative_index, split);
    for (Vec3& t : turn) t = per * t - (per - per * per * cosine / split.cos_refracted) * dot(t, normal) * normal;
  }
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
