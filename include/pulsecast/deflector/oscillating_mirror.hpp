// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DEFLECTOR_OSCILLATING_MIRROR_HPP
#define PULSECAST_DEFLECTOR_OSCILLATING_MIRROR_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/aim.hpp>

namespace PULSECAST_NAMESPACE {

/// Motion of an oscillating mirror from one end to the other.
enum class Swing : std::uint8_t {
  triangle,  ///< constant rate, and constant acceleration at the turning points
  sine,      ///< harmonic, such as that of a resonant mirror
};

/// Mirror that oscillates the beam in the plane of forward and up, first from -half_angle upwards.
struct OscillatingMirror {
  using refinements = refines<tag::MovesInLanes, tag::Validated>;
  double cycle_rate = 50;         ///< full oscillations per second, at most 1e12 [Hz]
  double half_angle = pi / 9;     ///< of the beam to either side, twice the mirror's [rad]
  Swing swing = Swing::triangle;  ///< motion from end to end
  double turning_time = 0;        ///< duration of a reversal; at most half a cycle, 0 for a sine [s]

  void validate() const {
    require_rate("OscillatingMirror::cycle_rate", cycle_rate);
    require_within("OscillatingMirror::half_angle", half_angle, 0, pi, "rad");
    const double most = swing == Swing::triangle ? 0.5 / cycle_rate : 0;
    require_within("OscillatingMirror::turning_time", turning_time, 0, most, "s");
  }

  [[nodiscard]] double angle(Tick t) const noexcept { return angles(TickLanes(t))[0]; }

  [[nodiscard]] auto at(Tick t) const noexcept { return pose_in_lanes(*this, t); }

  simd::Mask poses(const TickLanes& t, PoseLanes<frame::Beam, frame::Instrument>& poses) const noexcept {
    poses = aimed_above(angles(t));
    return all_lanes();
  }

 private:
  [[nodiscard]] simd::Doubles angles(const TickLanes& t) const noexcept {
    const simd::Doubles phase = t.phase(cycle_rate);
    if (swing == Swing::sine) return -half_angle * simd::cos(simd::Doubles(2 * pi * phase));
    const double turn = turning_time * cycle_rate;                  // [cycles]
    const double rate = 4 * half_angle / (1 - turn);                // between parabolas [rad/cycle]
    const simd::Doubles after = phase < 0.5 ? phase : 1.0 - phase;  // since the lower end [cycles]
    const simd::Doubles before = 0.5 - after;                       // until the upper end [cycles]
    const simd::Doubles lower = rate * after * after / turn - half_angle,
                        upper = half_angle - rate * before * before / turn;
    return after < 0.5 * turn ? lower : (before < 0.5 * turn ? upper : rate * (after - 0.25));
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
