// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_MATERIAL_HPP
#define PULSECAST_MATERIAL_MATERIAL_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <pulsecast/base/exponential.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/search.hpp>
#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/base/simd.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/base/vector_math.hpp>
#include <pulsecast/material/image.hpp>
#include <pulsecast/material/microfacet.hpp>
#include <pulsecast/material/reflectance_map.hpp>
#include <pulsecast/material/smooth_interface.hpp>
#include <pulsecast/material/spectrum.hpp>

namespace PULSECAST_NAMESPACE {

/// Angular law of the light that a surface scatters back to its source.
enum class Scattering : std::uint8_t {
  lambert,  ///< proportional to the cosine of incidence
  phong,    ///< Lambert and a specular lobe that is as high as a white Lambertian surface, whatever its exponent
  direction_independent,  ///< equal at any incidence
  normalized_phong,  ///< Lambert and a specular lobe that holds its share of the energy. Source: Lafortune & Willems
                     ///< 1994
  retroreflective,   ///< Lambert and light that returns to its source, as of sheeting and road marks
  tabulated,         ///< as measured, by `Material::backscatter_table`
  microfacet,        ///< light reflected by rough facets, and Lambert of the rest: varnish, wet ground, rippled water
};

/// How what a retroreflector returns falls with the entrance angle.
enum class RetroreflectorKind : std::uint8_t {
  beads,        ///< as a power of the cosine, by `Material::retroreflection_half_angle`: glass beads
  cube_corner,  ///< by the open area of three mirrors, and none beyond 35.3 degrees: hollow cube corners
  prisms,       ///< the same, with the angle inside glass by Snell's law: cube corners of glass, and prismatic sheeting
};

/// Row of a table of backscatter.
struct BackscatterAtIncidence {
  double incidence = 0;    ///< angle between light and normal, from 0 to pi/2 [rad]
  double backscatter = 0;  ///< by that of a white Lambertian surface at normal incidence, per unit of the reflectance
};

struct Material;

/// Backscatter of a material at one wavelength, by the cosine of incidence.
/// Source: Jutzi & Gross 2009; the lobe is about the mirror direction, twice the incidence away, and ends at 90
/// degrees.
struct Backscatter {
  double reflectance = 0;  ///< a fraction, split into the three shares below
  double even = 0, cosine = 0,
         lobe = 0;  ///< shares: isotropic; Lambertian; specular lobe, or a negative number for a lobe of `material`
  union {
    double exponent = 0;       ///< exponent of the lobe
    const Material* material;  ///< material whose lobe is another than Phong's
  };

  /// Backscatter towards the source at a cosine of incidence in [0, 1].
  [[nodiscard]] double operator()(double cos_incidence) const noexcept {
    return lobe == 0 ? reflectance * rough(cos_incidence) : glossy(simd::Doubles{} + cos_incidence)[0];
  }

  /// Angular law of the shares without the lobe.
  [[nodiscard]] double rough(double cos_incidence) const noexcept { return cosine * cos_incidence + even; }

  /// Backscatter with the lobe, by lane. Error of the lobe at most 1e-14 of `lobe`.
  [[nodiscard, gnu::always_inline]] simd::Doubles glossy(const simd::Doubles& cos_incidence) const noexcept {
    if (lobe < 0) [[unlikely]]
      return with_other_lobe(cos_incidence);
    const simd::Doubles cos_to_mirror = 2 * cos_incidence * cos_incidence - 1;
    return reflectance * (cosine * cos_incidence + even + lobe * positive_power(cos_to_mirror, exponent));
  }

 private:
  /// Power of the positive lanes; 0 of others.
  [[nodiscard, gnu::always_inline]] static simd::Doubles positive_power(const simd::Doubles& base,
                                                                        double exponent) noexcept {
    const simd::Doubles power = exponent <= 64 && exponent == static_cast<unsigned>(exponent)
                                    ? simd::whole_power(base, static_cast<unsigned>(exponent))
                                    : exponential(simd::Doubles(exponent * simd::detail::log_of_normal(base)));
    return base > 0 ? power : simd::Doubles{};
  }

  [[nodiscard]] simd::Doubles with_other_lobe(const simd::Doubles& cos_incidence) const noexcept;
};

/// Surface material.
struct Material {
  std::string name = "default";  ///< name in its file or program
  double reflectance = 0.5;      ///< reflectance at the laser's wavelength, in [0, 1]; ignored with a spectrum
  Scattering scattering = Scattering::lambert;  ///< angular law
  double specular_share = 0;                    ///< share of the reflectance in the lobe of Phong's laws, in [0, 1]
  double specular_exponent = 10;                ///< exponent of that lobe, at least 0
  /// Coefficient of retroreflection R_A, for light along the normal, at most 1e6 [cd/(lx m^2)]. That of a white
  /// Lambertian surface is 1/pi; beaded sheeting has some 70, prismatic 300 to 1,000. The budget holds from a few
  /// apertures' diameters on. Source: ASTM E808, CIE 54.2.
  double retroreflection = 0;
  double retroreflection_half_angle =
      pi / 6;  ///< entrance angle at which backscatter has fallen to half, from 0.01 to 1.5 [rad]
  RetroreflectorKind retroreflector = RetroreflectorKind::beads;  ///< law by entrance angle
  double retroreflection_index = 1.5;                             ///< refractive index of prisms, from 1 to 4
  /// Half angle at 1/e^2 of the light that returns, from 0 to 0.1; 0: wide against the aperture, and its energy is not
  /// told [rad].
  double retroreflection_width = 0;
  double roughness = 0.3;  ///< of `Scattering::microfacet`: root mean square slope of the facets, from 1e-3 to 2
  /// Backscatter by incidence for `Scattering::tabulated`: linear between rows, constant beyond them; angles ascend.
  SharedArray<BackscatterAtIncidence> backscatter_table{};
  std::uint16_t classification = 0;  ///< ASPRS class of its points
  bool ground = false;               ///< true if it may carry set-ups and vehicles
  std::shared_ptr<const Spectrum>
      spectrum{};            ///< reflectance by wavelength, shareable; empty for a constant reflectance
  SmoothInterface smooth{};  ///< light that goes on from it, for a transport that follows it
  Vec3 colour{1, 1, 1};      ///< red, green and blue of its points, as displays take them (sRGB), each from 0 to 1
  std::shared_ptr<const Image> picture{};  ///< what the colour is multiplied by, by texture coordinates; empty without
  std::shared_ptr<const ReflectanceMap> reflectance_map{};  ///< reflectance by texture coordinates; empty without

  /// @throws SettingError for values out of range
  void validate() const {
    require_within("Material::reflectance", reflectance, 0, 1, "");
    require_within("Material::specular_share", specular_share, 0, 1, "");
    require_not_negative("Material::specular_exponent", specular_exponent, "");
    require_within("Material::retroreflection", retroreflection, 0, 1e6, "cd/(lx m^2)");
    require_within("Material::retroreflection_index", retroreflection_index, 1, 4, "");
    require_within("Material::retroreflection_width", retroreflection_width, 0, 0.1, "rad");
    require_within("Material::retroreflection (share of the light in its width, and Material::reflectance)",
                   reflectance + retroreflected_share(), 0, 1, "");
    require_within("Material::roughness", roughness, 1e-3, 2, "");
    require_within("Material::retroreflection_half_angle", retroreflection_half_angle, 0.01, 1.5, "rad");
    smooth.validate();
    for (int k = 0; k < 3; ++k) require_within("Material::colour", colour[k], 0, 1, "");
    if (picture) picture->validate();
    if (reflectance_map) reflectance_map->validate();
    if (smooth.kind == InterfaceKind::mirror)
      require_within("Material::reflectance (with SmoothInterface::reflectance)", reflectance + smooth.reflectance, 0,
                     1, "");
    if (scattering == Scattering::tabulated)
      require_within("Material::backscatter_table (rows)", static_cast<double>(backscatter_table.size()), 1, 1e6, "");
    for (std::size_t i = 0; i < backscatter_table.size(); ++i) {
      require_within("Material::backscatter_table (incidence)", backscatter_table[i].incidence, 0, pi / 2 * (1 + 1e-6),
                     "rad");
      require_not_negative("Material::backscatter_table (backscatter)", backscatter_table[i].backscatter, "");
      if (i > 0)
        require_positive("Material::backscatter_table (from incidence to incidence)",
                         backscatter_table[i].incidence - backscatter_table[i - 1].incidence, "rad");
    }
  }

  /// Reflectance at a wavelength [m], a fraction.
  [[nodiscard]] double reflectance_at(double wavelength) const noexcept {
    return spectrum ? spectrum->reflectance(wavelength) : reflectance;
  }
  /// As above, at texture coordinates. A map tells no more than what the surface does not return or mirror otherwise.
  [[nodiscard]] double reflectance_at(double wavelength, const std::optional<Vec2>& texture) const noexcept {
    const double even = reflectance_at(wavelength);
    if (!reflectance_map || !texture) [[likely]]
      return even;
    const double taken = retroreflected_share() + (smooth.kind == InterfaceKind::mirror ? smooth.reflectance : 0);
    return std::min(reflectance_map->reflectance(wavelength, *texture, even), 1 - taken);
  }

  /// Share of the light of a wavelength [m], at a cosine of incidence, that the surface scatters, as an energy ledger
  /// counts it.
  [[nodiscard]] double scattered_share(double wavelength, double cos_incidence,
                                       const std::optional<Vec2>& texture = {}) const noexcept {
    return scattered_share(wavelength, cos_incidence, texture, facets().index);
  }
  /// As above, with the index behind the surface by that before it.
  [[nodiscard]] double scattered_share(double wavelength, double cos_incidence, const std::optional<Vec2>& texture,
                                       double relative_index) const noexcept {
    const double rest = std::min(std::min(reflectance_at(wavelength, texture), 1.0) + retroreflected_share(), 1.0);
    if (scattering != Scattering::microfacet) return rest;
    const double by_facets = fresnel_split(cos_incidence, relative_index).reflected;
    return by_facets + (1 - by_facets) * rest;
  }
  /// Share of the light along the normal that a retroreflector returns within its width.
  [[nodiscard]] double retroreflected_share() const noexcept {
    return scattering == Scattering::retroreflective
               ? retroreflection * pi / 2 * retroreflection_width * retroreflection_width
               : 0;
  }
  /// Facets of `Scattering::microfacet`, of the index of `smooth`.
  [[nodiscard]] Microfacets facets() const noexcept {
    return {roughness, smooth.inside.index > 1 ? smooth.inside.index : 1.5};
  }
  /// Light scattered from one direction towards another, by that of a white Lambertian surface towards its normal: for
  /// light that goes on from surface to surface, with the Lambertian law for those that are known towards the source
  /// alone. Unit vectors away from the surface; a normal of zero is that of leaves, which scatter into all directions
  /// alike.
  [[nodiscard]] double scattered(const Vec3& from, const Vec3& to, const Vec3& normal, double wavelength,
                                 const std::optional<Vec2>& texture = {}) const noexcept {
    const double diffuse = std::min(reflectance_at(wavelength, texture), 1.0);
    if (normal == Vec3{}) return diffuse / 4;
    const double in = dot(from, normal), out = dot(to, normal);
    if (!(in > 0 && out > 0)) return 0;
    if (scattering != Scattering::microfacet) return diffuse * out;
    const Microfacets rough = facets();
    return pi * rough.scattered(from, to, normal) + (1 - rough.reflected(in)) * diffuse * out;
  }
  /// Light that a retroreflector returns at a cosine of the entrance angle, by that along the normal. Source: open area
  /// of a round cube corner, Chang, Currie, Alley & Pittman 1971, as in Degnan 1993.
  [[nodiscard]] double returned(double cosine) const noexcept {
    if (!(cosine > 0)) return 0;
    if (retroreflector == RetroreflectorKind::beads)
      return std::pow(cosine, std::log(0.5) / std::log(std::cos(retroreflection_half_angle)));
    const double n = retroreflector == RetroreflectorKind::prisms ? retroreflection_index : 1,
                 sine2 = (1 - cosine * cosine) / (n * n);
    const double tangent2 = sine2 / (1 - sine2), open = 1 - 2 * tangent2;
    if (!(open > 0)) return 0;
    return 2 / pi * cosine * (std::asin(std::sqrt(open)) - std::sqrt(2 * tangent2 * open));
  }

  /// Reflectance times the angular law, at a wavelength [m] and, for a map, at texture coordinates.
  [[nodiscard]] Backscatter backscatter(double wavelength, const std::optional<Vec2>& texture = {}) const noexcept {
    Backscatter all{.reflectance = reflectance_at(wavelength, texture), .exponent = 0};
    switch (scattering) {
      case Scattering::lambert:
        all.cosine = 1;
        break;
      case Scattering::phong:
        all.cosine = 1 - specular_share;
        all.lobe = specular_share;
        all.exponent = specular_exponent;
        break;
      case Scattering::direction_independent:
        all.even = 1;
        break;
      default:
        all.lobe = -1;
        all.material = this;
    }
    return all;
  }

  /// Backscatter at a cosine of incidence and a wavelength [m].
  [[nodiscard]] double backscatter(double cos_incidence, double wavelength) const noexcept {
    return backscatter(wavelength)(cos_incidence);
  }
};

[[gnu::noinline]] inline simd::Doubles Backscatter::with_other_lobe(const simd::Doubles& cos_incidence) const noexcept {
  const Material& m = *material;
  const simd::Doubles cos_to_mirror = 2 * cos_incidence * cos_incidence - 1;
  if (m.scattering == Scattering::normalized_phong) {
    const double height = m.specular_share * (m.specular_exponent + 2) / 2;
    return reflectance * cos_incidence *
           (1 - m.specular_share + height * positive_power(cos_to_mirror, m.specular_exponent));
  }
  if (m.scattering == Scattering::retroreflective) {
    return reflectance * cos_incidence +
           pi * m.retroreflection * simd::generate([&](std::size_t lane) { return m.returned(cos_incidence[lane]); });
  }
  if (m.scattering == Scattering::microfacet) {
    const Microfacets facets = m.facets();
    return simd::generate([&](std::size_t lane) {
      const double at = cos_incidence[lane];
      return facets.backscatter(at) + (1 - facets.reflected(at)) * reflectance * at;
    });
  }
  if (m.backscatter_table.empty()) return simd::Doubles{};  // a material that was not validated
  return reflectance * simd::generate([&](std::size_t lane) {
           return detail::interpolated(m.backscatter_table, std::acos(std::clamp(cos_incidence[lane], -1.0, 1.0)),
                                       &BackscatterAtIncidence::incidence, &BackscatterAtIncidence::backscatter);
         });
}

}  // namespace PULSECAST_NAMESPACE

#endif
