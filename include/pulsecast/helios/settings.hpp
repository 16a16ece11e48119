// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_SETTINGS_HPP
#define PULSECAST_HELIOS_SETTINGS_HPP

#include <pulsecast/helios/detail/settings/scanner.hpp>
#include <pulsecast/helios/detail/settings/scene.hpp>

/// Settings of a survey document, in SI units and radians, without templates and references. The comment of a member
/// names its attribute or element, `fields` its limits, which `check_fields` checks. A 0 may mean a default or none.
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

  void fields(FieldIo& io) {
    io.whole("tIndex", time, 0, 999);
    io.whole("rollIndex", roll, 0, 999);
    io.whole("pitchIndex", pitch, 0, 999);
    io.whole("yawIndex", yaw, 0, 999);
    io.whole("xIndex", x, 0, 999);
    io.whole("yIndex", y, 0, 999);
    io.whole("zIndex", z, 0, 999);
  }
  bool operator==(const TrajectoryIndices&) const = default;
};

/// Trajectory of an interpolated platform: attributes of `<platformSettings>`.
struct TrajectorySettings {
  std::filesystem::path file{};                ///< `trajectory`
  std::optional<char> separator{};             ///< default: detected; `trajectory_separator`
  std::optional<TrajectoryIndices> columns{};  ///< default: by the file's header; `tIndex`...
  bool position_only = false;                  ///< `interpolationDomain="position"`
  bool angles_in_degrees = true;               ///< unit of angles in the file; `toRadians`
  bool sync_clock = false;                     ///< clock starts at the file's time; `syncGPSTime`
  bool teleports = false;                      ///< jump to the start; the optic restarts. `teleportToStart`
  std::optional<double> start{};               ///< on the file's clock, default its first; `tStart` [s]
  std::optional<double> end{};                 ///< on that clock, default its last; `tEnd` [s]

  void fields(FieldIo& io) {
    io.file("trajectory", file);
    separator_fields(io);
    TrajectoryIndices indices = columns.value_or(TrajectoryIndices{});
    bool given = columns.has_value();
    for (const char* name : {"tIndex", "rollIndex", "pitchIndex", "yawIndex", "xIndex", "yIndex", "zIndex"})
      given = given || io.has(name);
    if (given || io.reads()) indices.fields(io);
    if (given && io.reads()) columns = indices;
    io.choice("interpolationDomain", position_only, {{"position_and_attitude", false}, {"position", true}});
    io.flag("toRadians", angles_in_degrees);
    io.flag("syncGPSTime", sync_clock);
    io.flag("teleportToStart", teleports);
    double slope = 0;
    if (io.reads()) io.number("slopeFilterThreshold", slope, units::one, 0, 1e9);
    if (slope > 0) io.warn("slopeFilterThreshold", "slopeFilterThreshold has no effect: all samples are kept");
    io.number("tStart", start, units::second, -1e12, 1e12);
    io.number("tEnd", end, units::second, -1e12, 1e12);
    if (start && end && !(*start < *end)) io.fault("tEnd", "tEnd is not after tStart");
  }
  /// Both spellings of the separator.
  void separator_fields(FieldIo& io) {
    for (const char* name : {"trajectory_separator", "trajectory_seperator"}) {
      std::optional<std::string> given;
      if (!io.reads() && separator) given.emplace(1, *separator);
      io.text(name, given);
      if (!io.reads()) return;
      if (!given) continue;
      if (given->size() == 1 && std::string_view(",;\t ").find(*given) != given->npos)
        separator = given->front();
      else
        io.warn(name,
                said(name, *given) + " has no effect: expected a comma, a semicolon, a tab or a blank; it is detected");
    }
  }
  bool operator==(const TrajectorySettings&) const = default;
};

/// `<platformSettings>` of a leg
struct LegPlatformSettings {
  Vec3 position{};                           ///< start of the leg, in the scene; `x`, `y`, `z` [m]
  bool on_ground = false;                    ///< take z from the ground; `onGround`
  double speed = 70;                         ///< `movePerSec_m` [m/s]
  bool smooth_turn = false;                  ///< turn without a stop; `smoothTurn`, `stopAndTurn="false"`
  std::optional<double> yaw_at_departure{};  ///< multicopter; counter-clockwise from +y. `yawAtDeparture_deg` [rad]
  std::optional<TrajectorySettings> trajectory{};  ///< interpolated only

  void fields(FieldIo& io) {
    io.components(position);
    io.flag("onGround", on_ground);
    io.number("movePerSec_m", speed, units::metre_per_second, 0, 1e5);
    io.flag("smoothTurn", smooth_turn);
    bool stops = true;
    bool slows = true;
    if (io.reads()) {
      io.flag("stopAndTurn", stops);
      io.flag("slowdownEnabled", slows);
    }
    if (!stops) smooth_turn = true;
    if (!slows)
      io.warn("slowdownEnabled",
              "slowdownEnabled of false has no effect: a multicopter slows down as it must to turn and to stop");
    io.number("yawAtDeparture_deg", yaw_at_departure, units::degree, -3600, 3600);
    TrajectorySettings changed = trajectory.value_or(TrajectorySettings{});
    const TrajectorySettings before = changed;
    if (io.reads() || trajectory) changed.fields(io);
    if (changed != before || io.has("trajectory")) trajectory = std::move(changed);
  }
  bool operator==(const LegPlatformSettings&) const = default;
};

/// `<scannerSettings>` of a leg
struct LegScannerSettings {
  bool active = true;                          ///< `active`
  double pulse_rate = 0;                       ///< 0: the scanner's first; `pulseFreq_hz` [Hz]
  double scan_rate = 0;                        ///< `scanFreq_hz` [Hz]
  std::optional<double> scan_angle{};          ///< half, default the maximum; `scanAngle_deg` [rad]
  std::optional<double> vertical_angle_min{};  ///< rotating only; `verticalAngleMin_deg` [rad]
  std::optional<double> vertical_angle_max{};  ///< rotating only; `verticalAngleMax_deg` [rad]
  double head_rate = 0;                        ///< `headRotatePerSec_deg` [rad/s]
  double head_start = 0;                       ///< `headRotateStart_deg` [rad]
  double head_stop = 0;                        ///< `headRotateStop_deg` [rad]
  std::optional<double> divergence{};          ///< default: channels'; `beamDivergence_rad` [rad]
  double trajectory_interval = 0;              ///< of records; 0: none. `trajectoryTimeInterval_s` [s]
  double warm_up = 0;                          ///< run before the first pulse; `opticsWarmupPhase_s` [s]

  void fields(FieldIo& io) {
    io.flag("active", active);
    io.number("pulseFreq_hz", pulse_rate, units::hertz, 0, 1e8);
    io.number("scanFreq_hz", scan_rate, units::hertz, 0, 1e6);
    io.number("scanAngle_deg", scan_angle, units::degree, 0, 180);
    io.number("verticalAngleMin_deg", vertical_angle_min, units::degree, -360, 360);
    io.number("verticalAngleMax_deg", vertical_angle_max, units::degree, -360, 360);
    io.number("headRotatePerSec_deg", head_rate, units::degree_per_second, -1e6, 1e6);
    io.number("headRotateStart_deg", head_start, units::degree, -1e8, 1e8);
    io.number("headRotateStop_deg", head_stop, units::degree, -1e8, 1e8);
    io.number("beamDivergence_rad", divergence, units::radian, 1e-9, 0.5);
    io.number("trajectoryTimeInterval_s", trajectory_interval, units::second, 0, 1e9);
    io.number("opticsWarmupPhase_s", warm_up, units::second, 0, 1e5);
  }
  void validate() const { check_fields(*this); }
  bool operator==(const LegScannerSettings&) const = default;
};

/// `<leg>`
struct LegSettings {
  std::optional<std::string> strip{};    ///< legs of one strip share their files; `stripId`
  std::optional<double> duration_max{};  ///< `maxDuration_s` of leg or scannerSettings [s]
  LegPlatformSettings platform{};        ///< `platformSettings` of the leg
  LegScannerSettings scanner{};          ///< `scannerSettings` of the leg

  void fields(FieldIo& io) {
    io.text("stripId", strip);
    io.number("maxDuration_s", duration_max, units::second, 0, 1e9);
  }
  bool operator==(const LegSettings&) const = default;
};

/// True if a leg of a moving platform stays in place: the next one begins there, or there is none.
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

  void fields(FieldIo& io) {
    io.number("yaw_speed_deg", yaw_speed, units::degree_per_second, 0, 1e5);
    io.number("pitch_offset_deg", pitch_offset, units::degree, 0, 90);
  }
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
  double mean = 0;                                             ///< of `normal`; `mean` [m or rad]
  double deviation = 1;                                        ///< of `normal`; `stdev` [m or rad]
  double low = 0;                                              ///< of `uniform`; `min` [m or rad]
  double high = 1;                                             ///< of `uniform`; `max` [m or rad]
  bool clipped = false;                                        ///< `clipEnabled`
  double clip_low = 0;                                         ///< `clipMin` [m] or [rad]
  double clip_high = 1;                                        ///< `clipMax` [m] or [rad]
  int lifespan = 1;  ///< number of pulses per random number, 0 for all; `fixedLifespan`

  void fields(FieldIo& io) {
    using enum NoiseDistribution;
    io.choice("type", distribution, {{"NORMAL", normal}, {"UNIFORM", uniform}});
    io.number("mean", mean, units::one, -1e6, 1e6);
    io.number("stdev", deviation, units::one, 0, 1e6);
    io.number("min", low, units::one, -1e6, 1e6);
    io.number("max", high, units::one, -1e6, 1e6);
    io.flag("clipEnabled", clipped);
    io.number("clipMin", clip_low, units::one, -1e6, 1e6);
    io.number("clipMax", clip_high, units::one, -1e6, 1e6);
    io.whole("fixedLifespan", lifespan, 0, 1'000'000'000);
    if (distribution == uniform && !(low <= high)) io.fault("max", "max is below min");
    if (clipped && !(clip_low <= clip_high)) io.fault("clipMax", "clipMax is below clipMin");
  }
  bool operator==(const NoiseSettings&) const = default;
};

/// Calibration error, reported minus true mount, about the axes of the platform: `<mountError>`.
struct MountErrorSettings {
  Vec3 position{};     ///< of the lever arm: right, forward, up; `x`, `y`, `z` [m]
  double roll = 0;     ///< of the boresight, right side down; `roll_deg` [rad]
  double pitch = 0;    ///< front up; `pitch_deg` [rad]
  double heading = 0;  ///< clockwise from above; `heading_deg` [rad]

  void fields(FieldIo& io) {
    if (io.reads()) *this = {};
    io.components(position);
    io.number("roll_deg", roll, units::small_degree, -180, 180);
    io.number("pitch_deg", pitch, units::small_degree, -180, 180);
    io.number("heading_deg", heading, units::small_degree, -180, 180);
  }
  bool operator==(const MountErrorSettings&) const = default;
};

/// Random errors of reported poses, of this library: `<poseErrors>`. As `PoseErrors`, along and about the axes of the
/// body; those of boresight about the axes of the scanner.
struct PoseErrorSettings {
  Vec3 position_drift{};         ///< of a Gauss-Markov process; `positionDriftX_m`, Y and Z [m]
  Vec3 attitude_drift{};         ///< of the same kind; `attitudeDriftX_deg`, Y and Z [rad]
  double drift_time = 60;        ///< decay of drifts to 1/e; `driftTime_s` [s]
  double angular_jitter = 0;     ///< unreported turn of each beam; `angularJitter_deg` [rad]
  Vec3 lever_arm_deviation{};    ///< drawn once for all legs; `leverArmX_m`, Y and Z [m]
  Vec3 boresight_deviation{};    ///< drawn once for all legs; `boresightX_deg`, Y and Z [rad]
  double latency_deviation = 0;  ///< of the clock of poses, drawn once for all legs; `latency_s` [s]

  void fields(FieldIo& io) {
    if (io.reads()) *this = {};
    const auto axes = [&io](std::array<const char*, 3> names, Vec3& v, const XmlUnit& unit, double most) {
      for (int k = 0; k < 3; ++k) io.number(names[static_cast<std::size_t>(k)], v[k], unit, 0, most);
    };
    axes({"positionDriftX_m", "positionDriftY_m", "positionDriftZ_m"}, position_drift, units::metre, 1e6);
    axes({"attitudeDriftX_deg", "attitudeDriftY_deg", "attitudeDriftZ_deg"}, attitude_drift, units::small_degree, 180);
    io.number("driftTime_s", drift_time, units::second, 1e-3, 1e9);
    io.number("angularJitter_deg", angular_jitter, units::small_degree, 0, 180);
    axes({"leverArmX_m", "leverArmY_m", "leverArmZ_m"}, lever_arm_deviation, units::metre, 1e6);
    axes({"boresightX_deg", "boresightY_deg", "boresightZ_deg"}, boresight_deviation, units::small_degree, 180);
    io.number("latency_s", latency_deviation, units::second, 0, 1e3);
  }
  bool operator==(const PoseErrorSettings&) const = default;
};

/// `<platform>`, with the overrides of the survey.
struct PlatformSettings {
  std::string id{};                                              ///< `id`
  std::string name{};                                            ///< `name`
  PlatformKind kind = PlatformKind::stationary;                  ///< `type`
  MountSettings mount{};                                         ///< on the body; `<scannerMount>`
  MulticopterDynamics multicopter{};                             ///< multicopter only
  RotationSpec rotation_spec = RotationSpec::arinc_705;          ///< interpolated; `rotationSpec`
  std::array<std::optional<NoiseSettings>, 3> position_noise{};  ///< `<positionXNoise>`... [m]
  std::array<std::optional<NoiseSettings>, 3> attitude_noise{};  ///< `<attitudeXNoise>`... [rad]
  MountErrorSettings mount_error{};                              ///< `<mountError>`
  PoseErrorSettings pose_errors{};                               ///< `<poseErrors>`

  bool operator==(const PlatformSettings&) const = default;
};

/// Random offset of the start of legs: `legRandomOffset`.
struct LegOffsetSettings {
  double mean = 0;         ///< along each axis; `legRandomOffsetMean` [m]
  double deviation = 0.1;  ///< along each axis; `legRandomOffsetStdev` [m]

  void fields(FieldIo& io) {
    io.number("legRandomOffsetMean", mean, units::metre, -1e6, 1e6);
    io.number("legRandomOffsetStdev", deviation, units::metre, 0, 1e6);
  }
  bool operator==(const LegOffsetSettings&) const = default;
};

/// `<survey>`. Overrides (`<FWFSettings>`, `<detectorSettings>`, `<scannerMount>`, noise) are in scanner and platform.
struct SurveySettings {
  std::string name{};                             ///< default: that of the file; `name`
  std::optional<std::uint64_t> seed{};            ///< `seed`
  std::optional<LegOffsetSettings> leg_offset{};  ///< `legRandomOffset`...
  ScannerSettings scanner{};                      ///< `scanner`
  PlatformSettings platform{};                    ///< `platform`, or `basePlatform` if interpolated
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

/// True if a leg only ends the one before it, without pulses: a moving platform's last of several.
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
