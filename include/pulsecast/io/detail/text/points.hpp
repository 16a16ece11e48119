// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/detail/text/table.hpp>
#include <pulsecast/io/input_file.hpp>

namespace pulsecast::io {

/// Where a text file of points has what. Columns are counted from 0.
struct PointColumns {
  using Columns = std::array<std::size_t, 3>;

  std::string separators = {};                       ///< any of these; if none are given, what the first row has: see `TextPoints`
  Columns position{0, 1, 2};                         ///< x, y and z
  std::optional<Columns> normal = Columns{3, 4, 5};  ///< its x, y and z
  std::optional<Columns> colour = Columns{6, 7, 8};  ///< red, green and blue
  static constexpr std::size_t max_column = 999;     ///< that may be asked for

  void validate() const {
    for (const char c : separators)
      if (std::string_view("+-.#/\r\n").find(c) != std::string_view::npos || (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
          (c >= 'a' && c <= 'z'))
        throw SettingError("PointColumns::separators character", static_cast<unsigned char>(c), "",
                           "one that no number, comment or line end has");
    for (const Columns& columns : {position, normal.value_or(position), colour.value_or(position)})
      for (const std::size_t column : columns)
        require_within("PointColumns::column", static_cast<double>(column), 0, static_cast<double>(max_column), "");
  }
};

/// The points of a text file, a row each, one after another. Rows that begin with `//` or `#`, and blank ones, do not count. Separators
/// that are not given are semicolons if the first row has any, else commas, else blanks. Blanks and tabs around a cell do not count, and
/// where they separate, many count as one. Whether there are normals and colours, the first row decides; the others must have as many
/// columns as are needed, and may have more. Throws a `FileError` with path, line and column.
class TextPoints {
 public:
  TextPoints(InputFile file, PointColumns columns) : file_(std::move(file)), columns_(validated(std::move(columns))) {}

  /// Goes to the next point; false if there is none.
  [[nodiscard]] bool next() {
    while (const std::optional<std::string_view> line = file_.take_line()) {
      std::string_view text = *line;
      while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
      while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
      if (text.empty() || text.front() == '#' || text.starts_with("//")) continue;
      if (!begun_) {
        begin(text);
      } else {
        split(text);
        if (cells_.size() < needed_) too_few();
      }
      cut_ = file_.line_is_open();
      return true;
    }
    return false;
  }

  [[nodiscard]] Vec3 position() const { return vector(columns_.position); }  ///< of the point at hand, as it stands in the file
  [[nodiscard]] bool has_normals() const noexcept { return columns_.normal.has_value(); }
  [[nodiscard]] Vec3 normal() const { return vector(*columns_.normal); }
  [[nodiscard]] bool has_colours() const noexcept { return columns_.colour.has_value(); }
  [[nodiscard]] Vec3 colour() const { return vector(*columns_.colour); }
  static constexpr double max_colour = 255;  ///< if nobody says otherwise

  /// What was odd, but could be read; to be asked for after the last point.
  [[nodiscard]] std::vector<std::string> warnings() const {
    if (!cut_) return {};
    return {file_.path() + ": the last line has no end: the file may have been cut short"};
  }

  [[noreturn]] void fail_here(const std::string& problem) const { file_.fail_at_line(problem); }
  [[nodiscard]] const std::string& path() const noexcept { return file_.path(); }

 private:
  using Columns = PointColumns::Columns;

  [[nodiscard]] static bool is_blank(char c) noexcept { return c == ' ' || c == '\t'; }
  [[nodiscard]] bool separates(char c) const noexcept { return separates_[static_cast<unsigned char>(c)]; }

  /// Finds out from the first row what the file has.
  void begin(std::string_view text) {
    std::string separators = columns_.separators;
    if (separators.empty()) {
      const auto has = [&](char c) { return text.find(c) != text.npos; };
      separators = has(';') ? ";" : has(',') ? "," : " \t";
    }
    for (const char c : separators) separates_[static_cast<unsigned char>(c)] = true;
    const auto last = [](const Columns& columns) { return *std::max_element(columns.begin(), columns.end()) + 1; };
    needed_ = PointColumns::max_column + 1;
    split(text);
    needed_ = last(columns_.position);
    if (cells_.size() < needed_) too_few();
    for (std::optional<Columns>* columns : {&columns_.normal, &columns_.colour}) {
      if (*columns && cells_.size() < last(**columns)) columns->reset();
      if (*columns) needed_ = std::max(needed_, last(**columns));
    }
    begun_ = true;
  }

  /// Cuts a row that has no blanks around it into cells, as many as are needed.
  void split(std::string_view text) {
    cells_.clear();
    for (std::size_t begin = 0; cells_.size() < needed_;) {
      std::size_t end = begin;
      while (end < text.size() && !separates(text[end])) ++end;
      std::size_t cell_end = end;
      while (cell_end > begin && is_blank(text[cell_end - 1])) --cell_end;
      cells_.push_back(text.substr(begin, cell_end - begin));
      while (end < text.size() && is_blank(text[end])) ++end;
      if (end == text.size()) break;
      begin = end;
      if (separates(text[begin])) ++begin;  // not so where blanks separated
      while (begin < text.size() && is_blank(text[begin])) ++begin;
    }
  }

  [[nodiscard]] Vec3 vector(const Columns& columns) const { return {number(columns[0]), number(columns[1]), number(columns[2])}; }

  [[nodiscard]] double number(std::size_t column) const {
    const std::optional<double> value = TextTable::number_in(cells_[column]);
    if (value && std::fabs(*value) <= 1e12) return *value;
    if (std::any_of(cells_[column].begin(), cells_[column].end(), [](unsigned char c) { return c < ' '; }))
      fail_here("holds binary data: expected the text of a point cloud");
    throw FileError(file_.path(), TextTable::place(file_.line()) + ", column " + std::to_string(column + 1),
                    TextTable::quoted(cells_[column]) + ": expected a finite number, with a decimal point, within 1e12");
  }

  [[noreturn]] void too_few() const {
    fail_here("has " + std::to_string(cells_.size()) + " columns: expected at least " + std::to_string(needed_));
  }

  InputFile file_;
  PointColumns columns_;
  std::array<bool, 256> separates_{};
  std::size_t needed_ = 0;  // columns
  bool begun_ = false, cut_ = false;
  std::vector<std::string_view> cells_;  // of the row at hand
};

}  // namespace pulsecast::io
