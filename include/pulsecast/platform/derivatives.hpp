// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_DERIVATIVES_HPP
#define PULSECAST_PLATFORM_DERIVATIVES_HPP

#include <pulsecast/platform/platform.hpp>

namespace PULSECAST_NAMESPACE {

/// Derivatives of a trajectory at a time, in closed form if it is `Differentiable`. Others are differentiated over
/// 4 h = 1/64 s: to h^4 / 30 of the fifth derivative and h^4 / 90 of the sixth, and by rounding to about 4e-14 of the
/// coordinate a second, and 2e-11 a second squared. Jumps within that time are smeared over it,
/// a path is asked from 1/128 s before the survey on, and turns of more than 402 rad/s are not seen.
/// Source: Abramowitz & Stegun 1964, table 25.2, differences at five points.
template <Trajectory Path>
[[nodiscard]] Derivatives derivatives_of(const Path& path, Tick t) noexcept {
  static_assert(detail::members_checked<Path, tag::Differentiable>);
  if constexpr (Differentiable<Path> && detail::DerivativesOfItsPoses<Path>) {
    return path.derivatives(t);
  } else {
    constexpr double h = 1.0 / 256;
    const Pose<frame::Body, frame::World> now = path.at(t);
    Derivatives d;
    for (const double k : {-2.0, -1.0, 1.0, 2.0}) {
      const Pose<frame::Body, frame::World> pose = path.at(t + Tick::of_seconds(k * h));
      const Vec3 moved = pose.position - now.position;
      const Vec3 turned = rotation_vector(conjugate(now.rotation) * pose.rotation);
      const double first = (std::fabs(k) > 1 ? -0.5 * k : 8 * k) / (12 * h);
      const double second = (std::fabs(k) > 1 ? -1.0 : 16.0) / (12 * h * h);
      d.velocity += first * moved;
      d.acceleration += second * moved;
      d.angular_rate += first * turned;
      d.angular_acceleration += second * turned;
    }
    return d;
  }
}

/// Derivatives of an instrument on a trajectory, with rates along the instrument's axes.
/// Source: Goldstein 1980, Classical Mechanics, sec. 4-10: centripetal and Euler acceleration of the lever arm.
template <Trajectory Path>
[[nodiscard]] Derivatives derivatives_of(const Path& path, const Mount& mount, Tick t) noexcept {
  const Derivatives body = derivatives_of(path, t);
  const Rotation world_from_body = path.at(t).rotation, back = conjugate(mount.boresight);
  const Vec3 swept = cross(body.angular_rate, mount.lever_arm);
  const Vec3 pulled = cross(body.angular_acceleration, mount.lever_arm) + cross(body.angular_rate, swept);
  return {body.velocity + world_from_body * swept, body.acceleration + world_from_body * pulled,
          back * body.angular_rate, back * body.angular_acceleration};
}

}  // namespace PULSECAST_NAMESPACE

#endif
