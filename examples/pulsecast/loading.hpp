// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <pulsecast/helios/settings.hpp>
#include <pulsecast/helios/simulation.hpp>

#include "options.hpp"

class SceneSharing;
class SurveyInputs;

/// Settings of a simulation, and of what keeps its scene.
struct Loading {
  pulsecast::helios::Simulation::Settings settings{};
  std::string scene_text{};  ///< says all settings of the scene
  SceneStore store{};
  std::shared_ptr<SurveyInputs> inputs{};  ///< found unless given
  SceneSharing* sharing = nullptr;         ///< if the scene is to be that of other processes, too
};

/// `helios::make_simulation`, which is heavy, compiled once.
std::unique_ptr<pulsecast::helios::Simulation> load(const pulsecast::helios::SurveySettings& survey,
                                                    const pulsecast::helios::Simulation::Settings& settings);

/// The same, with a scene that is kept from run to run and shared by processes. Notes on that, for those who want to know more, are added
/// to `notes`, which must outlive the simulation.
std::unique_ptr<pulsecast::helios::Simulation> load(const pulsecast::helios::SurveySettings& survey, const Loading& how,
                                                    std::vector<std::string>& notes);
