// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "summary.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <iomanip>
#include <iostream>

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressLine::operator()(const pulsecast::Progress& progress) {
  const bool last = progress.done == progress.total;
  if (progress.done == 0 || (progress.seconds < next_ && !(last && shown_))) return;
  next_ = progress.seconds + interval_;
  shown_ = true;
  const double done = static_cast<double>(progress.done), total = static_cast<double>(progress.total);
  std::cerr << (terminal_ ? "\r" : "") << std::fixed << std::setprecision(0) << std::setw(4) << 100 * done / total
            << " %  " << (total - done) * progress.seconds / done << " s left   " << (terminal_ && !last ? "" : "\n")
            << std::flush;
}

void print(const pulsecast::RunSummary& run) {
  using enum pulsecast::Fate;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto line = [](const char* name, auto value, const char* unit) {
    std::cout << "  " << std::left << std::setw(13) << name << std::right << std::setw(12) << value << ' ' << unit
              << '\n';
  };
  std::cout << std::fixed << std::setprecision(2);
  line("pulses", run.pulses(), "");
  if (run.count(blocked) > 0)
    line("", run.count(blocked), "more would fall outside the field of view, and are not sent");
  line("echoes", run.echoes, "");
  line("missed", run.count(missed), "pulses, which hit nothing");
  if (run.count(out_of_range) > 0) line("out of range", run.count(out_of_range), "pulses");
  if (run.count(absorbed) > 0) line("absorbed", run.count(absorbed), "pulses");
  if (run.count(below_threshold) > 0) line("too weak", run.count(below_threshold), "pulses");
  line("time", run.seconds, "s");
  if (run.pulses() > 0) line("speed", static_cast<double>(run.pulses()) / run.seconds / 1e6, "million pulses/s");
  line("peak memory", static_cast<double>(usage.ru_maxrss) / 1024, "MiB");  // Linux counts in KiB. Source: getrusage(2)
}
