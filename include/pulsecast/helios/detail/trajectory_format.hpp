// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_TRAJECTORY_FORMAT_HPP
#define PULSECAST_HELIOS_DETAIL_TRAJECTORY_FORMAT_HPP

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/helios/settings.hpp>
#include <pulsecast/io/trajectory.hpp>

namespace PULSECAST_NAMESPACE::helios::detail {

inline void columns_of(const TrajectorySettings& t, io::TrajectoryFormat& format) {
  std::vector<std::pair<int, const char*>> columns{
      {t.columns->time, "t"}, {t.columns->x, "x"}, {t.columns->y, "y"}, {t.columns->z, "z"}};
  if (!t.position_only)
    columns.insert(columns.end(), {{t.columns->roll, "roll"}, {t.columns->pitch, "pitch"}, {t.columns->yaw, "yaw"}});
  int most = 0;
  for (const auto& [place, name] : columns) most = std::max(most, place);
  format.names = io::ColumnNames::nowhere;
  format.columns.clear();
  for (int i = 0; i <= most; ++i) format.columns.push_back("column_" + std::to_string(i));
  format.left_out = format.columns;
  for (const auto& [place, name] : columns) format.columns[static_cast<std::size_t>(place)] = name;
  std::erase_if(format.left_out,
                [&](const std::string& c) { return std::ranges::find(format.columns, c) == format.columns.end(); });
}

/// Format of the trajectory file of a leg.
[[nodiscard]] inline io::TrajectoryFormat trajectory_format(const TrajectorySettings& t, RotationSpec spec) {
  io::TrajectoryFormat format = io::helios_format();
  format.angles = spec == RotationSpec::canonical ? io::helios_canonical : io::helios_arinc_705;
  format.separator = t.separator.value_or(format.separator);
  format.fixed_separator = t.separator.has_value();
  format.angle_unit = t.angles_in_degrees ? io::AngleUnit::degree : io::AngleUnit::radian;
  if (t.position_only) format.columns = {"t", "x", "y", "z"};
  if (t.columns) columns_of(t, format);
  return format;
}

}  // namespace PULSECAST_NAMESPACE::helios::detail

#endif
