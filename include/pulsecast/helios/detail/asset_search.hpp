// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_ASSET_SEARCH_HPP
#define PULSECAST_HELIOS_DETAIL_ASSET_SEARCH_HPP

#include <regex.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
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
  /// without back-references and lookahead). Searches all folders. Time is linear in the length of a name.
  [[nodiscard]] AssetMatch find_all(const std::string& pattern) const {
    const std::size_t slash = pattern.rfind('/');
    const std::string folder = slash == std::string::npos ? "." : pattern.substr(0, slash + 1),
                      name = pattern.substr(slash + 1), extended = posix_extended(name);
    if (extended.empty() && !name.empty())
      return {.problem =
                  "is not a supported regular expression: expected at most " + std::to_string(max_pattern_size) +
                  " letters, no back-reference, no lookahead, and four counts in braces below 1000, none after a "
                  "group or a count"};
    regex_t expression;
    if (regcomp(&expression, extended.c_str(), REG_EXTENDED) != 0)
      return {.problem = "does not end with a regular expression"};
    const std::unique_ptr<regex_t, decltype(&regfree)> owner(&expression, &regfree);
    AssetMatch match;
    const std::vector<std::filesystem::path> places = candidates(folder);
    for (const std::filesystem::path& place : places) {
      std::error_code error;
      std::size_t entries = 0;
      for (std::filesystem::directory_iterator entry(place, error), end; !error && entry != end;
           entry.increment(error)) {
        if (++entries > max_entries)
          return {.problem = "names a folder with more than " + std::to_string(max_entries) + " files"};
        std::error_code ignored;
        const std::string file = entry->path().filename().string();
        regmatch_t longest{};
        if (regexec(&expression, file.c_str(), 1, &longest, 0) != 0 || longest.rm_so != 0 ||
            static_cast<std::size_t>(longest.rm_eo) != file.size() || !entry->is_regular_file(ignored))
          continue;
        match.files.push_back(normal(entry->path()));
        if (match.warning.empty()) match.warning = warning(pattern, match.files.back());
      }
    }
    std::sort(match.files.begin(), match.files.end());
    match.files.erase(std::unique(match.files.begin(), match.files.end()), match.files.end());
    if (match.files.empty()) match.problem = problem(pattern, places, "matches no file");
    return match;
  }

 private:
  static constexpr std::size_t max_pattern_size = 200;
  static constexpr std::size_t max_entries = 1'000'000;

  [[nodiscard]] static std::filesystem::path normal(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::path whole = std::filesystem::absolute(path, error).lexically_normal();
    return whole.has_filename() ? whole : whole.parent_path();
  }

  /// An ECMAScript pattern as an extended one of POSIX, which the C library matches in linear time. Empty if it is not
  /// supported, such as counts in braces that multiply each other.
  [[nodiscard]] static std::string posix_extended(std::string_view pattern) {
    if (pattern.size() > max_pattern_size) return {};
    std::string out;
    std::size_t counts = 0;
    bool in_set = false, repeats = false;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
      const char c = pattern[i];
      const std::string_view rest = pattern.substr(i + 1);
      const bool repeated = std::exchange(repeats, !in_set && (c == '*' || c == '+' || c == '?' || c == '}'));
      std::size_t copied = 1;
      if (c == '\\' && !rest.empty()) {
        const char escaped = rest.front(), lower = static_cast<char>(escaped | 0x20);
        const char* const set = lower == 'd' ? "0-9" : lower == 'w' ? "_[:alnum:]" : lower == 's' ? "[:space:]" : "";
        const bool literal = !((lower >= 'a' && lower <= 'z') || (escaped >= '0' && escaped <= '9'));
        if (!literal && (*set == '\0' || (in_set && escaped != lower))) return {};
        if (literal)
          out += in_set ? std::string("[.") + escaped + ".]" : std::string("\\") + escaped;
        else
          out += in_set ? set : (escaped == lower ? "[" : "[^") + std::string(set) + "]";
        ++i;
        continue;
      }
      if (in_set && c == '[' && rest.starts_with(':')) {
        copied = std::min(rest.find(":]"), rest.size()) + 3;
      } else if (in_set) {
        in_set = c != ']';
      } else if (c == '[') {
        in_set = true;
        if (rest.starts_with(']') || rest.starts_with("^]")) return {};
      } else if (c == '(' && rest.starts_with('?')) {
        if (!rest.starts_with("?:")) return {};  // lookahead
        i += 2;
      } else if (c == '{') {
        const std::size_t end = rest.find('}'), comma = std::min(rest.find(','), end);
        if (++counts > 4 || repeated || (i > 0 && pattern[i - 1] == ')') || comma > 3 || end - comma > 4) return {};
      } else if (c == '?' && repeated) {
        continue;  // the shortest match: of a whole name, all are alike
      }
      out.append(copied == 1 ? std::string_view(&c, 1) : pattern.substr(i, copied));
      i += copied - 1;
    }
    return out;
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
