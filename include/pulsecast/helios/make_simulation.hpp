// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_MAKE_SIMULATION_HPP
#define PULSECAST_HELIOS_MAKE_SIMULATION_HPP

#include <pulsecast/helios/simulation.hpp>

/// Loading of surveys: slow to compile, unless `pulsecast::compiled` is linked. Include it once.
namespace PULSECAST_NAMESPACE::helios {

struct BuiltParts;
struct SurveySettings;

/// Gives the parts of a repetition's scene: the result of `build`, or an equal earlier one.
using PartProvider = std::function<BuiltParts(int repetition, const std::function<BuiltParts()>& build)>;

/// Loads the scene and plans the legs of repetition 0. @throws SettingError with leg or part and attribute, FileError
[[nodiscard]] std::unique_ptr<Simulation> make_simulation(const SurveySettings& survey,
                                                          const Simulation::Settings& settings = {},
                                                          const PartProvider& provider = {});

}  // namespace PULSECAST_NAMESPACE::helios

#if PULSECAST_DEFINES(HELIOS_MAKE_SIMULATION)
#include <pulsecast/helios/detail/loaded_simulation.hpp>
#endif

#endif
