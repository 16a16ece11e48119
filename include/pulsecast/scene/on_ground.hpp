// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_ON_GROUND_HPP
#define PULSECAST_SCENE_ON_GROUND_HPP

#include <pulsecast/geometry/triangle.hpp>
#include <pulsecast/scene/part.hpp>

namespace PULSECAST_NAMESPACE {

/// Point of a part placed at the height of the ground, of its triangles' corners or else its box.
enum class GroundPlacement : std::uint8_t {
  origin,        ///< its own origin: for models whose origin is their foot
  lowest_point,  ///< its lowest point, or the middle of several: for a tree
  touching,      ///< its first point to meet the ground when lowered: for a car or a crate
  sunk,          ///< no bottom corner of its box above the ground: for a house on a slope
};

namespace detail {

template <class Shape>
concept ListsTriangles = MadeOfTriangles<Shape> && requires(const Shape& shape) {
  { shape.size() } -> std::convertible_to<std::size_t>;
};

/// Calls `visit(p)` for the points of a part, in the world [m].
template <Geometry Shape, class Visit>
void visit_points(const Shape& shape, const Placement& placement, const Visit& visit) {
  if constexpr (ListsTriangles<Shape>) {
    for (std::size_t i = 0; i < shape.size(); ++i) {
      const Triangle t = shape.triangle(static_cast<PrimitiveIndex>(i));
      for (const Vec3& corner : {t.a, t.b, t.c}) visit(placement.point(corner));
    }
  } else {
    for (const Vec3& corner : corners(shape.bounds())) visit(placement.point(corner));
  }
}

/// Lift that places a shape on the ground, negative if lowered [m]; empty if no point asked has
/// ground above or below. Calls `ground(place)`, as `Scene::ground_height`, once per point.
template <Geometry Shape>
[[nodiscard]] std::optional<double> lift_onto_ground(const Shape& shape, const Placement& placement,
                                                     const Ground auto& ground,
                                                     GroundPlacement placing = GroundPlacement::lowest_point) {
  std::optional<double> lift;
  // least or greatest lift of the points in question
  const auto ask = [&](const Vec3& p, bool most) {
    const std::optional<double> height = ground(Vec2{p.x, p.y});
    if (!height) return;
    const double asked = *height - p.z;
    lift = !lift ? asked : most ? std::max(*lift, asked) : std::min(*lift, asked);
  };
  if (placing == GroundPlacement::origin) {
    ask(placement.translation, true);
    return lift;
  }
  if (shape.bounds().empty()) return std::nullopt;
  if (placing == GroundPlacement::touching) {
    visit_points(shape, placement, [&](const Vec3& p) { ask(p, true); });
    return lift;
  }
  Box box;
  visit_points(shape, placement, [&](const Vec3& p) { box.extend(p); });
  if (placing == GroundPlacement::sunk) {
    for (const double x : {box.min.x, box.max.x})
      for (const double y : {box.min.y, box.max.y}) ask({x, y, box.min.z}, false);
    return lift;
  }
  Box lowest;
  const double scale = max_norm(max(box.max, -box.min));
  const double rounding = 1e-9 * box.size().z + 4 * std::numeric_limits<double>::epsilon() * scale;
  visit_points(shape, placement, [&](const Vec3& p) {
    if (p.z <= box.min.z + rounding) lowest.extend(p);
  });
  const Vec3 middle = lowest.centre();
  ask({middle.x, middle.y, box.min.z}, true);
  return lift;
}

}  // namespace detail

/// Part lifted or lowered onto the ground of others; empty without ground. It starts there, if it
/// moves. @throws SettingError for a placement out of range or a missing geometry
template <Geometry... Shapes>
[[nodiscard]] std::optional<Part<Shapes...>> on_ground(Part<Shapes...> part, const Ground auto& ground,
                                                       GroundPlacement placing = GroundPlacement::lowest_point) {
  part.placement = validated(part.placement);
  const auto lift_of = [&](const auto& shape) {
    if (!shape) throw SettingError("Part::geometry (number)", 0, "", "1");
    return detail::lift_onto_ground(*shape, part.placement, ground, placing);
  };
  const std::optional<double> lift = visit_shape(lift_of, part.geometry);
  if (!lift) return std::nullopt;
  part.placement.translation.z += *lift;
  return part;
}

}  // namespace PULSECAST_NAMESPACE

#endif
