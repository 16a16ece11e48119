// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>

#include <pulsecast/base/tick.hpp>

namespace pulsecast {

/// Which of n steps a clockwork is at, from 0, when it takes them one after the other at a constant rate [Hz], over and over.
/// A moment between two steps belongs to the nearer one: so a clockwork at the pulse rate takes one step a pulse, however times round.
[[nodiscard]] inline std::size_t step_in_cycle(const Tick& t, double steps_per_second, std::size_t n) noexcept {
  const double length = static_cast<double>(n);
  const auto step = static_cast<std::size_t>(std::floor(t.phase(steps_per_second / length) * length + 0.5));
  return step < n ? step : 0;
}

}  // namespace pulsecast
