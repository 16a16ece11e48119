// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <pulsecast/run.hpp>

/// Prints the progress of a run, its rate and the time left on the terminal: in one line that is renewed in place.
/// Elsewhere, as in the log of a server, a new line every five seconds.
class ProgressLine {
 public:
  ProgressLine();
  void operator()(const pulsecast::Progress& progress);

 private:
  bool terminal_;
  double interval_ = terminal_ ? 0.2 : 5.0;
  double next_ = interval_;
  bool shown_ = false;
};

/// The table that ends a run.
void print(const pulsecast::RunSummary& run);
