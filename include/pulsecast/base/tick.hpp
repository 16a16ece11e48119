// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

#include <pulsecast/base/arithmetic.hpp>

namespace pulsecast {

/// Number of a pulse slot in its source, from 0.
using PulseIndex = std::uint64_t;

/// A moment of the survey since its start, as exact after a year as in the first second.
struct Tick {
  std::int64_t second = 0;  ///< whole seconds
  double fraction = 0;      ///< the rest, in [0, 1) [s]

  /// The moment when slot i of a source of constant rate [Hz] begins.
  [[nodiscard]] static Tick of(PulseIndex i, double rate) noexcept {
    const double n = static_cast<double>(i);
    double whole = std::floor(n / rate), rest = std::fma(-whole, rate, n);  // exact, if `whole` is the right one of two
    if (rest < 0) --whole, rest = std::fma(-whole, rate, n);
    if (rest >= rate) ++whole, rest = std::fma(-whole, rate, n);
    return normal(static_cast<std::int64_t>(whole), rest / rate);
  }

  /// A span or moment given in seconds.
  [[nodiscard]] static Tick of_seconds(double seconds) noexcept {
    const double whole = std::floor(seconds);
    return normal(static_cast<std::int64_t>(whole), seconds - whole);
  }

  /// As one number; rounds to some 1e-16 of its size [s].
  [[nodiscard]] double seconds() const noexcept { return static_cast<double>(second) + fraction; }

  /// What a clockwork of constant frequency [Hz] shows: the part of a turn done, in [0, 1).
  /// The whole turns are taken off exactly, so the phase does not wear out with time.
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

  friend auto operator<=>(const Tick&, const Tick&) = default;

 private:
  [[nodiscard]] static Tick normal(std::int64_t second, double fraction) noexcept {
    return fraction < 1 ? Tick{second, fraction} : Tick{second + 1, fraction - 1};
  }
};

}  // namespace pulsecast
