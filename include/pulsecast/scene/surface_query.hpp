// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_SURFACE_QUERY_HPP
#define PULSECAST_SCENE_SURFACE_QUERY_HPP

#include <functional>

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Surface that an echo of a batch came from: normal, part, material, velocity. Empty if unknown.
using SurfaceQuery = std::function<std::optional<SurfaceInteraction>(const EchoBatch&, const Shot&, const Echo&)>;

/// Uncertainty of an echo, as of `uncertainty_of`.
using UncertaintyQuery = std::function<PointUncertainty(const Shot&, const Echo&)>;

/// Query of the surfaces of a world, which must outlive it, by one more ray per echo. The ray
/// follows the pulse's axis, or of a footprint `WithSubrayRecord` the subray whose hit has the
/// echo's labels and is nearest to it in range. The surface is the first of the echo's object and
/// class that it meets within `tolerance` [m] of the echo's range; unknown for light by way of
/// mirrors, if the axis meets nothing, or if errors of range or pose exceed the tolerance. A part
/// placed anew for each moment has no velocity: wrap the query to set it. @throws SettingError
template <SceneQueries World>
[[nodiscard]] SurfaceQuery surfaces_of(const World& world, double tolerance = 0.2) {
  require_positive("surfaces_of (tolerance)", tolerance, "m");
  return [&world, tolerance](const EchoBatch& batch, const Shot& shot,
                             const Echo& echo) -> std::optional<SurfaceInteraction> {
    const auto is_same = [&echo](const auto& other) noexcept {
      return other.object == echo.object && other.classification == echo.classification;
    };
    Ray ray{.origin = shot.origin, .direction = shot.direction, .tick = shot.tick, .pulse = shot.index};
    double range = echo.range, least = detail::infinity;
    if (!batch.subrays.empty())
      for (const SubrayRecord& subray : batch.subrays_of(static_cast<std::size_t>(&shot - batch.shots.data()))) {
        const double off = std::fabs(subray.range - echo.range);
        if (!is_same(subray) || !(off < least)) continue;
        const Vec3 way = subray.point - shot.origin;
        least = off;
        range = length(way);
        ray.direction = range > 0 ? way / range : shot.direction;
      }
    ray.near = std::max(0.0, range - tolerance);
    ray.far = range + tolerance;
    constexpr int max_surfaces = 16;  // of other objects in the window, one behind another
    for (int n = 0; n < max_surfaces; ++n) {
      const auto hit = world.closest_hit(ray);
      if (!hit) break;
      const SurfaceInteraction surface = world.surface(*hit, ray);
      if (is_same(surface)) return surface;
      ray.near = std::nextafter(hit->range, detail::infinity);
    }
    return std::nullopt;
  };
}

}  // namespace PULSECAST_NAMESPACE

#endif
