// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_MATERIAL_HPP
#define PULSECAST_SCENE_MATERIAL_HPP

#include <cstdint>
#include <memory>
#include <string>

#include <pulsecast/base/exponential.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/simd.hpp>
#include <pulsecast/base/vector_math.hpp>
#include <pulsecast/scene/spectrum.hpp>

namespace PULSECAST_NAMESPACE {

/// Angular law of the light that a surface scatters back to its source.
enum class Scattering : std::uint8_t {
  lambert,                ///< proportional to the cosine of incidence
  phong,                  ///< Lambert and a specular lobe
  direction_independent,  ///< equal at any incidence
};

/// Backscatter of a material at one wavelength, by the cosine of incidence.
/// Source: Jutzi & Gross 2009; the lobe is about the mirror direction, twice the incidence away, and ends at 90 degrees.
struct Backscatter {
  double reflectance = 0;                 ///< a fraction, split into the three shares below
  double even = 0, cosine = 0, lobe = 0;  ///< shares: isotropic; Lambertian; specular lobe
  double exponent = 0;                    ///< exponent of the lobe

  /// Backscatter towards the source at a cosine of incidence in [0, 1].
  [[nodiscard]] double operator()(double cos_incidence) const noexcept {
    return lobe == 0 ? reflectance * rough(cos_incidence) : glossy(simd::Doubles{} + cos_incidence)[0];
  }

  /// Angular law of the shares without the lobe.
  [[nodiscard]] double rough(double cos_incidence) const noexcept { return cosine * cos_incidence + even; }

  /// Backscatter with the lobe, by lane. Error of the lobe at most 1e-14 of `lobe`.
  [[nodiscard]] simd::Doubles glossy(const simd::Doubles& cos_incidence) const noexcept {
    const simd::Doubles cos_to_mirror = 2 * cos_incidence * cos_incidence - 1;
    const simd::Doubles power = exponent <= 64 && exponent == static_cast<unsigned>(exponent)
                                    ? simd::whole_power(cos_to_mirror, static_cast<unsigned>(exponent))
                                    : exponential(simd::Doubles(exponent * simd::detail::log_of_normal(cos_to_mirror)));
    const simd::Doubles specular = cos_to_mirror > 0 ? lobe * power : simd::Doubles{};
    return reflectance * (cosine * cos_incidence + even + specular);
  }
};

/// Surface material.
struct Material {
  std::string name = "default";                 ///< name in its file or program
  double reflectance = 0.5;                     ///< reflectance at the laser's wavelength, in [0, 1]; ignored with a spectrum
  Scattering scattering = Scattering::lambert;  ///< angular law
  double specular_share = 0;                    ///< share of the reflectance in the lobe of Phong's law, in [0, 1]
  double specular_exponent = 10;                ///< exponent of that lobe, at least 0
  std::uint16_t classification = 0;             ///< ASPRS class of its points
  bool ground = false;                          ///< true if it may carry set-ups and vehicles
  std::shared_ptr<const Spectrum> spectrum{};   ///< reflectance by wavelength, shareable; empty for a constant reflectance

  /// @throws SettingError for values out of range
  void validate() const {
    require_within("Material::reflectance", reflectance, 0, 1, "");
    require_within("Material::specular_share", specular_share, 0, 1, "");
    require_not_negative("Material::specular_exponent", specular_exponent, "");
  }

  /// Reflectance at a wavelength [m], a fraction.
  [[nodiscard]] double reflectance_at(double wavelength) const noexcept {
    return spectrum ? spectrum->reflectance(wavelength) : reflectance;
  }

  /// Reflectance times the angular law, at a wavelength [m].
  [[nodiscard]] Backscatter backscatter(double wavelength) const noexcept {
    Backscatter all{.reflectance = reflectance_at(wavelength)};
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
    }
    return all;
  }

  /// Backscatter at a cosine of incidence and a wavelength [m].
  [[nodiscard]] double backscatter(double cos_incidence, double wavelength) const noexcept {
    return backscatter(wavelength)(cos_incidence);
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
