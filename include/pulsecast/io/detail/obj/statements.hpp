// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_OBJ_STATEMENTS_HPP
#define PULSECAST_IO_DETAIL_OBJ_STATEMENTS_HPP

#include <streambuf>

#include <tiny_obj_loader.h>

#include <pulsecast/io/detail/mesh_file/mesh_rules.hpp>

/// Statements of OBJ and MTL files.
namespace PULSECAST_NAMESPACE::io::detail {

static_assert(std::same_as<tinyobj::real_t, double>,
              "define TINYOBJLOADER_USE_DOUBLE and link libtinyobjloader_double");

inline constexpr double max_number = 1e12;  ///< in a file, so that products cannot overflow

/// Number, if tinyobjloader reads the same: it reads others in part, and fails at long ones.
template <class Number>
[[nodiscard]] std::optional<Number> number_in(std::string_view word) {
  const std::optional<Number> value = word.size() <= 100 ? text::number_in<Number>(word) : std::nullopt;
  return value && std::isfinite(static_cast<double>(*value)) ? value : std::nullopt;
}

/// Statements that are noted by rules: for each rule their number, and the first of them.
class StatementNotes {
 public:
  explicit StatementNotes(std::span<const FormatRule> rules) : rules_(rules) {}

  /// Keeps to the rule for a statement. @throws FileError for one that is refused
  void keep(std::string_view name, const std::string& path, std::size_t line, std::string_view statement) {
    const FormatRule* const rule = rule_of(rules_, name);
    if (rule->use == FormatUse::refused) fail_at(path, line, text::quoted(statement), ": expected ", rule->meaning);
    if (rule->use != FormatUse::noted) return;
    Note& note = notes_[rule];
    if (++note.count == 1 || line < note.line) note = {note.count, line, std::string(statement)};
  }
  /// Adds the notes of a later part of the file.
  void add(const StatementNotes& more) {
    for (const auto& [rule, note] : more.notes_)
      if (const auto [known, is_new] = notes_.try_emplace(rule, note); !is_new) known->second.count += note.count;
  }
  void tell(const std::string& path, std::vector<std::string>& warnings) const {
    for (const auto& [rule, note] : notes_)
      warnings.push_back(warning(path, note.line, note.text.empty() ? "" : text::quoted(note.text) + ": ",
                                 rule->meaning, ", the first of ", note.count));
  }

 private:
  struct Note {
    std::size_t count = 0, line = 0;
    std::string text{};
  };
  std::span<const FormatRule> rules_;
  std::map<const FormatRule*, Note> notes_;
};

/// Text of an OBJ or MTL file, read in pieces.
class StatementFile : public InputFile {
 public:
  explicit StatementFile(const std::filesystem::path& path) : InputFile(path, "an OBJ or MTL file") {}

  /// Next whole statements, about `bytes` long; empty at the end of the file.
  [[nodiscard]] std::string next(std::size_t bytes) {
    std::string text = std::exchange(rest_, {});
    std::size_t end = 0;
    while (end == 0) {
      const std::string_view more = take(bytes);
      if (more.empty()) break;
      text += more;
      end = end_of_statements(text);
    }
    if (end > 0) {
      rest_.assign(text, end);
      text.resize(end);
    }
    if (!std::exchange(begun_, true)) text.erase(0, text.size() - text::without_byte_order_mark(text).size());
    return text;
  }

 private:
  /// End of the last line that is not continued in the next; 0 if there is none.
  static std::size_t end_of_statements(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = text.rfind('\n') + 1;
      text = text.substr(0, end == 0 ? 0 : end - 1);
      const std::size_t last = text.find_last_not_of(" \t\v\f\r");
      if (end > 0 && (last == text.npos || text[last] != '\\')) return end;
    }
    return 0;
  }

  std::string rest_;
  bool begun_ = false;
};

/// Buffer that feeds tinyobjloader by statements, so that checks and errors have their lines.
class StatementBuffer : public std::streambuf {
 public:
  /// `text` of whole statements of a file, after `lines_before` lines.
  StatementBuffer(std::string path, std::string text, std::size_t lines_before)
      : path_(std::move(path)), text_(std::move(text)), lines_before_(lines_before), lines_(lines_before) {}

 protected:
  /// Sets `ready`, empty at first, to the current statement for tinyobjloader. @throws FileError
  virtual void check(std::string& ready) = 0;
  /// Called for each comment.
  virtual void remark() {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::size_t line() const { return line_; }                   ///< its first line, from 1
  [[nodiscard]] bool line_is_open() const { return open_; }                  ///< for a last line without end
  [[nodiscard]] const std::string& statement() const { return statement_; }  ///< one blank after keyword
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
      if (statement_.starts_with('#')) remark();
    } while (statement_.empty() || statement_.starts_with('#'));
    if (statement_.find('#') != statement_.npos && !keyword().ends_with("mtl"))  // not in `usemtl Material #25`
      statement_.resize(std::min(statement_.find(" #"), statement_.size()));
    const std::string_view word = keyword(), after = rest();
    if (statement_.size() != word.size() + (after.empty() ? 0 : 1) + after.size())
      statement_ = std::string(word) + (after.empty() ? "" : " ") + std::string(after);
    return true;
  }

 private:
  int_type underflow() final {
    if (!next_statement()) return traits_type::eof();
    ready_.clear();
    check(ready_);
    ready_ += '\n';
    setg(ready_.data(), ready_.data(), ready_.data() + ready_.size());
    return traits_type::to_int_type(ready_.front());
  }

  /// Joins lines continued by a backslash, unlike tinyobjloader. False at the end of the text.
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
      if (c == '\r' && i + 1 < after && text_[i + 1] != c) fail(path_, InputFile::cr_alone);
      c = ' ';
    }
    return text::trimmed(std::string_view(text_).substr(begin, after - begin));
  }

  std::string path_, text_;
  std::string joined_, statement_, ready_;
  std::vector<std::string_view> words_;
  std::size_t lines_before_, lines_, line_ = 0, at_ = 0;  // `at_`: begin of the next line
  bool open_ = false;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
