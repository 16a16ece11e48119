// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCANNER_SCANNER_HPP
#define PULSECAST_SCANNER_SCANNER_HPP

#include <optional>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast {

/// Pulsed laser at a constant rate: the innermost stage of every pipeline.
struct Scanner {
  double pulse_rate = 100e3;      ///< pulse repetition rate, at most 1e12 [Hz]
  PulseIndex pulses = 1'000'000;  ///< number of slots, at most 2^52, and no longer than 1e15 s
  double delay = 0;               ///< delay of every pulse after the begin of its slot; less than one slot [s]
  Laser laser{};                  ///< laser of every pulse

  void validate() const {
    using namespace literals;
    require_rate("Scanner::pulse_rate", pulse_rate);
    require_within("Scanner::pulses", static_cast<double>(pulses), 0, 0x1p52, "");  // limit of the counts in `Tick` and `step_in_cycle`
    require_within("Scanner::pulses (duration)", static_cast<double>(pulses) / pulse_rate, 0, 1e15, "s");
    if (!(delay >= 0 && delay < 1 / pulse_rate))
      throw SettingError("Scanner::delay", delay, "s", detail::joined({"at least 0 and less than ", detail::to_text(1 / pulse_rate)}));
    require_within("Laser::wavelength", laser.wavelength, 1e-8, 1e-2, "m");
    require_within("Laser::peak_power", laser.peak_power, 1e-20, 1e20, "W");
    require_within("Laser::pulse_length", laser.pulse_length, 1e-15, 1, "s");
    require_within("Laser::divergence", laser.divergence.across, 0, 30_deg, "rad");
    require_within("Laser::divergence", laser.divergence.up, 0, 30_deg, "rad");
    if ((laser.divergence.across > 0) != (laser.divergence.up > 0))
      throw SettingError("Laser::divergence", 0, "rad", "greater than 0 both across and up, or neither");
    require_within("Laser::divergence (up by across)", laser.divergence.aspect(), 1e-6, 1e6, "");
    require_not_negative("Laser::waist_diameter", laser.waist_diameter, "m");
    require_finite("Laser::waist_range", laser.waist_range, "m");
  }

  [[nodiscard]] PulseIndex size() const noexcept { return pulses; }
  [[nodiscard]] Tick duration() const noexcept { return Tick::of(pulses, pulse_rate); }

  [[nodiscard]] std::optional<Pulse<frame::Beam>> pulse(PulseIndex i) const noexcept {
    std::optional<Pulse<frame::Beam>> p(std::in_place);
    p->index = i;
    p->tick = Tick::of(i, pulse_rate) + Tick::of_seconds(delay);
    p->laser = laser;
    return p;
  }
};

static_assert(BeamSource<Scanner>);

}  // namespace pulsecast

#endif
