// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_LAYERED_HPP
#define PULSECAST_SCENE_LAYERED_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include <pulsecast/concepts.hpp>
#include <pulsecast/scene/ray_hit.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Target through which light can go on, with surfaces as of a `Scene`.
template <class Map>
concept OpticalLayer = OpticalTarget<Map> && TellsSurfaces<Map>;

template <class Map>
using RayHitOf = std::remove_cvref_t<decltype(*std::declval<const Map&>().closest_hit(std::declval<const Ray&>()))>;

}  // namespace detail

/// Hit of a ray in one of several targets.
template <class... Maps>
struct LayerHit {
  double range = 0;                               ///< distance from the ray's origin [m]
  std::variant<detail::RayHitOf<Maps>...> hit{};  ///< of the target of its index
};

/// Several targets as one: `Layered world{still, moving}`. A ray meets the nearest hit of all; ties go to the first
/// target. Refers to its targets, which must outlive it. A target assigned anew, as by `Scene::with_placements`, is met
/// as it then is.
template <Target First, Target... Others>
class Layered {
  static constexpr bool optical = detail::OpticalLayer<First> && (detail::OpticalLayer<Others> && ...);

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
  /// As above, with the material and normal at each hit. This query and the next three exist if all targets have them:
  /// light goes on there.
  void closest(const StaggeredBundle& rays, std::span<Hit> hits, std::span<HitSurface> surfaces) const noexcept
      requires(optical) {
    std::apply(
        [&](const First* first, const Others*... others) noexcept {
          first->closest(rays, hits, surfaces);
          (add(*others, rays, hits, surfaces), ...);
        },
        targets_);
  }

  /// Closest hit of a ray; empty for a miss.
  [[nodiscard]] std::optional<LayerHit<First, Others...>> closest_hit(Ray ray) const noexcept requires(optical) {
    std::optional<LayerHit<First, Others...>> nearest;
    each([&]<std::size_t i>(const auto& map) noexcept {
      const auto hit = map.closest_hit(ray);
      if (!hit || (nearest && !(hit->range < nearest->range))) return;
      nearest = {hit->range, decltype(nearest->hit)(std::in_place_index<i>, *hit)};
      ray.far = std::min(ray.far, hit->range);
    });
    return nearest;
  }

  /// True if the ray meets anything beyond `ray.near`, up to a range [m] and to `ray.far`.
  [[nodiscard]] bool occluded(const Ray& ray, double range = std::numeric_limits<double>::infinity()) const noexcept
      requires(optical) {
    return std::apply([&](const auto*... targets) noexcept { return (targets->occluded(ray, range) || ...); },
                      targets_);
  }

  /// Surface at a hit of the same ray, in the world. Its `part` is that of the target met.
  [[nodiscard]] SurfaceInteraction surface(const LayerHit<First, Others...>& hit, const Ray& ray) const noexcept
      requires(optical) {
    SurfaceInteraction point;
    each([&]<std::size_t i>(const auto& map) noexcept {
      if (const auto* of = std::get_if<i>(&hit.hit)) point = map.surface(*of, ray);
    });
    return point;
  }

  /// True only if no ray of a cone meets anything in any target.
  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept {
    return std::apply([&](const auto*... targets) noexcept { return (detail::misses_cone(*targets, cone) && ...); },
                      targets_);
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

  /// Height of the ground of the targets at a place that is nearest to a height; by default of the highest [m]. Empty
  /// if none has any.
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
  template <class Map>
  static void add(const Map& map, const RayBundle& rays, std::span<Hit> hits) noexcept {
    alignas(Hit) std::array<std::byte, RayBundle::capacity * sizeof(Hit)>
        memory;  // not initialised, as most bundles have one ray
    const std::span<Hit> others(reinterpret_cast<Hit*>(memory.data()), rays.size);
    find_hits(map, up_to(hits, rays), others);
    for (std::size_t j = 0; j < rays.size; ++j)
      if (is_nearer(others[j], hits[j])) hits[j] = others[j];
  }
  template <class Map>
  static void add(const Map& map, const StaggeredBundle& rays, std::span<Hit> hits,
                  std::span<HitSurface> surfaces) noexcept {
    std::array<Hit, RayBundle::capacity> others;
    std::array<HitSurface, RayBundle::capacity> of_others;
    map.closest(up_to(hits, rays), others, of_others);
    for (std::size_t j = 0; j < rays.size; ++j) {
      if (!is_nearer(others[j], hits[j])) continue;
      hits[j] = others[j];
      surfaces[j] = of_others[j];
    }
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

  /// Calls `visit.operator()<i>(target)` for each target, in order.
  template <class Visitor>
  void each(const Visitor& visit) const noexcept {
    [&]<std::size_t... i>(std::index_sequence<i...>) noexcept {
      (visit.template operator()<i>(*std::get<i>(targets_)), ...);
    }
    (std::index_sequence_for<First, Others...>());
  }

  std::tuple<const First*, const Others*...> targets_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
