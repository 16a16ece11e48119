// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_MICROFACET_HPP
#define PULSECAST_MATERIAL_MICROFACET_HPP

#include <pulsecast/base/units.hpp>
#include <pulsecast/material/fresnel.hpp>
#include <pulsecast/material/lambert.hpp>

/// Contract: closed forms of light at a rough surface of small smooth facets with Gaussian slopes.
namespace PULSECAST_NAMESPACE {

namespace detail {

/// Rough surface: facets of a root mean square slope and a refractive index.
struct Microfacets {
  double slope = 0.3;  ///< root mean square of the slope, both axes together, greater than 0
  double index = 1.5;  ///< refractive index of the facets

  /// Density of the facets' normals by solid angle, at a cosine to the mean normal [1/sr].
  /// Source: Beckmann & Spizzichino 1963; Cook & Torrance 1982.
  [[nodiscard]] double density(double cosine) const noexcept {
    if (!(cosine > 0)) return 0;
    const double c2 = cosine * cosine, m2 = slope * slope;
    return std::exp((c2 - 1) / (c2 * m2)) / (pi * m2 * c2 * c2);
  }

  /// Ratio of the facets' area that hides others to that seen from a direction. Source: Smith 1967.
  [[nodiscard]] double hidden(double cosine) const noexcept {
    const double sine2 = 1 - cosine * cosine;
    if (!(sine2 > 0)) return 0;
    const double a = cosine / (slope * std::sqrt(sine2));
    return (std::exp(-a * a) / (a * std::sqrt(pi)) - std::erfc(a)) / 2;
  }

  /// Share of the light reflected at the mean normal, of unpolarised light.
  [[nodiscard]] double reflected(double cos_incidence) const noexcept {
    return fresnel_split(cos_incidence, index).reflected;
  }

  /// Light that returns to its source, as in `Hit::backscatter`, from facets that face it; masking
  /// is the same on both ways. Of a water surface, its glint. Source: Bufton, Hoge & Swift 1983.
  [[nodiscard]] double backscatter(double cos_incidence) const noexcept {
    if (!(cos_incidence > 0)) return 0;
    const double seen = 4 * cos_incidence * (1 + hidden(cos_incidence));
    return pi * reflected(1) * density(cos_incidence) / seen;
  }

  /// Radiance towards a direction by the irradiance from another, times the cosine of the first;
  /// unit vectors away from the surface [1/sr]. Its integral is at most the share that facets
  /// reflect. Source: Torrance & Sparrow 1967; height-correlated masking, Ross, Dion & Potvin 2005.
  [[nodiscard]] double scattered(const Vec3& from, const Vec3& to, const Vec3& normal) const noexcept {
    const double in = dot(from, normal), out = dot(to, normal);
    if (!(in > 0 && out > 0)) return 0;
    const Vec3 facet = normalize(from + to);
    const double seen = 4 * in * (1 + hidden(in) + hidden(out));
    return reflected(dot(facet, from)) * density(dot(facet, normal)) / seen;
  }
};

}  // namespace detail

/// Light reflected by rough facets, of the index of the material's body or 1.5, and Lambert's law
/// for the rest, which they weaken on its way in only, not reciprocal. For varnish or wet ground.
struct Microfacet {
  static constexpr bool reflects_interface = true;  ///< as the concept ReflectsInterface describes

  double slope = 0.3;  ///< root mean square of the facets' slope, both axes together, from 1e-3 to 2

  void validate() const { require_within("Microfacet::slope", slope, 1e-3, 2, ""); }
  double backscatter(double cosine, const SurfaceLight& light) const noexcept {
    const detail::Microfacets facets{slope, light.relative_index};
    return facets.backscatter(cosine) + (1 - facets.reflected(cosine)) * light.reflectance * cosine;
  }
  double scattered_share(double cosine, const SurfaceLight& light) const noexcept {
    const double by_facets = fresnel_split(cosine, light.relative_index).reflected;
    return by_facets + (1 - by_facets) * Lambert{}.scattered_share(cosine, light);
  }
  double scattered(const Vec3& in, const Vec3& out, const Vec3& normal, const SurfaceLight& light) const noexcept {
    const detail::Microfacets facets{slope, light.relative_index};
    return pi * facets.scattered(in, out, normal) +
           (1 - facets.reflected(dot(in, normal))) * Lambert{}.scattered(in, out, normal, light);
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
