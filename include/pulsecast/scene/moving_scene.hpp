// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_MOVING_SCENE_HPP
#define PULSECAST_SCENE_MOVING_SCENE_HPP

#include <pulsecast/scene/detail/moving_index.hpp>
#include <pulsecast/scene/motion.hpp>
#include <pulsecast/scene/scene.hpp>

namespace PULSECAST_NAMESPACE {

/// Scene with moving parts: `MovingScene<TriangleMesh<>> scene(parts, {.to = 60})`. A pulse meets
/// parts at their pose of its tick. Those without a motion cost as much as in a `Scene`.
template <Geometry... Shapes>
class MovingScene {
 public:
  static constexpr bool time_dependent = true;  ///< hits depend on the tick of a ray

  /// Part of this scene.
  using Part = pulsecast::Part<Shapes...>;

  /// `time` should span the survey and little more: at other times all moving parts are tested;
  /// same hits. `workers` build the indices. @throws SettingError
  MovingScene(std::vector<Part> parts, const MovingIndexSettings& time, const Workers& workers = {})
      : scene_(std::move(parts), Scene<Shapes...>::Motions::left_out, workers),
        movers_(movers(scene_.parts())),
        index_(
            movers_.size(), time,
            [this](auto i, const Tick& from, const Tick& to) { return swept(movers_[i], from, to); },
            [this](PrimitiveIndex i) { return size(movers_[i]); }, workers) {
    bounds_ = scene_.bounds();
    bounds_.extend(index_.bounds());
  }

  /// Bounds of all parts over the time [m].
  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  [[nodiscard]] std::span<const Part> parts() const noexcept { return scene_.parts(); }
  template <class Visitor>
  void visit_materials(const Visitor& visit) const {
    scene_.visit_materials(visit);
  }
  [[nodiscard]] bool deterministic() const noexcept { return scene_.deterministic(); }

  [[nodiscard]] std::size_t memory() const {
    detail::SharedMemorySum<> motions;
    for (const Mover& mover : movers_) {
      const PartMotion* motion = parts()[mover.part].motion.get();
      motions.add(motion, motion->memory());
    }
    return scene_.memory() + index_.memory() + movers_.capacity() * sizeof(Mover) + motions.sum();
  }

  /// Placement of a part at a time.
  [[nodiscard]] Placement placement(std::size_t part, const Tick& tick) const noexcept {
    const Part& moving = parts()[part];
    if (!moving.motion) return moving.placement;
    return moved(mover_of(part), tick);
  }

  /// Nearest hit of each ray of the bundle at its tick. Of parts at one range the first counts.
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    describe(rays, hits, typename Scene<Shapes...>::AskLaws{});
  }
  template <class Visitor>
  void closest(const StaggeredBundle& rays, std::span<Hit> hits, const Visitor& visit) const noexcept {
    describe(rays, hits, visit);
  }

  using TracesSheaves = MovingScene;  ///< as the concept requires
  /// As above, of each ray of a sheaf at its own tick; parts that move are met ray by ray.
  void closest(const detail::RaySheaf& rays, double wavelength, std::span<Hit> hits) const noexcept
      requires(detail::TakesSingleRays<Shapes>&&...) {
    detail::SheafHits nearest(rays);
    search(rays, nearest);
    for (std::size_t j = 0; j < rays.size; ++j)
      scene_.describe(rays.rays[j], nearest.of[j], wavelength, hits.subspan(j, 1), placements(rays.rays[j].tick),
                      typename Scene<Shapes...>::AskLaws{});
  }

  void closest(const RayBundle& rays, ClosestHits& hits) const noexcept { search(rays, hits); }

  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept {
    return (movers_.size() == parts().size() || scene_.misses_cone(cone)) &&
           (movers_.empty() || index_.misses_cone(cone));
  }

  [[nodiscard]] std::optional<RayHit> closest_hit(const Ray& ray) const noexcept {
    return detail::closest_hit(ray, searcher());
  }

  [[nodiscard]] bool occluded(const Ray& ray, double range = detail::infinity) const noexcept {
    return detail::occluded(ray, range, searcher());
  }

  template <class Visitor>
  std::size_t all_hits(const Ray& ray, Visitor&& visitor) const
      noexcept(std::is_nothrow_invocable_v<Visitor&, const RayHit&>) {
    return detail::visit_hits(ray, searcher(), visitor);
  }

  /// Surface at a hit of the same ray at its tick, in the world, with its velocity.
  [[nodiscard]] SurfaceInteraction surface(const RayHit& hit, const Ray& ray) const noexcept {
    const Part& part = parts()[hit.part];
    if (!part.motion) return detail::surface_at(hit, ray, part, part.placement);
    const Mover& mover = mover_of(hit.part);
    SurfaceInteraction point = detail::surface_at(hit, ray, part, moved(mover, ray.tick));
    point.velocity = part.motion->velocity(ray.tick, mover.centre, point.position);
    return point;
  }

  /// Height of the ground at a place [m], as of `Scene`; moving parts are no ground.
  [[nodiscard]] std::optional<double> ground_height(const Vec2& at, double near = detail::infinity) const noexcept {
    return scene_.ground_height(at, near);
  }

 private:
  template <detail::HasParts Map>
  friend class WithoutObject;
  using AnyPart = typename Scene<Shapes...>::AnyPart;

  struct Mover {
    std::size_t part;
    Vec3 centre;  ///< centre of its box as placed [m]
  };

  const Mover& mover_of(std::size_t part) const noexcept {
    const auto before = [&](std::size_t i) noexcept { return movers_[i].part < part; };
    return movers_[detail::first_not(movers_.size(), before)];
  }

  template <class Rays, class Visitor>
  void describe(const Rays& rays, std::span<Hit> hits, const Visitor& visit) const noexcept {
    ClosestHits nearest(rays);
    search(rays, nearest);
    scene_.describe(rays, nearest, rays.wavelength, hits, placements(rays.tick), visit);
  }

  const Scene<Shapes...>& still() const noexcept { return scene_; }
  auto placements(const Tick& tick) const noexcept {
    return [this, &tick](std::size_t part) noexcept { return placement(part, tick); };
  }

  template <class Rays, class Hits, class Meets = AnyPart>
  void search(const Rays& rays, Hits& hits, Meets meets = {}) const noexcept {
    scene_.search(rays, hits, meets);
    if constexpr (std::is_same_v<Rays, detail::RaySheaf>)
      for (std::size_t j = 0; j < rays.size; ++j) search_movers(rays.rays[j], hits.of[j], meets);
    else
      search_movers(rays, hits, meets);
  }
  template <class Rays, class Hits, class Meets>
  void search_movers(const Rays& rays, Hits& hits, Meets meets) const noexcept {
    if (movers_.empty()) return;
    const auto test = [&, meets](PrimitiveIndex i) noexcept {
      const std::size_t part = movers_[i].part;
      if (meets(parts()[part])) scene_.closest_in(part, moved(movers_[i], rays.tick), rays, hits);
    };
    index_.closest(rays, test, hits);
  }
  template <class Meets = AnyPart>
  auto searcher(Meets meets = {}) const noexcept {
    return [this, meets](const SingleRayPacket& ray, auto& hits) noexcept { this->search(ray, hits, meets); };
  }

  static Box bounds_of(const Part& part) noexcept {
    return visit_shape([](const auto& shape) noexcept { return shape->bounds(); }, part.geometry);
  }

  static std::vector<Mover> movers(std::span<const Part> parts) {
    std::vector<Mover> all;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (const Part& part = parts[i]; part.motion) all.push_back({i, part.placement.point(bounds_of(part).centre())});
    all.shrink_to_fit();
    return all;
  }

  Box swept(const Mover& mover, const Tick& from, const Tick& to) const noexcept {
    const Part& part = parts()[mover.part];
    return part.motion->swept(bounds_of(part), part.placement, from, to);
  }

  double size(const Mover& mover) const noexcept {
    const Part& part = parts()[mover.part];
    return max_norm(detail::placed_box(part.placement, bounds_of(part)).size());
  }

  Placement moved(const Mover& mover, const Tick& tick) const noexcept {
    const Part& part = parts()[mover.part];
    const Displacement now = part.motion->at(tick, mover.centre);
    const auto& [rotation, scale, translation] = part.placement;
    return {now.rotation * rotation, scale, now.point(translation)};
  }

  Scene<Shapes...> scene_;     ///< all parts; its index holds the static ones
  std::vector<Mover> movers_;  ///< sorted by index of their part
  MovingIndex index_;
  Box bounds_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
