// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <string>
#include <string_view>

/// Name of a file in the notation of logs and lists: `\x` and two digits for each control character and backslash.
[[nodiscard]] inline std::string written_name(const std::string& name) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (const char letter : name) {
    const auto c = static_cast<unsigned char>(letter);
    if (c >= ' ' && c != 0x7f && c != '\\')
      text += letter;
    else
      text.append("\\x").append({digits[c >> 4], digits[c & 15]});
  }
  return text;
}

/// Name in that notation, as it was.
[[nodiscard]] inline std::string name_written(std::string_view text) {
  std::string name;
  for (; !text.empty(); text.remove_prefix(1)) {
    unsigned c = 0;
    const bool is_escape = text.starts_with("\\x") && text.size() >= 4 &&
                           std::from_chars(text.data() + 2, text.data() + 4, c, 16).ptr == text.data() + 4;
    name += is_escape ? static_cast<char>(c) : text.front();
    if (is_escape) text.remove_prefix(3);
  }
  return name;
}
