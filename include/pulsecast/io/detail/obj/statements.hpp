// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_OBJ_STATEMENTS_HPP
#define PULSECAST_IO_DETAIL_OBJ_STATEMENTS_HPP

#include <algorithm>
#include <vector>

#include <pulsecast/io/input_file.hpp>

/// Statements of OBJ and MTL files.
namespace PULSECAST_NAMESPACE::io::detail {

inline constexpr double max_number = 1e12;  ///< in a file, so that products cannot overflow

[[nodiscard]] inline std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  while (!text.empty()) words.push_back(text::take_word(text));
  return words;
}

/// Next whole statements of a file, about `bytes` long; empty at its end.
[[nodiscard]] inline std::string next_statements(InputFile& file, std::size_t bytes) {
  std::string text;
  for (bool goes_on = true; goes_on;) {
    const std::optional<std::string_view> line = file.take_line();
    if (!line) break;
    text += *line;
    if (!file.line_is_open()) text += '\n';
    const std::size_t last = line->find_last_not_of(" \t\v\f\r");
    goes_on = text.size() < bytes || (last != line->npos && (*line)[last] == '\\');
  }
  return text;
}

/// Statements of a text, one after the other; those of several lines are joined.
class Statements {
 protected:
  /// `text` of whole statements of a file, after `lines_before` lines.
  Statements(std::string path, std::string text, std::size_t lines_before)
      : path_(std::move(path)), text_(std::move(text)), lines_before_(lines_before), lines_(lines_before) {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::size_t line() const { return line_; }   ///< first line of the current statement, from 1
  [[nodiscard]] bool line_is_open() const { return open_; }  ///< for a last line without end
  [[nodiscard]] std::string_view keyword() const {
    return std::string_view(statement_).substr(0, statement_.find(' '));
  }
  [[nodiscard]] std::string_view rest() const {
    return text::trimmed(std::string_view(statement_).substr(keyword().size()));
  }

  [[nodiscard]] const std::vector<std::string_view>& words() {
    words_.clear();
    for (std::string_view left = rest(); !left.empty();) words_.push_back(text::take_word(left));
    return words_;
  }

  [[nodiscard]] std::string quoted() const { return text::quoted(statement_); }
  [[noreturn]] void fail_here(const auto&... problem) const { fail_at(path_, line_, problem...); }
  void require(bool fulfilled, const char* expected) const {
    if (!fulfilled) fail_here(quoted(), ": expected ", expected);
  }

  void rewind() noexcept {
    at_ = 0;
    lines_ = lines_before_;
  }

  /// Advances to the next statement that is not empty; false at the end of the text.
  bool next_statement() {
    do {
      if (!take_statement()) return false;
    } while (statement_.empty() || statement_.starts_with('#'));
    if (statement_.find('#') != statement_.npos && !keyword().ends_with("mtl"))  // not in `usemtl Material #25`
      statement_.resize(std::min(statement_.find(" #"), statement_.size()));
    return true;
  }

 private:
  /// Joins lines continued by a backslash. False at the end of the text.
  bool take_statement() {
    joined_.clear();
    line_ = lines_ + 1;
    for (bool goes_on = true; goes_on;) {
      open_ = at_ == text_.size();
      if (open_) break;
      const std::string_view text = take_line();
      goes_on = text.ends_with('\\') && !(joined_.empty() && text.starts_with('#'));
      if (joined_.empty() && !goes_on) {
        statement_ = text;
        return true;
      }
      joined_.append(text.substr(0, text.size() - (goes_on ? 1 : 0))) += ' ';
    }
    statement_ = text::trimmed(joined_);
    return !joined_.empty();
  }

  std::string_view take_line() {
    const std::size_t begin = at_, end = text_.find('\n', begin);
    open_ = end == text_.npos;
    at_ = open_ ? text_.size() : end + 1;
    const std::size_t after = open_ ? text_.size() : end;
    ++lines_;
    for (std::size_t i = begin; i < after; ++i) {
      char& c = text_[i];
      if (static_cast<unsigned char>(c) >= ' ') continue;
      if (c < '\t' || c > '\r') fail_here("holds binary data: expected the text of an OBJ or MTL file");
      c = ' ';
    }
    return text::trimmed(std::string_view(text_).substr(begin, after - begin));
  }

  std::string path_, text_;
  std::string joined_, statement_;
  std::vector<std::string_view> words_;
  std::size_t lines_before_, lines_, line_ = 0, at_ = 0;  // `at_`: begin of the next line
  bool open_ = false;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
