// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_SURVEY_HPP
#define PULSECAST_HELIOS_SURVEY_HPP

#include <pulsecast/helios/detail/leg.hpp>
#include <pulsecast/platform/legs.hpp>

/// Compilation of survey settings to pulses.
namespace PULSECAST_NAMESPACE::helios {

/// Runnable survey, with data of its legs.
struct CompiledSurvey {
  /// Leg of the document.
  struct Leg {
    std::size_t number = 0;              ///< index in the document, from 0
    bool active = true;                  ///< true if pulses are emitted
    std::optional<std::string> strip{};  ///< name of its strip, if any
    PulseIndex first = 0, end = 0;       ///< range of its slots in the survey
    Tick start{}, duration{};            ///< start since the survey's start; duration
    double trajectory_interval = 0;      ///< interval of trajectory records; 0: none [s]
    double pulse_rate = 0;               ///< pulse rate [Hz]
  };
  Legs<SurveyLeg> source;               ///< source of all pulses
  std::vector<Leg> legs;                ///< legs, in order of the document
  std::optional<double> clock_start{};  ///< start by the clock of a trajectory, if any [s]
  std::vector<std::string> warnings{};  ///< warnings of the compilation
};

/// Pulses of a survey. @throws SettingError with leg and attribute, FileError of a trajectory
[[nodiscard]] CompiledSurvey compile_survey(const SurveySettings& survey, const GroundHeight& ground,
                                            const SurveyBuildOptions& options = {});

/// Checks legs and scanner without the scene; returns warnings. @throws SettingError, FileError
[[nodiscard]] std::vector<std::string> check_without_scene(
    const SurveySettings& survey, const std::vector<std::string>& leg_places = {},
    const io::MapProjector& projector = {}, const std::map<std::string, std::vector<TimedPose>>& trajectories = {});

}  // namespace PULSECAST_NAMESPACE::helios

#if PULSECAST_DEFINES(HELIOS_SURVEY)
#include <unordered_set>

#include <pulsecast/helios/detail/leg_paths.hpp>
#include <pulsecast/helios/detail/xml/writer.hpp>

namespace PULSECAST_NAMESPACE::helios {

namespace detail {

/// Compiles settings to a plan of legs.
class SurveyCompiler {
 public:
  SurveyCompiler(const SurveySettings& survey, const LegPaths& paths, const SurveyBuildOptions& options)
      : survey_(survey), paths_(paths), options_(options) {}

  [[nodiscard]] CompiledSurvey compile() const {
    std::vector<Leg<SurveyLeg>> legs;
    std::vector<CompiledSurvey::Leg> compiled;
    std::vector<std::string> warnings = paths_.warnings();
    PulseIndex first = 0;
    Tick start{};
    SurveyPath path;  // of the leg before, and then of the leg
    double optic_time = 0;
    std::unordered_set<std::string> noted;  // limits that an earlier leg reached
    for (std::size_t k = 0; k < survey_.legs.size(); ++k) {
      const LegSettings& leg = survey_.legs[k];
      const bool active = leg.scanner.active;
      const std::string name = paths_.leg_name(k);
      const double rate = naming(name, [&] { return pulse_rate_of(survey_.scanner, leg.scanner); });
      if (paths_[k].clock) start = Tick::of_seconds(*paths_[k].clock - *paths_.clock_start());
      const double late = follow(k, path, compiled), way = std::max(0.0, paths_[k].duration - late);
      const double duration = in_whole_slots(duration_of(k, way), rate, paths_[k].rounding);
      if (way > 0 && duration > 1.1 * way && active)
        warnings.push_back(text::joined(
            {name, ": the platform arrives after ", brief(way), " s, and stays for ", brief(duration - way),
             " s until the head has turned; without headRotateStop_deg, the leg ends at its arrival"}));
      require_within(name + " (duration)", duration, 0, 1e15, "s");
      require_within(name + " (pulses)", duration * rate, 0, 1e15, "");
      const double interval = active ? leg.scanner.trajectory_interval : 0;
      if (interval > 0)
        require_within(name + ": trajectoryTimeInterval_s (records)", duration / interval, 0, max_records, "");
      for (std::size_t c = 0; c < survey_.scanner.channels.size() && active && !only_ends(survey_, k); ++c)
        for (const std::string& note : limit_notes(survey_.scanner, c, leg.scanner, rate))
          if (noted.insert(note).second) warnings.push_back(name + ": " + note);
      const auto& trajectory = leg.platform.trajectory;
      const bool follows = survey_.platform.kind == PlatformKind::interpolated && trajectory;
      if (!active || (follows && trajectory->teleports)) optic_time = 0;
      const MountSettings& mounted = survey_.platform.mount;
      const Mount mount{.lever_arm = mounted.position, .boresight = mounted.rotation.rotation()};
      const InstrumentOptions options{mount.boresight, optic_time};
      Instrument instrument = naming(name, [&] { return Instrument(survey_.scanner, leg.scanner, duration, options); });
      const Tick time = instrument.duration();
      if (active) optic_time += time.seconds();
      SurveyNoise noise{.seed = options_.seed + 0x9e3779b97f4a7c15U * (k + 1),
                        .survey_seed = options_.seed,
                        .leg = static_cast<std::uint32_t>(k)};
      if (options_.platform_noise) {
        noise.position = survey_.platform.position_noise;
        noise.attitude = survey_.platform.attitude_noise;
        noise.mount = survey_.platform.mount_error;
        noise.errors = survey_.platform.pose_errors;
      }
      const auto known = paths_[k].clock ? std::optional(Tick::of_seconds(duration)) : std::nullopt;
      legs.push_back({SurveyLeg(path, mount, std::move(instrument), std::move(noise), known), active, start});
      const PulseIndex size = active ? legs.back().platform.size() : 0;
      compiled.push_back(
          {k, active, leg.strip, first, first + size, start, time, leg.scanner.trajectory_interval, rate});
      first += size;
      start = start + time;
    }
    return {Legs<SurveyLeg>(std::move(legs)), std::move(compiled), paths_.clock_start(), std::move(warnings)};
  }

 private:
  static constexpr double max_records = 1e9;  ///< records of a leg's trajectory: some 70 GB of text

  /// Sets the path of a leg. A plan continues where the leg before ended. Returns the delay [s].
  [[nodiscard]] double follow(std::size_t k, SurveyPath& path, const std::vector<CompiledSurvey::Leg>& before) const {
    const SurveyPath& planned = paths_[k].path;
    const Tick ended = k > 0 ? path.start + before[k - 1].duration : Tick{};
    path = planned;
    if (!paths_.continues(k)) return 0;
    const double late =
        static_cast<double>(ended.second - planned.start.second) + (ended.fraction - planned.start.fraction);
    if (std::fabs(late) * before[k - 1].pulse_rate >= 1) return 0;  // cut, or waiting for the head
    path.start = ended;
    return late;
  }

  /// Duration without its rounding, if that makes it whole slots [s].
  [[nodiscard]] static double in_whole_slots(double duration, double rate, double rounding) noexcept {
    const double slots = std::round(duration * rate);
    return std::fabs(duration - slots / rate) <= rounding ? slots / rate : duration;
  }

  /// Duration of a leg: until platform, in `way` [s], and head have arrived, or `duration_max` [s].
  [[nodiscard]] double duration_of(std::size_t k, double way) const {
    const LegSettings& leg = survey_.legs[k];
    const LegScannerSettings& s = leg.scanner;
    const double turn = s.head_stop - s.head_start, speed = head_rate(survey_.scanner.channels.front(), s);
    const bool stands = paths_[k].duration == 0;
    double duration = way;
    if (only_ends(survey_, k)) return 0;
    if (speed != 0 && turn / speed > 0) duration = std::max(duration, turn / speed - s.warm_up);
    if (leg.duration_max) {
      const double most = *leg.duration_max;
      return stands && duration == 0 ? most : std::min(duration, most);
    }
    if (paths_.is_stationary(k) && k + 1 < survey_.legs.size()) return duration;
    if (stands && duration == 0 && speed == 0 && s.active)
      throw SettingError(paths_.leg_name(k) + ": maxDuration_s", 0, "s",
                         "given if neither platform nor head moves, as the leg would never end otherwise");
    return std::max(0.0, duration);
  }

  const SurveySettings& survey_;
  const LegPaths& paths_;
  const SurveyBuildOptions& options_;
};

}  // namespace detail

PULSECAST_INLINE CompiledSurvey compile_survey(const SurveySettings& survey, const GroundHeight& ground,
                                               const SurveyBuildOptions& options) {
  const auto document = detail::document_of(survey, [&](std::size_t k) { return options.leg_name(k); });
  const LegPaths paths(survey, ground, options);
  CompiledSurvey compiled = detail::SurveyCompiler(survey, paths, options).compile();
  if (options.leg_places.empty())  // else reported by the reader
    compiled.warnings.insert(compiled.warnings.begin(), document.notes().begin(), document.notes().end());
  return compiled;
}

PULSECAST_INLINE std::vector<std::string> check_without_scene(
    const SurveySettings& survey, const std::vector<std::string>& leg_places, const io::MapProjector& projector,
    const std::map<std::string, std::vector<TimedPose>>& trajectories) {
  const auto ground = [](const Vec2&) -> std::optional<double> { return 0; };
  std::vector<std::string> warnings =
      compile_survey(survey, ground, {.leg_places = leg_places, .projector = projector, .trajectories = trajectories})
          .warnings;
  for (const ChannelSettings& channel : survey.scanner.channels) {
    const Receiver receiver = survey_receiver(channel);
    receiver.validate();
    const std::string odd = air_warning(channel.wavelength, receiver);
    if (!odd.empty() && std::ranges::find(warnings, odd) == warnings.end()) warnings.push_back(odd);
    survey_waveform(channel).validate();
    (void)RingFootprint(static_cast<std::size_t>(std::max(1, channel.waveform.rings)));
  }
  return warnings;
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif

#endif
