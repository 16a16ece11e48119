// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

#include <pulsecast/base/require.hpp>
#include <pulsecast/scene/spectrum.hpp>

namespace pulsecast {

/// The angular law by which a surface sends light back to where it came from.
enum class Scattering : std::uint8_t {
  lambert,                ///< falls with the cosine of the incidence
  phong,                  ///< Lambert and a glossy lobe
  direction_independent,  ///< the same from everywhere
};

/// What a surface of a material sends back of light of one wavelength, by the cosine of the incidence.
/// Source: Jutzi & Gross 2009; the lobe stands about the mirror direction, twice the incidence away, and ends at 90 degrees.
struct Backscatter {
  double reflectance = 0;                 ///< a fraction, of which the other three have shares
  double even = 0, cosine = 0, lobe = 0;  ///< the same from everywhere; as the cosine; as a glossy lobe
  double exponent = 0;                    ///< of the lobe

  /// For light that arrives at an angle of this cosine, in [0, 1], and returns the way it came.
  [[nodiscard]] double operator()(double cos_incidence) const noexcept {
    const double rough = cosine * cos_incidence + even;
    if (lobe == 0) return reflectance * rough;
    const double cos_to_mirror = 2 * cos_incidence * cos_incidence - 1;
    return reflectance * (rough + (cos_to_mirror > 0 ? lobe * std::pow(cos_to_mirror, exponent) : 0));
  }
};

/// What a surface is made of.
struct Material {
  std::string name = "default";
  double reflectance = 0.5;  ///< at the laser's wavelength, a fraction: in [0, 1]; does not count where there is a spectrum
  Scattering scattering = Scattering::lambert;
  double specular_share = 0;                   ///< of the reflectance, in the glossy lobe of Phong's law: in [0, 1]
  double specular_exponent = 10;               ///< of that lobe, at least 0
  std::uint16_t classification = 0;            ///< ASPRS class that its points get
  bool ground = false;                         ///< may carry set-ups and vehicles
  std::shared_ptr<const Spectrum> spectrum{};  ///< reflectance by wavelength, for several materials perhaps; empty if it is the same at all

  void validate() const {
    require_within("Material::reflectance", reflectance, 0, 1, "");
    require_within("Material::specular_share", specular_share, 0, 1, "");
    require_not_negative("Material::specular_exponent", specular_exponent, "");
  }

  /// For light of a wavelength [m]: a fraction.
  [[nodiscard]] double reflectance_at(double wavelength) const noexcept {
    return spectrum ? spectrum->reflectance(wavelength) : reflectance;
  }

  /// Reflectance times the angular law, for light of a wavelength [m].
  [[nodiscard]] Backscatter backscatter(double wavelength) const noexcept {
    Backscatter all{.reflectance = reflectance_at(wavelength)};
    switch (scattering) {
      case Scattering::lambert:
        all.cosine = 1;
        break;
      case Scattering::phong:
        all.cosine = 1 - specular_share, all.lobe = specular_share, all.exponent = specular_exponent;
        break;
      case Scattering::direction_independent:
        all.even = 1;
        break;
    }
    return all;
  }

  /// The same for one angle, given by its cosine.
  [[nodiscard]] double backscatter(double cos_incidence, double wavelength) const noexcept {
    return backscatter(wavelength)(cos_incidence);
  }
};

}  // namespace pulsecast
