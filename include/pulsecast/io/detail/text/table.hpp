// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <pulsecast/base/error.hpp>

namespace pulsecast::io {

/// Reader of a text table, row by row, independent of the locale, with line and column for errors. The separator is given, or found in the
/// first row: semicolon, else comma, else tab, else blanks, several as one. Quotation marks do not protect separators. Lines may end as on
/// any system; blank ones are skipped.
class TextTable {
 public:
  /// `expected` content for error messages, as in "a trajectory". Throws a `FileError` if there is no such file, or it is empty.
  TextTable(const std::filesystem::path& path, std::string_view expected, std::optional<char> separator = {})
      : path_(path.string()), expected_(expected), separator_(separator) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) fail("does not exist: expected " + expected_);
    if (!std::filesystem::is_regular_file(path, ignored)) fail("is a directory or device: expected " + expected_);
    file_.open(path, std::ios::binary);
    const bool has_some = file_ && file_.peek() != std::ifstream::traits_type::eof();
    if (!file_.is_open() || file_.bad()) fail("cannot be read");
    if (!has_some) fail("is empty: expected " + expected_);
  }

  /// Advances to the next line that is not blank; false at the end.
  bool next() {
    while (std::getline(file_, buffer_)) {
      line_is_open_ = file_.eof();
      if (++line_ == 1 && buffer_.starts_with("\xEF\xBB\xBF")) buffer_.erase(0, 3);  // byte order mark of UTF-8
      if (buffer_.ends_with('\r')) buffer_.pop_back();
      if (std::any_of(buffer_.begin(), buffer_.end(), [](unsigned char c) { return c < ' ' && c != '\t'; }))
        fail_here("holds binary data: expected the text of " + expected_);
      if (!text().empty()) return true;
    }
    if (file_.bad()) fail("cannot be read");
    return false;
  }

  /// Current line without surrounding blanks.
  [[nodiscard]] std::string_view text() const { return trimmed(buffer_); }

  [[nodiscard]] std::size_t line() const noexcept { return line_; }           ///< number of the line, from 1
  [[nodiscard]] bool line_is_open() const noexcept { return line_is_open_; }  ///< true for a last line without end
  [[nodiscard]] const std::string& path() const noexcept { return path_; }    ///< path of the file

  /// Cells of the current line without surrounding blanks and quotation marks. Valid until the next line.
  [[nodiscard]] const std::vector<std::string_view>& cells() {
    if (!separator_) separator_ = separator_in(buffer_);
    cells_.clear();
    if (*separator_ == ' ') {
      for (std::string_view left = text(); !left.empty(); left = trimmed(left)) {
        const std::size_t end = std::min(left.find_first_of(blanks), left.size());
        cells_.push_back(unquoted(left.substr(0, end)));
        left.remove_prefix(end);
      }
    } else {
      for (std::string_view left = buffer_;;) {
        const std::size_t end = std::min(left.find(*separator_), left.size());
        cells_.push_back(unquoted(trimmed(left.substr(0, end))));
        if (end == left.size()) break;
        left.remove_prefix(end + 1);
      }
    }
    return cells_;
  }

  /// Number in a cell; empty unless the whole cell is a finite number with a decimal point.
  [[nodiscard]] static std::optional<double> number_in(std::string_view cell) {
    if (cell.starts_with('+') && !cell.starts_with("+-")) cell.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    const bool is_all = error == std::errc{} && end == cell.data() + cell.size();
    return is_all && std::isfinite(value) ? std::optional(value) : std::nullopt;
  }

  /// Quotation of a text for an error message, cut to 64 characters.
  [[nodiscard]] static std::string quoted(std::string_view text) {
    return std::string("'").append(text.substr(0, 64)) + (text.size() > 64 ? "...'" : "'");
  }

  [[noreturn]] void fail(const std::string& problem) const { throw FileError(path_, "", problem); }
  [[noreturn]] void fail_here(const std::string& problem) const { throw FileError(path_, place(line_), problem); }

  /// `column` is counted from 0 here, from 1 in the message.
  [[noreturn]] void fail_here(std::size_t column, const std::string& problem) const {
    throw FileError(path_, place(line_) + ", column " + std::to_string(column + 1), problem);
  }

  [[nodiscard]] static std::string place(std::size_t line) { return "line " + std::to_string(line); }

 private:
  static constexpr std::string_view blanks = " \t";

  [[nodiscard]] static std::string_view trimmed(std::string_view text) {
    const std::size_t first = std::min(text.find_first_not_of(blanks), text.size());
    return text.substr(first, text.find_last_not_of(blanks) + 1 - first);
  }

  [[nodiscard]] static std::string_view unquoted(std::string_view cell) {
    return cell.size() >= 2 && cell.front() == '"' && cell.back() == '"' ? trimmed(cell.substr(1, cell.size() - 2)) : cell;
  }

  [[nodiscard]] static char separator_in(std::string_view row) {
    for (const char separator : {';', ',', '\t'})
      if (trimmed(row).find(separator) != row.npos) return separator;
    return ' ';
  }

  std::string path_, expected_;
  std::optional<char> separator_;
  std::ifstream file_;
  std::string buffer_;
  std::size_t line_ = 0;
  bool line_is_open_ = false;
  std::vector<std::string_view> cells_;
};

}  // namespace pulsecast::io
