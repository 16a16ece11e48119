// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DEFLECTOR_FIXED_BEAM_HPP
#define PULSECAST_DEFLECTOR_FIXED_BEAM_HPP

#include <pulsecast/base/unit_rotation.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/aim.hpp>

namespace PULSECAST_NAMESPACE {

/// Laser fixed in its housing, such as a rangefinder: `FixedBeam{aimed_at(azimuth, elevation)}`.
struct FixedBeam {
  using refinements = refines<tag::MovesInLanes, tag::Validated, tag::Normalizable>;
  Pose<frame::Beam, frame::Instrument> pose{};  ///< of the beam; rotation unit to within 1e-3

  void validate() const {
    require_rotation("FixedBeam::pose.rotation", pose.rotation);
    require_finite("FixedBeam::pose (length of position)", length(pose.position), "m");
  }
  void normalize() noexcept { pose.rotation = unit(pose.rotation); }

  [[nodiscard]] Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return pose; }

  simd::Mask poses(const TickLanes&, PoseLanes<frame::Beam, frame::Instrument>& at) const noexcept {
    at = PoseLanes(pose);
    return all_lanes();
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
