// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/text/points.hpp>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/file_errors.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::TemporaryFolder;

struct Read {
  std::vector<Vec3> positions, normals, colours;
  std::vector<std::string> warnings;
};

Read read(const std::string& text, const TextPointColumns& columns = {}) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.xyz", std::ios::binary) << text;
  TextPoints points(InputFile(folder / "a.xyz", "a point cloud"), columns);
  Read result;
  while (points.next()) {
    result.positions.push_back(points.position());
    if (points.has_normals()) result.normals.push_back(points.normal());
    if (points.has_colours()) result.colours.push_back(points.colour());
  }
  result.warnings = points.warnings();
  return result;
}

FileError error(const std::string& text, const TextPointColumns& columns = {}) {
  return support::file_error([&] { (void)read(text, columns); });
}

using Points = std::vector<Vec3>;
const Points two{{1, 2, 3}, {-4.5, 5e3, 0.25}};

TEST_CASE("columns are separated by what the first row has, or by what is given") {
  CHECK(read("1 2 3\n-4.5 5e3 .25\n").positions == two);
  CHECK(read("1,2,3\n-4.5,5e3,.25\n").positions == two);
  CHECK(read("1;2;3\n-4.5;5e3;.25\n").positions == two);
  CHECK(read("1\t2\t3\n-4.5\t5e3\t.25\n").positions == two);
  CHECK(read("1|2:3\n-4.5:5e3|.25\n", {.separators = "|:"}).positions == two);
  CHECK(read("1,2 3\n-4.5,5e3 .25\n", {.separators = ", "}).positions == two);
  CHECK(read("1_2_3\n-4.5_5e3_.25\n", {.separators = "_"}).positions == two);
}

TEST_CASE("many blanks are one separator, and none beside another one") {
  CHECK(read("  1 \t 2   3  \n\t-4.5  5e3\t\t.25\t\n").positions == two);
  CHECK(read(" 1 ,2 ,\t3 \n -4.5,  5e3,.25").positions == two);
  CHECK(read("1 , 2 3\n-4.5, 5e3 , .25 \n", {.separators = ", "}).positions == two);
  CHECK(error("1,,2,3\n").place() == "line 1, column 2");
  CHECK(error("1,,2,3\n").problem() == "'': expected a finite number, with a decimal point, within 1e12");
}

TEST_CASE("comments and blank rows do not count, lines do") {
  CHECK(read("// x y z\n#1 9 9\n\n1 2 3\n  \t\n  # no\n -4.5 5e3 .25\n//\n").positions == two);
  CHECK(read("\xEF\xBB\xBF"
             "1 2 3\r\n-4.5 5e3 .25\r\n")
            .positions == two);
  CHECK(error("//\n\n1 2 3\n1 2 x\n").place() == "line 4, column 3");
}

TEST_CASE("columns stand in any order") {
  const TextPointColumns columns{.position = {4, 0, 2},
                                 .normal = TextPointColumns::Columns{1, 1, 3},
                                 .colour = TextPointColumns::Columns{5, 6, 7}};
  const Read found = read("2 0.5 3 0.25 1 10 20 30\n5e3 -1 .25 7 -4.5 40 50 60 tree 5\n", columns);
  CHECK(found.positions == two);
  CHECK(found.normals == Points{{0.5, 0.5, 0.25}, {-1, -1, 7}});
  CHECK(found.colours == Points{{10, 20, 30}, {40, 50, 60}});
}

TEST_CASE("columns that are not asked for may hold anything") {
  CHECK(read("a 1 b 2 c 3\n\x01 -4.5 nan 5e3 - .25\n", {.position = {1, 3, 5}, .normal = {}, .colour = {}}).positions ==
        two);
}

TEST_CASE("the first row decides whether there are normals and colours") {
  const Read bare = read("1 2 3\n-4.5 5e3 .25 0 0 1\n");
  CHECK(bare.positions == two);
  CHECK(bare.normals.empty());
  CHECK(bare.colours.empty());
  CHECK(read("1 2 3 4 5\n").normals.empty());  // one column is missing
  CHECK(read("1 2 3 4 5 6\n").normals == Points{{4, 5, 6}});
  CHECK(read("1 2 3 4 5 6 7 8\n").colours.empty());
  CHECK(read("1 2 3 4 5 6 7 8 9\n").colours == Points{{7, 8, 9}});
  const FileError e = error("1 2 3 0 0 1\n1 2 3 0 0\n");
  CHECK(e.place() == "line 2");
  CHECK(e.problem() == "has 5 columns: expected at least 6");
}

TEST_CASE("one first row of names or a count is skipped with a warning, or gives the columns if it has x, y and z") {
  const auto skipped = [](const std::string& head, const std::string& what) {
    CAPTURE(head);
    const Read found = read(head + "1;2;3\n-4.5;5e3;.25\n");
    CHECK(found.positions == two);
    REQUIRE(found.warnings.size() == 1);
    CHECK(found.warnings[0].find("a.xyz, line " + what) != std::string::npos);
  };
  CHECK(read("2\n1;2;3\n-4.5;5e3;.25\n").warnings.empty());
  CHECK(read("75\n1;2;3\n-4.5;5e3;.25\n").warnings.at(0).find("a.xyz: announces 75 points and has 2") !=
        std::string::npos);
  skipped("//X;Y;Z;Intensity\n2\n", "3: has 3 columns, and 4 are named");
  skipped("x (ft);y (ft);z (ft)\n", "1: 'x (ft);y (ft);z (ft)' is skipped, as names of columns");
  skipped("east,north,height\n", "1: 'east,north,height' is skipped, as names of columns");
  for (const char* names : {"X;Y;Z\n", "\"x\" \"y\" \"z\"\n", "# x y z\n", "//X, Y, Z, Intensity\n"}) {
    CAPTURE(names);
    const Read found = read(std::string(names) + "1 2 3 9\n");
    CHECK(found.positions == Points{{1, 2, 3}});
    CHECK(found.warnings.empty());
  }
  for (const char* names : {"# time x y z\n", "time,x,y,z\n", "#time Y Z X\n"}) {
    CAPTURE(names);
    const bool turned = std::string(names).find('Y') != std::string::npos;
    CHECK(read(std::string(names) + "9 1 2 3\n").positions == Points{turned ? Vec3{3, 1, 2} : Vec3{1, 2, 3}});
    CHECK(error(std::string(names) + "1 2 3\n").problem() == "has 3 columns: expected at least 4");
  }
  const Read normals = read("x y z intensity class nz ny nx blue green red\n1 2 3 4 5 6 7 8 9 10 11\n");
  CHECK(normals.normals == Points{{8, 7, 6}});
  CHECK(normals.colours == Points{{11, 10, 9}});
  CHECK(read("x y z a b c d e f\n1 2 3 4 5 6 7 8 9\n").normals.empty());
  CHECK(read("z y x\n1 2 3\n", {.position = {0, 2, 1}}).positions == Points{{1, 3, 2}});  // settings have the last word
  for (const char* names : {"y x z\n", "# y x z\n"})
    CHECK(read(std::string(names) + "1 2 3\n", {.position = {1, 2, 0}})
              .warnings.at(0)
              .find("names other columns than the settings") != std::string::npos);
  CHECK(read("# by x\n1 2 3\n").warnings.empty());
  CHECK(read("time,x,y,z\n9,1,2,3\n", {.position = {1, 2, 3}}).positions == Points{{1, 2, 3}});
  for (const char* bad : {"x y z\nx y z\n1 2 3\n", "2\n2\n1 2 3\n", "x 2 z\n1 2 3\n", "x y\n1 2 3\n", "2.5\n1 2 3\n"}) {
    CAPTURE(bad);
    CHECK_THROWS_AS((void)read(bad), FileError);
  }
}

TEST_CASE("normals far from a length of one, as of colours, get a note") {
  CHECK(read("1 2 3 255 128 0\n").warnings.at(0).find("has a normal of length 285.") != std::string::npos);
  CHECK(read("1 2 3 0 0.6 0.8\n").warnings.empty());
  CHECK(read("1 2 3 0 0 0\n").warnings.empty());
}

TEST_CASE("each row of the rules of named columns that is refused has a file") {
  CHECK(error("lat,lon,z\n47,8,400\n").problem() == "'lat,lon,z': expected coordinates in metres, not degrees");
  CHECK(error("Longitude;Latitude;z\n8;47;400\n").place() == "line 1");
  CHECK(read("lat,lon,x,y,z\n47,8,1,2,3\n").positions == Points{{1, 2, 3}});
}

TEST_CASE("rows that cannot be right are refused, with line and column") {
  const auto problem = [](const char* cell) {
    return std::string("'") + cell + "': expected a finite number, with a decimal point, within 1e12";
  };
  for (const char* cell : {"nan", "inf", "-inf", "x", "1.5x", "1e13", "-1e13", "1e999", "0x10", "--1", "1..2"}) {
    CAPTURE(cell);
    const FileError e = error("1 2 3\n1 " + std::string(cell) + " 3\n");
    CHECK(e.place() == "line 2, column 2");
    CHECK(e.problem() == problem(cell));
  }
  CHECK(error("1 2 3 0 nan 1\n").place() == "line 1, column 5");
  CHECK(error("1 2 3 0 0 1 0 y 0\n").place() == "line 1, column 8");
  CHECK(error("1 2 3\nx y z\n").place() == "line 2, column 1");
  CHECK(error("1 2\n").problem() == "has 2 columns: expected at least 3");
  CHECK(error("1 2 3\n4 5\n").place() == "line 2");
  CHECK(error("1,2 3,4 5,6\n").problem() == problem("2 3"));
  CHECK(error("PK\x03\x04 2 3\n").problem() == "holds binary data: expected the text of a point cloud");
}

TEST_CASE("a last line without an end is read, with a warning") {
  const Read found = read("1 2 3\n-4.5 5e3 .25");
  CHECK(found.positions == two);
  REQUIRE(found.warnings.size() == 1);
  CHECK(found.warnings[0].ends_with("a.xyz: the last line has no line end: the file may be truncated"));
  CHECK(read("1 2 3\n").warnings.empty());
  CHECK(read("1 2 3\n# end").warnings.empty());
}

TEST_CASE("columns and separators that cannot be are refused") {
  for (const char* separators : {"1", ",e", "E", ".", "+", "-", "#", "/", "\n"}) {
    CAPTURE(separators);
    CHECK_THROWS_WITH_AS((TextPointColumns{.separators = separators}.validate()),
                         doctest::Contains("TextPointColumns::separators"), SettingError);
  }
  CHECK_THROWS_AS((TextPointColumns{.position = {0, 1, 1000}}.validate()), SettingError);
  CHECK_THROWS_AS((TextPointColumns{.normal = TextPointColumns::Columns{0, 1, 1000}}.validate()), SettingError);
  CHECK_THROWS_AS((TextPointColumns{.colour = TextPointColumns::Columns{std::size_t(-1), 1, 2}}.validate()),
                  SettingError);
  CHECK_NOTHROW((TextPointColumns{.separators = " \t,;|_", .normal = std::nullopt}.validate()));
}

}  // namespace
}  // namespace pulsecast::io
