// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_DETAIL_SURFACE_SAMPLE_HPP
#define PULSECAST_SCENE_DETAIL_SURFACE_SAMPLE_HPP

#include <pulsecast/scene/detail/ray_queries.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Members of a surface that all its hits need, in the part's frame.
struct SurfaceSample {
  Vec3 normal{};
  const Material* material = nullptr;
  std::uint32_t material_index = 0;
  bool foliage = false;
  bool uniform = false;  ///< same for every ray that hits the primitive
  std::optional<Vec2> texture{};
};

/// Samples the surface of a primitive where ray j hits it. Inlined, to set what is read alone.
template <class Part, class Rays>
struct SurfaceSampler {
  const Part& part;
  PrimitiveIndex primitive;
  const Rays& local;
  std::size_t j;

  template <class Shape>
  [[gnu::always_inline]] SurfaceSample operator()(const std::shared_ptr<const Shape>& shape) const noexcept {
    const SurfaceInteraction surface = surface_of(*shape, primitive, local, j);
    SurfaceSample found{.normal = surface.normal,
                        .material = &(*part.materials)[surface.material_index],
                        .material_index = surface.material_index,
                        .foliage = surface.foliage,
                        .uniform = UniformGeometry<Shape>};
    if constexpr (Textured<Shape>)
      if (found.material->reflectance_map) [[unlikely]] {
        found.uniform = false;
        const Vec3 weights = shape->triangle(primitive).weights(local.origin, local.direction(j));
        found.texture = shape->texture(primitive, weights);
      }
    return found;
  }
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
