// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include <pulsecast/concepts.hpp>

namespace pulsecast {

/// Not measured: 0.
struct NoWidth {
  [[nodiscard]] double width(std::span<const double>, double) const noexcept { return 0; }
};

/// By the second central moment of the waveform.
struct MomentWidth {
  [[nodiscard]] double width(std::span<const double> samples, double interval) const noexcept {
    double sum = 0, first = 0, second = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double t = static_cast<double>(i);
      sum += samples[i], first += samples[i] * t, second += samples[i] * t * t;
    }
    if (!(sum > 0)) return 0;
    const double mean = first / sum;
    const double variance = second / sum - mean * mean;
    return variance > 0 ? interval * std::sqrt(variance) : 0;
  }
};

static_assert(EchoWidth<NoWidth> && EchoWidth<MomentWidth>);

}  // namespace pulsecast
