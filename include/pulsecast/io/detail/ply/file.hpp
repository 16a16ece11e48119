// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PLY_FILE_HPP
#define PULSECAST_IO_DETAIL_PLY_FILE_HPP

#include <pulsecast/io/detail/ply/rules.hpp>
#include <pulsecast/io/point_records.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Rows of a kind in a PLY file, and the properties of each.
struct PlyElement {
  struct Property {
    std::string name{};                  ///< canonical
    NumberType type{};                   ///< of its numbers
    std::optional<NumberType> length{};  ///< of a list: type of its length
  };
  std::string name{};
  std::uint64_t count = 0;  ///< number of rows
  std::vector<Property> properties{};

  /// First property of a canonical name that is a list, or is none.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view of, bool list = false) const {
    for (std::size_t k = 0; k < properties.size(); ++k)
      if (properties[k].name == of && properties[k].length.has_value() == list) return k;
    return std::nullopt;
  }
};

/// PLY file, read row by row in memory independent of its size, as numbers of double precision. Throws a `FileError`
/// with path and line or byte. Source: Turk 1994, The PLY polygon file format.
class PlyFile {
 public:
  /// True if the file begins with the PLY signature.
  [[nodiscard]] static bool is_ply(InputFile& file) {
    file.seek(0);
    const std::string_view head = text::without_byte_order_mark(file.take(7));
    const bool is = head.starts_with("ply") && (head.size() < 4 || head[3] == '\n' || head[3] == '\r');
    file.seek(0);
    return is;
  }

  explicit PlyFile(InputFile file) : file_(std::move(file)) { read_header(); }

  [[nodiscard]] const std::vector<PlyElement>& elements() const noexcept { return elements_; }
  [[nodiscard]] const std::vector<std::string>& remarks() const noexcept { return remarks_; }  ///< comments, obj_info
  [[nodiscard]] bool is_text() const noexcept { return is_text_; }
  [[nodiscard]] const std::string& path() const noexcept { return file_.path(); }

  /// Keeps to the rules for elements, all of which have one, and for those properties and remarks that have one.
  void keep_rules(std::span<const FormatRule> rules, std::vector<std::string>& warnings) const {
    const auto keep = [&](std::string_view kind, const std::string& name, bool always = false) {
      const FormatRule* const rule = rule_of(rules, name);
      if (always || (rule && rule->name != "*")) (void)keep_rule(rules, path(), kind, name, warnings);
    };
    for (const PlyElement& element : elements_) {
      if (element.count > 0) keep("element", element.name, true);
      for (const auto& one : element.properties) keep("property", element.name + ' ' + one.name);
    }
    for (const std::string& remark : remarks_) {
      const std::string_view kind = kind_of_comment(remark);
      const std::string first = text::lower(remark.substr(0, remark.find_first_of(" \t:=,")));
      keep("header line", text::message("comment ", kind.empty() ? first : kind));
    }
  }

  /// Advances to the next element, past the rows that are left of the current one; false after the last.
  [[nodiscard]] bool next_element() {
    while (next()) continue;
    if (current_ + 1 >= elements_.size()) return false;
    ++current_;  // from -1 to the first
    row_ = 0;
    numbers_.assign(element().properties.size(), 0);
    lists_.assign(element().properties.size(), {});
    return true;
  }

  [[nodiscard]] const PlyElement& element() const noexcept { return elements_[current_]; }

  /// Advances to the next row of the element; false after the last.
  [[nodiscard]] bool next() {
    if (current_ >= elements_.size() || row_ == element().count) return false;
    ++row_;
    at_ = file_.position();
    while (is_text_ && text_.empty()) take_line();
    const auto& all = element().properties;
    for (std::size_t k = 0; k < all.size(); ++k)
      all[k].length ? take_list(all[k], lists_[k]) : static_cast<void>(numbers_[k] = take_number(all[k].type));
    if (!text_.empty()) fail_here("has more values than its header names");
    return true;
  }

  [[nodiscard]] double number(std::size_t property) const noexcept { return numbers_[property]; }  ///< of the row
  [[nodiscard]] const std::vector<double>& list(std::size_t property) const noexcept { return lists_[property]; }

  /// Throws a `FileError` about the current row.
  [[noreturn]] void fail_here(const auto&... problem) const {
    if (is_text_) fail_at(path(), header_lines_ + file_.line(), element().name, ' ', row_ - 1, ": ", problem...);
    file_.fail_at_byte(at_, element().name, ' ', row_ - 1, ": ", problem...);
  }

 private:
  void read_header() {
    const std::string head(file_.take(std::size_t{1} << 16));
    std::string_view rest = text::without_byte_order_mark(head), format;
    file_.check_first(rest.substr(0, rest.find('\n')));
    for (std::string_view key; key != "end_header";) {
      if (rest.find('\n') == rest.npos) file_.fail("is no PLY file: its PLY header has no end_header within 64 KiB");
      std::string_view line = text::trimmed(text::take_line(rest));
      ++header_lines_;
      key = text::take_word(line);
      if (key == "format") {
        format = text::take_word(line);
      } else if (key == "comment" || key == "obj_info") {
        remarks_.emplace_back(line);
      } else if (key == "element") {
        add_element(line);
      } else if (key == "property") {
        add_property(line);
      } else if (key != "ply" && key != "end_header" && !key.empty()) {
        fail_at(path(), header_lines_, text::quoted(key), ": expected a line of a PLY header");
      }
    }
    is_text_ = format == "ascii";
    const bool is_big = format == "binary_big_endian";
    if (!is_text_ && !is_big && format != "binary_little_endian")
      file_.fail("has the PLY format ", text::quoted(format),
                 ": expected ascii, binary_little_endian or binary_big_endian");
    swaps_ = is_big == (std::endian::native == std::endian::little);
    file_.seek(head.size() - rest.size());
    require_room();
  }

  void add_element(std::string_view line) {
    PlyElement made{.name = text::lower(text::take_word(line))};
    const auto count = text::number_in<std::uint64_t>(text::take_word(line));
    if (!count || std::ranges::find(elements_, made.name, &PlyElement::name) != elements_.end())
      fail_at(path(), header_lines_, "element ", text::quoted(made.name),
              ": expected the number of its rows, and each element once");
    made.count = *count;
    elements_.push_back(std::move(made));
  }

  void add_property(std::string_view line) {
    constexpr std::array<std::string_view, 16> names{"char",   "int8",    "uchar",  "uint8",  "short", "int16",
                                                     "ushort", "uint16",  "int",    "int32",  "uint",  "uint32",
                                                     "float",  "float32", "double", "float64"};
    const auto type = [&] {
      const std::string_view word = text::take_word(line);
      const auto found = std::ranges::find(names, word);
      if (found == names.end() || elements_.empty())
        fail_at(path(), header_lines_, text::quoted(word), ": expected a type of numbers, as in 'property float x'");
      return static_cast<NumberType>(1 + (found - names.begin()) / 2);  // in the order of the types
    };
    PlyElement::Property made;
    const bool is_list = line.starts_with("list");
    if (is_list) (void)text::take_word(line);
    if (is_list) made.length = type();
    made.type = type();
    made.name = canonical_name(text::take_word(line));
    elements_.back().properties.push_back(std::move(made));
  }

  /// Refuses counts of rows that do not fit into the file.
  void require_room() const {
    auto room = static_cast<double>(file_.size() - file_.position() + 1);
    for (const PlyElement& one : elements_) {
      std::size_t row = 0;  // at least [byte]
      for (const auto& p : one.properties) row += is_text_ ? 2 : size_of(p.length.value_or(p.type));
      room -= static_cast<double>(one.count) * static_cast<double>(row);
      if ((row == 0 && one.count > 0) || room < 0)
        file_.fail("claims ", one.count, " rows of the element ", text::quoted(one.name), " with ",
                   one.properties.size(), " properties: expected no more than fit into the file's ", file_.size(),
                   " bytes");
    }
  }

  void take_line() {
    const std::optional<std::string_view> line = file_.take_line();
    if (!line) fail_here("the file ends: expected more rows");
    text_ = text::trimmed(*line);
  }

  /// Next number of the row; NaN for a text that is none.
  [[nodiscard]] double take_number(NumberType type) {
    if (is_text_) {
      if (text_.empty()) fail_here("has fewer values than its header names");
      return text::number_in<double>(text::take_word(text_)).value_or(std::numeric_limits<double>::quiet_NaN());
    }
    const std::string_view bytes = file_.take(size_of(type));
    if (bytes.size() < size_of(type)) fail_here("the file ends: expected more rows");
    return visit_number_type(type, [&]<class Number>() {
      std::array<char, sizeof(Number)> copy;
      std::ranges::copy(bytes, copy.begin());
      if (swaps_) std::ranges::reverse(copy);
      return static_cast<double>(std::bit_cast<Number>(copy));
    });
  }

  void take_list(const PlyElement::Property& of, std::vector<double>& list) {
    const double length = take_number(*of.length);
    const std::uint64_t room = is_text_ ? text_.size() : (file_.size() - file_.position()) / size_of(of.type);
    if (!(length >= 0 && length == std::floor(length) && length <= static_cast<double>(room)))
      fail_here("has a list of ", length, " numbers: expected a whole number that fits into the file");
    list.resize(static_cast<std::size_t>(length));
    for (double& one : list) one = take_number(of.type);
  }

  InputFile file_;
  std::vector<PlyElement> elements_;
  std::vector<std::string> remarks_;
  bool is_text_ = false, swaps_ = false;
  std::size_t header_lines_ = 0, current_ = std::numeric_limits<std::size_t>::max();
  std::uint64_t row_ = 0, at_ = 0;  // rows taken; byte of the current one
  std::string_view text_;           // rest of the current line
  std::vector<double> numbers_;     // by property, as the next
  std::vector<std::vector<double>> lists_;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
