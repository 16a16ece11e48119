// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TRAJECTORY_HEAD_HPP
#define PULSECAST_IO_DETAIL_TRAJECTORY_HEAD_HPP

#include <pulsecast/io/detail/text/table.hpp>
#include <pulsecast/io/detail/trajectory/format.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Lines before the first row of a trajectory file: preamble, names of columns, and their units.
class TrajectoryHead {
 public:
  static constexpr std::size_t max_columns = 1000;  ///< in a file
  static constexpr std::size_t max_lines = 1000;    ///< that are neither comments nor rows

  TrajectoryHead(const TrajectoryFormat& format, TextTable& table)
      : format_(format), table_(table), names_(format.columns) {}

  /// Takes the current line of the table, unless it is a row. @throws FileError for columns without a pose
  [[nodiscard]] bool is_row() {
    if (has_rows_ && !table_.text().starts_with('#')) return true;
    if (!columns_) table_.forget_separator();
    if (table_.text().starts_with('#')) {
      if (!columns_) comment(table_.text());
      return false;
    }
    has_rows_ = looks_like_row() || !takes_line();
    if (has_rows_ && !columns_) settle_names();
    return has_rows_;
  }

  /// At the end of the file: throws a `FileError` if no line names the columns of a pose.
  void finish() const {
    if (!columns_ && problem_) throw *problem_;
  }

  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  [[nodiscard]] const TrajectoryColumns& columns() const noexcept { return *columns_; }
  [[nodiscard]] const std::string& left_out() const noexcept { return left_out_; }  ///< names of unknown columns

  [[nodiscard]] bool is_named() const noexcept { return named_; }  ///< columns, by the file

  /// True if extra columns are allowed: the file or the format names the others.
  [[nodiscard]] bool may_have_more() const noexcept {
    return format_.more_columns && (named_ || format_.names != ColumnNames::comments);
  }

 private:
  /// Reads `#HEADER: "t", "roll"`, the column names; `#TIME_COLUMN: 0`, the column of the time; and names of columns
  /// without such a word, if they define a pose. Where the format names the columns, such names must be in its order.
  void comment(std::string_view text) {
    if (format_.names == ColumnNames::nowhere) return refuse_other_order();
    if (is_key(text, "HEADER:")) {
      named_ = true;
      names_.clear();
      while (!text.empty()) {
        const std::size_t end = std::min(text.find(','), text.size());
        names_.emplace_back(text.substr(0, end));
        std::erase_if(names_.back(), [](char c) { return c == '"' || c == ' ' || c == '\t'; });
        text.remove_prefix(std::min(end + 1, text.size()));
      }
    } else if (is_key(text, "TIME_COLUMN:")) {
      text = text::trimmed(text);
      const double number = text::finite_number_in(text).value_or(-1);
      if (number < 0 || number > 1000 || number != std::floor(number))
        table_.fail_here(text::quoted(text), " is not a column index: expected a whole number from 0 to 1000");
      time_place_ = static_cast<std::size_t>(number);
    } else if (!named_) {
      std::vector<std::string> names = names_in_comment();
      named_ = names.size() <= max_columns && is_whole({names, format_.left_out, format_.angle_unit, true});
      if (!named_) return refuse_other_order();
      names_ = std::move(names);
    }
  }

  /// True for a comment that begins with a word in any case, after which its text begins then.
  [[nodiscard]] static bool is_key(std::string_view& text, std::string_view key) {
    const std::string_view rest = text.substr(std::min(text.find_first_not_of("# \t"), text.size()));
    if (!text::is_same_word(rest.substr(0, key.size()), key)) return false;
    text = rest.substr(key.size());
    return true;
  }

  [[nodiscard]] std::vector<std::string> names_in_comment() {
    std::vector<std::string> names(table_.cells().begin(), table_.cells().end());
    names.front().erase(0, names.front().find_first_not_of("# \t"));
    if (names.front().empty()) names.erase(names.begin());
    return names;
  }

  /// Refuses a comment whose words are as many as the columns of the format, and mostly names, in another order.
  void refuse_other_order() {
    const std::vector<std::string> names = names_in_comment();
    if (names.size() != format_.columns.size()) return;
    std::size_t known = 0;
    std::optional<std::size_t> other;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto named = trajectory_column(names[i], format_.angle_unit);
      const auto expected = trajectory_column(format_.columns[i], format_.angle_unit);
      known += named ? 1 : 0;
      if (named && expected && named->quantity != expected->quantity) other = i;
    }
    if (other && 2 * known > names.size())
      table_.fail_here(*other, text::quoted(names[*other]), ": expected ", text::quoted(format_.columns[*other]),
                       ", by the order of the format");
  }

  /// True if most cells of the line begin like numbers.
  [[nodiscard]] bool looks_like_row() {
    const std::vector<std::string_view>& cells = table_.cells();
    const auto numbers = std::ranges::count_if(cells, [](std::string_view cell) {
      return cell.find_first_of("0123456789+-.") == 0 || text::is_same_word(cell, "nan") ||
             text::is_same_word(cell, "inf");
    });
    return 2 * static_cast<std::size_t>(numbers) > cells.size();
  }

  /// Takes a line before the first row: names of columns, their units, or a preamble, to skip. False for a row.
  bool takes_line() {
    const std::vector<std::string_view>& cells = table_.cells();
    const auto is_known = [&](std::string_view name) {
      return trajectory_column(name, format_.angle_unit).has_value();
    };
    if (columns_) return takes_units();
    if (format_.names == ColumnNames::nowhere) return format_.more_columns;
    if (named_) return std::ranges::any_of(cells, is_known);
    if (++lines_ > max_lines) table_.fail_here("is no row: expected one within ", max_lines, " lines");
    const auto known = static_cast<std::size_t>(std::ranges::count_if(cells, is_known));
    names_.assign(cells.begin(), cells.end());
    try {
      named_ = true;
      understand();
    } catch (const FileError& problem) {
      named_ = false;
      columns_.reset();
      if (!problem_ || known > known_) problem_ = problem;
      known_ = std::max(known_, known);
    }
    return true;
  }

  /// Adds a row of units to the names; columns at the end may lack one. False for another row.
  bool takes_units() {
    const std::vector<std::string_view>& cells = table_.cells();
    const auto is_unit = [](std::string_view cell) {
      const auto same = [&](const Unit& unit) { return unit.name() == plain(cell); };
      return cell.find_first_of("[(") == 0 || std::ranges::any_of(units, same);
    };
    if (cells.size() > names_.size() || !std::ranges::all_of(cells, is_unit)) return false;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (columns_->all()[i]) names_[i] += ' ' + std::string(cells[i]);
    understand();
    return true;
  }

  /// Settles the column names before the first row of a file without them.
  void settle_names() {
    if (problem_) throw *problem_;
    if (format_.names == ColumnNames::first_line && !named_)
      table_.fail_here(
          "has numbers: expected the names of the columns, as in "
          "time_s,x_m,y_m,z_m,roll_deg,pitch_deg,heading_deg");
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

  /// Rule of an unknown column that is refused, by its name or unit; or null.
  [[nodiscard]] static const FormatRule* refusal_of(const std::string& name) {
    const std::string whole = plain(name);
    const FormatRule* rule = rule_of(trajectory_rules, whole);
    for (std::size_t at = whole.find('_'); rule->use != FormatUse::refused && at != whole.npos;
         at = whole.find('_', at + 1))
      rule = rule_of(trajectory_rules, '[' + whole.substr(at + 1));
    return rule->use == FormatUse::refused ? rule : nullptr;
  }

  void understand() {
    if (names_.size() > max_columns)
      table_.fail_here("has ", names_.size(), " columns: expected at most ", max_columns);
    columns_.emplace(names_, format_.left_out, format_.angle_unit, true);
    std::string unknown;
    for (const std::size_t i : columns_->unknown()) {
      const bool is_told_twice = trajectory_column(names_[i], format_.angle_unit).has_value();
      const FormatRule* const rule = is_told_twice || is_whole(*columns_) ? nullptr : refusal_of(names_[i]);
      if (rule) table_.fail_here(i, text::quoted(names_[i]), ": expected ", rule->meaning);
      unknown += (unknown.empty() ? "" : ", ") + text::quoted(names_[i]);
    }
    if (!may_have_more()) columns_.emplace(names_, format_.left_out, format_.angle_unit);
    if (columns_->problem().empty()) return void(left_out_ = std::move(unknown));
    if (const auto at = columns_->culprit()) table_.fail_here(*at, text::quoted(names_[*at]), " ", columns_->problem());
    if (!unknown.empty())
      unknown = "; not understood: " + unknown + "; a survey may give columns by number, as with zIndex";
    table_.fail_here(columns_->problem(), unknown);
  }

  /// True for columns of a time, a position and, unless the format has none, an attitude.
  [[nodiscard]] bool is_whole(const TrajectoryColumns& columns) const {
    const auto is_roll = [](const std::string& name) { return name.starts_with("roll"); };
    return columns.problem().empty() && (columns.has_attitude() || std::ranges::none_of(format_.columns, is_roll));
  }

  const TrajectoryFormat& format_;
  TextTable& table_;
  std::vector<std::string> names_;
  bool named_ = false;                     // by the file
  std::optional<FileError> problem_;       // of the line before the rows that is most like one of names
  std::size_t lines_ = 0, known_ = 0;      // such lines, and names known in the most alike
  std::string left_out_;                   // names of unknown columns
  std::optional<std::size_t> time_place_;  // index from 0
  std::optional<TrajectoryColumns> columns_;
  bool has_rows_ = false;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
