// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SETTINGS_MOUNT_HPP
#define PULSECAST_HELIOS_DETAIL_SETTINGS_MOUNT_HPP

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE::helios {

namespace detail {

/// Refuses an integer less than `least`.
inline void require_at_least(int least, std::string_view field, int value) {
  require_within(field, value, least, std::numeric_limits<int>::max(), "");
}

}  // namespace detail

/// Axis of a rotation: right, forward, up.
enum class Axis : std::uint8_t { x, y, z };

/// One rotation of a list: `<rot>`.
struct AxisTurn {
  Axis axis = Axis::z;  ///< `axis`
  double angle = 0;     ///< right-handed; `angle_deg` [rad]

  bool operator==(const AxisTurn&) const = default;
};

/// Rotations in sequence: the `<rot>` children of an element.
struct RotationList {
  std::vector<AxisTurn> turns{};
  bool local = false;  ///< about the rotating axes instead of the fixed ones; `rotations="local"`

  /// Product of all rotations.
  [[nodiscard]] Rotation rotation() const {
    Rotation all = no_rotation;  // as `extrinsic` and `intrinsic` do, but documents may have many turns
    for (const AxisTurn& turn : turns) {
      require_finite("angle_deg", degrees(turn.angle), "deg");
      const Vec3 about = turn.axis == Axis::x ? axis::right : turn.axis == Axis::y ? axis::forward : axis::up;
      const Rotation next = rotation_about(about, turn.angle);
      all = local ? all * next : next * all;
    }
    return normalize(all);
  }

  bool operator==(const RotationList&) const = default;
};

/// Pose of a device on its carrier: `<scannerMount>`, `<beamOrigin>`.
struct MountSettings {
  Vec3 position{};          ///< in the frame of the carrier; `x`, `y`, `z` [m]
  RotationList rotation{};  ///< from the frame of the device to that of the carrier

  bool operator==(const MountSettings&) const = default;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
