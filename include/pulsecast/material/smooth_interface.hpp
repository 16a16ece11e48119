// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_SMOOTH_INTERFACE_HPP
#define PULSECAST_MATERIAL_SMOOTH_INTERFACE_HPP

#include <pulsecast/material/medium.hpp>

namespace PULSECAST_NAMESPACE {

/// Kinds of specular reflection and transmission.
enum class InterfaceKind : std::uint8_t {
  none,        ///< not at all
  mirror,      ///< reflects a share of it, at any incidence
  pane,        ///< parallel faces, drawn as one surface: reflects, and transmits shifted
  dielectric,  ///< face of a body of a clear medium: reflects and refracts
  water,       ///< the same, of water
};

/// Surface that reflects or transmits light specularly, for a transport that follows it, such as
/// `LightPaths`; but not what it scatters by `Material::reflectance`, such as dirt on a window.
struct SmoothInterface {
  InterfaceKind kind = InterfaceKind::none;  ///< kind of reflection and transmission
  double reflectance = 0;                    ///< of a mirror: share that it reflects, in [0, 1]
  double thickness = 0;                      ///< of a pane: distance of its faces [m]
  Medium inside{};                           ///< of panes and bodies: medium against the normal

  /// Mirror that reflects a share of the light.
  [[nodiscard]] static SmoothInterface mirror(double reflectance = 0.95) noexcept {
    return {.kind = InterfaceKind::mirror, .reflectance = reflectance};
  }
  /// Pane of clear soda-lime glass of a thickness [m]. Source: Rubin 1985, dispersion, at 1.064 um.
  [[nodiscard]] static SmoothInterface pane(double thickness = 4e-3) noexcept {
    return {.kind = InterfaceKind::pane, .thickness = thickness, .inside = soda_lime};
  }
  /// Face of a body of the same glass.
  [[nodiscard]] static SmoothInterface glass() noexcept {
    return {.kind = InterfaceKind::dielectric, .inside = soda_lime};
  }

  /// Surface of water, such as `water(JerlovType::coastal_1, 532e-9)`. Glint: see `Microfacet`.
  [[nodiscard]] static SmoothInterface water(const Medium& inside = {.index = 1.33}) noexcept {
    return {.kind = InterfaceKind::water, .inside = inside};
  }

  void validate() const {
    require_within("SmoothInterface::reflectance", reflectance, 0, 1, "");
    require_not_negative("SmoothInterface::thickness", thickness, "m");
    inside.validate();
  }

  /// True if the surface reflects or transmits light specularly.
  [[nodiscard]] bool passes_light() const noexcept { return kind != InterfaceKind::none; }
  /// True if coaxial rays that hit a plane of it stay coaxial: mirrors and panes.
  [[nodiscard]] bool keeps_pencils() const noexcept {
    return kind == InterfaceKind::mirror || kind == InterfaceKind::pane;
  }

 private:
  static constexpr Medium soda_lime{.index = 1.5129, .group_index = 1.5271};
};

}  // namespace PULSECAST_NAMESPACE

#endif
