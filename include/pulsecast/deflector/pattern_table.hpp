// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DEFLECTOR_PATTERN_TABLE_HPP
#define PULSECAST_DEFLECTOR_PATTERN_TABLE_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/aim.hpp>

namespace PULSECAST_NAMESPACE {

/// Direction of a beam as two angles.
struct BeamAngles {
  double azimuth = 0;    ///< angle from forward to the right [rad]
  double elevation = 0;  ///< angle above the plane of right and forward [rad]
};

/// Beam directions from a table, in turn and repeated: a solid-state sensor, or a log.
struct PatternTable {
  using refinements = refines<tag::Validated>;
  std::vector<BeamAngles> entries{};  ///< directions in the order of use; at least one
  double entry_rate = 100e3;          ///< best the pulse rate; at most 1e12 [Hz]

  void validate() const {
    require_within("PatternTable::entries (number)", entries.size(), 1, 1e9, "");
    require_rate("PatternTable::entry_rate", entry_rate);
    for (const BeamAngles& e : entries) {
      require_angle("BeamAngles::azimuth", e.azimuth);
      require_within("BeamAngles::elevation", e.elevation, -pi / 2, pi / 2, "rad");
    }
  }

  /// Index of the current entry, from 0.
  [[nodiscard]] std::size_t entry(Tick t) const noexcept { return step_in_cycle(t, entry_rate, entries.size()); }

  [[nodiscard]] Pose<frame::Beam, frame::Instrument> at(Tick t) const noexcept {
    const BeamAngles& e = entries[entry(t)];
    return aimed_at(e.azimuth, e.elevation);
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
