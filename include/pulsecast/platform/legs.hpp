// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_LEGS_HPP
#define PULSECAST_PLATFORM_LEGS_HPP

#include <pulsecast/base/search.hpp>
#include <pulsecast/pulse_lanes.hpp>

namespace PULSECAST_NAMESPACE {

/// Pass of a platform. An inactive leg, as a turn between strips, takes its time but has no slots.
template <WorldSource P>
struct Leg {
  P platform;                   ///< carrier of the instrument
  bool active = true;           ///< true if pulses are emitted
  std::optional<Tick> start{};  ///< since the survey's; by default the end of the leg before
};

/// Passes in sequence, of one type of platform: set-ups of a tripod, strips of a flight. Each leg's
/// clock starts at zero; the survey's time goes on from leg to leg, or from the start that a leg
/// states: such legs may leave gaps and overlap. Legs with equal tables of emitters share one.
template <WorldSource P>
class Legs {
 public:
  using refinements = refines<tag::MakesLanes>;
  /// 1 to 65535 legs, of at most 2^60 slots, 1e15 s and `max_emitters`. @throws SettingError
  explicit Legs(std::vector<Leg<P>> legs) {
    require_within("Legs::legs (number)", legs.size(), 1, 65535, "");
    PulseIndex first = 0;
    Tick start{}, last{};
    for (Leg<P>& leg : legs) {
      start = leg.start.value_or(start);
      require_within("Legs::legs (start)", start.seconds(), 0, 1e15, "s");
      starts_.push_back({first, start});
      if (leg.active && leg.platform.size() > 0) {
        require_within("Legs::legs (slots)", static_cast<double>(first) + static_cast<double>(leg.platform.size()), 0,
                       0x1p60, "");
        first += leg.platform.size();
        starts_.back().first_emitter = add_emitters(leg.platform.emitters());
      }
      if constexpr (DrawsByLeg<P>) leg.platform.draw_for_leg(static_cast<std::uint32_t>(legs_.size()));
      start = start + leg.platform.duration();
      require_within("Legs::legs (duration)", start.seconds(), 0, 1e15, "s");
      last = last < start ? start : last;
      legs_.push_back(std::move(leg.platform));
    }
    end_ = {first, last};
  }

  /// All legs active.
  explicit Legs(std::vector<P> legs) : Legs(active(std::move(legs))) {}

  [[nodiscard]] PulseIndex size() const noexcept { return end_.pulse; }
  [[nodiscard]] Tick duration() const noexcept { return end_.tick; }
  /// Emitters of the legs that have slots.
  [[nodiscard]] std::vector<Emitter> emitters() const { return emitters_; }

  [[nodiscard]] std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept { return pulse_lanes(i, 1)[0]; }

  [[nodiscard]] PulseLanes<frame::World> pulse_lanes(PulseIndex i, std::size_t count) const noexcept {
    const std::size_t k = leg_of(i);
    const PulseIndex slot = i - starts_[k].pulse, left = legs_[k].size() - slot;
    auto p = find_pulses(legs_[k], slot, left < count ? left : count);
    p.tick = p.tick + starts_[k].tick;
    p.leg.fill(static_cast<std::uint16_t>(k));
    for (std::uint16_t& emitter : p.emitter) emitter = static_cast<std::uint16_t>(starts_[k].first_emitter + emitter);
    return p;
  }

  /// First slot of the first leg, in their order, that has one at a time or after it.
  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept requires FindsSlots<P> {
    for (std::size_t k = 0; k < legs_.size(); ++k) {
      const PulseIndex first = starts_[k].pulse, end = k + 1 < starts_.size() ? starts_[k + 1].pulse : size();
      if (first == end) continue;
      const Tick of_leg = t - starts_[k].tick - Tick::of_seconds(4e-16);  // as both round
      if (const PulseIndex slot = first + legs_[k].slot_from(of_leg); slot < end) return slot;
    }
    return size();
  }

  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept requires SkipsBlocked<P> {
    const std::size_t k = leg_of(i);
    return starts_[k].pulse + legs_[k].next_pulse(i - starts_[k].pulse);
  }

  /// Errors of the leg of a slot, as the concept StatesErrors requires.
  template <class Visit>
  void visit_errors(PulseIndex i, Tick t, const Visit& visit) const noexcept requires StatesErrors<P> {
    const std::size_t k = leg_of(i);
    legs_[k].visit_errors(i - starts_[k].pulse, t - starts_[k].tick, visit);
  }

  [[nodiscard]] const std::vector<P>& legs() const noexcept { return legs_; }  ///< platforms in order

  /// Begin of leg k since the survey's start.
  [[nodiscard]] Tick start(std::size_t k) const noexcept { return starts_[k].tick; }

  /// Index of the leg of slot i.
  [[nodiscard]] std::size_t leg_of(PulseIndex i) const noexcept {
    return detail::first_not(starts_.size(), [&](std::size_t k) noexcept { return starts_[k].pulse <= i; }) - 1;
  }

 private:
  struct Start {
    PulseIndex pulse;
    Tick tick;
    std::uint16_t first_emitter = 0;  // index of its table in that of all legs
  };

  /// Index of a leg's table in that of all legs: appended, unless an earlier leg has an equal one.
  std::uint16_t add_emitters(const std::vector<Emitter>& table) {
    const std::size_t size = emitters_.size();
    for (std::size_t first = 0; first + table.size() <= size; ++first)
      if (std::equal(table.begin(), table.end(), emitters_.begin() + static_cast<std::ptrdiff_t>(first)))
        return static_cast<std::uint16_t>(first);
    require_within("Legs::legs (emitters)", size + table.size(), 0, max_emitters, "");
    for (const Emitter& emitter : table) emitters_.push_back(emitter);
    return static_cast<std::uint16_t>(size);
  }

  static std::vector<Leg<P>> active(std::vector<P> platforms) {
    std::vector<Leg<P>> legs;
    for (P& platform : platforms) legs.push_back({std::move(platform)});
    return legs;
  }

  std::vector<P> legs_;
  std::vector<Start> starts_;
  std::vector<Emitter> emitters_;
  Start end_{};
};

}  // namespace PULSECAST_NAMESPACE

#endif
