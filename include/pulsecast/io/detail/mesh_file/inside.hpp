// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_INSIDE_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_INSIDE_HPP

#include <filesystem>
#include <string>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// True for a path that does not leave a folder by its words; links are followed.
[[nodiscard]] inline bool is_inside(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const std::filesystem::path within = std::filesystem::absolute(file).lexically_normal().lexically_relative(
      std::filesystem::absolute(folder).lexically_normal());
  return !within.empty() && *within.begin() != "..";
}

/// Text with `%20` as a blank, and so on. Source: RFC 3986, 2.1.
[[nodiscard]] inline std::string unescaped(const std::string& text) {
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string made;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0;
    made += escape ? static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2])) : text[i];
    if (escape) i += 2;
  }
  return made;
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
