// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_NAMED_FILES_HPP
#define PULSECAST_HELIOS_DETAIL_NAMED_FILES_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/text.hpp>
#include <pulsecast/io/input_file.hpp>

/// Files that a mesh file names, found without knowing its format.
namespace PULSECAST_NAMESPACE::helios::detail {

/// Buffers and pictures that are there, beside a mesh file or below its folder, and whose names stand in it. A name is the longest text
/// without quotes, brackets and control characters before the ending of such a file; a part of it may be the name, too.
[[nodiscard]] inline std::vector<std::filesystem::path> files_named_in(const std::filesystem::path& mesh) {
  static constexpr std::array endings{"bin", "png", "jpg", "jpeg", "bmp", "tga", "gif", "psd", "pgm", "ppm", "pnm"};
  std::vector<std::filesystem::path> found;
  try {
    const io::MappedFile file(mesh);
    const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size());
    const std::filesystem::path folder = mesh.parent_path();
    for (std::size_t dot = text.find('.'); dot != text.npos; dot = text.find('.', dot + 1)) {
      const std::string_view after = text.substr(dot + 1, 4);
      const auto ending = std::find_if(endings.begin(), endings.end(),
                                       [&](std::string_view one) { return text::is_same_word(after.substr(0, one.size()), one); });
      if (ending == endings.end()) continue;
      std::size_t begin = dot;
      const auto is_of_name = [](char c) { return static_cast<unsigned char>(c) >= ' ' && std::strchr("\"'<>|*?", c) == nullptr; };
      while (begin > 0 && dot - begin < 1000 && is_of_name(text[begin - 1])) --begin;
      std::string name(text.substr(begin, dot - begin + 1 + std::strlen(*ending)));
      std::replace(name.begin(), name.end(), '\\', '/');
      for (std::size_t blank = name.find("%20"); blank != name.npos; blank = name.find("%20")) name.replace(blank, 3, " ");
      std::error_code ignored;
      for (const std::filesystem::path& one : {(folder / name).lexically_normal(), folder / std::filesystem::path(name).filename()})
        if (std::filesystem::is_regular_file(one, ignored) && std::find(found.begin(), found.end(), one) == found.end())
          found.push_back(one);
    }
  } catch (const FileError&) {  // unreadable
  }
  return found;
}

}  // namespace PULSECAST_NAMESPACE::helios::detail

#endif
