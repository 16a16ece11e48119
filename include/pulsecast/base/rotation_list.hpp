// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_ROTATION_LIST_HPP
#define PULSECAST_BASE_ROTATION_LIST_HPP

#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE {

/// Right-handed rotation by an angle about an axis.
struct AxisAngle {
  Vec3 axis = axis::up;  ///< axis of rotation, of any length but zero
  double angle = 0;      ///< angle of rotation [rad]

  void validate() const {
    require_positive("AxisAngle::axis (length)", length(axis), "");
    require_angle("AxisAngle::angle", angle);
  }
};

/// Extrinsic rotations in sequence, each about a fixed axis: `extrinsic({{axis::right, -90_deg},
/// {axis::up, 90_deg}})` tilts a forward view down, then turns it left. Throws a `SettingError`.
[[nodiscard]] inline Rotation extrinsic(const std::vector<AxisAngle>& turns) {
  Rotation all = no_rotation;
  for (const AxisAngle& turn : turns) {
    turn.validate();
    all = rotation_about(turn.axis, turn.angle) * all;
  }
  return normalize(all);
}

/// Intrinsic rotations, each about an axis of the rotated frame: `extrinsic` in reverse order.
[[nodiscard]] inline Rotation intrinsic(const std::vector<AxisAngle>& turns) {
  Rotation all = no_rotation;
  for (const AxisAngle& turn : turns) {
    turn.validate();
    all = all * rotation_about(turn.axis, turn.angle);
  }
  return normalize(all);
}

}  // namespace PULSECAST_NAMESPACE

#endif
