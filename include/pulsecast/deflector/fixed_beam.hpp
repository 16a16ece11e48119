// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/unit_rotation.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/aim.hpp>

namespace pulsecast {

/// A laser that stands still in its housing: one emitter of a device of many, or a rangefinder. `FixedBeam{aimed_at(azimuth, elevation)}`.
struct FixedBeam {
  Pose<frame::Beam, frame::Instrument> pose{};

  void validate() const {
    require_rotation("FixedBeam::pose.rotation", pose.rotation);
    require_finite("FixedBeam::pose (length of position)", length(pose.position), "m");
  }
  void normalize() noexcept { pose.rotation = unit(pose.rotation); }

  [[nodiscard]] Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return pose; }
};

static_assert(Optic<FixedBeam>);

}  // namespace pulsecast
