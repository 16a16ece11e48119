// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_LAYERED_HPP
#define PULSECAST_SCENE_LAYERED_HPP

#include <tuple>

#include <pulsecast/scene/find_hits.hpp>

namespace PULSECAST_NAMESPACE {

/// Several targets as one: `Layered world{still, moving}`. A ray meets the nearest hit; ties go to
/// the first target. The targets must outlive it; they may be assigned anew.
template <Target First, Target... Others>
class Layered {
  static constexpr bool answers = (SceneQueries<First> && ... && SceneQueries<Others>);

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
  using TracesSheaves = Layered;  ///< as the concept requires
  /// As above, of each ray of a sheaf.
  void closest(const detail::RaySheaf& rays, double wavelength, std::span<Hit> hits) const noexcept
      requires(detail::TracesSheaves<First>&&...&& detail::TracesSheaves<Others>) {
    detail::RaySheaf rest = rays;
    std::array<Hit, detail::RaySheaf::capacity> others;
    each([&](std::uint32_t i, const auto& target) noexcept {
      target.closest(rest, wavelength, i == 0 ? hits : others);
      for (std::size_t j = 0; j < rays.size; ++j) {
        if (i > 0 && is_nearer(others[j], hits[j])) hits[j] = others[j];
        rest.far[j] = std::min(rest.far[j], hits[j].range);
      }
    });
  }
  /// As above, and visits the surfaces. These four exist if all targets have `SceneQueries`.
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

  [[nodiscard]] bool occluded(const Ray& ray, double range = detail::infinity) const noexcept requires(answers) {
    bool any = false;
    each([&](std::uint32_t, const auto& target) noexcept { any = any || target.occluded(ray, range); });
    return any;
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

  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept {
    bool all = true;
    each([&](std::uint32_t, const auto& target) noexcept { all = all && detail::misses_cone(target, cone); });
    return all;
  }

  template <class Visitor>
  void visit_materials(const Visitor& visit) const {
    each([&](std::uint32_t, const auto& target) { detail::visit_materials(target, visit); });
  }

  [[nodiscard]] Box bounds() const noexcept requires(detail::Bounded<First>&&...&& detail::Bounded<Others>) {
    Box all;
    each([&](std::uint32_t, const auto& target) noexcept { all.extend(target.bounds()); });
    return all;
  }

  [[nodiscard]] std::optional<double> ground_height(const Vec2& at, double near = detail::infinity) const noexcept
      requires(detail::FindsGround<First>&&...&& detail::FindsGround<Others>) {
    std::optional<double> best;
    const auto is_better = [&](double a, double b) noexcept {
      return near < detail::infinity ? std::fabs(a - near) < std::fabs(b - near) : a > b;
    };
    each([&](std::uint32_t, const auto& target) noexcept {
      const std::optional<double> height = target.ground_height(at, near);
      if (height && (!best || is_better(*height, *best))) best = height;
    });
    return best;
  }

 private:
  /// Replaces the hits beyond those of a target, which is traced to the farthest of them.
  template <class Target>
  static void add(const Target& target, const RayBundle& rays, std::span<Hit> hits) noexcept {
    // not initialised, as most bundles have one ray
    alignas(Hit) std::array<std::byte, RayBundle::capacity * sizeof(Hit)> memory;
    const std::span<Hit> others(reinterpret_cast<Hit*>(memory.data()), rays.size);
    find_hits(target, up_to(hits, rays), others);
    for (std::size_t j = 0; j < rays.size; ++j)
      if (is_nearer(others[j], hits[j])) hits[j] = others[j];
  }
  template <class Target, class Visitor>
  static void add(const Target& target, const StaggeredBundle& rays, std::span<Hit> hits,
                  const Visitor& visit) noexcept {
    std::array<Hit, RayBundle::capacity> others;
    const auto visit_nearer = [&](std::size_t first, std::size_t end, const auto& surface) noexcept {
      for (std::size_t j = first; j < end; ++j) {
        if (!is_nearer(others[j], hits[j])) continue;
        hits[j] = others[j];
        visit(j, j + 1, surface);
      }
    };
    target.closest(up_to(hits, rays), others, visit_nearer);
  }

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
