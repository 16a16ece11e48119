// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

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

namespace pulsecast {

struct TerrainFollowing {
  double height = 100;  ///< above the ground, at least [m]
  double step = 10;     ///< horizontal distance at which the ground is looked at [m]
  double slope = 0.2;   ///< steepest climb and descent: height by distance

  void validate() const {
    require_finite("TerrainFollowing::height", height, "m");
    require_positive("TerrainFollowing::step", step, "m");
    require_positive("TerrainFollowing::slope", slope, "");
  }
};

/// Follows a line over the ground: `ground(place)` gives its height [m] at a place east and north [m], or nothing where it is not known;
/// there, the last height counts, or else the first one known. Of all paths that keep their height wherever the ground is looked at, and
/// climb no steeper than allowed, it is the lowest. If no ground is known at all, the path is the line's own.
[[nodiscard]] Waypoints plan_terrain_following(const StraightLine& line, const Ground auto& ground, const TerrainFollowing& settings = {}) {
  line.validate(), settings.validate();
  const Vec3 path = line.to - line.from;
  const double distance = std::hypot(path.x, path.y);
  require_within("TerrainFollowing::step (steps)", distance / settings.step, 0, 1e7, "");
  const auto steps = static_cast<std::size_t>(std::ceil(distance / settings.step));
  const double step = steps == 0 ? 0 : distance / static_cast<double>(steps);

  std::vector<Vec3> positions;
  std::optional<double> last;
  std::size_t unknown = 0;  // at the start of the line
  for (std::size_t i = 0; i <= steps; ++i) {
    positions.push_back(steps == 0 ? line.from : line.from + path * (static_cast<double>(i) / static_cast<double>(steps)));
    const std::optional<double> here = ground(Vec2{positions[i].x, positions[i].y});
    if (here) last = here;
    if (last)
      positions[i].z = *last + settings.height;
    else
      ++unknown;
  }
  if (!last) return Waypoints(at_constant_speed({line.from, line.to}, line.speed));
  for (std::size_t i = unknown; i-- > 0;) positions[i].z = positions[unknown].z;

  const double climb = settings.slope * step;  // from one position to the next
  for (std::size_t i = 1; i <= steps; ++i) positions[i].z = std::max(positions[i].z, positions[i - 1].z - climb);
  for (std::size_t i = steps; i-- > 0;) positions[i].z = std::max(positions[i].z, positions[i + 1].z - climb);
  return Waypoints(at_constant_speed(positions, line.speed));
}

}  // namespace pulsecast
