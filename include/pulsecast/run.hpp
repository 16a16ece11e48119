// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/base/require.hpp>
#include <pulsecast/survey.hpp>

namespace pulsecast {

/// How far a run has come.
struct Progress {
  PulseIndex done = 0;   ///< pulse slots delivered to the sinks
  PulseIndex total = 0;  ///< pulse slots to do
  std::uint64_t echoes = 0;
  double seconds = 0;  ///< since the start of the run [s]
};

/// The slots of a survey that a run does.
struct RunSlots {
  PulseIndex first, stride, count;

  [[nodiscard]] PulseIndex operator[](PulseIndex n) const noexcept { return first + n * stride; }
};

struct RunOptions {
  unsigned threads = 0;                                     ///< at most `max_threads`; 0 for as many as the machine runs at once
  PulseIndex first = 0;                                     ///< the first slot to do
  PulseIndex end = std::numeric_limits<PulseIndex>::max();  ///< the slot after the last, at most the survey's size
  PulseIndex stride = 1;                                    ///< every so many-th slot only: a preview
  std::function<void(const Progress&)> progress{};          ///< called after every batch, one call at a time, on any thread
  std::stop_token stop{};                                   ///< ends the run early; what was delivered is whole up to there

  void validate() const {
    require_within("RunOptions::threads", threads, 0, max_threads, "");
    require_within("RunOptions::stride", static_cast<double>(stride), 1, 1e18, "");
  }

  /// Which of `size` slots to do. @throws SettingError if the options cannot be
  [[nodiscard]] RunSlots slots(PulseIndex size) const {
    validate();
    const PulseIndex to = std::min(end, size), from = std::min(first, to);
    return {from, stride, (to - from + stride - 1) / stride};
  }
};

/// What a run came to.
struct RunSummary {
  PulseIndex slots = 0;                             ///< pulse slots done
  std::array<std::uint64_t, fate_count> fates{};    ///< slots by `Fate`
  double energy = 0;                                ///< sent, as in `Outcome` [J]
  std::array<double, fate_count> energy_by_fate{};  ///< of that energy, by the fate of the subrays that carried it; in sum all of it [J]
  std::uint64_t echoes = 0;
  std::uint64_t rays = 0;  ///< subrays traced
  double seconds = 0;      ///< [s]
  bool complete = true;    ///< false if it was stopped

  /// Takes in what another run came to, or another part of the same.
  void add(const RunSummary& other) noexcept {
    slots += other.slots, echoes += other.echoes, rays += other.rays, energy += other.energy, seconds += other.seconds;
    for (std::size_t f = 0; f < fate_count; ++f) fates[f] += other.fates[f], energy_by_fate[f] += other.energy_by_fate[f];
    complete = complete && other.complete;
  }

  [[nodiscard]] std::uint64_t count(Fate fate) const noexcept { return fates[static_cast<std::size_t>(fate)]; }
  [[nodiscard]] double share(Fate fate) const noexcept { return energy > 0 ? energy_by_fate[static_cast<std::size_t>(fate)] / energy : 0; }
  [[nodiscard]] PulseIndex pulses() const noexcept { return slots - count(Fate::blocked); }  ///< that were sent
};

/// What came of slots, one after another, for those who ask a survey for single ones.
struct ResultBuffer {
  std::vector<Shot> shots{};
  std::vector<Echo> echoes{};
  std::vector<float> samples{};
  std::vector<SubrayHit> subrays{};
  RunSummary counts{};  ///< all but rays and seconds

  void clear() noexcept { shots.clear(), echoes.clear(), samples.clear(), subrays.clear(), counts = {}; }

  void append(const Outcome& outcome) {
    ++counts.slots;
    ++counts.fates[static_cast<std::size_t>(outcome.shot.fate)];
    if (outcome.shot.fate == Fate::blocked) return;
    Shot& shot = shots.emplace_back(outcome.shot);
    shot.first_echo = static_cast<std::uint32_t>(echoes.size()), shot.echoes = static_cast<std::uint32_t>(outcome.echoes.size());
    shot.first_sample = samples.size(), shot.samples = static_cast<std::uint32_t>(outcome.waveform.size());
    for (const Echo& echo : outcome.echoes) echoes.push_back(echo);
    samples.insert(samples.end(), outcome.waveform.begin(), outcome.waveform.end());
    for (const SubrayHit& subray : outcome.subrays) subrays.push_back(subray);
    counts.echoes += outcome.echoes.size();
    counts.energy += outcome.energy;
    for (std::size_t f = 0; f < fate_count; ++f) counts.energy_by_fate[f] += outcome.energy * outcome.shares[f];
  }

  /// The batch that sinks get; it lives as long as this is not changed.
  [[nodiscard]] EchoBatch batch(double sample_interval) const noexcept { return {shots, echoes, samples, sample_interval, subrays}; }
};

namespace detail {

/// The results of consecutive slots, in memory of their own that is used again and again.
struct ResultChunk : ResultBuffer {
  std::uint64_t number = 0;
  ResultChunk* next_free = nullptr;

  [[nodiscard]] std::size_t bytes() const noexcept {
    return std::span(shots).size_bytes() + std::span(echoes).size_bytes() + std::span(samples).size_bytes() +
           std::span(subrays).size_bytes();
  }
};

/// Hands out chunks to workers, and the finished ones, in order and one at a time, to whoever takes them. Workers run ahead, so that none
/// waits for one that is slow, or that the system has put aside; but only until what is finished fills a few megabytes, or until there are
/// two chunks a worker if these are large, which bounds the memory. The chunk delivered last is the next to be used, as it is in the cache.
class ReorderBuffer {
 public:
  ReorderBuffer(std::uint64_t chunks, std::size_t workers, std::stop_token stop)
      : chunks_(chunks),
        always_ahead_(2 * workers + 2),
        max_ahead_(16 * always_ahead_),
        room_(std::make_unique<ResultChunk[]>(max_ahead_)),
        finished_(std::make_unique<ResultChunk*[]>(max_ahead_)),
        stop_(std::move(stop)) {
    for (std::size_t i = 0; i < max_ahead_; ++i) room_[i].next_free = std::exchange(free_, &room_[i]);
  }

  /// The next chunk to work on, empty; none at the end, or when the run is stopped.
  [[nodiscard]] ResultChunk* next() {
    std::unique_lock lock(mutex_);
    moved_.wait(lock, [&] { return failure_ || handed_out_ == chunks_ || may_go_ahead(); });
    if (failure_ || handed_out_ == chunks_ || stop_.stop_requested()) return nullptr;
    ResultChunk* const chunk = std::exchange(free_, free_->next_free);
    chunk->clear();
    chunk->number = handed_out_++;
    return chunk;
  }

  /// Takes a chunk back, and delivers all that are due unless another worker is at it already.
  template <class Deliver>
  void finish(ResultChunk& chunk, const Deliver& deliver) {
    std::unique_lock lock(mutex_);
    finished_bytes_ += chunk.bytes();
    place(chunk.number) = &chunk;
    if (delivering_) return;
    delivering_ = true;
    while (!failure_ && place(delivered_)) {
      ResultChunk* const due = std::exchange(place(delivered_), nullptr);
      lock.unlock();
      deliver(*due);
      lock.lock();
      ++delivered_;
      finished_bytes_ -= due->bytes();
      due->next_free = std::exchange(free_, due);
      moved_.notify_all();
    }
    delivering_ = false;
  }

  /// Ends the run for everybody; the first failure is the one that counts.
  void fail(std::exception_ptr failure) noexcept {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
    moved_.notify_all();
  }

  [[nodiscard]] std::exception_ptr failure() const noexcept { return failure_; }

 private:
  static constexpr std::size_t max_bytes = std::size_t{6} << 20;  // finished and not delivered: some milliseconds of fast work

  [[nodiscard]] bool may_go_ahead() const noexcept {
    const std::uint64_t ahead = handed_out_ - delivered_;
    return ahead < always_ahead_ || (ahead < max_ahead_ && finished_bytes_ < max_bytes);
  }
  [[nodiscard]] ResultChunk*& place(std::uint64_t number) noexcept { return finished_[number % max_ahead_]; }

  std::uint64_t chunks_, handed_out_ = 0, delivered_ = 0;
  std::size_t always_ahead_, max_ahead_, finished_bytes_ = 0;
  std::unique_ptr<ResultChunk[]> room_;
  std::unique_ptr<ResultChunk*[]> finished_;  // each at its place, which is empty before
  ResultChunk* free_ = nullptr;               // the first of them
  std::stop_token stop_;
  bool delivering_ = false;
  std::exception_ptr failure_;
  std::mutex mutex_;
  std::condition_variable moved_;
};

}  // namespace detail

/// Simulates the pulses of a survey on several threads, and hands what came back to the sinks in pulse order. The same survey gives the
/// same batches on any number of threads. Whatever a sink or the progress callback throws ends the run and comes out here.
template <class Survey, EchoSink... Sinks>
RunSummary run(const Survey& survey, const RunOptions& options, Sinks&&... sinks) {
  const RunSlots slots = options.slots(survey.size());
  const PulseIndex subrays_per_chunk = 65'536;  // where they are recorded, else they take no room
  const PulseIndex slots_per_chunk =
      std::clamp(subrays_per_chunk / std::max<PulseIndex>(1, survey.recorded_subrays()), PulseIndex{1}, PulseIndex{2048});
  const std::uint64_t chunks = (slots.count + slots_per_chunk - 1) / slots_per_chunk;
  const std::size_t workers = std::min<std::uint64_t>(thread_count(options.threads), std::max<std::uint64_t>(chunks, 1));
  const auto began = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); };

  detail::ReorderBuffer buffer(chunks, workers, options.stop);
  RunSummary summary;
  const auto deliver = [&](const detail::ResultChunk& chunk) {
    [[maybe_unused]] const EchoBatch batch = chunk.batch(survey.sample_interval());  // there may be no sinks
    (sinks(batch), ...);
    summary.add(chunk.counts);
    if (options.progress) options.progress({summary.slots, slots.count, summary.echoes, elapsed()});
  };
  for_each_index(workers, options.threads, [&](std::size_t) noexcept {  // each works on as long as there is something to do
    try {
      detail::ResultChunk* chunk = buffer.next();
      if (!chunk) return;
      auto workspace = survey.workspace();
      for (; chunk; chunk = buffer.next()) {
        const PulseIndex from = chunk->number * slots_per_chunk, to = std::min(from + slots_per_chunk, slots.count);
        for (PulseIndex n = from; n < to; ++n) chunk->append(survey(slots[n], workspace));
        buffer.finish(*chunk, deliver);
      }
    } catch (...) {
      buffer.fail(std::current_exception());
    }
  });
  if (buffer.failure()) std::rethrow_exception(buffer.failure());
  summary.rays = summary.pulses() * survey.subrays();
  summary.seconds = elapsed();
  summary.complete = summary.slots == slots.count;
  return summary;
}

}  // namespace pulsecast
