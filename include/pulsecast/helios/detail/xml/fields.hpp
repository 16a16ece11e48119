// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_FIELDS_HPP
#define PULSECAST_HELIOS_DETAIL_XML_FIELDS_HPP

#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/detail/xml/output.hpp>
#include <pulsecast/helios/settings.hpp>

/// Elements, in the format of HELIOS++: what the tables of settings cannot say.
namespace PULSECAST_NAMESPACE::helios::xml {

/// Reads or writes settings that their table says all of.
template <class Settings>
void fields(FieldIo& io, Settings& settings) {
  settings.fields(io);
}

/// The element that is read, or written.
[[nodiscard]] inline XmlInput& input(FieldIo& io) { return static_cast<XmlInput&>(io); }
[[nodiscard]] inline XmlOutput& output(FieldIo& io) { return static_cast<XmlOutput&>(io); }

/// Reports the `SettingError` of a check; that of a writer is the fault itself.
template <class Check>
void valid(const FieldIo& io, const Check& check) {
  if (!io.reads()) return check();
  try {
    check();
  } catch (const SettingError& wrong) {
    io.fault("", wrong.what());
  }
}

/// Six noise elements and the errors of mount and poses, of a platform or of a survey; a later one replaces an earlier
/// one.
inline void noise_fields(FieldIo& io, PlatformSettings& platform) {
  static constexpr std::array position{"positionXNoise", "positionYNoise", "positionZNoise"};
  static constexpr std::array attitude{"attitudeXNoise", "attitudeYNoise", "attitudeZNoise"};
  const auto one = [&](const char* name, std::optional<NoiseSettings>& noise) {
    if (io.reads() || noise)
      io.element(name, [&](FieldIo& inner) { (io.reads() ? noise.emplace() : *noise).fields(inner); });
  };
  for (std::size_t i = 0; i < 3; ++i) one(position[i], platform.position_noise[i]);
  for (std::size_t i = 0; i < 3; ++i) {
    one(attitude[i], platform.attitude_noise[i]);
    if (const auto& noise = platform.attitude_noise[i])
      ask_for_degrees(io, attitude[i],
                      noise->distribution == NoiseDistribution::normal
                          ? std::max(std::fabs(noise->mean), noise->deviation)
                          : std::max(std::fabs(noise->low), std::fabs(noise->high)),
                      units::small_degree);
  }
  if (io.reads() || platform.mount_error != MountErrorSettings{})
    io.element("mountError", [&](FieldIo& inner) { platform.mount_error.fields(inner); });
  if (io.reads() || platform.pose_errors != PoseErrorSettings{})
    io.element("poseErrors", [&](FieldIo& inner) { platform.pose_errors.fields(inner); });
}

/// Convention of angles, of an interpolated platform.
inline void rotation_spec(FieldIo& io, RotationSpec& spec) {
  io.choice("rotationSpec", spec, {{"ARINC 705", RotationSpec::arinc_705}, {"CANONICAL", RotationSpec::canonical}});
}

inline void fields(FieldIo& io, PlatformSettings& platform) {
  io.require({"id", "type"});
  io.text("id", platform.id);
  io.text("name", platform.name);
  using enum PlatformKind;
  PlatformKind kind = platform.kind;
  if (!io.reads() && kind == interpolated) kind = stationary;  // its base has no effect
  io.choice("type", kind,
            {{"static", stationary},
             {"linearpath", linear_path},
             {"multicopter", multicopter},
             {"groundvehicle", ground_vehicle}});
  if (io.reads()) platform.kind = kind;
  io.element("scannerMount", [&](FieldIo& inner) { platform.mount.fields(inner); });
  noise_fields(io, platform);
  if (platform.kind == multicopter)
    platform.multicopter.fields(io);
  else
    io.without_effect({"yaw_speed_deg", "pitch_offset_deg"}, "has no effect with this type of platform");
  io.without_effect({"drag", "engine_max_force", "speedup_magnitude", "slowdown_magnitude", "slowdown_distance",
                     "pitch_speed_deg", "roll_speed_deg", "roll_offset_deg", "base_pitch_deg"},
                    "has no effect: paths are planned by speed and acceleration");
}

}  // namespace PULSECAST_NAMESPACE::helios::xml

#endif
