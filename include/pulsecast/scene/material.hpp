// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include <pulsecast/base/expect.hpp>

namespace pulsecast {

/// The angular law by which a surface sends light back to where it came from.
enum class Scattering : std::uint8_t {
  lambert,                ///< falls with the cosine of the incidence
  phong,                  ///< Lambert and a glossy lobe
  direction_independent,  ///< the same from everywhere
};

/// What a surface is made of.
struct Material {
  std::string name = "default";
  double reflectance = 0.5;  ///< at the laser's wavelength, a fraction: in [0, 1]
  Scattering scattering = Scattering::lambert;
  double specular_share = 0;         ///< of the reflectance, in the glossy lobe of Phong's law: in [0, 1]
  double specular_exponent = 10;     ///< of that lobe, at least 0
  std::uint16_t classification = 0;  ///< ASPRS class that its points get
  bool ground = false;               ///< may carry set-ups and vehicles

  void validate() const {
    expect_within("Material::reflectance", reflectance, 0, 1, "");
    expect_within("Material::specular_share", specular_share, 0, 1, "");
    expect_not_negative("Material::specular_exponent", specular_exponent, "");
  }

  /// Reflectance times the angular law, for light that arrives at an angle of this cosine, in [0, 1], and returns the way it came.
  /// Source: Jutzi & Gross 2009; the lobe stands about the mirror direction, twice the incidence away, and ends at 90 degrees.
  [[nodiscard]] double backscatter(double cos_incidence) const noexcept {
    switch (scattering) {
      case Scattering::lambert:
        return reflectance * cos_incidence;
      case Scattering::phong: {
        const double cos_to_mirror = 2 * cos_incidence * cos_incidence - 1;
        const double lobe = cos_to_mirror > 0 ? std::pow(cos_to_mirror, specular_exponent) : 0;
        return reflectance * ((1 - specular_share) * cos_incidence + specular_share * lobe);
      }
      case Scattering::direction_independent:
        break;
    }
    return reflectance;
  }
};

}  // namespace pulsecast
