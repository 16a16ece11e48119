// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/cell_numbers.hpp>

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"

namespace pulsecast::io {
namespace {

using Cell = CellNumbers::Cell;

TEST_CASE("cells are numbered in the order in which they are met") {
  CellNumbers cells;
  CHECK(cells.number({5, 0, 0}) == 0);
  CHECK(cells.number({0, 5, 0}) == 1);
  CHECK(cells.number({5, 0, 0}) == 0);
  CHECK(cells.number({0, 0, 5}) == 2);
  CHECK(cells.size() == 3);
  CHECK(std::move(cells).release() == std::vector<Cell>{{5, 0, 0}, {0, 5, 0}, {0, 0, 5}});
}

TEST_CASE("cells are told apart as an ordered map tells them apart") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const auto reach = static_cast<std::uint64_t>(random.log_uniform(2, 0x1p32));
    CellNumbers cells;
    std::map<Cell, std::uint32_t> expected;
    std::uint64_t wrong = 0;
    for (int i = 0; i < 5000; ++i) {
      const auto x = static_cast<std::uint32_t>(random.whole(reach)), y = static_cast<std::uint32_t>(random.whole(reach));
      const Cell cell{x, y, random.coin() ? 0 : ~0U};
      const std::uint32_t number = expected.try_emplace(cell, static_cast<std::uint32_t>(expected.size())).first->second;
      wrong += cells.number(cell) != number;
    }
    CHECK(wrong == 0);
    CHECK(cells.size() == expected.size());
  }
}

}  // namespace
}  // namespace pulsecast::io
