// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_ASSET_SEARCH_HPP
#define PULSECAST_HELIOS_DETAIL_ASSET_SEARCH_HPP

#include <filesystem>
#include <regex>
#include <vector>

#include <pulsecast/base/text.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Files found under a name, or the reason why there are none.
struct AssetMatch {
  std::vector<std::filesystem::path> files{};  ///< absolute, sorted by path
  std::string problem{};                       ///< empty if there are files
  std::string warning{};                       ///< unusual place of the files; empty for others
};

/// Finds the files that documents name: absolute, or in the first folder that has them. A path that
/// leads out of all folders ranks after the others and gives a warning.
class AssetSearch {
 public:
  explicit AssetSearch(const std::vector<std::filesystem::path>& folders) {
    for (const std::filesystem::path& folder : folders) {
      const std::filesystem::path whole = normal(folder);
      if (std::ranges::find(folders_, whole) == folders_.end()) folders_.push_back(whole);
    }
  }

  /// Absolute, in search order.
  [[nodiscard]] const std::vector<std::filesystem::path>& folders() const noexcept { return folders_; }

  /// Finds the file of a name. A backslash separates as well.
  [[nodiscard]] AssetMatch find(std::string name) const {
    std::replace(name.begin(), name.end(), '\\', '/');
    const std::vector<std::filesystem::path> places = candidates(name);
    std::error_code ignored;
    for (const std::filesystem::path& place : places)
      if (is_regular_file(place, ignored)) return {.files = {place}, .warning = warning(name, place)};
    return {.problem = problem(name, places, "does not exist")};
  }

  /// Finds the files whose names match a regular expression as a whole: the last component of `pattern` (ECMAScript,
  /// without back-references). Searches all folders. Time is linear in the length of a name.
  [[nodiscard]] AssetMatch find_all(const std::string& pattern) const {
    const std::size_t slash = pattern.rfind('/');
    const std::string folder = slash == std::string::npos ? "." : pattern.substr(0, slash + 1),
                      name = pattern.substr(slash + 1);
    if (!is_simple(name))
      return {.problem = "is not a supported regular expression: expected at most " + std::to_string(max_pattern_size) +
                         " letters, no back-reference, and four counts in braces, none of them after a group"};
    AssetMatch match;
    const std::vector<std::filesystem::path> places = candidates(folder);
    try {
      const std::regex expression(name, syntax);
      for (const std::filesystem::path& place : places) {
        std::error_code error;
        std::size_t entries = 0;
        for (std::filesystem::directory_iterator entry(place, error), end; !error && entry != end;
             entry.increment(error)) {
          if (++entries > max_entries)
            return {.problem = "names a folder with more than " + std::to_string(max_entries) + " files"};
          std::error_code ignored;
          if (!std::regex_match(entry->path().filename().string(), expression) || !entry->is_regular_file(ignored))
            continue;
          match.files.push_back(normal(entry->path()));
          if (match.warning.empty()) match.warning = warning(pattern, match.files.back());
        }
      }
    } catch (const std::regex_error&) {
      return {.problem = "does not end with a regular expression"};
    }
    std::sort(match.files.begin(), match.files.end());
    match.files.erase(std::unique(match.files.begin(), match.files.end()), match.files.end());
    if (match.files.empty()) match.problem = problem(pattern, places, "matches no file");
    return match;
  }

 private:
  static constexpr std::size_t max_pattern_size = 200;
  static constexpr std::size_t max_entries = 1'000'000;
#ifdef __GLIBCXX__  // matches in linear time; backtracking takes a power of the name's length
  static constexpr auto syntax = std::regex_constants::ECMAScript | std::regex_constants::__polynomial;
#else
  static constexpr auto syntax = std::regex_constants::ECMAScript;
#endif

  [[nodiscard]] static std::filesystem::path normal(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::path whole = std::filesystem::absolute(path, error).lexically_normal();
    return whole.has_filename() ? whole : whole.parent_path();
  }

  /// True if the number of states of a pattern is bounded: counts in braces multiply them.
  [[nodiscard]] static bool is_simple(std::string_view pattern) {
    std::size_t counts = 0;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
      if (pattern[i] == '\\') {
        if (++i < pattern.size() && pattern[i] >= '1' && pattern[i] <= '9') return false;  // back-reference
      } else if (pattern[i] == '{') {
        ++counts;
        if (i > 0 && pattern[i - 1] == ')') return false;
      }
    }
    return pattern.size() <= max_pattern_size && counts <= 4;
  }

  /// Candidate paths of a name: those inside the folders, then those outside.
  [[nodiscard]] std::vector<std::filesystem::path> candidates(const std::string& name) const {
    const std::filesystem::path path(name);
    if (name.empty()) return {};
    if (path.is_absolute()) return {normal(path)};
    std::vector<std::filesystem::path> found, outside;
    for (const std::filesystem::path& folder : folders_) {
      std::filesystem::path place = normal(folder / path);
      (is_inside(place) ? found : outside).push_back(std::move(place));
    }
    found.insert(found.end(), outside.begin(), outside.end());
    return found;
  }

  [[nodiscard]] bool is_inside(const std::filesystem::path& place) const {
    return std::ranges::any_of(folders_, [&](const std::filesystem::path& folder) {
      return std::ranges::mismatch(folder, place).in1 == folder.end();
    });
  }

  /// Warning about a file outside the folders; empty for others.
  [[nodiscard]] std::string warning(const std::string& name, const std::filesystem::path& place) const {
    if (std::filesystem::path(name).is_absolute() || is_inside(place)) return "";
    return "is outside the assets folders: " + place.string();
  }

  [[nodiscard]] std::string problem(const std::string& name, const std::vector<std::filesystem::path>& places,
                                    const char* missing) const {
    if (name.empty()) return "is empty: expected a path";
    std::string all;
    for (const auto& place : places) all += (all.empty() ? "" : ", ") + place.string();
    return text::joined({missing, ": looked for ", all.empty() ? "no folder" : all});
  }

  std::vector<std::filesystem::path> folders_;
};

}  // namespace PULSECAST_NAMESPACE::helios

#endif
