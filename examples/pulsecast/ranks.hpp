// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/helios/simulation.hpp>
#include <pulsecast/run.hpp>

#include "options.hpp"
#include "scene_sharing.hpp"

/// What becomes of one leg, or of all legs of a strip: they are simulated, and written as `LegFiles` says.
class LegRun {
 public:
  virtual ~LegRun() = default;
  std::function<void(const pulsecast::EchoBatch&)> watch{};  ///< sees what is written; only where there is one process
  virtual void add_trajectory(const pulsecast::helios::SurveyLeg& leg, pulsecast::Tick start, double interval) = 0;
  virtual pulsecast::RunSummary run(const pulsecast::helios::Simulation& simulation, const pulsecast::RunOptions& options) = 0;
  virtual void close() = 0;
};

/// The processes that run a survey together: one, or those that `mpirun` has started. All do the same, but what only one may do, as to name
/// a folder, is done by the first, which tells the others; and only it is heard on the terminal.
class Ranks : public SceneSharing {
 public:
  [[nodiscard]] virtual bool first() const = 0;
  [[nodiscard]] virtual int count() const = 0;
  /// What the first says, by all.
  [[nodiscard]] virtual std::string from_first(std::string text) = 0;
  /// As many as are asked for; if none are, a fair share of the machine's.
  [[nodiscard]] virtual unsigned threads(unsigned asked) = 0;
  [[nodiscard]] virtual std::unique_ptr<LegRun> leg_run(const std::filesystem::path& folder, const std::string& prefix,
                                                        const Options& options, double start_time,
                                                        const std::vector<std::string>& channels) = 0;
  /// What the processes have sent to each other, for the table that ends a run. Nothing if there is only one.
  [[nodiscard]] virtual std::string traffic() = 0;
  /// Something went wrong, maybe here only: lets this process be heard, unless the first says the same.
  virtual void complain() = 0;
  /// Ends all processes, if there are others.
  virtual void abort(int status) = 0;
};

/// To be called before all else. Where `mpirun` or its like has started several processes, the program that knows MPI takes the place of
/// this one; throws if it is not there.
std::unique_ptr<Ranks> join_ranks(char** argv);
