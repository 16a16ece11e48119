// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/survey.hpp>

namespace pulsecast::validation {

/// What a pulse brought back: an `Outcome` that keeps.
struct Result {
  EnergyLedger energy;
  double power = 0;  ///< of all subrays together [W]
  std::vector<SubrayRecord> subrays;
  std::vector<Echo> echoes;
  std::vector<float> waveform;  ///< received power, if the detector keeps it [W]
  double waveform_start = 0;    ///< two-way travel time of its first sample [s]
};

inline const Receiver vacuum{.visibility = std::numeric_limits<double>::infinity()};

/// One pulse from the origin to the north, along +y.
template <Footprint Pattern, Target Map, Detector Instrument = FirstHit>
[[nodiscard]] Result one_pulse(const Map& map, const Pattern& footprint, const Laser& laser = {},
                               const Receiver& receiver = vacuum, const Instrument& detector = {}) {
  const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 1, .laser = laser}}};
  const Survey survey{source, WithSubrayRecord{footprint}, map, receiver, detector};
  auto workspace = survey.workspace();
  const Outcome o = survey(0, workspace);
  Result result{o.energy,
                0,
                {o.subrays.begin(), o.subrays.end()},
                {o.echoes.begin(), o.echoes.end()},
                {o.waveform.begin(), o.waveform.end()},
                o.shot.waveform_start};
  for (const SubrayRecord& hit : o.subrays) result.power += hit.power;
  return result;
}

}  // namespace pulsecast::validation
