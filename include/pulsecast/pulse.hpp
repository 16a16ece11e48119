// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PULSE_HPP
#define PULSECAST_PULSE_HPP

#include <cstdint>
#include <optional>

#include <pulsecast/base/frame.hpp>
#include <pulsecast/base/tick.hpp>

namespace pulsecast {

/// Beam divergence: full angles at 1/e^2 of the peak irradiance [rad]; one number for a round beam.
struct Divergence {
  double across;  ///< full angle along the beam's x [rad]
  double up;      ///< full angle along the beam's z [rad]

  /// Round beam.
  constexpr Divergence(double both) noexcept : across(both), up(both) {}
  /// Elliptical beam.
  constexpr Divergence(double across_, double up_) noexcept : across(across_), up(up_) {}

  /// Ratio of up to across: 1 for a round beam.
  [[nodiscard]] constexpr double aspect() const noexcept { return up == across ? 1 : up / across; }

  friend bool operator==(const Divergence&, const Divergence&) = default;
};

/// Laser, in the terms of its data sheet. A beam from or through a point has a waist of zero diameter. `Scanner` enforces the ranges: they
/// keep received powers, down to 10^-30 of the power sent, and their squares within a double's range.
struct Laser {
  double wavelength = 1.064e-6;    ///< wavelength, from 10 nm to 1 cm [m]
  double peak_power = 4;           ///< peak power of a pulse, from 1e-20 to 1e20 [W]
  double pulse_length = 4e-9;      ///< full width at half maximum, from 1 fs to 1 s [s]
  Divergence divergence = 0.3e-3;  ///< full angles, from 0 to 30 degrees; across and up within a factor of 1e6 of each other [rad]
  double waist_diameter = 0;       ///< waist at 1/e^2, across; up in proportion to the divergences [m]
  double waist_range = 0;          ///< distance of the waist from the exit; a focus if positive [m]

  /// True if the beam diverges from the exit point.
  [[nodiscard]] bool from_a_point() const noexcept { return waist_diameter == 0 && waist_range == 0; }

  friend bool operator==(const Laser&, const Laser&) = default;
};

/// One laser pulse, in a frame.
template <class Frame>
struct Pulse {
  PulseIndex index = 0;                                ///< slot in its source
  Tick tick{};                                         ///< emission time, since the survey's start
  Pose<frame::Beam, Frame> pose{};                     ///< pose at the exit
  std::optional<Pose<frame::Beam, Frame>> reported{};  ///< pose as known to the instrument; empty if exact
  Laser laser{};                                       ///< laser that emitted the pulse
  double scan_angle = 0;     ///< angle about the body's forward axis: 0 down, positive to the right, in [-pi, pi] [rad]; set by a platform
  std::uint16_t leg = 0;     ///< number of its leg or strip, from 0
  std::uint8_t channel = 0;  ///< number of the emitter in a multi-emitter device, from 0

  Pulse() = default;

  /// Transforms a pulse into the frame around its own. Drops `reported`, which is of no use there.
  template <class Inner>
  Pulse(const Pose<Inner, Frame>& outer_from_inner, const Pulse<Inner>& p) noexcept
      : index(p.index),
        tick(p.tick),
        pose(outer_from_inner * p.pose),
        laser(p.laser),
        scan_angle(p.scan_angle),
        leg(p.leg),
        channel(p.channel) {}

  /// Exit of the beam [m].
  [[nodiscard]] const Vec3& origin() const noexcept { return pose.position; }
  /// Unit vector along the beam.
  [[nodiscard]] Vec3 direction() const noexcept { return pose.rotation * axis::forward; }
};

}  // namespace pulsecast

#endif
