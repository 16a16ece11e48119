// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/laz/median.hpp>

#include <cstdint>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laz_reader.hpp"

namespace pulsecast::io::detail {
namespace {

using support::Generator;
using support::LazMiddle;

TEST_CASE("three numbers outvote the two zeros that they leave") {
  LazMedian median;
  CHECK(median.value() == 0);
  for (const int middle : {0, 0, 7, 7}) {
    median.add(7);
    CHECK(median.value() == middle);
  }
}

TEST_CASE("it is the middle of five that are sorted anew each time") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const std::uint64_t range = random.whole(20) + 1;
    LazMedian median;
    LazMiddle other;
    for (int i = 0; i < 2'000; ++i) {
      const auto number = static_cast<std::int32_t>(random.whole(range)) - 3;
      median.add(number);
      other.add(number);
      REQUIRE(median.value() == other.value());
    }
  }
}

TEST_CASE("it stays where most numbers are, whatever comes in between") {
  LazMedian median;
  for (int i = 0; i < 100; ++i) {
    median.add(100);
    if (i % 5 == 4) median.add(i % 2 == 0 ? 1'000'000 : -1'000'000);
    if (i >= 10) CHECK(median.value() == 100);
  }
}

}  // namespace
}  // namespace pulsecast::io::detail
