// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <pulsecast/base/vector.hpp>

namespace pulsecast {

/// Frames of reference. All are right-handed, in metres, with x right, y forward, z up.
namespace frame {
struct Beam {};        ///< the laser: the beam leaves along +y, and z is the footprint's up
struct Instrument {};  ///< the housing of the scanner
struct Body {};        ///< the tripod, car, drone or airplane that carries it
struct World {};       ///< the scene: x east, y north, z up
}  // namespace frame

/// Where a frame is, and how it is turned, in another: maps what is given in `From` into `To`.
/// Poses compose only where their frames touch: `world_from_body * body_from_instrument`.
template <class From, class To>
struct Pose {
  Rotation rotation = no_rotation;  ///< unit quaternion
  Vec3 position{};                  ///< origin of `From` in `To` [m]

  /// A point of `From`, in `To` [m].
  [[nodiscard]] Vec3 point(const Vec3& p) const noexcept { return rotation * p + position; }

  /// A direction of `From`, in `To`; keeps its length.
  [[nodiscard]] Vec3 direction(const Vec3& d) const noexcept { return rotation * d; }

  [[nodiscard]] Pose<To, From> inverse() const noexcept {
    const Rotation back = conjugate(rotation);
    return {back, -(back * position)};
  }

  /// Whether it is a place and a rotation, in single precision at least: what every motion must give.
  [[nodiscard]] bool rigid() const noexcept { return finite(position) && std::fabs(length(rotation) - 1) <= 1e-6; }
};

template <class A, class B, class C>
[[nodiscard]] Pose<A, C> operator*(const Pose<B, C>& c_from_b, const Pose<A, B>& b_from_a) noexcept {
  return {c_from_b.rotation * b_from_a.rotation, c_from_b.point(b_from_a.position)};
}

/// Pose of a body at a time.
struct TimedPose {
  double time = 0;                  ///< since the start of the leg or survey that it belongs to [s]
  Vec3 position{};                  ///< in the world [m]
  Rotation rotation = no_rotation;  ///< from the body to the world; unit to a thousandth
};

/// From axes x right, y forward, z up to x forward, y left, z up, which ROS uses. Source: ROS REP 103.
[[nodiscard]] inline Vec3 to_forward_left_up(const Vec3& v) noexcept { return {v.y, -v.x, v.z}; }

/// From axes x forward, y left, z up (ROS REP 103) to x right, y forward, z up.
[[nodiscard]] inline Vec3 from_forward_left_up(const Vec3& v) noexcept { return {-v.y, v.x, v.z}; }

}  // namespace pulsecast
