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
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include <pulsecast/base/expect.hpp>
#include <pulsecast/survey.hpp>

namespace pulsecast {

/// How far a run has come.
struct Progress {
  PulseIndex done = 0;   ///< pulse slots delivered to the sinks
  PulseIndex total = 0;  ///< pulse slots to do
  std::uint64_t echoes = 0;
  double seconds = 0;  ///< since the start of the run [s]
};

struct RunOptions {
  unsigned threads = 0;                                     ///< 0 for as many as the machine runs at once
  PulseIndex first = 0;                                     ///< the first slot to do
  PulseIndex end = std::numeric_limits<PulseIndex>::max();  ///< the slot after the last, at most the survey's size
  PulseIndex stride = 1;                                    ///< every so many-th slot only: a preview
  std::function<void(const Progress&)> progress{};          ///< called after every batch, one call at a time, on any thread
  std::stop_token stop{};                                   ///< ends the run early; what was delivered is whole up to there
};

/// What a run came to.
struct RunSummary {
  PulseIndex slots = 0;                           ///< pulse slots done
  std::array<std::uint64_t, fate_count> fates{};  ///< slots by `Fate`
  double energy = 0;                              ///< sent, as in `Outcome` [J]
  std::array<double, fate_count> spent{};  ///< of that energy, by what became of the subrays that carried it; their sum is all of it [J]
  std::uint64_t echoes = 0;
  std::uint64_t rays = 0;  ///< subrays traced
  double seconds = 0;      ///< [s]
  bool complete = true;    ///< false if it was stopped

  [[nodiscard]] std::uint64_t count(Fate fate) const noexcept { return fates[static_cast<std::size_t>(fate)]; }
  [[nodiscard]] double share(Fate fate) const noexcept { return energy > 0 ? spent[static_cast<std::size_t>(fate)] / energy : 0; }
  [[nodiscard]] PulseIndex pulses() const noexcept { return slots - count(Fate::blocked); }  ///< that were sent
};

namespace detail {

/// The results of consecutive slots, in memory of their own that is used again and again.
struct Chunk {
  std::vector<Shot> shots;
  std::vector<Echo> echoes;
  std::vector<float> samples;
  std::vector<SubrayHit> subrays;
  RunSummary counts;

  void clear() noexcept { shots.clear(), echoes.clear(), samples.clear(), subrays.clear(), counts = {}; }

  void append(const Outcome& outcome) {
    ++counts.slots;
    ++counts.fates[static_cast<std::size_t>(outcome.shot.fate)];
    if (outcome.shot.fate == Fate::blocked) return;
    Shot& shot = shots.emplace_back(outcome.shot);
    shot.first_echo = static_cast<std::uint32_t>(echoes.size()), shot.echoes = static_cast<std::uint32_t>(outcome.echoes.size());
    shot.first_sample = samples.size(), shot.samples = static_cast<std::uint32_t>(outcome.waveform.size());
    echoes.insert(echoes.end(), outcome.echoes.begin(), outcome.echoes.end());
    if (!outcome.waveform.empty()) samples.insert(samples.end(), outcome.waveform.begin(), outcome.waveform.end());
    if (!outcome.subrays.empty()) subrays.insert(subrays.end(), outcome.subrays.begin(), outcome.subrays.end());
    counts.echoes += outcome.echoes.size();
    counts.energy += outcome.energy;
    for (std::size_t f = 0; f < fate_count; ++f) counts.spent[f] += outcome.energy * outcome.shares[f];
  }
};

/// Hands out chunk numbers to workers, and the finished chunks, in order and one at a time, to whoever takes them. No worker runs
/// farther ahead than there are chunks, which bounds the memory.
class Conveyor {
 public:
  Conveyor(std::uint64_t chunks, std::size_t ahead, std::stop_token stop)
      : chunks_(chunks), ring_(ahead), ready_(ahead, false), stop_(std::move(stop)) {}

  [[nodiscard]] Chunk& chunk(std::uint64_t number) noexcept { return ring_[number % ring_.size()]; }

  /// The next number to work on; none at the end, or when the run is stopped.
  [[nodiscard]] std::optional<std::uint64_t> next() {
    std::unique_lock lock(mutex_);
    moved_.wait(lock, [&] { return failure_ || handed_out_ == chunks_ || handed_out_ < delivered_ + ring_.size(); });
    if (failure_ || handed_out_ == chunks_ || stop_.stop_requested()) return std::nullopt;
    return handed_out_++;
  }

  /// Takes a chunk back, and delivers all that are due unless another worker is at it already.
  template <class Deliver>
  void finish(std::uint64_t number, const Deliver& deliver) {
    std::unique_lock lock(mutex_);
    ready_[number % ring_.size()] = true;
    if (delivering_) return;
    delivering_ = true;
    while (!failure_ && ready_[delivered_ % ring_.size()]) {
      lock.unlock();
      deliver(ring_[delivered_ % ring_.size()]);
      lock.lock();
      ready_[delivered_ % ring_.size()] = false;
      ++delivered_;
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
  std::uint64_t chunks_, handed_out_ = 0, delivered_ = 0;
  std::vector<Chunk> ring_;
  std::vector<bool> ready_;
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
  expect_within("RunOptions::stride", static_cast<double>(options.stride), 1, 1e18, "");
  const PulseIndex subrays_per_chunk = 65'536;  // where they are recorded, else they take no room
  const PulseIndex slots_per_chunk =
      std::clamp(subrays_per_chunk / std::max<PulseIndex>(1, survey.recorded_subrays()), PulseIndex{1}, PulseIndex{2048});
  const PulseIndex end = std::min(options.end, survey.size()), first = std::min(options.first, end);
  const PulseIndex slots = (end - first + options.stride - 1) / options.stride;
  const unsigned threads = options.threads > 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
  const auto began = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); };

  detail::Conveyor conveyor((slots + slots_per_chunk - 1) / slots_per_chunk, 2 * std::size_t{threads} + 2, options.stop);
  RunSummary summary;
  const auto deliver = [&](detail::Chunk& chunk) {
    const EchoBatch batch{chunk.shots, chunk.echoes, chunk.samples, survey.sample_interval(), chunk.subrays};
    (sinks(batch), ...);
    summary.slots += chunk.counts.slots;
    summary.echoes += chunk.counts.echoes;
    summary.energy += chunk.counts.energy;
    for (std::size_t f = 0; f < fate_count; ++f) summary.fates[f] += chunk.counts.fates[f], summary.spent[f] += chunk.counts.spent[f];
    if (options.progress) options.progress({summary.slots, slots, summary.echoes, elapsed()});
  };
  const auto work = [&]() noexcept {
    try {
      auto workspace = survey.workspace();
      while (const auto number = conveyor.next()) {
        detail::Chunk& chunk = conveyor.chunk(*number);
        chunk.clear();
        const PulseIndex from = *number * slots_per_chunk, to = std::min(from + slots_per_chunk, slots);
        for (PulseIndex n = from; n < to; ++n) chunk.append(survey(first + n * options.stride, workspace));
        conveyor.finish(*number, deliver);
      }
    } catch (...) {
      conveyor.fail(std::current_exception());
    }
  };
  {
    std::vector<std::jthread> helpers;
    try {
      for (unsigned k = 1; k < threads; ++k) helpers.emplace_back(work);
    } catch (...) {
      conveyor.fail(std::current_exception());  // no more threads to be had
    }
    work();
  }
  if (conveyor.failure()) std::rethrow_exception(conveyor.failure());
  summary.rays = summary.pulses() * survey.subrays();
  summary.seconds = elapsed();
  summary.complete = summary.slots == slots;
  return summary;
}

}  // namespace pulsecast
