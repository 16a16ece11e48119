// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_FRAME_HPP
#define PULSECAST_BASE_FRAME_HPP

#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE {

/// Frames of reference. All are right-handed, in metres, with x right, y forward, z up.
namespace frame {
struct Beam {};        ///< laser: the beam leaves along +y, and z is the footprint's up
struct Instrument {};  ///< housing of the scanner
struct Body {};        ///< tripod, car, drone or airplane that carries the instrument
struct World {};       ///< scene: x east, y north, z up
}  // namespace frame

/// Rigid transform from frame `From` to frame `To`: rotation, then translation.
/// Poses compose only where their frames touch: `world_from_body * body_from_instrument`.
template <class From, class To>
struct Pose {
  Rotation rotation = no_rotation;  ///< unit quaternion
  Vec3 position{};                  ///< origin of `From` in `To` [m]

  /// Maps a point from `From` to `To` [m].
  [[nodiscard]] Vec3 point(const Vec3& p) const noexcept { return rotation * p + position; }

  /// Maps a direction from `From` to `To`; keeps its length.
  [[nodiscard]] Vec3 direction(const Vec3& d) const noexcept { return rotation * d; }

  /// Transform back from `To` to `From`.
  [[nodiscard]] Pose<To, From> inverse() const noexcept {
    const Rotation back = conjugate(rotation);
    return {back, -(back * position)};
  }

  /// True if all numbers are finite.
  [[nodiscard]] bool finite() const noexcept {
    const double sum = position.x + position.y + position.z + rotation.w + rotation.x + rotation.y + rotation.z;
    return std::isfinite(sum);  // a sum keeps NaN and infinity
  }

  /// True if the position is finite and the rotation unit to 1e-6: the law of every motion.
  [[nodiscard]] bool rigid() const noexcept {
    return pulsecast::finite(position) && std::fabs(length(rotation) - 1) <= 1e-6;
  }
};

/// Composition of two poses, the right one first.
template <class A, class B, class C>
[[nodiscard]] Pose<A, C> operator*(const Pose<B, C>& c_from_b, const Pose<A, B>& b_from_a) noexcept {
  return {c_from_b.rotation * b_from_a.rotation, c_from_b.point(b_from_a.position)};
}

/// First and second derivatives in time of the pose of a moving frame.
struct Derivatives {
  Vec3 velocity{};              ///< of its origin, in the frame that it moves in [m/s]
  Vec3 acceleration{};          ///< of its origin, in that frame, too [m/s^2]
  Vec3 angular_rate{};          ///< along its own axes [rad/s]
  Vec3 angular_acceleration{};  ///< derivative of these numbers [rad/s^2]

  /// Turns the moving frame by a further rotation, which is `turn` now: to these axes from the former ones,
  /// at a rate [rad/s] and an angular acceleration [rad/s^2] along these axes. Source: derivative of `turn^-1 rate`.
  void turn_by(const Rotation& turn, const Vec3& rate, const Vec3& angular) noexcept {
    const Rotation back = conjugate(turn);
    const Vec3 carried = back * angular_rate;
    angular_rate = carried + rate;
    angular_acceleration = back * angular_acceleration + cross(carried, rate) + angular;
  }
};

/// Pose of a body at a point in time.
struct TimedPose {
  double time = 0;                  ///< time since the start of its leg or survey [s]
  Vec3 position{};                  ///< origin of the body in the world [m]
  Rotation rotation = no_rotation;  ///< rotation from the body to the world; unit to within 1e-3
};

/// Converts axes x right, y forward, z up to x forward, y left, z up. Source: ROS REP 103.
[[nodiscard]] inline Vec3 to_forward_left_up(const Vec3& v) noexcept { return {v.y, -v.x, v.z}; }

/// Converts axes x forward, y left, z up (ROS REP 103) to x right, y forward, z up.
[[nodiscard]] inline Vec3 from_forward_left_up(const Vec3& v) noexcept { return {-v.y, v.x, v.z}; }

/// Heading of a direction, clockwise from north [rad]; `otherwise` if it is vertical or zero.
[[nodiscard]] inline double heading_of(const Vec3& direction, double otherwise = 0) noexcept {
  return direction.x == 0 && direction.y == 0 ? otherwise : std::atan2(direction.x, direction.y);
}

/// Attitude of a level body with a compass heading, clockwise from north [rad].
[[nodiscard]] inline Rotation level(double heading) noexcept { return rotation_about(axis::up, -heading); }

}  // namespace PULSECAST_NAMESPACE

#endif
