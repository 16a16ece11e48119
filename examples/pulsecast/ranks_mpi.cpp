// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "ranks.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <sstream>

#include <pulsecast/io/gzip.hpp>
#include <pulsecast/io/misses.hpp>
#include <pulsecast/io/text_files.hpp>
#include <pulsecast/io/trajectory.hpp>
#include <pulsecast/mpi/run.hpp>

#include "outputs.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;
using mpi::MpiGroup;
using mpi::MpiOutput;

namespace {

std::unique_ptr<MpiOutput> shared_points(MpiGroup& group, const fs::path& path, const Options& o, double start_time) {
  if (o.format == "laz") return std::make_unique<mpi::MpiLaz>(group, path, las_settings(o, start_time), o.threads);
  if (o.format == "las") return std::make_unique<mpi::MpiLas>(group, path, las_settings(o, start_time));
  const io::TextFileSettings settings{.start_time = start_time};
  if (o.format == "xyz")
    return std::make_unique<mpi::MpiRows<io::XyzWriter, io::TextFileSettings, io::PointTextColumns>>(
        group, path, settings, text_columns(o));
  const auto file = group.first() ? std::make_shared<io::OutputFile>(io::gzip_file(path)) : nullptr;
  return std::make_unique<mpi::MpiStream<io::XyzWriter>>(
      group,
      [settings, more = text_columns(o)](io::OutputFile piece) {
        return io::XyzWriter(std::move(piece), settings, more);
      },
      [file](const mpi::MpiMessage& bytes) { file->write(bytes.rest()); }, [file] { file->commit(); });
}

/// `LegFiles`, written by all processes.
class SharedLegRun final : public LegRun {
 public:
  SharedLegRun(MpiGroup& group, const fs::path& folder, const std::string& prefix, const Options& o, double start_time,
               const std::vector<std::string>& channels)
      : group_(group) {
    if (group.first())
      trajectory_.emplace(folder / (prefix + "_trajectory.txt"), io::TrajectoryFileSettings{.start_time = start_time});
    const std::vector<fs::path> files = point_files(folder, prefix, o, channels);
    for (const fs::path& path : files) {
      MpiOutput* const points = add(shared_points(group, path, o, start_time));
      if (files.size() > 1) points->channel = static_cast<std::uint16_t>(outputs_.size() - 1);
    }
    if (o.write_waveform)
      add(std::make_unique<mpi::MpiRows<io::WaveformTextWriter, io::TextFileSettings>>(
          group, folder / (prefix + "_fullwave.txt"), io::TextFileSettings{start_time}));
    if (o.write_pulse)
      add(std::make_unique<mpi::MpiRows<io::PulseTextWriter, io::TextFileSettings>>(
          group, folder / (prefix + "_pulse.txt"), io::TextFileSettings{start_time}));
    if (o.write_misses)
      add(std::make_unique<mpi::MpiRows<io::MissTextWriter, io::TextFileSettings>>(
          group, folder / (prefix + "_misses.txt"), io::TextFileSettings{start_time}));
    if (o.misses_at) miss_points_.emplace(io::MissSettings{.range = *o.misses_at});
  }

  void add_trajectory(const helios::SurveyLeg& leg, Tick start, double interval) override {
    if (trajectory_ && interval > 0) trajectory_->add(leg.path(), start, leg.recorded(), interval);
  }

  RunSummary run(const AnySurvey& survey, const RunOptions& options) override {
    std::vector<MpiOutput*> outputs;
    for (const auto& output : outputs_) outputs.push_back(output.get());
    const auto simulate = [&](const RunOptions& part, const mpi::MpiPartSink& sink) {
      if (!miss_points_) return pulsecast::run(survey, part, sink);
      return pulsecast::run(survey, part, [&](const EchoBatch& batch) { sink((*miss_points_)(batch)); });
    };
    return mpi::run_parts(group_, options.end, options, simulate, outputs);
  }

  /// Closes points last: a leg is complete when all its files exist.
  void close() override {
    if (trajectory_) trajectory_->close();
    for (auto output = outputs_.rbegin(); output != outputs_.rend(); ++output) (*output)->close();
  }

  [[nodiscard]] LeftOut left_out() const override {
    LeftOut sum;
    for (const auto& output : outputs_)
      sum.add({.pulses_cut = output->pulses_cut(), .classes_cut = output->classes_cut()});
    return sum;
  }

 private:
  MpiOutput* add(std::unique_ptr<MpiOutput> output) { return outputs_.emplace_back(std::move(output)).get(); }

  MpiGroup& group_;
  std::optional<io::MissPoints> miss_points_;
  std::optional<io::TrajectoryWriter> trajectory_;  // on the first process
  std::vector<std::unique_ptr<MpiOutput>> outputs_;
};

MPI_Comm of_this_machine(MPI_Comm all) {
  MPI_Comm communicator = MPI_COMM_NULL;
  MPI_Comm_split_type(all, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &communicator);
  return communicator;
}

class ManyRanks final : public Ranks {
 public:
  ManyRanks() : machine_(of_this_machine(MPI_COMM_WORLD)) {
    if (!first())
      for (std::ostream* out : {&std::cout, &std::cerr}) out->setstate(std::ios::failbit);
  }

  [[nodiscard]] bool first() const override { return group_.first(); }
  [[nodiscard]] int count() const override { return group_.size(); }
  [[nodiscard]] std::string from_first(std::string text) override {
    return group_.channel().from_first(std::move(text));
  }

  [[nodiscard]] unsigned threads(unsigned asked) override {
    cpu_set_t own;
    CPU_ZERO(&own);
    const int bound = sched_getaffinity(0, sizeof own, &own) == 0 ? CPU_COUNT(&own) : 1;
    const long share = sysconf(_SC_NPROCESSORS_ONLN) / machine_.size();
    return asked > 0 ? asked : static_cast<unsigned>(std::max(1L, std::min<long>(bound, share)));
  }

  [[nodiscard]] std::unique_ptr<LegRun> leg_run(const fs::path& folder, const std::string& prefix,
                                                const Options& options, double start_time,
                                                const std::vector<std::string>& channels) override {
    return std::make_unique<SharedLegRun>(group_, folder, prefix, options, start_time, channels);
  }

  [[nodiscard]] std::string traffic() override {
    mpi::MpiTraffic sum;
    for (const mpi::MpiTraffic& one : group_.channel().gather(group_.channel().traffic())) {
      sum.messages += one.messages;
      sum.bytes += one.bytes;
    }
    std::ostringstream text;
    text << std::setw(12) << sum.messages << " among " << count() << " processes, " << std::fixed
         << std::setprecision(2) << static_cast<double>(sum.bytes) / (1 << 20) << " MiB";
    return text.str();
  }

  void complain() override {
    if (!first()) {  // an error of all is reported by the first, which ends the others meanwhile
      std::signal(SIGTERM, SIG_DFL);
      ::sleep(2);
    }
    for (std::ostream* out : {&std::cout, &std::cerr}) out->clear();
  }
  void abort(int status) override {
    std::cerr << std::flush;
    mpi::MpiSession::abort(status);
  }

  [[nodiscard]] bool builds() const override { return machine_.first(); }
  [[nodiscard]] bool shared() const override { return machine_.size() > 1; }
  [[nodiscard]] std::string from_builder(std::string text) override { return machine_.from_first(std::move(text)); }
  void barrier() override {
    machine_.barrier([] { MpiGroup::pause(); });
  }

 private:
  mpi::MpiSession session_;
  MpiGroup group_;
  mpi::MpiChannel machine_;  // processes of this machine
};

}  // namespace

std::unique_ptr<Ranks> join_ranks(char** /*argv*/) { return std::make_unique<ManyRanks>(); }
