// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>

namespace pulsecast {

/// A right-handed turn about an axis.
struct AxisAngle {
  Vec3 axis = axis::up;  ///< of any length but zero
  double angle = 0;      ///< [rad]

  void validate() const {
    require_positive("AxisAngle::axis (length)", length(axis), "");
    require_finite("AxisAngle::angle", angle, "rad");
  }
};

/// One turn after the other, each about an axis of the frame outside, which stays where it is ("extrinsic"):
/// `extrinsic({{axis::right, -90_deg}, {axis::up, 90_deg}})` tilts what looks forward down, and then turns it left.
[[nodiscard]] inline Rotation extrinsic(const std::vector<AxisAngle>& turns) {
  Rotation all = no_rotation;
  for (const AxisAngle& turn : turns) turn.validate(), all = rotation_about(turn.axis, turn.angle) * all;
  return normalize(all);
}

/// One turn after the other, each about an axis of what is turned, as the turns before have left it ("intrinsic"). It is what
/// `extrinsic` gives for the same turns in reverse order.
[[nodiscard]] inline Rotation intrinsic(const std::vector<AxisAngle>& turns) {
  Rotation all = no_rotation;
  for (const AxisAngle& turn : turns) turn.validate(), all = all * rotation_about(turn.axis, turn.angle);
  return normalize(all);
}

}  // namespace pulsecast
