// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DEFLECTOR_ROTATING_HEAD_HPP
#define PULSECAST_DEFLECTOR_ROTATING_HEAD_HPP

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Head that rotates a whole instrument at a constant rate.
struct RotatingHead {
  using refinements = refines<tag::MovesInLanes, tag::Validated>;
  double angular_rate = 2 * pi;  ///< to the left about an upward axis, within 1e12 [rad/s]
  double start = 0;              ///< angle at the survey's start, from -2 pi to 2 pi [rad]
  Vec3 axis = axis::up;          ///< axis of rotation, of any length but zero

  void validate() const {
    require_within("RotatingHead::angular_rate", angular_rate, -1e12, 1e12, "rad/s");
    require_angle("RotatingHead::start", start);
    require_positive("RotatingHead::axis (length)", length(axis), "");
  }

  [[nodiscard]] auto at(Tick t) const noexcept { return pose_in_lanes(*this, t); }

  simd::Mask poses(const TickLanes& t, PoseLanes<frame::Instrument, frame::Instrument>& poses) const noexcept {
    const simd::Doubles angle = start + 2 * pi * t.phase(angular_rate / (2 * pi));
    poses.rotation = RotationLanes::about(pulsecast::normalize(axis), angle);
    poses.position = {};
    return all_lanes();
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
