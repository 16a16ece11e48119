// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SETTINGS_LEG_HPP
#define PULSECAST_HELIOS_DETAIL_SETTINGS_LEG_HPP

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>

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
  std::optional<double>
      divergence{};                ///< common value of all channels, default each one's own; `beamDivergence_rad` [rad]
  double trajectory_interval = 0;  ///< interval of trajectory records; 0: none. `trajectoryTimeInterval_s` [s]
  double warm_up = 0;              ///< running time of head and optic before the first pulse; `opticsWarmupPhase_s` [s]

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
  std::optional<std::string> strip{};  ///< legs of one strip share their files; `stripId`
  std::optional<double>
      duration_max{};  ///< upper limit of the leg's duration; `maxDuration_s` of leg or scannerSettings [s]
  LegPlatformSettings platform{};
  LegScannerSettings scanner{};

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

}  // namespace PULSECAST_NAMESPACE::helios

#endif
