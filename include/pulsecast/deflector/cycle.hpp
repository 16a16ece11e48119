// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DEFLECTOR_CYCLE_HPP
#define PULSECAST_DEFLECTOR_CYCLE_HPP

#include <cmath>
#include <cstddef>

#include <pulsecast/base/tick.hpp>

namespace PULSECAST_NAMESPACE {

/// Index, from 0, of the current step in a cycle of n steps at a constant rate [Hz].
/// A time between two steps takes the nearer one, so at the pulse rate every pulse takes one step in spite of rounding.
[[nodiscard]] inline std::size_t step_in_cycle(const Tick& t, double step_rate, std::size_t n) noexcept {
  const double length = static_cast<double>(n);
  const auto step = static_cast<std::size_t>(std::floor(t.phase(step_rate / length) * length + 0.5));
  return step < n ? step : 0;
}

}  // namespace PULSECAST_NAMESPACE

#endif
