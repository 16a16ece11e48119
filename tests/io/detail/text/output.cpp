// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/text/output.hpp>

#include <cstdint>
#include <limits>
#include <string>

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
    CHECK_THROWS_WITH_AS(text.vector("a place", Vec3{0, bad, 0}, 4),
                         doctest::Contains("line 2: cannot be written: a place is not finite; expected finite coordinates"), FileError);
    CHECK_THROWS_AS(text.close(), FileError);
  }
  CHECK(folder.empty());
}

TEST_CASE("reals need not be finite: a width that was not found is written as such") {
  const TemporaryFolder folder;
  TextOutput text{OutputFile(folder / "a.txt")};
  text.reals(4, std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::quiet_NaN()).end_row();
  text.close();
  CHECK(content(folder / "a.txt") == "nan nan\n");
}

}  // namespace
}  // namespace pulsecast::io
