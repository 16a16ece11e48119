// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/las/points.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/las_builder.hpp"
#include "support/las_reader.hpp"
#include "support/laz_builder.hpp"
#include "support/reference_database.hpp"
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
      const bool has_waveforms = format == 4 || format == 5 || format >= 9;
      CHECK(found.warnings.size() == (has_waveforms ? 1 : 0));
      CHECK(found.colours.size() == (has_colours(format) ? las.points.size() : 0));
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < las.points.size(); ++i) {
        const auto& stored = las.points[i].stored;
        const auto& colour = las.points[i].colour;
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
  for (const Case& c : {Case{1, 0}, {2, 3}, {4, 3}, {4, 6}, {4, 8}}) {
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

std::string keys_of(const std::vector<std::array<unsigned, 2>>& keys) {
  std::string body(8 + 8 * keys.size(), '\0');
  LasBuilder::put(body, 0, 1, 2);
  LasBuilder::put(body, 6, keys.size(), 2);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    LasBuilder::put(body, 8 + 8 * i, keys[i][0], 2);
    LasBuilder::put(body, 12 + 8 * i, 1, 2);
    LasBuilder::put(body, 14 + 8 * i, keys[i][1], 2);
  }
  return body;
}

/// A point at (1, 1, 1) units, with records.
LasBuilder at_one(std::vector<LasBuilder::Record> records) {
  return {.minor = 4, .format = 6, .points = {{.stored = {100, 100, 100}}}, .more = std::move(records)};
}

std::string with_keys(const std::vector<std::array<unsigned, 2>>& keys) {
  return at_one({{"LASF_Projection", 34735, keys_of(keys)}}).bytes();
}

std::string with_wkt(const std::string& text) { return at_one({{"LASF_Projection", 2112, text}}).bytes(); }

const std::string degrees = R"(GEOGCS["WGS 84",DATUM["D",SPHEROID["S",6378137,298.25]],UNIT["degree",0.01745329]])";
std::string projected(const std::string& unit) {
  return R"(PROJCS["a [b] c",)" + degrees + R"(,PROJECTION["Transverse_Mercator"],PARAMETER["scale_factor",0.9996],)" +
         unit + R"(,AXIS["Easting",EAST],AUTHORITY["EPSG","2263"]])";
}
const std::string projected_by_crs =
    R"(PROJCRS["x",BASEGEOGCRS["y",DATUM["z",ELLIPSOID["e",1,2,LENGTHUNIT["metre",1]]]],CONVERSION["c",)"
    R"(PARAMETER["False easting",0,LENGTHUNIT["metre",1]]],CS[Cartesian,2],AXIS["e",east,)"
    R"(LENGTHUNIT["foot",0.3048]],AXIS["n",north,LENGTHUNIT["foot",0.3048]],ANGLEUNIT["degree",0.017]])";

TEST_CASE("coordinates in feet become metres, by text or keys, horizontal and vertical apart") {
  const double foot = 0.3048, us_foot = 1200.0 / 3937.0;
  struct Case {
    std::string bytes;
    Vec3 place;
    std::size_t notes;
  };
  const std::string us = R"(UNIT["US survey foot",0.3048006096012192,AUTHORITY["EPSG","9003"]])";
  const std::string heights = R"(VERT_CS["NAVD88",VERT_DATUM["d",2005],UNIT["metre",1],AXIS["Up",UP]])";
  const support::WithDatabase none(nullptr);
  std::string keys = keys_of({{1024, 1}, {3072, 2263}, {1026, 0}, {4099, 32767}, {4096, 8228}});
  LasBuilder::put(keys, 8 + 16 + 2, 34737, 2);
  const LasBuilder named = at_one({{"LASF_Projection", 34735, keys},
                                   {"LASF_Projection", 34736, "12345678"},
                                   {"LASF_Projection", 34737, "NAD83 / New York (ftUS) + NAVD88 height (ft)|"}});
  for (const Case& c :
       {Case{with_wkt(projected(R"(UNIT["metre",1])")), {1, 1, 1}, 0},
        {with_wkt(projected(us)), {us_foot, us_foot, us_foot}, 1},
        {with_wkt(R"(COMPD_CS["both",)" + projected(us) + "," + heights + "]"), {us_foot, us_foot, 1}, 0},
        {with_wkt(R"(COMPD_CS["both",)" + projected(R"(UNIT["metre", 1])") +
                  R"(,VERT_CS["h",VERT_DATUM["d",2005],UNIT["foot",0.3048]]])"),
         {1, 1, foot},
         0},
        {with_wkt(projected_by_crs), {foot, foot, foot}, 1},
        {with_wkt(R"(LOCAL_CS["plant",UNIT["millimetre",0.001]])"), {1e-3, 1e-3, 1e-3}, 1},
        {with_keys({{1024, 1}, {3072, 25832}}), {1, 1, 1}, 0},
        {with_keys({{1024, 1}, {3076, 9003}}), {us_foot, us_foot, us_foot}, 1},
        {with_keys({{1024, 1}, {3076, 9001}, {4099, 9002}}), {1, 1, foot}, 0},
        {with_keys({{1024, 1}, {3076, 9002}, {4099, 9001}}), {foot, foot, 1}, 0},
        {with_keys({{1024, 1}, {3072, 2263}}), {1, 1, 1}, 1},
        {with_keys({{1024, 1}, {3072, 25832}, {4096, 6360}}), {1, 1, 1}, 1},
        {named.bytes(), {us_foot, us_foot, foot}, 0}}) {
    const Read found = read(c.bytes);
    CAPTURE(found.positions.at(0).x);
    CAPTURE(found.positions.at(0).z);
    CHECK(length(found.positions.at(0) - c.place) < 1e-12);
    CHECK(found.warnings.size() == c.notes);
  }
  // text before keys, if the header says so, and in extended records, too
  LasBuilder both = at_one({{"LASF_Projection", 34735, keys_of({{1024, 1}, {3076, 9001}})}});
  both.extended = {{"LASF_Projection", 2112, projected(us)}};
  CHECK(read(both.bytes()).positions.at(0).x == 1);
  both.encoding = 16;
  CHECK(length(read(both.bytes()).positions.at(0) - Vec3{us_foot, us_foot, us_foot}) < 1e-12);
}

TEST_CASE("reference systems that are no text are noted, and unknown ones refused") {
  for (const char* text : {"PROJCS", "]]]", "EPSG:25832"}) CHECK(read(with_wkt(text)).warnings.size() == 1);
  for (const char* text : {"[", "PROJCS[", "FOO[\"x\"]", "PROJCS[\"x\",UNIT[\"m\",1e9]]"})
    CHECK_MESSAGE(error(with_wkt(text)).problem() != "no error", text);
  CHECK(read(with_wkt("")).positions.size() == 1);
  CHECK(error(with_wkt(degrees))
            .problem()
            .starts_with("has the reference system 'WKT GEOGCS': expected projected coordinates, not degrees"));
}

TEST_CASE("classes, and objects by the extra bytes ObjectId, are those of the points") {
  for (const unsigned format : {1U, 6U}) {
    LasBuilder las{.minor = 4, .format = format, .extra = 6};
    las.more = {{"LASF_Spec", 4, LasBuilder::descriptor("Amplitude", 3) + LasBuilder::descriptor("ObjectId", 5)}};
    las.points = {{.kind = 5, .extra = std::string("xx\x01\x02\x00\x00", 6)},
                  {.kind = 31, .extra = "xx\xFF\xFF\xFF\xFF"}};
    const TemporaryFolder folder;
    LasPoints points(InputFile(put(folder, las.bytes()), "a point cloud"));
    REQUIRE(points.next());
    CHECK(points.has_class());
    CHECK(points.classification() == 5);
    CHECK(points.has_object());
    CHECK(points.object() == 513);
    REQUIRE(points.next());
    CHECK(points.classification() == 31);
    CHECK(points.object() == 0xFFFFFFFF);
    for (const std::string& other : {LasBuilder::descriptor("ObjectId", 6), LasBuilder::descriptor("ObjectId", 5, 8),
                                     LasBuilder::descriptor("ObjectIds", 5), LasBuilder::descriptor("ObjectId", 23),
                                     LasBuilder::descriptor("x", 10) + LasBuilder::descriptor("ObjectId", 5)}) {
      las.more[0].body = other;
      CHECK_FALSE(LasPoints(InputFile(put(folder, las.bytes()), "a point cloud")).has_object());
    }
  }
}

TEST_CASE("a class of LAS 1.0 has all eight bits") {
  for (const unsigned minor : {0U, 1U}) {
    std::string bytes = LasBuilder{.minor = minor, .format = 1, .points = {{}}}.bytes();
    LasBuilder::put(bytes, 227 + 15, 72, 1);  // key-point of class 8, or class 72
    const TemporaryFolder folder;
    LasPoints points(InputFile(put(folder, bytes), "a point cloud"));
    REQUIRE(points.next());
    CHECK(points.classification() == (minor == 0 ? 72 : 8));
  }
}

TEST_CASE("each item of the table is read, noted or refused as it says") {
  using support::LazBuilder;
  const auto warnings_of = [](const std::string& bytes) { return [bytes] { return read(bytes).warnings; }; };
  const auto point = [](LasBuilder::Point p) {
    return LasBuilder{.minor = 4, .format = 6, .points = {std::move(p), {}}}.bytes();
  };
  /// Checks a file that is read.
  const auto gives = [](const std::string& bytes, const Vec3& place) {
    return [=] {
      const Read found = read(bytes);
      CHECK(length(found.positions.at(0) - place) < 1e-12);
      return std::vector<std::string>{};
    };
  };
  const LasBuilder::Record wkt{"LASF_Projection", 2112, projected(R"(UNIT["foot",0.3048])")};
  const LasBuilder::Record by_liblas{"liblas", 2112, projected(R"(UNIT["foot",0.3048])")};
  const std::string old = LasBuilder{.minor = 2, .format = 1, .points = {{.stored = {100, 100, 100}}}}.bytes();
  const std::string recent = LasBuilder{.minor = 4, .format = 6, .points = {{.stored = {100, 100, 100}}}}.bytes();
  const std::string waves = LasBuilder{.minor = 3, .format = 4, .points = {{.stored = {100, 100, 100}}}}.bytes();
  const Vec3 feet{0.3048, 0.3048, 0.3048}, one{1, 1, 1};
  test::check_rules(
      detail::las_rules,
      std::vector<test::FormatCase>{
          {"withheld points", warnings_of(point({.withheld = true}))},
          {"synthetic points", warnings_of(point({.flags = 1}))},
          {"points of class 7", warnings_of(point({.kind = 7}))},
          {"points of class 18", warnings_of(point({.kind = 18}))},
          {"key-points and overlap", gives(point({.stored = {100, 100, 100}, .flags = 10}), one)},
          {"waveforms", warnings_of(waves)},
          {"extra bytes ObjectId",
           [] {
             LasBuilder las{.minor = 4, .format = 6, .points = {{.extra = "A"}}, .extra = 1};
             las.more = {{"LASF_Spec", 4, LasBuilder::descriptor("ObjectId", 1)}};
             const TemporaryFolder folder;
             LasPoints points(InputFile(put(folder, las.bytes()), "a point cloud"));
             CHECK(points.next());
             CHECK(points.object() == 65);
             return points.warnings();
           }},
          {"other extra bytes ObjectId",
           [&] {
             LasBuilder las{.minor = 4, .format = 6, .points = {{}}, .extra = 4};
             las.more = {{"LASF_Spec", 4, LasBuilder::descriptor("ObjectId", 6)}};
             return read(las.bytes()).warnings;
           }},
          {"two numbers of points",
           [&] {
             std::string bytes = LasBuilder{.minor = 4, .format = 1, .points = {{}, {}}}.bytes();
             LasBuilder::put(bytes, 107, 1, 4);
             const Read found = read(bytes);
             CHECK(found.positions.size() == 2);
             return found.warnings;
           }},
          {"steps below 1e-5", warnings_of(LasBuilder{.scale = {1e-7, 1e-7, 1e-3}, .points = {{}}}.bytes())},
          {"LASF_Projection 2111", warnings_of(at_one({{"LASF_Projection", 2111, "PARAM_MT[\"x\"]"}}).bytes())},
          {"LASF_Projection 2112", gives(at_one({wkt}).bytes(), feet)},
          {"liblas 2112", gives(at_one({by_liblas}).bytes(), feet)},
          {"LASF_Projection 34735", gives(with_keys({{3076, 9002}}), feet)},
          {"LASF_Projection 34736", gives(at_one({{"LASF_Projection", 34736, "12345678"}}).bytes(), one)},
          {"LASF_Projection 34737", gives(at_one({{"LASF_Projection", 34737, "UTM|"}}).bytes(), one)},
          {"lascompatible 22204", warnings_of(at_one({{"lascompatible", 22204, "x"}}).bytes())},
          {"LAZ compressor 1", warnings_of(LazBuilder{.compressor = 1}.bytes(old))},
          {"LAZ compressor 2", gives(LazBuilder{}.bytes(old), one)},
          {"LAZ compressor 3", gives(LazBuilder{}.bytes(recent), one)},
          {"LAZ item of version 1", warnings_of(LazBuilder{.version = 1}.bytes(old))},
          {"LAZ item of version 2", gives(LazBuilder{.version = 2}.bytes(old), one)},
          {"LAZ item of version 3", gives(LazBuilder{.version = 3}.bytes(recent), one)},
          {"LAZ item of version 4", gives(LazBuilder{.version = 4}.bytes(recent), one)},
          {"LAZ wave packet of version 1", warnings_of(LazBuilder{}.bytes(waves))},
      });
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
