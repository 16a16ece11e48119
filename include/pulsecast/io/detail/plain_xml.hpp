// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PLAIN_XML_HPP
#define PULSECAST_IO_DETAIL_PLAIN_XML_HPP

#include <pulsecast/io/input_file.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Refuses declared encodings but UTF-8, US-ASCII and ISO-8859-1. Source: XML 1.0, 2.8 and 4.3.3.
inline void require_plain_encoding(std::string_view text, const std::filesystem::path& path) {
  constexpr std::string_view blanks = " \t\r\n";
  if (!text.starts_with("<?xml") || text.find_first_of(blanks) != 5) return;
  text = text.substr(5, text.find("?>") - 5);
  while (text.find_first_not_of(blanks) != text.npos) {  // name = "value"
    text.remove_prefix(text.find_first_not_of(blanks));
    const std::string_view name = text::take_word(text, " \t\r\n=");
    const char quote = text.empty() ? ' ' : text.front();
    const std::size_t end = text.find(quote, 1);
    if (end == text.npos || (quote != '"' && quote != '\'')) fail(path, "has a malformed XML declaration");
    const std::string_view value = text.substr(1, end - 1);
    text.remove_prefix(end + 1);
    if (name == "encoding" && std::ranges::none_of(std::array{"UTF-8", "US-ASCII", "ISO-8859-1"},
                                                   [&](const char* one) { return text::is_same_word(value, one); }))
      fail(path, "has the encoding ", text::quoted(value), ": expected UTF-8, US-ASCII or ISO-8859-1");
  }
}

/// Refuses XML files with a document type, by which they open others and grow without end, and with
/// encodings that could hide one: its letters must have the bytes of ASCII.
inline void require_plain_xml(const std::filesystem::path& path) {
  const MappedFile file(path, "an XML file");
  const std::string_view text = text::without_byte_order_mark(file.text());
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start == text.npos || text[start] != '<' || text.substr(0, 64).find('\0') != text.npos)
    fail(path, "does not begin as XML in UTF-8");
  require_plain_encoding(text.substr(start), path);
  if (text.find("<!DOCTYPE") != text.npos || text.find("<!ENTITY") != text.npos)
    fail(path, "has a document type: expected none");
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
