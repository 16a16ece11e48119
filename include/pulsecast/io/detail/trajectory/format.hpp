// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TRAJECTORY_FORMAT_HPP
#define PULSECAST_IO_DETAIL_TRAJECTORY_FORMAT_HPP

#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/io/detail/trajectory/attitude.hpp>
#include <pulsecast/io/detail/trajectory/columns.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Place of the column names in a trajectory file.
enum class ColumnNames : std::uint8_t {
  first_line,  ///< in the first line
  comments,    ///< in lines that begin with `#HEADER:` and `#TIME_COLUMN:`
  nowhere,     ///< nowhere, by agreement
};

/// Format of a trajectory file. Names and units: see `trajectory_column`. Lines that begin with # are comments.
struct TrajectoryFormat {
  ColumnNames names = ColumnNames::first_line;  ///< place of the names
  /// Columns to write, in this order, and to read from a file without names.
  std::vector<std::string> columns{"time_s", "x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "heading_deg"};
  std::vector<std::string> left_out{};  ///< columns of the file to ignore
  char separator = ',';          ///< comma, semicolon, tab or blank for writing; found when reading, unless fixed
  bool fixed_separator = false;  ///< true if files to be read must have this separator
  bool more_columns = false;     ///< true if a file may have other columns, which are ignored
  AngleUnit angle_unit = AngleUnit::degree;     ///< unit of angles in columns whose names do not state it
  AngleConvention angles = heading_pitch_roll;  ///< meaning of roll, pitch and yaw
  Axes axes{};                                  ///< axes of x, y, z and of qx, qy, qz

  void validate() const {
    angles.validate();
    if (std::string_view(",;\t ").find(separator) == std::string_view::npos)
      throw SettingError("TrajectoryFormat::separator (character code)", separator, "",
                         "a comma, a semicolon, a tab or a blank");
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (columns[i].find_first_of(separator == ' ' ? ",;\"#\t\r\n " : ",;\"#\t\r\n") != std::string::npos)
        throw SettingError("TrajectoryFormat::columns (index)", static_cast<double>(i), "",
                           "that of a name without separator, quotation mark, # or line end");
    const TrajectoryColumns plan(columns, left_out, angle_unit);
    if (plan.problem().empty()) return;
    if (!plan.culprit())
      throw SettingError("TrajectoryFormat::columns (number)", static_cast<double>(columns.size()), "",
                         "enough for a pose: " + plan.problem());
    const std::size_t i = *plan.culprit();
    throw SettingError("TrajectoryFormat::columns (index)", static_cast<double>(i), "",
                       "that of a valid name: '" + columns[i] + "' " + plan.problem());
  }
};

/// CSV: columns in any order, with names and units in the first line.
[[nodiscard]] inline TrajectoryFormat csv_format() { return {}; }

/// Trajectories that HELIOS++ reads: names and place of the time in comments, angles in degrees. Other columns may be
/// between, if named.
[[nodiscard]] inline TrajectoryFormat helios_format() {
  return {.names = ColumnNames::comments,
          .columns = {"t", "roll", "pitch", "yaw", "x", "y", "z"},
          .more_columns = true,
          .angles = helios_arinc_705};
}

/// Output of HELIOS++ and `TrajectoryWriter`: position, time and angles in degrees, separated by blanks.
[[nodiscard]] inline TrajectoryFormat helios_output_format() {
  return {.names = ColumnNames::nowhere,
          .columns = {"x", "y", "z", "gpsTime", "roll", "pitch", "yaw"},
          .separator = ' ',
          .angles = helios_canonical};
}

/// Time, position and quaternion, separated by blanks, as in the TUM RGB-D benchmark (Sturm et al. 2012). Body axes are
/// a robot's: x forward, y left, z up (ROS REP 103).
[[nodiscard]] inline TrajectoryFormat tum_format() {
  return {.names = ColumnNames::nowhere,
          .columns = {"time", "x", "y", "z", "qx", "qy", "qz", "qw"},
          .separator = ' ',
          .axes = {.body = BodyAxes::forward_left_up}};
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
