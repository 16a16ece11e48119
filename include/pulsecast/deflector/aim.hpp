// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <pulsecast/base/frame.hpp>

/// How optics say where their beam goes.
namespace pulsecast {

/// The pose of a beam that is turned up from forward, about right, by an angle [rad].
[[nodiscard]] inline Pose<frame::Beam, frame::Instrument> aimed_above(double angle) noexcept {
  return {Rotation{std::cos(0.5 * angle), std::sin(0.5 * angle), 0, 0}, {}};
}

/// The pose of a beam that leaves from `origin` [m] and is first turned up, then from forward to the right. Its right stays level.
[[nodiscard]] inline Pose<frame::Beam, frame::Instrument> aimed_at(double azimuth, double elevation, const Vec3& origin = {}) noexcept {
  return {Rotation{std::cos(0.5 * azimuth), 0, 0, -std::sin(0.5 * azimuth)} * aimed_above(elevation).rotation, origin};
}

/// The pose of a beam along a unit direction, by the shortest turn from forward: its up turns no more than it must.
[[nodiscard]] inline Pose<frame::Beam, frame::Instrument> aimed_along(const Vec3& direction) noexcept {
  const double x = direction.x, y = direction.y, z = direction.z;
  const double aside_squared = x * x + z * z;
  if (y < 0 && aside_squared < 1e-300) return {Rotation{0, 0, 0, 1}, {}};  // straight back: about up
  const double w = y < 0 ? aside_squared / (1 - y) : 1 + y;                // 1 + y both ways; near -1 only the first does not cancel
  return {normalize(Rotation{w, z, 0, -x}), {}};
}

}  // namespace pulsecast
