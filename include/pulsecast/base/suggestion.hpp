// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_SUGGESTION_HPP
#define PULSECAST_BASE_SUGGESTION_HPP

#include <numeric>
#include <span>
#include <vector>

#include <pulsecast/base/text.hpp>

/// Known names in place of a misspelt one, for messages.
namespace PULSECAST_NAMESPACE::text {

namespace detail {

/// Number of insertions, deletions, changes and swaps of neighbours that turn one word into the
/// other; case is ignored. Source: optimal string alignment distance, Damerau 1964.
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto is_same = [](char x, char y) { return lower(x) == lower(y); };
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = is_same(a[i - 1], b[j - 1]) ? 0 : 1;
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + changed});
      if (i > 1 && j > 1 && is_same(a[i - 1], b[j - 2]) && is_same(a[i - 2], b[j - 1]))
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    std::swap(before_last, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace detail

/// Known name, and its edit distance from a word.
struct NearestName {
  std::string_view name;     ///< the known name
  std::size_t distance = 0;  ///< of the first 100 bytes
};

/// Known name of minimum edit distance from a word, the first of equals. Requires a known name.
[[nodiscard]] inline NearestName nearest_name(std::string_view word, std::span<const std::string> known) {
  constexpr std::size_t longest = 100;  // bytes that count, as the time grows with their product
  NearestName nearest;
  for (const std::string_view name : known) {
    const std::size_t distance = detail::edit_distance(word.substr(0, longest), name.substr(0, longest));
    if (nearest.name.data() == nullptr || distance < nearest.distance) nearest = {name, distance};
  }
  return nearest;
}

/// "; did you mean 'pulseFreq_hz'?", with the nearest known name; all of them if none is near.
[[nodiscard]] inline std::string suggestion(std::string_view unknown, std::span<const std::string> known) {
  constexpr std::size_t max_listed = 40, longest = 100;
  if (known.empty()) return "";
  const NearestName nearest = nearest_name(unknown, known);
  if (nearest.distance <= std::max<std::size_t>(std::min(unknown.size(), longest) / 2, 2))
    return "; did you mean '" + std::string(nearest.name) + "'?";
  std::string list;
  for (const std::string& name : known.first(std::min(known.size(), max_listed)))
    list += (list.empty() ? "" : ", ") + name;
  return "; known names: " + list + (known.size() > max_listed ? ", ..." : "");
}

}  // namespace PULSECAST_NAMESPACE::text

#endif
