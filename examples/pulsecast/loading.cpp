// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "loading.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <sstream>
#include <variant>

#include <pulsecast/helios/make_simulation.hpp>
#include <pulsecast/helios/scene.hpp>
#include <pulsecast/helios/survey.hpp>

#include "foreign_meshes.hpp"
#include "scene_store.hpp"
#include "survey_inputs.hpp"

using namespace pulsecast;
using helios::Simulation;
using helios::SurveySettings;

namespace {

bool is_random(const helios::PartSource& source) {
  return std::visit(
      [](const auto& s) {
        bool random = false;
        if constexpr (requires { s.material; }) random = s.material.random > 0;
        if constexpr (requires { s.random_shift; }) random = random || s.random_shift;
        return random;
      },
      source);
}

/// Inputs of a scene in a run.
SceneInputs inputs_of(const SurveySettings& survey, const Loading& loading, int run) {
  SceneInputs inputs{.files = loading.inputs->scene(), .more = loading.inputs->spectra(), .name = survey.scene.id};
  inputs.content = [&all = *loading.inputs](const std::filesystem::path& path) { return all.fingerprint(path); };
  bool random = false, moves = false;
  for (const helios::PartSettings& part : survey.scene.parts) {
    random = random || is_random(part.source);
    moves = moves || !part.motions.empty();
    for (const helios::SwapSettings& swap : part.swaps) random = random || (swap.source && is_random(*swap.source));
  }
  std::ostringstream all;
  all << std::setprecision(17) << loading.scene_text << "\nrun " << run << " fixed_incidence "
      << loading.settings.fixed_incidence << " library_physics " << loading.settings.library_physics;
  if (random) all << " seed " << loading.settings.seed;
  if (moves) all << " rate " << helios::first_pulse_rate(survey);
  for (const auto& channel : survey.scanner.channels) all << ' ' << channel.wavelength;
  inputs.settings = all.str();
  return inputs;
}

}  // namespace

std::unique_ptr<Simulation> load(const SurveySettings& survey, const Simulation::Settings& settings) {
  Simulation::Settings all = settings;
  all.city_models = city_models();
  return helios::make_simulation(survey, all);
}

std::unique_ptr<Simulation> load(const SurveySettings& survey, const Loading& loading,
                                 std::vector<std::string>& notes) {
  Loading complete = loading;
  complete.settings.city_models = city_models();
  if (!complete.inputs) complete.inputs = std::make_shared<SurveyInputs>(survey, loading.settings.assets);
  const auto parts = [survey, complete, &notes](int run, const std::function<helios::BuiltParts()>& build) {
    const SceneInputs inputs = inputs_of(survey, complete, run);
    KeptParts kept = complete.sharing ? shared_parts(*complete.sharing, complete.store, inputs, build, notes)
                                      : stored_parts(complete.store, inputs, build, notes);
    complete.inputs->add(kept.built.files);
    return std::move(kept.built);
  };
  return helios::make_simulation(survey, complete.settings, parts);
}

void for_each_raster(const SurveySettings& survey, const std::function<void(const Raster&, const Placement&)>& use) {
  for (const auto& [raster, placement] : helios::SceneBuilder(survey.scene, {}).rasters()) use(raster, placement);
}

std::string why_no_points(const Simulation& simulation, const RunSummary& run, PulseIndex first) {
  if (!run.complete || run.echoes > 0 || run.pulses() == 0) return {};
  const Simulation::Scene scene = simulation.scene();
  const helios::CompiledSurvey& compiled = simulation.compiled();
  const auto leg = std::ranges::find_if(compiled.legs, [&](const auto& l) { return l.end > l.first && l.end > first; });
  if (scene.empty || leg == compiled.legs.end()) return "no points: the scene is empty, or no leg has pulses";
  std::ostringstream text;
  const auto put = [&](const char* words, const Vec3& v) {
    text << words << '(' << v.x << ", " << v.y << ", " << v.z << ')';
  };
  text << std::fixed << std::setprecision(1) << "no points: leg " << leg->number;
  put(" begins at ", compiled.source.legs()[leg->number].path().at({}).position);
  put(" m, and the scene extends from ", scene.min);
  put(" to ", scene.max);
  return text.str() + " m";
}
