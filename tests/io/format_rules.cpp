// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/format_rules.hpp>

#include <array>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/format_cases.hpp"

namespace pulsecast::io {
namespace {

using test::broken_rules;
using test::check_rules;
using test::FormatCase;

constexpr std::array<FormatRule, 4> rules{{{"SCALE", FormatUse::read, "scale of heights"},
                                           {"KHR_known", FormatUse::read, "light"},
                                           {"KHR_*", FormatUse::noted, "drawn without it"},
                                           {"DEPTH", FormatUse::refused, "heights, as gdal_calc makes them"}}};

std::vector<std::string> kept(std::string_view name) {
  std::vector<std::string> warnings;
  keep_rule(rules, "a.tif", "tag", name, warnings);
  return warnings;
}

TEST_CASE("the first rule that fits an item holds, for all items of a beginning, too") {
  CHECK(rule_of(rules, "SCALE") == &rules[0]);
  CHECK(rule_of(rules, "KHR_known") == &rules[1]);
  CHECK(rule_of(rules, "KHR_other") == &rules[2]);
  CHECK(rule_of(rules, "KHR_") == &rules[2]);
  CHECK(rule_of(rules, "SCALES") == nullptr);
}

TEST_CASE("a rule may have several names, each for itself or for all that begin so") {
  constexpr std::array<FormatRule, 2> several{{{"a b, c*", FormatUse::read, ""}, {"c, d", FormatUse::read, ""}}};
  for (const char* name : {"a b", "c", "cx", "a b, c*"}) CHECK(rule_of(several, name) == &several[0]);
  CHECK(rule_of(several, "d") == &several[1]);
  for (const char* name : {"a", "b", "", "dx"}) CHECK(rule_of(several, name) == nullptr);
}

TEST_CASE("an item is read, noted or refused by its rule, and refused without one") {
  CHECK(kept("SCALE").empty());
  CHECK(kept("KHR_x") == std::vector<std::string>{"a.tif: has the tag 'KHR_x': drawn without it"});
  CHECK_THROWS_WITH_AS(kept("DEPTH"), "a.tif: has the tag 'DEPTH': expected heights, as gdal_calc makes them",
                       FileError);
  CHECK_THROWS_WITH_AS(kept("OTHER"), "a.tif: has the tag 'OTHER', which is unknown: expected a file without it",
                       FileError);
}

TEST_CASE("a row without a file, a file without a row and another use are found") {
  const std::vector<FormatCase> right{{"SCALE", [] { return kept("SCALE"); }},
                                      {"KHR_known", [] { return kept("KHR_known"); }},
                                      {"KHR_*", [] { return kept("KHR_x"); }},
                                      {"DEPTH", [] { return kept("DEPTH"); }}};
  check_rules(rules, right);
  CHECK(broken_rules(rules, std::span(right).first(3)).size() == 1);
  CHECK(broken_rules(std::span(rules).first(3), right).size() == 1);
  std::vector<FormatCase> wrong = right;
  for (std::size_t k = 0; k < wrong.size(); ++k) wrong[k].warnings_of = right[(k + 2) % 4].warnings_of;
  CHECK(broken_rules(rules, wrong).size() == 3);  // what is read may have other warnings
}

}  // namespace
}  // namespace pulsecast::io
