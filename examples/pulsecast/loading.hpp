// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/helios/settings.hpp>
#include <pulsecast/helios/simulation.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scene/part.hpp>
#include <pulsecast/shape/raster.hpp>

#include "options.hpp"

class SceneSharing;
class SurveyInputs;

/// Settings of a simulation and of its scene store.
struct Loading {
  pulsecast::helios::Simulation::Settings settings{};
  std::string scene_text{};  ///< text of all settings of the scene
  SceneStore store{};
  std::shared_ptr<SurveyInputs> inputs{};  ///< default: found from the survey
  SceneSharing* sharing = nullptr;         ///< for a scene shared with other processes
};

/// `helios::make_simulation`, compiled once because it is heavy.
std::unique_ptr<pulsecast::helios::Simulation> load(const pulsecast::helios::SurveySettings& survey,
                                                    const pulsecast::helios::Simulation::Settings& settings);

/// Overload with a scene kept between runs and shared by processes. Adds notes on that to `notes`, which must outlive
/// the simulation.
std::unique_ptr<pulsecast::helios::Simulation> load(const pulsecast::helios::SurveySettings& survey,
                                                    const Loading& loading, std::vector<std::string>& notes);

/// Calls `use` with each raster of heights in a scene, and its placement.
void for_each_raster(const pulsecast::helios::SurveySettings& survey,
                     const std::function<void(const pulsecast::Raster&, const pulsecast::Placement&)>& use);

/// Explains a complete run without points, of pulse slots from `first` on: mostly, scene and legs have coordinates of
/// different origin. Empty for any other.
std::string why_no_points(const pulsecast::helios::Simulation& simulation, const pulsecast::RunSummary& run,
                          pulsecast::PulseIndex first);
