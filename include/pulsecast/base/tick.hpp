// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_TICK_HPP
#define PULSECAST_BASE_TICK_HPP

#include <cmath>
#include <compare>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE {

/// Number of a pulse slot in its source, from 0.
using PulseIndex = std::uint64_t;

/// Time since the start of the survey, as exact after a year as in the first second.
struct Tick {
  std::int64_t second = 0;  ///< whole part [s]
  double fraction = 0;      ///< fractional part, in [0, 1) [s]

  /// Begin of slot i of a source of constant rate [Hz].
  [[nodiscard]] static Tick of(PulseIndex i, double rate) noexcept {
    const double n = static_cast<double>(i);
    double whole = std::floor(n / rate);
    double rest = std::fma(-whole, rate, n);  // exact, if `whole` is the right one of two
    if (rest < 0) {
      --whole;
      rest = std::fma(-whole, rate, n);
    }
    if (rest >= rate) {
      ++whole;
      rest = std::fma(-whole, rate, n);
    }
    return normal(static_cast<std::int64_t>(whole), rest / rate);
  }

  /// Time span or point in time, given in seconds.
  [[nodiscard]] static Tick of_seconds(double seconds) noexcept {
    const double whole = std::floor(seconds);
    return normal(static_cast<std::int64_t>(whole), seconds - whole);
  }

  /// Time as one number, rounded to some 1e-16 of its size [s].
  [[nodiscard]] double seconds() const noexcept { return static_cast<double>(second) + fraction; }

  /// Phase of an oscillation of constant frequency [Hz]: completed part of the cycle, in [0, 1).
  /// Whole cycles are removed exactly, so the phase keeps its precision over time.
  [[nodiscard]] double phase(double frequency) const noexcept {
    const double whole = static_cast<double>(second);
    const double turns = frequency * whole;
    const double lost = std::fma(frequency, whole, -turns);
    const double phase = (turns - std::floor(turns)) + frequency * fraction + lost;
    const double wrapped = phase - std::floor(phase);
    return wrapped < 1 ? wrapped : 0;
  }

  [[nodiscard]] friend Tick operator+(const Tick& a, const Tick& b) noexcept {
    return normal(a.second + b.second, a.fraction + b.fraction);
  }

  /// Time span from b to a; seconds may be negative.
  [[nodiscard]] friend Tick operator-(const Tick& a, const Tick& b) noexcept {
    const double rest = a.fraction - b.fraction;
    return rest < 0 ? normal(a.second - b.second - 1, rest + 1) : normal(a.second - b.second, rest);
  }

  friend auto operator<=>(const Tick&, const Tick&) = default;

 private:
  [[nodiscard]] static Tick normal(std::int64_t second, double fraction) noexcept {
    return fraction < 1 ? Tick{second, fraction} : Tick{second + 1, fraction - 1};
  }
};

/// Current step, from 0, in a cycle of n steps at a constant rate [Hz]. A time between two takes
/// the nearer, so that at the pulse rate every pulse takes one step in spite of rounding.
[[nodiscard]] inline std::size_t step_in_cycle(const Tick& t, double steps_per_second, std::size_t n) noexcept {
  const double length = static_cast<double>(n), place = t.phase(steps_per_second / length) * length;
  const auto step = static_cast<std::size_t>(std::floor(place + 0.5));
  return step < n ? step : 0;
}

}  // namespace PULSECAST_NAMESPACE

#endif
