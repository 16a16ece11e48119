// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_LAYERED_HPP
#define PULSECAST_SCENE_LAYERED_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Several targets as one: `Layered world{still, moving}`. A ray meets the nearest hit of all; ties go to the first target. Refers to its
/// targets, which must outlive it. A target assigned anew, as by `Scene::with_placements`, is met as it then is.
template <Target First, Target... Others>
class Layered {
 public:
  /// Refers to the targets.
  explicit Layered(const First& first, const Others&... others) noexcept : targets_(&first, &others...) {}
  template <class... Any>
  requires(sizeof...(Any) == 1 + sizeof...(Others) &&
           !(std::is_lvalue_reference_v<Any> && ...)) explicit Layered(Any&&...) = delete;  // a temporary target would dangle

  /// Nearest hit of each ray of the bundle. A range of NaN is kept.
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    std::apply(
        [&](const First* first, const Others*... others) noexcept {
          find_hits(*first, rays, hits);
          (add(*others, rays, hits), ...);
        },
        targets_);
  }

  /// True only if no ray of a cone meets anything in any target.
  [[nodiscard]] bool misses_cone(const RayCone& cone) const noexcept {
    return std::apply([&](const auto*... targets) noexcept { return (detail::misses_cone(*targets, cone) && ...); }, targets_);
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

  /// Height of the highest ground of the targets at a place [m]; empty if none has any.
  [[nodiscard]] std::optional<double> ground_height(const Vec2& at) const noexcept requires(requires(const First& f, const Others&... o) {
    f.ground_height(at);
    (o.ground_height(at), ...);
  }) {
    std::optional<double> highest;
    const auto raise = [&](const std::optional<double>& height) noexcept {
      if (height && !(highest >= height)) highest = height;
    };
    std::apply([&](const auto*... targets) noexcept { (raise(targets->ground_height(at)), ...); }, targets_);
    return highest;
  }

 private:
  /// Replaces the hits beyond those of a target, which is traced no farther than the farthest of them.
  template <class Map>
  static void add(const Map& map, const RayBundle& rays, std::span<Hit> hits) noexcept {
    RayBundle shortened = rays;
    double farthest = 0;
    for (std::size_t j = 0; j < rays.size; ++j) farthest = std::max(farthest, hits[j].range);
    shortened.far = std::min(rays.far, farthest);
    std::array<Hit, RayBundle::capacity> others;
    find_hits(map, shortened, others);
    for (std::size_t j = 0; j < rays.size; ++j)
      if (!std::isnan(hits[j].range) && !(others[j].range >= hits[j].range)) hits[j] = others[j];
  }

  std::tuple<const First*, const Others*...> targets_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
