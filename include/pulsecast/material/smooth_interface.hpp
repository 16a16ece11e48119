// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_SMOOTH_INTERFACE_HPP
#define PULSECAST_MATERIAL_SMOOTH_INTERFACE_HPP

#include <pulsecast/base/require.hpp>
#include <pulsecast/material/medium.hpp>

namespace PULSECAST_NAMESPACE {

/// Ways in which a smooth surface passes light on.
enum class InterfaceKind : std::uint8_t {
  none,        ///< not at all
  mirror,      ///< reflects a share of it, at any incidence
  pane,        ///< plate with two parallel faces, drawn as one surface: reflects light, and lets it through, shifted
  dielectric,  ///< face of a body of glass or another clear medium: reflects and refracts
  water,       ///< the same, of water
};

/// Smooth surface that passes light on, for a transport that follows it, as `LightPaths`. What the surface scatters
/// itself, by `Material::reflectance`, as dirt on a window does, is neither reflected nor let through.
struct SmoothInterface {
  InterfaceKind kind = InterfaceKind::none;  ///< way in which light is passed on
  double reflectance = 0;                    ///< of a mirror: share of the light that it reflects, in [0, 1]
  double thickness = 0;                      ///< of a pane: distance of its faces [m]
  Medium inside{};                           ///< of panes and bodies: medium behind the surface, against its normal

  /// Mirror that reflects a share of the light.
  [[nodiscard]] static SmoothInterface mirror(double reflectance = 0.95) noexcept {
    return {.kind = InterfaceKind::mirror, .reflectance = reflectance};
  }
  /// Pane of clear soda-lime glass of a thickness [m]. Source: dispersion formula of Rubin 1985, at 1.064 um.
  [[nodiscard]] static SmoothInterface pane(double thickness = 4e-3) noexcept {
    return {.kind = InterfaceKind::pane, .thickness = thickness, .inside = soda_lime};
  }
  /// Face of a body of the same glass.
  [[nodiscard]] static SmoothInterface glass() noexcept {
    return {.kind = InterfaceKind::dielectric, .inside = soda_lime};
  }

  /// Surface of water of a kind, as of `water(JerlovType::coastal_1, 532e-9)`. For the glint of waves that the scene
  /// has not, and foam, see `Scattering::microfacet` and `Material::reflectance`.
  [[nodiscard]] static SmoothInterface water(const Medium& inside = {.index = 1.33}) noexcept {
    return {.kind = InterfaceKind::water, .inside = inside};
  }

  void validate() const {
    require_within("SmoothInterface::reflectance", reflectance, 0, 1, "");
    require_not_negative("SmoothInterface::thickness", thickness, "m");
    inside.validate();
  }

  /// True if light goes on from the surface.
  [[nodiscard]] bool passes_light() const noexcept { return kind != InterfaceKind::none; }
  /// True if all rays of a pencil that meet a plane of it go on as a pencil: mirrors and panes.
  [[nodiscard]] bool keeps_pencils() const noexcept {
    return kind == InterfaceKind::mirror || kind == InterfaceKind::pane;
  }

 private:
  static constexpr Medium soda_lime{.index = 1.5129, .group_index = 1.5271};
};

}  // namespace PULSECAST_NAMESPACE

#endif
