// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_APERTURE_OVERLAP_HPP
#define PULSECAST_TRANSPORT_APERTURE_OVERLAP_HPP

#include <pulsecast/detector/radiometry.hpp>
#include <pulsecast/scanner/beam.hpp>

namespace PULSECAST_NAMESPACE {

/// Place and view of a receiver's aperture beside that of the beam.
struct ApertureGeometry {
  double separation = 0;        ///< distance of the axes at the instrument [m]
  double inclination = 0;       ///< of the receiver's axis to the beam's, from -0.1 to 0.1 [rad]
  double field_of_view = 2e-3;  ///< full angle of the receiver's view, from 1e-6 to 1 [rad]
  double obstruction = 0;       ///< diameter of what covers the middle of the aperture [m]

  void validate() const {
    require_within("ApertureGeometry::separation", separation, 0, 1e3, "m");
    require_within("ApertureGeometry::inclination", inclination, -0.1, 0.1, "rad");
    require_within("ApertureGeometry::field_of_view", field_of_view, 1e-6, 1, "rad");
    require_not_negative("ApertureGeometry::obstruction", obstruction, "m");
  }
};

/// Area that two discs share [m^2], from their radii and the distance of their centres [m].
[[nodiscard]] inline double shared_area(double a, double b, double distance) noexcept {
  if (distance >= a + b) return 0;
  const double least = std::min(a, b);
  if (distance <= std::fabs(a - b)) return pi * least * least;
  const double from_a = (distance * distance + a * a - b * b) / (2 * distance), from_b = distance - from_a;
  const auto segment = [](double r, double middle) {
    const double cosine = std::clamp(middle / r, -1.0, 1.0);
    return r * r * std::acos(cosine) - middle * r * std::sqrt(1 - cosine * cosine);
  };
  return segment(a, from_a) + segment(b, from_b);
}

/// Share of a beam's cross section, to the 1/e^2 radius, that a receiver sees at a range [m]; of an
/// ellipse, that of the disc of its area. Source: overlap function of geometrical optics for an
/// even beam, Halldorsson & Langerholc 1978; Measures 1984.
[[nodiscard]] inline double aperture_overlap(const ApertureGeometry& g, const Receiver& receiver, const Laser& laser,
                                             double range) noexcept {
  const Vec2 axes = beam_radius(laser, range);
  const double beam = std::max(std::sqrt(axes.x * axes.y), 1e-9);  // a line is a thin disc
  const double wider = range * std::tan(0.5 * g.field_of_view), view = 0.5 * receiver.diameter + wider;
  const double distance = std::fabs(g.separation - range * std::tan(g.inclination));
  const double shadow = std::max(0.5 * g.obstruction - wider, 0.0);
  const double seen = shared_area(beam, view, distance) - shared_area(beam, std::min(shadow, view), distance);
  return seen / (pi * beam * beam);
}

/// Table for `Receiver::overlap` from range 0 to `far` [m], at steps of a thousandth of the range,
/// and of a hundredth of `near` [m] before ten times that. @throws SettingError
[[nodiscard]] inline SharedArray<OverlapAtRange> overlap_table(const ApertureGeometry& g, const Receiver& receiver,
                                                               const Laser& laser, double near = 0.1,
                                                               double far = 1000) {
  g.validate();
  receiver.validate();
  laser.validate();
  require_within("overlap_table (near)", near, 1e-3, 1e6, "m");
  require_within("overlap_table (far)", far, near, 1e6, "m");
  std::vector<OverlapAtRange> rows;
  for (double range = 0; range < far; range += std::max(0.001 * range, 0.01 * near))
    rows.push_back({range, aperture_overlap(g, receiver, laser, range)});
  rows.push_back({far, aperture_overlap(g, receiver, laser, far)});
  return SharedArray<OverlapAtRange>(std::move(rows));
}

}  // namespace PULSECAST_NAMESPACE

#endif
