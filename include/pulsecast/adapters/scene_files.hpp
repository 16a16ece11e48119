// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/adapters/mapped_file.hpp>
#include <pulsecast/adapters/survey_settings.hpp>
#include <pulsecast/base/error.hpp>

namespace pulsecast::adapters {

/// All files that a scene is built from, in any run, each once: those that its settings name, and the materials that OBJ files name. Files
/// that are not there are left out; whoever builds the scene will say so.
[[nodiscard]] std::vector<std::filesystem::path> scene_files(const SceneSettings& scene);

namespace detail {

class SceneFiles {
 public:
  void add(const PartSource& source) {
    std::visit(
        [this](const auto& s) {
          for (const std::filesystem::path& file : s.files)
            if (add(file) && std::is_same_v<decltype(s), const ObjSource&>) add_materials(file);
          if constexpr (requires { s.material; }) add(s.material.file);
          if constexpr (requires { s.leaf_angles; }) add(s.leaf_angles);
        },
        source);
  }

  [[nodiscard]] std::vector<std::filesystem::path> take() { return std::move(files_); }

 private:
  /// Whether it is there and was not before.
  bool add(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored) || !seen_.insert(file).second) return false;
    files_.push_back(file);
    return true;
  }

  /// What `mtllib` in an OBJ file may name.
  void add_materials(const std::filesystem::path& obj) {
    try {
      const MappedFile file(obj);
      const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()), keyword = "mtllib";
      for (std::size_t at = text.find(keyword); at != text.npos; at = text.find(keyword, at)) {
        at += keyword.size();
        std::size_t end = std::min(text.find('\n', at), text.size());
        while (end < text.size() && text.substr(at, end - at).find_last_of('\\') != text.npos &&
               text.substr(at, end - at).find_last_not_of(" \t\r") == text.substr(at, end - at).find_last_of('\\'))
          end = std::min(text.find('\n', end + 1), text.size());  // the statement goes on
        add_named(obj.parent_path(), std::string(text.substr(at, end - at)));
      }
    } catch (const FileError&) {  // cannot be read
    }
  }

  /// Names one after the other, or one that has blanks.
  void add_named(const std::filesystem::path& folder, std::string names) {
    constexpr const char* blanks = " \t\r\n";
    std::replace(names.begin(), names.end(), '\\', '/');
    const std::size_t first = names.find_first_not_of(blanks);
    if (first == names.npos) return;
    add(folder / names.substr(first, names.find_last_not_of(blanks) + 1 - first));
    for (std::size_t word = first; word != names.npos;) {
      const std::size_t end = std::min(names.find_first_of(blanks, word), names.size());
      add(folder / names.substr(word, end - word));
      word = names.find_first_not_of(blanks, end);
    }
  }

  std::vector<std::filesystem::path> files_;
  std::set<std::filesystem::path> seen_;
};

}  // namespace detail

inline std::vector<std::filesystem::path> scene_files(const SceneSettings& scene) {
  detail::SceneFiles files;
  for (const PartSettings& part : scene.parts) {
    files.add(part.source);
    for (const SwapSettings& swap : part.swaps)
      if (swap.source) files.add(*swap.source);
  }
  return files.take();
}

}  // namespace pulsecast::adapters
