// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SETTINGS_MOUNT_HPP
#define PULSECAST_HELIOS_DETAIL_SETTINGS_MOUNT_HPP

#include <pulsecast/helios/detail/settings/fields.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Axis of a rotation: right, forward, up.
enum class Axis : std::uint8_t { x, y, z };

/// One rotation of a list: `<rot>`.
struct AxisTurn {
  Axis axis = Axis::z;  ///< `axis`
  double angle = 0;     ///< right-handed; `angle_deg` [rad]

  void fields(FieldIo& io) {
    io.require({"axis", "angle_deg"});
    io.choice("axis", axis, {{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}});
    io.number("angle_deg", angle, units::degree, -36000, 36000);
    if (looks_like_radians(angle, false))
      io.warn("angle_deg",
              "angle_deg is " + xml_number(units::degree.number(angle)) + ": given in radians, not degrees?");
  }
  bool operator==(const AxisTurn&) const = default;
};

/// Rotations in sequence: the `<rot>` children of an element.
struct RotationList {
  std::vector<AxisTurn> turns{};
  bool local = false;  ///< about the rotating axes instead of the fixed ones; `rotations="local"`

  /// Product of all rotations.
  [[nodiscard]] Rotation rotation() const {
    Rotation all = no_rotation;  // not `extrinsic`: documents may have many turns
    const std::array axes{axis::right, axis::forward, axis::up};
    for (const AxisTurn& turn : turns) {
      require_finite("angle_deg", degrees(turn.angle), "deg");
      const Rotation next = rotation_about(axes[static_cast<std::size_t>(turn.axis)], turn.angle);
      all = local ? all * next : next * all;
    }
    return normalize(all);
  }

  void fields(FieldIo& io) {
    io.choice("rotations", local, {{"global", false}, {"local", true}});
    io.children("rot", turns);
  }
  bool operator==(const RotationList&) const = default;
};

/// Pose of a device on its carrier: `<scannerMount>`, `<beamOrigin>`.
struct MountSettings {
  Vec3 position{};          ///< in the frame of the carrier; `x`, `y`, `z` [m]
  RotationList rotation{};  ///< from the frame of the device to that of the carrier

  void fields(FieldIo& io) {
    if (io.reads()) *this = {};
    io.components(position);
    rotation.fields(io);
  }
  bool operator==(const MountSettings&) const = default;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
