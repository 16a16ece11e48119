// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "simulation.hpp"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>
#include <variant>

#include <pulsecast/adapters/scene_builder.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>
#include <pulsecast/survey.hpp>

using namespace pulsecast;
using adapters::SurveyLeg;
using adapters::SurveyScene;
using adapters::SurveySettings;

namespace {

template <class Width>
using Pipeline = Survey<Legs<SurveyLeg>, RingFootprint, SurveyScene, FullWaveform<Width>>;

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

bool same_receiver(const adapters::ChannelSettings& a, const adapters::ChannelSettings& b) {
  return a.receiver_diameter == b.receiver_diameter && a.efficiency == b.efficiency && a.visibility == b.visibility &&
         a.accuracy == b.accuracy && a.range_min == b.range_min && a.range_max == b.range_max && a.returns_max == b.returns_max &&
         a.received_power_min == b.received_power_min && a.waveform == b.waveform;
}

}  // namespace

struct Simulation::Inside {
  SurveySettings survey;
  Settings settings;
  adapters::SceneBuilder builder;
  std::optional<adapters::SurveyPlan> plan;
  std::optional<SurveyScene> scene;
  std::variant<std::monostate, Pipeline<NoWidth>, Pipeline<GaussianFit>> pipeline;
  std::vector<std::string> warnings;

  Inside(const SurveySettings& s, const Settings& how)
      : survey(s),
        settings(how),
        builder(
            s.scene,
            {.spectra = spectra_of(s, how.assets), .pulse_rate = first_rate(s), .seed = how.seed, .fixed_incidence = how.fixed_incidence}) {
  }

  template <class Width>
  void make(const WaveformSettings& waveform, const ReceiverNoise& noise, std::uint64_t seed) {
    const adapters::ChannelSettings& channel = survey.scanner.channels.front();
    pipeline.emplace<Pipeline<Width>>(plan->source, RingFootprint(static_cast<std::size_t>(std::max(1, channel.waveform.rings))), *scene,
                                      adapters::survey_receiver(channel), FullWaveform<Width>(waveform, {}, noise), seed);
  }

  void begin(int run) {
    const std::vector<adapters::SurveyPart> parts = builder.parts(run);
    scene.emplace(parts, TimeWindows{.to = 1});
    const auto ground = [&](const Vec2& at) { return scene->ground_height(at); };
    const adapters::SurveyBuildOptions options{settings.seed, settings.platform_noise, settings.leg_noise};
    plan.emplace(adapters::plan_survey(survey, ground, options));
    const double duration = plan->source.duration().seconds();
    const bool moves = std::any_of(parts.begin(), parts.end(), [](const auto& p) { return p.motion != nullptr; });
    if (moves) scene.emplace(parts, TimeWindows{.to = std::max(1e-3, duration)});

    const adapters::ChannelSettings& channel = survey.scanner.channels.front();
    const Vec3 size = scene->bounds().empty() ? Vec3{} : scene->bounds().size();
    const double longest = std::min(2 * length(size) / speed_of_light + 20 * channel.pulse_length, 4e-6);
    const WaveformSettings waveform = adapters::survey_waveform(channel, settings.waveforms ? longest : 0);
    ReceiverNoise noise;
    if (settings.waveform_noise) noise.deviation = 0.25 * channel.received_power_min;
    const std::uint64_t seed = settings.seed + static_cast<std::uint64_t>(run) * 0x9e3779b97f4a7c15U;
    settings.echo_width ? make<GaussianFit>(waveform, noise, seed) : make<NoWidth>(waveform, noise, seed);

    warnings = builder.warnings();
    warnings.insert(warnings.end(), plan->warnings.begin(), plan->warnings.end());
    for (const auto& other : survey.scanner.channels)
      if (!same_receiver(other, channel)) {
        warnings.push_back("scanner '" + survey.scanner.id +
                           "': its channels have different receivers; all are taken to have that of the first");
        break;
      }
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
