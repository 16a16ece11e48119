// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/reference.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <proj.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/io/detail/reference_reader.hpp>
#include <pulsecast/io/las.hpp>

#include "support/las_reader.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

constexpr double us_foot = 1200.0 / 3937;  // source: NBS, Federal Register 24, 5348 (1959)

/// Message of the refusal; empty without one.
std::string refusal(const SpatialReference& given, const std::string& name = {}) {
  try {
    (void)complete_reference(given, name);
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

/// True if PROJ takes a well-known text for the system of a definition, axes aside.
bool is_same(const std::string& wkt, const std::string& definition) {
  PJ_CONTEXT* context = proj_context_create();
  PJ *one = proj_create(context, wkt.c_str()), *other = proj_create(context, definition.c_str());
  const bool same = one != nullptr && other != nullptr &&
                    proj_is_equivalent_to_with_ctx(context, one, other, PJ_COMP_EQUIVALENT) != 0;
  proj_destroy(one);
  proj_destroy(other);
  proj_context_destroy(context);
  return same;
}

TEST_CASE("a code gives the text of its system, its units and its codes") {
  for (const int code : {2056, 28992, 2154, 27700, 2263, 25832, 32733, 5514}) {
    CAPTURE(code);
    const SpatialReference found = complete_reference({.epsg = static_cast<std::uint16_t>(code)});
    CHECK(found.epsg == code);
    CHECK(found.vertical_epsg == 0);
    CHECK(std::fabs(found.unit / (code == 2263 ? us_foot : 1) - 1) < 1e-12);
    CHECK(found.vertical_unit == 1);
    CHECK(found.wkt.starts_with("PROJCS["));
    CHECK(found.wkt.find('\n') == found.wkt.npos);
    CHECK(is_same(found.wkt, "EPSG:" + std::to_string(code)));
    CHECK(complete_reference({.wkt = found.wkt}) == found);
  }
}

TEST_CASE("a vertical system makes the text a compound one, with its unit") {
  const SpatialReference german = complete_reference({.epsg = 25832, .vertical_epsg = 7837});
  CHECK((german.epsg == 25832 && german.vertical_epsg == 7837 && german.unit == 1 && german.vertical_unit == 1));
  CHECK(german.wkt.starts_with("COMPD_CS["));
  CHECK(contains(german.wkt, "VERT_DATUM[\"Deutsches Haupthoehennetz 2016\",2005"));
  CHECK(is_same(german.wkt, "EPSG:25832+7837"));
  const SpatialReference feet = complete_reference({.epsg = 2263, .vertical_epsg = 6360});
  CHECK(std::fabs(feet.vertical_unit / us_foot - 1) < 1e-12);
  CHECK(complete_reference({.epsg = 2263, .vertical_epsg = 5703}).vertical_unit == 1);
  const SpatialReference compound = complete_reference({.epsg = 7415});  // Amersfoort / RD New + NAP height
  CHECK((compound.epsg == 28992 && compound.vertical_epsg == 5709));
  CHECK(is_same(compound.wkt, "EPSG:7415"));
}

TEST_CASE("a text in other words is written as WKT 1") {
  PJ_CONTEXT* context = proj_context_create();
  PJ* system = proj_create(context, "EPSG:2154");
  for (const PJ_WKT_TYPE type : {PJ_WKT2_2019, PJ_WKT1_ESRI}) {
    const SpatialReference found = complete_reference({.wkt = proj_as_wkt(context, system, type, nullptr)});
    CHECK(found.wkt.starts_with("PROJCS["));
    CHECK(found.unit == 1);
    if (type == PJ_WKT2_2019) CHECK((found.epsg == 2154 && is_same(found.wkt, "EPSG:2154")));
  }
  proj_destroy(system);
  proj_context_destroy(context);
}

TEST_CASE("systems that points cannot be in are refused by name") {
  CHECK(contains(refusal({.epsg = 4326}), "EPSG:4326: is in degrees"));
  CHECK(contains(refusal({.epsg = 4937}), "is in degrees"));
  CHECK(contains(refusal({.epsg = 4978}), "is not a projected reference system"));
  CHECK(contains(refusal({.epsg = 5783}), "is not a projected reference system"));
  CHECK(contains(refusal({.epsg = 2065}), "has axes to the south and west"));
  CHECK(contains(refusal({.epsg = 2053}), "has axes to the west and south"));
  CHECK(contains(refusal({.epsg = 9999}), "EPSG:9999: is unknown to PROJ"));
  CHECK(contains(refusal({.epsg = 25832, .vertical_epsg = 4326}), "EPSG:25832+4326: is unknown to PROJ"));
  CHECK(contains(refusal({.epsg = 25832, .vertical_epsg = 5715}), "has depths"));
  CHECK(contains(refusal({.wkt = "PROJCS[]"}, "site.wkt"), "site.wkt: is not understood by PROJ"));
  CHECK(contains(refusal({.wkt = "PROJCS[]"}), "the well-known text: is not understood"));
  CHECK(contains(refusal({}), "EPSG:0: is unknown"));
}

TEST_CASE("damaged texts are refused, or read") {
  const std::string sound = complete_reference({.epsg = 25832, .vertical_epsg = 7837}).wkt;
  std::vector<std::string> texts{std::string(100'000, '['),   "+proj=", "EPSG:", "{", "\0x",
                                 "urn:ogc:def:crs,crs:EPSG::"};
  for (std::size_t i = 0; i < 60; ++i) {
    std::string text = sound.substr(0, sound.size() * i / 60);
    texts.push_back(text);
    text = sound;
    text[sound.size() * i / 60] = "[],\"0\xFF"[i % 6];
    texts.push_back(text);
  }
  for (const std::string& text : texts) {
    CAPTURE(text);
    const std::string problem = refusal({.wkt = text.empty() ? "x" : text});
    if (!problem.empty()) CHECK(contains(problem, "expected"));
  }
}

TEST_CASE("every code of the database is known, or refused; its text gives itself again") {
  PJ_CONTEXT* context = proj_context_create();
  char** codes = proj_get_codes_from_database(context, "EPSG", PJ_TYPE_PROJECTED_CRS, 0);
  std::size_t known = 0, refused = 0, number = 0;
  for (char** code = codes; code != nullptr && *code != nullptr; ++code) {
    const int epsg = std::atoi(*code);
    if (epsg > 32766 || ++number % 41 != 0) continue;  // some hundred of five thousand
    CAPTURE(epsg);
    const SpatialReference given{.epsg = static_cast<std::uint16_t>(epsg)};
    const std::string problem = refusal(given);
    ++(problem.empty() ? known : refused);
    if (problem.empty()) {
      const SpatialReference found = complete_reference(given);
      CHECK(found.epsg == epsg);
      const SpatialReference again = complete_reference({.wkt = found.wkt});  // with axes, where they were left out
      CHECK((again.epsg == epsg && again.unit == found.unit));
      CHECK(complete_reference({.wkt = again.wkt}) == again);
      found.validate();
    } else {
      CHECK((contains(problem, "expected") && contains(problem, *code)));
    }
  }
  proj_string_list_destroy(codes);
  proj_context_destroy(context);
  CHECK(known > 50);
  CHECK(refused < known / 10);
}

/// Place in units of a system.
struct Control {
  std::uint16_t epsg;
  double latitude, longitude;
  Vec2 place;
  double unit = 1;
};

TEST_CASE("published control points are where they should be") {
  // sources: EPSG Guidance Note 7-2 (2019), examples of the methods; swisstopo, Formulas for the Swiss map projection
  const std::vector<Control> controls{
      {27700, 50.5, 0.5, {577274.99, 69740.50}},                                           // Transverse Mercator
      {28992, 53, 6, {196105.283, 557057.739}},                                            // Oblique Stereographic
      {32040, 28.5, -96, {2963503.91, 254759.80}, us_foot},                                // Lambert Conic, 2SP
      {2056, 46 + 57 / 60.0 + 8.66 / 3600, 7 + 26 / 60.0 + 22.5 / 3600, {2.6e6, 1.2e6}}};  // its origin
  for (const Control& c : controls) {
    CAPTURE(c.epsg);
    const Vec2 place = map_projector(0, c.epsg)(c.longitude, c.latitude).place;
    CHECK(length(place - c.place * c.unit) < 0.011);  // printed to the centimetre
  }
}

TEST_CASE("east comes first, whatever the order of the system's axes, and true north turns to the meridian") {
  const MapProjector utm = map_projector(4258, 25832);
  CHECK(length(utm(9, 0).place - Vec2{500'000, 0}) < 1e-6);
  CHECK(std::fabs(utm(9, 50).convergence) < 1e-9);
  // source: Snyder 1987, Map Projections, p. 61: on a sphere tan(convergence) = tan(longitude) sin(latitude)
  for (const double aside : {-2.0, 1.0, 2.5})
    CHECK(std::fabs(utm(9 + aside, 50).convergence + std::atan(std::tan(radians(aside)) * std::sin(radians(50)))) <
          2e-6);
  const MapPoint northing_first = map_projector(0, 2193)(173, -41);
  CHECK(std::fabs(northing_first.place.x - 1'600'000) < 1e-6);
  CHECK(northing_first.place.y > 5'000'000);
}

/// Message of the refusal of a place.
std::string place_refusal(std::uint16_t from, std::uint16_t to, double longitude, double latitude) {
  try {
    (void)map_projector(from, to)(longitude, latitude);
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST_CASE("operations that err by more than 0.1 m, or whose grid is missing, are refused with a way out") {
  const std::string one_metre = place_refusal(4326, 25832, 9, 50);
  CHECK(contains(one_metre, "EPSG:4326: cannot be projected to ETRS89 / UTM zone 32N to 0.1 m"));
  CHECK(contains(one_metre, "expected latitude and longitude in EPSG:4258 (ETRS89)"));
  CHECK(contains(one_metre, "errs by 1 m"));
  const std::string no_grid = place_refusal(4258, 28992, 5, 52);  // to 0.001 m by the grid, to 0.25 m without
  if (!no_grid.empty()) CHECK(contains(no_grid, "PROJ finds no grid nl_nsgi_rdtrans2018"));
  CHECK(contains(place_refusal(4937, 25832, 9, 50), "has heights"));
  CHECK(contains(place_refusal(25832, 25832, 9, 50), "is not in degrees"));
  CHECK(contains(place_refusal(4258, 4258, 9, 50), "is in degrees"));
  CHECK(contains(place_refusal(9999, 25832, 9, 50), "is unknown"));
  CHECK(contains(place_refusal(4258, 25832, -60, 50), "outside the area of"));
  CHECK(contains(place_refusal(4258, 25832, 50, 9), "outside the area of"));  // swapped
  CHECK(contains(place_refusal(4258, 25832, 9, 91), "has no place at"));
  CHECK(contains(place_refusal(4258, 25832, std::nan(""), 50), "has no place at"));
  CHECK(place_refusal(4258, 25832, 13.8, 50).empty());  // Bavaria, in a zone that ends at 12 degrees
  CHECK(place_refusal(0, 3832, -170, 20).empty());      // across the date line
}

TEST_CASE("readers ask PROJ for the units of codes that stand alone") {
  const auto read = [](std::uint16_t epsg, std::uint16_t vertical) {
    const std::array<std::uint16_t, 12> keys{1, 1, 0, 2, 3072, 0, 1, epsg, 4096, 0, 1, vertical};
    std::vector<std::string> warnings;
    return detail::ReferenceReader("a.las", detail::HeightUnit::metre, warnings).by_keys({keys, {}, {}});
  };
  const SpatialReference found = read(2263, 6360), indian = read(24370, 5773);
  CHECK(std::fabs(found.unit / us_foot - 1) < 1e-12);
  CHECK(std::fabs(found.vertical_unit / us_foot - 1) < 1e-12);
  CHECK(std::fabs(indian.unit - 0.914398530744441) < 1e-12);
  CHECK(indian.vertical_unit == 1);
}

TEST_CASE("the systems that readers take for ones in metres are so by PROJ, and those of depths go down") {
  const detail::Proj proj("EPSG");
  const auto axis_of = [&](int code, int index) {
    const detail::ProjObject system(
        proj_create_from_database(proj, "EPSG", std::to_string(code).c_str(), PJ_CATEGORY_CRS, 0, nullptr));
    return system ? proj.axis(proj.part(system.get(), index).get(), 0) : detail::Proj::Axis{};
  };
  int known = 0;
  const auto& ranges = detail::systems_in_metres;
  REQUIRE(std::ranges::is_sorted(ranges));
  for (std::size_t i = 0; i < ranges.size(); i += 2)
    for (int code = ranges[i]; code <= ranges[i + 1]; code += 3)
      for (const int part : {0, 1}) {
        const detail::Proj::Axis axis = axis_of(code, part);
        if (axis.direction.empty() || axis.unit < 0.1) continue;  // of degrees
        INFO("EPSG:", code);
        CHECK(axis.unit == 1);
        CHECK(axis.direction != "down");
        ++known;
      }
  CHECK(known > 1000);
  for (const std::uint16_t code : detail::systems_of_depths) CHECK(axis_of(code, 0).direction == "down");
}

TEST_CASE("threads have contexts of their own") {
  const SpatialReference expected = complete_reference({.epsg = 2056});
  std::vector<SpatialReference> found(4);
  std::vector<std::thread> threads;
  for (SpatialReference& one : found) threads.emplace_back([&one] { one = complete_reference({.epsg = 2056}); });
  for (std::thread& thread : threads) thread.join();
  for (const SpatialReference& one : found) CHECK(one == expected);
}

TEST_CASE("points in LAS are where they are on the map, in metres, whatever the unit of the system") {
  const Shot shot{.origin = {1'234.5678, 5'678.1234, 99.4321}, .direction = {0, 1, 0}, .echoes = 1};
  const std::array shots{shot};
  const std::array echoes{Echo{.range = 10}};
  EchoBatch batch;
  batch.shots = shots;
  batch.echoes = echoes;
  for (const SpatialReference& in : {SpatialReference{.epsg = 2263},
                                     {.epsg = 2263, .vertical_epsg = 6360},
                                     {.epsg = 25832, .vertical_epsg = 7837}}) {
    const support::TemporaryFolder folder;
    const SpatialReference reference = complete_reference(in);
    LasWriter las(folder / "points.las", {.reference = reference});
    las(batch);
    las.close();
    const support::LasFile file = support::read_las(folder / "points.las");
    CHECK(file.wkt == reference.wkt);
    const std::array<double, 3> place = file.points.at(0).place;
    CHECK(std::fabs(place[0] * reference.unit - 1'234.5678) < 1e-3);
    CHECK(std::fabs(place[1] * reference.unit - 5'688.1234) < 1e-3);
    CHECK(std::fabs(place[2] * reference.vertical_unit - 99.4321) < 1e-3);
  }
}

}  // namespace
}  // namespace pulsecast::io
