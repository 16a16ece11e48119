// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DEFLECTOR_PALMER_MIRROR_HPP
#define PULSECAST_DEFLECTOR_PALMER_MIRROR_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/aim.hpp>

namespace PULSECAST_NAMESPACE {

/// Nutating mirror: the beam describes a cone about forward once a turn, from up over right. A
/// second half angle makes the cone elliptical. The deviation from forward is the first half angle
/// times the cosine upwards, and the second times the sine to the right.
struct PalmerMirror {
  using refinements = refines<tag::MovesInLanes, tag::Validated>;
  double rotation_rate = 50;                  ///< rate of turns around the cone, at most 1e12 [Hz]
  double half_angle = pi / 9;                 ///< half angle upwards and downwards [rad]
  std::optional<double> half_angle_across{};  ///< that to right and left; the same if empty [rad]

  void validate() const {
    require_rate("PalmerMirror::rotation_rate", rotation_rate);
    require_within("PalmerMirror::half_angle", half_angle, 0, pi / 2, "rad");
    require_within("PalmerMirror::half_angle_across", half_angle_across.value_or(0), 0, pi / 2, "rad");
  }

  [[nodiscard]] auto at(Tick t) const noexcept { return pose_in_lanes(*this, t); }

  simd::Mask poses(const TickLanes& t, PoseLanes<frame::Beam, frame::Instrument>& poses) const noexcept {
    const auto turn = simd::sincos(simd::Doubles(2 * pi * t.phase(rotation_rate)));
    const simd::Doubles across = half_angle_across.value_or(half_angle) * turn.sin;
    const simd::Doubles upwards = half_angle * turn.cos, square = across * across + upwards * upwards;
    const simd::Doubles off = simd::sqrt(square);  // angle from forward [rad]
    const auto tilt = simd::sincos(off);
    const simd::Doubles aside = off > 0.0 ? tilt.sin / off : simd::Doubles{} + 1.0;
    poses = aimed_along(Vec3Lanes{aside * across, tilt.cos, aside * upwards});
    return all_lanes();
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
