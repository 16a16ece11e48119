// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include <pulsecast/base/frame.hpp>
#include <pulsecast/base/tick.hpp>

namespace pulsecast {

/// How a beam widens: full angles at 1/e^2 of the peak irradiance [rad]; one number if the beam is round.
struct Divergence {
  double across;  ///< along the beam's x [rad]
  double up;      ///< along the beam's z [rad]

  constexpr Divergence(double both) noexcept : across(both), up(both) {}
  constexpr Divergence(double across_, double up_) noexcept : across(across_), up(up_) {}

  /// Up by across: 1 if the beam is round.
  [[nodiscard]] constexpr double aspect() const noexcept { return up == across ? 1 : up / across; }

  friend bool operator==(const Divergence&, const Divergence&) = default;
};

/// What a laser sends, in the terms of its data sheet. A beam from a point, or through one, has a waist without diameter. Ranges are those
/// that `Scanner` takes: received powers, which may be 10^-30 of what was sent, keep clear of the ends of a double's range, squared too.
struct Laser {
  double wavelength = 1.064e-6;    ///< from 10 nm to 1 cm [m]
  double peak_power = 4;           ///< of a pulse, from 1e-20 to 1e20 [W]
  double pulse_length = 4e-9;      ///< full width at half maximum, from 1 fs to 1 s [s]
  Divergence divergence = 0.3e-3;  ///< from 0 to 30 degrees; across and up within a factor of 1e6 of each other [rad]
  double waist_diameter = 0;       ///< at 1/e^2, where the beam is narrowest: across; up, in the proportion of the divergences [m]
  double waist_range = 0;          ///< where that is, from the exit: a focus if it is positive [m]

  [[nodiscard]] bool from_a_point() const noexcept { return waist_diameter == 0 && waist_range == 0; }

  friend bool operator==(const Laser&, const Laser&) = default;
};

/// One laser pulse, as seen from a frame.
template <class Frame>
struct Pulse {
  PulseIndex index = 0;                                ///< slot in the source that was asked
  Tick tick{};                                         ///< when it leaves, since the survey's start
  Pose<frame::Beam, Frame> pose{};                     ///< where it leaves, and how it is turned
  std::optional<Pose<frame::Beam, Frame>> reported{};  ///< what the instrument takes its pose for; empty if it knows it
  Laser laser{};
  double scan_angle = 0;     ///< about the body's forward axis: 0 down, positive to the right, in [-pi, pi] [rad]; set by a platform
  std::uint16_t leg = 0;     ///< number of the leg or strip that it belongs to, from 0
  std::uint8_t channel = 0;  ///< number of the emitter in a device of several, from 0

  Pulse() = default;

  /// The pulse as seen from a frame that surrounds its own. What was reported in the inner frame is of no use in the outer one.
  template <class Inner>
  Pulse(const Pose<Inner, Frame>& outer_from_inner, const Pulse<Inner>& p) noexcept
      : index(p.index),
        tick(p.tick),
        pose(outer_from_inner * p.pose),
        laser(p.laser),
        scan_angle(p.scan_angle),
        leg(p.leg),
        channel(p.channel) {}

  [[nodiscard]] const Vec3& origin() const noexcept { return pose.position; }
  [[nodiscard]] Vec3 direction() const noexcept { return pose.rotation * axis::forward; }
};

}  // namespace pulsecast
