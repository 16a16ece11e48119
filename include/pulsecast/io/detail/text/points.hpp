// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TEXT_POINTS_HPP
#define PULSECAST_IO_DETAIL_TEXT_POINTS_HPP

#include <algorithm>
#include <cmath>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/detail/text/table.hpp>
#include <pulsecast/io/detail/text/text_point_columns.hpp>
#include <pulsecast/io/input_file.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Reader of a text of points, one a row. Blank rows, and those that begin with `//` or `#`, are
/// skipped; so is, with a warning, a first row that is a whole number, as a count, or has no
/// number, as the names of columns. Default separators are semicolons if the first row has any,
/// else commas, else blanks, several as one. Blanks around a cell are ignored. The first row
/// decides on normals and colours. Throws a `FileError` with path, line and column.
class TextPoints {
 public:
  TextPoints(InputFile file, TextPointColumns columns)
      : file_(std::move(file)), columns_(validated(std::move(columns))) {}

  /// Advances to the next point; false at the end.
  [[nodiscard]] bool next() {
    while (const std::optional<std::string_view> line = file_.take_line()) {
      const std::string_view text = text::trimmed(*line);
      if (text.empty()) continue;
      if (text.front() == '#' || text.starts_with("//")) {
        const std::size_t begin = text.find_first_not_of("#/ \t");
        if (begin != text.npos && names_other_columns(text.substr(begin)))
          note("names x, y and z of other columns than those that are read");
        continue;
      }
      if (!begun_ && is_heading(text)) continue;
      if (!begun_) {
        begin(text);
      } else {
        cells_.split(text, needed_);
        if (cells().size() < needed_) too_few();
      }
      cut_ = file_.line_is_open();
      return true;
    }
    return false;
  }

  /// Of the current point, in coordinates of the file.
  [[nodiscard]] Vec3 position() const { return vector(columns_.position); }
  [[nodiscard]] bool has_normals() const noexcept { return columns_.normal.has_value(); }
  [[nodiscard]] Vec3 normal() const { return vector(*columns_.normal); }
  [[nodiscard]] bool has_colours() const noexcept { return columns_.colour.has_value(); }
  [[nodiscard]] Vec3 colour() const { return vector(*columns_.colour); }
  static constexpr double max_colour = 255;  ///< default
  [[nodiscard]] bool has_class() const noexcept { return false; }
  [[nodiscard]] std::uint32_t classification() const noexcept { return 0; }
  [[nodiscard]] bool has_object() const noexcept { return false; }
  [[nodiscard]] std::uint32_t object() const noexcept { return 0; }

  /// Oddities that could still be read; complete after the last point.
  [[nodiscard]] std::vector<std::string> warnings() const {
    std::vector<std::string> all = notes_;
    if (cut_) all.push_back(file_.path() + ": the last line has no line end: the file may be truncated");
    return all;
  }

  [[noreturn]] void fail_here(const std::string& problem) const { file_.fail_at_line(problem); }
  [[nodiscard]] const std::string& path() const noexcept { return file_.path(); }

 private:
  using Columns = TextPointColumns::Columns;

  [[nodiscard]] const std::vector<std::string_view>& cells() const noexcept { return cells_.cells(); }

  void note(const std::string& oddity) {
    notes_.push_back(text::joined({file_.path(), ", line ", std::to_string(file_.line()), ": ", oddity}));
  }

  /// Splits a row by the separators of the settings, or those that it has.
  void split(std::string_view text) {
    std::string separators = columns_.separators;
    if (separators.empty()) {
      const auto has = [&](char c) { return text.find(c) != text.npos; };
      separators = has(';') ? ";" : has(',') ? "," : text::blanks;
    }
    cells_ = RowCells(separators, true);
    cells_.split(text, TextPointColumns::max_column + 1);
  }

  /// True if a row of names has x, y and z, not all in the columns that are read.
  [[nodiscard]] bool names_other_columns(std::string_view text) {
    split(text);
    bool is_other = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto named = std::find_if(cells().begin(), cells().end(), [&](std::string_view cell) {
        if (cell.size() == 3 && cell.front() == '"') cell = cell.substr(1, 1);
        return text::is_same_word(cell, std::string_view("xyz").substr(axis, 1));
      });
      if (named == cells().end()) return false;
      const auto column = static_cast<std::size_t>(named - cells().begin());
      is_other = is_other || column != columns_.position[axis];
    }
    return is_other;
  }

  /// True for a first row that is a count of points or has the names of columns. Notes it.
  [[nodiscard]] bool is_heading(std::string_view text) {
    if (std::exchange(has_heading_, true)) return false;
    if (std::ranges::any_of(text, [](unsigned char c) { return c < ' ' && c != '\t'; })) return false;
    split(text);
    const bool is_count = cells().size() == 1 && text::number_in<std::uint64_t>(text);
    const auto is_number = [](auto cell) { return text::number_in<double>(cell) || cell == "nan"; };
    const bool has_number = std::ranges::any_of(cells(), is_number);
    if (!is_count && (has_number || cells().size() < 3)) return false;
    if (!is_count && names_other_columns(text))
      fail_here("names x, y and z of other columns than those that are read: expected these first");
    note(text::quoted(text) + " is skipped, as " + (is_count ? "a count of points" : "names of columns"));
    return true;
  }

  /// Detects the separators and columns from the first row.
  void begin(std::string_view text) {
    split(text);
    const auto last = [](const Columns& columns) { return std::ranges::max(columns) + 1; };
    needed_ = last(columns_.position);
    if (cells().size() < needed_) too_few();
    for (std::optional<Columns>* columns : {&columns_.normal, &columns_.colour}) {
      if (*columns && cells().size() < last(**columns)) columns->reset();
      if (*columns) needed_ = std::max(needed_, last(**columns));
    }
    begun_ = true;
  }

  [[nodiscard]] Vec3 vector(const Columns& of) const { return {number(of[0]), number(of[1]), number(of[2])}; }

  [[nodiscard]] double number(std::size_t column) const {
    const std::optional<double> value = text::number_in<double>(cells()[column]);
    if (value && std::fabs(*value) <= 1e12) return *value;
    if (std::ranges::any_of(cells()[column], [](unsigned char c) { return c < ' '; }))
      fail_here("holds binary data: expected the text of a point cloud");
    file_.fail_at_column(
        column, text::quoted(cells()[column]) + ": expected a finite number, with a decimal point, within 1e12");
  }

  [[noreturn]] void too_few() const {
    fail_here("has " + std::to_string(cells().size()) + " columns: expected at least " + std::to_string(needed_));
  }

  InputFile file_;
  TextPointColumns columns_;
  RowCells cells_{"", true};
  std::size_t needed_ = 0;  // columns in use
  std::vector<std::string> notes_;
  bool begun_ = false, has_heading_ = false, cut_ = false;  // `has_heading_`: first row looked at
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
