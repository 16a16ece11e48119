// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCANNER_SCANNER_HPP
#define PULSECAST_SCANNER_SCANNER_HPP

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Pulsed laser at a constant rate: the innermost stage of every pipeline.
struct Scanner {
  using refinements = refines<tag::FindsSlots, tag::MakesLanes, tag::StridesLanes, tag::Validated>;
  static constexpr bool strides_lanes = true;
  double pulse_rate = 100e3;      ///< pulse repetition rate, from 1e-3 to 1e12 [Hz]
  PulseIndex pulses = 1'000'000;  ///< number of slots, at most 2^52, and no longer than 1e15 s
  double delay = 0;               ///< delay after the begin of a slot; less than one slot [s]
  Laser laser{};                  ///< laser of every pulse
  double footprint_scale = 1;     ///< as in `Emitter`
  std::uint16_t receiver = 0;     ///< as in `Emitter`

  void validate() const {
    require_within("Scanner::pulse_rate", pulse_rate, 1e-3, 1e12, "Hz");
    require_within("Scanner::pulses", pulses, 0, 0x1p52, "");  // as in `Tick`
    require_within("Scanner::pulses (duration)", static_cast<double>(pulses) / pulse_rate, 0, 1e15, "s");
    if (!(delay >= 0 && delay < 1 / pulse_rate))
      throw SettingError("Scanner::delay", delay, "s",
                         text::joined({"at least 0 and less than ", text::to_text(1 / pulse_rate)}));
    emitter().validate();
  }

  [[nodiscard]] PulseIndex size() const noexcept { return pulses; }
  [[nodiscard]] Tick duration() const noexcept { return Tick::of(pulses, pulse_rate); }
  [[nodiscard]] std::vector<Emitter> emitters() const { return {emitter()}; }

  [[nodiscard]] std::optional<Pulse<frame::Beam>> pulse(PulseIndex i) const noexcept { return pulse_lanes(i, 1)[0]; }

  [[nodiscard]] PulseLanes<frame::Beam> pulse_lanes(PulseIndex i, std::size_t count,
                                                    PulseIndex step = 1) const noexcept {
    PulseLanes<frame::Beam> p;
    p.size = count;
    p.sent = first_lanes(count);
    p.tick = TickLanes::of(i, pulse_rate, step) + Tick::of_seconds(delay);
    return p;
  }

  /// First slot at or after a time.
  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept {
    const double periods = (t.seconds() - delay) * pulse_rate * (1 - 0x1p-50);  // rounded down
    if (!(periods > 0)) return 0;
    if (periods >= static_cast<double>(pulses)) return pulses;
    const auto before = static_cast<PulseIndex>(periods);
    return Tick::of(before, pulse_rate) + Tick::of_seconds(delay) < t ? before + 1 : before;
  }

 private:
  [[nodiscard]] Emitter emitter() const noexcept { return {laser, footprint_scale, receiver}; }
};

}  // namespace PULSECAST_NAMESPACE

#endif
