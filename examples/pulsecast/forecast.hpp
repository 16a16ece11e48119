// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <pulsecast/forecast.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/helios/simulation.hpp>

#include "options.hpp"
#include "trial_run.hpp"

/// Forecast of a survey with certain settings.
struct Forecast {
  pulsecast::helios::ReceiverOverrides overrides{};
  std::size_t subrays = 0;         ///< per pulse
  pulsecast::Estimate seconds{};   ///< total run time [s]
  pulsecast::Estimate memory{};    ///< peak [byte]
  pulsecast::Estimate points{};    ///< in all files
  pulsecast::Estimate bytes{};     ///< of all files
  pulsecast::EchoErrors errors{};  ///< without those of the instrument, against the reference
};

/// Forecasts of a survey from a sample of its pulses.
struct Forecasts {
  double loading = 0;           ///< time of loading the scene, now [s]
  std::uint64_t slots = 0;      ///< number of slots in the survey
  std::uint64_t sampled = 0;    ///< simulated slots of `all.front()`
  std::size_t finest = 0;       ///< subrays of the reference simulation
  std::vector<Forecast> all{};  ///< the first has the survey's own settings; the second, if an accuracy is asked for,
  ///< those that reach it, or come nearest
};

/// Simulates samples of a survey at several settings. The simulation must be new; `loading` is the time of making it
/// [s].
Forecasts forecasts_of(const pulsecast::helios::Simulation& simulation, const pulsecast::helios::SurveySettings& survey,
                       const Options& options, std::uint64_t seed, double loading);
