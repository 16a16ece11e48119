// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TRAJECTORY_RULES_HPP
#define PULSECAST_IO_DETAIL_TRAJECTORY_RULES_HPP

#include <pulsecast/base/units.hpp>
#include <pulsecast/io/format_rules.hpp>

/// Columns, units and headers of trajectory files.
namespace PULSECAST_NAMESPACE::io {

/// Content of a column of a trajectory file.
enum class Quantity { time, x, y, z, east, north, up, down, roll, pitch, yaw, qx, qy, qz, qw, longitude, latitude };

namespace detail {

/// Names of the columns of each quantity, in the order of `Quantity`; the first is preferred.
inline constexpr std::array<FormatRule, 17> column_rules{{
    {"time t gps_time gpstime timestamp tow sow", FormatUse::read, "time"},
    {"x tx p_rs_r_x", FormatUse::read, "position along x"},
    {"y ty p_rs_r_y", FormatUse::read, "position along y"},
    {"z tz p_rs_r_z", FormatUse::read, "position along z"},
    {"east easting", FormatUse::read, "position east"},
    {"north northing", FormatUse::read, "position north"},
    {"up height altitude h_ell h_msl", FormatUse::read, "height; a word may precede height"},
    {"down", FormatUse::read, "height, downwards"},
    {"roll", FormatUse::read, "first angle of the convention that the survey or format names"},
    {"pitch", FormatUse::read, "second angle of it"},
    {"yaw heading", FormatUse::read, "third angle of it"},
    {"qx q_x q_rs_x", FormatUse::read, "quaternion from the body to the world, x"},
    {"qy q_y q_rs_y", FormatUse::read, "quaternion, y"},
    {"qz q_z q_rs_z", FormatUse::read, "quaternion, z"},
    {"qw q_w q_rs_w", FormatUse::read, "quaternion, w"},
    {"longitude lon", FormatUse::read, "place on a map that is given, unless there are metres, too"},
    {"latitude lat", FormatUse::read, "the same"},
}};

enum class Dimension : std::uint8_t { time, length, angle, number };

struct Unit {
  FormatRule rule;  ///< its name in brackets
  Dimension dimension;
  double per_si;

  [[nodiscard]] constexpr std::string_view name() const noexcept { return rule.name.substr(1, rule.name.size() - 2); }
};

inline constexpr auto units = std::to_array<Unit>({
    {{"[s]", FormatUse::read, "seconds"}, Dimension::time, 1},
    {{"[sec]", FormatUse::read, "seconds"}, Dimension::time, 1},
    {{"[ms]", FormatUse::read, "milliseconds"}, Dimension::time, 1e3},
    {{"[us]", FormatUse::read, "microseconds"}, Dimension::time, 1e6},
    {{"[ns]", FormatUse::read, "nanoseconds"}, Dimension::time, 1e9},
    {{"[m]", FormatUse::read, "metres"}, Dimension::length, 1},
    {{"[cm]", FormatUse::read, "centimetres"}, Dimension::length, 1e2},
    {{"[mm]", FormatUse::read, "millimetres"}, Dimension::length, 1e3},
    {{"[km]", FormatUse::read, "kilometres"}, Dimension::length, 1e-3},
    {{"[deg]", FormatUse::read, "degrees"}, Dimension::angle, degrees(1)},
    {{"[rad]", FormatUse::read, "radians"}, Dimension::angle, 1},
});

/// Other items. Columns that are refused are left out of files whose others make a whole pose.
inline constexpr auto other_rules = std::to_array<FormatRule>({
    {"[f*", FormatUse::refused, "metres: feet are international ones or those of the US survey"},
    {"[us*", FormatUse::refused, "metres, not feet of the US survey"},
    {"lat*", FormatUse::refused, "a column named latitude_deg or latitude_rad"},
    {"lon*", FormatUse::refused, "a column named longitude_deg or longitude_rad"},
    {"omega*, phi*, kappa*", FormatUse::refused, "roll, pitch and yaw, not the angles of photogrammetry"},
    {"roll*", FormatUse::refused, "a column named roll_deg or roll_rad"},
    {"pitch*", FormatUse::refused, "a column named pitch_deg or pitch_rad"},
    {"yaw*", FormatUse::refused, "a column named yaw_deg or yaw_rad"},
    {"heading*", FormatUse::refused, "a column named heading_deg or heading_rad"},
    {"azimuth*", FormatUse::refused, "a column named heading_deg, if it is the heading of the platform"},
    {"#HEADER:", FormatUse::read, "names of the columns, with commas between"},
    {"#TIME_COLUMN:", FormatUse::read, "place of the time, from 0"},
    {"*", FormatUse::noted, "unknown columns are left out"},
});

/// Rules of trajectory files: columns, units in brackets, and lines that begin with `#`.
inline constexpr auto trajectory_rules = [] {
  std::array<FormatRule, column_rules.size() + units.size() + other_rules.size()> all{};
  auto end = std::ranges::copy(column_rules, all.begin()).out;
  for (const Unit& unit : units) *end++ = unit.rule;
  std::ranges::copy(other_rules, end);
  return all;
}();

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE::io

#endif
