// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <pulsecast/base/expect.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/aim.hpp>

namespace pulsecast {

/// A laser that stands still in its housing: one emitter of a device of many, or a rangefinder. `FixedBeam{aimed_at(azimuth, elevation)}`.
struct FixedBeam {
  Pose<frame::Beam, frame::Instrument> pose{};

  void validate() const {
    expect_within("FixedBeam::pose (norm of rotation)", length(pose.rotation), 1 - 1e-9, 1 + 1e-9, "");
    expect_finite("FixedBeam::pose (length of position)", length(pose.position), "m");
  }

  [[nodiscard]] Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return pose; }
};

static_assert(Optic<FixedBeam>);

}  // namespace pulsecast
