// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/pulse_text.hpp>

#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::TemporaryFolder;

std::string written(const std::vector<Shot>& shots, PulseTextSettings settings = {}) {
  const TemporaryFolder folder;
  PulseTextWriter writer(folder / "pulses.txt", settings);
  writer(EchoBatch{shots, {}, {}, 0});
  writer.close();
  return content(folder / "pulses.txt");
}

TEST_CASE("a pulse is a line of ten columns, nine of which are HELIOS++'s") {
  Shot shot;
  shot.index = 41;
  shot.tick = {7, 0.25};
  shot.origin = {100, 200.00004, -50};
  shot.direction = {0.6, 0, -0.8};
  shot.channel = 3;
  shot.fate = Fate::returned;
  CHECK(written({shot}) == "100.0000 200.0000 -50.0000 0.600000000 0.000000000 -0.800000000 7250000000.0000 41 3 0\n");
  CHECK(written({shot}, {.start_time = 4e8}) ==
        "100.0000 200.0000 -50.0000 0.600000000 0.000000000 -0.800000000 400000007250000000.0000 41 3 0\n");
}

TEST_CASE("pulses are written whatever became of them, and their fates have the numbers that are documented") {
  const std::vector<Fate> fates{Fate::returned, Fate::missed, Fate::out_of_range, Fate::below_threshold, Fate::absorbed};
  std::vector<Shot> shots(fates.size());
  for (std::size_t i = 0; i < fates.size(); ++i) {
    shots[i].index = i;
    shots[i].fate = fates[i];
  }
  std::string expected, zeros = "0.0000 0.0000 0.0000 0.000000000 0.000000000 0.000000000 0.0000 ";
  for (const char* end : {"0 0 0\n", "1 0 2\n", "2 0 3\n", "3 0 4\n", "4 0 5\n"}) expected += zeros + end;
  CHECK(written(shots) == expected);
}

TEST_CASE("no pulses make an empty file; one without a place or a direction is an error") {
  CHECK(written({}).empty());
  const TemporaryFolder folder;
  std::vector<Shot> shots(2);
  for (Vec3 Shot::*member : {&Shot::origin, &Shot::direction}) {
    shots[1] = {};
    (shots[1].*member).z = std::numeric_limits<double>::quiet_NaN();
    PulseTextWriter writer(folder / "pulses.txt");
    CHECK_THROWS_WITH_AS(writer(EchoBatch{shots, {}, {}, 0}), doctest::Contains("line 2"), FileError);
  }
  CHECK_THROWS_AS(PulseTextWriter(folder / "a.txt", {.start_time = std::numeric_limits<double>::infinity()}), SettingError);
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::io
