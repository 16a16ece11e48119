// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MPI_RUN_HPP
#define PULSECAST_MPI_RUN_HPP

#include <pulsecast/mpi/detail/stream.hpp>
#include <pulsecast/mpi/laz.hpp>
#include <pulsecast/mpi/rows.hpp>

/// Survey runs on the processes of an MPI communicator, each with its own threads.
///
///     MpiSession mpi;
///     MpiGroup group;                                   // of MPI_COMM_WORLD
///     MpiLas points(group, "points.las", {});          // written by all processes
///     run(group, survey, {.threads = 8}, points);      // the same survey on all processes
///     points.close();
///
/// The first process hands out blocks of pulses on request, and simulates, too. Results equal those
/// of one process, byte for byte. All functions are collective: every process calls them. An
/// exception on one process must end all: see `MpiSession`.
namespace PULSECAST_NAMESPACE::mpi {

/// Sink of part of a survey on one process.
struct MpiPartSink {
  std::function<void(const EchoBatch&)> take;  ///< takes a batch
  bool empty_shots;                            ///< true if it reads shots without echoes

  void operator()(const EchoBatch& batch) const { take(batch); }
  [[nodiscard]] bool reads_empty_shots() const noexcept { return empty_shots; }
};

/// Simulation of part of a survey, as `run(survey, options, sink)`.
using MpiSimulate = std::function<RunSummary(const RunOptions& options, const MpiPartSink& sink)>;

namespace detail {

/// Part of one process in a run.
class MpiRun {
 public:
  MpiRun(MpiGroup& group, PulseIndex size, const RunOptions& options, const MpiSimulate& simulate,
         std::span<MpiOutput* const> outputs)
      : group_(group),
        slots_(options.slots(size)),
        options_(options),
        simulate_(simulate),
        outputs_(outputs.begin(), outputs.end()) {
    if (group.first()) scheduler_.emplace(slots_.count, static_cast<unsigned>(group.size()));
  }

  RunSummary run() {
    group_.begin(this, [](void* self, int from, int kind, MpiMessage message) {
      static_cast<MpiRun*>(self)->receive(from, kind, message);
    });
    send(0, ask, {});
    while (!(no_more_ && held_.empty())) {
      const bool served = serve(), worked = work();
      if (work_ && held_.size() < max_held && !full())
        simulate(*std::exchange(work_, std::nullopt));
      else if (!served && !worked)
        MpiGroup::pause();
    }
    group_.channel().barrier([this] {
      if (!serve() && !work()) MpiGroup::pause();
    });
    group_.end();
    return sum();
  }

 private:
  enum Kind { ask, give, done, belongs };

  struct Held {
    std::uint64_t number;
    std::vector<std::unique_ptr<MpiPiece>> pieces;
    std::optional<std::vector<MpiPlace>> places{};
  };
  static constexpr std::size_t max_held = 3;

  void send(int to, Kind kind, MpiMessage message) { group_.send(to, kind, std::move(message)); }

  bool serve() {
    const bool served = group_.serve();
    place();
    return served;
  }

  void receive(int from, int kind, MpiMessage& message) {
    if (kind == ask) {
      if (options_.stop.stop_requested()) scheduler_->stop();
      const std::optional<MpiBlock> block = scheduler_->next(from);
      send(from, give, std::move(MpiMessage().add(block.value_or(MpiBlock{}))));
    } else if (kind == give) {
      const auto block = message.next<MpiBlock>();
      if (block.from < block.to)
        work_ = block;
      else
        no_more_ = true;
    } else if (kind == done) {
      const auto number = message.next<std::uint64_t>();
      const auto cost = message.next<MpiCost>();
      std::vector<MpiExtent> extents;
      message.next(extents, outputs_.size());
      scheduler_->finish(number, std::move(extents), cost);
      const MpiCost& all = scheduler_->cost();
      if (options_.progress) options_.progress({all.slots, slots_.count, all.echoes, elapsed()});
    } else {
      const auto number = message.next<std::uint64_t>();
      const auto held = std::ranges::find(held_, number, &Held::number);
      message.next(held->places.emplace(), outputs_.size());
    }
  }

  /// First process: sends the places of finished blocks as soon as they are known.
  void place() {
    if (!scheduler_) return;
    const auto may = [this] { return std::ranges::all_of(outputs_, &MpiOutput::may_place); };
    scheduler_->settle(may, [this](std::uint64_t number, int owner, const auto& extents) {
      MpiMessage message;
      message.add(number);
      for (std::size_t k = 0; k < outputs_.size(); ++k) message.add(outputs_[k]->place(extents[k], owner));
      send(owner, belongs, std::move(message));
    });
  }

  /// Writes a piece at its place, or does other work that is ready; false if there is none.
  bool work() {
    bool any = false;
    if (!held_.empty() && held_.front().places) {  // a process's blocks are placed in order
      Held due = std::move(held_.front());
      held_.pop_front();
      for (std::size_t k = 0; k < outputs_.size(); ++k) {
        outputs_[k]->put(*due.pieces[k], (*due.places)[k]);
        outputs_[k]->give_back(std::move(due.pieces[k]));
      }
      any = true;
    }
    for (MpiOutput* output : outputs_) any = output->work() || any;
    return any;
  }

  [[nodiscard]] bool full() const { return std::ranges::any_of(outputs_, &MpiOutput::full); }

  void simulate(const MpiBlock& block) {
    send(0, ask, {});  // requested early, so that it is here when this one is done
    Held& held = held_.emplace_back(Held{block.number, {}});
    for (MpiOutput* output : outputs_) held.pieces.push_back(output->take_piece());
    RunOptions part{.threads = options_.threads,
                    .executor = options_.executor,
                    .first = slots_[block.from],
                    .end = slots_[block.to - 1] + 1,
                    .stride = slots_.stride};
    part.progress = [this](const Progress&) { serve(); };
    std::vector<Shot> shots;
    const bool empty_shots = std::ranges::any_of(held.pieces, [](auto& p) { return p->reads_empty_shots(); });
    const auto take = [&](const EchoBatch& batch) {
      for (std::size_t k = 0; k < outputs_.size(); ++k) {
        EchoBatch some = batch;
        if (const auto channel = outputs_[k]->channel) {
          shots.clear();
          for (const Shot& s : batch.shots)
            if (s.channel == *channel) shots.push_back(s);
          some.shots = shots;
        }
        (*held.pieces[k])(some);
      }
    };
    const RunSummary summary = simulate_(part, {take, empty_shots});
    own_.add(summary);
    MpiCost cost{summary.slots, summary.echoes, 0, summary.seconds};
    MpiMessage extents;
    for (const auto& piece : held.pieces) {
      extents.add(piece->extent());
      cost.bytes += piece->memory();
    }
    send(0, done, std::move(MpiMessage().add(block.number).add(cost).add(extents.rest())));
  }

  [[nodiscard]] RunSummary sum() {
    const std::vector<RunSummary> all = group_.channel().gather(std::exchange(own_, {}));
    for (const RunSummary& one : all) own_.add(one);
    own_.seconds = elapsed();
    own_.complete = own_.slots == slots_.count;
    return group_.channel().from_first(own_);
  }

  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
  }

  MpiGroup& group_;
  RunSlots slots_;
  const RunOptions& options_;
  const MpiSimulate& simulate_;
  std::vector<MpiOutput*> outputs_;
  std::optional<MpiBlockScheduler> scheduler_;  // on the first process
  std::optional<MpiBlock> work_;                // next block
  bool no_more_ = false;
  std::deque<Held> held_;  // finished blocks without a place, and the current one
  RunSummary own_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

/// Output that feeds a sink of the first process with the results of all.
template <class Sink>
[[nodiscard]] std::unique_ptr<MpiOutput> mpi_output(MpiGroup& group, Sink& sink) {
  const bool empty_shots = group.channel().from_first(pulsecast::detail::reads_empty_shots(sink));
  return std::make_unique<MpiStream<MpiBatchWriter>>(
      group, [empty_shots](io::OutputFile piece) { return MpiBatchWriter(std::move(piece), empty_shots); },
      [&sink](MpiMessage bytes) { for_each_batch(std::move(bytes), sink); }, [] {});
}

}  // namespace detail

/// Runs a survey of `size` slots, any part of which every process can simulate. Outputs may serve
/// several runs; their makers close them. `options.progress` and `options.stop` count on the first
/// process only: a stopped run is complete up to some slot. Threads and executor are per process.
inline RunSummary run_parts(MpiGroup& group, PulseIndex size, const RunOptions& options, const MpiSimulate& simulate,
                            std::span<MpiOutput* const> outputs) {
  return detail::MpiRun(group, size, options, simulate, outputs).run();
}

/// Receiver of results in `run`: an output of all processes, or a sink of the first.
template <class S>
concept MpiSink = std::is_base_of_v<MpiOutput, std::remove_reference_t<S>> || EchoSink<S>;

/// Simulates the pulses of a survey, made alike on all processes. A sink is an `MpiOutput`, written
/// by all, or any `EchoSink`, called on the first process only, with batches in pulse order, whose
/// choice of shots counts for all. Every process gets the summary of all.
template <PulseSurvey Survey, MpiSink... Sinks>
RunSummary run(MpiGroup& group, const Survey& survey, const RunOptions& options, Sinks&&... sinks) {
  std::vector<MpiOutput*> outputs;
  std::vector<std::unique_ptr<MpiOutput>> own;
  const auto take = [&]<class Sink>(Sink& sink) {
    if constexpr (std::is_base_of_v<MpiOutput, Sink>) {
      outputs.push_back(&sink);
    } else {
      outputs.push_back(own.emplace_back(detail::mpi_output(group, sink)).get());
    }
  };
  (take(sinks), ...);
  const MpiSimulate simulate = [&](const RunOptions& part, const MpiPartSink& sink) {
    return pulsecast::run(survey, part, sink);
  };
  const RunSummary summary = run_parts(group, survey.size(), options, simulate, outputs);
  for (const auto& output : own) output->close();
  return summary;
}

/// Says of a call of `run` what is wrong with it.
template <class Survey, class... Sinks>
requires(!PulseSurvey<Survey> || !(MpiSink<Sinks> && ...)) RunSummary
    run(MpiGroup&, const Survey&, const RunOptions&, Sinks&&...) {
  static_assert(PulseSurvey<Survey>,
                "run: the second argument must be a survey; for a type of your own, static_assert(PulseSurvey<T>)");
  static_assert(
      (MpiSink<Sinks> && ...),
      "run: a sink must be an MpiOutput or callable with one batch, as is [](const EchoBatch& batch) { ... }");
  return {};
}

}  // namespace PULSECAST_NAMESPACE::mpi

#endif
