// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/suggestion.hpp>

#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast::text;

TEST_CASE("letters put in, left out, changed and swapped are counted") {
  CHECK(detail::edit_distance("", "") == 0);
  CHECK(detail::edit_distance("", "abc") == 3);
  CHECK(detail::edit_distance("pulseFreq_Hz", "pulseFreq_hz") == 0);
  CHECK(detail::edit_distance("kitten", "sitting") == 3);  // Levenshtein's textbook pair
  CHECK(detail::edit_distance("abcd", "acbd") == 1);
  CHECK(detail::edit_distance("ca", "abc") == 3);  // of the restricted distance: no part is edited twice
  for (const auto& [a, b] : {std::pair("trajectory_seperator", "trajectory_separator"), std::pair("axis", "aixs")}) {
    CHECK(detail::edit_distance(a, b) == 1);
    CHECK(detail::edit_distance(b, a) == 1);
  }
}

TEST_CASE("the nearest name is suggested, or all if none is near") {
  const std::vector<std::string> known{"scanFreq_hz", "pulseFreq_hz", "scanAngle_deg"};
  CHECK(suggestion("scanFreqHz", known) == "; did you mean 'scanFreq_hz'?");
  CHECK(suggestion("scanAngle", known) == "; did you mean 'scanAngle_deg'?");
  CHECK(suggestion("q", known) == "; known names: scanFreq_hz, pulseFreq_hz, scanAngle_deg");
  CHECK(suggestion("q", {}).empty());
  CHECK(suggestion("abcd", std::vector<std::string>{"abxy"}) == "; did you mean 'abxy'?");     // half of its letters
  CHECK(suggestion("abcdef", std::vector<std::string>{"abuvwx"}) == "; known names: abuvwx");  // more than half
}

TEST_CASE("of names that are equally near, the first is taken; only the beginning of long ones counts") {
  const std::vector<std::string> known{"heading", "pitch", "bitch"};
  CHECK(nearest_name("itch", known).name == "pitch");
  CHECK(nearest_name("itch", known).distance == 1);
  const std::string longest(100, 'a');
  CHECK(nearest_name(longest + "b", std::vector<std::string>{longest + "cdef"}).distance == 0);
  const std::vector<std::string> many(50, "xyz");
  CHECK(suggestion("q", many).ends_with("xyz, ..."));
}
