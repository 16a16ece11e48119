// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/ascii_grid.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/detail/raster_rules.hpp>

#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/spoilt_text.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

const std::string head = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 2\n";

AsciiGrid read(const std::string& text, const AsciiGridSettings& settings = {}) {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "a.asc", std::ios::binary) << text;
  return read_ascii_grid(folder / "a.asc", settings);
}

TEST_CASE("settings replace the missing value of the file and scale the heights, the missing value before") {
  const std::vector<float> heights =
      read(head + "NODATA_value -1\n-1 -9999 7\n4 5 6\n", {.vertical_scale = 0.5, .missing = 7}).raster.heights;
  CHECK(heights[0] == -0.5F);
  CHECK(heights[1] == -4999.5F);
  CHECK(std::isnan(heights[2]));
  CHECK(heights[5] == 3);
  for (const double scale : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")})
    CHECK_THROWS_AS((void)read(head + "1 2 3 4 5 6", {.vertical_scale = scale}), SettingError);
}

TEST_CASE("a mark, CR LF, CR alone, and NODATA of float limits are read") {
  CHECK(read("\xEF\xBB\xBF" + head + "1 2 3 4 5 6\n").raster.heights[5] == 6);
  const AsciiGrid limit = read(head + "nodata_VALUE -3.4028234663852886e+38\n-3.4028234663852886e+38 2 3 4 5 6\n");
  CHECK(std::isnan(limit.raster.heights[0]));
  CHECK(limit.warnings.empty());
  std::string old = head + "1 2 3 4 5 6\n";
  for (char& c : old)
    if (c == '\n') c = '\r';
  CHECK(read(old).raster.heights[3] == 4);
}

TEST_CASE("a grid of one line longer than a block is read, words across the ends of blocks too") {
  for (const std::size_t shift : {0U, 1U, 2U, 3U, 4U, 5U, 6U}) {
    std::string text = std::string(shift, ' ') + "ncols 1000 nrows 500 xllcorner 0 yllcorner 0 cellsize 1";
    for (int i = 0; i < 500000; ++i) text += ' ' + std::to_string(100000 + i % 99991);
    const AsciiGrid grid = read(text + '\n');
    bool same = true;
    for (std::size_t i = 0; i < 500000; ++i)
      same = same && grid.raster.heights[i] == static_cast<float>(100000 + i % 99991);
    CHECK(same);
    CHECK(grid.warnings.empty());
    CHECK(support::file_error([&] { (void)read(text + "\n\nx"); }).place() == "line 3");
  }
}

TEST_CASE("a grid that can only be in degrees is refused, unless a file beside it names a projected system") {
  const auto grid = [](const std::string& place) { return "ncols 2\nnrows 2\n" + place + "\n1 2\n3 4\n"; };
  for (const char* globe :
       {"xllcorner 8.5\nyllcorner 49.4\ncellsize 0.000278", "xllcenter -180\nyllcorner 0\ncellsize 0.0083",
        "xllcorner 8\nyllcorner 49\ncellsize 0.0166666667", "xllcorner 8\nyllcorner 49\ncellsize 0.08333333333333"}) {
    CAPTURE(globe);
    const FileError error = support::file_error([&] { (void)read(grid(globe)); });
    CHECK(support::contains(error.problem(), "is it in degrees? Expected metres; gdalwarp"));
  }
  CHECK_THROWS_AS((void)read("ncols 4\nnrows 2\nxllcorner -180\nyllcorner -90\ncellsize 90\n1 2 3 4 5 6 7 8\n"),
                  FileError);
  for (const char* place :
       {"xllcorner 500000\nyllcorner 5400000\ncellsize 0.005", "xllcorner 8\nyllcorner 49\ncellsize 0.5",
        "xllcorner 0\nyllcorner 0\ncellsize 0.05", "xllcorner 8\nyllcorner 49\ncellsize 1"})
    CHECK(read(grid(place)).warnings.empty());
  const support::TemporaryFolder folder;
  std::ofstream(folder / "a.asc") << grid("xllcorner 8\nyllcorner 49\ncellsize 0.005");
  std::ofstream(folder / "a.prj") << R"(PROJCS["site",GEOGCS["x",UNIT["Degree",0.0174]],UNIT["Meter",1.0]])";
  CHECK(read_ascii_grid(folder / "a.asc").raster.pixel.x == 0.005);
}

TEST_CASE("a system beside the grid tells the unit of coordinates and heights") {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "a.asc") << head + "1 2 3\n4 5 6\n";
  const auto with = [&](const std::string& system, const AsciiGridSettings& settings = {}) {
    std::ofstream(folder / "a.prj") << system;
    return read_ascii_grid(folder / "a.asc", settings);
  };
  const std::string feet = R"(PROJCS["x",GEOGCS["y",UNIT["Degree",0.0174]],UNIT["Foot",0.3048]])";
  const std::string up = R"(,VERTCS["z",VDATUM["z"],PARAMETER["Direction",1.0],UNIT["Foot_US",0.25]])";
  const AsciiGrid flat = with(feet), high = with(feet + up), scaled = with(feet + up, {.vertical_scale = 2});
  for (const AsciiGrid* grid : {&flat, &high, &scaled}) {
    CHECK(grid->raster.pixel == Vec2{2 * 0.3048, 2 * 0.3048});
    CHECK(grid->raster.first == Vec2{101 * 0.3048, 203 * 0.3048});
    CHECK(grid->reference.unit == 0.3048);
  }
  CHECK(flat.raster.heights[1] == 2);
  CHECK(flat.warnings.size() == 1);  // of heights without a unit
  CHECK(high.raster.heights[1] == 0.5F);
  CHECK(high.warnings.empty());
  CHECK(scaled.raster.heights[1] == 4);
  CHECK(support::contains(support::file_error([&] { (void)with(R"(GEOGCS["y",UNIT["Degree",0.0174]])"); }).problem(),
                          "projected coordinates, not degrees"));
}

TEST_CASE("heights that often mark missing ones are noted without NODATA_value") {
  CHECK(read(head + "1 2 -32768 -32768 5 6\n").warnings.size() == 1);
  CHECK(read(head + "NODATA_value -9999\n1 2 -32768 -32768 5 6\n").warnings.empty());
  CHECK(read(head + "1 2 -9999 4 5 6\n").warnings.empty());  // missing by habit
  CHECK(read(head + "1 2 -32768 4 5 6\n", {.missing = 1}).warnings.empty());
}

TEST_CASE("each keyword of the rules changes what is read") {
  const auto changes = [](const std::string& text, bool is_changed) {
    CHECK(is_changed);
    return read(text).warnings;
  };
  const std::string rest = "1 2 3 4 5 6\n";
  const Raster usual = read(head + rest).raster;
  const std::string wide = "ncols 2\nnrows 3\nxllcenter 100\nyllcenter 200\ndx 3\ndy 4\nNODATA_value 3\n" + rest;
  const Raster other = read(wide).raster;
  test::check_rules(
      io::detail::ascii_grid_rules,
      std::vector<test::FormatCase>{{"ncols", [&] { return changes(wide, other.columns == 2); }},
                                    {"nrows", [&] { return changes(wide, other.rows == 3); }},
                                    {"xllcorner", [&] { return changes(head + rest, usual.first.x == 101); }},
                                    {"xllcenter", [&] { return changes(wide, other.first.x == 100); }},
                                    {"yllcorner", [&] { return changes(head + rest, usual.first.y == 203); }},
                                    {"yllcenter", [&] { return changes(wide, other.first.y == 208); }},
                                    {"cellsize",
                                     [&] {
                                       return changes(head + rest, usual.pixel == Vec2{2, 2});
                                     }},
                                    {"dx", [&] { return changes(wide, other.pixel.x == 3); }},
                                    {"dy", [&] { return changes(wide, other.pixel.y == 4); }},
                                    {"NODATA_value", [&] { return changes(wide, std::isnan(other.heights[2])); }}});
}

TEST_CASE("counts that the file cannot hold are refused before memory is taken") {
  const FileError error = support::file_error(
      [] { (void)read("ncols 134217728\nnrows 134217728\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n"); });
  CHECK(error.place() == "line 2");
  CHECK(support::contains(error.problem(), "18014398509481984"));
  CHECK(support::file_error([] {
          (void)read("ncols 13421772\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n");
        }).place() == "line 2");
  CHECK(read("ncols 2 nrows 2 dx 1 dy 1 xllcenter 0 yllcenter 0 1 2 3 4").raster.heights.size() ==
        4);  // the least file
}

TEST_CASE("truncated grids are refused, or warn of it") {
  const std::string whole = head + "NODATA_value -1\n1 2 3.5\n4 -1 6.25\n";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    CAPTURE(size);
    try {
      const AsciiGrid grid = read(whole.substr(0, size));
      CHECK(grid.warnings.size() == 1);
    } catch (const FileError& error) {
      if (size > 0) CHECK((error.place().starts_with("line ")));
    }
  }
}

TEST_CASE("1000 spoilt grids are read, or refused by a FileError") {
  constexpr const char* words[] = {"nan",   "-1",   "1e308",        "99999999999", "inf",
                                   "ncols", "dx 1", "NODATA_value", "\n",          ","};
  int refused = 0, accepted = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    support::Generator random(seed);
    CAPTURE(seed);
    const std::string text = support::spoilt(head + "1 2 3.5\n4 -1 6\n", 1 + random.whole(3), words, random);
    try {
      read(text).raster.validate();
      ++accepted;
    } catch (const FileError&) {
      ++refused;
    }
  }
  MESSAGE(refused << " refused, " << accepted << " read");
  CHECK(refused > 50);
  CHECK(accepted > 10);
}

TEST_CASE("a grid is told by its extension") {
  CHECK(is_ascii_grid("a/dem.asc"));
  CHECK(is_ascii_grid("DEM.ASC"));
  CHECK_FALSE(is_ascii_grid("asc"));
  CHECK_FALSE(is_ascii_grid("dem.tif"));
}

}  // namespace
}  // namespace pulsecast::io
