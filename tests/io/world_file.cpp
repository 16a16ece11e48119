// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/world_file.hpp>

#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "support/file_errors.hpp"
#include "support/generators.hpp"
#include "support/spoilt_text.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using support::contains;

namespace {

const support::TemporaryFolder folder;

WorldFile read(const std::string& text) {
  std::ofstream(folder / "dem.pgw", std::ios::binary) << text;
  return read_world_file(folder / "dem.pgw");
}

std::string error(const std::string& text) {
  return support::file_error([&] { (void)read(text); }).what();
}

}  // namespace

TEST_CASE("a world file places the pixels of a picture") {
  for (const char* text : {"2\n0\n0\n-3\n1001\n1998.5\n", "2.0\r\n0.0\r\n-0.0\r\n-3.0\r\n1001\r\n1998.5",
                           "\n 2\n0\n0\n -3e0\n1.001e3\n\n1998.5\n\n"}) {
    INFO(text);
    const WorldFile world = read(text);
    CHECK(world.step == Vec2{2, -3});
    CHECK(world.first == Vec2{1001, 1998.5});
  }
  CHECK(read("2\n0\n0\n3\n1\n2\n").step.y == 3);  // rows to the north
}

TEST_CASE("what is no placement is refused, with its line") {
  CHECK(contains(error("2\n0\n0\n-3\n1\n"), "ends after 5 numbers"));
  CHECK(contains(error("2\n0\n0\n-3\n1\n2\n7\n"), "line 7: is a line too many"));
  CHECK(contains(error("2\n0,1\n0\n-3\n1\n2\n"), "line 2: '0,1': expected a number"));
  CHECK(contains(error("2\n0.1\n0\n-3\n1\n2\n"), "line 2: is rotated or sheared"));
  CHECK(contains(error("2\n0\n-0.1\n-3\n1\n2\n"), "line 3: is rotated or sheared"));
  CHECK(contains(error("-2\n0\n0\n-3\n1\n2\n"), "line 1: has columns that go west"));
  CHECK(contains(error("0\n0\n0\n-3\n1\n2\n"), "line 1: '0': expected the size of a pixel"));
  CHECK(contains(error("2\n0\n0\n1e7\n1\n2\n"), "line 4: '1e7': expected the size of a pixel"));
  CHECK(contains(error("2\n0\n0\n-3\n1\n2e15\n"), "line 6: '2e15': expected a place within 1e15 m"));
  CHECK(contains(error("nan\n0\n0\n-3\n1\n2\n"), "line 1: 'nan': expected a number"));
  CHECK(contains(error(""), "is empty"));
  CHECK(contains(support::file_error([] { (void)read_world_file(folder / "none.pgw"); }).what(), "does not exist"));
}

TEST_CASE("a world file is found beside its picture by each of its names") {
  const support::TemporaryFolder place;
  CHECK(world_file_of(place / "dem.png").empty());
  CHECK(world_file_of(place / "dem").empty());
  for (const char* name : {"dem.wld", "dem.pngw", "dem.pgw"}) {
    std::ofstream(place / name) << "1\n";
    CHECK(world_file_of(place / "dem.png") == place / name);
  }
  std::ofstream(place / "UP.PGW") << "1\n";
  CHECK(world_file_of(place / "UP.PNG") == place / "UP.PGW");
}

TEST_CASE("other files beside a raster have its name") {
  const auto files = side_files_of("a/dem.tif");
  CHECK(std::vector<std::filesystem::path>(files.begin(), files.end()) ==
        std::vector<std::filesystem::path>{"a/dem.tif.aux.xml", "a/dem.prj", "a/dem.PRJ", "a/dem.tif.msk"});
}

TEST_CASE("a spoilt world file is refused with its place, or gives a placement that a raster takes") {
  support::Generator random(8531);
  std::size_t refused = 0, read_all = 0;
  for (int time = 0; time < 400; ++time) {
    const std::string text = support::spoilt("0.5\n0\n0\n-0.5\n4650000.25\n5400000.75\n", 1 + random.whole(3),
                                             std::array{"nan", "1e999", "\n", "-", "0x1"}, random);
    INFO("seed 8531, ", text);
    try {
      const WorldFile world = read(text);
      CHECK((world.step.x >= 1e-9 && world.step.x <= 1e6 && std::fabs(world.first.x) <= 1e15 &&
             std::fabs(world.first.y) <= 1e15));
      ++read_all;
    } catch (const FileError& e) {
      CHECK(e.path() == (folder / "dem.pgw").string());
      ++refused;
    }
  }
  CHECK(refused > 100);
  CHECK(read_all > 20);
}
