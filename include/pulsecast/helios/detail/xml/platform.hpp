// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_PLATFORM_HPP
#define PULSECAST_HELIOS_DETAIL_XML_PLATFORM_HPP

#include <array>
#include <cstddef>

#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>
#include <pulsecast/helios/settings.hpp>

/// `<platform>` and its children.
namespace PULSECAST_NAMESPACE::helios::xml {

template <class Io>
void fields(Io& io, Of<Io, NoiseSettings>& noise) {
  io.choice("type", noise.distribution,
            {{"NORMAL", NoiseDistribution::normal}, {"UNIFORM", NoiseDistribution::uniform}});
  io.number("mean", noise.mean, units::one, -1e6, 1e6);
  io.number("stdev", noise.deviation, units::one, 0, 1e6);
  io.number("min", noise.low, units::one, -1e6, 1e6);
  io.number("max", noise.high, units::one, -1e6, 1e6);
  io.flag("clipEnabled", noise.clipped);
  io.number("clipMin", noise.clip_low, units::one, -1e6, 1e6);
  io.number("clipMax", noise.clip_high, units::one, -1e6, 1e6);
  io.whole("fixedLifespan", noise.lifespan, 0, 1'000'000'000);
  if (noise.distribution == NoiseDistribution::uniform && !(noise.low <= noise.high))
    io.fault("max", "max is below min");
  if (noise.clipped && !(noise.clip_low <= noise.clip_high)) io.fault("clipMax", "clipMax is below clipMin");
}

/// Six noise elements, of a platform or of a survey; a later one replaces an earlier one.
template <class Io>
void noise_fields(Io& io, Of<Io, PlatformSettings>& platform) {
  static constexpr std::array position{"positionXNoise", "positionYNoise", "positionZNoise"};
  static constexpr std::array attitude{"attitudeXNoise", "attitudeYNoise", "attitudeZNoise"};
  const auto one = [&](const char* name, auto& noise) {
    if constexpr (Io::reads) {
      io.child(name, [&](auto& inner) { fields(inner, noise.emplace()); });
    } else {
      if (noise) io.child(name, [&](auto& inner) { fields(inner, *noise); });
    }
  };
  for (std::size_t i = 0; i < 3; ++i) one(position[i], platform.position_noise[i]);
  for (std::size_t i = 0; i < 3; ++i) one(attitude[i], platform.attitude_noise[i]);
}

template <class Io>
void fields(Io& io, Of<Io, MulticopterDynamics>& copter) {
  io.number("yaw_speed_deg", copter.yaw_speed, units::degree, 0, 1e5);
  io.number("pitch_offset_deg", copter.pitch_offset, units::degree, 0, 90);
}

template <class Io>
void fields(Io& io, Of<Io, PlatformSettings>& platform) {
  io.require({"id", "type"});
  io.text("id", platform.id);
  io.text("name", platform.name);
  PlatformKind kind = platform.kind;
  if (!Io::reads && kind == PlatformKind::interpolated) kind = PlatformKind::stationary;  // its base has no effect
  io.choice("type", kind,
            {{"static", PlatformKind::stationary},
             {"linearpath", PlatformKind::linear_path},
             {"multicopter", PlatformKind::multicopter},
             {"groundvehicle", PlatformKind::ground_vehicle}});
  if constexpr (Io::reads) platform.kind = kind;
  io.child("scannerMount", [&](auto& inner) { fields(inner, platform.mount); });
  noise_fields(io, platform);
  if (platform.kind == PlatformKind::multicopter)
    fields(io, platform.multicopter);
  else
    io.without_effect({"yaw_speed_deg", "pitch_offset_deg"}, "has no effect with this type of platform");
  io.without_effect({"drag", "engine_max_force", "speedup_magnitude", "slowdown_magnitude", "slowdown_distance",
                     "pitch_speed_deg", "roll_speed_deg", "roll_offset_deg", "base_pitch_deg"},
                    "has no effect: paths are planned by speed and acceleration");
}

}  // namespace PULSECAST_NAMESPACE::helios::xml

#endif
