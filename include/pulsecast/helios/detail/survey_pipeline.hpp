// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SURVEY_PIPELINE_HPP
#define PULSECAST_HELIOS_DETAIL_SURVEY_PIPELINE_HPP

#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/gaussian_fit.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/transport/direct_light.hpp>
#include <pulsecast/transport/light_paths.hpp>

/// Stages that an XML document chooses, as one type each: the pipeline is then compiled once.
namespace PULSECAST_NAMESPACE::helios::detail {

/// `FullWaveform` with or without echo widths.
template <WaveformReceiver Receiver>
class SurveyDetector {
  using Plain = FullWaveform<NoWidth, Receiver>;
  using Fitting = FullWaveform<GaussianFit, Receiver>;

 public:
  using refinements = refines<tag::SamplesWaveforms, tag::ValidatesLaser, tag::PreparesForLasers>;
  using Workspace = std::variant<typename Plain::Workspace, typename Fitting::Workspace>;
  static constexpr bool runs_without_reflections = Receiver::runs_without_reflections;

  explicit SurveyDetector(Plain detector) : detector_(std::move(detector)) {}
  explicit SurveyDetector(Fitting detector) : detector_(std::move(detector)) {}

  [[nodiscard]] double sample_interval() const noexcept {
    return std::visit([](const auto& d) noexcept { return d.sample_interval(); }, detector_);
  }
  void validate(const Laser& laser) const {
    std::visit([&](const auto& d) { d.validate(laser); }, detector_);
  }
  void prepare(const Laser& laser) {
    std::visit([&](auto& d) { d.prepare(laser); }, detector_);
  }
  [[nodiscard]] Workspace workspace(std::size_t reflections) const {
    return std::visit([&](const auto& d) { return Workspace(d.workspace(reflections)); }, detector_);
  }
  // the branches are inlined, as by `visit` a pulse takes 60 instructions more
  [[nodiscard, gnu::always_inline]] Detection detect(const DetectorInput& input, Workspace& w) const noexcept {
    if (const auto* plain = std::get_if<Plain>(&detector_))
      return plain->detect(input, *std::get_if<typename Plain::Workspace>(&w));
    return std::get_if<Fitting>(&detector_)->detect(input, *std::get_if<typename Fitting::Workspace>(&w));
  }

 private:
  std::variant<Plain, Fitting> detector_;
};

/// Rings of subrays, whose surveys judge surfaces if asked.
struct SurveyFootprint : RingFootprint {
  using refinements = refines<tag::JudgesSurfaces>;
  bool judges = false;  ///< see `JudgesSurfaces`

  SurveyFootprint(RingFootprint rings, bool judged) : RingFootprint(std::move(rings)), judges(judged) {}
  [[nodiscard]] bool judges_surfaces() const noexcept { return judges; }
};

/// `DirectLight`, or `LightPaths` for a scene that asks for it.
class SurveyLight {
 public:
  using Workspace = std::variant<DirectLight::Workspace, LightPaths::Workspace>;

  explicit SurveyLight(DirectLight light) : light_(light) {}
  explicit SurveyLight(LightPaths light) : light_(validated(std::move(light))) {}

  /// As the concept ValidatesTarget requires.
  template <SceneQueries Target>
  void validate(const Target& target) const {
    if (const auto* paths = std::get_if<LightPaths>(&light_)) paths->validate(target);
  }
  [[nodiscard]] std::size_t reflections(std::size_t subrays) const noexcept {
    return std::visit([&](const auto& l) noexcept { return l.reflections(subrays); }, light_);
  }
  [[nodiscard]] Workspace workspace(std::size_t subrays) const {
    return std::visit([&](const auto& l) { return Workspace(l.workspace(subrays)); }, light_);
  }
  template <SceneQueries Target>
  [[nodiscard, gnu::always_inline]] TransportResult trace(const Target& target, const TransportInput& light,
                                                          Workspace& w,
                                                          std::span<Reflection> reflections) const noexcept {
    if (const auto* direct = std::get_if<DirectLight>(&light_))
      return direct->trace(target, light, *std::get_if<DirectLight::Workspace>(&w), reflections);
    return std::get_if<LightPaths>(&light_)->trace(target, light, *std::get_if<LightPaths::Workspace>(&w), reflections);
  }

 private:
  std::variant<DirectLight, LightPaths> light_;
};

/// Wavelength of all channels, for media [m]. @throws SettingError if there are several
[[nodiscard]] inline double wavelength_of(const SurveySettings& survey) {
  const std::vector<ChannelSettings>& channels = survey.scanner.channels;
  for (const ChannelSettings& channel : channels)
    if (channel.wavelength != channels.front().wavelength)
      throw SettingError("wavelength_nm (of another channel, with a preset of <medium>)",
                         units::nanometre.number(channel.wavelength), "nm",
                         "that of the first; give the coefficients of the medium instead");
  return channels.front().wavelength;
}

/// Transport of a survey: that of `light` and `<medium>`, if its scene asks for one.
/// @throws SettingError for boxes of media that overlap, and presets beyond the wavelength
[[nodiscard]] inline SurveyLight survey_light(const SurveySettings& survey, const LightSettings& light,
                                              bool follows_light, bool library_physics) {
  if (!follows_light) return SurveyLight(DirectLight{.spread_planes = library_physics});
  const SceneSettings& scene = survey.scene;
  const bool by_wavelength =
      std::any_of(scene.media.begin(), scene.media.end(), [](const auto& m) { return m.preset != MediumPreset::none; });
  return SurveyLight(
      LightPaths{.passages = static_cast<std::size_t>(light.passages),
                 .share_min = light.share_min,
                 .spread_planes = library_physics,
                 .scattering = {.orders = static_cast<std::size_t>(light.orders),
                                .paths = static_cast<std::size_t>(light.paths),
                                .field_of_view = light.field_of_view},
                 .air = scene.air(by_wavelength ? wavelength_of(survey) : MediumSettings::known_wavelength)});
}

}  // namespace PULSECAST_NAMESPACE::helios::detail

#endif
