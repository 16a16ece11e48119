// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include "simulation.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <memory>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>
#include <variant>

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>
#include <pulsecast/helios/detail/receivers.hpp>
#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/scene.hpp>
#include <pulsecast/io/las_packets.hpp>

#include "scene_store.hpp"
#include "survey_inputs.hpp"

using namespace pulsecast;
using helios::SurveyScene;
using helios::SurveySettings;

namespace {

io::SpectralLibrary spectra_of(const SurveySettings& survey, const std::vector<std::filesystem::path>& folders) {
  io::SpectralLibrary all;
  for (const std::filesystem::path& folder : folders) {
    try {
      io::SpectralLibrary here = io::read_spectral_library(folder);
      all.spectra.merge(here.spectra);
      all.warnings.insert(all.warnings.end(), here.warnings.begin(), here.warnings.end());
    } catch (const FileError& unreadable) {  // nobody may need it
      all.warnings.emplace_back(unreadable.what());
    }
  }
  for (const auto& channel : survey.scanner.channels) all.wavelengths.push_back(channel.wavelength);
  return all;
}

double first_rate(const SurveySettings& survey) {
  for (const auto& leg : survey.legs)
    if (leg.scanner.pulse_rate > 0) return leg.scanner.pulse_rate;
  return survey.scanner.pulse_rates.empty() ? 100e3 : survey.scanner.pulse_rates.front();
}

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

/// A survey of any kind of receiver, so that what runs and samples it is compiled once, and the pipeline of each kind in one place.
class AnySurvey {
 public:
  struct Scratch {
    virtual ~Scratch() = default;
  };
  using Workspace = std::unique_ptr<Scratch>;

  AnySurvey() = default;
  AnySurvey(const AnySurvey&) = delete;
  AnySurvey& operator=(const AnySurvey&) = delete;
  virtual ~AnySurvey() = default;
  [[nodiscard]] virtual Workspace workspace() const = 0;
  [[nodiscard]] virtual PulseIndex size() const noexcept = 0;
  [[nodiscard]] virtual std::size_t subrays() const noexcept = 0;
  [[nodiscard]] virtual std::size_t recorded_subrays() const noexcept = 0;
  [[nodiscard]] virtual double sample_interval() const noexcept = 0;
  [[nodiscard]] virtual Outcome operator()(PulseIndex i, Workspace& w) const noexcept = 0;
};

template <class Survey>
class SurveyOf final : public AnySurvey {
 public:
  explicit SurveyOf(Survey survey) : survey_(std::move(survey)) {}
  [[nodiscard]] Workspace workspace() const override { return std::make_unique<Own>(survey_.workspace()); }
  [[nodiscard]] PulseIndex size() const noexcept override { return survey_.size(); }
  [[nodiscard]] std::size_t subrays() const noexcept override { return survey_.subrays(); }
  [[nodiscard]] std::size_t recorded_subrays() const noexcept override { return survey_.recorded_subrays(); }
  [[nodiscard]] double sample_interval() const noexcept override { return survey_.sample_interval(); }
  [[nodiscard]] Outcome operator()(PulseIndex i, Workspace& w) const noexcept override { return survey_(i, static_cast<Own&>(*w).own); }

 private:
  struct Own : Scratch {
    explicit Own(typename Survey::Workspace w) : own(std::move(w)) {}
    typename Survey::Workspace own;
  };
  Survey survey_;
};

/// What this thread has had of a processor [s].
double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// All that a scene depends on in a run.
SceneInputs inputs_of(const SurveySettings& survey, const Simulation::Settings& how, int run) {
  SceneInputs inputs{.files = how.inputs->scene(), .more = how.inputs->spectra(), .name = survey.scene.id};
  inputs.content = [&all = *how.inputs](const std::filesystem::path& path) { return all.fingerprint(path); };
  bool random = false, moves = false;
  for (const helios::PartSettings& part : survey.scene.parts) {
    random = random || is_random(part.source), moves = moves || !part.motions.empty();
    for (const helios::SwapSettings& swap : part.swaps) random = random || (swap.source && is_random(*swap.source));
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
  helios::SceneBuilder builder;
  std::optional<helios::CompiledSurvey> compiled;
  std::optional<SurveyScene> scene;
  std::unique_ptr<const AnySurvey> pipeline;
  std::vector<helios::SurveyPart> meshes;  // beside the survey's own parts
  std::uint64_t seed = 0;                  // of this repetition
  std::vector<std::string> scene_warnings, warnings, notes;

  Inside(const SurveySettings& s, const Settings& how)
      : survey(s),
        settings(with_inputs(s, how)),
        builder(s.scene, {.spectra = spectra_of(s, settings.inputs->spectra()),
                          .pulse_rate = first_rate(s),
                          .seed = how.seed,
                          .fixed_incidence = how.fixed_incidence,
                          .threads = how.threads}) {
    for (const Mesh& mesh : how.meshes)
      meshes.push_back({.geometry = std::make_shared<const TriangleMesh<>>(mesh.data, how.threads),
                        .materials = material_table({mesh.material}),
                        .object = mesh.object});
  }

  [[nodiscard]] static Settings with_inputs(const SurveySettings& survey, Settings how) {
    if (!how.inputs) how.inputs = std::make_shared<SurveyInputs>(survey, how.assets);
    return how;
  }

  /// Batches hold waveforms of one kind of bins, so all channels are sampled as the finest of them is.
  [[nodiscard]] helios::ScannerSettings sampled_alike(helios::ScannerSettings scanner, std::vector<std::string>& told) const {
    double finest = scanner.channels.front().waveform.bin_size, coarsest = finest;
    for (const auto& c : scanner.channels)
      finest = std::min(finest, c.waveform.bin_size), coarsest = std::max(coarsest, c.waveform.bin_size);
    if (coarsest > finest)
      told.push_back("scanner '" + scanner.id + "': its channels have bins of different size; all are sampled by the smallest");
    if (settings.las_waveforms) finest = las_bins(finest, told);
    for (auto& c : scanner.channels) c.waveform.bin_size = finest;
    return scanner;
  }

  [[nodiscard]] std::string survey_name() const { return settings.place.empty() ? "survey '" + survey.name + "'" : settings.place; }

  /// LAS counts the time from sample to sample in picoseconds. Source: LAS 1.4 R15, Waveform Packet Descriptor.
  [[nodiscard]] double las_bins(double bin, std::vector<std::string>& told) const {
    constexpr double rounding = 1e-6;  // [ps]
    const double picoseconds = bin * 1e12, nearest = std::nearbyint(picoseconds);
    if (std::fabs(picoseconds - nearest) <= rounding) return bin;
    const double whole = std::max(1.0, std::floor(picoseconds));
    told.push_back(survey_name() + ": binSize_ns is " + helios::xml_number(helios::units::nanosecond.number(bin)) +
                   ", and samples in LAS are whole picoseconds apart: it is taken as " + helios::xml_number(whole / 1e3));
    return whole / 1e12;
  }

  /// Cuts waveforms that are too long for where they go.
  void limit_record(WaveformSettings& s) {
    const double most = settings.las_waveforms ? io::LasPackets::max_samples : WaveformSettings::max_kept;
    const double longest = (most - 0.5) * s.sample_interval;  // half a sample for rounding
    if (s.record_length <= longest) return;
    s.record_length = longest;
    tell(survey_name() + ": waveforms are cut after " + helios::xml_number(std::round(longest * 1e12) / 1e3) + " ns, " +
         helios::xml_number(most) + " samples, which is all that " + (settings.las_waveforms ? "LAS" : "is kept") +
         (settings.las_waveforms ? " takes" : "") + "; longer bins reach farther");
  }

  void tell(std::string text) {
    if (std::find(warnings.begin(), warnings.end(), text) == warnings.end()) warnings.push_back(std::move(text));
  }

  [[nodiscard]] helios::ScannerSettings scanner_of(const Receiving& how) const {
    helios::ScannerSettings scanner = survey.scanner;
    for (helios::ChannelSettings& channel : scanner.channels) {
      channel.waveform.rings = how.rings.value_or(channel.waveform.rings);
      channel.waveform.bin_size = how.bin_size.value_or(channel.waveform.bin_size);
      if (how.ideal) channel.accuracy = 0, channel.errors.range_noise.clear();
    }
    return scanner;
  }

  void receive(const Receiving& how) {
    std::vector<std::string> told;
    const helios::ScannerSettings scanner = sampled_alike(scanner_of(how), told);
    for (std::string& text : told) tell(std::move(text));
    settings.echo_width && !how.ideal ? make<GaussianFit>(scanner, how.ideal) : make<NoWidth>(scanner, how.ideal);
  }

  template <class Width>
  void make(const helios::ScannerSettings& scanner, bool ideal) {
    const Vec3 size = scene->bounds().empty() ? Vec3{} : scene->bounds().size();
    const bool waveforms = settings.waveforms && !ideal, noisy = settings.waveform_noise && !ideal;
    const auto receiver = [&](const helios::ChannelSettings& channel) -> helios::ChannelReceiver<FullWaveform<Width>> {
      const double longest = std::min(2 * length(size) / speed_of_light + 20 * channel.pulse_length, 4e-6);
      WaveformSettings waveform = helios::survey_waveform(channel, waveforms ? longest : 0);
      limit_record(waveform);
      ReceiverNoise noise;
      if (noisy) noise.deviation = 0.25 * channel.received_power_min;
      return {RingFootprint(static_cast<std::size_t>(std::max(1, channel.waveform.rings))), helios::survey_receiver(channel),
              FullWaveform<Width>(waveform, {}, noise)};
    };
    using Pipeline = helios::SurveyByChannel<SurveyScene, FullWaveform<Width>>;
    pipeline = std::make_unique<SurveyOf<Pipeline>>(helios::survey_by_channel(scanner, compiled->source, *scene, seed, receiver));
  }

  std::vector<helios::SurveyPart> parts(int run) {
    const auto build = [&] { return BuiltParts{builder.parts(run), builder.warnings(), {}, {}}; };
    const SceneInputs inputs = inputs_of(survey, settings, run);
    BuiltParts built = settings.sharing ? shared_parts(*settings.sharing, settings.store, inputs, build, notes)
                                        : stored_parts(settings.store, inputs, build, notes);
    for (std::string& warning : built.warnings)
      if (std::find(scene_warnings.begin(), scene_warnings.end(), warning) == scene_warnings.end())
        scene_warnings.push_back(std::move(warning));
    return std::move(built.parts);
  }

  void begin(int run) {
    std::vector<helios::SurveyPart> all = parts(run);
    all.insert(all.end(), meshes.begin(), meshes.end());
    scene.emplace(all, MovingIndexSettings{.to = 1});
    const auto ground = [&](const Vec2& at) { return scene->ground_height(at); };
    const helios::SurveyBuildOptions options{settings.seed, settings.platform_noise, settings.leg_noise, settings.leg_places};
    compiled.emplace(helios::compile_survey(survey, ground, options));
    const double duration = compiled->source.duration().seconds();
    const bool moves = std::any_of(all.begin(), all.end(), [](const auto& p) { return p.motion != nullptr; });
    if (moves) scene.emplace(all, MovingIndexSettings{.to = std::max(1e-3, duration)});

    seed = settings.seed + static_cast<std::uint64_t>(run) * 0x9e3779b97f4a7c15U;
    warnings = scene_warnings;
    warnings.insert(warnings.end(), compiled->warnings.begin(), compiled->warnings.end());
    receive({});
  }
};

Simulation::Simulation(const SurveySettings& survey, const Settings& settings) : inside_(std::make_unique<Inside>(survey, settings)) {
  begin(0);
}
Simulation::~Simulation() = default;

int Simulation::runs() const { return inside_->builder.runs(); }
void Simulation::begin(int run) { inside_->begin(run); }
const helios::CompiledSurvey& Simulation::compiled() const { return *inside_->compiled; }
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
  return pulsecast::run(*inside_->pipeline, options, sink);
}

void Simulation::receive(const Receiving& how) { inside_->receive(how); }

std::vector<Sample> Simulation::sample(std::span<const SampleBlock> blocks, unsigned threads) const {
  constexpr std::size_t at_once = 8;
  const AnySurvey& survey = *inside_->pipeline;
  std::vector<Sample> all(blocks.size());
  for_each_index((blocks.size() + at_once - 1) / at_once, threads, [&](std::size_t task) {
    AnySurvey::Workspace workspace = survey.workspace();
    ResultBuffer room;  // used again and again, as those of a run are
    for (std::size_t k = task * at_once; k < std::min((task + 1) * at_once, blocks.size()); ++k) {
      const SampleBlock& block = blocks[k];
      Sample& sample = all[k];
      room.clear();
      for (PulseIndex i = block.first; i < block.from; ++i) room.append(survey(i, workspace));
      room.clear();
      const double start = processor_seconds();
      for (PulseIndex i = block.from; i < block.end; ++i) room.append(survey(i, workspace));
      sample.seconds = processor_seconds() - start;
      sample.sample_interval = survey.sample_interval();
      static_cast<ResultBuffer&>(sample) = room;
    }
  });
  return all;
}

std::vector<SlotCount> Simulation::count(std::span<const PulseIndex> slots, unsigned threads) const {
  constexpr std::size_t at_once = 1024;
  const AnySurvey& survey = *inside_->pipeline;
  std::vector<SlotCount> all(slots.size());
  for_each_index((slots.size() + at_once - 1) / at_once, threads, [&](std::size_t k) {
    AnySurvey::Workspace workspace = survey.workspace();
    for (std::size_t i = k * at_once; i < std::min((k + 1) * at_once, slots.size()); ++i) {
      const Outcome outcome = survey(slots[i], workspace);
      all[i] = {outcome.shot.fate, static_cast<std::uint8_t>(outcome.echoes.size())};
    }
  });
  return all;
}

std::vector<std::string> check_without_scene(const SurveySettings& survey, const std::vector<std::string>& leg_places) {
  const auto ground = [](const Vec2&) -> std::optional<double> { return 0; };
  std::vector<std::string> warnings = helios::compile_survey(survey, ground, {.leg_places = leg_places}).warnings;
  for (const auto& channel : survey.scanner.channels) {
    helios::survey_receiver(channel).validate();
    helios::survey_waveform(channel).validate();
    (void)RingFootprint(static_cast<std::size_t>(std::max(1, channel.waveform.rings)));
  }
  return warnings;
}
