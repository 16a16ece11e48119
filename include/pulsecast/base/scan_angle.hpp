// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_SCAN_ANGLE_HPP
#define PULSECAST_BASE_SCAN_ANGLE_HPP

#include <cmath>
#include <limits>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE {

/// Angle of a beam from the vertical, about the level heading of the body: 0 straight down,
/// positive to the right, in [-pi, pi] [rad]; it includes roll. Made from a direction, it is
/// computed when read. Source: ASPRS LAS 1.4 R15, Scan Angle, formats 6 to 10.
class ScanAngle {
 public:
  ScanAngle() = default;
  /// Of an angle [rad].
  ScanAngle(double angle) noexcept : right_(angle), down_(none) {}  // NOLINT: is a number
  /// Of a direction with these components to the right and down, of any length.
  ScanAngle(double right, double down) noexcept : right_(std::isnan(down) ? down : right), down_(down) {}

  /// Angle [rad].
  operator double() const noexcept { return std::isnan(down_) ? right_ : std::atan2(right_, down_); }  // NOLINT

 private:
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double right_ = 0, down_ = 1;  ///< components of a direction; or an angle, beside NaN
};

}  // namespace PULSECAST_NAMESPACE

#endif
