// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_SURVEY_HPP
#define PULSECAST_HELIOS_SURVEY_HPP

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/helios/detail/leg.hpp>
#include <pulsecast/helios/detail/survey_options.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/platform/legs.hpp>

/// Compilation of survey settings to pulses.
namespace PULSECAST_NAMESPACE::helios {

/// Runnable survey, with data of its legs.
struct CompiledSurvey {
  /// Leg of the survey.
  struct Leg {
    std::size_t number = 0;              ///< index in the document, from 0
    bool active = true;                  ///< true if pulses are emitted
    std::optional<std::string> strip{};  ///< name of its strip, if any
    PulseIndex first = 0, end = 0;       ///< range of its slots in the survey
    Tick start{}, duration{};            ///< start since the survey's start; duration
    double trajectory_interval = 0;      ///< interval of trajectory records; 0: none [s]
    double pulse_rate = 0;               ///< pulse rate [Hz]
  };
  Legs<SurveyLeg> source;  ///< source of all pulses; each distinct receiver of the scanner's channels has an index
  std::vector<Leg> legs;   ///< legs, in order of the document
  std::optional<double>
      clock_start{};  ///< start time of the survey, that of its earliest leg, if a trajectory gives it [s]
  std::vector<std::string> warnings{};  ///< warnings of the compilation
};

/// Pulses of a survey. `ground` gives the height of the scene's ground [m]. Throws a `SettingError` with leg and
/// attribute, or a `FileError` of a trajectory.
[[nodiscard]] CompiledSurvey compile_survey(const SurveySettings& survey, const GroundHeight& ground,
                                            const SurveyBuildOptions& options = {});

}  // namespace PULSECAST_NAMESPACE::helios

#if PULSECAST_DEFINITIONS
#include <pulsecast/helios/detail/survey_compiler.hpp>
#endif

#endif
