// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/ptx.hpp>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>

#include "support/generators.hpp"
#include "support/refused_field.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using namespace literals;
using support::content;
using support::refused_field;
using support::TemporaryFolder;

/// Pulses with an echo each, at these slots; the reported point of each is given.
struct Points {
  std::vector<Shot> shots{};
  std::vector<Echo> echoes{};

  void add(PulseIndex slot, const Vec3& at, double reflectance = 0.25, int more = 0) {
    const auto first = static_cast<std::uint32_t>(echoes.size());
    shots.push_back({.index = slot, .origin = {0, 0, 0}, .direction = at / length(at), .first_echo = first});
    shots.back().echoes = static_cast<std::uint32_t>(1 + more);
    for (int k = 0; k <= more; ++k)
      echoes.push_back({.range = length(at) + k, .reflectance = static_cast<float>(reflectance)});
  }
  [[nodiscard]] EchoBatch batch() const { return {.shots = shots, .echoes = echoes, .samples = {}}; }
};

TEST_CASE("a file of one scan, line by line: a header, and a line for each row of each column") {
  const TemporaryFolder folder;
  PtxWriter writer(folder / "a.ptx", {{.first = 10,
                                       .end = 19,
                                       .line_slots = 4,
                                       .before = 1,
                                       .rows = 3,
                                       .scanner = {rotation_about(axis::up, 90_deg), {0, 0, 2}}}});
  Points points;
  points.shots.push_back({.index = 10});  // without an echo
  points.add(11, {-4, 0, 2}, 0.5, 2);     // row 2 of column 0: 4 m forward of a scanner that faces west
  points.add(12, {1, 1, 1});              // row 3, which has no place
  points.add(13, {0, 3, 2}, 2);           // row 0 of column 1: 3 m to the right
  points.add(18, {0, 0, 5}, -1);          // row 1 of column 2
  writer(points.batch());
  writer.close();
  CHECK(writer.echoes_left_out() == 3);
  std::istringstream lines(content(folder / "a.ptx"));
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  REQUIRE(all.size() == 10 + 3 * 3);
  CHECK((all[0] == "3" && all[1] == "3"));
  CHECK(all[2] == "0.000000000 0.000000000 2.000000000");
  CHECK(all[3] == "0.000000000 1.000000000 0.000000000");   // x, to the right, is north
  CHECK(all[4] == "-1.000000000 0.000000000 0.000000000");  // y, forward, is west
  CHECK(all[5] == "0.000000000 0.000000000 1.000000000");
  CHECK(all[6] == all[3] + " 0");
  CHECK((all[7] == all[4] + " 0" && all[8] == all[5] + " 0" && all[9] == all[2] + " 1"));
  const std::string none = "0 0 0 0.5";
  const std::vector<std::string> rows{none,
                                      none,
                                      "0.000000 4.000000 0.000000 0.500000",
                                      "3.000000 0.000000 0.000000 1.000000",
                                      none,
                                      none,
                                      none,
                                      "0.000000 0.000000 3.000000 0.000000",
                                      none};
  for (std::size_t k = 0; k < rows.size(); ++k) CHECK(all[10 + k] == rows[k]);
}

TEST_CASE("the matrix brings all points of any number of scans back to the world") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    std::vector<PtxScan> scans;
    Points points;
    std::vector<Vec3> world;
    std::vector<std::size_t> lines_of;
    PulseIndex slot = 0;
    for (int k = 0; k < 3; ++k) {
      const auto line = 1 + random.whole(9);
      PtxScan scan{.first = slot, .line_slots = line, .before = random.whole(line), .rows = line};
      scan.end = slot + 1 + random.whole(40);
      scan.scanner = {random.rotation(), random.point(1e3)};
      for (PulseIndex i = scan.first; i < scan.end; ++i)
        if (random.whole(3) > 0) {
          world.push_back(random.point(100));
          points.add(i, world.back());
        }
      slot = scan.end + random.whole(3);
      scans.push_back(scan);
    }
    const TemporaryFolder folder;
    PtxWriter writer(folder / "a.ptx", scans);
    for (const Shot& shot : points.shots) writer({.shots = {&shot, 1}, .echoes = points.echoes, .samples = {}});
    writer.close();
    CHECK(writer.echoes_left_out() == 0);
    std::istringstream in(content(folder / "a.ptx"));
    std::size_t found = 0;
    for (const PtxScan& scan : scans) {
      std::uint64_t columns = 0, rows = 0;
      in >> columns >> rows;
      CHECK((columns == scan.columns() && rows == scan.rows));
      double skipped = 0, m[4][4];
      for (int i = 0; i < 12; ++i) in >> skipped;
      for (auto& row : m)
        for (double& number : row) in >> number;
      for (std::uint64_t i = 0; i < columns * rows; ++i) {
        double p[3], intensity = 0;
        in >> p[0] >> p[1] >> p[2] >> intensity;
        if (p[0] == 0 && p[1] == 0 && p[2] == 0) {
          CHECK(intensity == 0.5);
          continue;
        }
        REQUIRE(found < world.size());
        CHECK(scan.first + i == points.shots[found].index + scan.before);
        for (int axis = 0; axis < 3; ++axis) {
          const double at = p[0] * m[0][axis] + p[1] * m[1][axis] + p[2] * m[2][axis] + m[3][axis];
          CHECK(std::fabs(at - world[found][axis]) < 3e-6);
        }
        ++found;
      }
    }
    CHECK(static_cast<bool>(in));
    CHECK(found == world.size());
    std::string more;
    CHECK_FALSE(static_cast<bool>(in >> more));
  }
}

TEST_CASE("without close there is no file, and echoes beyond all scans have no place") {
  const TemporaryFolder folder;
  Points points;
  points.add(5, {1, 1, 1});
  {
    PtxWriter writer(folder / "a.ptx", {{.first = 0, .end = 4, .line_slots = 2, .rows = 2}});
    writer(points.batch());
    CHECK(writer.echoes_left_out() == 1);
  }
  CHECK(folder.empty());
  PtxWriter none(folder / "b.ptx", {});
  none(points.batch());
  none.close();
  CHECK(content(folder / "b.ptx").empty());
}

TEST_CASE("scans out of range or order are refused, and leave no file") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::vector<PtxScan>& scans) {
    return refused_field([&] { PtxWriter(folder / "a.ptx", scans); });
  };
  CHECK(refused({{.first = 3, .end = 3}}) == "PtxScan::end - first");
  CHECK(refused({{.line_slots = 0}}) == "PtxScan::line_slots");
  CHECK(refused({{.line_slots = 3, .before = 3}}) == "PtxScan::before");
  CHECK(refused({{.line_slots = 3, .rows = 4}}) == "PtxScan::rows");
  CHECK(refused({{.scanner = {no_rotation, {std::numeric_limits<double>::infinity(), 0, 0}}}}) ==
        "PtxScan::scanner (distance)");
  CHECK(refused({{.first = 0, .end = 4}, {.first = 3, .end = 9}}) == "PtxScan::first");
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::io
