// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/text/output.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::TemporaryFolder;

/// What a row of one time reads.
std::string nanoseconds(const Tick& time) {
  const TemporaryFolder folder;
  TextOutput text{OutputFile(folder / "a.txt")};
  text.nanoseconds(time).end_row();
  text.close();
  return content(folder / "a.txt");
}

TEST_CASE("numbers stand with one blank between them, and rows end and begin anew") {
  TextRow row;
  CHECK(row.add(1.5, 4).add(7).add(std::uint8_t{65}).end() == "1.5000 7 65\n");
  CHECK(row.add(-2.0, 1).add(std::numeric_limits<std::uint64_t>::max()).end() == "-2.0 18446744073709551615\n");
  CHECK(row.add(std::numeric_limits<std::int64_t>::min()).end() == "-9223372036854775808\n");
}

TEST_CASE("a zero has no sign, however it came about") {
  TextRow row;
  CHECK(row.add(-0.0, 4).add(-0.00004, 4).add(-0.00006, 4).add(-1e-300, 0).add(-10.0, 1).end() ==
        "0.0000 0.0000 -0.0001 0 -10.0\n");
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

TEST_CASE("a word stands as it is, and what is not a number has no sign") {
  TextRow row;
  CHECK(row.add(1).add(std::string_view("word")).add(-std::numeric_limits<double>::quiet_NaN(), 4).end() ==
        "1 word nan\n");
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
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {  // among them those half-way between two, or next to it
    CAPTURE(seed);
    support::Generator random(seed);
    const int decimals = static_cast<int>(random.whole(12));
    double value = static_cast<double>(random.whole(std::uint64_t{1} << random.whole(50)) * 2 + 1) / 2 /
                   std::pow(10, random.whole(12));
    if (random.coin()) value = std::nextafter(value, random.coin() ? 0 : 1e300);
    if (random.coin()) value = -value;
    std::array<char, 400> expected{};
    std::snprintf(expected.data(), expected.size(), "%.*f\n", decimals, value);
    std::string text(expected.data());
    if (text.find_first_of("123456789") == text.npos && text[0] == '-') text.erase(0, 1);
    TextRow row;
    CHECK(row.add(value, decimals).end() == text);
  }
  TextRow row;
  CHECK(row.add(0.5, 0).add(1.5, 0).add(0.125, 2).add(0.375, 2).add(1e-9, 9).add(-0.999, 2).end() ==
        "0 2 0.12 0.38 0.000000001 -1.00\n");
  CHECK(row.add(std::numeric_limits<double>::lowest(), 9).end().size() == 1 + 309 + 1 + 9 + 1);
}

TEST_CASE("rows are made of vectors, reals and whole numbers, each with its decimals") {
  const TemporaryFolder folder;
  TextOutput text{OutputFile(folder / "a.txt")};
  text.vector("a place", Vec3{1, -2.00004, 0.5}, 4).reals(1, 2.25, 3.0F, 4).wholes(7, std::uint8_t{65}).end_row();
  text.wholes(-1).end_row();
  text.close();
  CHECK(content(folder / "a.txt") == "1.0000 -2.0000 0.5000 2.2 3.0 4.0 7 65\n-1\n");
}

TEST_CASE("times in nanoseconds keep all four decimals, after years and before the start") {
  CHECK(nanoseconds({0, 0}) == "0.0000\n");
  CHECK(nanoseconds({0, 1.5e-9}) == "1.5000\n");
  CHECK(nanoseconds({12, 0.25}) == "12250000000.0000\n");
  CHECK(nanoseconds({400'000'000, 123'456'789.1234e-9}) == "400000000123456789.1234\n");
  CHECK(nanoseconds({7, 1 - 1e-16}) == "8000000000.0000\n");
  CHECK(nanoseconds({-1, 0.75}) == "-250000000.0000\n");
  CHECK(nanoseconds({-1, 0}) == "-1000000000.0000\n");
  CHECK(nanoseconds({-3, 0.5}) == "-2500000000.0000\n");
  support::Generator random(1);
  for (int i = 0; i < 200; ++i) {  // small ones, against what the row itself writes
    const double seconds = random.log_uniform(1e-12, 1e-3);
    TextRow row;
    CHECK(nanoseconds(Tick::of_seconds(seconds)).size() == row.add(seconds * 1e9, 4).end().size());
    CHECK(std::fabs(std::stod(nanoseconds(Tick::of_seconds(seconds))) - seconds * 1e9) <= 0.5001e-4);
  }
}

TEST_CASE("a vector that is not finite is an error that says whose it is, and leaves no file") {
  const TemporaryFolder folder;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    TextOutput text{OutputFile(folder / "a.txt")};
    text.wholes(1).end_row();
    CHECK_THROWS_WITH_AS(
        text.vector("a place", Vec3{0, bad, 0}, 4),
        doctest::Contains("line 2: cannot be written: a place is not finite; expected finite coordinates"), FileError);
    CHECK_THROWS_AS(text.close(), FileError);
  }
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::io
