// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SAMPLE_HPP
#define PULSECAST_SAMPLE_HPP

#include <time.h>

#include <pulsecast/any_survey.hpp>
#include <pulsecast/base/parallel.hpp>
#include <pulsecast/result_buffer.hpp>

/// Samples of a survey's slots, in any order, for estimates of a whole run.
namespace PULSECAST_NAMESPACE {

/// Consecutive slots of a sample. Slots before `from` are simulated to warm the caches, but do not count.
struct SampleBlock {
  PulseIndex first = 0, from = 0, end = 0;  ///< first slot, first that counts, one past the last
  bool empty_shots = true;  ///< false: shots without echoes are counted, not kept, as in a run whose sinks read none
};

/// Results of the counted slots of a block.
struct Sample : ResultBuffer {
  double seconds = 0;          ///< processor time [s]
  double sample_interval = 0;  ///< sample spacing of the waveforms [s]

  /// Results as a batch, valid until they change.
  [[nodiscard]] EchoBatch batch() const { return ResultBuffer::batch(sample_interval); }
};

/// Result of a single slot.
struct SlotCount {
  Fate fate = Fate::blocked;  ///< fate of the slot
  std::uint8_t echoes = 0;    ///< number of its echoes
};

namespace detail {

/// Processor time of this thread [s].
[[nodiscard]] inline double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace detail

/// Simulates blocks. Equal blocks give equal samples, except for the time, on any number of threads.
[[nodiscard]] inline std::vector<Sample> sample(const AnySurvey& survey, std::span<const SampleBlock> blocks,
                                                const Workers& workers = {}) {
  constexpr std::size_t at_once = 8;
  std::vector<Sample> all(blocks.size());
  for_each_index((blocks.size() + at_once - 1) / at_once, workers, [&](std::size_t task) {
    AnySurvey::Workspace workspace = survey.workspace();
    ResultBuffer buffer;  // reused, as in a run
    for (std::size_t k = task * at_once; k < std::min((task + 1) * at_once, blocks.size()); ++k) {
      const SampleBlock& block = blocks[k];
      const auto add = [&](const Outcome& outcome) {
        buffer.append(outcome, block.empty_shots);
        return outcome.shot.index + 1;
      };
      buffer.clear();
      survey.simulate_in_order(block.first, block.from, workspace, add);
      buffer.clear();
      const double start = detail::processor_seconds();
      survey.simulate_in_order(block.from, block.end, workspace, add);
      all[k].seconds = detail::processor_seconds() - start;
      all[k].sample_interval = survey.sample_interval();
      static_cast<ResultBuffer&>(all[k]) = buffer;
    }
  });
  return all;
}

/// Counts the echoes of single slots.
[[nodiscard]] inline std::vector<SlotCount> count_echoes(const AnySurvey& survey, std::span<const PulseIndex> slots,
                                                         const Workers& workers = {}) {
  constexpr std::size_t at_once = 1024;
  std::vector<SlotCount> all(slots.size());
  for_each_index((slots.size() + at_once - 1) / at_once, workers, [&](std::size_t k) {
    AnySurvey::Workspace workspace = survey.workspace();
    for (std::size_t i = k * at_once; i < std::min((k + 1) * at_once, slots.size()); ++i) {
      const Outcome outcome = survey(slots[i], workspace);
      all[i] = {outcome.shot.fate, static_cast<std::uint8_t>(outcome.echoes.size())};
    }
  });
  return all;
}

}  // namespace PULSECAST_NAMESPACE

#endif
