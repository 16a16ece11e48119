// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_WITHOUT_OBJECT_HPP
#define PULSECAST_SCENE_WITHOUT_OBJECT_HPP

#include <pulsecast/scene/scene.hpp>

namespace PULSECAST_NAMESPACE {

/// A `Scene` or `MovingScene` as seen by a sensor that ignores an object, such as the robot that carries it: the hits,
/// to the bit, of a scene without the parts of this `Part::object`. Refers to the scene, which must outlive it, and may
/// be assigned anew. Each sensor may ignore another object of one scene; sensors that ignore none take the scene
/// itself. Of a `Layered`, the layer that has the object is seen without it.
template <detail::HasParts Map>
class WithoutObject {
 public:
  /// Refers to a scene.
  WithoutObject(const Map& map, ObjectId object) noexcept : map_(&map), meets_{object} {}
  WithoutObject(const Map&&, ObjectId) = delete;  // a temporary scene would dangle

  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept { find(rays, hits, AskLaws{}); }
  template <class Visitor>
  void closest(const StaggeredBundle& rays, std::span<Hit> hits, const Visitor& visit) const noexcept {
    find(rays, hits, visit);
  }
  using TracesSheaves = WithoutObject;  ///< as the concept requires
  void closest(const detail::RaySheaf& rays, double wavelength, std::span<Hit> hits) const noexcept
      requires(detail::TracesSheaves<Map>) {
    detail::SheafHits nearest(rays);
    map_->search(rays, nearest, meets_);
    for (std::size_t j = 0; j < rays.size; ++j)
      map_->still().describe(rays.rays[j], nearest.of[j], wavelength, hits.subspan(j, 1),
                             map_->placements(rays.rays[j].tick), AskLaws{});
  }
  [[nodiscard]] std::optional<RayHit> closest_hit(const Ray& ray) const noexcept {
    return detail::closest_hit(ray, map_->searcher(meets_));
  }
  [[nodiscard]] bool occluded(const Ray& ray, double range = detail::infinity) const noexcept {
    return detail::occluded(ray, range, map_->searcher(meets_));
  }
  [[nodiscard]] SurfaceInteraction surface(const RayHit& hit, const Ray& ray) const noexcept {
    return map_->surface(hit, ray);
  }

  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept { return map_->misses_cone(cone); }
  template <class Visitor>
  void visit_materials(const Visitor& visit) const {
    map_->visit_materials(visit);
  }

 private:
  struct Meets {
    ObjectId ignored;
    bool operator()(const auto& part) const noexcept { return part.object != ignored; }
  };

  using AskLaws = typename std::remove_cvref_t<decltype(std::declval<const Map&>().still())>::AskLaws;

  template <class Rays, class Visitor>
  void find(const Rays& rays, std::span<Hit> hits, const Visitor& visit) const noexcept {
    ClosestHits nearest(rays);
    map_->search(rays, nearest, meets_);
    map_->still().describe(rays, nearest, rays.wavelength, hits, map_->placements(rays.tick), visit);
  }

  const Map* map_;
  Meets meets_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
