// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/any_survey.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/run.hpp>

#include "options.hpp"
#include "point_files.hpp"
#include "scene_sharing.hpp"

/// Run of one leg, or of all legs of a strip: simulates them and writes `LegFiles`.
class LegRun {
 public:
  virtual ~LegRun() = default;
  std::function<void(const pulsecast::EchoBatch&)> watch{};  ///< receives the shots with echoes; with one process only
  virtual void add_trajectory(const pulsecast::helios::SurveyLeg& leg, pulsecast::Tick start, double interval) = 0;
  virtual pulsecast::RunSummary run(const pulsecast::AnySurvey& survey, const pulsecast::RunOptions& options) = 0;
  virtual void close() = 0;
  /// What its files do not hold, once closed, on the first process.
  [[nodiscard]] virtual LeftOut left_out() const = 0;
};

/// Processes of a survey: one, or those of `mpirun`. All do the same. The first one alone does unique tasks, such as
/// naming a folder, and sends the result to the others. Only the first prints to the terminal.
class Ranks : public SceneSharing {
 public:
  [[nodiscard]] virtual bool first() const = 0;
  [[nodiscard]] virtual int count() const = 0;
  /// Text of the first process, on all.
  [[nodiscard]] virtual std::string from_first(std::string text) = 0;
  /// Number of threads as requested; 0: a fair share of the machine.
  [[nodiscard]] virtual unsigned threads(unsigned asked) = 0;
  [[nodiscard]] virtual std::unique_ptr<LegRun> leg_run(const std::filesystem::path& folder, const std::string& prefix,
                                                        const Options& options, double start_time,
                                                        const std::vector<std::string>& channels) = 0;
  /// Messages between the processes, for the final table. Empty for one process.
  [[nodiscard]] virtual std::string traffic() = 0;
  /// Lets this process print an error, unless the first one reports the same.
  virtual void complain() = 0;
  /// Ends all other processes, if any.
  virtual void abort(int status) = 0;
};

/// Joins the processes; must be called first. If `mpirun` or a similar launcher started several, the MPI program
/// replaces this one; throws if it is missing.
std::unique_ptr<Ranks> join_ranks(char** argv);
