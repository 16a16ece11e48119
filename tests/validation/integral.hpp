// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Integrals that closed forms are made of.
#pragma once

namespace pulsecast::validation {

/// Integral of `f` between two limits, by the midpoint rule.
template <class F>
double integral(const F& f, double from, double to, int steps) {
  double sum = 0;
  for (int k = 0; k < steps; ++k) sum += f(from + (k + 0.5) / steps * (to - from));
  return sum * (to - from) / steps;
}

}  // namespace pulsecast::validation
