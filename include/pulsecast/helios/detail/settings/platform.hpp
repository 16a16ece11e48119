// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SETTINGS_PLATFORM_HPP
#define PULSECAST_HELIOS_DETAIL_SETTINGS_PLATFORM_HPP

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <pulsecast/base/units.hpp>
#include <pulsecast/helios/detail/settings/mount.hpp>

namespace PULSECAST_NAMESPACE::helios {

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

}  // namespace PULSECAST_NAMESPACE::helios

#endif
