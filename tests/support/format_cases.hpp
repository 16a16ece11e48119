// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/format_rules.hpp>

namespace pulsecast::test {

/// File for a row of a table of rules.
struct FormatCase {
  std::string_view row;  ///< name of the rule
  std::function<std::vector<std::string>()>
      warnings_of;  ///< writes and reads the file; checks what a rule that is `read` changes
};

/// What is wrong with a table and its files, one sentence each: a row without a file, a file without a row, and a file
/// that is not read, noted or refused as its row says, in the words of its meaning.
inline std::vector<std::string> broken_rules(std::span<const io::FormatRule> rules, std::span<const FormatCase> cases) {
  std::vector<std::string> broken;
  const auto has_case = [&](std::string_view name) {
    return std::ranges::find(cases, name, &FormatCase::row) != cases.end();
  };
  for (const io::FormatRule& rule : rules)
    for (std::string_view names = has_case(rule.name) ? "" : rule.name; !names.empty();)
      if (const std::string_view name = io::detail::take_name(names); !has_case(name))
        broken.push_back("no file for " + std::string(name));
  for (const FormatCase& one : cases) {
    const io::FormatRule* const rule = io::rule_of(rules, one.row);
    if (!rule || (rule->name == "*" && one.row != "*")) {
      broken.push_back("no row for " + std::string(one.row));
      continue;
    }
    const auto tells = [&](std::string_view text) { return text.find(rule->meaning) != text.npos; };
    std::string result = "read";
    try {
      const std::vector<std::string> warnings = one.warnings_of();
      if (std::ranges::any_of(warnings, tells)) result = "noted";
    } catch (const FileError& error) {
      result = tells(error.what()) ? "refused" : std::string("refused for another reason: ") + error.what();
    }
    constexpr std::array<std::string_view, 3> expected{"read", "noted", "refused"};
    if (result != expected[static_cast<std::size_t>(rule->use)])
      broken.push_back(std::string(one.row) + " is " + result + ", but should be " +
                       std::string(expected[static_cast<std::size_t>(rule->use)]));
  }
  return broken;
}

/// Checks that each row of a table has a file that is read, noted or refused as the row says, and each file a row.
inline void check_rules(std::span<const io::FormatRule> rules, std::span<const FormatCase> cases) {
  for (const std::string& problem : broken_rules(rules, cases)) FAIL_CHECK(problem);
}

}  // namespace pulsecast::test
