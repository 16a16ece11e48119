// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DEFLECTOR_AIM_HPP
#define PULSECAST_DEFLECTOR_AIM_HPP

#include <pulsecast/base/lanes.hpp>

/// Beam poses from angles or directions, for optics.
namespace PULSECAST_NAMESPACE {

/// Pose of a beam at an elevation [rad]: rotated from forward towards up, about the right axis.
[[nodiscard]] inline Pose<frame::Beam, frame::Instrument> aimed_above(double angle) noexcept {
  return {detail::rotation_wxyz(std::cos(0.5 * angle), std::sin(0.5 * angle), 0, 0), {}};
}

/// Poses of beams at elevations [rad], as above.
[[nodiscard]] inline PoseLanes<frame::Beam, frame::Instrument> aimed_above(const simd::Doubles& angle) noexcept {
  return PoseLanes<frame::Beam, frame::Instrument>{RotationLanes::about(axis::right, angle)};
}

/// Pose of a beam from `origin` [m]: elevated, then turned to the right [rad]; right stays level.
[[nodiscard]] inline Pose<frame::Beam, frame::Instrument> aimed_at(double azimuth, double elevation,
                                                                   const Vec3& origin = {}) noexcept {
  const Rotation turn = detail::rotation_wxyz(std::cos(0.5 * azimuth), 0, 0, -std::sin(0.5 * azimuth));
  return {turn * aimed_above(elevation).rotation, origin};
}

/// Pose of a beam along a unit direction, by the shortest rotation from forward.
[[nodiscard]] inline Pose<frame::Beam, frame::Instrument> aimed_along(const Vec3& direction) noexcept {
  const double x = direction.x, y = direction.y, z = direction.z;
  const double aside_squared = x * x + z * z;
  if (y < 0 && aside_squared < 1e-300) return {detail::rotation_wxyz(0, 0, 0, 1), {}};  // back: about up
  const double w = y < 0 ? aside_squared / (1 - y) : 1 + y;  // 1 + y, without cancellation near -1
  return {normalize(detail::rotation_wxyz(w, z, 0, -x)), {}};
}

/// Poses of beams along unit directions, as above.
[[nodiscard]] inline PoseLanes<frame::Beam, frame::Instrument> aimed_along(const Vec3Lanes& direction) noexcept {
  const simd::Doubles &x = direction.x, &y = direction.y, &z = direction.z, zero{};
  const simd::Doubles aside_squared = x * x + z * z;
  const auto behind = y < 0.0, back = behind & (aside_squared < 1e-300);  // straight back
  const simd::Doubles w = behind ? aside_squared / (1.0 - y) : 1.0 + y, one = zero + 1.0;
  const RotationLanes shortest = normalize(RotationLanes{back ? one : w, z, zero, -x});
  return PoseLanes<frame::Beam, frame::Instrument>{
      RotationLanes{back ? zero : shortest.w, back ? zero : shortest.x, zero, back ? one : shortest.z}};
}

}  // namespace PULSECAST_NAMESPACE

#endif
