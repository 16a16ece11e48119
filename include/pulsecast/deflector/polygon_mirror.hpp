// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <pulsecast/base/expect.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast {

/// A rotating polygon mirror: every facet sweeps the beam once from low to high, in the plane of forward and up, then the next one takes
/// over. Pulses outside the gate are blocked. The angle of a beam above forward counts from -sweep to +sweep.
struct PolygonMirror {
  double lines_per_second = 100;  ///< facets that pass [Hz]
  double sweep = 2 * pi / 3;      ///< half angle that one facet sweeps: a full turn by the number of facets [rad]
  double angle_min = -pi;         ///< the gate opens above this angle [rad]
  double angle_max = pi;          ///< and closes above this one [rad]

  void validate() const {
    expect_positive("PolygonMirror::lines_per_second", lines_per_second, "Hz");
    expect_within("PolygonMirror::sweep", sweep, 0, pi, "rad");
    expect_within("PolygonMirror::angle_min", angle_min, -pi, pi, "rad");
    expect_within("PolygonMirror::angle_max", angle_max, angle_min, pi, "rad");
  }

  /// Above forward [rad].
  [[nodiscard]] double angle(Tick t) const noexcept { return sweep * (2 * t.phase(lines_per_second) - 1); }

  [[nodiscard]] bool open(Tick t) const noexcept {
    const double a = angle(t);
    return a >= angle_min && a <= angle_max;
  }

  [[nodiscard]] Pose<frame::Beam, frame::Instrument> at(Tick t) const noexcept {
    const double half = 0.5 * angle(t);
    return {Rotation{std::cos(half), std::sin(half), 0, 0}, {}};  // about right
  }
};

static_assert(Optic<PolygonMirror> && Gated<PolygonMirror>);

}  // namespace pulsecast
