// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETAIL_CHUNK_QUEUE_HPP
#define PULSECAST_DETAIL_CHUNK_QUEUE_HPP

#include <pulsecast/result_buffer.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Results of consecutive slots, in reused memory.
struct ResultChunk : ResultBuffer {
  std::uint64_t number = 0;       ///< number of the chunk
  PulseIndex begin = 0, end = 0;  ///< first slot of the run, and one past the last
  ResultChunk* next_free = nullptr;
  PulseError error = PulseError::none;  ///< of the slot after the last; ends the run after all slots before it
  Shot wrong{};                         ///< that slot

  /// Appends the result of a slot, or notes its error.
  void add(const Outcome& outcome, bool empty_shots) {
    error = outcome.error;
    if (error == PulseError::none)
      append(outcome, empty_shots);
    else
      wrong = outcome.shot;
  }

  /// Makes at least as much room as another has.
  void reserve_as(const ResultChunk& other) {
    shots.reserve(other.shots.capacity());
    echoes.reserve(other.echoes.capacity());
    samples.reserve(other.samples.capacity());
    subrays.reserve(other.subrays.capacity());
  }

  /// Memory of the results, and of the room for results [byte].
  [[nodiscard]] std::size_t bytes() const noexcept {
    return bytes_of([](const auto& results) { return results.size(); });
  }
  [[nodiscard]] std::size_t room() const noexcept {
    return bytes_of([](const auto& results) { return results.capacity(); });
  }

 private:
  [[nodiscard]] std::size_t bytes_of(const auto& count) const noexcept {
    return count(shots) * sizeof(Shot) + count(echoes) * sizeof(Echo) + count(samples) * sizeof(float) +
           count(subrays) * sizeof(SubrayRecord);
  }
};

/// Chunks of a run for its workers, from any thread.
class ChunkQueue {
 public:
  ChunkQueue() = default;
  ChunkQueue(const ChunkQueue&) = delete;
  ChunkQueue& operator=(const ChunkQueue&) = delete;

  /// Next empty chunk to work on; null at the end, or when the run is stopped.
  [[nodiscard]] virtual ResultChunk* next() = 0;
  /// Takes back a finished chunk, and delivers all that are due unless another worker is delivering.
  virtual void finish(ResultChunk& chunk) = 0;

 protected:
  ~ChunkQueue() = default;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
