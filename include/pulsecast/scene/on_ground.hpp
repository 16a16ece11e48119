// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <variant>

#include <pulsecast/concepts.hpp>
#include <pulsecast/geometry/triangle.hpp>
#include <pulsecast/scene/part.hpp>

namespace pulsecast {

/// What of a part comes to the height of the ground below or above it. Points of a part are the corners of its triangles, or else those of
/// its box.
enum class GroundPlacement : std::uint8_t {
  origin,        ///< its own origin, wherever its shape is: for models that are made to be stood there
  lowest_point,  ///< its lowest point (of several, their middle), whatever the ground does around it: for a tree
  touching,      ///< the point that touches first if it is let down: nothing is below the ground; for a car or a crate
  sunk,          ///< all corners of the bottom of its box are in the ground or on it: nothing hovers; for a house on a slope
};

namespace detail {

/// Calls `visit(p)` for the points of a part, in the world [m].
template <Geometry Shape, class Visit>
void visit_points(const Shape& shape, const Similarity& placement, const Visit& visit) {
  if constexpr (requires {
                  { shape.triangle(PrimitiveIndex{}) } -> std::convertible_to<Triangle>;
                  { shape.size() } -> std::convertible_to<std::size_t>;
                }) {
    for (std::size_t i = 0; i < shape.size(); ++i) {
      const Triangle t = shape.triangle(static_cast<PrimitiveIndex>(i));
      for (const Vec3& corner : {t.a, t.b, t.c}) visit(placement.point(corner));
    }
  } else {
    for (const Vec3& corner : corners(shape.bounds())) visit(placement.point(corner));
  }
}

}  // namespace detail

/// The height by which a placed shape has to be lifted to stand on the ground, negative if lowered [m]; empty if none of the points that
/// are asked for stands over or under ground. Ground is asked once a point: `ground(place)`, as `Scene::ground_height` of the scene of the
/// parts that carry others.
template <Geometry Shape>
[[nodiscard]] std::optional<double> lift_onto_ground(const Shape& shape, const Similarity& placement, const Ground auto& ground,
                                                     GroundPlacement ground_placement = GroundPlacement::lowest_point) {
  std::optional<double> lift;
  // the least or the most that any of the points asks for
  const auto ask = [&](const Vec3& p, bool most) {
    const std::optional<double> height = ground(Vec2{p.x, p.y});
    if (!height) return;
    const double asked = *height - p.z;
    lift = !lift ? asked : most ? std::max(*lift, asked) : std::min(*lift, asked);
  };
  if (ground_placement == GroundPlacement::origin) return ask(placement.translation, true), lift;
  if (shape.bounds().empty()) return std::nullopt;
  if (ground_placement == GroundPlacement::touching) {
    detail::visit_points(shape, placement, [&](const Vec3& p) { ask(p, true); });
    return lift;
  }
  Box box;
  detail::visit_points(shape, placement, [&](const Vec3& p) { box.extend(p); });
  if (ground_placement == GroundPlacement::sunk) {
    for (const double x : {box.min.x, box.max.x})
      for (const double y : {box.min.y, box.max.y}) ask({x, y, box.min.z}, false);
    return lift;
  }
  Box lowest;
  const double rounding = 1e-9 * box.size().z + 4 * std::numeric_limits<double>::epsilon() * max_norm(max(box.max, -box.min));
  detail::visit_points(shape, placement, [&](const Vec3& p) {
    if (p.z <= box.min.z + rounding) lowest.extend(p);
  });
  const Vec3 middle = lowest.centre();
  return ask({middle.x, middle.y, box.min.z}, true), lift;
}

/// A part that stands on the ground of others, lifted or lowered; empty if there is no ground for it. A motion of the part is not asked:
/// it starts there.
template <Geometry... Shapes>
[[nodiscard]] std::optional<Part<Shapes...>> on_ground(Part<Shapes...> part, const Ground auto& ground,
                                                       GroundPlacement ground_placement = GroundPlacement::lowest_point) {
  part.placement = validated(part.placement);
  const auto lift_of = [&](const auto& shape) {
    if (!shape) throw SettingError("Part::geometry (number)", 0, "", "1");
    return lift_onto_ground(*shape, part.placement, ground, ground_placement);
  };
  const std::optional<double> lift = std::visit(lift_of, part.geometry);
  if (!lift) return std::nullopt;
  part.placement.translation.z += *lift;
  return part;
}

}  // namespace pulsecast
