// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/laz/integers.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laz_reader.hpp"

namespace pulsecast::io::detail {
namespace {

using support::Generator;
using support::LazDecoder;
using support::LazNumbers;

struct Item {
  std::int32_t expected, number;
  unsigned context;
  unsigned length = 0;  ///< as the encoder says it
};

std::string coded(std::vector<Item>& items, unsigned bits) {
  LazEncoder encoder;
  LazIntegers integers(bits, 4);
  for (Item& item : items) {
    integers.encode(encoder, item.expected, item.number, item.context);
    item.length = integers.last_length();
  }
  const std::vector<std::byte> bytes = std::move(encoder).finish();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// How many of them come back as others.
std::size_t wrong(std::vector<Item> items, unsigned bits) {
  LazDecoder decoder(coded(items, bits));
  LazNumbers numbers(bits);
  std::size_t count = 0;
  for (const Item& item : items) {
    const auto number = static_cast<std::uint64_t>(numbers.decode(decoder, item.expected, item.context));
    const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
    if ((number & mask) != (static_cast<std::uint64_t>(item.number) & mask) || numbers.length != item.length) ++count;
  }
  return count + (decoder.at_end() ? 0 : 1);
}

TEST_CASE("a correction of k bits is one of 2^k, of which none has fewer") {
  struct Length {
    std::int64_t correction;
    unsigned length;
  };
  for (const Length& of : {Length{0, 0},
                           {1, 0},
                           {-1, 1},
                           {2, 1},
                           {-2, 2},
                           {-3, 2},
                           {3, 2},
                           {4, 2},
                           {5, 3},
                           {-4, 3},
                           {256, 8},
                           {-255, 8},
                           {-256, 9},
                           {257, 9},
                           {2147483647, 31},
                           {-2147483647, 31},
                           {-2147483648, 32}}) {
    CAPTURE(of.correction);
    std::vector<Item> items{{0, static_cast<std::int32_t>(of.correction), 0}};
    static_cast<void>(coded(items, 32));
    CHECK(items[0].length == of.length);
  }
}

TEST_CASE("all corrections near 0 and near each power of two come back") {
  std::vector<Item> items;
  for (std::int32_t c = -600; c <= 600; ++c) items.push_back({0, c, 0});
  for (unsigned k = 9; k < 32; ++k)
    for (std::int32_t near = -2; near <= 2; ++near)
      for (const std::int64_t sign : {-1, 1}) items.push_back({0, static_cast<std::int32_t>(sign * (std::int64_t{1} << k) + near), 1});
  CHECK(wrong(items, 32) == 0);
}

TEST_CASE("numbers of 16 and 32 bits come back from whatever was expected, in all contexts") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    for (const unsigned bits : {16U, 32U}) {
      const std::uint64_t range = std::uint64_t{1} << bits;
      const double spread = random.log_uniform(1, static_cast<double>(range));
      std::vector<Item> items(3'000);
      for (Item& item : items) {
        const std::uint64_t expected = random.whole(range);
        const std::uint64_t number = expected + random.whole(static_cast<std::uint64_t>(spread) + 1);
        item.context = static_cast<unsigned>(random.whole(4));
        item.expected = static_cast<std::int32_t>(expected & (range - 1));
        item.number = static_cast<std::int32_t>(number & (range - 1));
        if (bits == 16 && random.coin()) {
          item.expected = static_cast<std::int16_t>(item.expected);
          item.number = static_cast<std::int16_t>(item.number);
        }
      }
      CHECK(wrong(items, bits) == 0);
    }
  }
}

TEST_CASE("what is as expected costs next to nothing") {
  std::vector<Item> items(100'000, Item{5, 5, 0});
  CHECK(coded(items, 32).size() < 100);
}

}  // namespace
}  // namespace pulsecast::io::detail
