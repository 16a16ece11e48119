// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_ANY_TARGET_HPP
#define PULSECAST_SCENE_ANY_TARGET_HPP

#include <type_traits>
#include <variant>

#include <pulsecast/concepts.hpp>
#include <pulsecast/scene/find_hits.hpp>

namespace PULSECAST_NAMESPACE {

/// Scan target of one of several types, for maps chosen at run time: `AnyTarget<Scene<HeightField>,
/// MovingScene<TriangleMesh<>>>`. Holds its target by value, and must outlive the survey as any map
/// must. `AnyTarget<Layered<Map>, ...>` refers to a map instead, as `Layered` does.
template <Target First, Target... Others>
class AnyTarget {
  static constexpr bool answers = SceneQueries<First> && (SceneQueries<Others> && ...);

 public:
  /// Takes a target of one of the types.
  template <class Target>
  requires std::constructible_from<std::variant<First, Others...>, Target> AnyTarget(Target target)
      : target_(std::move(target)) {}  // NOLINT(google-explicit-constructor): implicit by purpose

  /// Nearest hit of each ray of the bundle, as of the target.
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    std::visit([&](const auto& target) noexcept { find_hits(target, rays, hits); }, target_);
  }

  /// As above, and visits the surfaces. This query and the next three exist if all types have `SceneQueries`.
  template <class Visitor>
  requires(answers) void closest(const StaggeredBundle& rays, std::span<Hit> hits,
                                 const Visitor& visit) const noexcept {
    std::visit([&](const auto& target) noexcept { target.closest(rays, hits, visit); }, target_);
  }

  /// True only if no ray of a cone meets anything, as of the target; false of a target that cannot tell.
  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept {
    return std::visit([&](const auto& target) noexcept { return detail::misses_cone(target, cone); }, target_);
  }

  /// Closest hit of a ray; empty for a miss.
  [[nodiscard]] std::optional<RayHit> closest_hit(const Ray& ray) const noexcept requires(answers) {
    return std::visit([&](const auto& target) noexcept { return target.closest_hit(ray); }, target_);
  }
  /// True if the ray meets anything beyond `ray.near`, up to a range [m] and to `ray.far`.
  [[nodiscard]] bool occluded(const Ray& ray, double range = std::numeric_limits<double>::infinity()) const noexcept
      requires(answers) {
    return std::visit([&](const auto& target) noexcept { return target.occluded(ray, range); }, target_);
  }
  /// Calls `visitor(hit)` with every `RayHit` of a ray, as `Scene::all_hits`. Returns the number of calls.
  template <class Visitor>
  requires(answers) std::size_t all_hits(const Ray& ray, Visitor&& visitor)
  const noexcept(std::is_nothrow_invocable_v<Visitor&, const RayHit&>) {
    return std::visit([&](const auto& target) { return target.all_hits(ray, visitor); }, target_);
  }
  /// Surface at a hit of the same ray, in the world.
  [[nodiscard]] SurfaceInteraction surface(const RayHit& hit, const Ray& ray) const noexcept requires(answers) {
    return std::visit([&](const auto& target) noexcept { return target.surface(hit, ray); }, target_);
  }

  /// As of a target that `VisitsMaterials`, if it does.
  template <class Visitor>
  void visit_materials(const Visitor& visit) const {
    std::visit([&](const auto& target) { detail::visit_materials(target, visit); }, target_);
  }

  /// Bounds of the target [m].
  [[nodiscard]] Box bounds() const noexcept requires(requires(const First& f, const Others&... o) {
    f.bounds();
    (o.bounds(), ...);
  }) {
    return std::visit([](const auto& target) noexcept -> Box { return target.bounds(); }, target_);
  }

  /// Height of the ground of the target at a place that is nearest to a height; by default of the
  /// highest [m]. Empty if there is none.
  [[nodiscard]] std::optional<double> ground_height(
      const Vec2& at, double near = std::numeric_limits<double>::infinity()) const noexcept
      requires(requires(const First& f, const Others&... o) {
        f.ground_height(at, near);
        (o.ground_height(at, near), ...);
      }) {
    return std::visit([&](const auto& target) noexcept { return target.ground_height(at, near); }, target_);
  }

 private:
  std::variant<First, Others...> target_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
