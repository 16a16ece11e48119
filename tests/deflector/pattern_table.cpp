// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/deflector/pattern_table.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <pulsecast/base/units.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

static_assert(Optic<PatternTable>);

namespace {
PatternTable some_table(std::uint64_t seed, std::size_t n, double rate) {
  support::Generator any(seed);
  PatternTable table{.entry_rate = rate};
  for (std::size_t k = 0; k < n; ++k)
    table.entries.push_back({.azimuth = any.uniform(-pi, pi), .elevation = any.uniform(-1.5, 1.5)});
  return table;
}
}  // namespace

TEST_CASE("a pattern table goes through its entries, one a pulse, and begins again") {
  const PatternTable table = some_table(1, 37, 240e3);
  for (const PulseIndex start : {PulseIndex{0}, PulseIndex{1000000000000}})
    for (PulseIndex i = start; i < start + 100; ++i) {
      CAPTURE(i);
      const Tick t = Tick::of(i, 240e3);
      REQUIRE(table.entry(t) == i % 37);
      const auto& [azimuth, elevation] = table.entries[i % 37];
      const double level = std::cos(elevation);
      const Vec3 expected{level * std::sin(azimuth), level * std::cos(azimuth), std::sin(elevation)};
      CHECK(length(table.at(t).direction(axis::forward) - expected) < 1e-15);
    }
}

TEST_CASE("a pattern table keeps the laws of a motion") {
  const auto ticks = support::some_ticks(5);
  CHECK(support::motion_laws(some_table(2, 100, 1234.5), ticks) == "");
}

TEST_CASE("a pattern table refuses entries that cannot be, and none at all") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(PatternTable{}.validate(), SettingError);
  CHECK_NOTHROW(PatternTable{.entries = {{}}}.validate());
  CHECK_THROWS_AS((PatternTable{.entries = {{}, {.azimuth = nan}}}.validate()), SettingError);
  for (const double bad : {-1.6, 1.6, nan})
    CHECK_THROWS_AS((PatternTable{.entries = {{}, {.elevation = bad}}}.validate()), SettingError);
  for (const double bad : {0.0, -1.0, nan})
    CHECK_THROWS_AS((PatternTable{.entries = {{}}, .entry_rate = bad}.validate()), SettingError);
}
