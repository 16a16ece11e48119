// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_LAYERED_HPP
#define PULSECAST_SCENE_LAYERED_HPP

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>

#include <pulsecast/concepts.hpp>
#include <pulsecast/scene/find_hits.hpp>

namespace PULSECAST_NAMESPACE {

/// Several targets as one: `Layered world{still, moving}`. A ray meets the nearest hit of all; ties
/// go to the first target. Refers to its targets, which must outlive it. A target assigned anew, as
/// by `Scene::with_placements`, is met as it then is.
template <Target First, Target... Others>
class Layered {
  static constexpr bool answers = SceneQueries<First> && (SceneQueries<Others> && ...);

 public:
  /// Refers to the targets.
  explicit Layered(const First& first, const Others&... others) noexcept : targets_(&first, &others...) {}
  template <class... Any>
  requires(sizeof...(Any) == 1 + sizeof...(Others) &&
           !(std::is_lvalue_reference_v<Any> &&
             ...)) explicit Layered(Any&&...) = delete;  // a temporary target would dangle

  /// Nearest hit of each ray of the bundle. A range of NaN is kept.
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    std::apply(
        [&](const First* first, const Others*... others) noexcept {
          find_hits(*first, rays, hits);
          (add(*others, rays, hits), ...);
        },
        targets_);
  }
  /// As above, and visits the surfaces. This query and the next three exist if all targets have `SceneQueries`.
  template <class Visitor>
  requires(answers) void closest(const StaggeredBundle& rays, std::span<Hit> hits,
                                 const Visitor& visit) const noexcept {
    std::apply(
        [&](const First* first, const Others*... others) noexcept {
          first->closest(rays, hits, visit);
          (add(*others, rays, hits, visit), ...);
        },
        targets_);
  }

  /// Closest hit of a ray; empty for a miss.
  [[nodiscard]] std::optional<RayHit> closest_hit(Ray ray) const noexcept requires(answers) {
    std::optional<RayHit> nearest;
    each([&](std::uint32_t i, const auto& target) noexcept {
      const std::optional<RayHit> hit = target.closest_hit(ray);
      if (!hit || (nearest && !(hit->range < nearest->range))) return;
      nearest = hit;
      nearest->layer = hit->layer * size + i;  // a layer may be a `Layered` itself
      ray.far = std::min(ray.far, hit->range);
    });
    return nearest;
  }

  /// True if the ray meets anything beyond `ray.near`, up to a range [m] and to `ray.far`.
  [[nodiscard]] bool occluded(const Ray& ray, double range = std::numeric_limits<double>::infinity()) const noexcept
      requires(answers) {
    return std::apply([&](const auto*... targets) noexcept { return (targets->occluded(ray, range) || ...); },
                      targets_);
  }

  /// Surface at a hit of the same ray, in the world. Its `part` is that of the target hit.
  [[nodiscard]] SurfaceInteraction surface(RayHit hit, const Ray& ray) const noexcept requires(answers) {
    SurfaceInteraction surface;
    const std::uint32_t layer = hit.layer % size;
    hit.layer /= size;
    each([&](std::uint32_t i, const auto& target) noexcept {
      if (i == layer) surface = target.surface(hit, ray);
    });
    return surface;
  }

  /// True only if no ray of a cone meets anything in any target.
  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept {
    return std::apply([&](const auto*... targets) noexcept { return (detail::misses_cone(*targets, cone) && ...); },
                      targets_);
  }

  /// As of a target that `VisitsMaterials`, for targets that do.
  template <class Visitor>
  void visit_materials(const Visitor& visit) const {
    each([&](std::uint32_t, const auto& target) { detail::visit_materials(target, visit); });
  }

  /// Bounds of all targets [m].
  [[nodiscard]] Box bounds() const noexcept requires(requires(const First& f, const Others&... o) {
    f.bounds();
    (o.bounds(), ...);
  }) {
    Box all;
    std::apply([&](const auto*... targets) noexcept { (all.extend(targets->bounds()), ...); }, targets_);
    return all;
  }

  /// Height of the ground of the targets at a place that is nearest to a height; by default of the
  /// highest [m]. Empty if none has any.
  [[nodiscard]] std::optional<double> ground_height(
      const Vec2& at, double near = std::numeric_limits<double>::infinity()) const noexcept
      requires(requires(const First& f, const Others&... o) {
        f.ground_height(at, near);
        (o.ground_height(at, near), ...);
      }) {
    std::optional<double> best;
    const auto is_better = [&](double a, double b) noexcept {
      return near < std::numeric_limits<double>::infinity() ? std::fabs(a - near) < std::fabs(b - near) : a > b;
    };
    const auto take = [&](const std::optional<double>& height) noexcept {
      if (height && (!best || is_better(*height, *best))) best = height;
    };
    std::apply([&](const auto*... targets) noexcept { (take(targets->ground_height(at, near)), ...); }, targets_);
    return best;
  }

 private:
  /// Replaces the hits beyond those of a target, which is traced no farther than the farthest of them.
  template <class Target>
  static void add(const Target& target, const RayBundle& rays, std::span<Hit> hits) noexcept {
    alignas(Hit) std::array<std::byte, RayBundle::capacity * sizeof(Hit)>
        memory;  // not initialised, as most bundles have one ray
    const std::span<Hit> others(reinterpret_cast<Hit*>(memory.data()), rays.size);
    find_hits(target, up_to(hits, rays), others);
    for (std::size_t j = 0; j < rays.size; ++j)
      if (is_nearer(others[j], hits[j])) hits[j] = others[j];
  }
  template <class Target, class Visitor>
  static void add(const Target& target, const StaggeredBundle& rays, std::span<Hit> hits,
                  const Visitor& visit) noexcept {
    std::array<Hit, RayBundle::capacity> others;
    const auto visit_nearer = [&](std::size_t first, std::size_t end, const SurfaceInteraction& surface) noexcept {
      for (std::size_t j = first; j < end; ++j) {
        if (!is_nearer(others[j], hits[j])) continue;
        hits[j] = others[j];
        visit(j, j + 1, surface);
      }
    };
    target.closest(up_to(hits, rays), others, visit_nearer);
  }

  /// Rays as far as the farthest of their hits.
  template <class Rays>
  static Rays up_to(std::span<const Hit> hits, Rays rays) noexcept {
    double farthest = 0;
    for (std::size_t j = 0; j < rays.size; ++j) farthest = std::max(farthest, hits[j].range);
    rays.far = std::min(rays.far, farthest);
    return rays;
  }
  /// True for the nearer hit of a later target; a range of NaN is kept.
  static bool is_nearer(const Hit& other, const Hit& hit) noexcept {
    return !std::isnan(hit.range) && !(other.range >= hit.range);
  }

  /// Calls `visit(i, target)` for each target, in order.
  template <class Visitor>
  void each(const Visitor& visit) const {
    std::uint32_t i = 0;
    std::apply([&](const auto*... targets) { (visit(i++, *targets), ...); }, targets_);
  }

  static constexpr std::uint32_t size = 1 + sizeof...(Others);
  std::tuple<const First*, const Others*...> targets_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
