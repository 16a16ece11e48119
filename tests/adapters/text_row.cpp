// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/adapters/text_row.hpp>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include "support/generators.hpp"

namespace pulsecast::adapters {
namespace {

TEST_CASE("numbers stand with one blank between them, and rows end and begin anew") {
  TextRow row;
  CHECK(row.add(1.5, 4).add(7).add(std::uint8_t{65}).end() == "1.5000 7 65\n");
  CHECK(row.add(-2.0, 1).add(std::numeric_limits<std::uint64_t>::max()).end() == "-2.0 18446744073709551615\n");
  CHECK(row.add(std::numeric_limits<std::int64_t>::min()).end() == "-9223372036854775808\n");
}

TEST_CASE("a zero has no sign, however it came about") {
  TextRow row;
  CHECK(row.add(-0.0, 4).add(-0.00004, 4).add(-0.00006, 4).add(-1e-300, 0).add(-10.0, 1).end() == "0.0000 0.0000 -0.0001 0 -10.0\n");
}

TEST_CASE("a number without a count of decimals is as short as it can be, and reads back the same") {
  TextRow row(';');
  CHECK(row.add(0.1).add(-0.0).add(1e300).add(7).add(2.5, 1).end() == "0.1;0;1e+300;7;2.5\n");
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const double value = random.log_uniform(1e-300, 1e300) * (random.coin() ? 1 : -1);
    CHECK(std::strtod(std::string(row.add(value).end()).c_str(), nullptr) == value);
  }
}

TEST_CASE("numbers are written as the C library does, and the largest finds room") {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const double value = random.log_uniform(1e-3, 1e300) * (random.coin() ? 1 : -1);
    std::array<char, 400> expected{};
    std::snprintf(expected.data(), expected.size(), "%.4f\n", value);
    TextRow row;
    CHECK(row.add(value, 4).end() == std::string(expected.data()));
  }
  TextRow row;
  CHECK(row.add(std::numeric_limits<double>::lowest(), 9).end().size() == 1 + 309 + 1 + 9 + 1);
}

}  // namespace
}  // namespace pulsecast::adapters
