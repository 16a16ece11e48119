// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_MATERIAL_HPP
#define PULSECAST_MATERIAL_MATERIAL_HPP

#include <pulsecast/material/image.hpp>
#include <pulsecast/material/smooth_interface.hpp>
#include <pulsecast/material/spectrum.hpp>
#include <pulsecast/material/surface_law.hpp>

namespace PULSECAST_NAMESPACE {

/// Reflectance by texture coordinates, as `ReflectanceMap`.
struct ReflectanceByTexture {
  virtual ~ReflectanceByTexture() = default;
  virtual void validate() const = 0;
  /// Picture that it is read from; null without.
  [[nodiscard]] virtual const Image* picture() const noexcept = 0;
  /// Reflectance at a wavelength [m], where that of the material is `even`.
  [[nodiscard]] virtual double reflectance(double wavelength, Vec2 texture, double even) const noexcept = 0;
};

/// Surface material.
struct Material {
  std::string name = "default";                ///< name in its file or program
  double reflectance = 0.5;                    ///< at the laser's wavelength, in [0, 1]; ignored with a spectrum
  SurfaceLaw law{};                            ///< law of the scattered light; it may ignore the reflectance
  std::uint16_t classification = 0;            ///< ASPRS class of its points
  bool ground = false;                         ///< true if it may carry set-ups and vehicles
  std::shared_ptr<const Spectrum> spectrum{};  ///< reflectance by wavelength; empty: constant
  SmoothInterface smooth{};                    ///< specular light, for a transport that follows it
  Vec3 colour{1, 1, 1};                        ///< of its points: red, green, blue (sRGB), from 0 to 1
  std::shared_ptr<const Image> picture{};      ///< factor of the colour by texture, if any
  std::shared_ptr<const ReflectanceByTexture> reflectance_map{};  ///< reflectance by texture, if any

  void validate() const {
    require_within("Material::reflectance", reflectance, 0, 1, "");
    law.validate();
    require_within("Material::law (share of the light in a retroreflector's cone, and Material::reflectance)",
                   reflectance + law.returned_share(), 0, 1, "");
    smooth.validate();
    for (int k = 0; k < 3; ++k) require_within("Material::colour", colour[k], 0, 1, "");
    if (picture) picture->validate();
    if (reflectance_map) reflectance_map->validate();
    if (smooth.kind == InterfaceKind::mirror)
      require_within("Material::reflectance (with SmoothInterface::reflectance)", reflectance + smooth.reflectance, 0,
                     1, "");
  }

  /// Reflectance at a wavelength [m], a fraction.
  [[nodiscard]] double reflectance_at(double wavelength) const noexcept {
    return spectrum ? spectrum->reflectance(wavelength) : reflectance;
  }
  /// As above, at texture coordinates; at most what the surface neither returns nor mirrors.
  [[nodiscard]] double reflectance_at(double wavelength, const std::optional<Vec2>& texture) const noexcept {
    const double even = reflectance_at(wavelength);
    if (!reflectance_map || !texture) [[likely]]
      return even;
    const double mirrored = smooth.kind == InterfaceKind::mirror ? smooth.reflectance : 0;
    const double taken = law.returned_share() + mirrored;
    return std::min(reflectance_map->reflectance(wavelength, *texture, even), 1 - taken);
  }

  /// Refractive index of the body behind the surface; 1.5 if there is none.
  [[nodiscard]] double index() const noexcept { return smooth.inside.index > 1 ? smooth.inside.index : 1.5; }
  /// Light of a wavelength [m] on the surface, at texture coordinates.
  [[nodiscard]] SurfaceLight light(double wavelength, const std::optional<Vec2>& texture = {}) const noexcept {
    return {wavelength, reflectance_at(wavelength, texture), index()};
  }

  /// Share of the light of a wavelength [m], at a cosine of incidence, that the surface scatters.
  [[nodiscard]] double scattered_share(double wavelength, double cos_incidence,
                                       const std::optional<Vec2>& texture = {}) const noexcept {
    return scattered_share(light(wavelength, texture), cos_incidence);
  }
  /// As above, in a light.
  [[nodiscard]] double scattered_share(const SurfaceLight& in, double cos_incidence) const noexcept {
    return law.model() ? law.model()->scattered_share(cos_incidence, in) : std::min(in.reflectance, 1.0);
  }

  /// Light scattered from one direction towards another, as of a law that `ScattersBetween`; 0 to
  /// and from behind. A normal of zero is that of leaves: they scatter into all directions alike.
  [[nodiscard]] double scattered(const Vec3& from, const Vec3& to, const Vec3& normal, double wavelength,
                                 const std::optional<Vec2>& texture = {}) const noexcept {
    const SurfaceLight in = light(wavelength, texture);
    if (normal == Vec3{}) return scattered_share(in, 1) / 4;
    const double cos_out = dot(to, normal);
    if (!(dot(from, normal) > 0 && cos_out > 0)) return 0;
    return law.model() ? law.model()->scattered(from, to, normal, in) : std::min(in.reflectance, 1.0) * cos_out;
  }

  /// Direction drawn by a law that `SamplesDirections`; empty for others, and for leaves.
  [[nodiscard]] std::optional<SampledDirection> sample(const Vec3& from, const Vec3& normal, double u,
                                                       double v) const noexcept {
    return law.model() && normal != Vec3{} ? law.model()->sample(from, normal, u, v) : std::nullopt;
  }
  /// Backscatter at a cosine of incidence, a wavelength [m] and, for a map, texture coordinates.
  [[nodiscard]] double backscatter(double cos_incidence, double wavelength,
                                   const std::optional<Vec2>& texture = {}) const noexcept {
    const SurfaceLight in = light(wavelength, texture);
    return law.model() ? law.model()->backscatter(cos_incidence, in)
                       : in.reflectance * (law.cosine_share() * cos_incidence + law.even_share());
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
