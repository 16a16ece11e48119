// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DEFLECTOR_POLYGON_MIRROR_HPP
#define PULSECAST_DEFLECTOR_POLYGON_MIRROR_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/aim.hpp>

namespace PULSECAST_NAMESPACE {

/// Rotating polygon mirror: each facet in turn sweeps the beam from low to high in the plane of
/// forward and up, from -sweep, included, to +sweep, excluded. Pulses outside the gate are blocked;
/// those on its ends pass, however rounded.
struct PolygonMirror {
  using refinements = refines<tag::Gated, tag::ForeseesOpening, tag::MovesInLanes, tag::Validated>;
  double line_rate = 100;             ///< rate of facets, at most 1e12 [Hz]
  double sweep = 2 * pi / 3;          ///< half angle of a facet: a turn by the number of facets [rad]
  double angle_min = -pi;             ///< lower end of the gate [rad]
  double angle_max = pi;              ///< upper end of the gate [rad]
  std::vector<double> facet_tilts{};  ///< deflections by the facets to the right [rad]

  void validate() const {
    require_rate("PolygonMirror::line_rate", line_rate);
    require_within("PolygonMirror::sweep", sweep, 0, pi, "rad");
    require_within("PolygonMirror::angle_min", angle_min, -pi, pi, "rad");
    require_within("PolygonMirror::angle_max", angle_max, angle_min, pi, "rad");
    require_within("PolygonMirror::facet_tilts (number)", facet_tilts.size(), 0, 1000, "");
    for (const double tilt : facet_tilts) require_within("PolygonMirror::facet_tilts", tilt, -pi / 2, pi / 2, "rad");
  }

  [[nodiscard]] double angle(Tick t) const noexcept { return angles(TickLanes(t))[0]; }

  /// Index of the current facet: below the number of tilts, or 0 without tilts.
  [[nodiscard]] std::size_t facet(Tick t) const noexcept {
    if (facet_tilts.size() < 2) return 0;
    const double n = static_cast<double>(facet_tilts.size());
    // whole lines of a turn: rounding of its phase must not change the line
    const double line = std::round(n * t.phase(line_rate / n) - phases(TickLanes(t))[0]);
    return static_cast<std::size_t>(line < 0 ? line + n : line) % facet_tilts.size();
  }

  [[nodiscard]] bool open(Tick t) const noexcept { return gate(angles(TickLanes(t)))[0] != 0; }

  /// Moment at which the beam enters the gate, some rounding errors early.
  [[nodiscard]] Tick next_open(Tick t) const noexcept {
    if (open(t)) return t;
    const double begin = 0.5 * (angle_min / sweep + 1);  // phase; may be before 0 [cycles]
    const double phase = phases(TickLanes(t))[0];
    const double left = angle(t) < angle_min ? begin - phase : 1 - phase + (begin > 0 ? begin : 0);
    const double wait = (left < 2 ? left : 1) - 2 * margin();
    const double longest = 1e15 * line_rate;  // [cycles]: no survey is longer than 1e15 s
    return wait > 0 ? t + Tick::of_seconds((wait < longest ? wait : longest) / line_rate) : t;
  }

  /// The line of a tilted facet lies on a cone, at a constant angle to the plane.
  [[nodiscard]] auto at(Tick t) const noexcept { return pose_in_lanes(*this, t); }

  simd::Mask poses(const TickLanes& t, PoseLanes<frame::Beam, frame::Instrument>& poses) const noexcept {
    const simd::Doubles angle = angles(t);
    poses = aimed_above(angle);
    if (!facet_tilts.empty()) {
      RotationLanes tilts;
      for (std::size_t lane = 0; lane < simd::lane_count; ++lane)
        tilts.set(lane, aimed_at(facet_tilts[facet(t[lane])], 0).rotation);
      poses.rotation = poses.rotation * tilts;
    }
    return gate(angle);
  }

 private:
  /// Error of a phase: 16 units in its last place, and in that of a fraction of a second [cycles].
  [[nodiscard]] double rounding() const noexcept { return 0x1p-48 * (1 + line_rate); }

  /// Phase by which a gate is wider, so that decimal rates stay on its ends for 1e6 lines [cycles].
  [[nodiscard]] double margin() const noexcept { return 0x1p-33 + rounding(); }

  /// Phase of the line [cycles]; what rounding leaves just before its end begins the next one.
  [[nodiscard]] simd::Doubles phases(const TickLanes& t) const noexcept {
    const simd::Doubles phase = t.phase(line_rate);
    return phase < 1 - rounding() ? phase : simd::Doubles{};
  }
  [[nodiscard]] simd::Doubles angles(const TickLanes& t) const noexcept { return sweep * (2.0 * phases(t) - 1.0); }
  [[nodiscard]] simd::Mask gate(const simd::Doubles& angle) const noexcept {
    return (angle >= angle_min - 2 * sweep * margin()) & (angle <= angle_max + 2 * sweep * margin());
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
