// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <pulsecast/base/expect.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/aim.hpp>

namespace pulsecast {

/// A laser that stands still in its housing: one emitter of a device of many, or a rangefinder.
struct FixedBeam {
  double azimuth = 0;    ///< from forward to the right [rad]
  double elevation = 0;  ///< above the plane of right and forward [rad]
  Vec3 origin{};         ///< where the beam leaves [m]

  void validate() const {
    expect_finite("FixedBeam::azimuth", azimuth, "rad");
    expect_within("FixedBeam::elevation", elevation, -pi / 2, pi / 2, "rad");
    expect_finite("FixedBeam::origin (length)", length(origin), "m");
  }

  [[nodiscard]] Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return {aimed_at(azimuth, elevation).rotation, origin}; }
};

static_assert(Optic<FixedBeam>);

}  // namespace pulsecast
