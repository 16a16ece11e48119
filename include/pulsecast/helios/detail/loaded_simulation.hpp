// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_LOADED_SIMULATION_HPP
#define PULSECAST_HELIOS_DETAIL_LOADED_SIMULATION_HPP

#include <pulsecast/helios/detail/adjustable.hpp>
#include <pulsecast/helios/detail/scene_files.hpp>
#include <pulsecast/helios/detail/survey_pipeline.hpp>
#include <pulsecast/helios/make_simulation.hpp>
#include <pulsecast/helios/scene.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/io/las.hpp>
#include <pulsecast/uncertainty.hpp>

namespace PULSECAST_NAMESPACE::helios {

namespace detail {

/// Spectra in folders, for the wavelengths of the channels. An unreadable folder gives a warning.
[[nodiscard]] inline io::SpectralLibrary spectra_of(const SurveySettings& survey,
                                                    const std::vector<std::filesystem::path>& folders) {
  io::SpectralLibrary all;
  for (const std::filesystem::path& folder : folders) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored)) continue;
    try {
      io::SpectralLibrary here = io::read_spectral_library(folder);
      all.spectra.merge(here.spectra);
      all.warnings.insert(all.warnings.end(), here.warnings.begin(), here.warnings.end());
    } catch (const FileError& unreadable) {
      all.warnings.emplace_back(unreadable.what());
    }
  }
  for (const ChannelSettings& channel : survey.scanner.channels) all.wavelengths.push_back(channel.wavelength);
  return all;
}

/// Waveform settings within the limits of batches and files, with a warning for each change.
class WaveformLimits {
 public:
  WaveformLimits(const SurveySettings& survey, const Simulation::Settings& settings)
      : name_(settings.place.empty() ? "survey '" + survey.name + "'" : settings.place), las_(settings.las_waveforms) {}

  /// Scanner with the smallest bin size in all channels, as a batch has one sample interval.
  [[nodiscard]] ScannerSettings sampled_alike(ScannerSettings scanner, std::vector<std::string>& warnings) const {
    double finest = finest_bin(scanner);
    if (std::ranges::any_of(scanner.channels, [&](const auto& c) { return c.waveform.bin_size > finest; }))
      warnings.push_back("scanner '" + scanner.id +
                         "': its channels have bins of different size; all are sampled by the smallest");
    if (las_) finest = las_bins(finest, warnings);
    for (ChannelSettings& c : scanner.channels) c.waveform.bin_size = finest;
    return scanner;
  }

  /// Cuts waveforms to the longest that LAS or a batch takes.
  void limit_record(WaveformSettings& s, std::vector<std::string>& warnings) const {
    const double most = las_ ? io::LasPackets::max_samples : WaveformSettings::max_kept;
    const double longest = (most - 0.5) * s.sample_interval;  // margin for rounding: half a sample
    if (s.record_length <= longest) return;
    s.record_length = longest;
    warnings.push_back(name_ + ": waveforms are cut after " + xml_number(std::round(longest * 1e12) / 1e3) + " ns, " +
                       xml_number(most) + " samples, the maximum " + (las_ ? "of LAS" : "kept") +
                       "; longer bins reach farther");
  }

 private:
  /// Bin size for LAS, in whole picoseconds [s]. Source: LAS 1.4 R15, Waveform Packet Descriptor.
  [[nodiscard]] double las_bins(double bin, std::vector<std::string>& warnings) const {
    constexpr double rounding = 1e-6;  // [ps]
    const double picoseconds = bin * 1e12;
    if (std::fabs(picoseconds - std::nearbyint(picoseconds)) <= rounding) return bin;
    const double whole = std::max(1.0, std::floor(picoseconds));
    warnings.push_back(name_ + ": binSize_ns is " + xml_number(units::nanosecond.number(bin)) +
                       ", and samples in LAS are whole picoseconds apart: it is taken as " + xml_number(whole / 1e3));
    return whole / 1e12;
  }

  std::string name_;
  bool las_;
};

/// Inputs of a simulation, for all repetitions.
struct SimulationInputs {
  SurveySettings survey;
  Simulation::Settings settings;
  PartProvider provider;
  std::vector<SurveyPart> meshes{};  ///< in addition to the survey's own parts

  SimulationInputs(const SurveySettings& of_survey, const Simulation::Settings& with, const PartProvider& parts)
      : survey(of_survey), settings(with), provider(parts) {
    for (const Simulation::Mesh& mesh : settings.meshes)
      meshes.push_back({.geometry = std::make_shared<const MaskedMesh<>>(mesh.data, settings.threads),
                        .materials = material_table({mesh.material}),
                        .object = mesh.object,
                        .attributes = mesh.attributes});
  }

  [[nodiscard]] SceneBuilder builder() const {
    return {survey.scene,
            {.spectra = spectra_of(survey, spectra_folders(settings.assets)),
             .pulse_rate = first_pulse_rate(survey),
             .seed = settings.seed,
             .fixed_incidence = settings.fixed_incidence,
             .tilted_leaves = settings.library_physics,
             .threads = settings.threads,
             .city_models = settings.city_models}};
  }
};

inline void add_new(std::vector<std::string>& known, const std::vector<std::string>& texts) {
  for (const std::string& text : texts)
    if (std::find(known.begin(), known.end(), text) == known.end()) known.push_back(text);
}

/// Scene and legs of a repetition.
struct LoadedRepetition {
  std::shared_ptr<const SimulationInputs> inputs;
  SceneBuilder builder;  ///< with the files read so far
  std::uint64_t seed;
  std::vector<std::string> warnings{};
  std::shared_ptr<const SurveyScene> scene{};
  std::optional<CompiledSurvey> compiled{};

  LoadedRepetition(std::shared_ptr<const SimulationInputs> all, SceneBuilder with_files, int number)
      : inputs(std::move(all)),
        builder(std::move(with_files)),
        seed(inputs->settings.seed + static_cast<std::uint64_t>(number) * 0x9e3779b97f4a7c15U) {
    const auto build = [&] { return BuiltParts{builder.parts(number), builder.warnings(), builder.files()}; };
    BuiltParts built = inputs->provider ? inputs->provider(number, build) : build();
    std::vector<SurveyPart>& parts = built.parts;
    parts.insert(parts.end(), inputs->meshes.begin(), inputs->meshes.end());
    scene = std::make_shared<const SurveyScene>(parts, MovingIndexSettings{.to = 1});
    const auto ground = [&](const Vec2& at, auto... near) { return scene->ground_height(at, near...); };
    const Simulation::Settings& s = inputs->settings;
    compiled =
        compile_survey(inputs->survey, ground, {s.seed, s.platform_noise, s.leg_noise, s.leg_places, s.projector});
    const double duration = compiled->source.duration().seconds();
    if (std::any_of(parts.begin(), parts.end(), [](const SurveyPart& p) { return p.motion != nullptr; }))
      scene = std::make_shared<const SurveyScene>(parts, MovingIndexSettings{.to = std::max(1e-3, duration)});
    add_new(warnings, built.warnings);
    warnings.insert(warnings.end(), compiled->warnings.begin(), compiled->warnings.end());
    note_distance();
  }

 private:
  /// Notes the first leg that stays farther from the scene than any channel measures.
  void note_distance() {
    double range = 0;
    for (const ChannelSettings& channel : inputs->survey.scanner.channels)
      range = std::max(range, range_of(channel, inputs->settings.library_physics));
    const Box box = scene->bounds();
    for (const CompiledSurvey::Leg& leg : compiled->legs) {
      if (leg.first == leg.end || box.empty()) continue;
      Box way;
      for (int i = 0; i <= 64; ++i)
        way.extend(
            compiled->source.legs()[leg.number].path().at(Tick::of_seconds(leg.duration.seconds() * i / 64)).position);
      const double apart = length(max(max(box.min - way.max, way.min - box.max), Vec3{}));
      if (apart < 1.01 * range) continue;
      const SurveyBuildOptions names{.leg_places = inputs->settings.leg_places};
      return warnings.push_back(text::joined({names.leg_name(leg.number), " is at least ", brief(apart),
                                              " m from the scene, and the scanner measures up to ", brief(range),
                                              " m, by rangeMax_m or the light of a white surface: no points"}));
    }
  }
};

[[nodiscard]] inline ScannerSettings overridden(ScannerSettings scanner, const ReceiverOverrides& overrides) {
  for (ChannelSettings& channel : scanner.channels) {
    channel.waveform.rings = overrides.rings.value_or(channel.waveform.rings);
    channel.waveform.bin_size = overrides.bin_size.value_or(channel.waveform.bin_size);
    if (!overrides.ideal) continue;
    channel.accuracy = 0;
    channel.errors.range_noise.clear();
  }
  return scanner;
}

/// Footprint, receiver and detector of a channel.
template <class Receiver, EchoWidth Width>
[[nodiscard]] ReceiverUnit<SurveyFootprint, SurveyDetector<Receiver>> receiver_unit(const ChannelSettings& channel,
                                                                                    const WaveformSettings& waveform,
                                                                                    bool noisy, bool judged) {
  const auto unit = [&] {
    if constexpr (std::same_as<Receiver, ReceiverNoise>)
      return survey_receiver_unit<Width>(channel, waveform, noisy);
    else
      return library_receiver_unit<Width>(channel, waveform, noisy);
  }();
  return {SurveyFootprint(unit.footprint, judged), unit.receiver, SurveyDetector<Receiver>(unit.detector)};
}

/// Survey, and what makes the uncertainty of its echoes; empty unless asked for.
struct JoinedSurvey {
  AnySurvey survey;
  std::function<UncertaintyQuery()> uncertainty{};
};

/// Survey of scene, legs and receivers. Adds warnings of the receivers.
template <class Receiver>
[[nodiscard]] JoinedSurvey joined(const LoadedRepetition& loaded, const ReceiverOverrides& overrides,
                                  std::vector<std::string>& warnings) {
  const SurveySettings& survey = loaded.inputs->survey;
  const Simulation::Settings& settings = loaded.inputs->settings;
  const WaveformLimits limits(survey, settings);
  const ScannerSettings scanner = limits.sampled_alike(overridden(survey.scanner, overrides), warnings);
  const bool library = settings.library_physics, follows_light = settings.light_paths || survey.scene.follows_light(),
             waveforms = settings.waveforms && !overrides.ideal, noisy = settings.waveform_noise && !overrides.ideal,
             widths = settings.echo_width && !overrides.ideal;
  LightSettings light = survey.scene.light_or_default();
  light.orders = overrides.orders.value_or(light.orders);
  light.paths = overrides.paths.value_or(light.paths);
  const Box bounds = loaded.scene->bounds();
  const double extent = bounds.empty() ? 0 : length(bounds.size());
  auto units = ReceiverGroups(survey.scanner).units(scanner, [&](const ChannelSettings& channel) {
    const double longest = std::min(2 * extent / speed_of_light + 20 * channel.pulse_length, 4e-6);
    WaveformSettings waveform = survey_waveform(channel, waveforms ? longest : 0, library, follows_light);
    if (overrides.true_ranges && !follows_light) waveform.timing = EchoTiming::true_range;
    limits.limit_record(waveform, warnings);
    auto unit = widths ? receiver_unit<Receiver, GaussianFit>(channel, waveform, noisy, settings.uncertainty)
                       : receiver_unit<Receiver, NoWidth>(channel, waveform, noisy, settings.uncertainty);
    if (const std::string air = air_warning(channel.wavelength, unit.receiver); !air.empty()) warnings.push_back(air);
    return unit;
  });
  using Own = Survey<Legs<SurveyLeg>, SurveyFootprint, SurveyScene, SurveyDetector<Receiver>, SurveyLight>;
  Own own(loaded.compiled->source, std::move(units), *loaded.scene, survey_light(survey, light, follows_light, library),
          loaded.seed);
  JoinedSurvey both{{own, loaded.scene}};
  if (settings.uncertainty)
    both.uncertainty = [scene = loaded.scene,
                        kept = std::make_shared<const Own>(std::move(own))]() -> UncertaintyQuery {
      return [scene, kept, of = uncertainty_of(*kept)](const Shot& shot, const Echo& echo) { return of(shot, echo); };
    };
  return both;
}

class LoadedSimulation final : public Simulation {
 public:
  explicit LoadedSimulation(std::shared_ptr<const LoadedRepetition> loaded, const ReceiverOverrides& overrides = {})
      : loaded_(std::move(loaded)), overrides_(overrides), warnings_(loaded_->warnings), joined_(received(overrides)) {}

  [[nodiscard]] const AnySurvey& survey() const noexcept override { return joined_.survey; }
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept override { return warnings_; }
  [[nodiscard]] const SurveySettings& document() const noexcept override { return loaded_->inputs->survey; }
  [[nodiscard]] const Settings& settings() const noexcept override { return loaded_->inputs->settings; }
  [[nodiscard]] const CompiledSurvey& compiled() const noexcept override { return *loaded_->compiled; }

  [[nodiscard]] Scene scene() const override {
    const SurveyScene& s = *loaded_->scene;
    Scene out{.min = s.bounds().min,
              .max = s.bounds().max,
              .parts = s.parts().size(),
              .memory = s.memory(),
              .empty = s.bounds().empty()};
    for (const SurveyPart& part : s.parts()) {
      out.moving += part.motion ? 1 : 0;
      if (const auto* mesh = std::get_if<std::shared_ptr<const MaskedMesh<>>>(&part.geometry))
        out.triangles += (*mesh)->size();
    }
    return out;
  }

  [[nodiscard]] io::PointSettings points() const override {
    io::PointSettings points = io::points_of(*loaded_->scene);
    const auto kept = [&](const auto& of_scene) {
      return [scene = loaded_->scene, of_scene](const EchoBatch& batch, const Shot& shot, const Echo& echo) {
        return of_scene(batch, shot, echo);
      };
    };
    points.surfaces = kept(points.surfaces);
    points.colours = kept(points.colours);
    if (joined_.uncertainty) points.uncertainty = joined_.uncertainty();
    for (const ChannelSettings& channel : loaded_->inputs->survey.scanner.channels)
      points.lasers.push_back(survey_laser(channel, {}));
    return points;
  }

  [[nodiscard]] int repetitions() const override { return loaded_->builder.runs(); }
  [[nodiscard]] std::unique_ptr<Simulation> repetition(int number) const override {
    return std::make_unique<LoadedSimulation>(
        std::make_shared<const LoadedRepetition>(loaded_->inputs, loaded_->builder, number));
  }
  [[nodiscard]] std::unique_ptr<Simulation> with_receivers(const ReceiverOverrides& overrides) const override {
    return std::make_unique<LoadedSimulation>(loaded_, overrides);
  }
  [[nodiscard]] ReceiverOverrides reference(bool true_ranges = false) const override {
    const LightSettings light = loaded_->inputs->survey.scene.light_or_default();
    int rings = 1;
    for (const ChannelSettings& channel : loaded_->inputs->survey.scanner.channels)
      rings = std::max(rings, overrides_.rings.value_or(channel.waveform.rings));
    return {.rings = std::clamp(2 * rings, 26, 100),
            .bin_size = pulse_length() / 128,
            .orders = light.orders,
            .paths = std::clamp(16 * light.paths, 1024, 100'000),
            .ideal = true,
            .true_ranges = true_ranges};
  }
  [[nodiscard]] RunErrors errors(const ErrorSampleOptions& options) const override {
    const ReceiverOverrides best = reference(true);
    ReceiverOverrides own = overrides_, sampling = overrides_;
    own.ideal = sampling.ideal = sampling.true_ranges = true;
    sampling.bin_size = best.bin_size;
    const std::vector<ErrorStep> steps{{"sampling", with_receivers(sampling)->survey()},
                                       {"estimator", with_receivers(own)->survey()},
                                       {"instrument", joined_.survey}};
    return errors_of_run(with_receivers(best)->survey(), steps, sampled(options));
  }
  [[nodiscard]] SettingsChoice choose(const Accuracy& accuracy, const ErrorSampleOptions& options) const override {
    const double own_bin = finest_bin(overridden(loaded_->inputs->survey.scanner, overrides_));
    return choose_settings(accuracy, adjustable(*this, pulse_length(), own_bin), sampled(options));
  }

 private:
  [[nodiscard]] double pulse_length() const {
    const auto& channels = loaded_->inputs->survey.scanner.channels;
    return std::ranges::min(channels, {}, &ChannelSettings::pulse_length).pulse_length;
  }
  [[nodiscard]] ErrorSampleOptions sampled(ErrorSampleOptions options) const {
    options.reach = 0.25 * speed_of_light * pulse_length();
    return options;
  }
  [[nodiscard]] JoinedSurvey received(const ReceiverOverrides& overrides) {
    std::vector<std::string> of_receivers;
    JoinedSurvey joined_survey = loaded_->inputs->settings.library_physics
                                     ? joined<BandLimitedReceiver<>>(*loaded_, overrides, of_receivers)
                                     : joined<ReceiverNoise>(*loaded_, overrides, of_receivers);
    add_new(warnings_, of_receivers);
    return joined_survey;
  }

  std::shared_ptr<const LoadedRepetition> loaded_;
  ReceiverOverrides overrides_;
  std::vector<std::string> warnings_;
  JoinedSurvey joined_;
};

}  // namespace detail

PULSECAST_INLINE std::unique_ptr<Simulation> make_simulation(const SurveySettings& survey,
                                                             const Simulation::Settings& settings,
                                                             const PartProvider& provider) {
  const auto inputs = std::make_shared<const detail::SimulationInputs>(survey, settings, provider);
  return std::make_unique<detail::LoadedSimulation>(
      std::make_shared<const detail::LoadedRepetition>(inputs, inputs->builder(), 0));
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
