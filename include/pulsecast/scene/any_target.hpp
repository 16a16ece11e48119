// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_ANY_TARGET_HPP
#define PULSECAST_SCENE_ANY_TARGET_HPP

#include <variant>

#include <pulsecast/scene/find_hits.hpp>

namespace PULSECAST_NAMESPACE {

/// Scan target of one of several types, for maps chosen at run time: `AnyTarget<Scene<HeightField>,
/// MovingScene<TriangleMesh<>>>`. Holds its target by value, and must outlive the survey as any
/// map. `AnyTarget<Layered<Map>, ...>` refers to a map instead, as `Layered` does.
template <Target First, Target... Others>
class AnyTarget {
  static constexpr bool answers = (SceneQueries<First> && ... && SceneQueries<Others>);

 public:
  /// Takes a target of one of the types.
  template <class Target>
  requires std::constructible_from<std::variant<First, Others...>, Target> AnyTarget(Target target)
      : target_(std::move(target)) {}  // NOLINT: implicit by purpose

  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    ask([&](const auto& target) noexcept { find_hits(target, rays, hits); });
  }

  /// As above, and visits the surfaces. These four exist if all types have `SceneQueries`.
  template <class Visitor>
  requires(answers) void closest(const StaggeredBundle& rays, std::span<Hit> hits,
                                 const Visitor& visit) const noexcept {
    ask([&](const auto& target) noexcept { target.closest(rays, hits, visit); });
  }

  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept {
    return ask([&](const auto& target) noexcept { return detail::misses_cone(target, cone); });
  }

  [[nodiscard]] std::optional<RayHit> closest_hit(const Ray& ray) const noexcept requires(answers) {
    return ask([&](const auto& target) noexcept { return target.closest_hit(ray); });
  }
  [[nodiscard]] bool occluded(const Ray& ray, double range = detail::infinity) const noexcept requires(answers) {
    return ask([&](const auto& target) noexcept { return target.occluded(ray, range); });
  }
  /// Calls `visitor(hit)` with every `RayHit` of a ray, as `Scene::all_hits`. Returns their number.
  template <class Visitor>
  requires(answers) std::size_t all_hits(const Ray& ray, Visitor&& visitor)
  const noexcept(std::is_nothrow_invocable_v<Visitor&, const RayHit&>) {
    return ask([&](const auto& target) { return target.all_hits(ray, visitor); });
  }
  [[nodiscard]] SurfaceInteraction surface(const RayHit& hit, const Ray& ray) const noexcept requires(answers) {
    return ask([&](const auto& target) noexcept { return target.surface(hit, ray); });
  }

  template <class Visitor>
  void visit_materials(const Visitor& visit) const {
    ask([&](const auto& target) { detail::visit_materials(target, visit); });
  }

  [[nodiscard]] Box bounds() const noexcept requires(detail::Bounded<First>&&...&& detail::Bounded<Others>) {
    return ask([](const auto& target) noexcept -> Box { return target.bounds(); });
  }

  [[nodiscard]] std::optional<double> ground_height(const Vec2& at, double near = detail::infinity) const noexcept
      requires(detail::FindsGround<First>&&...&& detail::FindsGround<Others>) {
    return ask([&](const auto& target) noexcept { return target.ground_height(at, near); });
  }

 private:
  decltype(auto) ask(const auto& question) const { return std::visit(question, target_); }

  std::variant<First, Others...> target_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
