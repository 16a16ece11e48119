// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PULSE_HPP
#define PULSECAST_PULSE_HPP

#include <optional>

#include <pulsecast/base/lanes.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/base/scan_angle.hpp>
#include <pulsecast/base/units.hpp>

namespace PULSECAST_NAMESPACE {

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

/// Laser, in the terms of its data sheet. A beam from or through a point has a waist of zero diameter. The ranges keep
/// received powers, down to 10^-30 of the power sent, and their squares within a double's range.
struct Laser {
  double wavelength = 1.064e-6;    ///< wavelength, from 10 nm to 1 cm [m]
  double peak_power = 4;           ///< peak power of a pulse, from 1e-20 to 1e20 [W]
  double pulse_length = 4e-9;      ///< full width at half maximum, from 1 fs to 1 s [s]
  Divergence divergence = 0.3e-3;  ///< full angles, from 0 to 30 degrees; across and up within a factor of 1e6 [rad]
  double waist_diameter = 0;       ///< waist at 1/e^2, across; up in proportion to the divergences [m]
  double waist_range = 0;          ///< distance of the waist from the exit; a focus if positive [m]

  /// Energy of a pulse: peak power times pulse length [J].
  [[nodiscard]] double energy() const noexcept { return peak_power * pulse_length; }

  /// True if the beam diverges from the exit point.
  [[nodiscard]] bool from_a_point() const noexcept { return waist_diameter == 0 && waist_range == 0; }

  void validate() const {
    using namespace literals;
    require_within("Laser::wavelength", wavelength, 1e-8, 1e-2, "m");
    require_within("Laser::peak_power", peak_power, 1e-20, 1e20, "W");
    require_within("Laser::pulse_length", pulse_length, 1e-15, 1, "s");
    require_within("Laser::divergence", divergence.across, 0, 30_deg, "rad");
    require_within("Laser::divergence", divergence.up, 0, 30_deg, "rad");
    if ((divergence.across > 0) != (divergence.up > 0))
      throw SettingError("Laser::divergence", 0, "rad", "greater than 0 both across and up, or neither");
    require_within("Laser::divergence (up by across)", divergence.aspect(), 1e-6, 1e6, "");
    require_not_negative("Laser::waist_diameter", waist_diameter, "m");
    require_finite("Laser::waist_range", waist_range, "m");
  }

  friend bool operator==(const Laser&, const Laser&) = default;
};

/// Emitter of a device, with the number of its receiver. A pulse source lists its emitters once, and each pulse refers
/// to its emitter by number.
struct Emitter {
  Laser laser{};               ///< laser of its pulses
  double footprint_scale = 1;  ///< factor of the footprint's offsets, from 0 to 1000; 1: in units of the 1/e^2 radius
  std::uint16_t receiver = 0;  ///< index of its receiver in the survey
  std::uint16_t channel = 0;   ///< number in its device, from 0, as in `Shot`

  void validate() const {
    laser.validate();
    require_within("Emitter::footprint_scale", footprint_scale, 0, 1000, "");
  }

  friend bool operator==(const Emitter&, const Emitter&) = default;
};

inline constexpr std::size_t max_emitters = 65'535;  ///< limit of the emitters of a source

namespace detail {

/// Data of a pulse that the platform adds.
template <class Frame>
struct PulseOnPlatform {};

template <>
struct PulseOnPlatform<frame::World> {
  std::optional<Pose<frame::Beam, frame::World>> reported{};  ///< pose as measured by the instrument; empty if exact
  ScanAngle scan_angle{};  ///< angle of the beam from the vertical, to the right, a number [rad]
  std::uint16_t leg = 0;   ///< number of its leg, from 0
};

/// Data of pulses in lanes that no stage before the platform knows.
template <class Frame>
struct LanesOnPlatform {};

template <>
struct LanesOnPlatform<frame::World> {
  simd::Mask reports{};                                  ///< lanes whose `reported` is not empty
  PoseLanes<frame::Beam, frame::World> reported{};       ///< as in `Pulse`
  std::array<ScanAngle, simd::lane_count> scan_angle{};  ///< as in `Pulse` [rad]
  std::array<std::uint16_t, simd::lane_count> leg{};     ///< as in `Pulse`
};

}  // namespace detail

/// One laser pulse, in a frame. In the world it also has `reported`, `scan_angle` and `leg`.
template <class Frame>
struct Pulse : detail::PulseOnPlatform<Frame> {
  Tick tick{};                      ///< emission time, since the survey's start
  Pose<frame::Beam, Frame> pose{};  ///< pose at the exit
  std::uint16_t emitter = 0;        ///< index in the emitters of its source

  Pulse() = default;

  /// Transforms a pulse into the frame around its own.
  template <class Inner>
  Pulse(const Pose<Inner, Frame>& outer_from_inner, const Pulse<Inner>& p) noexcept
      : tick(p.tick), pose(outer_from_inner * p.pose), emitter(p.emitter) {}

  /// Exit of the beam [m].
  [[nodiscard]] const Vec3& origin() const noexcept { return pose.position; }
  /// Unit vector along the beam.
  [[nodiscard]] Vec3 direction() const noexcept { return pose.rotation * axis::forward; }
};

/// Pulses of consecutive slots, one in each lane of a register, in a frame.
template <class Frame>
struct PulseLanes : detail::LanesOnPlatform<Frame> {
  std::size_t size = 0;                  ///< number of slots, from the first lane on
  simd::Mask sent{};                     ///< lanes with a pulse; the others are blocked, or beyond the slots
  TickLanes tick{};                      ///< emission times, since the survey's start
  PoseLanes<frame::Beam, Frame> pose{};  ///< poses at the exit
  std::array<std::uint16_t, simd::lane_count> emitter{};  ///< as in `Pulse`

  PulseLanes() = default;

  /// Transforms the pulses into the frame around their own.
  template <class Inner>
  PulseLanes(const PoseLanes<Inner, Frame>& outer_from_inner, const PulseLanes<Inner>& p) noexcept
      : size(p.size), sent(p.sent), tick(p.tick), pose(outer_from_inner * p.pose), emitter(p.emitter) {}

  /// Pulse of a lane; empty if it is blocked.
  [[nodiscard]] std::optional<Pulse<Frame>> operator[](std::size_t lane) const noexcept {
    std::optional<Pulse<Frame>> p;
    get(lane, p);
    return p;
  }
  /// As above, into memory of the caller.
  [[gnu::always_inline]] void get(std::size_t lane, std::optional<Pulse<Frame>>& p) const noexcept {
    p.reset();
    if (sent[lane] == 0) return;
    p.emplace();
    p->tick = tick[lane];
    p->pose = pose[lane];
    p->emitter = emitter[lane];
    if constexpr (std::is_same_v<Frame, frame::World>) {
      if (this->reports[lane] != 0) p->reported = this->reported[lane];
      p->scan_angle = this->scan_angle[lane];
      p->leg = this->leg[lane];
    }
  }

  /// Appends the next slot, of which there are less than `simd::lane_count`.
  void push_back(const std::optional<Pulse<Frame>>& p) noexcept {
    const std::size_t lane = size++;
    if (!p) return;
    sent[lane] = -1;
    tick.set(lane, p->tick);
    pose.set(lane, p->pose);
    emitter[lane] = p->emitter;
    if constexpr (std::is_same_v<Frame, frame::World>) {
      if (p->reported) this->report(lane, *p->reported);
      this->scan_angle[lane] = p->scan_angle;
      this->leg[lane] = p->leg;
    }
  }

  /// Sets the pose of a lane as measured by the instrument.
  void report(std::size_t lane,
              const Pose<frame::Beam, frame::World>& p) noexcept requires std::same_as<Frame, frame::World> {
    this->reports[lane] = -1;
    this->reported.set(lane, p);
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
