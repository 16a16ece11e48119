// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_DETAIL_RAY_QUERIES_HPP
#define PULSECAST_SCENE_DETAIL_RAY_QUERIES_HPP

#include <pulsecast/geometry/detail/ray_sheaf.hpp>
#include <pulsecast/geometry/triangle.hpp>
#include <pulsecast/scene/part.hpp>

/// Queries by a ray: `search(ray, hits)` offers hits to a `ClosestHit`, `AnyHit` or `AllHits`.
namespace PULSECAST_NAMESPACE::detail {

template <class Shape, class Rays, class Hits>
concept Intersects = requires(const Shape& shape, const Rays& rays, Hits& hits) {
  shape.closest(rays, hits);
};

template <class Shape>
concept SurfacedBySingleRay = requires(const Shape& shape, const SingleRayPacket& ray) {
  shape.surface(PrimitiveIndex{}, ray, std::size_t{});
};

/// Shape that needs no bundle for a ray's closest hit and its surface.
template <class Shape>
concept TakesSingleRays = Intersects<Shape, SingleRayPacket, ClosestHit> && SurfacedBySingleRay<Shape>;

/// Offers the hits of a shape with a bundle or a single ray. A shape that takes neither single rays
/// nor such hits is asked for the closest hit of a bundle.
template <class Shape, class Rays, class Hits>
void offer_hits(const Shape& shape, const Rays& rays, Hits& hits) noexcept {
  if constexpr (Intersects<Shape, Rays, Hits>) {
    shape.closest(rays, hits);
  } else if constexpr (std::is_same_v<Hits, AllHits>) {
    const auto closest = [&shape](const auto& from, auto& next) noexcept { offer_hits(shape, from, next); };
    hits.offer_chain(rays, closest);
  } else {
    const RayBundle bundle = bundle_of(rays, hits.limit_of(0));
    ClosestHits nearest(bundle);
    nearest.part = hits.part;
    shape.closest(bundle, nearest);
    if (nearest.met(0)) hits.offer(0, nearest.range[0], nearest.primitive_of(0));
  }
}

/// Offers the hits of a shape with each ray of a sheaf, together if the shape takes sheaves.
template <class Shape>
void offer_hits(const Shape& shape, const RaySheaf& rays, SheafHits& hits) noexcept {
  if constexpr (Intersects<Shape, RaySheaf, SheafHits>) {
    shape.closest(rays, hits);
  } else {
    for (std::size_t j = 0; j < rays.size; ++j) {
      hits.of[j].part = hits.part;
      offer_hits(shape, rays.rays[j], hits.of[j]);
    }
  }
}

template <class Shape>
[[nodiscard, gnu::always_inline]] inline SurfaceInteraction surface_of(const Shape& shape, PrimitiveIndex primitive,
                                                                       const auto& rays, std::size_t j) noexcept {
  constexpr bool single = std::is_same_v<std::remove_cvref_t<decltype(rays)>, SingleRayPacket>;
  if constexpr (!single || SurfacedBySingleRay<Shape>)
    return shape.surface(primitive, rays, j);
  else
    return shape.surface(primitive, bundle_of(rays, infinity), 0);
}

[[nodiscard]] inline RayHit ray_hit(double range, std::uint64_t id) noexcept {
  return {range, static_cast<std::uint32_t>(id >> 32), static_cast<PrimitiveIndex>(id)};
}

template <class Search>
[[nodiscard]] std::optional<RayHit> closest_hit(const Ray& ray, const Search& search) noexcept {
  ClosestHit nearest(ray.far);
  search(SingleRayPacket(ray), nearest);
  if (!nearest.met(0)) return std::nullopt;
  return ray_hit(nearest.range[0], nearest.id[0]);
}

template <class Search>
[[nodiscard]] bool occluded(const Ray& ray, double range, const Search& search) noexcept {
  AnyHit any(range < ray.far ? range : ray.far);
  search(SingleRayPacket(ray), any);
  return any.found;
}

template <class Search, class Visitor>
std::size_t visit_hits(const Ray& ray, const Search& search,
                       Visitor& visitor) noexcept(std::is_nothrow_invocable_v<Visitor&, const RayHit&>) {
  SingleRayPacket from(ray);
  AllHits buffer(ray.near, ray.far);
  for (std::size_t visited = 0;;) {
    search(from, buffer);
    for (const AllHits::Entry& hit : buffer.hits()) {
      ++visited;
      if constexpr (std::is_void_v<std::invoke_result_t<Visitor&, const RayHit&>>)
        visitor(ray_hit(hit.range, hit.id));
      else if (!visitor(ray_hit(hit.range, hit.id)))
        return visited;
    }
    if (!buffer.full()) return visited;
    from.near = buffer.continue_after();
  }
}

template <class Part>
[[nodiscard]] SurfaceInteraction surface_at(const RayHit& hit, const Ray& ray, const Part& part,
                                            const Placement& placement) noexcept {
  SingleRayPacket before(ray);
  before.near = std::nextafter(hit.range, -infinity);  // the hit is the next one
  const SingleRayPacket local = placement.to_local(before);
  SurfaceInteraction point;
  const auto look = [&](const auto& shape) noexcept {
    using Shape = std::remove_cvref_t<decltype(*shape)>;
    point = surface_of(*shape, hit.primitive, local, 0);
    point.front = !(dot(point.normal, local.toward) > 0);
    point.normal = placement.rotation * (point.front ? point.normal : -point.normal);
    if constexpr (MadeOfTriangles<Shape>)
      point.weights = shape->triangle(hit.primitive).weights(local.origin, local.toward);
    if constexpr (Textured<Shape>) point.texture = shape->texture(hit.primitive, *point.weights);
  };
  visit_shape(look, part.geometry);
  point.material = &(*part.materials)[point.material_index];
  point.classification = point.material->classification;
  point.object = part.object;
  point.part = hit.part;
  point.primitive = hit.primitive;
  point.position = ray.origin + hit.range * ray.direction;
  return point;
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
