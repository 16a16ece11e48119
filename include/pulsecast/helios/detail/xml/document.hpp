// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_DOCUMENT_HPP
#define PULSECAST_HELIOS_DETAIL_XML_DOCUMENT_HPP

#include <pugixml.hpp>

#include <pulsecast/base/search.hpp>
#include <pulsecast/helios/detail/xml/faults.hpp>
#include <pulsecast/io/input_file.hpp>

/// Encodings of XML documents.
namespace PULSECAST_NAMESPACE::helios::xml {

/// Encoding that a document names, in small letters; empty if none. Source: XML 1.0, 2.8 and 4.3.3.
[[nodiscard]] inline std::string declared_encoding(std::string_view text) {
  if (!text.starts_with("<?xml")) return {};
  const std::string_view line = text.substr(0, std::min(text.find("?>"), text.size()));
  const std::size_t name = line.find("encoding"), open = line.find_first_of("\"'", name);
  if (name == line.npos || open == line.npos) return {};
  return text::lower(line.substr(open + 1, line.find(line[open], open + 1) - open - 1));
}

/// Place of the first byte that is not in a UTF-8 character, or the end. Source: RFC 3629, 4.
[[nodiscard]] inline std::size_t first_not_utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned lead = byte(i);
    const std::size_t more = lead < 0x80                   ? 0
                             : lead >= 0xC2 && lead < 0xE0 ? 1
                             : lead >= 0xE0 && lead < 0xF0 ? 2
                             : lead >= 0xF0 && lead < 0xF5 ? 3
                                                           : 9;
    const unsigned least = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
    const unsigned most = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
    if (more == 9 || (more > 0 && (byte(i + 1) < least || byte(i + 1) > most))) return i;
    for (std::size_t k = 2; k <= more; ++k)
      if ((byte(i + k) & 0xC0) != 0x80) return i;
    i += more + 1;
  }
  return text.size();
}

/// Text in UTF-8 of one in windows-1252, which holds ISO-8859-1 but for control characters.
/// Source: WHATWG, Encoding Standard, index windows-1252.
[[nodiscard]] inline std::string utf8_of_windows_1252(std::string_view text) {
  static constexpr std::array<std::uint16_t, 32> from_0x80{
      0x20AC, 0x81,   0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
      0x2039, 0x0152, 0x8D,   0x017D, 0x8F,   0x90,   0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
      0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0x9D,   0x017E, 0x0178};
  std::wstring made;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    made += static_cast<wchar_t>(byte >= 0x80 && byte < 0xA0 ? from_0x80[byte - 0x80U] : byte);
  }
  return pugi::as_utf8(made);
}

/// Text in UTF-8 of one in UTF-16 with a byte order mark, half pairs as U+FFFD; none for others. Source: RFC 2781.
[[nodiscard]] inline std::optional<std::string> utf8_of_utf16(std::string_view text) {
  const bool is_little = text.starts_with("\xFF\xFE");
  if (!is_little && !text.starts_with("\xFE\xFF")) return std::nullopt;
  std::wstring made;
  for (std::size_t i = 2; i + 1 < text.size(); i += 2) {
    const auto first = static_cast<unsigned char>(text[i]), second = static_cast<unsigned char>(text[i + 1]);
    const int unit = is_little ? second << 8 | first : first << 8 | second;
    const int before = made.empty() ? 0 : static_cast<int>(made.back());
    if (before >= 0xD800 && before < 0xDC00 && unit >= 0xDC00 && unit < 0xE000)
      made.back() = static_cast<wchar_t>(0x10000 + ((before - 0xD800) << 10) + unit - 0xDC00);
    else
      made += static_cast<wchar_t>(unit);
  }
  std::ranges::replace_if(
      made, [](wchar_t c) { return c >= 0xD800 && c < 0xE000; }, wchar_t{0xFFFD});
  return pugi::as_utf8(made);
}

}  // namespace PULSECAST_NAMESPACE::helios::xml

namespace PULSECAST_NAMESPACE::helios {

/// Collects faults and warnings, each once.
class XmlReport {
 public:
  static constexpr std::size_t max_listed = 1000;  ///< of faults, and of warnings

  void fault(XmlPlace place, std::string problem) {
    if (is_full()) return;
    for (const XmlFault& other : faults_)
      if (other.place == place && other.problem == problem) return;
    if (lenient_) return warn(place, problem);
    faults_.push_back({std::move(place), std::move(problem)});
  }

  void warn(const XmlPlace& place, const std::string& problem) {
    if (is_full_of_warnings()) return;
    std::string text = place.text() + ": " + problem;
    if (std::ranges::find(warnings_, text) == warnings_.end()) warnings_.push_back(std::move(text));
    if (is_full_of_warnings()) warnings_.back() += "; more than " + std::to_string(max_listed) + " are not listed";
  }

  /// Calls `read()` and turns its faults into warnings, for elements without use.
  template <class Read>
  void leniently(Read read) {
    const bool before = std::exchange(lenient_, true);
    read();
    lenient_ = before;
  }

  /// True if no more faults are kept, so that searching can stop.
  [[nodiscard]] bool is_full() const noexcept { return faults_.size() == max_listed; }
  [[nodiscard]] bool is_full_of_warnings() const noexcept { return warnings_.size() == max_listed; }
  [[nodiscard]] std::size_t faults() const noexcept { return faults_.size(); }  ///< their number
  [[nodiscard]] bool is_clean() const noexcept { return faults_.empty(); }

  void require_clean() const {
    if (!faults_.empty()) throw XmlFaults(faults_, warnings_);
  }

  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

 private:
  std::vector<XmlFault> faults_;
  std::vector<std::string> warnings_;
  bool lenient_ = false;
};

/// XML file in memory, with the position of elements and attributes. Entities are refused.
class XmlDocument {
 public:
  static constexpr std::size_t max_file_size = std::size_t{64} << 20;      ///< [byte]
  static constexpr std::size_t max_attribute_size = std::size_t{1} << 16;  ///< [byte]
  static constexpr std::size_t max_attributes = 100;                       ///< per element

  /// Throws `XmlFaults` if the file is not XML.
  explicit XmlDocument(const std::filesystem::path& path) : path_(path.string()) {
    io::InputFile file(path, "an XML document");
    if (file.size() > max_file_size)
      file.fail("is longer than " + std::to_string(max_file_size) + " bytes: expected an XML document");
    text_ = file.take_rest();
    const std::optional<std::string> of_utf16 = xml::utf8_of_utf16(text_);
    if (of_utf16) text_ = *of_utf16;
    find_line_ends();
    if (const std::size_t zero = text_.find('\0'); zero != text_.npos)
      fail_at(zero, "holds binary data: expected an XML document; UTF-16 begins with a byte order mark");
    if (!of_utf16) decode();
    constexpr unsigned options = pugi::parse_default | pugi::parse_doctype;
    const auto status = document_.load_buffer(text_.data(), text_.size(), options, pugi::encoding_utf8);
    const char* const hint = status.status == pugi::status_end_element_mismatch
                                 ? " (this end tag does not match the last start tag)"
                             : status.status == pugi::status_no_document_element ? " (no element)"
                                                                                 : "";
    if (!status)
      fail_at(static_cast<std::size_t>(status.offset),
              text::joined({"is not well-formed XML: ", status.description(), hint}));
    for (const pugi::xml_node node : document_.children()) {
      if (node.type() == pugi::node_doctype && std::string_view(node.value()).find('[') != text_.npos)
        fail_at(text_.find("<!DOCTYPE"), "declares entities: expected a document without a DOCTYPE of its own");
      if (node.type() == pugi::node_element && node != root())
        fail_at(offset(node), "a second root element: expected the end of the file");
    }
    for (const pugi::xpath_node& found : document_.select_nodes("descendant::*")) check_attributes(found.node());
  }

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// Oddity of the encoding and its place; empty without.
  [[nodiscard]] const std::optional<XmlFault>& oddity() const noexcept { return oddity_; }
  [[nodiscard]] pugi::xml_node root() const noexcept { return document_.document_element(); }

  /// Position of an element, or of an attribute of it; that of the file for none.
  [[nodiscard]] XmlPlace place(pugi::xml_node node = {}, std::string_view attribute = {}) const {
    std::size_t found = offset(node);
    if (attribute.empty()) return place_of(found);
    each_attribute(found, [&](std::size_t at, std::string_view name, std::string_view) {
      if (name == attribute) found = at;
      return name != attribute;
    });
    return place_of(found);
  }

 private:
  /// Makes the text UTF-8. Lines stay.
  void decode() {
    const std::string declared = xml::declared_encoding(text_);
    const auto is_one_of = [&](auto... names) { return (... || (declared == names)); };
    const std::size_t odd = xml::first_not_utf8(text_);
    const bool is_utf8 = is_one_of("", "utf-8", "utf8", "us-ascii", "ascii");
    const bool is_ascii = std::ranges::none_of(text_, [](char c) { return static_cast<unsigned char>(c) >= 0x80; });
    if (is_ascii || (is_utf8 && odd == text_.size())) return;
    if (!is_utf8 && !is_one_of("iso-8859-1", "latin1", "windows-1252", "cp1252"))
      fail_at(0, "has the encoding " + text::quoted(declared) +
                     ": expected UTF-8, ISO-8859-1 or windows-1252, to "
                     "which iconv converts it");
    if (odd == text_.size()) {
      oddity_ = {place(), "names the encoding " + text::quoted(declared) + ", and is UTF-8, as which it is taken"};
      return;
    }
    if (is_utf8)
      oddity_ = {place_of(odd),
                 "is no UTF-8, and is taken as windows-1252; the first line may tell, as in "
                 "encoding=\"windows-1252\""};
    text_ = xml::utf8_of_windows_1252(text_);
    find_line_ends();
  }

  void find_line_ends() {
    line_ends_.clear();
    for (std::size_t i = 0; i < text_.size(); ++i)
      if (text_[i] == '\n') line_ends_.push_back(i);
  }

  /// Offset of the byte after the `<` of an element.
  [[nodiscard]] std::size_t offset(pugi::xml_node node) const {
    const std::ptrdiff_t at = node.offset_debug();
    return at < 0 ? 0 : std::min(static_cast<std::size_t>(at), text_.size());
  }

  [[nodiscard]] XmlPlace place_of(std::size_t byte) const {
    const std::size_t line =
        pulsecast::detail::first_not(line_ends_.size(), [&](std::size_t i) { return line_ends_[i] < byte; });
    const std::size_t begin = line == 0 ? 0 : line_ends_[line - 1] + 1;
    return {.path = path_, .line = line + 1, .column = byte - begin + 1};
  }

  [[noreturn]] void fail_at(std::size_t byte, std::string problem) const {
    throw XmlFaults({{place_of(std::min(byte, text_.size())), std::move(problem)}});
  }

  /// Calls visit(byte, name, value) for each attribute of an element, until it returns false.
  template <class Visit>
  void each_attribute(std::size_t at, Visit visit) const {
    const auto skip = [&](std::string_view set) { at = std::min(text_.find_first_not_of(set, at), text_.size()); };
    const auto seek = [&](std::string_view set) { at = std::min(text_.find_first_of(set, at), text_.size()); };
    seek(" \t\r\n/>");
    while (true) {
      skip(" \t\r\n");
      if (at == text_.size() || text_[at] == '>' || text_[at] == '/') return;
      const std::size_t begin = at;
      seek("= \t\r\n>");
      const std::string_view name = std::string_view(text_).substr(begin, at - begin);
      seek("\"'");
      if (at == text_.size()) return;
      const char quote = text_[at++];
      const std::size_t end = std::min(text_.find(quote, at), text_.size());
      if (!visit(begin, name, std::string_view(text_).substr(at, end - at))) return;
      at = std::min(end + 1, text_.size());
    }
  }

  /// Refuses repeated and overlong attributes of an element, which pugixml accepts silently.
  void check_attributes(pugi::xml_node node) const {
    std::vector<std::string_view> names;
    each_attribute(offset(node), [&](std::size_t at, std::string_view name, std::string_view value) {
      if (name.size() + value.size() > max_attribute_size)
        fail_at(at, text::joined({"an attribute is longer than ", std::to_string(max_attribute_size),
                                  " bytes: ", text::quoted(name)}));
      if (names.size() == max_attributes)
        fail_at(at, "attribute " + text::quoted(name) + " exceeds the maximum number of attributes");
      if (std::ranges::find(names, name) != names.end())
        fail_at(at, "attribute " + text::quoted(name) + " is given twice");
      names.push_back(name);
      return true;
    });
  }

  std::string path_, text_;
  std::optional<XmlFault> oddity_;
  std::vector<std::size_t> line_ends_;
  pugi::xml_document document_;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
