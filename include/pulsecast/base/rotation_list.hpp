// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <pulsecast/base/expect.hpp>
#include <pulsecast/base/vector.hpp>

namespace pulsecast {

/// A right-handed turn about an axis.
struct Turn {
  Vec3 axis = up;    ///< of any length but zero
  double angle = 0;  ///< [rad]

  void validate() const {
    expect_positive("Turn::axis (length)", length(axis), "");
    expect_finite("Turn::angle", angle, "rad");
  }
};

/// One turn after the other, each about an axis of the frame outside, which stays where it is ("extrinsic"):
/// `fixed_axes({{right, -90_deg}, {up, 90_deg}})` tilts what looks forward down, and then turns it left.
[[nodiscard]] inline Rotation fixed_axes(const std::vector<Turn>& turns) {
  Rotation all = no_rotation;
  for (const Turn& turn : turns) turn.validate(), all = rotation_about(turn.axis, turn.angle) * all;
  return normalize(all);
}

/// One turn after the other, each about an axis of what is turned, as the turns before have left it ("intrinsic"). It is what
/// `fixed_axes` gives for the same turns in reverse order.
[[nodiscard]] inline Rotation moving_axes(const std::vector<Turn>& turns) {
  Rotation all = no_rotation;
  for (const Turn& turn : turns) turn.validate(), all = all * rotation_about(turn.axis, turn.angle);
  return normalize(all);
}

}  // namespace pulsecast
