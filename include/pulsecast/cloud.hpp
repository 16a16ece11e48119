// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_CLOUD_HPP
#define PULSECAST_CLOUD_HPP

#include <vector>

#include <pulsecast/echo.hpp>

namespace PULSECAST_NAMESPACE {

/// Point cloud in memory: a sink that keeps every echo, column by column.
struct Cloud {
  std::vector<Vec3> points;        ///< points in the world [m]
  std::vector<Echo> echoes;        ///< echo of each point
  std::vector<PulseIndex> pulses;  ///< pulse index of each point
  std::vector<Tick> ticks;         ///< emission time of that pulse, since the survey's start

  /// Appends the echoes of a batch. Errors: std::bad_alloc.
  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) {
        points.push_back(point_of(shot, echo));
        echoes.push_back(echo);
        pulses.push_back(shot.index);
        ticks.push_back(shot.tick);
      }
  }

  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< as the concept ChoosesShots describes

  [[nodiscard]] std::size_t size() const noexcept { return points.size(); }
};

}  // namespace PULSECAST_NAMESPACE

#endif
