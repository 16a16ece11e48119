// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_RUN_HPP
#define PULSECAST_RUN_HPP

#include <functional>
#include <stop_token>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/parallel.hpp>
#include <pulsecast/base/progress.hpp>
#include <pulsecast/base/scratch_memory.hpp>
#include <pulsecast/detail/chunk_queue.hpp>
#include <pulsecast/survey.hpp>

namespace PULSECAST_NAMESPACE {

/// Slots of a survey in a run.
struct RunSlots {
  PulseIndex first, stride, count;  ///< first slot, step between slots, number of slots

  /// Slot number `n` of the run.
  [[nodiscard]] PulseIndex operator[](PulseIndex n) const noexcept { return first + n * stride; }

  /// Number of the first slot of the run that is not before slot `i`, which is not before `first`.
  [[nodiscard]] PulseIndex number_from(PulseIndex i) const noexcept {
    return (i - first) / stride + ((i - first) % stride > 0 ? 1 : 0);
  }
};

/// Options of a run.
struct RunOptions {
  unsigned threads = 0;    ///< threads, at most `max_threads`; 0: all of the executor or the hardware
  ExecutorRef executor{};  ///< runs the work, as `ThreadPool` does; empty: threads that live for the call
  PulseIndex first = 0;    ///< first slot
  PulseIndex end = std::numeric_limits<PulseIndex>::max();  ///< one past the last slot, at most the survey's size
  PulseIndex stride = 1;                                    ///< step between slots, greater than 1 for a preview
  ProgressCallback progress{};  ///< called after every batch, one call at a time, on any thread
  std::stop_token stop{};       ///< ends the run early; results delivered so far are complete

  void validate() const {
    require_within("RunOptions::threads", threads, 0, max_threads, "");
    require_within("RunOptions::stride", stride, 1, 1e18, "");
  }

  /// Threads of the run, as a builder takes them.
  [[nodiscard]] Workers workers() const noexcept { return {executor, threads}; }

  /// Slots of a run over `size` slots. @throws SettingError for options out of range
  [[nodiscard]] RunSlots slots(PulseIndex size) const {
    validate();
    const PulseIndex to = std::min(end, size), from = std::min(first, to);
    return {from, stride, (to - from + stride - 1) / stride};
  }
};

namespace detail {

/// Workspace of a worker, which an executor may keep for the next run of the same survey.
template <class Survey>
struct WorkspaceMemory : ScratchItem {
  decltype(std::declval<const Survey&>().workspace()) workspace;  ///< which need not be movable
  std::weak_ptr<const void> identity;                             ///< of its survey

  explicit WorkspaceMemory(const Survey& survey) : workspace(survey.workspace()), identity(identity_of(survey)) {}
  [[nodiscard]] bool fits(const Survey& survey) const noexcept {
    const std::shared_ptr<const void> own = identity.lock();
    return own && own == identity_of(survey);
  }
  [[nodiscard]] bool outdated(const Survey&) const noexcept { return identity.expired(); }

 private:
  static std::shared_ptr<const void> identity_of(const Survey& survey) noexcept {
    if constexpr (IdentifiedSurvey<Survey>)
      return survey.identity();
    else
      return nullptr;
  }
};

/// True unless a sink says that it reads no empty shots.
template <class Sink>
[[nodiscard]] bool reads_empty_shots(const Sink& sink) noexcept {
  static_assert(members_checked<Sink, tag::ChoosesShots>);
  if constexpr (ChoosesShots<Sink>) return sink.reads_empty_shots();
  return true;
}

/// Simulates the slots of a run from number `n` up to `end` into a chunk, with or without empty shots, or up to the
/// first error.
template <class Survey, class Workspace>
void simulate(const Survey& survey, const RunSlots& slots, PulseIndex n, PulseIndex end, Workspace& workspace,
              bool empty_shots, ResultChunk& chunk) {
  const auto add = [&](const Outcome& outcome) {  // returns the next slot
    chunk.add(outcome, empty_shots);
    n = chunk.error == PulseError::none ? n + 1 : end;
    if constexpr (SkipsBlocked<Survey>)
      if (outcome.shot.fate == Fate::blocked && n < end) {
        const PulseIndex next = std::min(end, slots.number_from(survey.next_pulse(slots[n])));
        chunk.append_blocked(next - n);
        n = next;
      }
    return slots[n];
  };
  while (n < end)
    if constexpr (SimulatesInOrder<Survey>)
      survey.simulate_in_order(slots[n], slots.stride == 1 ? slots[end] : slots[n] + 1, workspace, add);
    else
      add(survey(slots[n], workspace));
}

/// Results of a run for its sinks, and chunks for its workers: what does not depend on the type of the survey.
/// `work(queue)` is called by each worker.
RunSummary run_chunks(const RunOptions& options, const RunSlots& slots, std::size_t recorded_subrays,
                      const std::function<void(ChunkQueue&)>& work,
                      const std::function<void(const ResultChunk&)>& deliver);

}  // namespace detail

/// Simulates the pulses of a survey on several threads, and passes the results to the sinks in pulse order. The batches
/// depend neither on the number of threads nor on the executor. Exceptions of sinks and of the progress callback end
/// the run and are rethrown.
/// @throws SettingError for options out of range @throws std::runtime_error for the first pulse with a `PulseError`,
/// after the sinks have got all pulses before it
template <PulseSurvey Survey, EchoSink... Sinks>
RunSummary run(const Survey& survey, const RunOptions& options, Sinks&&... sinks) {
  static_assert(detail::members_checked<Survey, tag::SkipsBlocked, tag::SimulatesInOrder, tag::IdentifiedSurvey>);
  const RunSlots slots = options.slots(survey.size());
  using Memory = detail::WorkspaceMemory<Survey>;
  ScratchMemory* const kept = options.executor.memory();
  if constexpr (IdentifiedSurvey<Survey>)
    if (kept)
      kept->provide<Memory>(options.workers().count(),
                            survey);  // for all threads, as some may have their first work in a later run
  const bool empty_shots = (detail::reads_empty_shots(sinks) || ...);
  const auto work = [&](detail::ChunkQueue& queue) {  // each worker runs until no chunk is left
    detail::ResultChunk* chunk = queue.next();
    if (!chunk) return;
    const Borrowed<Memory> memory(IdentifiedSurvey<Survey> ? kept : nullptr, survey);
    for (; chunk; chunk = queue.next()) {
      detail::simulate(survey, slots, chunk->begin, chunk->end, memory->workspace, empty_shots, *chunk);
      queue.finish(*chunk);
    }
  };
  const auto deliver = [&](const detail::ResultChunk& chunk) {
    [[maybe_unused]] const EchoBatch batch = chunk.batch(survey.sample_interval());  // there may be no sinks
    (sinks(batch), ...);
  };
  RunSummary summary = detail::run_chunks(options, slots, survey.recorded_subrays(), std::ref(work), std::ref(deliver));
  summary.rays = summary.pulses() * survey.subrays();
  return summary;
}

/// Says of a call of `run` what is wrong with it.
template <class Survey, class... Sinks>
requires(!PulseSurvey<Survey> || !(EchoSink<Sinks> && ...)) RunSummary
    run(const Survey&, const RunOptions&, Sinks&&...) {
  static_assert(PulseSurvey<Survey>,
                "run: the first argument must be a survey; for a type of your own, static_assert(PulseSurvey<T>)");
  static_assert((EchoSink<Sinks> && ...),
                "run: a sink must be callable with one batch, as is [](const EchoBatch& batch) { ... }");
  return {};
}

}  // namespace PULSECAST_NAMESPACE

#if PULSECAST_DEFINES(RUN)
#include <condition_variable>  // includes the steady clock: <chrono> would add a calendar, a tenth of this header's cost
#include <exception>
#include <stdexcept>

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

#endif
