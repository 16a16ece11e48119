// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PLATFORM_BLOCK_FLIGHT_HPP
#define PULSECAST_PLATFORM_BLOCK_FLIGHT_HPP

#include <pulsecast/platform/straight_line.hpp>

namespace PULSECAST_NAMESPACE {

/// Parallel flight lines over an area, flown in alternating directions.
struct BlockFlight {
  Box area{};             ///< area to cover, seen from above; z of its corners is ignored [m]
  double altitude = 500;  ///< altitude of the lines: z in the world [m]
  double swath = 300;     ///< width on the ground covered by one line [m]
  double overlap = 0.3;   ///< share of the swath common to neighbouring lines, in [0, 0.99]
  double heading = 0;     ///< heading of the first line, clockwise from north [rad]
  double speed = 60;      ///< ground speed [m/s]
  double run_in = 0;      ///< extension of each line before and after the area [m]

  void validate() const {
    for (const double side : {area.size().x, area.size().y})
      if (!(side >= 0)) throw SettingError("BlockFlight::area (side)", side, "m", "at least 0");
    require_finite("BlockFlight::area (size)", std::hypot(area.size().x, area.size().y), "m");
    require_finite("BlockFlight::altitude", altitude, "m");
    require_positive("BlockFlight::swath", swath, "m");
    require_within("BlockFlight::overlap", overlap, 0, 0.99, "");
    require_angle("BlockFlight::heading", heading);
    require_positive("BlockFlight::speed", speed, "m/s");
    require_finite("BlockFlight::run_in", run_in, "m");
  }
};

/// Lines of a block flight, from left to right as seen along the first line. Together their swaths
/// cover the area, with equal margins on both sides. Throws a `SettingError`.
[[nodiscard]] inline std::vector<StraightLine> plan_block_flight(const BlockFlight& block) {
  block.validate();
  const Vec3 along{std::sin(block.heading), std::cos(block.heading), 0}, across{along.y, -along.x, 0};
  const Vec3 size = block.area.size();
  const double length_along = size.x * std::fabs(along.x) + size.y * std::fabs(along.y) + 2 * block.run_in;
  const double width = size.x * std::fabs(across.x) + size.y * std::fabs(across.y);
  const double spacing = block.swath * (1 - block.overlap);
  require_within("BlockFlight::swath (lines)", width / spacing, 0, 65534, "");  // of legs
  // the swaths of n lines cover (n - 1) spacings and one swath; rounding must not add a line
  const auto lines = 1 + static_cast<std::size_t>(std::ceil(std::max(0.0, (width - block.swath) / spacing - 1e-9)));
  const Vec3 centre{block.area.centre().x, block.area.centre().y, block.altitude};

  std::vector<StraightLine> all;
  for (std::size_t k = 0; k < lines; ++k) {
    const Vec3 middle = centre + across * (spacing * (static_cast<double>(k) - 0.5 * static_cast<double>(lines - 1)));
    StraightLine line{middle - along * (0.5 * length_along), middle + along * (0.5 * length_along), block.speed};
    if (k % 2 == 1) std::swap(line.from, line.to);
    all.push_back(line);
  }
  return all;
}

}  // namespace PULSECAST_NAMESPACE

#endif
