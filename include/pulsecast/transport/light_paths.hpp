// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_LIGHT_PATHS_HPP
#define PULSECAST_TRANSPORT_LIGHT_PATHS_HPP

#include <pulsecast/transport/detail/path_tracer.hpp>
#include <pulsecast/transport/detail/plane_spread.hpp>

namespace PULSECAST_NAMESPACE {

/// Transport of light that goes on from smooth surfaces, by `Material::smooth`: `Survey{platform,
/// footprint, scene, LightPaths{}, receiver, detector}`. Every surface on its way sends light back
/// along the same way, reported along the beam, at half the optical path.
///
/// A scene without such surfaces gives the reflections of `DirectLight`, bit for bit. In the
/// ledger, a surface's share of the light is scattered, and the rest is absorbed.
///
/// Plane mirrors and panes pass subrays on together; bodies refract them one by one. Light spreads
/// by the plane that each ray meets. Left out: polarisation, interference, diffraction.
struct LightPaths {
  std::size_t passages = 8;         ///< most surfaces that pass light on, from 0 to 32
  double share_min = 1e-4;          ///< least share of a subray's light that is followed, one way
  bool spread_planes = true;        ///< as in `DirectLight`
  MultipleScattering scattering{};  ///< light that surfaces scatter to and fro
  Media air{};                      ///< media in the air
  /// Number of stretches, beside whole cells, that media in the air, and bodies, send back exactly,
  /// from 4 to 1e6: the ends of more are blurred by a twelfth of their range.
  std::size_t volume_cells = 8192;

  void validate() const {
    require_within("LightPaths::passages", passages, 0, 32, "");
    require_within("LightPaths::share_min", share_min, 0, 1, "");
    scattering.validate();
    require_within("LightPaths::volume_cells", volume_cells, 4, 1e6, "");
  }

  /// Refuses laws that are no `ScattersBetween`, for light to and fro. @throws SettingError
  template <SceneQueries Target>
  void validate(const Target& target) const {
    if (scattering.orders == 1) return;
    detail::visit_materials(target, [&](const Material& material) {
      if (!material.law.scatters_between())
        throw SettingError(
            "MultipleScattering::orders",
            text::joined({" above 1 need laws with scattered(in, out, normal, wavelength), which material '",
                          material.name, "' has not"}));
    });
  }

  using Workspace = detail::PathWorkspace;  ///< scratch memory of one worker

  /// Room for the reflections of a pulse. Light of further ones is counted as cut.
  [[nodiscard]] std::size_t reflections(std::size_t subrays) const noexcept {
    constexpr double expected = detail::BeamParticles::most;
    const std::size_t particles = air.has_particles() ? static_cast<std::size_t>(1.2 * expected) : 0;
    const std::size_t most = subrays * (2 * passages + 1) + scattering.reflections() + particles;
    return spreads(subrays) ? most + slope_subrays_max : most;
  }
  [[nodiscard]] Workspace workspace(std::size_t subrays) const {
    return {passages, volume_cells, spreads(subrays) ? SubrayDirections::room(slope_subrays_max) : SubrayDirections()};
  }

  /// Follows all subrays. Sets velocities, too, if `with_velocity`.
  template <bool with_velocity = false, SceneQueries Target>
  [[nodiscard]] TransportResult trace(const Target& target, const TransportInput& light, Workspace& w,
                                      std::span<Reflection> reflections) const noexcept {
    TransportResult result;
    detail::PathTracer<with_velocity, Target> tracer(target, light, *this, w, reflections, result);
    tracer.trace();
    if (!with_velocity && spreads(light.subrays) && !tracer.passed_on()) {
      const auto direct = detail::direct_ones(reflections.first(result.reflections));
      if (const double span = span_of_ranges(light, direct); span > 1)
        spread_over_plane(light, span, reflections, w.slope, result, [&](const TransportInput& again) noexcept {
          TransportResult other;
          detail::PathTracer<with_velocity, Target>(target, again, *this, w, reflections, other).trace();
          return other;
        });
    }
    return result;
  }

 private:
  [[nodiscard]] bool spreads(std::size_t subrays) const noexcept { return spread_planes && subrays > 2; }
};

}  // namespace PULSECAST_NAMESPACE

#endif
