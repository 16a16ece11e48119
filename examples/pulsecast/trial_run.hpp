// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <pulsecast/forecast.hpp>
#include <pulsecast/helios/simulation.hpp>

#include "options.hpp"

/// Cost of writing a survey: a part that grows with the results, and one that does not.
struct WritingCost {
  double point = 0, line = 0;  ///< per point; per pulse that counts
  double fixed = 0;            ///< files without results, and trajectories
  double unsure = 0;           ///< half width of the 95 % interval, relative to the growing part

  [[nodiscard]] double growing(double points, double lines) const { return points * point + lines * line; }
  /// Scales to a known total cost.
  void scale_to(double all, double points, double lines);
};

/// Costs of writing a survey with the settings of a run.
struct WritingCosts {
  WritingCost bytes{};    ///< [byte]
  WritingCost seconds{};  ///< of a processor [s]
};

/// Pulses that count beside the points, as files have a line for each.
enum class PulseLines { none, empty, all };
PulseLines pulse_lines(const Options& options, const std::vector<std::string>& channels);

/// Writes stretches of a survey by the writers of a run: those that begin at `starts`, until their number and processor
/// time suffice.
WritingCosts writing_costs(const pulsecast::helios::Simulation& simulation, const Options& options,
                           const std::vector<std::string>& channels, PulseLines counted,
                           std::span<const pulsecast::PulseIndex> starts);

/// Resident memory of a process [byte].
struct Resident {
  double own = 0, file = 0, peak = 0;  ///< anonymous memory; pages of files; peak resident memory so far
};

/// Trial of a run: each leg was simulated and written until more points would take no more memory, or processor time
/// ran out.
struct TrialRun {
  std::uint64_t filling = 0;     ///< points that fill the buffers of the writers
  Resident before{}, after{};    ///< memory before the trial, and after it in the process of its own that it had
  bool complete = false;         ///< the whole survey was written:
  double points = 0, lines = 0;  ///< number of points, and of pulses that count
  double bytes = 0;              ///< of all files [byte]
  double most_points = 0;        ///< of a set of files

  /// Peak memory of a run of at most `of_run` points [byte].
  [[nodiscard]] pulsecast::Estimate memory(double of_run, const Options& options) const;
};

/// Tries a run in a child process. The simulation must be new, as in a run.
TrialRun trial_run(const pulsecast::helios::Simulation& simulation, const Options& options,
                   const std::vector<std::string>& channels, PulseLines counted);
