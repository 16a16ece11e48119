// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TRAJECTORY_ATTITUDE_HPP
#define PULSECAST_IO_DETAIL_TRAJECTORY_ATTITUDE_HPP

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>

/// Conventions of attitudes in files: angles, their order, and axes of quaternions and positions.
namespace PULSECAST_NAMESPACE::io {

/// Three angles of an attitude, to be interpreted by an `AngleConvention`.
struct RollPitchYaw {
  double roll = 0;   ///< roll [rad]
  double pitch = 0;  ///< pitch [rad]
  double yaw = 0;    ///< yaw or heading [rad]
};

/// One of the three rotations of an attitude.
struct ElementalRotation {
  double RollPitchYaw::*angle;  ///< angle of rotation, as in `&RollPitchYaw::yaw`
  Vec3 axis;                    ///< axis in the body, unit; right-handed
};

/// Convention of three angles. At zero the body is level and faces `zero_heading`. It is then
/// rotated about its own axes in the order of the list; they are perpendicular to each other.
struct AngleConvention {
  /// Intrinsic rotations; read backwards, the list is that of extrinsic ones.
  std::array<ElementalRotation, 3> turns{
      {{&RollPitchYaw::yaw, -axis::up}, {&RollPitchYaw::pitch, axis::right}, {&RollPitchYaw::roll, axis::forward}}};
  double zero_heading = 0;  ///< heading of the body at zero angles, clockwise from north [rad]

  void validate() const {
    require_angle("AngleConvention::zero_heading", zero_heading);
    constexpr double rounding = 1e-9;
    for (std::size_t i = 0; i < 3; ++i) {
      const ElementalRotation &turn = turns[i], &next = turns[(i + 1) % 3];
      require_within("AngleConvention::turns axis (length)", length(turn.axis), 1 - rounding, 1 + rounding, "");
      const double cosine = dot(turn.axis, next.axis);
      require_within("AngleConvention::turns axes (cosine between)", cosine, -rounding, rounding, "");
      if (turn.angle == next.angle || turn.angle == nullptr)
        throw SettingError("AngleConvention::turns angle (place)", static_cast<double>(i), "",
                           "roll, pitch and yaw, each once");
    }
  }
};

/// Heading clockwise from north, pitch nose up, roll right wing down: axes forward, right, down in
/// a world of north, east, down. Source: ISO 1151-1, DIN 9300-1; usual for navigation units.
inline const AngleConvention heading_pitch_roll{};

/// `heading_pitch_roll` with roll before pitch. HELIOS++ calls this "ARINC 705".
inline const AngleConvention helios_arinc_705{
    .turns = {
        {{&RollPitchYaw::yaw, -axis::up}, {&RollPitchYaw::roll, axis::forward}, {&RollPitchYaw::pitch, axis::right}}}};

/// Roll about right, pitch about forward, yaw left from north: "CANONICAL" of HELIOS++.
inline const AngleConvention helios_canonical{
    .turns = {
        {{&RollPitchYaw::roll, axis::right}, {&RollPitchYaw::pitch, axis::forward}, {&RollPitchYaw::yaw, axis::up}}}};

/// Yaw counter-clockwise from east, pitch nose up, roll right wing down.
inline const AngleConvention mathematical{.turns = {{{&RollPitchYaw::yaw, axis::up},
                                                     {&RollPitchYaw::pitch, axis::right},
                                                     {&RollPitchYaw::roll, axis::forward}}},
                                          .zero_heading = pi / 2};

/// Yaw counter-clockwise from east, pitch nose down, roll right wing down: body axes forward, left,
/// up in a world of east, north, up. Source: ROS REP 103.
inline const AngleConvention ros_roll_pitch_yaw{.turns = {{{&RollPitchYaw::yaw, axis::up},
                                                           {&RollPitchYaw::pitch, -axis::right},
                                                           {&RollPitchYaw::roll, axis::forward}}},
                                                .zero_heading = pi / 2};

/// Attitude, from the body to the world, of angles in a convention.
[[nodiscard]] inline Rotation rotation_of(const RollPitchYaw& angles, const AngleConvention& convention) noexcept {
  Rotation rotation = rotation_about(axis::up, -convention.zero_heading);
  for (const ElementalRotation& turn : convention.turns)
    rotation = rotation * rotation_about(turn.axis, angles.*turn.angle);
  return normalize(rotation);
}

/// Angles of an attitude, from the body to the world, in a convention: the middle one in [-pi/2,
/// pi/2], the others in [-pi, pi]. They reproduce the attitude to some 1e-14 everywhere. In gimbal
/// lock (middle angle +-pi/2) all rotation is yaw, or the first angle if yaw is in the middle.
/// Source: half-angle sums as in Bernardes & Viollet 2022, PLoS ONE 17(11), e0276302.
[[nodiscard]] inline RollPitchYaw roll_pitch_yaw(const Rotation& rotation, const AngleConvention& convention) noexcept {
  const auto& [first, middle, last] = convention.turns;
  const Rotation q = rotation_about(axis::up, convention.zero_heading) * rotation;
  const Vec3 v{q.x, q.y, q.z};
  const double sense = dot(cross(first.axis, middle.axis), last.axis) < 0 ? -1 : 1;  // handedness
  const double a = dot(v, first.axis), b = sense * dot(v, middle.axis), c = dot(v, last.axis);
  // With the angles A, B, C of the turns, q is, up to length and sign,
  //   w + b = (cos B/2 + sin B/2) cos (A+C)/2,  a + c = (cos B/2 + sin B/2) sin (A+C)/2,
  //   w - b = (cos B/2 - sin B/2) cos (A-C)/2,  a - c = (cos B/2 - sin B/2) sin (A-C)/2.
  const double plus = std::hypot(q.w + b, a + c), minus = std::hypot(q.w - b, a - c);
  double half_sum = std::atan2(a + c, q.w + b), half_difference = std::atan2(a - c, q.w - b);
  constexpr double rounding = 1e-14;                              // below it, one of the two is noise
  const double sign = last.angle == &RollPitchYaw::yaw ? -1 : 1;  // -1: the first angle is zero
  if (plus < rounding)
    half_sum = sign * half_difference;
  else if (minus < rounding)
    half_difference = sign * half_sum;
  RollPitchYaw angles;
  angles.*first.angle = std::remainder(half_sum + half_difference, 2 * pi);
  angles.*middle.angle = sense * (2 * std::atan2(plus, minus) - pi / 2);
  angles.*last.angle = std::remainder(half_sum - half_difference, 2 * pi);
  return angles;
}

/// Directions of the axes x, y and z of a body.
enum class BodyAxes : std::uint8_t {
  right_forward_up,    ///< of this library
  forward_right_down,  ///< aviation. Source: ISO 1151-1
  forward_left_up,     ///< robotics. Source: ROS REP 103
};

/// Directions of the axes x, y and z of the world.
enum class WorldAxes : std::uint8_t {
  east_north_up,    ///< of this library
  north_east_down,  ///< aviation
};

/// Axes of a file's positions and quaternions.
struct Axes {
  BodyAxes body = BodyAxes::right_forward_up;  ///< of the body
  WorldAxes world = WorldAxes::east_north_up;  ///< of the world

  /// Position from these world axes in east, north, up, and back: the swap is its own inverse.
  [[nodiscard]] Vec3 swapped(const Vec3& position) const noexcept {
    return world == WorldAxes::east_north_up ? position : Vec3{position.y, position.x, -position.z};
  }

  /// Attitude between these axes as one from right, forward, up to east, north, up.
  [[nodiscard]] Rotation from_file(const Rotation& rotation) const noexcept {
    return of_world() * rotation * conjugate(of_body());
  }

  /// Inverse of `from_file`.
  [[nodiscard]] Rotation to_file(const Rotation& rotation) const noexcept {
    return conjugate(of_world()) * rotation * of_body();
  }

 private:
  // (x, y, z) becomes (y, x, -z)
  static Rotation down_from_up() noexcept { return rotation_about(axis::right + axis::forward, pi); }

  [[nodiscard]] Rotation of_world() const noexcept {
    return world == WorldAxes::east_north_up ? no_rotation : down_from_up();
  }
  [[nodiscard]] Rotation of_body() const noexcept {
    if (body == BodyAxes::right_forward_up) return no_rotation;
    return body == BodyAxes::forward_right_down ? down_from_up() : rotation_about(axis::up, pi / 2);
  }
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
