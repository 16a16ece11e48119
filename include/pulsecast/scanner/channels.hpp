// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCANNER_CHANNELS_HPP
#define PULSECAST_SCANNER_CHANNELS_HPP

#include <pulsecast/pulse_lanes.hpp>

namespace PULSECAST_NAMESPACE {

/// Device with many emitters, each a pulse source with its own laser, origin and optic, all in one
/// frame and of one type. Of n channels, slot i is slot `i / n` of channel `i % n`. Emitters that
/// fire in turn differ in `Scanner::delay`, which must not decrease from channel to channel;
/// emitters that fire together share it. The emitters of channel k have the channel number k.
template <class Source>
requires BeamSource<Source> || InstrumentSource<Source> || WorldSource<Source>
class Channels {
 public:
  using refinements = refines<tag::MakesLanes>;
  static constexpr bool strides_lanes = detail::MakesStridedLanes<Source>;
  /// 1 to `max_emitters` channels and emitters, of one size and duration. @throws SettingError
  explicit Channels(std::vector<Source> channels) : channels_(std::move(channels)) {
    require_within("Channels::channels (number)", channels_.size(), 1, max_emitters, "");
    std::size_t emitters = 0;
    for (Source& c : channels_) {
      c = validated(std::move(c));
      first_emitter_.push_back(static_cast<std::uint16_t>(emitters));
      emitters += c.emitters().size();
      require_within("Channels::channels (emitters)", emitters, 0, max_emitters, "");
    }
    const double slots = static_cast<double>(channels_[0].size()), time = duration().seconds();
    for (const Source& c : channels_) {
      require_within("Channels::channels (slots)", c.size(), slots, slots, "");
      require_within("Channels::channels (duration)", c.duration().seconds(), time, time, "s");
    }
    require_order();
  }

  [[nodiscard]] PulseIndex size() const noexcept { return channels_.size() * channels_[0].size(); }
  [[nodiscard]] Tick duration() const noexcept { return channels_[0].duration(); }
  [[nodiscard]] std::vector<Emitter> emitters() const {
    std::vector<Emitter> all;
    for (std::size_t k = 0; k < channels_.size(); ++k)
      for (Emitter& emitter : channels_[k].emitters()) {
        emitter.channel = static_cast<std::uint16_t>(k);
        all.push_back(emitter);
      }
    return all;
  }

  [[nodiscard]] auto pulse(PulseIndex i) const noexcept -> decltype(std::declval<const Source&>().pulse(i)) {
    return pulse_lanes(i, 1)[0];
  }

  [[nodiscard]] auto pulse_lanes(PulseIndex i, std::size_t count, PulseIndex step = 1) const noexcept {
    const std::size_t n = channels_.size();
    if (step % n == 0) {  // all of one channel
      auto all = find_pulses(channels_[i % n], i / n, count, step / n);
      for (std::uint16_t& emitter : all.emitter) emitter = static_cast<std::uint16_t>(emitter + first_emitter_[i % n]);
      return all;
    }
    detail::PulsesOf<Source> all;
    for (; all.size < count; i += step) {
      all.push_back(find_pulses(channels_[i % n], i / n, 1)[0]);
      std::uint16_t& emitter = all.emitter[all.size - 1];
      emitter = static_cast<std::uint16_t>(emitter + first_emitter_[i % n]);
    }
    return all;
  }

  [[nodiscard]] PulseIndex slot_from(Tick t) const noexcept requires FindsSlots<Source> {
    const PulseIndex n = channels_.size();
    PulseIndex first = size();  // of the first slots of all channels
    for (PulseIndex k = 0; k < n; ++k) first = std::min(first, channels_[k].slot_from(t) * n + k);
    return first;
  }

  [[nodiscard]] PulseIndex next_pulse(PulseIndex i) const noexcept requires SkipsBlocked<Source> {
    const PulseIndex n = channels_.size(), most = size();
    PulseIndex next = most;  // first of the next slots of all channels
    for (PulseIndex slot = i; slot < std::min(most, i + n) && slot < next; ++slot)
      next = std::min(next, channels_[slot % n].next_pulse(slot / n) * n + slot % n);
    return std::min(next, most);
  }

  [[nodiscard]] auto measured(PulseIndex i, Tick t) const noexcept requires MeasuresBeam<Source> {
    return channels_[i % channels_.size()].measured(i / channels_.size(), t);
  }

  /// Errors of the channel of a slot, as the concept StatesErrors requires.
  template <class Visit>
  void visit_errors(PulseIndex i, Tick t, const Visit& visit) const noexcept requires StatesErrors<Source> {
    channels_[i % channels_.size()].visit_errors(i / channels_.size(), t, visit);
  }

  [[nodiscard]] const std::vector<Source>& channels() const noexcept { return channels_; }  ///< in firing order

 private:
  /// Throws a `SettingError` if time decreases from one pulse to the next in the first or the last
  /// two rounds, and more of the first until every channel has fired, as an optic may block it.
  /// Channels of one rate show their order in any round.
  void require_order() const {
    constexpr PulseIndex max_waiting = 4096;  // slots in which a channel may be blocked
    const PulseIndex n = channels_.size(), some = 2 * n + max_waiting;
    std::vector<bool> fired(channels_.size());
    std::size_t waiting = channels_.size();
    std::optional<Tick> last;
    const auto require_next = [&](PulseIndex i) {
      const auto p = pulse(i);
      if (!p) return;
      if (last && p->tick < *last)
        throw SettingError("Channels::channels (pulse of channel " + std::to_string(i % n) + ")", p->tick.seconds(),
                           "s", "at least that of the previous channel, " + text::to_text(last->seconds()) + " s");
      last = p->tick;
      if (!fired[i % n]) --waiting;
      fired[i % n] = true;
    };
    PulseIndex i = 0;
    for (; i < std::min(size(), some) && (i < 2 * n || waiting > 0); ++i) require_next(i);
    for (i = std::max(i, size() - std::min(size(), 2 * n)); i < size(); ++i) require_next(i);
  }

  std::vector<Source> channels_;
  std::vector<std::uint16_t> first_emitter_;  // of each channel, in the table of all
};

}  // namespace PULSECAST_NAMESPACE

#endif
