// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <pulsecast/base/units.hpp>
#include <pulsecast/helios/detail/settings/mount.hpp>

namespace pulsecast::helios {

enum class PlatformKind : std::uint8_t {
  stationary,      ///< `type="static"`
  linear_path,     ///< `type="linearpath"`
  multicopter,     ///< `type="multicopter"`
  ground_vehicle,  ///< `type="groundvehicle"`
  interpolated,    ///< `platform="interpolated"`: as its trajectory says
};

/// What roll, pitch and yaw of a trajectory mean: `rotationSpec`.
enum class RotationSpec : std::uint8_t {
  arinc_705,  ///< `ARINC 705`
  canonical,  ///< `CANONICAL`
};

/// How a multicopter flies.
struct MulticopterDynamics {
  double yaw_speed = radians(85.94);  ///< at most; `yaw_speed_deg` [rad/s]
  double pitch_offset = radians(35);  ///< by which it leans at most; `pitch_offset_deg` [rad]

  bool operator==(const MulticopterDynamics&) const = default;
};

enum class NoiseDistribution : std::uint8_t {
  normal,   ///< `type="NORMAL"`
  uniform,  ///< `type="UNIFORM"`
};

/// A random number that is added at each pulse: `<positionXNoise>`...
struct NoiseSettings {
  NoiseDistribution distribution = NoiseDistribution::normal;  ///< `type`
  double mean = 0;                                             ///< of the normal one; `mean` [m] or [rad]
  double deviation = 1;                                        ///< of the normal one; `stdev` [m] or [rad]
  double low = 0;                                              ///< of the uniform one; `min` [m] or [rad]
  double high = 1;                                             ///< of the uniform one; `max` [m] or [rad]
  bool clipped = false;                                        ///< `clipEnabled`
  double clip_low = 0;                                         ///< `clipMin` [m] or [rad]
  double clip_high = 1;                                        ///< `clipMax` [m] or [rad]
  int lifespan = 1;                                            ///< for how many pulses each number is used, 0 for all; `fixedLifespan`

  void validate() const { detail::require_at_least(0, "fixedLifespan", lifespan); }

  bool operator==(const NoiseSettings&) const = default;
};

/// `<platform>`, with what the survey sets of it.
struct PlatformSettings {
  std::string id{};                                              ///< `id`
  std::string name{};                                            ///< `name`
  PlatformKind kind = PlatformKind::stationary;                  ///< `type`
  MountSettings mount{};                                         ///< of the instrument on the body; `<scannerMount>`
  MulticopterDynamics multicopter{};                             ///< of the multicopter
  RotationSpec rotation_spec = RotationSpec::arinc_705;          ///< of the interpolated one; `rotationSpec`
  std::array<std::optional<NoiseSettings>, 3> position_noise{};  ///< `<positionXNoise>`, Y and Z [m]
  std::array<std::optional<NoiseSettings>, 3> attitude_noise{};  ///< `<attitudeXNoise>`, Y and Z [rad]

  void validate() const {
    for (const auto* noises : {&position_noise, &attitude_noise})
      for (const std::optional<NoiseSettings>& noise : *noises)
        if (noise) noise->validate();
  }

  bool operator==(const PlatformSettings&) const = default;
};

}  // namespace pulsecast::helios
