// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETAIL_RUN_CHUNKS_HPP
#define PULSECAST_DETAIL_RUN_CHUNKS_HPP

#include <algorithm>
#include <condition_variable>  // includes the steady clock: <chrono> would add a calendar, a tenth of this header's cost
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <stdexcept>
#include <string>

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/detail/reorder_buffer.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Reports a pulse with an error.
[[noreturn]] inline void throw_pulse_error(PulseError error, const Shot& shot) {
  const std::string pulse =
      text::joined({"pulse ", std::to_string(shot.index), " at ", text::to_text(shot.tick.seconds()), " s"});
  if (error == PulseError::map)
    throw std::runtime_error(text::joined(
        {"the map answered ", pulse, " with NaN: check its ranges and backscatter, or the laws of its materials"}));
  throw std::runtime_error(
      text::joined({pulse, " has a pose that is not finite: check the trajectory, optic or pose errors"}));
}

PULSECAST_INLINE RunSummary run_chunks(const RunOptions& options, const RunSlots& slots, std::size_t recorded_subrays,
                                       const std::function<void(ChunkQueue&)>& work,
                                       const std::function<void(const ResultChunk&)>& deliver) {
  const PulseIndex subrays_per_chunk = 65'536;  // bound where subrays are recorded; otherwise they take no memory
  const PulseIndex most = std::clamp(slots.count / 16, PulseIndex{256}, PulseIndex{2048});  // few in a short run
  const PulseIndex slots_per_chunk =
      std::clamp(subrays_per_chunk / std::max<PulseIndex>(1, recorded_subrays), PulseIndex{1}, most);
  const std::uint64_t chunks = (slots.count + slots_per_chunk - 1) / slots_per_chunk;
  const std::size_t workers = std::min<std::uint64_t>(options.workers().count(), std::max<std::uint64_t>(chunks, 1));
  const auto began = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); };

  RunSummary summary;
  const auto take = [&](const ResultChunk& chunk) {
    deliver(chunk);
    summary.add(chunk.counts);
    if (chunk.error != PulseError::none) throw_pulse_error(chunk.error, chunk.wrong);
    if (options.progress) options.progress({summary.slots, slots.count, summary.echoes, elapsed()});
  };
  ScratchMemory* const kept = options.executor.memory();
  ReorderBuffer buffer(kept, slots.count, slots_per_chunk, workers, options.stop, std::ref(take));
  for_each_index(workers, options.workers(), [&](std::size_t) noexcept {
    try {
      work(buffer);
    } catch (...) {
      buffer.fail(std::current_exception());
    }
  });
  if (buffer.failure()) std::rethrow_exception(buffer.failure());
  if (kept) buffer.make_room();
  summary.seconds = elapsed();
  summary.complete = summary.slots == slots.count;
  return summary;
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
