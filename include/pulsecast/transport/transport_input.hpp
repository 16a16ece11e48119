// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_TRANSPORT_INPUT_HPP
#define PULSECAST_TRANSPORT_TRANSPORT_INPUT_HPP

#include <pulsecast/detector/radiometry.hpp>
#include <pulsecast/scanner/subray_directions.hpp>

namespace PULSECAST_NAMESPACE {

/// Light of one pulse, as a `Transport` takes it. Valid during the call.
struct TransportInput {
  const Pulse<frame::World>& pulse;  ///< tick, true pose, and reported pose unless exact
  PulseIndex index;                  ///< number of the pulse; with `seed`, key of random numbers
  std::uint64_t seed;                ///< seed of the survey
  const Emitter& emitter;            ///< emitter of the pulse
  const SubrayDirections& beam;      ///< subrays of the emitter, in the frame of the pose
  std::size_t subrays;               ///< number of subrays
  const LinkBudget& budget;          ///< link budget of emitter and receiver
  WhiteTarget& white_target;         ///< memory of that budget's last result
  RangeGate gate{};                  ///< range gate of the receiver
  std::span<SubrayRecord> record{};  ///< first surfaces of the subrays, to be set, if recorded

  /// The same light by other subrays, without a record.
  [[nodiscard]] TransportInput by(const SubrayDirections& others, std::size_t count) const noexcept {
    return {pulse, index, seed, emitter, others, count, budget, white_target, gate};
  }
  /// Energy of the pulse [J].
  [[nodiscard]] double energy() const noexcept { return emitter.laser.energy(); }
  /// Pose of the beam as known to the instrument.
  [[nodiscard]] const Pose<frame::Beam, frame::World>& reported() const noexcept {
    return pulse.reported ? *pulse.reported : pulse.pose;
  }
};

namespace detail {

/// Memory for the reflections of a pulse. Those that pulses seldom reach are not initialized.
[[nodiscard]] inline SharedBuffer<Reflection> room_for(std::size_t reflections, std::size_t subrays) {
  const SharedBuffer<Reflection> room(reflections);
  std::fill_n(room.begin(), std::min(reflections, 20 * subrays), Reflection{});
  return room;
}

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE

#endif
