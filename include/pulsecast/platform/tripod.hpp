// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_TRIPOD_HPP
#define PULSECAST_PLATFORM_TRIPOD_HPP

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Static trajectory, level.
struct Tripod {
  using refinements = refines<tag::MovesInLanes, tag::Differentiable, tag::Validated>;
  Vec3 position{};     ///< foot of the tripod, in the world [m]
  double heading = 0;  ///< compass heading, clockwise from north [rad]

  void validate() const {
    require_finite("Tripod::position (x)", position.x, "m");
    require_finite("Tripod::position (y)", position.y, "m");
    require_finite("Tripod::position (z)", position.z, "m");
    require_angle("Tripod::heading", heading);
  }

  [[nodiscard]] Pose<frame::Body, frame::World> at(Tick) const noexcept { return {level(heading), position}; }
  [[nodiscard]] Derivatives derivatives(Tick) const noexcept { return {}; }

  simd::Mask poses(const TickLanes& t, PoseLanes<frame::Body, frame::World>& poses) const noexcept {
    poses = PoseLanes(at(t[0]));
    return all_lanes();
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
