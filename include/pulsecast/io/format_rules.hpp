// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_FORMAT_RULES_HPP
#define PULSECAST_IO_FORMAT_RULES_HPP

#include <pulsecast/io/input_file.hpp>

namespace PULSECAST_NAMESPACE::io {

/// What a reader does with an item of a file.
enum class FormatUse : std::uint8_t {
  read,     ///< applied
  noted,    ///< without effect, with a warning
  refused,  ///< the file is refused
};

/// Tag, key, band, element, attribute or extension that changes geometry, radiometry, place or time. The rules of a
/// format are one table, which its reader asks and `docs/formats.md` prints.
struct FormatRule {
  std::string_view name;     ///< as the format names it; with `*` at its end, all that begin so; or several: `a, b*`
  FormatUse use;             ///< what the reader does with it
  std::string_view meaning;  ///< what it becomes; for `noted`, what is so without it; for `refused`, the way out
};

namespace detail {

/// Takes the first of several names, up to a comma and a blank.
[[nodiscard]] constexpr std::string_view take_name(std::string_view& names) noexcept {
  const std::string_view first = names.substr(0, names.find(", "));
  names.remove_prefix(std::min(names.size(), first.size() + 2));
  return first;
}

/// Kind of a comment in a mesh or cloud: `unit`, as of SketchUp (`File units = inches`) and Maya (`uses centimeters as
/// units`), `offset`, as of CloudCompare (`Global shift: -500000 0 0`), or empty.
[[nodiscard]] inline std::string_view kind_of_comment(std::string_view comment) {
  const std::string words = text::lower(comment);
  const auto has = [&](auto... parts) { return ((words.find(parts) != words.npos) || ...); };
  if (has("unit") && has("inch", "feet", "foot", "yard", "centi", "milli", "kilo", " cm", " mm", " km", " ft"))
    return "unit";
  for (const std::string_view part : {"offset", "shift"})
    if (words.find_first_of("123456789", words.find(part)) != words.npos) return "offset";
  return "";
}

}  // namespace detail

/// First rule for an item, or null.
[[nodiscard]] constexpr const FormatRule* rule_of(std::span<const FormatRule> rules, std::string_view name) noexcept {
  for (const FormatRule& rule : rules) {
    if (name == rule.name) return &rule;
    for (std::string_view names = rule.name; !names.empty();)
      if (const std::string_view one = detail::take_name(names);
          one.ends_with('*') ? name.starts_with(one.substr(0, one.size() - 1)) : name == one)
        return &rule;
  }
  return nullptr;
}

/// Keeps to the rule for an item of a file: "PATH: has the KIND 'NAME': MEANING" as a warning or a `FileError`. True if
/// it is to be read. @throws FileError for an item that is refused, or that no rule names
inline bool keep_rule(std::span<const FormatRule> rules, const std::filesystem::path& path, std::string_view kind,
                      std::string_view name, std::vector<std::string>& warnings) {
  const FormatRule* const rule = rule_of(rules, name);
  if (!rule)
    detail::fail(path, "has the ", kind, ' ', text::quoted(name), ", which is unknown: expected a file without it");
  if (rule->use == FormatUse::refused)
    detail::fail(path, "has the ", kind, ' ', text::quoted(name), ": expected ", rule->meaning);
  if (rule->use == FormatUse::noted)
    warnings.push_back(
        detail::warning(path.string(), 0, "has the ", kind, ' ', text::quoted(name), ": ", rule->meaning));
  return rule->use == FormatUse::read;
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
