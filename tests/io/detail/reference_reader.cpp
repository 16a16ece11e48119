// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/reference_reader.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/reference_database.hpp"
#include "support/relative.hpp"
#include "support/spoilt_text.hpp"

namespace pulsecast::io {
namespace {

using detail::GeoKeys;
using detail::HeightUnit;

constexpr double foot = 0.3048, us_foot = 1200.0 / 3937;
const std::string geographic = R"(GEOGCS["NAD83",DATUM["D",SPHEROID["S",6378137,298]],UNIT["Degree",0.0174532925]])";
std::string projected(const std::string& unit) {
  return "PROJCS[\"a [b], (c) UNIT[\"\"x\"\",3]\"," + geographic + ",PROJECTION[\"L\"],PARAMETER[\"k\",0.9996]," +
         unit + R"(,AXIS["Easting",EAST],AUTHORITY["EPSG","2263"]])";
}
const std::string in_metres = projected(R"(UNIT["metre", 1])");
const std::string in_feet = projected("\n  UNIT[\"Foot_US\",0.3048006096012192,\n    AUTHORITY[\"EPSG\",\"9003\"]]");
const std::string up = R"(VERT_CS["z",VERT_DATUM["z",2005],UNIT["metre",1],AXIS["Up",UP]])";
const std::string wkt2 =
    R"(PROJCRS["x",BASEGEOGCRS["y",ELLIPSOID["e",6378137,298,LENGTHUNIT["metre",1]],ANGLEUNIT["degree",0.017]],)"
    R"(CONVERSION["c",PARAMETER["False easting",0,LENGTHUNIT["metre",1]]],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],)"
    R"(LENGTHUNIT["foot",0.3048],USAGE[SCOPE["s"],VERTICALEXTENT[-9,0,LENGTHUNIT["metre",1]]],ID["EPSG",2222]])";
const std::string of_axes =
    R"(PROJCRS["x",BASEGEOGCRS["y"],CONVERSION["c"],CS[Cartesian,2],AXIS["e",east,LENGTHUNIT["foot",0.3048]],)"
    R"(AXIS["n",north,LENGTHUNIT["foot",0.3048]]])";

struct Found {
  SpatialReference reference{};
  std::vector<std::string> warnings{};
};

Found by_text(const std::string& text, HeightUnit otherwise = HeightUnit::metre) {
  Found made;
  made.reference = detail::ReferenceReader("a.prj", otherwise, made.warnings).by_text(text);
  return made;
}

/// Keys of the record: each as its number, and its value or its place and index.
struct Keys {
  std::vector<std::array<std::uint16_t, 4>> keys{};
  std::vector<double> numbers{};
  std::string texts{};
};

Found by_keys(const Keys& in, HeightUnit otherwise = HeightUnit::metre) {
  std::vector<std::uint16_t> directory{1, 1, 0, static_cast<std::uint16_t>(in.keys.size())};
  for (const auto& key : in.keys) directory.insert(directory.end(), key.begin(), key.end());
  Found made;
  made.reference =
      detail::ReferenceReader("a.tif", otherwise, made.warnings).by_keys({directory, in.numbers, in.texts});
  return made;
}

std::string refusal(const auto& read) {
  try {
    (void)read();
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST_CASE("well-known text tells the units of coordinates and heights, in each of its forms") {
  const support::WithDatabase none(nullptr);
  struct Case {
    std::string wkt;
    double unit, vertical;
    bool has_heights = true;
  };
  for (const Case& c :
       {Case{in_feet, us_foot, 1, false},
        {"COMPD_CS[\"c\"," + in_feet + "," + up + "]", us_foot, 1},
        {in_feet + R"(,VERTCS["v",VDATUM["v"],PARAMETER["Direction",1.0],UNIT["Foot_US",0.25]])", us_foot, 0.25},
        {wkt2, foot, 1, false},
        {of_axes, foot, 1, false},
        {"COMPOUNDCRS[\"c\"," + wkt2 +
             R"(,VERTCRS["v",CS[vertical,1],AXIS["up",up],LENGTHUNIT["ft",0.5]],ID["EPSG",1]])",
         foot, 0.5},
        {"COMPOUNDCRS[\"c\"," + wkt2 + R"(,VERTCRS["v",CS[vertical,1],AXIS["up",up,LENGTHUNIT["ft",0.5]]]])", foot,
         0.5},
        {"BOUNDCRS[SOURCECRS[" + wkt2 + "],TARGETCRS[" + geographic + "],ABRIDGEDTRANSFORMATION[\"t\"]]", foot, 1,
         false},
        {R"(LOCAL_CS["site",UNIT["millimetre",0.001]])", 0.001, 1, false},
        {R"(ENGCRS["site",CS[Cartesian,2],LENGTHUNIT["foot",0.3048]])", foot, 1, false},
        {"\xEF\xBB\xBF  \n" + in_metres + "\r\n", 1, 1}}) {
    CAPTURE(c.wkt);
    const Found found = by_text(c.wkt), points = by_text(c.wkt, HeightUnit::of_coordinates);
    CHECK(found.reference.unit == support::relative(c.unit, 1e-12));
    CHECK(found.reference.vertical_unit == c.vertical);
    CHECK(points.reference.vertical_unit == (c.has_heights ? c.vertical : found.reference.unit));
    CHECK(found.warnings.size() == (c.has_heights ? 0 : 1));
    CHECK(points.warnings.size() == found.warnings.size());
    CHECK(by_text(c.wkt, HeightUnit::by_setting).warnings.empty());
    CHECK(c.wkt.find(found.reference.wkt) != std::string::npos);
    CHECK(found.reference.wkt.ends_with(']'));
  }
}

TEST_CASE("texts that are none, incomplete or of an odd unit are refused or noted") {
  for (const char* text : {"Projection UTM\nUnits METERS\n", "EPSG:25832", "]]]", "UNIT"})
    CHECK(by_text(text).warnings == std::vector<std::string>{"a.prj: has the reference system 'no well-known text': "
                                                             "metres are assumed"});
  for (const std::string& text : {std::string("PROJCS["), in_feet.substr(0, in_feet.size() - 1),
                                  std::string("UNIT[\"m\","), std::string("PROJCS[\"x]]")})
    CHECK(refusal([&] { return by_text(text); }).find("expected a complete well-known text") != std::string::npos);
  for (const char* unit : {"1e9", "0", "-1", "nan", "x", ""})
    CHECK(refusal([&] { return by_text(projected("UNIT[\"m\"," + std::string(unit) + "]")); })
              .find("has the reference "
                    "system 'unit of") != std::string::npos);
  CHECK(refusal([&] { return by_text("FOO[\"x\"]"); }).find("'WKT FOO', which is unknown") != std::string::npos);
  std::string deep = in_feet;
  for (int i = 0; i < 100000; ++i) deep = "COMPD_CS[" + std::move(deep) + "]";
  CHECK(refusal([&] { return by_text(deep); }).find("'WKT COMPD_CS', which is unknown") != std::string::npos);
}

TEST_CASE("keys tell units by code, size, name and system") {
  const support::WithDatabase none(nullptr);
  struct Case {
    Keys keys;
    double unit, vertical = 0;  // 0: not told
    std::size_t notes = 0;
  };
  const auto named = [](std::uint16_t system, const std::string& name, std::uint16_t vertical = 0) {
    Keys made{{{1026, 34737, 5, 0}, {3072, 0, 1, system}}, {}, name};
    if (vertical != 0) made.keys.push_back({4096, 0, 1, vertical});
    return made;
  };
  for (const Case& c : {Case{{}, 1},
                        {{{{1024, 0, 1, 1}, {3072, 0, 1, 25832}}}, 1},
                        {{{{3072, 34736, 1, 2263}}}, 1},
                        {{{{3076, 0, 1, 9003}, {4099, 0, 1, 9002}}}, us_foot, foot},
                        {{{{3076, 0, 1, 9036}}}, 1000, 0, 1},
                        {{{{3076, 0, 1, 32767}, {3077, 34736, 1, 1}}, {7, 0.5}}, 0.5, 0, 1},
                        {{{{3077, 34736, 1, 0}}, {0.25}}, 0.25, 0, 1},
                        {{{{3072, 0, 1, 32767}}}, 1, 0, 1},
                        {{{{3072, 0, 1, 2263}}}, 1, 0, 1},
                        {{{{3072, 0, 1, 26741}}}, 1, 0, 1},
                        {{{{3072, 0, 1, 7407}}}, 1, 0, 1},
                        {{{{4096, 0, 1, 6360}}}, 1, 0, 1},
                        {{{{4096, 0, 1, 5103}}}, 1, 0, 1},
                        {{{{4096, 0, 1, 32767}}}, 1, 0, 1},
                        {{{{4096, 0, 1, 7837}}}, 1, 1},
                        {{{{4096, 0, 1, 5103}, {4099, 0, 1, 9003}}}, 1, us_foot},
                        {{{{4096, 0, 1, 6360}, {4097, 34737, 22, 2}}, {}, "x|NAVD88 height (ftUS)|"}, 1, us_foot},
                        {named(2263, "NAD83 / New York (ftUS) + NAVD88 height|", 5703), us_foot, 1},
                        {named(2222, "NAD83 / Arizona (ft) + NAVD88 height (ftUS)|", 6360), foot, us_foot},
                        {named(25832, "ETRS89 / UTM zone 32N + NAVD88 height (ftUS)|", 6360), 1, us_foot},
                        {named(2154, "RGF93 v1 / Lambert-93 + NGF-IGN69 height|", 5720), 1, 1},
                        {named(25832, "ETRS89 / UTM zone 32N + Poolbeg height (ft(Br36))|", 5754), 1, 0, 1},
                        {named(26741, "NAD27 / California zone I + NAVD88 height|", 5703), 1, 1, 1},
                        {named(26820, "NAD83 / Minnesota Central (ftUS)|"), 1, 0, 1},
                        {{{{3072, 0, 1, 32767}, {3073, 34737, 9, 0}}, {}, "site (ftUS)|"}, us_foot, 0, 1}}) {
    CAPTURE(c.keys.texts);
    CAPTURE(c.unit);
    CAPTURE(c.vertical);
    const Found found = by_keys(c.keys), points = by_keys(c.keys, HeightUnit::of_coordinates);
    CHECK(found.reference.unit == c.unit);
    CHECK(found.reference.vertical_unit == (c.vertical == 0 ? 1 : c.vertical));
    CHECK(points.reference.vertical_unit == (c.vertical == 0 ? c.unit : c.vertical));
    CHECK(found.warnings.size() == c.notes);
    CHECK(points.warnings.size() == c.notes);
  }
  const Found compound = by_keys({{{3072, 0, 1, 25832}, {4096, 0, 1, 7837}}});
  CHECK(compound.reference == SpatialReference{.epsg = 25832, .vertical_epsg = 7837});
}

TEST_CASE("a database tells the units of codes that stand alone") {
  const support::WithDatabase feet([](const SpatialReference& of, const std::string&) {
    if (of.epsg == 2222) throw FileError("EPSG:2222", "", "is unknown");
    const bool has_heights = of.vertical_epsg != 0 || of.epsg == 7407;
    return SpatialReference{.epsg = of.epsg,
                            .vertical_epsg = std::uint16_t{has_heights},
                            .unit = 0.25,
                            .vertical_unit = has_heights ? 0.5 : 1};
  });
  for (const std::vector<std::array<std::uint16_t, 4>>& keys :
       {std::vector<std::array<std::uint16_t, 4>>{{3072, 0, 1, 7407}}, {{3072, 0, 1, 2263}, {4096, 0, 1, 6360}}}) {
    const Found found = by_keys({keys});
    CHECK(found.reference.unit == 0.25);
    CHECK(found.reference.vertical_unit == 0.5);
    CHECK(found.warnings.empty());
  }
  CHECK(by_keys({{{3072, 0, 1, 2263}}}, HeightUnit::of_coordinates).reference.vertical_unit == 0.25);
  const Found heights = by_keys({{{4096, 0, 1, 6360}}});
  CHECK(heights.reference == SpatialReference{.vertical_epsg = 6360, .unit = 1, .vertical_unit = 0.5});
  CHECK(by_keys({{{3072, 0, 1, 2263}, {3076, 0, 1, 9003}, {4099, 0, 1, 9003}}}).reference.unit == us_foot);
  CHECK(by_keys({{{3072, 0, 1, 25832}}}).reference.unit == 1);
  CHECK(by_keys({{{3072, 0, 1, 2222}}}).warnings.size() == 1);
}

TEST_CASE("each rule of reference systems has one that is read, noted or refused as it says") {
  const support::WithDatabase none(nullptr);
  const auto text = [](const std::string& wkt) { return [wkt] { return by_text(wkt).warnings; }; };
  const auto keyed = [](const Keys& keys, double unit = 1, double vertical = 1) {
    return [=] {
      const Found found = by_keys(keys);
      CHECK(found.reference.unit == unit);
      CHECK(found.reference.vertical_unit == vertical);
      return found.warnings;
    };
  };
  const auto one = [&](std::uint16_t key, std::uint16_t value) { return keyed({{{key, 0, 1, value}}}); };
  test::check_rules(
      detail::reference_rules,
      std::vector<test::FormatCase>{
          {"WKT PROJ*", text(in_metres)},
          {"WKT LOCAL_CS", text(R"(LOCAL_CS["x",UNIT["metre",1]])")},
          {"WKT ENG*", text(R"(ENGCRS["x",CS[Cartesian,2],LENGTHUNIT["metre",1]])")},
          {"WKT VERT*", text("COMPD_CS[\"c\"," + in_feet + "," + up + "]")},
          {"WKT GEO*", text("COMPD_CS[\"c\"," + geographic + "," + up + "]")},
          {"GeoKey 1024 = 1", one(1024, 1)},
          {"GeoKey 1024 = 2", one(2048, 4326)},
          {"GeoKey 1024 = 3", one(1024, 3)},
          {"GeoKey 1024 = *", one(1024, 32767)},
          {"GeoKey 1025", one(1025, 2)},
          {"GeoKey 1026",
           keyed({{{1026, 34737, 9, 0}, {3072, 0, 1, 2263}, {4099, 0, 1, 9001}}, {}, "NY (ftUS)|"}, us_foot)},
          {"GeoKey 20*", keyed({{{2048, 0, 1, 4258}, {2057, 34736, 1, 0}, {3072, 0, 1, 25832}}, {6378137}})},
          {"GeoKey 3072", one(3072, 25832)},
          {"GeoKey 3076", keyed({{{3076, 0, 1, 9002}, {4099, 0, 1, 9001}}}, foot)},
          {"GeoKey 3077", keyed({{{3077, 34736, 1, 0}, {4099, 0, 1, 9001}}, {0.5}}, 0.5)},
          {"GeoKey 30*", keyed({{{3059, 0, 1, 1}, {3075, 0, 1, 8}, {3096, 34736, 1, 0}}})},
          {"GeoKey 4096", one(4096, 7837)},
          {"GeoKey 4097", keyed({{{4096, 0, 1, 6360}, {4097, 34737, 9, 0}}, {}, "NAVD88 height (ft)"}, 1, foot)},
          {"GeoKey 4098", one(4098, 5103)},
          {"GeoKey 4099", keyed({{{4099, 0, 1, 9002}}}, 1, foot)},
          {"GeoKey 5120", keyed({{{5120, 34736, 1, 0}}, {2020}})},
          {"unit of *", one(3076, 9999)},
          {"depths", one(4096, 5715)},
          {"axis to the west", text(R"(PROJCS["x",UNIT["metre",1],AXIS["Y",WEST],AXIS["X",SOUTH]])")},
          {"coordinates without a unit", one(3072, 2263)},
          {"heights without a unit", text(in_feet)},
          {"no well-known text", text("Units METERS")},
          {"text that is cut off", text("PROJCS[\"x\"")}});
}

TEST_CASE("axes to the west are noted once, by a code, a method or the text, with a database or without") {
  const std::string begin = "PROJCS[\"x\"," + geographic + ",PROJECTION[\"", end = R"(,UNIT["metre",1])";
  const auto esri = [&](const std::string& rest) { return by_text(begin + rest + end + "]").warnings; };
  const auto coded = [](std::uint16_t code) { return by_keys({{{3072, 0, 1, code}, {3076, 0, 1, 9001}}}).warnings; };
  const auto unknown = [](const SpatialReference&, const std::string&) -> SpatialReference {
    throw FileError("EPSG", "", "has axes to the west and south");
  };
  for (const support::WithDatabase::Database database : {support::WithDatabase::Database(unknown), {}}) {
    const support::WithDatabase with(database);
    for (const std::uint16_t code :
         std::initializer_list<std::uint16_t>{2046, 2053, 2055, 2065, 2221, 3053, 5513, 8352, 22279, 29385}) {
      CAPTURE(code);
      REQUIRE(coded(code).size() == 1);
      CHECK(coded(code)[0].find("'axis to the west': x is taken as east") != std::string::npos);
    }
    for (const std::uint16_t code : std::initializer_list<std::uint16_t>{2056, 2066, 2222, 5514, 25832, 29386})
      CHECK(coded(code).empty());
  }
  CHECK(by_keys({{{3072, 0, 1, 32767}, {3075, 0, 1, 27}, {3076, 0, 1, 9001}}}).warnings.size() == 1);
  CHECK(by_keys({{{3072, 0, 1, 2053}, {3076, 0, 1, 9001}},
                 {},
                 "ESRI PE String = " + begin + "Transverse_Mercator_South_Orientated\"]" + end + "]|"})
            .warnings.size() == 1);
  CHECK(esri("Transverse_Mercator_South_Orientated\"]").size() == 1);
  CHECK(esri("Krovak\"],PARAMETER[\"XY_Plane_Rotation\",0.0]").size() == 1);
  CHECK(esri("Krovak\"],PARAMETER[\"XY_Plane_Rotation\",90.0]").empty());
  CHECK(by_text(begin + "Transverse_Mercator_South_Orientated\"]" + end + R"(,AXIS["Y",WEST],AXIS["X",SOUTH]])")
            .warnings.size() == 1);
}

TEST_CASE("depths, degrees and units that nobody knows are refused, but for heights that a setting scales") {
  const std::string depths = "heights, not depths", degrees = "expected projected coordinates, not degrees";
  for (const std::string& wkt : {in_metres + R"(,VERTCS["v",VDATUM["v"],PARAMETER["Direction",-1.0],UNIT["m",1]])",
                                 "COMPD_CS[\"c\"," + in_metres + R"(,VERT_CS["v",UNIT["m",1],AXIS["Depth", DOWN]]])"}) {
    CHECK(refusal([&] { return by_text(wkt); }).find(depths) != std::string::npos);
    CHECK(by_text(wkt, HeightUnit::by_setting).warnings.empty());
  }
  const Keys named{{{1026, 34737, 9, 0}, {4096, 0, 1, 32767}}, {}, "x + MSL depth|"};
  for (const Keys& keys : {Keys{{{4096, 0, 1, 5715}, {4099, 0, 1, 9001}}}, named}) {
    CHECK(refusal([&] { return by_keys(keys); }).find(depths) != std::string::npos);
    CHECK(by_keys(keys, HeightUnit::by_setting).warnings.empty());
  }
  for (const std::string& wkt : {geographic, std::string("Projection GEOGRAPHIC\nUnits DD\n"),
                                 std::string(R"(GEOCCS["c",UNIT["metre",1]])"), std::string(R"(GEODCRS["c"])")})
    CHECK(refusal([&] { return by_text(wkt); }).find(degrees) != std::string::npos);
  CHECK(refusal([&] { return by_keys({{{1024, 0, 1, 2}}}); }).find(degrees) != std::string::npos);
  CHECK(refusal([&] { return by_keys({{{2048, 0, 1, 4326}}}); }).find(degrees) != std::string::npos);
  for (const double size : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e7})
    CHECK(refusal([&] { return by_keys({{{3076, 0, 1, 32767}, {3077, 34736, 1, 0}}, {size}}); }) != "");
  CHECK(refusal([&] { return by_keys({{{3076, 0, 1, 32767}, {3077, 34736, 1, 9}}}); }) != "");
  CHECK(refusal([&] { return by_keys({{{4099, 0, 1, 9999}}}); }) != "");
  CHECK(by_keys({{{4099, 0, 1, 9999}}}, HeightUnit::by_setting).warnings.empty());
  for (const int key : {1023, 1027, 2100, 3100, 4095, 4100, 5000, 5121, 32767})
    CHECK(refusal([&] {
            return by_keys({{{static_cast<std::uint16_t>(key), 0, 1, 1}}});
          }).find("which is unknown") != std::string::npos);
  CHECK(by_keys({{{0, 0, 0, 0}, {32768, 0, 1, 1}, {65535, 0, 1, 1}}}).warnings.empty());  // padding; private keys
}

TEST_CASE("well-known text of Esri in the keys names the system") {
  const Found found = by_keys({{{3072, 0, 1, 32767}, {3073, 34737, 9, 0}}, {}, "ESRI PE String = " + in_feet + "|x|"});
  CHECK(found.reference.unit == support::relative(us_foot, 1e-12));
  CHECK(found.reference.wkt == in_feet);
  CHECK(by_keys({{{3072, 0, 1, 25832}}, {}, "ESRI PE String = "}).warnings.size() == 1);
}

TEST_CASE("spoilt texts and keys are refused, or give units that readers take") {
  const support::WithDatabase none(nullptr);
  support::Generator random(3802);
  int refused = 0, accepted = 0;
  const auto try_one = [&](const auto& read) {
    try {
      const Found found = read();
      for (const double unit : {found.reference.unit, found.reference.vertical_unit})
        CHECK((unit >= 1e-6 && unit <= 1e6));
      ++accepted;
    } catch (const FileError&) {
      ++refused;
    }
  };
  for (int time = 0; time < 1000; ++time) {
    const std::string text = support::spoilt("COMPD_CS[\"c\"," + in_feet + "," + up + "]", 1 + random.whole(3),
                                             std::array{"UNIT[", "\"", "nan", "-1", "]", "PROJCS[", "AXIS["}, random);
    INFO("seed 3802, ", text);
    try_one([&] { return by_text(text); });
    Keys keys{{{1026, 34737, 9, 0}, {3072, 0, 1, 2263}, {3077, 34736, 1, 0}, {4096, 0, 1, 6360}}, {0.5}, text};
    for (auto& key : keys.keys)
      if (random.whole(3) == 0) key[random.whole(4)] = static_cast<std::uint16_t>(random.whole(65536));
    try_one([&] { return by_keys(keys, HeightUnit::of_coordinates); });
  }
  CHECK(accepted > 400);
  CHECK(refused > 400);
  for (const char c : {'"', '[', ']', ',', ' ', 'A'}) try_one([&] { return by_text(std::string(3000000, c)); });
  try_one([&] { return by_text("GEOGCS[" + std::string(9000000, ' ')); });
}

}  // namespace
}  // namespace pulsecast::io
