// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SENSOR_IMU_HPP
#define PULSECAST_SENSOR_IMU_HPP

#include <pulsecast/base/tick.hpp>
#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE {

/// What an inertial sensor measures, in its own axes, at `tick` and in the interval that ends there.
struct ImuSample {
  Tick tick{};                ///< end of the interval
  double interval = 0;        ///< length of the interval [s]
  Vec3 angle_increment{};     ///< angular rate, integrated over the interval [rad]
  Vec3 velocity_increment{};  ///< specific force, integrated over the interval [m/s]
  Vec3 angular_rate{};        ///< at `tick` [rad/s]
  Vec3 specific_force{};      ///< acceleration less gravity, at `tick` [m/s2]
};

}  // namespace PULSECAST_NAMESPACE

#endif
