// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_TERRAIN_FOLLOWING_HPP
#define PULSECAST_PLATFORM_TERRAIN_FOLLOWING_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/waypoints.hpp>

namespace PULSECAST_NAMESPACE {

/// Limits of a flight at a height above the ground.
struct TerrainFollowing {
  double height = 100;  ///< minimum height above the ground [m]
  double step = 10;     ///< horizontal distance between ground queries [m]
  double slope = 0.2;   ///< steepest climb and descent: height by distance

  void validate() const {
    require_finite("TerrainFollowing::height", height, "m");
    require_positive("TerrainFollowing::step", step, "m");
    require_positive("TerrainFollowing::slope", slope, "");
  }
};

/// Plans a path over the ground along a line: `ground(place)` gives the height [m] at a place east and north [m], or
/// nothing where unknown; there the last known height counts, or else the first one. The path is the lowest that keeps
/// its height at every query and its slope within the limit. Without any known ground it is the line itself. Throws a
/// `SettingError`.
[[nodiscard]] Waypoints plan_terrain_following(const StraightLine& line, const Ground auto& ground,
                                               const TerrainFollowing& settings = {}) {
  line.validate();
  settings.validate();
  const Vec3 path = line.to - line.from;
  const double distance = std::hypot(path.x, path.y);
  require_within("TerrainFollowing::step (steps)", distance / settings.step, 0, 1e7, "");
  const auto steps = static_cast<std::size_t>(std::ceil(distance / settings.step));
  const double step = steps == 0 ? 0 : distance / static_cast<double>(steps);

  std::vector<Vec3> positions;
  std::optional<double> last;
  std::size_t unknown = 0;  // queries at the start of the line
  for (std::size_t i = 0; i <= steps; ++i) {
    positions.push_back(steps == 0 ? line.from
                                   : line.from + path * (static_cast<double>(i) / static_cast<double>(steps)));
    const std::optional<double> here = ground(Vec2{positions[i].x, positions[i].y});
    if (here) last = here;
    if (last)
      positions[i].z = *last + settings.height;
    else
      ++unknown;
  }
  if (!last) return Waypoints(at_constant_speed({line.from, line.to}, line.speed));
  for (std::size_t i = unknown; i-- > 0;) positions[i].z = positions[unknown].z;

  const double climb = settings.slope * step;  // largest height difference from one position to the next [m]
  for (std::size_t i = 1; i <= steps; ++i) positions[i].z = std::max(positions[i].z, positions[i - 1].z - climb);
  for (std::size_t i = steps; i-- > 0;) positions[i].z = std::max(positions[i].z, positions[i + 1].z - climb);
  return Waypoints(at_constant_speed(positions, line.speed));
}

}  // namespace PULSECAST_NAMESPACE

#endif
