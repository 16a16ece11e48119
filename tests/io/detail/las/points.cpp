// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/las/points.hpp>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/file_errors.hpp"
#include "support/generators.hpp"
#include "support/las_builder.hpp"
#include "support/las_reader.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::LasBuilder;
using support::TemporaryFolder;

std::filesystem::path put(const TemporaryFolder& folder, const std::string& bytes) {
  std::filesystem::remove(folder / "a.las");
  std::ofstream(folder / "a.las", std::ios::binary) << bytes;
  return folder / "a.las";
}

struct Read {
  std::vector<Vec3> positions, colours;
  std::vector<std::string> warnings;
};

Read read(const std::string& bytes) {
  const TemporaryFolder folder;
  InputFile file(put(folder, bytes), "a point cloud");
  REQUIRE(LasPoints::is_las(file));
  LasPoints points(std::move(file));
  Read result;
  while (points.next()) {
    result.positions.push_back(points.position());
    if (points.has_colours()) result.colours.push_back(points.colour());
  }
  result.warnings = points.warnings();
  return result;
}

FileError error(const std::string& bytes) {
  return support::file_error([&] { (void)read(bytes); });
}

LasBuilder random_file(support::Generator& random, unsigned minor, unsigned format) {
  LasBuilder las{.minor = minor, .format = format, .scale = {0.001, 0.01, 0.25}, .offset = {477000, 5429000, -3}};
  las.extra = random.whole(3) * 7;
  las.records = random.whole(200);
  for (int i = 0; i < 100; ++i) {
    const auto steps = [&] { return static_cast<std::int32_t>(random.uniform(-0x1p31, 0x1p31)); };
    const auto channel = [&] { return static_cast<std::uint16_t>(random.whole(65536)); };
    las.points.push_back({{steps(), steps(), steps()}, {channel(), channel(), channel()}, false});
  }
  return las;
}

bool has_colours(unsigned format) {
  return format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
}

TEST_CASE("every version and point format is read") {
  constexpr std::uint64_t seed = 3;
  support::Generator random(seed);
  for (unsigned minor = 0; minor <= 4; ++minor)
    for (unsigned format = 0; format <= 10; ++format) {
      if (minor < 4 && format >= 6) continue;  // these came with 1.4
      CAPTURE(seed);
      CAPTURE(minor);
      CAPTURE(format);
      const LasBuilder las = random_file(random, minor, format);
      const Read found = read(las.bytes());
      REQUIRE(found.positions.size() == las.points.size());
      CHECK(found.warnings.empty());
      CHECK(found.colours.size() == (has_colours(format) ? las.points.size() : 0));
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < las.points.size(); ++i) {
        const auto& [stored, colour, withheld] = las.points[i];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          wrong += found.positions[i][static_cast<int>(axis)] != stored[axis] * las.scale[axis] + las.offset[axis];
          if (has_colours(format)) wrong += found.colours[i][static_cast<int>(axis)] != colour[axis];
        }
      }
      CHECK(wrong == 0);
    }
}

TEST_CASE("the builder of these files is good in the eyes of the other reader") {
  const TemporaryFolder folder;
  LasBuilder las{.minor = 4, .format = 6, .points = {{}}};
  std::string bytes = las.bytes();
  LasBuilder::put(bytes, 6, 16, 2);
  const support::LasFile file = support::read_las(put(folder, bytes));
  CHECK(file.points.size() == 1);
}

TEST_CASE("the number of points is the legacy one where 1.4 gives no other") {
  LasBuilder las{.minor = 4, .format = 2, .points = {{}, {}}};
  std::string bytes = las.bytes();
  LasBuilder::put(bytes, 247, 0, 8);
  CHECK(read(bytes).positions.size() == 2);
  LasBuilder::put(bytes, 247, 1, 8);
  CHECK(read(bytes).positions.size() == 1);
}

TEST_CASE("points that are withheld are passed over, with a warning") {
  struct Case {
    unsigned minor, format;
  };
  for (const Case& c : {Case{1, 0}, {2, 3}, {4, 5}, {4, 6}, {4, 10}}) {
    CAPTURE(c.minor);
    CAPTURE(c.format);
    LasBuilder las{.minor = c.minor, .format = c.format};
    las.points = {{.stored = {1, 0, 0}}, {.stored = {2, 0, 0}, .withheld = true}, {.stored = {3, 0, 0}}};
    const Read found = read(las.bytes());
    CHECK(found.positions == std::vector<Vec3>{{0.01, 0, 0}, {0.03, 0, 0}});
    REQUIRE(found.warnings.size() == 1);
    CHECK(found.warnings[0].ends_with("a.las: 1 of 3 points are marked as withheld and left out"));
  }
  CHECK(read(LasBuilder{.minor = 0, .format = 0, .points = {{.withheld = true}}}.bytes()).positions.size() ==
        1);  // a bit of the class
}

TEST_CASE("what follows the points does not count") {
  CHECK(read(LasBuilder{.points = {{}}}.bytes() + std::string(1000, 'x')).positions.size() == 1);
}

TEST_CASE("headers that cannot be right are refused, with the byte") {
  const LasBuilder las{.minor = 2, .format = 3, .points = {{}, {}}};
  const std::string good = las.bytes();
  REQUIRE(read(good).positions.size() == 2);
  struct Case {
    std::size_t at;
    std::uint64_t value;
    std::size_t size;
    const char *place, *problem;
  };
  const std::uint64_t nan = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN());
  for (const Case& c :
       {Case{24, 2, 1, "byte 24", "is LAS 2.2: expected a version from 1.0 to 1.4"},
        {25, 5, 1, "byte 24", "is LAS 1.5: expected a version from 1.0 to 1.4"},
        {25, 4, 1, "byte 94", "the header has 227 bytes: expected at least 375"},
        {94, 100, 2, "byte 94", "the header has 100 bytes: expected at least 227"},
        {96, 100, 4, "byte 96", "the points begin at byte 100: expected one from 227 to the file's size of 295"},
        {96, 4000000000, 4, "byte 96", "the points begin at byte 4000000000"},
        {104, 131, 1, "byte 104", "the points are compressed (LAZ): expected LAS"},
        {104, 11, 1, "byte 104", "has the point format 11: expected one from 0 to 10"},
        {105, 33, 2, "byte 105", "a point has 33 bytes: expected at least the 34 of format 3"},
        {105, 0, 2, "byte 105", "a point has 0 bytes"},
        {107, 0, 4, "byte 107", "holds no point: expected at least one"},
        {107, 3, 4, "byte 107",
         "claims 3 points of 34 bytes from byte 227: expected no more than fit into the file's 295"},
        {107, 0xFFFFFFFF, 4, "byte 107", "claims 4294967295 points"},
        {131, 0, 8, "byte 131", "the scale is 0: expected one above 0"},
        {139, nan, 8, "byte 139", "the scale is nan"},
        {171, nan, 8, "byte 171", "the offset is nan: expected a finite one"}}) {
    CAPTURE(c.at);
    CAPTURE(c.value);
    std::string bad = good;
    LasBuilder::put(bad, c.at, c.value, c.size);
    const FileError e = error(bad);
    CHECK(e.place() == c.place);
    CHECK_MESSAGE(e.problem().starts_with(c.problem), e.problem());
    CHECK(e.path().ends_with("a.las"));
  }
  std::string many = LasBuilder{.minor = 4, .format = 6, .points = {{}}}.bytes();
  LasBuilder::put(many, 247, 1000000000000, 8);
  CHECK(error(many).place() == "byte 247");
}

TEST_CASE("a file that ends anywhere is refused") {
  const std::string good = LasBuilder{.minor = 4, .format = 7, .points = {{}, {}}}.bytes();
  for (std::size_t size = 4; size < good.size(); ++size) {
    CAPTURE(size);
    CHECK(error(good.substr(0, size)).problem() != "no error");
  }
  CHECK(error("LASF").place() == "byte 4");
  CHECK(error("LASF").problem() == "the file ends: expected the 227 bytes of a LAS header");
}

TEST_CASE("points out of all reach are refused, with the byte") {
  LasBuilder las{.minor = 2, .format = 0, .scale = {1e4, 1, 1}, .points = {{}, {.stored = {2000000000, 0, 0}}}};
  const FileError e = error(las.bytes());
  CHECK(e.place() == "byte 247");
  CHECK(e.problem() == "has a point beyond 1e12 m: expected coordinates up to 1e12 m");
}

TEST_CASE("what begins otherwise is no LAS") {
  const TemporaryFolder folder;
  for (const char* text : {"L", "LAS", "LAZF", "1 2 3\n"}) {
    InputFile file(put(folder, text), "a point cloud");
    CHECK_FALSE(LasPoints::is_las(file));
    CHECK(file.take(100) == text);
  }
}

}  // namespace
}  // namespace pulsecast::io
