// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCANNER_BEAM_HPP
#define PULSECAST_SCANNER_BEAM_HPP

#include <pulsecast/pulse.hpp>

namespace PULSECAST_NAMESPACE {

/// Semi-axes of a beam at 1/e^2 of its peak irradiance, across and up, at a range [m].
/// Source: ISO 11146-1:2005, d^2 = d0^2 + theta^2 (z - z0)^2.
[[nodiscard]] inline Vec2 beam_radius(const Laser& laser, double range) noexcept {
  const double across = 0.5 * std::hypot(laser.waist_diameter, laser.divergence.across * (range - laser.waist_range));
  return {across, across * laser.divergence.aspect()};
}

/// Beam quality factor M^2, across: 1 for a perfect Gaussian beam, the physical minimum.
/// Source: Siegman 1990; ISO 11146-1:2005, M^2 = pi d0 theta / (4 lambda).
[[nodiscard]] inline double beam_quality(const Laser& laser) noexcept {
  return pi * laser.waist_diameter * laser.divergence.across / (4 * laser.wavelength);
}

/// Round beam described by its exit optics, for `gaussian_beam`.
struct BeamExit {
  double diameter = 5e-3;                                  ///< at 1/e^2, at the exit [m]
  double focus = std::numeric_limits<double>::infinity();  ///< negative if divergent [m]
  double quality = 1;                                      ///< M^2, at least 1

  void validate() const {
    require_positive("BeamExit::diameter", diameter, "m");
    if (!(std::fabs(focus) > 0)) throw SettingError("BeamExit::focus", focus, "m", "other than 0");
    require_within("BeamExit::quality", quality, 1, 1e6, "");
  }
};

/// Copy of a laser with the divergence and waist of the beam from an exit. A focused beam's waist
/// lies short of the focus. Throws a `SettingError`. Source: Carlsson, Steinvall & Letalick 2001,
/// w^2 = w0^2 ((1 - R/F)^2 + (lambda R / (pi w0^2))^2); M^2 lambda for lambda, Siegman 1990.
[[nodiscard]] inline Laser gaussian_beam(const BeamExit& exit, Laser laser) {
  exit.validate();
  require_positive("Laser::wavelength", laser.wavelength, "m");
  const double radius = exit.diameter / 2;
  const double spread = exit.quality * laser.wavelength / pi;  // waist radius times half angle
  const double half_angle = std::hypot(radius / exit.focus, spread / radius);
  laser.divergence = 2 * half_angle;
  laser.waist_diameter = 2 * spread / half_angle;
  laser.waist_range = radius * radius / exit.focus / (half_angle * half_angle);
  return laser;
}

}  // namespace PULSECAST_NAMESPACE

#endif
