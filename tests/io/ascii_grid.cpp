// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/ascii_grid.hpp>

#include <cmath>
#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

const std::string head = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 2\n";

struct Files {
  support::TemporaryFolder folder;

  [[nodiscard]] AsciiGrid read(const std::string& text) const {
    std::ofstream(folder / "a.asc", std::ios::binary | std::ios::trunc) << text;
    return read_ascii_grid(folder / "a.asc");
  }
  [[nodiscard]] std::string refusal(const std::string& text) const {
    try {
      (void)read(text);
      return {};
    } catch (const FileError& error) {
      return error.what();
    }
  }
};

TEST_CASE("a grid has its pixels where its corner says, and its rows from the north") {
  const Files files;
  const AsciiGrid grid = files.read(head + "1 2 3\n4 5 6\n");
  CHECK(grid.raster.columns == 3);
  CHECK(grid.raster.rows == 2);
  CHECK(grid.raster.first == Vec2{101, 203});
  CHECK(grid.raster.pixel == Vec2{2, 2});
  CHECK(grid.raster.heights == std::vector<float>{1, 2, 3, 4, 5, 6});
  CHECK(grid.warnings.empty());
  REQUIRE(files.read(head + "1 2 3\n4 5 6").warnings.size() == 1);
  CHECK(files.read(head + "1 2 3\n4 5 6").warnings[0].find("may be truncated") != std::string::npos);
  std::ofstream(files.folder / "b.asc") << head << "1 2 3\n4 -1 6\n";
  const AsciiGrid feet = read_ascii_grid(files.folder / "b.asc", {.vertical_scale = 0.5, .missing = -1});
  CHECK(feet.raster.heights[1] == 1);
  CHECK(std::isnan(feet.raster.heights[4]));
  CHECK_THROWS_AS((void)read_ascii_grid(files.folder / "b.asc", {.vertical_scale = 0}), SettingError);
}

TEST_CASE("a grid may be given by centres, by two sizes, in any case, order and lines") {
  const Files files;
  const Raster corner = files.read(head + "1 2 3 4 5 6").raster;
  for (const std::string text : {"NROWS 2\r\nNCOLS 3\r\nXLLCENTER 101\r\nYLLCENTER 201\r\nCELLSIZE 2\r\n1 2\r\n3 4 5\r\n\r\n6\r\n",
                                 "cellsize 2 xllcenter 101 yllcorner 200\tnrows 2 ncols 3 1 2 3 4 5 6"}) {
    const Raster other = files.read(text).raster;
    CHECK(other.first == corner.first);
    CHECK(other.heights == corner.heights);
  }
  const Raster tall = files.read("ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ndx 2\ndy 4\n1 2 3 4 5 6").raster;
  CHECK(tall.pixel == Vec2{2, 4});
  CHECK(tall.first == Vec2{101, 206});
}

TEST_CASE("missing heights are those of the file's value, NaN, and what cannot be a height") {
  const Files files;
  const AsciiGrid by_default = files.read(head + "-9999 nan 3\n1e16 5 -9998\n");
  const std::vector<float>& heights = by_default.raster.heights;
  for (const std::size_t i : {0U, 1U, 3U}) CHECK(std::isnan(heights[i]));
  CHECK(heights[5] == -9998);
  REQUIRE(by_default.warnings.size() == 1);
  CHECK(by_default.warnings[0].find("line 7: a height is beyond 1e15 m, one of 1") != std::string::npos);
  const Raster own = files.read(head + "NODATA_value -1\n-1 -9999 3\n4 5 6\n").raster;
  CHECK(std::isnan(own.heights[0]));
  CHECK(own.heights[1] == -9999);
}

TEST_CASE("a damaged grid is explained, or read") {
  const Files files;
  const auto says = [&](const std::string& text, const std::string& part) {
    CAPTURE(text);
    CHECK(files.refusal(text).find(part) != std::string::npos);
  };
  says("", "a.asc");
  says(head, "ends after 0 heights");
  says(head + "1 2 3 4 5", "ends after 5 heights");
  says(head + "1 2 3\n4 5 6 7", "line 7: '7' is one height too many");
  says(head + "1 2 x\n4 5 6", "line 6: 'x': expected a height");
  says(head + "colour 3\n1 2 3 4 5 6", "line 6: 'colour': expected a keyword");
  says(head + "ncols 3\n1 2 3 4 5 6", "line 6: 'ncols' is repeated");
  says(head + "xllcenter 3\n1 2 3 4 5 6", "both 'xllcorner' and 'xllcenter'");
  says("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\n1 2 3 4 5 6", "neither 'cellsize' nor 'dx'");
  says("ncols 3\nnrows 2\ncellsize 1\nyllcorner 0\n1 2 3 4 5 6", "neither 'xllcorner' nor 'xllcenter'");
  says("nrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4 5 6", "has no 'ncols'");
  says("ncols", "'ncols' is ''");
  says("ncols inf", "'ncols' is 'inf'");
  for (const std::string count : {"-3", "1", "2.5", "1e30", "134217729"})
    says("ncols " + count + "\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4 5 6", "'ncols' is ");
  for (const std::string size : {"0", "-1"})
    says("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize " + size + "\n1 2 3 4 5 6", "'cellsize' is ");
  says("ncols 3\nnrows 2\nxllcorner 1e300\nyllcorner 0\ncellsize 1\n1 2 3 4 5 6", "Raster::first.x is ");
  says(head + "-9999 -9999 -9999 -9999 -9999 -9999", "has no height that is not missing");
  says(std::string("ncols 3\nnrows 2\n\0\1\2\xFF", 20), "expected");
  // counts that the file cannot hold are refused before there is memory for them
  says("ncols 100000\nnrows 20000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3", "'ncols' times 'nrows' is 2000000000");
  const std::string whole = head + "1 2 3\n4 5 6";
  for (std::size_t length = 0; length < whole.size(); ++length) {
    CAPTURE(length);
    CHECK_FALSE(files.refusal(whole.substr(0, length)).empty());
  }
  CHECK(files.refusal(whole).empty());
}

TEST_CASE("a grid is told by its extension") {
  CHECK(is_ascii_grid("a/dem.asc"));
  CHECK(is_ascii_grid("DEM.ASC"));
  CHECK_FALSE(is_ascii_grid("asc"));
  CHECK_FALSE(is_ascii_grid("dem.tif"));
}

}  // namespace
}  // namespace pulsecast::io
