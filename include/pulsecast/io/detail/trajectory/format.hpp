// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/io/detail/trajectory/attitude.hpp>
#include <pulsecast/io/detail/trajectory/columns.hpp>

namespace pulsecast::io {

/// Where a trajectory file names its columns.
enum class ColumnNames : std::uint8_t {
  first_line,  ///< in its first line
  comments,    ///< in lines that begin with `#HEADER:` and `#TIME_COLUMN:`
  nowhere,     ///< they are agreed
};

/// How a trajectory file speaks; the same for reading and writing. `trajectory_column` tells what names and units there are. Lines that
/// begin with # are comments.
struct TrajectoryFormat {
  ColumnNames names = ColumnNames::first_line;  ///< where they stand
  /// What is written, in this order; and what is read from a file that does not name its columns.
  std::vector<std::string> columns{"time_s", "x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "heading_deg"};
  std::vector<std::string> left_out{};       ///< columns of the file that are no matter
  char separator = ',';                      ///< comma, semicolon, tab or blank when writing; when reading it is found, unless fixed
  bool fixed_separator = false;              ///< whether files that are read must have that one
  bool more_columns = false;                 ///< whether a file may have columns of other names, or beyond those named, which do not count
  AngleUnit angle_unit = AngleUnit::degree;  ///< of angles in columns whose names do not say it
  AngleConvention angles = heading_pitch_roll;  ///< what roll, pitch and yaw mean
  Axes axes{};                                  ///< of x, y, z and of qx, qy, qz

  void validate() const {
    angles.validate();
    if (std::string_view(",;\t ").find(separator) == std::string_view::npos)
      throw SettingError("TrajectoryFormat::separator (its code)", separator, "", "a comma, a semicolon, a tab or a blank");
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (columns[i].find_first_of(separator == ' ' ? ",;\"#\t\r\n " : ",;\"#\t\r\n") != std::string::npos)
        throw SettingError("TrajectoryFormat::columns (place)", static_cast<double>(i), "",
                           "that of a name without separators, quotation marks, # and line ends");
    const TrajectoryColumns plan(columns, left_out, angle_unit);
    if (plan.problem().empty()) return;
    if (!plan.culprit())
      throw SettingError("TrajectoryFormat::columns (number)", static_cast<double>(columns.size()), "", "whole: " + plan.problem());
    const std::size_t i = *plan.culprit();
    throw SettingError("TrajectoryFormat::columns (place)", static_cast<double>(i), "",
                       "that of another name: '" + columns[i] + "' " + plan.problem());
  }
};

/// Columns that are named, with units, in the first line, in any order.
[[nodiscard]] inline TrajectoryFormat csv_format() { return {}; }

/// What HELIOS++ reads: names and the place of the time in comments, angles in degrees. Other columns may stand between, if they are named.
[[nodiscard]] inline TrajectoryFormat helios_format() {
  return {.names = ColumnNames::comments,
          .columns = {"t", "roll", "pitch", "yaw", "x", "y", "z"},
          .more_columns = true,
          .angles = helios_arinc_705};
}

/// What HELIOS++ and `TrajectoryWriter` write: position, time and angles in degrees, with blanks between them.
[[nodiscard]] inline TrajectoryFormat helios_output_format() {
  return {.names = ColumnNames::nowhere,
          .columns = {"x", "y", "z", "gpsTime", "roll", "pitch", "yaw"},
          .separator = ' ',
          .angles = helios_canonical};
}

/// Time, position and quaternion with blanks between them, as in the TUM RGB-D benchmark (Sturm et al. 2012). The body is a robot's: x is
/// forward, y left and z up (ROS REP 103).
[[nodiscard]] inline TrajectoryFormat tum_format() {
  return {.names = ColumnNames::nowhere,
          .columns = {"time", "x", "y", "z", "qx", "qy", "qz", "qw"},
          .separator = ' ',
          .axes = {.body = BodyAxes::forward_left_up}};
}

}  // namespace pulsecast::io
