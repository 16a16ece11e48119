// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_ENCODING_HPP
#define PULSECAST_HELIOS_DETAIL_XML_ENCODING_HPP

#include <algorithm>
#include <array>

#include <pugixml.hpp>

#include <pulsecast/base/text.hpp>

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

/// Text in UTF-8 of one in UTF-16 with a byte order mark; halves of pairs become U+FFFD. None for other texts.
/// Source: RFC 2781.
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

#endif
