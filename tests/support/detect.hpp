// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <span>

#include <pulsecast/concepts.hpp>

namespace pulsecast::support {

/// What a detector makes of reflections of a laser's pulse, without a gate.
template <class D, class Workspace>
[[nodiscard]] Detection detect(const D& detector, const Laser& laser, std::span<Reflection> reflections,
                               Workspace& workspace, const RandomKey& key = {}) {
  const Emitter emitter{.laser = laser};
  return detector.detect(DetectorInput{emitter, {}, reflections, key}, workspace);
}

/// Steps of a quadrature by `mean_distance`.
struct DistanceSteps {
  double reach = 0;  ///< the maximum is looked for within that of 0 [s]
  double step = 0;   ///< in steps of that [s]
  int count = 0;     ///< of the mean
};

/// Mean distance of a waveform from a pulse, both by their maxima, within a pulse length of the maximum. `waveform(t)`,
/// `pulse(t)`: at a time [s]; the pulse has a maximum of 1 at 0.
template <class Waveform, class Pulse>
[[nodiscard]] double mean_distance(const Waveform& waveform, const Pulse& pulse, double pulse_length,
                                   const DistanceSteps& steps) {
  double top = 0, at = 0;
  for (double t = -steps.reach; t < steps.reach; t += steps.step)
    if (const double here = waveform(t); here > top) {
      top = here;
      at = t;
    }
  double mean = 0;
  for (int i = 0; i < steps.count; ++i) {
    const double t = pulse_length * (2 * (i + 0.5) / steps.count - 1);
    mean += std::fabs(waveform(at + t) / top - pulse(t)) / steps.count;
  }
  return mean;
}

}  // namespace pulsecast::support
