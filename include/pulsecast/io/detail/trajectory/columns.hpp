// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TRAJECTORY_COLUMNS_HPP
#define PULSECAST_IO_DETAIL_TRAJECTORY_COLUMNS_HPP

#include <algorithm>
#include <array>
#include <initializer_list>
#include <vector>

#include <pulsecast/base/suggestion.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/base/units.hpp>

/// Columns of trajectory files: names and units.
namespace PULSECAST_NAMESPACE::io {

/// Content of a column of a trajectory file.
enum class Quantity : std::uint8_t { time, x, y, z, east, north, up, down, roll, pitch, yaw, qx, qy, qz, qw };

/// Value of each quantity in SI units; 0 if not set.
struct QuantityValues {
  std::array<double, 15> values{};  ///< [s, m, rad or 1]

  [[nodiscard]] double& operator[](Quantity quantity) noexcept { return values[static_cast<std::size_t>(quantity)]; }
  [[nodiscard]] double operator[](Quantity quantity) const noexcept {
    return values[static_cast<std::size_t>(quantity)];
  }
};

/// Unit of angles in columns whose names do not state it.
enum class AngleUnit : std::uint8_t { degree, radian };

/// Content and unit of a column, from its name.
struct TrajectoryColumn {
  Quantity quantity{};  ///< content
  double per_si = 1;    ///< number of its units in a second, metre or radian
};

namespace detail {

/// Names of columns; the first of each quantity is the preferred one.
inline constexpr auto quantity_names = std::to_array<std::pair<std::string_view, Quantity>>({
    {"time", Quantity::time},
    {"t", Quantity::time},
    {"gps_time", Quantity::time},
    {"gpstime", Quantity::time},
    {"timestamp", Quantity::time},
    {"x", Quantity::x},
    {"y", Quantity::y},
    {"z", Quantity::z},
    {"east", Quantity::east},
    {"easting", Quantity::east},
    {"north", Quantity::north},
    {"northing", Quantity::north},
    {"up", Quantity::up},
    {"height", Quantity::up},
    {"altitude", Quantity::up},
    {"down", Quantity::down},
    {"roll", Quantity::roll},
    {"pitch", Quantity::pitch},
    {"yaw", Quantity::yaw},
    {"heading", Quantity::yaw},
    {"qx", Quantity::qx},
    {"qy", Quantity::qy},
    {"qz", Quantity::qz},
    {"qw", Quantity::qw},
});

enum class Dimension : std::uint8_t { time, length, angle, number };

[[nodiscard]] constexpr Dimension dimension_of(Quantity quantity) noexcept {
  if (quantity == Quantity::time) return Dimension::time;
  if (quantity <= Quantity::down) return Dimension::length;
  return quantity <= Quantity::yaw ? Dimension::angle : Dimension::number;
}

struct Unit {
  std::string_view name;
  Dimension dimension;
  double per_si;
};

inline constexpr auto units = std::to_array<Unit>({
    {"s", Dimension::time, 1},
    {"ms", Dimension::time, 1e3},
    {"us", Dimension::time, 1e6},
    {"ns", Dimension::time, 1e9},
    {"m", Dimension::length, 1},
    {"cm", Dimension::length, 1e2},
    {"mm", Dimension::length, 1e3},
    {"km", Dimension::length, 1e-3},
    {"deg", Dimension::angle, degrees(1)},
    {"rad", Dimension::angle, 1},
});

/// Normal form of a name: small letters, and an underscore for each run of others: "Roll [deg]" becomes "roll_deg".
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

/// Column of a name; empty if unknown. A unit may follow: `time_s`, `x_mm`, `Roll [deg]`; without one, times are in
/// seconds and lengths in metres. A word may precede a height: `Ellipsoid height`. Case does not matter.
[[nodiscard]] inline std::optional<TrajectoryColumn> trajectory_column(std::string_view name, AngleUnit angles) {
  const std::string whole = detail::plain(name);
  for (const auto& [known, quantity] : detail::quantity_names) {
    if (!whole.starts_with(known)) continue;
    const detail::Dimension dimension = detail::dimension_of(quantity);
    std::string_view unit = std::string_view(whole).substr(known.size());
    if (unit.empty())
      return TrajectoryColumn{quantity,
                              dimension == detail::Dimension::angle && angles == AngleUnit::degree ? degrees(1) : 1};
    if (!unit.starts_with('_')) continue;
    unit.remove_prefix(1);
    for (const detail::Unit& u : detail::units)
      if (u.dimension == dimension && u.name == unit) return TrajectoryColumn{quantity, u.per_si};
  }
  const std::size_t height = whole.rfind("_height");
  return height == whole.npos ? std::nullopt : trajectory_column(std::string_view(whole).substr(height + 1), angles);
}

/// Known column name nearest to an unknown one.
[[nodiscard]] inline std::string nearest_trajectory_column(std::string_view name) {
  const std::string whole = detail::plain(name.substr(0, 64));
  std::vector<std::string> names;
  for (const auto& [known, quantity] : detail::quantity_names) {
    names.emplace_back(known);
    for (const detail::Unit& unit : detail::units)
      if (unit.dimension == detail::dimension_of(quantity))
        names.push_back(std::string(known) + '_' + std::string(unit.name));
  }
  return std::string(text::nearest_name(whole, names).name);
}

/// Assignment of quantities to columns.
class TrajectoryColumns {
 public:
  /// `names` in the order of the columns; those in `left_out` are ignored.
  TrajectoryColumns(const std::vector<std::string>& names, const std::vector<std::string>& left_out, AngleUnit angles) {
    for (std::size_t i = 0; i < names.size() && problem_.empty(); ++i) {
      const auto same = [&](const std::string& other) { return detail::plain(other) == detail::plain(names[i]); };
      columns_.push_back(std::ranges::any_of(left_out, same) ? std::nullopt : trajectory_column(names[i], angles));
      if (columns_.back())
        put(i);
      else if (std::none_of(left_out.begin(), left_out.end(), same)) {
        problem_ = "is not a known column: did you mean '" + nearest_trajectory_column(names[i]) +
                   "'? Others must be set as left out";
        culprit_ = i;
      }
    }
    if (problem_.empty()) require_whole();
  }

  /// Defect of the names, in words; empty without one.
  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }

  /// Column of the defect, from 0; empty if it concerns all.
  [[nodiscard]] std::optional<std::size_t> culprit() const noexcept { return culprit_; }

  /// Columns in the order of the file; empty for ignored ones.
  [[nodiscard]] const std::vector<std::optional<TrajectoryColumn>>& all() const noexcept { return columns_; }

  [[nodiscard]] bool has(Quantity quantity) const noexcept {
    return places_[static_cast<std::size_t>(quantity)].has_value();
  }

 private:
  void put(std::size_t i) {
    std::optional<std::size_t>& place = places_[static_cast<std::size_t>(columns_[i]->quantity)];
    if (place) {
      problem_ =
          "duplicates column " + std::to_string(*place + 1) + ": expected one of them, the other set as left out";
      culprit_ = i;
    }
    place = i;
  }

  /// Requires a time, one whole position, and at most one attitude.
  void require_whole() {
    using enum Quantity;
    const int xyz = count({x, y, z}), directions = count({east, north}), vertical = count({up, down}),
              angles = count({roll, pitch, yaw}), quaternion = count({qx, qy, qz, qw});
    if (!has(time))
      problem_ = "no column is the time: expected one named 'time_s'";
    else if (!(xyz == 3 && directions + vertical == 0) && !(xyz == 0 && directions == 2 && vertical == 1))
      problem_ = "the columns do not define one position: expected either x, y, z or east, north and up or down";
    else if (quaternion > 0 && (quaternion < 4 || angles > 0))
      problem_ =
          "the columns do not define one attitude: expected either angles or qx, qy, qz and qw, the others set as left "
          "out";
  }

  [[nodiscard]] int count(std::initializer_list<Quantity> quantities) const {
    return static_cast<int>(std::count_if(quantities.begin(), quantities.end(), [&](Quantity q) { return has(q); }));
  }

  std::vector<std::optional<TrajectoryColumn>> columns_;
  std::array<std::optional<std::size_t>, std::tuple_size_v<decltype(QuantityValues::values)>> places_{};
  std::string problem_;
  std::optional<std::size_t> culprit_;
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
