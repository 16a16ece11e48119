// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_DOCUMENT_HPP
#define PULSECAST_HELIOS_DETAIL_XML_DOCUMENT_HPP

#include <pulsecast/base/search.hpp>
#include <pulsecast/helios/detail/xml/encoding.hpp>
#include <pulsecast/helios/detail/xml/faults.hpp>
#include <pulsecast/io/input_file.hpp>

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
