// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/subray_text.hpp>

#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::TemporaryFolder;

SubrayHit hit(double range, double power, const Vec3& point) {
  SubrayHit hit;
  hit.range = range;
  hit.power = power;
  hit.point = point;
  hit.cos_incidence = 0.5;
  hit.backscatter = 0.25;
  hit.object = 12;
  hit.classification = 5;
  return hit;
}

TEST_CASE("a hit is a line of eleven columns; subrays that met nothing have none, and keep their numbers") {
  const TemporaryFolder folder;
  std::vector<Shot> shots(2);
  shots[0].index = 40;
  shots[1].index = 41;
  const std::vector<SubrayHit> subrays{hit(10, 2.5e-9, {1, 2, 3}), SubrayHit{}, SubrayHit{}, hit(20.00016, 0, {-1, 0, 5e6})};
  SubrayTextWriter writer(folder / "subrays.txt");
  writer(EchoBatch{shots, {}, {}, 0, subrays});
  writer.close();
  CHECK(content(folder / "subrays.txt") ==
        "40 0 1.0000 2.0000 3.0000 10.0000 2.500000000 0.500000 0.250000 12 5\n"
        "41 1 -1.0000 0.0000 5000000.0000 20.0002 0.000000000 0.500000 0.250000 12 5\n");
}

TEST_CASE("without recorded subrays, and without pulses, the file is empty; a hit without a place is an error") {
  const TemporaryFolder folder;
  const std::vector<Shot> shots(2);
  SubrayTextWriter writer(folder / "subrays.txt");
  writer(EchoBatch{shots, {}, {}, 0, {}});
  writer(EchoBatch{});
  writer.close();
  CHECK(content(folder / "subrays.txt").empty());
  const std::vector<SubrayHit> subrays(2, hit(1, 1, {0, std::numeric_limits<double>::quiet_NaN(), 0}));
  SubrayTextWriter bad(folder / "bad.txt");
  CHECK_THROWS_AS(bad(EchoBatch{shots, {}, {}, 0, subrays}), FileError);
  CHECK_FALSE(std::filesystem::exists(folder / "bad.txt.part"));
}

}  // namespace
}  // namespace pulsecast::io
