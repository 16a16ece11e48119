// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/search.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

#include <doctest/doctest.h>

using pulsecast::detail::first_not;

TEST_CASE("a search finds what std::lower_bound and std::upper_bound find") {
  for (std::size_t count = 0; count < 40; ++count) {
    std::vector<int> table(count);
    for (std::size_t i = 0; i < count; ++i) table[i] = static_cast<int>(i / 3 * 2);  // each number three times
    for (int wanted = -1; wanted < 30; ++wanted) {
      CAPTURE(count);
      CAPTURE(wanted);
      const auto lower = std::lower_bound(table.begin(), table.end(), wanted), upper = std::upper_bound(table.begin(), table.end(), wanted);
      CHECK(first_not(count, [&](std::size_t i) { return table[i] < wanted; }) == static_cast<std::size_t>(lower - table.begin()));
      CHECK(first_not(count, [&](std::size_t i) { return table[i] <= wanted; }) == static_cast<std::size_t>(upper - table.begin()));
    }
  }
}
