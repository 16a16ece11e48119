// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <map>
#include <string>

#include <pulsecast/helios/simulation.hpp>
#include <pulsecast/run_errors.hpp>

#include "options.hpp"

/// What a run was made from, for its report.
struct RunOrigin {
  std::string settings{}, options{};            ///< all settings as XML; options of the command line as text
  std::map<std::string, std::string> inputs{};  ///< input files, with their fingerprints
  std::uint64_t seed = 0;
  int repetition = 0;  ///< from 0
  std::string chosen{};  ///< settings that `--accuracy` chose, in place of those of the survey
};

/// Errors of a run (`--errors`), computed while the run goes on.
class ErrorReport {
 public:
  static constexpr const char* name = "report.json";

  /// Begins to compute; simulation and options must outlive it.
  ErrorReport(const pulsecast::helios::Simulation& simulation, const Options& options, std::uint64_t seed);

  /// Waits for the errors, writes them into the folder, and prints them unless all is quiet.
  void finish(const std::filesystem::path& folder, RunOrigin origin, const pulsecast::RunSummary& run);

 private:
  const Options& options_;
  std::future<pulsecast::RunErrors> errors_;
};

/// Name of a figure for users.
const char* label_of(pulsecast::ErrorFigure figure);
/// Value and limits of a figure, in the unit of lengths or in percent.
std::string text_of(const pulsecast::EchoErrors& errors, pulsecast::ErrorFigure figure);
/// Prints the errors of all parts; `by_class` also those of each class.
void print(const pulsecast::RunErrors& errors, bool by_class);
