// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETAIL_REORDER_BUFFER_HPP
#define PULSECAST_DETAIL_REORDER_BUFFER_HPP

#include <condition_variable>
#include <exception>
#include <functional>
#include <stop_token>

#include <pulsecast/base/scratch_memory.hpp>
#include <pulsecast/detail/chunk_queue.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Chunks of a reorder buffer, which an executor may keep for the next run.
struct ChunkMemory : ScratchItem {
  std::size_t size;
  std::unique_ptr<ResultChunk[]> chunks;
  std::unique_ptr<ResultChunk*[]> finished;  ///< ring by chunk number; null until finished

  explicit ChunkMemory(std::size_t count)
      : size(count),
        chunks(std::make_unique<ResultChunk[]>(count)),
        finished(std::make_unique<ResultChunk*[]>(count)) {}
  [[nodiscard]] bool fits(std::size_t count) const noexcept { return size >= count; }
  [[nodiscard]] bool outdated(std::size_t) const noexcept { return true; }  ///< a larger one serves all
};

/// Reorder buffer: hands out chunks to workers, and delivers finished ones in order, one at a time. Workers run ahead,
/// so that none waits for a slow or descheduled one. Memory is bounded: they stop when finished chunks fill a few
/// megabytes, or at two chunks per worker if these are large. The chunk delivered last is reused first, as it is in the
/// cache.
class ReorderBuffer final : public ChunkQueue {
 public:
  /// Delivers chunks in order.
  using Deliver = std::function<void(const ResultChunk&)>;

  ReorderBuffer(ScratchMemory* kept, PulseIndex slots, PulseIndex slots_per_chunk, std::size_t workers,
                std::stop_token stop, Deliver deliver)
      : slots_(slots),
        slots_per_chunk_(slots_per_chunk),
        chunks_((slots + slots_per_chunk - 1) / slots_per_chunk),
        always_ahead_(2 * workers + 2),
        max_ahead_(16 * always_ahead_),
        memory_(kept, max_ahead_),
        stop_(std::move(stop)),
        deliver_(std::move(deliver)) {
    if (kept) make_room(std::bit_ceil(slots_per_chunk));  // steps of a loop differ by some slots
    for (std::size_t i = max_ahead_; i-- > 0;) memory_->chunks[i].next_free = std::exchange(free_, &memory_->chunks[i]);
    std::fill_n(memory_->finished.get(), max_ahead_, nullptr);
  }

  [[nodiscard]] ResultChunk* next() override {
    std::unique_lock lock(mutex_);
    moved_.wait(lock, [&] { return failure_ || handed_out_ == chunks_ || may_go_ahead(); });
    if (failure_ || handed_out_ == chunks_ || stop_.stop_requested()) return nullptr;
    ResultChunk* const chunk = std::exchange(free_, free_->next_free);
    chunk->clear();
    chunk->error = PulseError::none;
    chunk->number = handed_out_++;
    chunk->begin = chunk->number * slots_per_chunk_;
    chunk->end = std::min(chunk->begin + slots_per_chunk_, slots_);
    return chunk;
  }

  void finish(ResultChunk& chunk) override {
    std::unique_lock lock(mutex_);
    finished_bytes_ += chunk.bytes();
    place(chunk.number) = &chunk;
    if (delivering_) return;
    delivering_ = true;
    while (!failure_ && place(delivered_)) {
      ResultChunk* const due = std::exchange(place(delivered_), nullptr);
      lock.unlock();
      deliver_(*due);
      lock.lock();
      ++delivered_;
      finished_bytes_ -= due->bytes();
      due->next_free = std::exchange(free_, due);
      moved_.notify_all();
    }
    delivering_ = false;
  }

  /// Makes room for a short run in the chunks that it may need, as much as any had. At the end of a run, the next one
  /// over as many results then allocates nothing, whichever chunks it takes.
  void make_room(PulseIndex slots = 0) {
    ResultChunk& first = memory_->chunks[0];
    first.reserve(slots);
    for (std::size_t i = 1; i < max_ahead_; ++i) first.reserve_as(memory_->chunks[i]);
    const std::uint64_t some =
        std::min<std::uint64_t>({chunks_, max_ahead_, std::max(always_ahead_, max_bytes / (first.room() + 1))});
    for (std::size_t i = 1; i < some; ++i) memory_->chunks[i].reserve_as(first);
  }

  /// Ends the run for all workers; the first failure counts.
  void fail(std::exception_ptr failure) noexcept {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
    moved_.notify_all();
  }

  [[nodiscard]] std::exception_ptr failure() const noexcept { return failure_; }

 private:
  static constexpr std::size_t max_bytes = std::size_t{6}
                                           << 20;  // finished but not delivered: some milliseconds of fast work

  [[nodiscard]] bool may_go_ahead() const noexcept {
    const std::uint64_t ahead = handed_out_ - delivered_;
    return ahead < always_ahead_ || (ahead < max_ahead_ && finished_bytes_ < max_bytes);
  }
  [[nodiscard]] ResultChunk*& place(std::uint64_t number) noexcept { return memory_->finished[number % max_ahead_]; }

  PulseIndex slots_, slots_per_chunk_;
  std::uint64_t chunks_, handed_out_ = 0, delivered_ = 0;
  std::size_t always_ahead_, max_ahead_, finished_bytes_ = 0;
  Borrowed<ChunkMemory> memory_;
  ResultChunk* free_ = nullptr;  // head of the free list
  std::stop_token stop_;
  Deliver deliver_;
  bool delivering_ = false;
  std::exception_ptr failure_;
  std::mutex mutex_;
  std::condition_variable moved_;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
