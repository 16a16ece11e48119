// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_SETTINGS_HPP
#define PULSECAST_HELIOS_SETTINGS_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/helios/detail/settings/mount.hpp>
#include <pulsecast/helios/detail/settings/scanner.hpp>
#include <pulsecast/helios/detail/settings/scene.hpp>

/// Settings of a survey document, as plain structs in SI units and radians. A program may change them before it builds
/// the survey. Templates, references and inheritance are resolved: each struct is complete. The comment of a member
/// names its attribute or element. A 0 may mean a default or none; `validate` refuses negative values there.
namespace PULSECAST_NAMESPACE::helios {

/// Column of each quantity, from 0.
struct TrajectoryIndices {
  int time = 0;   ///< `tIndex`
  int roll = 1;   ///< `rollIndex`
  int pitch = 2;  ///< `pitchIndex`
  int yaw = 3;    ///< `yawIndex`
  int x = 4;      ///< `xIndex`
  int y = 5;      ///< `yIndex`
  int z = 6;      ///< `zIndex`

  bool operator==(const TrajectoryIndices&) const = default;
};

/// Trajectory of an interpolated platform: attributes of `<platformSettings>`.
struct TrajectorySettings {
  std::filesystem::path file{};                ///< `trajectory`
  std::optional<char> separator{};             ///< default: detected; `trajectory_separator`, or `trajectory_seperator`
  std::optional<TrajectoryIndices> columns{};  ///< default: from the header of the file; `tIndex`...
  bool position_only = false;                  ///< `interpolationDomain="position"`
  bool angles_in_degrees = true;               ///< unit of angles in the file; `toRadians`
  bool sync_clock = false;                     ///< start the clock at the time in the file; `syncGPSTime`
  bool teleports = false;  ///< jump to the start, like a leg without pulses: the optic restarts. `teleportToStart`
  std::optional<double> start{};  ///< on the clock of the file, default its first sample; `tStart` [s]
  std::optional<double> end{};    ///< on the clock of the file, default its last sample; `tEnd` [s]

  bool operator==(const TrajectorySettings&) const = default;
};

/// `<platformSettings>` of a leg
struct LegPlatformSettings {
  Vec3 position{};           ///< start of the leg, in the coordinates of the scene; `x`, `y`, `z` [m]
  bool on_ground = false;    ///< take z from the ground; `onGround`
  double speed = 70;         ///< `movePerSec_m` [m/s]
  bool smooth_turn = false;  ///< multicopter: turn without a stop; `smoothTurn`, or `stopAndTurn="false"`
  std::optional<double> yaw_at_departure{};  ///< multicopter; counter-clockwise from +y. `yawAtDeparture_deg` [rad]
  std::optional<TrajectorySettings> trajectory{};  ///< interpolated only

  bool operator==(const LegPlatformSettings&) const = default;
};

/// `<scannerSettings>` of a leg
struct LegScannerSettings {
  bool active = true;                          ///< `active`
  double pulse_rate = 0;                       ///< default: the scanner's first; `pulseFreq_hz` [Hz]
  double scan_rate = 0;                        ///< `scanFreq_hz` [Hz]
  std::optional<double> scan_angle{};          ///< half angle, default the device's limit; `scanAngle_deg` [rad]
  std::optional<double> vertical_angle_min{};  ///< rotating only; `verticalAngleMin_deg` [rad]
  std::optional<double> vertical_angle_max{};  ///< rotating only; `verticalAngleMax_deg` [rad]
  double head_rate = 0;                        ///< `headRotatePerSec_deg` [rad/s]
  double head_start = 0;                       ///< `headRotateStart_deg` [rad]
  double head_stop = 0;                        ///< `headRotateStop_deg` [rad]
  std::optional<double> divergence{};  ///< of all channels; by default each one's own. `beamDivergence_rad` [rad]
  double trajectory_interval = 0;      ///< interval of trajectory records; 0: none. `trajectoryTimeInterval_s` [s]
  double warm_up = 0;  ///< running time of head and optic before the first pulse; `opticsWarmupPhase_s` [s]

  void validate() const {
    require_not_negative("pulseFreq_hz", pulse_rate, "Hz");
    require_not_negative("scanFreq_hz", scan_rate, "Hz");
    if (scan_angle) require_not_negative("scanAngle_deg", degrees(*scan_angle), "deg");
    require_not_negative("trajectoryTimeInterval_s", trajectory_interval, "s");
    require_not_negative("opticsWarmupPhase_s", warm_up, "s");
  }

  bool operator==(const LegScannerSettings&) const = default;
};

/// `<leg>`
struct LegSettings {
  std::optional<std::string> strip{};    ///< legs of one strip share their files; `stripId`
  std::optional<double> duration_max{};  ///< upper limit of its duration; `maxDuration_s` of leg or scannerSettings [s]
  LegPlatformSettings platform{};        ///< `platformSettings` of the leg
  LegScannerSettings scanner{};          ///< `scannerSettings` of the leg

  void validate() const {
    if (duration_max) require_not_negative("maxDuration_s", *duration_max, "s");
    scanner.validate();
  }

  bool operator==(const LegSettings&) const = default;
};

/// True if a leg of a moving platform stays in place: the next one begins there, too, or there is none.
[[nodiscard]] inline bool stays_in_place(const std::vector<LegSettings>& legs, std::size_t k) {
  if (k + 1 >= legs.size()) return legs.size() == 1;
  const LegPlatformSettings &here = legs[k].platform, &next = legs[k + 1].platform;
  const bool is_above = here.position.x == next.position.x && here.position.y == next.position.y;
  return is_above && here.on_ground == next.on_ground && (here.on_ground || here.position.z == next.position.z);
}

/// Kind of platform: `type` of `<platform>`.
enum class PlatformKind : std::uint8_t {
  stationary,      ///< `type="static"`
  linear_path,     ///< `type="linearpath"`
  multicopter,     ///< `type="multicopter"`
  ground_vehicle,  ///< `type="groundvehicle"`
  interpolated,    ///< `platform="interpolated"`: follows its trajectory
};

/// Convention for roll, pitch and yaw of a trajectory: `rotationSpec`.
enum class RotationSpec : std::uint8_t {
  arinc_705,  ///< `ARINC 705`
  canonical,  ///< `CANONICAL`
};

/// Limits of a multicopter's attitude.
struct MulticopterDynamics {
  double yaw_speed = radians(85.94);  ///< maximum; `yaw_speed_deg` [rad/s]
  double pitch_offset = radians(35);  ///< maximum bank angle; `pitch_offset_deg` [rad]

  bool operator==(const MulticopterDynamics&) const = default;
};

/// Distribution of noise: `type` of a noise element.
enum class NoiseDistribution : std::uint8_t {
  normal,   ///< `type="NORMAL"`
  uniform,  ///< `type="UNIFORM"`
};

/// Random number added at each pulse: `<positionXNoise>`...
struct NoiseSettings {
  NoiseDistribution distribution = NoiseDistribution::normal;  ///< `type`
  double mean = 0;                                             ///< normal distribution; `mean` [m] or [rad]
  double deviation = 1;                                        ///< normal distribution; `stdev` [m] or [rad]
  double low = 0;                                              ///< uniform distribution; `min` [m] or [rad]
  double high = 1;                                             ///< uniform distribution; `max` [m] or [rad]
  bool clipped = false;                                        ///< `clipEnabled`
  double clip_low = 0;                                         ///< `clipMin` [m] or [rad]
  double clip_high = 1;                                        ///< `clipMax` [m] or [rad]
  int lifespan = 1;  ///< number of pulses per random number, 0 for all; `fixedLifespan`

  void validate() const { detail::require_at_least(0, "fixedLifespan", lifespan); }

  bool operator==(const NoiseSettings&) const = default;
};

/// `<platform>`, with the overrides of the survey.
struct PlatformSettings {
  std::string id{};                                      ///< `id`
  std::string name{};                                    ///< `name`
  PlatformKind kind = PlatformKind::stationary;          ///< `type`
  MountSettings mount{};                                 ///< pose of the instrument on the body; `<scannerMount>`
  MulticopterDynamics multicopter{};                     ///< multicopter only
  RotationSpec rotation_spec = RotationSpec::arinc_705;  ///< interpolated only; `rotationSpec`
  std::array<std::optional<NoiseSettings>, 3> position_noise{};  ///< `<positionXNoise>`, Y and Z [m]
  std::array<std::optional<NoiseSettings>, 3> attitude_noise{};  ///< `<attitudeXNoise>`, Y and Z [rad]

  void validate() const {
    for (const auto* noises : {&position_noise, &attitude_noise})
      for (const std::optional<NoiseSettings>& noise : *noises)
        if (noise) noise->validate();
  }

  bool operator==(const PlatformSettings&) const = default;
};

/// Random offset of the start of legs: `legRandomOffset`.
struct LegOffsetSettings {
  double mean = 0;         ///< along each axis; `legRandomOffsetMean` [m]
  double deviation = 0.1;  ///< along each axis; `legRandomOffsetStdev` [m]

  bool operator==(const LegOffsetSettings&) const = default;
};

/// `<survey>`. Its overrides of the scanner (`<FWFSettings>`, `<detectorSettings>`) and the platform (`<scannerMount>`,
/// noise) are stored there.
struct SurveySettings {
  std::string name{};                             ///< default: that of the file; `name`
  std::optional<std::uint64_t> seed{};            ///< `seed`
  std::optional<LegOffsetSettings> leg_offset{};  ///< `legRandomOffset`...
  ScannerSettings scanner{};                      ///< `scanner`
  PlatformSettings platform{};                    ///< `platform`, or `basePlatform` if that is interpolated
  SceneSettings scene{};                          ///< `scene`
  std::vector<LegSettings> legs{};                ///< `<leg>`, in this order

  bool operator==(const SurveySettings&) const = default;
};

/// True if the legs of such a platform lead to the start of the next one.
[[nodiscard]] constexpr bool legs_connect(PlatformKind kind) noexcept {
  return kind != PlatformKind::stationary && kind != PlatformKind::interpolated;
}

/// True if a moving platform stays in place in a leg.
[[nodiscard]] inline bool is_stationary(const SurveySettings& survey, std::size_t leg) {
  return legs_connect(survey.platform.kind) && stays_in_place(survey.legs, leg);
}

/// True if a leg only ends the one before it, without pulses: the last of several of a moving platform.
[[nodiscard]] inline bool only_ends(const SurveySettings& survey, std::size_t leg) {
  return legs_connect(survey.platform.kind) && leg > 0 && leg + 1 == survey.legs.size();
}

/// Pulse rate of the first leg that sets one; else the scanner's default, else 100 kHz [Hz].
[[nodiscard]] inline double first_pulse_rate(const SurveySettings& survey) {
  for (const LegSettings& leg : survey.legs)
    if (leg.scanner.pulse_rate > 0) return leg.scanner.pulse_rate;
  return survey.scanner.pulse_rates.empty() ? 100e3 : survey.scanner.pulse_rates.front();
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
