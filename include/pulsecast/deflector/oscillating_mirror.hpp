// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include <pulsecast/base/require.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/aim.hpp>

namespace pulsecast {

/// How an oscillating mirror gets from one end to the other.
enum class Swing : std::uint8_t {
  triangle,  ///< at a constant rate, turning round at a constant acceleration
  sine,      ///< as a resonant mirror does
};

/// A mirror that swings the beam to and fro in the plane of forward and up, from -half_angle to +half_angle and back. It starts at the
/// lower end. One cycle is two lines.
struct OscillatingMirror {
  double cycles_per_second = 50;  ///< to and fro, at most 1e12 [Hz]
  double half_angle = pi / 9;     ///< of the beam either side of forward; the mirror itself turns half as far [rad]
  Swing swing = Swing::triangle;  ///< how it gets from end to end
  double turning_time = 0;  ///< of one turning round, half of it before the end and half after; of a triangle, at most half a cycle [s]

  void validate() const {
    require_rate("OscillatingMirror::cycles_per_second", cycles_per_second);
    require_within("OscillatingMirror::half_angle", half_angle, 0, pi, "rad");
    require_within("OscillatingMirror::turning_time", turning_time, 0, swing == Swing::triangle ? 0.5 / cycles_per_second : 0, "s");
  }

  /// Above forward [rad].
  [[nodiscard]] double angle(Tick t) const noexcept {
    const double phase = t.phase(cycles_per_second);
    if (swing == Swing::sine) return -half_angle * std::cos(2 * pi * phase);
    const double turn = turning_time * cycles_per_second;  // [cycles]
    const double rate = 4 * half_angle / (1 - turn);       // between the turns, so that the parabolas end at the half angle [rad/cycle]
    const double after = phase < 0.5 ? phase : 1 - phase;  // the lower end; the way back mirrors the way there [cycles]
    const double before = 0.5 - after;                     // the upper end [cycles]
    if (after < 0.5 * turn) return -half_angle + rate * after * after / turn;
    if (before < 0.5 * turn) return half_angle - rate * before * before / turn;
    return rate * (after - 0.25);
  }

  [[nodiscard]] Pose<frame::Beam, frame::Instrument> at(Tick t) const noexcept { return aimed_above(angle(t)); }
};

static_assert(Optic<OscillatingMirror>);

}  // namespace pulsecast
