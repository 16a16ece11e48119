// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <pulsecast/helios/simulation.hpp>

#include "options.hpp"

/// A figure that is expected, and two between which it will be 19 times in 20.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

/// What a survey would come to with some settings.
struct Forecast {
  pulsecast::helios::Receiving how{};
  std::size_t subrays = 0;        ///< of a pulse
  Estimate seconds{};             ///< from start to end [s]
  Estimate memory{};              ///< at most, at a time [byte]
  Estimate points{};              ///< in all files
  Estimate bytes{};               ///< of all files
  Estimate range_error{};         ///< which 19 of 20 echoes do not exceed, against a far finer simulation [m]
  Estimate intensity_error{};     ///< the same, as a share of the intensity
  double lost = 0, invented = 0;  ///< echoes of the finer simulation that are not there, and those that only are here, as shares
};

/// What is known of a survey from a sample of its pulses.
struct Forecasts {
  double loading = 0;           ///< what the scene took, now [s]
  std::uint64_t slots = 0;      ///< of the survey
  std::uint64_t sampled = 0;    ///< slots that were simulated for the forecasts of `all.front()`
  std::size_t finest = 0;       ///< subrays of the simulation that errors are against
  std::vector<Forecast> all{};  ///< first as the survey is
};

/// Simulates samples of a survey at several settings. The simulation must be as made; `loading` is what that took [s].
Forecasts forecasts_of(pulsecast::helios::Simulation& simulation, const pulsecast::helios::SurveySettings& survey, const Options& options,
                       std::uint64_t seed, double loading);
