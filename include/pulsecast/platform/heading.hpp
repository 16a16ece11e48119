// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_HEADING_HPP
#define PULSECAST_PLATFORM_HEADING_HPP

#include <cmath>

#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE {

/// Heading of a direction: clockwise from north, in [-pi, pi]; `otherwise` if the direction is vertical or zero [rad].
[[nodiscard]] inline double heading_of(const Vec3& direction, double otherwise = 0) noexcept {
  return direction.x == 0 && direction.y == 0 ? otherwise : std::atan2(direction.x, direction.y);
}

/// Attitude of a level body with a compass heading, clockwise from north [rad].
[[nodiscard]] inline Rotation level(double heading) noexcept { return rotation_about(axis::up, -heading); }

}  // namespace PULSECAST_NAMESPACE

#endif
