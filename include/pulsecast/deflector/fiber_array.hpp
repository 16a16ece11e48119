// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DEFLECTOR_FIBER_ARRAY_HPP
#define PULSECAST_DEFLECTOR_FIBER_ARRAY_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/aim.hpp>

namespace PULSECAST_NAMESPACE {

/// Row of fibres in the plane of forward and up, lit in turn from -half_angle to +half_angle.
struct FiberArray {
  using refinements = refines<tag::Validated>;
  std::uint32_t fibers = 128;  ///< number of fibres in the row
  double fiber_rate = 100e3;   ///< best the pulse rate; at most 1e12 [Hz]
  double half_angle = pi / 9;  ///< angle of the outermost fibres to either side of forward [rad]

  void validate() const {
    require_within("FiberArray::fibers", fibers, 1, 4294967295.0, "");
    require_rate("FiberArray::fiber_rate", fiber_rate);
    require_within("FiberArray::half_angle", half_angle, 0, pi, "rad");
  }

  /// Index of the lit fibre, from 0.
  [[nodiscard]] std::size_t fiber(Tick t) const noexcept { return step_in_cycle(t, fiber_rate, fibers); }

  [[nodiscard]] double angle(Tick t) const noexcept {
    return fibers == 1 ? 0 : half_angle * (2 * static_cast<double>(fiber(t)) / (fibers - 1.0) - 1);
  }

  [[nodiscard]] Pose<frame::Beam, frame::Instrument> at(Tick t) const noexcept { return aimed_above(angle(t)); }
};

}  // namespace PULSECAST_NAMESPACE

#endif
