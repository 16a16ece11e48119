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

#include "support/file_errors.hpp"
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

TEST_CASE("a grid that may be in degrees is read with a question") {
  const auto warnings = [&](const std::string& place) {
    return read("ncols 2\nnrows 2\n" + place + "\n1 2\n3 4\n").warnings;
  };
  const std::vector<std::string> globe = warnings("xllcorner 8.5\nyllcorner 49.4\ncellsize 0.000278");
  REQUIRE(globe.size() == 1);
  CHECK(globe[0].ends_with("is it in degrees? Expected metres"));
  CHECK(warnings("xllcorner 500000\nyllcorner 5400000\ncellsize 0.005").empty());
  CHECK(warnings("xllcorner 8\nyllcorner 49\ncellsize 0.5").empty());
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
