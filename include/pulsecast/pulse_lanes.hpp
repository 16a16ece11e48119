// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PULSE_LANES_HPP
#define PULSECAST_PULSE_LANES_HPP

#include <pulsecast/concepts.hpp>

/// Poses of any motion and pulses of any source in SIMD batches.
namespace PULSECAST_NAMESPACE {

/// Poses of a motion at the ticks of the lanes in `asked`; returns the lanes of these where it is open. A motion that
/// does not move in lanes, or that replaces the `at` of one, is asked tick by tick.
template <class M>
simd::Mask find_poses(const M& motion, const TickLanes& ticks, simd::Mask asked, detail::PosesOf<M>& poses) noexcept {
  static_assert(detail::members_checked<M, tag::Gated, tag::ForeseesOpening, tag::MovesInLanes>);
  if constexpr (MovesInLanes<M> && detail::LanesOfItsPoses<M>) {
    return asked & motion.poses(ticks, poses);
  } else {
    for (std::size_t lane = 0; lane < simd::lane_count; ++lane) {
      if (asked[lane] == 0) continue;
      const Tick t = ticks[lane];
      if constexpr (Gated<M>) asked[lane] = motion.open(t) ? -1 : 0;
      if (asked[lane] != 0) poses.set(lane, motion.at(t));
    }
    return asked;
  }
}

/// Pulses of a source of every `step`-th slot from i on, as the concepts MakesLanes and StridesLanes require: of one
/// slot, if the source does not, or replaces the `pulse` of one that does.
template <class S>
[[nodiscard]] detail::PulsesOf<S> find_pulses(const S& source, PulseIndex i, std::size_t count,
                                              [[maybe_unused]] PulseIndex step = 1) noexcept {
  static_assert(detail::members_checked<S, tag::MakesLanes, tag::StridesLanes, tag::FindsSlots, tag::SkipsBlocked,
                                        tag::DrawsByLeg, tag::MeasuresBeam, tag::StatesErrors>);
  if constexpr (detail::MakesStridedLanes<S>)
    return source.pulse_lanes(i, count, step);
  else if constexpr (MakesLanes<S> && detail::LanesOfItsPulses<S>)
    if (step == 1) return source.pulse_lanes(i, count);
  detail::PulsesOf<S> one;
  one.push_back(source.pulse(i));
  return one;
}

}  // namespace PULSECAST_NAMESPACE

#endif
