// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TRAJECTORY_TABLE_HPP
#define PULSECAST_IO_DETAIL_TRAJECTORY_TABLE_HPP

#include <pulsecast/io/detail/trajectory/head.hpp>
#include <pulsecast/platform/waypoints.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Part of a trajectory, on the clock of its file. Ends between two poses are interpolated as in
/// `Waypoints`. A window that begins at a jump begins after it; one that ends there ends before it.
struct TimeWindow {
  std::optional<double> start{};  ///< begin; by default the first pose [s]
  std::optional<double> end{};    ///< end; by default the last pose [s]

  void validate() const {
    if (start) require_finite("TimeWindow::start", *start, "s");
    if (end) require_finite("TimeWindow::end", *end, "s");
    if (start && end && *start > *end)
      throw SettingError("TimeWindow::start", *start, "s", "no later than the end, " + text::to_text(*end));
  }
};

/// Content of a trajectory file: `Waypoints(table.poses)` moves along it.
struct TrajectoryTable {
  double start_time = 0;              ///< clock time of the file at the first pose [s]
  std::vector<TimedPose> poses;       ///< poses in order of time, from 0; at a jump, twice a time
  std::vector<std::string> warnings;  ///< oddities that could still be read
};

namespace detail {

inline constexpr double max_in_trajectory = 1e12;  ///< resolved to about 1e-4 [s, m or rad]

class TrajectoryReader {
 public:
  TrajectoryReader(const std::filesystem::path& path, const TrajectoryFormat& format)
      : format_(validated(format)),
        table_(path, "a trajectory", format_.fixed_separator ? std::optional(format_.separator) : std::nullopt),
        head_(format_, table_) {}

  [[nodiscard]] TrajectoryTable read(const TimeWindow& window) {
    while (table_.next())
      if (head_.is_row()) row();
    head_.finish();
    if (rows_.empty()) table_.fail("holds no pose: expected at least one line of numbers");
    if (table_.line_is_open()) table_.warn(table_.line(), "has no line end: the file may be truncated");
    count_weeks();
    sort();
    remarks();
    cut(validated(window));
    result_.warnings = std::move(table_.warnings);
    return std::move(result_);
  }

 private:
  struct Row {
    TimedPose pose;
    std::size_t line = 0;
  };

  void row() {
    const std::vector<std::string_view>& cells = table_.cells();
    const std::vector<std::string>& names = head_.names();
    if (cells.size() < names.size() || (cells.size() > names.size() && !head_.may_have_more()))
      table_.fail_here("has ", cells.size(), " columns: expected ", names.size());
    if (cells.size() > names.size() && head_.is_named() && !cells.back().empty()) longer_.at(table_.line());
    QuantityValues values;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::optional<TrajectoryColumn>& column = head_.columns().all()[i];
      if (!column) continue;
      const std::optional<double> number = text::finite_number_in(cells[i]);
      if (!number || std::fabs(*number / column->per_si) > max_in_trajectory)
        table_.fail_here(i, text::quoted(cells[i]), " in column ", names[i],
                         ": expected a finite number, with a decimal point, within 1e12 s, m or rad",
                         column->quantity == Quantity::time ? "; nanoseconds in a column named time_ns" : "");
      values[column->quantity] = *number / column->per_si;
    }
    TimedPose pose{values[Quantity::time], position(values), rotation(values)};
    if (head_.columns().has(Quantity::longitude)) {
      widest_ = std::max({widest_, std::fabs(values[Quantity::longitude]), std::fabs(values[Quantity::latitude])});
      project(values, pose);
    }
    rows_.push_back({pose, table_.line()});
  }

  /// Moves a pose to the map. Source: Snyder 1987, Map Projections, p. 19 (convergence).
  void project(const QuantityValues& values, TimedPose& pose) {
    if (!format_.projector)
      table_.fail_here(
          "has a longitude and a latitude: expected east and north, or a map to project to, by "
          "TrajectoryFormat::projector "
          "or --project");
    try {
      const MapPoint at = format_.projector(degrees(values[Quantity::longitude]), degrees(values[Quantity::latitude]));
      pose.position.x = at.place.x;
      pose.position.y = at.place.y;
      pose.rotation = rotation_about(axis::up, -at.convergence) * pose.rotation;
    } catch (const FileError& error) {
      table_.fail_here("cannot be projected: ", error.what());
    }
  }

  [[nodiscard]] Vec3 position(const QuantityValues& values) const {
    using enum Quantity;
    if (head_.columns().has(x)) return format_.axes.swapped({values[x], values[y], values[z]});
    return {values[east], values[north], head_.columns().has(up) ? values[up] : -values[down]};
  }

  [[nodiscard]] Rotation rotation(const QuantityValues& values) {
    using enum Quantity;
    if (!head_.columns().has(qw)) return rotation_of({values[roll], values[pitch], values[yaw]}, format_.angles);
    const Rotation given = pulsecast::detail::rotation_wxyz(values[qw], values[qx], values[qy], values[qz]);
    const double error = std::fabs(length(given) - 1);
    if (!(error <= 1e-3)) table_.fail_here("the quaternion has the norm ", length(given), ": expected 1, within 1e-3");
    if (error > 2e-6) not_unit_.at(table_.line());  // more than six decimals explain
    return format_.axes.from_file(normalize(given));
  }

  /// Counts times on where those of a GPS week begin anew, within an hour of its end.
  void count_weeks() {
    constexpr double week = 604800, longest = 3600;  // [s]
    Oddity begins;
    double before = -1, added = 0;
    for (Row& row : rows_) {
      const double time = row.pose.time;
      if (time >= 0 && before <= week && before - time > week - longest) {
        added += week;
        begins.at(row.line);
      }
      before = time;
      row.pose.time += added;
    }
    table_.warn(begins, "begins a GPS week", ": times count on, beyond 604800 s");
  }

  void sort() {
    const auto earlier = [](const Row& a, const Row& b) { return a.pose.time < b.pose.time; };
    for (std::size_t i = 1; i < rows_.size(); ++i)
      if (earlier(rows_[i], rows_[i - 1])) unsorted_.at(rows_[i].line);
    if (unsorted_.count > 0) std::ranges::stable_sort(rows_, earlier);
    const auto repeats = [this](const Row& before, const Row& row) {
      const TimedPose &a = before.pose, &b = row.pose;
      if (a.time != b.time || a.position != b.position || a.rotation != b.rotation) return false;
      repeated_.at(row.line);
      return true;
    };
    rows_.erase(std::unique(rows_.begin(), rows_.end(), repeats), rows_.end());
  }

  void remarks() {
    if (!head_.left_out().empty())
      table_.warn(0, rule_of(trajectory_rules, "*")->meaning, ": ", head_.left_out().substr(0, 1000));
    table_.warn(unsorted_, "is earlier than the previous pose", ": the poses were sorted by time");
    table_.warn(repeated_, "repeats a pose", ": it is left out");
    table_.warn(longer_, "has more columns than names", ": the last ones are left out");
    table_.warn(not_unit_, "has a quaternion that is not unit", ": it is normalized");
    if (widest_ > 0 && widest_ <= radians(3.2))
      table_.warn(0,
                  "longitude and latitude are all within 3.2 degrees: given in radians? Name such columns "
                  "longitude_rad, latitude_rad");
    if (head_.columns().has(Quantity::qw)) return;
    if (turns_by_radians())
      table_.warn(
          0,
          "roll, pitch and yaw are all within 3.2 degrees, and head elsewhere than the poses: given in radians? "
          "Name such columns roll_rad, pitch_rad, heading_rad, or set toRadians=\"false\"");
    for (const auto& [quantity, name] :
         {std::pair{Quantity::roll, "roll"}, {Quantity::pitch, "pitch"}, {Quantity::yaw, "yaw"}})
      if (!head_.columns().has(quantity)) table_.warn(0, "no column for the ", name, ": 0 is assumed");
  }

  /// True if angles taken as degrees are all as small as those in radians, which fit the course of the platform better.
  [[nodiscard]] bool turns_by_radians() const {
    const auto is_degree = [](const auto& column) { return column && column->per_si == degrees(1); };
    if (rows_.size() < 5 || std::ranges::none_of(head_.columns().all(), is_degree)) return false;
    double way = 0, along = 0, along_by_radians = 0;
    for (std::size_t i = 1; i < rows_.size(); ++i) {
      const Rotation& turn = rows_[i - 1].pose.rotation;
      const RollPitchYaw a = roll_pitch_yaw(turn, format_.angles);
      if (std::fabs(a.roll) > radians(3.2) || std::fabs(a.pitch) > radians(3.2) || std::fabs(a.yaw) > radians(3.2))
        return false;
      const Rotation by_radians = rotation_of({degrees(a.roll), degrees(a.pitch), degrees(a.yaw)}, format_.angles);
      const Vec3 step = (rows_[i].pose.position - rows_[i - 1].pose.position) * Vec3{1, 1, 0};
      way += length(step);
      along += dot(turn * axis::forward, step);
      along_by_radians += dot(by_radians * axis::forward, step);
    }
    return along < 0.9 * way && along_by_radians > along;
  }

  /// Cuts the poses to the window and starts its clock.
  void cut(const TimeWindow& window) {
    const double first = rows_.front().pose.time, last = rows_.back().pose.time;
    const double from = window.start.value_or(first), to = window.end.value_or(last);
    const double start = std::max(first, from), end = std::min(last, to);
    if (start > end)
      table_.fail("has poses from ", first, " s to ", last, " s: expected some from ", from, " s to ", to, " s");
    if (from < first) table_.warn(0, "the window begins before the first pose, at ", first, " s");
    if (to > last) table_.warn(0, "the window ends after the last pose, at ", last, " s");
    result_.start_time = start;
    const auto time_of = [](const Row& row) { return row.pose.time; };
    const auto within = std::ranges::upper_bound(rows_, start, {}, time_of);
    const auto behind = std::ranges::lower_bound(within, rows_.end(), end, {}, time_of);
    result_.poses.push_back((within - 1)->pose.time == start ? (within - 1)->pose : between(within, start));
    Oddity jumps;
    for (auto row = within; row != behind; ++row) {
      if (row != within && row->pose.time == (row - 1)->pose.time) jumps.at(row->line);
      result_.poses.push_back(row->pose);
    }
    if (end > start) result_.poses.push_back(behind->pose.time == end ? behind->pose : between(behind, end));
    note_gaps();
    for (TimedPose& pose : result_.poses) pose.time -= start;
    table_.warn(jumps, "repeats the time of the previous pose at another pose", ": a jump of the platform");
  }

  /// Notes intervals without poses of more than 20 times the median, from 4 intervals on.
  void note_gaps() {
    std::vector<double> intervals;
    const std::vector<TimedPose>& poses = result_.poses;
    std::size_t longest = 1;
    const auto length = [&](std::size_t i) { return poses[i].time - poses[i - 1].time; };
    for (std::size_t i = 1; i < poses.size(); ++i) {
      if (length(i) > 0) intervals.push_back(length(i));
      if (length(i) > length(longest)) longest = i;
    }
    if (intervals.size() < 4) return;
    const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
    std::ranges::nth_element(intervals, middle);
    const auto gaps = std::ranges::count_if(intervals, [&](double one) { return one > 20 * *middle; });
    if (*middle >= 1000)
      table_.warn(0, "poses are ", *middle, " s apart: if times are in nanoseconds, name their column time_ns");
    if (gaps > 0)
      table_.warn(0, "no pose between ", poses[longest - 1].time, " s and ", poses[longest].time, " s, the longest of ",
                  gaps,
                  " gaps of more than 20 times the median interval: poses are "
                  "interpolated across it; windows (tStart, tEnd) leave gaps out");
  }

  /// Pose at a time between a row and the one before.
  [[nodiscard]] static TimedPose between(std::vector<Row>::const_iterator row, double time) {
    TimedPose before = (row - 1)->pose, after = row->pose;
    const double start = std::exchange(before.time, 0);
    after.time -= start;
    const auto pose = Waypoints({before, after}).at(Tick::of_seconds(time - start));
    return {time, pose.position, pose.rotation};
  }

  TrajectoryFormat format_;
  TextTable table_;
  TrajectoryHead head_;
  std::vector<Row> rows_;
  Oddity unsorted_, repeated_, not_unit_, longer_;
  double widest_ = 0;  // longitude or latitude [rad]
  TrajectoryTable result_;
};

}  // namespace detail

/// Reads a trajectory. Throws a `FileError` with path, line and column at the first error, also a
/// quaternion whose norm is off by more than 1/1000, or a number beyond 1e12 s, m or rad. Warnings:
/// - poses out of order, which are sorted; repeated poses, which are left out;
/// - different poses at one time within the window: a jump from the first in the file to the last;
/// - angles without a column, which are 0; quaternions that are not unit, which are normalized.
[[nodiscard]] inline TrajectoryTable read_trajectory(const std::filesystem::path& path,
                                                     const TrajectoryFormat& format = csv_format(),
                                                     const TimeWindow& window = {}) {
  return reading(path, [&] { return detail::TrajectoryReader(path, format).read(window); });
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
