// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/copc/octree.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/detail/copc/subtree.hpp>

#include "support/generators.hpp"

namespace pulsecast::io::detail {
namespace {

using support::Generator;

TEST_CASE("a Morton number has the bits of x, y and z in turns, and gives them back") {
  CHECK(copc_morton({1, 0, 0}) == 1);
  CHECK(copc_morton({0, 1, 0}) == 2);
  CHECK(copc_morton({0, 0, 1}) == 4);
  CHECK(copc_morton({0b11, 0b10, 0b01}) == 0b011'101);
  CHECK(copc_morton({0x1FFFFF, 0x1FFFFF, 0x1FFFFF}) == (std::uint64_t{1} << 63) - 1);
  Generator random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto any = [&] { return static_cast<std::int64_t>(random.whole(std::uint64_t{1} << 21)); };
    const CopcPlace place{any(), any(), any()};
    CHECK(copc_place_of(copc_morton(place)) == place);
  }
}

TEST_CASE("the distance from a cell's centre is the same for points on either side of it") {
  CHECK(copc_off_centre({0, 0, 0}, 0) == 0);
  CHECK(copc_off_centre({7, 8, 7}, 4) == 3);  // half a step along each axis
  CHECK(copc_off_centre({16, 8, 7}, 4) == 15 * 15 + 2);
  CHECK(copc_off_centre({-1, -8, -9}, 4) == 15 * 15 + 2);
}

/// Path from the root down, as text that compares as nodes do.
std::string path_of(const CopcKey& key) {
  std::string path;
  for (CopcKey k = key; k.level > 0; k = k.parent())
    path += static_cast<char>('0' + (k.x & 1) + 2 * (k.y & 1) + 4 * (k.z & 1));
  std::reverse(path.begin(), path.end());
  return path;
}

TEST_CASE("nodes come in order of the paths down to them, parents first") {
  Generator random(2);
  std::vector<CopcKey> keys;
  for (int i = 0; i < 300; ++i) {
    CopcKey key;
    for (std::uint64_t depth = random.whole(i < 200 ? 4 : 26); depth > 0; --depth)
      key = key.child(static_cast<unsigned>(random.whole(8)));
    keys.push_back(key);
  }
  for (const CopcKey& a : keys)
    for (const CopcKey& b : keys) CHECK(copc_before(a, b) == (path_of(a) < path_of(b)));
}

TEST_CASE("of each cell the point nearest to the centre is picked, the first of several") {
  struct Point {
    std::uint64_t cell, off;
  };
  const std::vector<std::vector<Point>> children{{{1, 5}, {1, 4}, {1, 4}, {2, 0}}, {}, {{9, 1}, {9, 2}}};
  const std::vector<std::size_t> counts{4, 0, 2};
  const auto picked = copc_sample(
      counts, [&](std::size_t child, std::uint32_t i) { return children[child][i].cell; },
      [&](std::size_t child, std::uint32_t i) { return children[child][i].off; });
  CHECK(picked == std::vector<std::vector<std::uint32_t>>{{1, 3}, {}, {0}});
  std::string taken, left;
  copc_part(
      4, picked[0], [&](std::uint32_t i) { taken += std::to_string(i); },
      [&](std::uint32_t i) { left += std::to_string(i); });
  CHECK(taken == "13");
  CHECK(left == "02");
}

}  // namespace
}  // namespace pulsecast::io::detail
