// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_PLANE_SPREAD_HPP
#define PULSECAST_TRANSPORT_PLANE_SPREAD_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/transport/illumination.hpp>

namespace PULSECAST_NAMESPACE {

/// Plane that all subrays of a beam from a point met. The inverse of the range along the beam's axis is linear in the tangents of a
/// subray's angles, whatever the plane.
class MetPlane {
 public:
  /// Fits a plane to the reflections of all subrays, in their order, by least squares.
  MetPlane(const SubrayDirections& beam, std::span<const Reflection> reflections) noexcept {
    const double n = static_cast<double>(reflections.size());
    double across = 0, up = 0, inverse = 0;
    for (std::size_t j = 0; j < reflections.size(); ++j) {
      across += beam.x[j] / beam.y[j] / n;
      up += beam.z[j] / beam.y[j] / n;
      inverse += inverse_at(beam, reflections, j) / n;
    }
    double aa = 0, bb = 0, ab = 0, ai = 0, bi = 0;
    for (std::size_t j = 0; j < reflections.size(); ++j) {
      const double a = beam.x[j] / beam.y[j] - across, b = beam.z[j] / beam.y[j] - up, i = inverse_at(beam, reflections, j) - inverse;
      aa += a * a;
      bb += b * b;
      ab += a * b;
      ai += a * i;
      bi += b * i;
    }
    const double determinant = aa * bb - ab * ab;
    across_ = (bb * ai - ab * bi) / determinant;
    up_ = (aa * bi - ab * ai) / determinant;
    middle_ = inverse - across_ * across - up_ * up;
  }

  /// Greatest distance of a reflection from the plane, along its ray [m]; NaN without a plane.
  [[nodiscard]] double farthest_from(const SubrayDirections& beam, std::span<const Reflection> reflections) const noexcept {
    double most = 0;
    for (std::size_t j = 0; j < reflections.size(); ++j) {
      const double inverse = beam.y[j] * middle_ + beam.x[j] * across_ + beam.z[j] * up_,
                   off = std::fabs(1 / inverse - reflections[j].range);
      if (!(off <= most)) most = off;
    }
    return most;
  }

  /// Range of the Gaussian beam's light that meets the plane at so many standard deviations towards its far end [m]; negative if none does.
  [[nodiscard]] double range_at(double deviations, const Emitter& emitter) const noexcept {
    const double across = 0.25 * emitter.footprint_scale * emitter.laser.divergence.across * across_;
    const double up = 0.25 * emitter.footprint_scale * emitter.laser.divergence.up * up_;
    return 1 / (middle_ - deviations * std::hypot(across, up));
  }

 private:
  static double inverse_at(const SubrayDirections& beam, std::span<const Reflection> reflections, std::size_t j) noexcept {
    return 1 / (reflections[j].range * beam.y[j]);
  }

  double middle_ = 0, across_ = 0, up_ = 0;  ///< inverse of the range on the axis, and its slopes [1/m]
};

inline constexpr std::size_t plane_reflections_max = 2048;  ///< greatest number of reflections that light is spread to

/// Spreads the light of a pulse over a smooth plane that is met so obliquely that its subrays may be echoes of their own: if their ranges
/// part by more than two deviations of the pulse, other reflections take their place, with the power of a Gaussian beam over the plane.
/// Without another ray, a plane then gives one echo, of the place and width that the beam's has.
///
/// They are so near to each other that their sum has a single maximum. Derived for pulses of a `PulseShape`, whose spectrum falls as the
/// cube of the frequency: the ripple of a comb of spacing d is 2 (d / 2 pi tau)^3, and its curvature is less than that of the whole echo,
/// of a deviation s, if d is below pi tau^3 / s^2, with all in metres of range. Four times as many subrays are dense enough themselves.
///
/// `reflections` begins with those of all subrays, in their order, of which there are `count`; its size is the room for others. Returns
/// true if it was done, with their number in `count`.
[[nodiscard]] inline bool spread_over_plane(const Illumination& light, std::span<Reflection> reflections, std::size_t& count) noexcept {
  const std::span<Reflection> met = reflections.first(count);
  const double tau = 0.5 * speed_of_light * light.emitter.laser.pulse_length / 3.4, deviation = std::sqrt(3.0) * tau;  // of the pulse [m]
  double nearest = met[0].range, farthest = met[0].range;
  for (const Reflection& r : met) {
    nearest = r.range < nearest ? r.range : nearest;
    farthest = r.range > farthest ? r.range : farthest;
  }
  if (!(farthest - nearest > 2 * deviation)) return false;
  const MetPlane plane(light.beam, met);
  if (!(plane.farthest_from(light.beam, met) < 0.1 * deviation)) return false;

  constexpr double reach = 4;  // deviations of the beam
  const double begin = plane.range_at(-reach, light.emitter), end = plane.range_at(reach, light.emitter);
  if (!(begin > 0 && end > begin)) return false;
  const double spread = (end - begin) / (2 * reach),
               spacing = std::min(tau, 0.5 * pi * tau * tau * tau / (spread * spread + deviation * deviation));
  const double parts = std::min(std::ceil((end - begin) / spacing) + 1, static_cast<double>(reflections.size()));

  if (static_cast<double>(count) >= 4 * parts) return false;  // dense enough

  double power = 0;
  for (const Reflection& r : met) power += r.power;
  Reflection like = met[count / 2];
  double weights = 0;
  std::size_t made = 0;
  for (double k = 0; k < parts; ++k) {
    const double at = reach * (2 * k / (parts - 1) - 1), range = plane.range_at(at, light.emitter);
    if (!light.gate.contains(range)) continue;
    like.range = range;
    like.power = std::exp(-0.5 * at * at) / (range * range);
    weights += like.power;
    reflections[made++] = like;
  }
  if (made == 0) return false;
  for (Reflection& r : reflections.first(made)) r.power *= power / weights;
  count = made;
  return true;
}

}  // namespace PULSECAST_NAMESPACE

#endif
