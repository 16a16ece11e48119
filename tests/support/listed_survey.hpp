// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <pulsecast/concepts.hpp>

namespace pulsecast::support {

/// A survey whose echoes are those of a function of the slot.
struct Listed {
  struct Workspace {
    std::vector<Echo> echoes;
  };
  PulseIndex slots = 1000;
  std::function<std::vector<Echo>(PulseIndex)> echoes{};
  Vec3 moved{};                        ///< of the reported beams [m]
  PulseIndex blocked = 1'000'000'000;  ///< one slot in so many is blocked
  std::size_t rays = 1;                ///< number of subrays

  Workspace workspace() const { return {}; }
  PulseIndex size() const noexcept { return slots; }
  std::size_t subrays() const noexcept { return rays; }
  std::size_t recorded_subrays() const noexcept { return 0; }
  double sample_interval() const noexcept { return 0; }
  Outcome operator()(PulseIndex i, Workspace& w) const noexcept {
    Outcome outcome;
    outcome.shot.index = i;
    outcome.shot.origin = moved;
    outcome.shot.direction = axis::forward;
    w.echoes = i % blocked == blocked - 1 ? std::vector<Echo>{} : echoes(i);
    outcome.echoes = w.echoes;
    outcome.shot.fate = i % blocked == blocked - 1 ? Fate::blocked : w.echoes.empty() ? Fate::missed : Fate::returned;
    return outcome;
  }
};
static_assert(PulseSurvey<Listed>);

inline Echo echo_at(double range, double amplitude = 1, std::uint16_t classification = 0) {
  Echo echo;
  echo.range = range;
  echo.amplitude = amplitude;
  echo.classification = classification;
  return echo;
}

}  // namespace pulsecast::support
