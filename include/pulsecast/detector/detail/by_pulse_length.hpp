// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_BY_PULSE_LENGTH_HPP
#define PULSECAST_DETECTOR_DETAIL_BY_PULSE_LENGTH_HPP

#include <vector>

#include <pulsecast/pulse.hpp>

namespace PULSECAST_NAMESPACE {

/// Data that a detector prepares for each pulse length, of which a device has few.
template <class Prepared>
class ByPulseLength {
 public:
  /// Data for the pulse length of a laser; null without any.
  [[nodiscard]] const Prepared* find(const Laser& laser) const noexcept {
    for (const auto& [length, prepared] : known_)
      if (length == laser.pulse_length) return &prepared;
    return nullptr;
  }

  void add(const Laser& laser, Prepared prepared) { known_.emplace_back(laser.pulse_length, std::move(prepared)); }

  void each(const auto& visit) const {
    for (const auto& [length, prepared] : known_) visit(prepared);
  }

 private:
  std::vector<std::pair<double, Prepared>> known_;  ///< by full width at half maximum [s]
};

}  // namespace PULSECAST_NAMESPACE

#endif
