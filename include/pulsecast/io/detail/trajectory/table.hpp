// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TRAJECTORY_TABLE_HPP
#define PULSECAST_IO_DETAIL_TRAJECTORY_TABLE_HPP

#include <algorithm>
#include <cmath>

#include <pulsecast/io/detail/text/table.hpp>
#include <pulsecast/io/detail/trajectory/format.hpp>
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
        names_(format_.columns),
        table_(path, "a trajectory", format_.fixed_separator ? std::optional(format_.separator) : std::nullopt) {}

  [[nodiscard]] TrajectoryTable read(const TimeWindow& window) {
    while (table_.next()) {
      if (table_.text().starts_with('#')) {
        if (format_.names == ColumnNames::comments && !columns_) comment(table_.text());
      } else if (!columns_ && format_.names == ColumnNames::first_line) {
        take_names();
      } else if (!columns_ && format_.more_columns && has_names_only()) {
        if (format_.names == ColumnNames::comments && !named_) {
          named_ = true;
          take_names();
        }
      } else {
        if (!columns_) settle_names();
        row();
      }
    }
    if (rows_.empty()) table_.fail("holds no pose: expected at least one line of numbers");
    if (table_.line_is_open()) table_.warn(table_.line(), "has no line end: the file may be truncated");
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

  /// Reads `#HEADER: "t", "roll"`, the column names, and `#TIME_COLUMN: 0`, the column of the time.
  void comment(std::string_view text) {
    if (text.starts_with("#HEADER:")) {
      named_ = true;
      names_.clear();
      for (text.remove_prefix(8); !text.empty();) {
        const std::size_t end = std::min(text.find(','), text.size());
        names_.emplace_back(text.substr(0, end));
        std::erase_if(names_.back(), [](char c) { return c == '"' || c == ' ' || c == '\t'; });
        text.remove_prefix(std::min(end + 1, text.size()));
      }
    } else if (text.starts_with("#TIME_COLUMN:")) {
      text = text::trimmed(text.substr(13));
      const double number = text::finite_number_in(text).value_or(-1);
      if (number < 0 || number > 1000 || number != std::floor(number))
        table_.fail_here(text::quoted(text), " is not a column index: expected a whole number from 0 to 1000");
      time_place_ = static_cast<std::size_t>(number);
    }
  }

  /// True if the line could be a header without a comment mark.
  [[nodiscard]] bool has_names_only() {
    return std::ranges::none_of(table_.cells(), [](std::string_view cell) {
      return cell.empty() || cell.find_first_of("0123456789+-.") == 0 || text::finite_number_in(cell);
    });
  }

  void take_names() {
    const std::vector<std::string_view>& cells = table_.cells();
    if (text::finite_number_in(cells.front()))
      table_.fail_here(
          "has numbers: expected the names of the columns, as in "
          "time_s,x_m,y_m,z_m,roll_deg,pitch_deg,heading_deg");
    names_.assign(cells.begin(), cells.end());
    understand();
  }

  /// Settles the column names before the first row of a file without them.
  void settle_names() {
    const auto is_time = [&](const std::string& name) {
      const std::optional<TrajectoryColumn> column = trajectory_column(name, format_.angle_unit);
      return column && column->quantity == Quantity::time;
    };
    if (time_place_ && !named_) std::erase_if(names_, is_time);
    if (time_place_ && *time_place_ >= names_.size() + (named_ ? 0 : 1))
      table_.fail_here("#TIME_COLUMN is ", *time_place_, ": expected the index, from 0, of one of ", names_.size(),
                       " columns");
    if (time_place_ && named_ && !is_time(names_[*time_place_])) names_[*time_place_] = "t";
    if (time_place_ && !named_) names_.insert(names_.begin() + static_cast<std::ptrdiff_t>(*time_place_), "t");
    understand();
  }

  void understand() {
    if (may_have_more()) leave_out_unknown();
    columns_.emplace(names_, format_.left_out, format_.angle_unit);
    if (columns_->problem().empty()) return;
    const std::optional<std::size_t> at = columns_->culprit();
    if (!at) table_.fail_here(columns_->problem(), unknown_names());
    table_.fail_here(*at, text::quoted(names_[*at]), " ", columns_->problem());
  }

  /// Names that are not those of columns, to end a message.
  [[nodiscard]] std::string unknown_names() const {
    std::string all;
    for (const std::string& name : names_)
      if (!trajectory_column(name, format_.angle_unit)) all += (all.empty() ? "" : ", ") + text::quoted(name);
    return all.empty() ? all : "; not understood: " + all + "; a survey may give columns by number, as with zIndex";
  }

  /// True if extra columns are allowed: the file or the format names the others.
  [[nodiscard]] bool may_have_more() const noexcept {
    return format_.more_columns && (named_ || format_.names != ColumnNames::comments);
  }

  void leave_out_unknown() {
    std::string unknown;
    std::vector<std::string>& out = format_.left_out;
    const auto is = [this](const std::string& name, Quantity first, Quantity last) {
      const std::optional<TrajectoryColumn> column = trajectory_column(name, format_.angle_unit);
      return column && column->quantity >= first && column->quantity <= last;
    };
    using enum Quantity;
    const bool is_placed = std::ranges::any_of(names_, [&](const std::string& name) { return is(name, x, north); });
    for (const std::string& name : names_) {
      const bool is_known = is(name, time, is_placed ? qw : latitude);  // degrees may stand beside metres
      if (is_known || std::ranges::find(out, name) != out.end()) continue;
      out.push_back(name);
      unknown += (unknown.empty() ? "" : ", ") + text::quoted(name);
    }
    if (!unknown.empty()) table_.warn(0, "unknown columns are left out: ", unknown.substr(0, 1000));
  }

  void row() {
    const std::vector<std::string_view>& cells = table_.cells();
    if (cells.size() < names_.size() || (cells.size() > names_.size() && !may_have_more()))
      table_.fail_here("has ", cells.size(), " columns: expected ", names_.size());
    QuantityValues values;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const std::optional<TrajectoryColumn>& column = columns_->all()[i];
      if (!column) continue;
      const std::optional<double> number = text::finite_number_in(cells[i]);
      if (!number || std::fabs(*number / column->per_si) > max_in_trajectory)
        table_.fail_here(i, text::quoted(cells[i]), " in column ", names_[i],
                         ": expected a finite number, with a decimal point, within 1e12 s, m or rad");
      values[column->quantity] = *number / column->per_si;
    }
    TimedPose pose{values[Quantity::time], position(values), rotation(values)};
    if (columns_->has(Quantity::longitude)) project(values, pose);
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
    if (columns_->has(x)) return format_.axes.swapped({values[x], values[y], values[z]});
    return {values[east], values[north], columns_->has(up) ? values[up] : -values[down]};
  }

  [[nodiscard]] Rotation rotation(const QuantityValues& values) {
    using enum Quantity;
    if (!columns_->has(qw)) return rotation_of({values[roll], values[pitch], values[yaw]}, format_.angles);
    const Rotation given = pulsecast::detail::rotation_wxyz(values[qw], values[qx], values[qy], values[qz]);
    const double error = std::fabs(length(given) - 1);
    if (!(error <= 1e-3)) table_.fail_here("the quaternion has the norm ", length(given), ": expected 1, within 1e-3");
    if (error > 2e-6) not_unit_.at(table_.line());  // more than six decimals explain
    return format_.axes.from_file(normalize(given));
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
    table_.warn(unsorted_, "is earlier than the previous pose", ": the poses were sorted by time");
    table_.warn(repeated_, "repeats a pose", ": it is left out");
    table_.warn(not_unit_, "has a quaternion that is not unit", ": it is normalized");
    if (columns_->has(Quantity::qw)) return;
    for (const auto& [quantity, name] :
         {std::pair{Quantity::roll, "roll"}, {Quantity::pitch, "pitch"}, {Quantity::yaw, "yaw"}})
      if (!columns_->has(quantity)) table_.warn(0, "no column for the ", name, ": 0 is assumed");
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
  std::vector<std::string> names_;
  bool named_ = false;                     // by a #HEADER
  std::optional<std::size_t> time_place_;  // index from 0
  TextTable table_;
  std::optional<TrajectoryColumns> columns_;
  std::vector<Row> rows_;
  Oddity unsorted_, repeated_, not_unit_;
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
