// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_LOADED_SIMULATION_HPP
#define PULSECAST_HELIOS_DETAIL_LOADED_SIMULATION_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <time.h>

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>
#include <pulsecast/helios/detail/any_survey.hpp>
#include <pulsecast/helios/detail/receivers.hpp>
#include <pulsecast/helios/detail/scene_files.hpp>
#include <pulsecast/helios/detail/xml/number.hpp>
#include <pulsecast/helios/make_simulation.hpp>
#include <pulsecast/helios/scene.hpp>
#include <pulsecast/helios/simulation.hpp>
#include <pulsecast/io/las.hpp>
#include <pulsecast/io/spectral_library.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/survey.hpp>
#include <pulsecast/transport/light_paths.hpp>

/// Surveys with their scenes, ready to run.
namespace PULSECAST_NAMESPACE::helios {

namespace detail {

/// Spectra in folders, for the wavelengths of the channels. An unreadable folder gives a warning, as no part may need
/// it.
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

/// Processor time of this thread [s].
[[nodiscard]] inline double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Detectors of a survey: waveform settings of its channels within the limits of batches and files, with a warning for
/// each change.
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
  /// Bin size for LAS, whose sample interval is in whole picoseconds [s]. Source: LAS 1.4 R15, Waveform Packet
  /// Descriptor.
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

/// Wavelength of all channels, for media that are by it [m]. @throws SettingError if there are several
[[nodiscard]] inline double wavelength_of(const SurveySettings& survey) {
  const std::vector<ChannelSettings>& channels = survey.scanner.channels;
  for (const ChannelSettings& channel : channels)
    if (channel.wavelength != channels.front().wavelength)
      throw SettingError("wavelength_nm (of another channel, with a preset of <medium>)",
                         units::nanometre.number(channel.wavelength), "nm",
                         "that of the first; give the coefficients of the medium instead");
  return channels.front().wavelength;
}

/// Transport of a survey whose scene has `<light>` or `<medium>`. @throws SettingError for boxes of media that overlap,
/// and presets beyond the wavelength
[[nodiscard]] inline LightPaths light_paths(const SurveySettings& survey, bool library_physics) {
  const SceneSettings& scene = survey.scene;
  const LightSettings light = scene.light.empty() ? LightSettings{} : scene.light.front();
  const bool by_wavelength =
      std::any_of(scene.media.begin(), scene.media.end(), [](const auto& m) { return m.preset != MediumPreset::none; });
  return {.passages = static_cast<std::size_t>(light.passages),
          .share_min = light.share_min,
          .spread_planes = library_physics,
          .scattering = {.orders = static_cast<std::size_t>(light.orders),
                         .paths = static_cast<std::size_t>(light.paths),
                         .field_of_view = light.field_of_view},
          .air = scene.air(by_wavelength ? wavelength_of(survey) : MediumSettings::known_wavelength)};
}

/// Only implementation of `Simulation`.
class LoadedSimulation final : public Simulation {
 public:
  LoadedSimulation(const SurveySettings& survey, const Settings& settings, const PartProvider& provider)
      : survey_(survey),
        settings_(settings),
        provider_(provider),
        builder_(survey.scene, {.spectra = spectra_of(survey, spectra_folders(settings.assets)),
                                .pulse_rate = first_pulse_rate(survey),
                                .seed = settings.seed,
                                .fixed_incidence = settings.fixed_incidence,
                                .tilted_leaves = settings.library_physics,
                                .threads = settings.threads,
                                .city_models = settings.city_models}),
        limits_(survey, settings) {
    for (const Mesh& mesh : settings.meshes)
      meshes_.push_back({.geometry = std::make_shared<const TriangleMesh<>>(mesh.data, settings.threads),
                         .materials = material_table({mesh.material}),
                         .object = mesh.object,
                         .attributes = mesh.attributes});
    begin(0);
  }

  [[nodiscard]] int runs() const override { return builder_.runs(); }

  void begin(int run) override {
    std::vector<SurveyPart> all = parts(run);
    all.insert(all.end(), meshes_.begin(), meshes_.end());
    scene_.emplace(all, MovingIndexSettings{.to = 1});
    const auto ground = [&](const Vec2& at, auto... near) { return scene_->ground_height(at, near...); };
    const SurveyBuildOptions options{settings_.seed, settings_.platform_noise, settings_.leg_noise,
                                     settings_.leg_places};
    compiled_.emplace(compile_survey(survey_, ground, options));
    const double duration = compiled_->source.duration().seconds();
    const bool moves = std::any_of(all.begin(), all.end(), [](const SurveyPart& p) { return p.motion != nullptr; });
    if (moves) scene_.emplace(all, MovingIndexSettings{.to = std::max(1e-3, duration)});

    seed_ = settings_.seed + static_cast<std::uint64_t>(run) * 0x9e3779b97f4a7c15U;
    warnings_ = scene_warnings_;
    warnings_.insert(warnings_.end(), compiled_->warnings.begin(), compiled_->warnings.end());
    receive({});
  }

  [[nodiscard]] const CompiledSurvey& compiled() const override { return *compiled_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return warnings_; }

  [[nodiscard]] Scene scene() const override {
    const SurveyScene& s = *scene_;
    Scene out{.min = s.bounds().min,
              .max = s.bounds().max,
              .parts = s.parts().size(),
              .memory = s.memory(),
              .empty = s.bounds().empty()};
    for (const SurveyPart& part : s.parts()) {
      out.moving += part.motion ? 1 : 0;
      if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh<>>>(&part.geometry))
        out.triangles += (*mesh)->size();
    }
    return out;
  }

  [[nodiscard]] io::PointSettings points() const override { return io::points_of(*scene_); }

  RunSummary run(const RunOptions& options, const Sink& sink) const override {
    return pulsecast::run(*pipeline_, options, sink);
  }

  void receive(const ReceiverOverrides& overrides) override {
    std::vector<std::string> warnings;
    const ScannerSettings scanner = limits_.sampled_alike(scanner_of(overrides), warnings);
    if (settings_.echo_width && !overrides.ideal)
      connect<GaussianFit>(scanner, overrides.ideal, warnings);
    else
      connect<NoWidth>(scanner, overrides.ideal, warnings);
    add_new(warnings_, warnings);
  }

  [[nodiscard]] std::vector<Sample> sample(std::span<const SampleBlock> blocks, unsigned threads) const override {
    constexpr std::size_t at_once = 8;
    const AnySurvey& survey = *pipeline_;
    std::vector<Sample> all(blocks.size());
    for_each_index((blocks.size() + at_once - 1) / at_once, threads, [&](std::size_t task) {
      AnySurvey::Workspace workspace = survey.workspace();
      ResultBuffer buffer;  // reused, as in a run
      for (std::size_t k = task * at_once; k < std::min((task + 1) * at_once, blocks.size()); ++k) {
        const SampleBlock& block = blocks[k];
        Sample& sample = all[k];
        const auto add = [&](const Outcome& outcome) {
          buffer.append(outcome, block.empty_shots);
          return outcome.shot.index + 1;
        };
        buffer.clear();
        survey.simulate_in_order(block.first, block.from, workspace, add);
        buffer.clear();
        const double start = processor_seconds();
        survey.simulate_in_order(block.from, block.end, workspace, add);
        sample.seconds = processor_seconds() - start;
        sample.sample_interval = survey.sample_interval();
        static_cast<ResultBuffer&>(sample) = buffer;
      }
    });
    return all;
  }

  [[nodiscard]] std::vector<SlotCount> count(std::span<const PulseIndex> slots, unsigned threads) const override {
    constexpr std::size_t at_once = 1024;
    const AnySurvey& survey = *pipeline_;
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

 private:
  static void add_new(std::vector<std::string>& known, const std::vector<std::string>& texts) {
    for (const std::string& text : texts)
      if (std::find(known.begin(), known.end(), text) == known.end()) known.push_back(text);
  }

  std::vector<SurveyPart> parts(int run) {
    const auto build = [&] { return BuiltParts{builder_.parts(run), builder_.warnings(), builder_.files()}; };
    BuiltParts built = provider_ ? provider_(run, build) : build();
    add_new(scene_warnings_, built.warnings);
    return std::move(built.parts);
  }

  [[nodiscard]] ScannerSettings scanner_of(const ReceiverOverrides& overrides) const {
    ScannerSettings scanner = survey_.scanner;
    for (ChannelSettings& channel : scanner.channels) {
      channel.waveform.rings = overrides.rings.value_or(channel.waveform.rings);
      channel.waveform.bin_size = overrides.bin_size.value_or(channel.waveform.bin_size);
      if (!overrides.ideal) continue;
      channel.accuracy = 0;
      channel.errors.range_noise.clear();
    }
    return scanner;
  }

  template <class Width>
  void connect(const ScannerSettings& scanner, bool ideal, std::vector<std::string>& warnings) {
    const Vec3 size = scene_->bounds().empty() ? Vec3{} : scene_->bounds().size();
    const bool waveforms = settings_.waveforms && !ideal, noisy = settings_.waveform_noise && !ideal,
               library = settings_.library_physics;
    const auto units_by = [&](const auto& receiver_unit) {
      return ReceiverGroups(survey_.scanner).units(scanner, [&](const ChannelSettings& channel) {
        const double longest = std::min(2 * length(size) / speed_of_light + 20 * channel.pulse_length, 4e-6);
        WaveformSettings waveform = survey_waveform(channel, waveforms ? longest : 0, library, follows_light());
        limits_.limit_record(waveform, warnings);
        auto unit = receiver_unit(channel, waveform, noisy);
        if (const std::string air = air_warning(channel.wavelength, unit.receiver); !air.empty())
          warnings.push_back(air);
        return unit;
      });
    };
    if (library)
      connect<BandLimitedWaveform<Width>>(units_by(library_receiver_unit<Width>));
    else
      connect<FullWaveform<Width>>(units_by(survey_receiver_unit<Width>));
  }

  [[nodiscard]] bool follows_light() const { return settings_.light_paths || survey_.scene.follows_light(); }

  template <class Detector>
  void connect(std::vector<ReceiverUnit<RingFootprint, Detector>> units) {
    if (follows_light())
      connect(std::move(units), validated(light_paths(survey_, settings_.library_physics)));
    else
      connect(std::move(units), DirectLight{.spread_planes = settings_.library_physics});
  }

  template <class Detector, class Light>
  void connect(std::vector<ReceiverUnit<RingFootprint, Detector>> units, const Light& light) {
    using Pipeline = Survey<Legs<SurveyLeg>, RingFootprint, SurveyScene, Detector, Light>;
    pipeline_ =
        std::make_unique<SurveyOf<Pipeline>>(Pipeline(compiled_->source, std::move(units), *scene_, light, seed_));
  }

  SurveySettings survey_;
  Settings settings_;
  PartProvider provider_;
  SceneBuilder builder_;
  WaveformLimits limits_;
  std::optional<CompiledSurvey> compiled_;
  std::optional<SurveyScene> scene_;
  std::unique_ptr<const AnySurvey> pipeline_;
  std::vector<SurveyPart> meshes_;  // in addition to the survey's own parts
  std::uint64_t seed_ = 0;          // seed of this repetition
  std::vector<std::string> scene_warnings_, warnings_;
};

}  // namespace detail

PULSECAST_INLINE std::unique_ptr<Simulation> make_simulation(const SurveySettings& survey,
                                                             const Simulation::Settings& settings,
                                                             const PartProvider& provider) {
  return std::make_unique<detail::LoadedSimulation>(survey, settings, provider);
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
