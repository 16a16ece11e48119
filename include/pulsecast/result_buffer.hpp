// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_RESULT_BUFFER_HPP
#define PULSECAST_RESULT_BUFFER_HPP

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Totals of a run.
struct RunSummary {
  PulseIndex slots = 0;                           ///< pulse slots done
  std::array<std::uint64_t, fate_count> fates{};  ///< slots by `Fate`
  EnergyLedger energy{};                          ///< energy by the end of its paths [J]
  std::uint64_t echoes = 0;                       ///< echoes found
  std::uint64_t rays = 0;                         ///< subrays traced
  std::uint64_t spread = 0;      ///< pulses whose light was spread over a smooth surface: `spread_over_plane`
  std::uint64_t unresolved = 0;  ///< of these, pulses that may have false echoes nevertheless
  double seconds = 0;            ///< duration [s]
  bool complete = true;          ///< false if stopped

  /// Adds the totals of another run, or of another part of the same run.
  void add(const RunSummary& other) noexcept {
    slots += other.slots;
    echoes += other.echoes;
    rays += other.rays;
    spread += other.spread;
    unresolved += other.unresolved;
    energy.add(other.energy);
    seconds += other.seconds;
    for (std::size_t f = 0; f < fate_count; ++f) fates[f] += other.fates[f];
    complete = complete && other.complete;
  }

  /// Slots of a fate.
  [[nodiscard]] std::uint64_t count(Fate fate) const noexcept { return fates[static_cast<std::size_t>(fate)]; }
  [[nodiscard]] PulseIndex pulses() const noexcept { return slots - count(Fate::blocked); }  ///< pulses sent
};

/// Results of successive slots, for single requests to a survey.
struct ResultBuffer {
  std::vector<Shot> shots{};            ///< as in `EchoBatch`
  std::vector<Echo> echoes{};           ///< as in `EchoBatch`
  std::vector<float> samples{};         ///< as in `EchoBatch`
  std::vector<SubrayRecord> subrays{};  ///< as in `EchoBatch`
  RunSummary counts{};                  ///< without rays and seconds

  /// Makes room for slots with an echo each.
  void reserve(PulseIndex slots) {
    shots.reserve(slots);
    echoes.reserve(slots);
  }

  /// Removes all results, and keeps the memory.
  void clear() noexcept {
    shots.clear();
    echoes.clear();
    samples.clear();
    subrays.clear();
    counts = {};
  }

  /// Appends the result of a slot. A shot without echo, waveform and subrays is only counted, unless `empty_shots`.
  void append(const Outcome& outcome, bool empty_shots = true) {
    ++counts.slots;
    ++counts.fates[static_cast<std::size_t>(outcome.shot.fate)];
    if (outcome.shot.fate == Fate::blocked) return;
    counts.energy.add(outcome.energy);
    counts.spread += outcome.spread ? 1 : 0;
    counts.unresolved += outcome.unresolved ? 1 : 0;
    if (!empty_shots && outcome.echoes.empty() && outcome.waveform.empty() && outcome.subrays.empty()) return;
    Shot& shot = shots.emplace_back(outcome.shot);
    shot.first_echo = static_cast<std::uint32_t>(echoes.size());
    shot.echoes = static_cast<std::uint32_t>(outcome.echoes.size());
    shot.first_sample = samples.size();
    shot.samples = static_cast<std::uint32_t>(outcome.waveform.size());
    for (const Echo& echo : outcome.echoes) echoes.push_back(echo);
    if (!outcome.waveform.empty()) samples.insert(samples.end(), outcome.waveform.begin(), outcome.waveform.end());
    for (const SubrayRecord& subray : outcome.subrays) subrays.push_back(subray);
    counts.echoes += outcome.echoes.size();
  }

  /// Counts blocked slots.
  void append_blocked(PulseIndex slots) noexcept {
    counts.slots += slots;
    counts.fates[static_cast<std::size_t>(Fate::blocked)] += slots;
  }

  /// Batch for the sinks; valid until this buffer changes.
  [[nodiscard]] EchoBatch batch(double sample_interval) const noexcept {
    return {{shots.data(), shots.size()},
            {echoes.data(), echoes.size()},
            {samples.data(), samples.size()},
            sample_interval,
            {subrays.data(), subrays.size()}};
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
