// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TEXT_TABLE_HPP
#define PULSECAST_IO_DETAIL_TEXT_TABLE_HPP

#include <pulsecast/io/input_file.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Splitter of rows into cells.
class RowCells {
 public:
  /// Any of the characters `separators` ends a cell. If `joins_blanks` is set, blanks and tabs
  /// around cells do not count, and as separators several count as one.
  RowCells(std::string_view separators, bool joins_blanks) : joins_blanks_(joins_blanks) {
    for (const char c : separators) separates_[static_cast<unsigned char>(c)] = true;
  }

  /// Splits a row into at most `max_cells` cells, without blanks around them; valid until the next.
  const std::vector<std::string_view>& split(std::string_view row, std::size_t max_cells = std::string_view::npos) {
    cells_.clear();
    const auto skip_blanks = [&](std::size_t at) {
      while (joins_blanks_ && at < row.size() && text::is_blank(row[at])) ++at;
      return at;
    };
    if (joins_blanks_) row = text::trimmed(row);
    for (std::size_t begin = 0; cells_.size() < max_cells;) {
      std::size_t end = begin;
      while (end < row.size() && !separates(row[end])) ++end;
      cells_.push_back(text::trimmed(row.substr(begin, end - begin)));
      begin = skip_blanks(end);
      if (begin == row.size()) break;
      if (separates(row[begin])) ++begin;  // not after separating blanks
      begin = skip_blanks(begin);
    }
    return cells_;
  }

  [[nodiscard]] const std::vector<std::string_view>& cells() const noexcept { return cells_; }

 private:
  [[nodiscard]] bool separates(char c) const noexcept { return separates_[static_cast<unsigned char>(c)]; }

  std::array<bool, 256> separates_{};
  bool joins_blanks_ = true;
  std::vector<std::string_view> cells_;
};

/// Lines with the same defect.
struct Oddity {
  std::size_t first = 0, count = 0;  ///< first such line, and number of them

  void at(std::size_t line) noexcept {
    if (count++ == 0) first = line;
  }
};

/// Reader of a text table, row by row, independent of the locale. The separator is given, or found
/// in the first row: semicolon, else comma, else tab, else blanks, several as one. Quotation marks
/// do not protect separators. Lines may end as on any system; blank ones are skipped.
class TextTable {
 public:
  /// `expected` content, as in "a trajectory". @throws FileError for no file, or an empty one
  TextTable(const std::filesystem::path& path, std::string_view expected, std::optional<char> separator = {})
      : file_(path, expected), expected_(expected), is_fixed_(separator) {
    if (separator) cells_ = cells_between(*separator);
  }

  /// Finds the separator anew, in the next line whose cells are asked for, unless it is given.
  void forget_separator() noexcept {
    if (!is_fixed_) cells_.reset();
  }

  /// Advances to the next line that is not blank; false at the end.
  bool next() {
    while (const std::optional<std::string_view> line = file_.take_line()) {
      line_text_ = *line;
      if (std::ranges::any_of(*line, [](unsigned char c) { return c < ' ' && c != '\t'; }))
        fail_here("holds binary data: expected the text of " + expected_);
      if (!text().empty()) return true;
    }
    return false;
  }

  /// Current line without surrounding blanks.
  [[nodiscard]] std::string_view text() const { return text::trimmed(line_text_); }

  [[nodiscard]] std::size_t line() const noexcept { return file_.line(); }  ///< number, from 1
  [[nodiscard]] bool line_is_open() const noexcept { return file_.line_is_open(); }
  [[nodiscard]] const std::string& path() const noexcept { return file_.path(); }

  /// Cells of the current line, without blanks and quotation marks around; valid until the next.
  [[nodiscard]] const std::vector<std::string_view>& cells() {
    if (!cells_) cells_ = cells_between(separator_in(text()));
    unquoted_ = cells_->split(line_text_);
    for (std::string_view& cell : unquoted_)
      if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
        cell = text::trimmed(cell.substr(1, cell.size() - 2));
    return unquoted_;
  }

  [[noreturn]] void fail(const auto&... problem) const { file_.fail(problem...); }
  [[noreturn]] void fail_here(std::string_view what, const auto&... more) const { file_.fail_at_line(what, more...); }

  /// `column` is counted from 0 here, from 1 in the message.
  [[noreturn]] void fail_here(std::size_t column, const auto&... problem) const {
    file_.fail_at_column(column, problem...);
  }

  /// Throws a `FileError` about a text of the current line that is none of what is expected.
  [[noreturn]] void refuse(std::string_view text, const auto&... expected) const {
    fail_here(text::quoted(text), ": expected ", expected...);
  }
  [[noreturn]] void refuse(std::size_t column, const auto&... expected) const {
    fail_here(column, text::quoted(unquoted_[column]), ": expected ", expected...);
  }

  /// Adds a warning about a line, or the whole file for line 0.
  void warn(std::size_t line, const auto&... oddity) { warnings.push_back(detail::warning(path(), line, oddity...)); }
  /// Adds a warning about lines, if there are any.
  void warn(const Oddity& lines, std::string_view what, std::string_view consequence = {}) {
    if (lines.count > 0) warn(lines.first, what, ", the first of ", lines.count, consequence);
  }

  std::vector<std::string> warnings;  ///< oddities that could still be read

 private:
  [[nodiscard]] static char separator_in(std::string_view row) {
    for (const char separator : {';', ',', '\t'})
      if (row.find(separator) != row.npos) return separator;
    return ' ';
  }

  [[nodiscard]] static RowCells cells_between(char separator) {
    return separator == ' ' ? RowCells(text::blanks, true) : RowCells({&separator, 1}, separator != '\t');
  }

  InputFile file_;
  std::string expected_;
  bool is_fixed_;
  std::string_view line_text_;
  std::optional<RowCells> cells_;
  std::vector<std::string_view> unquoted_;
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
