// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TRAJECTORY_FORMAT_HPP
#define PULSECAST_IO_DETAIL_TRAJECTORY_FORMAT_HPP

#include <set>

#include <pulsecast/base/suggestion.hpp>
#include <pulsecast/io/detail/trajectory/attitude.hpp>
#include <pulsecast/io/detail/trajectory/rules.hpp>
#include <pulsecast/io/spatial_reference.hpp>

/// Columns of trajectory files, their names and units, and formats.
namespace PULSECAST_NAMESPACE::io {

/// Value of each quantity in SI units; 0 if not set.
struct QuantityValues {
  std::array<double, 17> values{};  ///< [s, m, rad or 1]

  [[nodiscard]] double& operator[](Quantity of) noexcept { return values[static_cast<std::size_t>(of)]; }
  [[nodiscard]] double operator[](Quantity of) const noexcept { return values[static_cast<std::size_t>(of)]; }
};

/// Unit of angles in columns whose names do not state it.
enum class AngleUnit : std::uint8_t { degree, radian };

/// Content and unit of a column, from its name.
struct TrajectoryColumn {
  Quantity quantity{};  ///< content
  double per_si = 1;    ///< number of its units in a second, metre or radian
};

namespace detail {

/// Calls `visit` with each name and its quantity.
void each_quantity_name(const auto& visit) {
  for (std::size_t i = 0; i < column_rules.size(); ++i)
    for (std::string_view left = column_rules[i].name; !left.empty();)
      visit(text::take_word(left), static_cast<Quantity>(i));
}

[[nodiscard]] constexpr Dimension dimension_of(Quantity quantity) noexcept {
  if (quantity == Quantity::time) return Dimension::time;
  if (quantity <= Quantity::down) return Dimension::length;
  return quantity <= Quantity::yaw || quantity >= Quantity::longitude ? Dimension::angle : Dimension::number;
}

/// Normal form of a name: small letters, an underscore for each run of others, as in "roll_deg".
[[nodiscard]] inline std::string plain(std::string_view name) {
  std::string result;
  for (const char c : text::lower(name)) {
    const bool counts = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (counts)
      result += c;
    else if (!result.empty() && result.back() != '_')
      result += '_';
  }
  if (result.ends_with('_')) result.pop_back();
  return result;
}

}  // namespace detail

/// Column of a name; empty if unknown. A unit may follow: `time_s`, `Roll [deg]`; without one,
/// times are in seconds and lengths in metres. A word may precede a height: `Ellipsoid height`.
[[nodiscard]] inline std::optional<TrajectoryColumn> trajectory_column(std::string_view name, AngleUnit angles) {
  const std::string whole = detail::plain(name);
  std::optional<TrajectoryColumn> column;
  detail::each_quantity_name([&](std::string_view known, Quantity quantity) {
    if (column || !whole.starts_with(known)) return;
    const detail::Dimension dimension = detail::dimension_of(quantity);
    const std::string_view unit = std::string_view(whole).substr(known.size());
    const bool in_degrees = dimension == detail::Dimension::angle && angles == AngleUnit::degree;
    if (unit.empty()) column = {quantity, in_degrees ? degrees(1) : 1};
    for (const detail::Unit& u : detail::units)
      if (u.dimension == dimension && unit.starts_with('_') && u.name() == unit.substr(1))
        column = {quantity, u.per_si};
  });
  const std::size_t height = whole.rfind("_height");
  if (column || height == whole.npos) return column;
  return trajectory_column(std::string_view(whole).substr(height + 1), angles);
}

/// Known column name nearest to an unknown one.
[[nodiscard]] inline std::string nearest_trajectory_column(std::string_view name) {
  const std::string whole = detail::plain(name.substr(0, 64));
  std::vector<std::string> names;
  detail::each_quantity_name([&](std::string_view known, Quantity quantity) {
    names.emplace_back(known);
    for (const detail::Unit& unit : detail::units)
      if (unit.dimension == detail::dimension_of(quantity)) names.push_back(text::message(known, '_', unit.name()));
  });
  return std::string(text::nearest_name(whole, names).name);
}

/// Assignment of quantities to columns.
class TrajectoryColumns {
 public:
  /// `names` in the order of the columns; those in `left_out` are ignored, and with `more` all unknown ones.
  TrajectoryColumns(const std::vector<std::string>& names, const std::vector<std::string>& left_out, AngleUnit angles,
                    bool more = false) {
    std::set<std::string> out;
    for (const std::string& name : left_out) out.insert(detail::plain(name));
    for (std::size_t i = 0; i < names.size() && problem_.empty(); ++i) {
      const bool is_out = out.contains(detail::plain(names[i]));
      columns_.push_back(is_out ? std::nullopt : trajectory_column(names[i], angles));
      if (columns_.back()) put(i);
      if (columns_.back() || is_out) continue;
      unknown_.push_back(i);
      if (!more)
        blame(i, "is not a known column: did you mean '", nearest_trajectory_column(names[i]),
              "'? Others must be set as left out");
    }
    using enum Quantity;
    const bool is_placed = count({x, y, z}) == 3 || count({east, north}) == 2;
    for (const Quantity degrees : {longitude, latitude})
      if (more && is_placed && has(degrees)) leave_out(degrees);
    std::ranges::sort(unknown_);
    if (problem_.empty()) require_whole();
  }

  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }  ///< or empty

  /// Column of the problem, from 0; empty if it concerns all.
  [[nodiscard]] std::optional<std::size_t> culprit() const noexcept { return culprit_; }

  /// Columns that are neither known nor left out, from 0.
  [[nodiscard]] const std::vector<std::size_t>& unknown() const noexcept { return unknown_; }

  /// Columns in the order of the file; empty for ignored ones.
  [[nodiscard]] const std::vector<std::optional<TrajectoryColumn>>& all() const noexcept { return columns_; }

  [[nodiscard]] bool has(Quantity quantity) const noexcept {
    return places_[static_cast<std::size_t>(quantity)].has_value();
  }

  [[nodiscard]] bool has_attitude() const {
    using enum Quantity;
    return has(qw) || count({roll, pitch, yaw}) == 3;
  }

 private:
  void put(std::size_t i) {
    std::optional<std::size_t>& place = places_[static_cast<std::size_t>(columns_[i]->quantity)];
    if (place)
      blame(i, "duplicates column ", *place + 1,
            ": expected one of them, the other set as left out, or columns by number, as with zIndex of a "
            "survey");
    place = i;
  }

  void leave_out(Quantity quantity) {
    std::optional<std::size_t>& place = places_[static_cast<std::size_t>(quantity)];
    columns_[*place].reset();
    unknown_.push_back(*place);
    place.reset();
  }

  void blame(std::size_t column, const auto&... problem) {
    problem_ = text::message(problem...);
    culprit_ = column;
  }

  /// Requires a time, one whole position, and at most one attitude.
  void require_whole() {
    using enum Quantity;
    const int xyz = count({x, y, z}), directions = count({east, north}) + count({longitude, latitude}),
              vertical = count({up, down}), degrees = count({longitude, latitude}), angles = count({roll, pitch, yaw}),
              quaternion = count({qx, qy, qz, qw});
    if (!has(time))
      problem_ = "no column is the time: expected one named 'time_s'";
    else if (!(xyz == 3 && directions + vertical == 0) &&
             !(xyz == 0 && directions == 2 && vertical == 1 && degrees != 1))
      problem_ =
          "the columns do not define one position: expected either x, y, z or east, north (or latitude, longitude, to "
          "be projected) and up or down";
    else if (quaternion > 0 && (quaternion < 4 || angles > 0))
      problem_ =
          "the columns do not define one attitude: expected either angles or qx, qy, qz and qw, the others "
          "set as left out";
  }

  [[nodiscard]] int count(std::initializer_list<Quantity> quantities) const {
    return static_cast<int>(std::ranges::count_if(quantities, [&](Quantity q) { return has(q); }));
  }

  std::vector<std::optional<TrajectoryColumn>> columns_;
  std::array<std::optional<std::size_t>, std::tuple_size_v<decltype(QuantityValues::values)>> places_{};
  std::vector<std::size_t> unknown_;
  std::string problem_;
  std::optional<std::size_t> culprit_;
};

/// Place of the column names in a trajectory file.
enum class ColumnNames : std::uint8_t {
  first_line,  ///< in the first line
  comments,    ///< in lines that begin with `#HEADER:` and `#TIME_COLUMN:`
  nowhere,     ///< nowhere, by agreement
};

/// Format of a trajectory file. Names: `trajectory_column`. Lines that begin with # are comments.
struct TrajectoryFormat {
  ColumnNames names = ColumnNames::first_line;  ///< place of the names
  /// Columns to write, in this order, and to read from a file without names.
  std::vector<std::string> columns{"time_s", "x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "heading_deg"};
  std::vector<std::string> left_out{};          ///< columns of the file to ignore
  char separator = ',';                         ///< comma, semicolon, tab or blank, to write
  bool fixed_separator = false;                 ///< true if files to be read must have it, too
  bool more_columns = false;                    ///< true if other columns are ignored
  AngleUnit angle_unit = AngleUnit::degree;     ///< unit of angles whose names have none
  AngleConvention angles = heading_pitch_roll;  ///< meaning of roll, pitch and yaw
  Axes axes{};                                  ///< axes of x, y, z and of qx, qy, qz
  MapProjector projector{};  ///< of longitude and latitude; attitudes to true north become those to grid north

  void validate() const {
    angles.validate();
    if (std::string_view(",;\t ").find(separator) == std::string_view::npos)
      throw SettingError("TrajectoryFormat::separator (character code)", separator, "",
                         "a comma, a semicolon, a tab or a blank");
    const char* const refused = separator == ' ' ? ",;\"#\t\r\n " : ",;\"#\t\r\n";
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (columns[i].find_first_of(refused) != std::string::npos)
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

/// Trajectories that HELIOS++ reads: names and place of the time in comments, angles in degrees, other columns named.
[[nodiscard]] inline TrajectoryFormat helios_format() {
  return {.names = ColumnNames::comments,
          .columns = {"t", "roll", "pitch", "yaw", "x", "y", "z"},
          .more_columns = true,
          .angles = helios_arinc_705};
}

/// Output of HELIOS++ and `TrajectoryWriter`: position, time and angles in degrees, between blanks.
[[nodiscard]] inline TrajectoryFormat helios_output_format() {
  return {.names = ColumnNames::nowhere,
          .columns = {"x", "y", "z", "gpsTime", "roll", "pitch", "yaw"},
          .separator = ' ',
          .angles = helios_canonical};
}

/// Time, position and quaternion, separated by blanks, as in the TUM RGB-D benchmark (Sturm et al.
/// 2012). Body axes are a robot's: x forward, y left, z up (ROS REP 103).
[[nodiscard]] inline TrajectoryFormat tum_format() {
  return {.names = ColumnNames::nowhere,
          .columns = {"time", "x", "y", "z", "qx", "qy", "qz", "qw"},
          .separator = ' ',
          .axes = {.body = BodyAxes::forward_left_up}};
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
