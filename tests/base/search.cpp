// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/base/search.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

using pulsecast::detail::first_not;
using pulsecast::detail::interpolated;
using pulsecast::detail::neighbours;

TEST_CASE("a search finds what std::lower_bound and std::upper_bound find") {
  for (std::size_t count = 0; count < 40; ++count) {
    std::vector<int> table(count);
    for (std::size_t i = 0; i < count; ++i) table[i] = static_cast<int>(i / 3 * 2);  // each number three times
    for (int wanted = -1; wanted < 30; ++wanted) {
      CAPTURE(count);
      CAPTURE(wanted);
      const auto lower = std::lower_bound(table.begin(), table.end(), wanted),
                 upper = std::upper_bound(table.begin(), table.end(), wanted);
      CHECK(first_not(count, [&](std::size_t i) { return table[i] < wanted; }) ==
            static_cast<std::size_t>(lower - table.begin()));
      CHECK(first_not(count, [&](std::size_t i) { return table[i] <= wanted; }) ==
            static_cast<std::size_t>(upper - table.begin()));
    }
  }
}

TEST_CASE("a place has a neighbour on both sides, and beyond the table the outermost element twice") {
  const std::vector<double> table{1, 2, 4};
  const auto around = [&](double x) {
    const auto [before, behind] = neighbours(table.size(), [&](std::size_t i) { return !(x < table[i]); });
    return std::pair(before, behind);
  };
  CHECK(around(0.5) == std::pair<std::size_t, std::size_t>(0, 0));
  CHECK(around(1) == std::pair<std::size_t, std::size_t>(0, 1));
  CHECK(around(3) == std::pair<std::size_t, std::size_t>(1, 2));
  CHECK(around(4) == std::pair<std::size_t, std::size_t>(2, 2));
  CHECK(neighbours(1, [](std::size_t) { return true; }).behind == 0);
}

TEST_CASE("a table is interpolated between its entries and constant beyond them") {
  struct Entry {
    double x, y;
  };
  const std::vector<Entry> table{{1, 10}, {2, 20}, {4, -20}};
  const auto at = [&](double x) { return interpolated(table, x, &Entry::x, &Entry::y); };
  CHECK(at(-5) == 10);
  CHECK(at(1) == 10);
  CHECK(at(1.5) == 15);
  CHECK(at(2) == 20);
  CHECK(at(3) == 0);
  CHECK(at(4) == -20);
  CHECK(at(9) == -20);
  CHECK(interpolated(std::vector<Entry>{{1, 10}}, 1, &Entry::x, &Entry::y) == 10);
}
