// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "simulation.hpp"

#include <algorithm>
#include <iomanip>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>
#include <variant>

#include <pulsecast/adapters/scene_builder.hpp>
#include <pulsecast/adapters/scene_files.hpp>
#include <pulsecast/adapters/survey_receivers.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>

#include "scene_store.hpp"

using namespace pulsecast;
using adapters::SurveyScene;
using adapters::SurveySettings;

namespace {

template <class Width>
using Pipeline = adapters::SurveyByChannel<SurveyScene, FullWaveform<Width>>;

adapters::SpectralLibrary spectra_of(const SurveySettings& survey, const std::vector<std::filesystem::path>& assets) {
  adapters::SpectralLibrary all;
  for (const std::filesystem::path& folder : assets) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder / "spectra", error)) continue;
    adapters::SpectralLibrary here = adapters::read_spectral_library(folder / "spectra");
    all.spectra.merge(here.spectra);
  }
  for (const auto& channel : survey.scanner.channels) all.wavelengths.push_back(channel.wavelength);
  return all;
}

double first_rate(const SurveySettings& survey) {
  for (const auto& leg : survey.legs)
    if (leg.scanner.pulse_rate > 0) return leg.scanner.pulse_rate;
  return survey.scanner.pulse_rates.empty() ? 100e3 : survey.scanner.pulse_rates.front();
}

bool is_random(const adapters::PartSource& source) {
  return std::visit(
      [](const auto& s) {
        bool random = false;
        if constexpr (requires { s.material; }) random = s.material.random > 0;
        if constexpr (requires { s.random_shift; }) random = random || s.random_shift;
        return random;
      },
      source);
}

/// All that a scene depends on in a run.
SceneInputs inputs_of(const SurveySettings& survey, const Simulation::Settings& how, int run) {
  SceneInputs inputs{.files = adapters::scene_files(survey.scene), .name = survey.scene.id};
  for (const std::filesystem::path& folder : how.assets) {
    std::error_code error;
    if (std::filesystem::is_directory(folder / "spectra", error)) inputs.more.push_back(folder / "spectra");
  }
  bool random = false, moves = false;
  for (const adapters::PartSettings& part : survey.scene.parts) {
    random = random || is_random(part.source), moves = moves || !part.motions.empty();
    for (const adapters::SwapSettings& swap : part.swaps) random = random || (swap.source && is_random(*swap.source));
  }
  std::ostringstream all;
  all << std::setprecision(17) << how.scene_text << "\nrun " << run << " fixed_incidence " << how.fixed_incidence;
  if (random) all << " seed " << how.seed;
  if (moves) all << " rate " << first_rate(survey);
  for (const auto& channel : survey.scanner.channels) all << ' ' << channel.wavelength;
  inputs.settings = all.str();
  return inputs;
}

}  // namespace

struct Simulation::Inside {
  SurveySettings survey;
  Settings settings;
  adapters::SceneBuilder builder;
  std::optional<adapters::SurveyPlan> plan;
  std::optional<SurveyScene> scene;
  std::variant<std::monostate, Pipeline<NoWidth>, Pipeline<GaussianFit>> pipeline;
  std::vector<std::string> scene_warnings, warnings, notes;

  Inside(const SurveySettings& s, const Settings& how)
      : survey(s),
        settings(how),
        builder(s.scene, {.spectra = spectra_of(s, how.assets),
                          .pulse_rate = first_rate(s),
                          .seed = how.seed,
                          .fixed_incidence = how.fixed_incidence,
                          .threads = how.threads}) {}

  /// Batches hold waveforms of one kind of bins, so all channels are sampled as the finest of them is.
  [[nodiscard]] adapters::ScannerSettings sampled_alike(std::vector<std::string>& told) const {
    adapters::ScannerSettings scanner = survey.scanner;
    double finest = scanner.channels.front().waveform.bin_size, coarsest = finest;
    for (const auto& c : scanner.channels)
      finest = std::min(finest, c.waveform.bin_size), coarsest = std::max(coarsest, c.waveform.bin_size);
    for (auto& c : scanner.channels) c.waveform.bin_size = finest;
    if (coarsest > finest)
      told.push_back("scanner '" + scanner.id + "': its channels have bins of different size; all are sampled by the smallest");
    return scanner;
  }

  template <class Width>
  void make(std::uint64_t seed) {
    const Vec3 size = scene->bounds().empty() ? Vec3{} : scene->bounds().size();
    const adapters::ScannerSettings scanner = sampled_alike(warnings);
    const auto receiver = [&](const adapters::ChannelSettings& channel) -> adapters::ChannelReceiver<FullWaveform<Width>> {
      const double longest = std::min(2 * length(size) / speed_of_light + 20 * channel.pulse_length, 4e-6);
      ReceiverNoise noise;
      if (settings.waveform_noise) noise.deviation = 0.25 * channel.received_power_min;
      return {RingFootprint(static_cast<std::size_t>(std::max(1, channel.waveform.rings))), adapters::survey_receiver(channel),
              FullWaveform<Width>(adapters::survey_waveform(channel, settings.waveforms ? longest : 0), {}, noise)};
    };
    pipeline.emplace<Pipeline<Width>>(adapters::survey_by_channel(scanner, plan->source, *scene, seed, receiver));
  }

  std::vector<adapters::SurveyPart> parts(int run) {
    const auto build = [&] { return BuiltParts{builder.parts(run), builder.warnings()}; };
    BuiltParts built = stored_parts(settings.store, inputs_of(survey, settings, run), build, notes);
    for (std::string& warning : built.warnings)
      if (std::find(scene_warnings.begin(), scene_warnings.end(), warning) == scene_warnings.end())
        scene_warnings.push_back(std::move(warning));
    return std::move(built.parts);
  }

  void begin(int run) {
    const std::vector<adapters::SurveyPart> all = parts(run);
    scene.emplace(all, TimeWindows{.to = 1});
    const auto ground = [&](const Vec2& at) { return scene->ground_height(at); };
    const adapters::SurveyBuildOptions options{settings.seed, settings.platform_noise, settings.leg_noise};
    plan.emplace(adapters::plan_survey(survey, ground, options));
    const double duration = plan->source.duration().seconds();
    const bool moves = std::any_of(all.begin(), all.end(), [](const auto& p) { return p.motion != nullptr; });
    if (moves) scene.emplace(all, TimeWindows{.to = std::max(1e-3, duration)});

    const std::uint64_t seed = settings.seed + static_cast<std::uint64_t>(run) * 0x9e3779b97f4a7c15U;
    warnings = scene_warnings;
    warnings.insert(warnings.end(), plan->warnings.begin(), plan->warnings.end());
    settings.echo_width ? make<GaussianFit>(seed) : make<NoWidth>(seed);
  }
};

Simulation::Simulation(const SurveySettings& survey, const Settings& settings) : inside_(std::make_unique<Inside>(survey, settings)) {
  begin(0);
}
Simulation::~Simulation() = default;

int Simulation::runs() const { return inside_->builder.runs(); }
void Simulation::begin(int run) { inside_->begin(run); }
const adapters::SurveyPlan& Simulation::plan() const { return *inside_->plan; }
const std::vector<std::string>& Simulation::warnings() const { return inside_->warnings; }
const std::vector<std::string>& Simulation::notes() const { return inside_->notes; }

Simulation::Scene Simulation::scene() const {
  const SurveyScene& s = *inside_->scene;
  Scene out{.least = s.bounds().min, .most = s.bounds().max, .parts = s.parts().size(), .memory = s.memory(), .empty = s.bounds().empty()};
  for (const auto& part : s.parts()) {
    out.moving += part.motion ? 1 : 0;
    if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh<>>>(&part.geometry)) out.triangles += (*mesh)->size();
  }
  return out;
}

RunSummary Simulation::run(const RunOptions& options, const std::function<void(const EchoBatch&)>& sink) const {
  return std::visit(
      [&](const auto& survey) -> RunSummary {
        if constexpr (std::is_same_v<std::decay_t<decltype(survey)>, std::monostate>)
          return {};
        else
          return pulsecast::run(survey, options, sink);
      },
      inside_->pipeline);
}

void check_without_scene(const SurveySettings& survey) {
  const auto ground = [](const Vec2&) -> std::optional<double> { return 0; };
  (void)adapters::plan_survey(survey, ground);
  for (const auto& channel : survey.scanner.channels) {
    adapters::survey_receiver(channel).validate();
    adapters::survey_waveform(channel).validate();
    (void)RingFootprint(static_cast<std::size_t>(std::max(1, channel.waveform.rings)));
  }
}
