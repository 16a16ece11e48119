// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/geojson.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/refused_field.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::refused_field;
using support::TemporaryFolder;

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Pulses that look down, each from above its points.
struct Run {
  std::vector<Shot> shots{};
  std::vector<Echo> echoes{};

  /// Adds a pulse with echoes at these ranges.
  Run& pulse(std::uint16_t leg, double time, const Vec3& origin, const std::vector<double>& ranges = {}) {
    shots.push_back({.index = shots.size(),
                     .tick = Tick::of_seconds(time),
                     .origin = origin,
                     .direction = -axis::up,
                     .leg = leg,
                     .first_echo = static_cast<std::uint32_t>(echoes.size()),
                     .echoes = static_cast<std::uint32_t>(ranges.size())});
    for (const double range : ranges) echoes.push_back({.range = range});
    return *this;
  }

  [[nodiscard]] EchoBatch batch() const { return {.shots = shots, .echoes = echoes, .samples = {}}; }
};

std::string geojson(const Run& run, const GeoJsonSettings& settings = {}) {
  const TemporaryFolder folder;
  GeoJsonWriter writer(folder / "a.geojson", settings);
  writer(run.batch());
  writer.close();
  return content(folder / "a.geojson");
}

/// File without a reference system that holds these features.
std::string collection(const std::string& features) {
  return "{\"type\":\"FeatureCollection\",\"features\":[" + features + "\n]}\n";
}

std::string trajectory(const std::string& properties, const std::string& geometry) {
  return "\n{\"type\":\"Feature\",\"properties\":{\"kind\":\"trajectory\"," + properties +
         "},\"geometry\":" + geometry + "}";
}

std::string footprint(const std::string& properties, const std::string& ring) {
  return "\n{\"type\":\"Feature\",\"properties\":{\"kind\":\"footprint\"," + properties +
         "},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[" + ring + "]]}}";
}

/// Part of a file between the first two of these marks.
std::string between(const std::string& file, const std::string& first, const std::string& last) {
  const std::size_t at = file.find(first);
  REQUIRE(at != std::string::npos);
  const std::size_t end = file.find(last, at + first.size());
  REQUIRE(end != std::string::npos);
  return file.substr(at + first.size(), end - at - first.size());
}

std::string ring_of(const std::string& file) { return between(file, "\"Polygon\",\"coordinates\":[[", "]]}"); }

TEST_CASE(
    "a leg that moves is a line of its pulses at the interval with the first and the last, above the hull of its "
    "points") {
  Run run;
  run.pulse(3, 10, {0, 0, 5}, {5}).pulse(3, 10.5, {1, 0, 5}, {4, 5}).pulse(3, 11, {1, 1, 5}, {5});
  run.pulse(3, 11.25, {0.5, 0.5, 5}, {1}).pulse(3, 11.75, {0, 1, 5.0004}, {5});
  CHECK(geojson(run) ==
        collection(footprint("\"leg\":3,\"start\":10,\"end\":11.75,\"points\":6,\"area\":1",
                             "[0.000,0.000],[1.000,0.000],[1.000,1.000],[0.000,1.000],[0.000,0.000]") +
                   "," +
                   trajectory("\"leg\":3,\"start\":10,\"end\":11.75,\"pulses\":5,\"points\":6",
                              "{\"type\":\"LineString\",\"coordinates\":[[0.000,0.000,5.000],[1.000,1.000,5.000],"
                              "[0.000,1.000,5.000]]}")));
}

TEST_CASE("coordinates are in units of the reference system, and areas in square metres") {
  Run run;
  run.pulse(0, 0, {10, 20, 30}, {5}).pulse(0, 1, {30, 20, 30}, {5}).pulse(0, 2, {10, 40, 30}, {5});
  const std::string file = geojson(run, {.unit = 2, .vertical_unit = 0.5});
  CHECK(file.find("[5.000,10.000,60.000]") != file.npos);
  CHECK(file.find("[15.000,10.000]") != file.npos);  // of the footprint
  CHECK(file.find("\"area\":200}") != file.npos);
}

TEST_CASE("a run without pulses is a collection without features") { CHECK(geojson({}) == collection("")); }

TEST_CASE("a code of EPSG is named") {
  CHECK(geojson({}, {.epsg = 25832}) ==
        "{\"type\":\"FeatureCollection\",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"urn:ogc:def:crs:EPSG::"
        "25832\"}},"
        "\"features\":[\n]}\n");
}

TEST_CASE(
    "a leg that moves by less than the resolution is a point, also on both sides of zero, and one without points has "
    "no footprint") {
  const Run run = Run().pulse(0, 0, {-0.0001, 7, 2}).pulse(0, 1, {0.0001, 7, 2}).pulse(0, 2, {0, 7, 2.0003});
  CHECK(geojson(run) == collection(trajectory("\"leg\":0,\"start\":0,\"end\":2,\"pulses\":3,\"points\":0",
                                              "{\"type\":\"Point\",\"coordinates\":[0.000,7.000,2.000]}")));
}

TEST_CASE("a line that returns to its start keeps the way between, and a stop in it is one point") {
  const Run run = Run().pulse(0, 0, {0, 0, 0}).pulse(0, 1, {4, 0, 0}).pulse(0, 2, {4, 0, 0}).pulse(0, 3, {0, 0, 0});
  CHECK(between(geojson(run), "\"LineString\",\"coordinates\":", "}") ==
        "[[0.000,0.000,0.000],[4.000,0.000,0.000],[0.000,0.000,0.000]]");
}

TEST_CASE("a leg ends when another begins, one that comes back is new, and batches may divide it anywhere") {
  Run run;
  for (const std::uint16_t leg : std::vector<std::uint16_t>{0, 1, 0})
    for (int i = 0; i < 4; ++i) {
      const double time = static_cast<double>(run.shots.size());
      run.pulse(leg, time, {time, i % 2 == 0 ? 0.0 : 3.0, 9}, {9});
    }
  const std::string whole = geojson(run);
  std::string kinds;
  for (std::size_t at = whole.find("\"kind\":\""); at != std::string::npos; at = whole.find("\"kind\":\"", at + 1))
    kinds += between(whole.substr(at), "\"kind\":\"", ",\"start\"") + ";";
  CHECK(kinds ==
        "footprint\",\"leg\":0;trajectory\",\"leg\":0;footprint\",\"leg\":1;trajectory\",\"leg\":1;"
        "footprint\",\"leg\":0;trajectory\",\"leg\":0;");
  const TemporaryFolder folder;
  GeoJsonWriter writer(folder / "a.geojson");
  for (const Shot& shot : run.shots) writer({.shots = {&shot, 1}, .echoes = run.echoes, .samples = {}});
  writer.close();
  CHECK(content(folder / "a.geojson") == whole);
}

TEST_CASE("each interval since the start of a leg has its footprint, and intervals without points have none") {
  Run run;
  for (const double start : {5.0, 7.0, 11.0})
    run.pulse(0, start, {start, 0, 1}, {1})
        .pulse(0, start + 0.5, {start + 2, 0, 1}, {1})
        .pulse(0, start + 1, {start, 1, 1}, {1});
  run.pulse(0, 14, {0, 0, 1});
  const std::string file = geojson(run, {.footprint_interval = 2});
  for (const auto* const part : {"5,\"end\":6,\"points\":3,\"area\":1}", "7,\"end\":8,\"points\":3,\"area\":1}",
                                 "11,\"end\":12,\"points\":3,\"area\":1}"})
    CHECK(file.find(std::string("\"footprint\",\"leg\":0,\"start\":") + part) != std::string::npos);
  CHECK(std::count(file.begin(), file.end(), '\n') == 1 + 3 + 1 + 1);
}

TEST_CASE("points on a line, or fewer than three, have no footprint") {
  CHECK(geojson(Run().pulse(0, 0, {0, 0, 1}, {1}).pulse(0, 1, {5, 5, 1}, {1, 2, 3})).find("Polygon") ==
        std::string::npos);
  Run run;
  for (int i = 0; i < 100; ++i) run.pulse(0, 0.01 * i, {500'000 + 0.3 * i, 5'400'000 + 0.1 * i, 1}, {1});
  CHECK(geojson(run).find("Polygon") == std::string::npos);
  run.pulse(0, 1, {500'000 + 3, 5'400'000 + 1.001, 1}, {1});
  CHECK(geojson(run).find("Polygon") != std::string::npos);
}

TEST_CASE("origins and points that are not finite are left out, while their pulses count") {
  Run run;
  run.pulse(0, 0, {infinite, 0, 1}, {1})
      .pulse(0, 1, {0, 0, 1}, {1})
      .pulse(0, 2, {2, 0, 1}, {1, infinite})
      .pulse(0, 3, {0, 2, 1}, {1});
  run.pulse(0, 4, {0, std::nan(""), 1}, {1}).pulse(0, 5, {1e308, 0, 1});
  CHECK(geojson(run) == collection(footprint("\"leg\":0,\"start\":1,\"end\":3,\"points\":3,\"area\":2",
                                             "[0.000,0.000],[2.000,0.000],[0.000,2.000],[0.000,0.000]") +
                                   "," +
                                   trajectory("\"leg\":0,\"start\":0,\"end\":5,\"pulses\":6,\"points\":6",
                                              "{\"type\":\"LineString\",\"coordinates\":[[0.000,0.000,1.000],[2.000,0."
                                              "000,1.000],[0.000,2.000,1.000]]}")));
  CHECK(geojson(Run().pulse(0, 0, {infinite, 0, 0})) == collection(""));
  Run far;
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(1e300, 0, 0), Vec3(0, 1e300, 0)}) far.pulse(0, 0, origin, {1});
  CHECK(geojson(far).find("inf") == std::string::npos);
  CHECK(geojson(far).find("nan") == std::string::npos);
}

/// Corners by definition: each edge of the hull has all other points on its left, or on it between its ends.
std::vector<Vec2> hull_by_edges(const std::vector<Vec2>& points) {
  std::vector<Vec2> corners;
  const auto is_edge = [&](const Vec2& a, const Vec2& b) {
    return std::all_of(points.begin(), points.end(), [&](const Vec2& p) {
      const double side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
      const double along = (p.x - a.x) * (p.x - b.x) + (p.y - a.y) * (p.y - b.y);
      return side > 0 || (side == 0 && along <= 0);
    });
  };
  const auto first = std::min_element(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  });
  corners.push_back(*first);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto next = std::find_if(points.begin(), points.end(),
                                   [&](const Vec2& b) { return b != corners.back() && is_edge(corners.back(), b); });
    REQUIRE(next != points.end());
    if (*next == corners.front()) break;
    corners.push_back(*next);
  }
  return corners;
}

TEST_CASE("a hull has the corners that its definition says, with points on edges and repeated ones too") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const double size = seed % 2 == 0 ? 6 : 1e7;  // of a coarse grid, with many points on edges, and of a fine one
    std::vector<Vec2> points{{0, 0}, {1, 0}, {0, 1}};
    for (std::uint64_t i = random.whole(60); i > 0; --i)
      points.push_back({std::floor(random.uniform(-size, size)), std::floor(random.uniform(-size, size))});
    CHECK(detail::convex_hull(points) == hull_by_edges(points));
  }
}

TEST_CASE("a hull of many more points than the buffer holds is that of all of them") {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    std::vector<Vec2> points;
    detail::HullOfStream stream;
    for (int i = 0; i < 50'000; ++i) {
      const double angle = random.uniform(0, 6.2831853), radius = seed % 2 == 0 ? 4e7 : random.uniform(0, 1e6);
      points.push_back({std::nearbyint(radius * std::cos(angle)), std::nearbyint(radius * std::sin(angle))});
      stream.add(points.back());
    }
    const std::vector<Vec2> corners = stream.take();
    CHECK(corners == detail::convex_hull(points));
    CHECK((seed % 2 == 0) == (corners.size() > 4096));  // of a circle, the corners alone exceed the buffer
    CHECK(stream.take().empty());
  }
}

TEST_CASE("a footprint of a disc of many points has its area, and the ring is closed and runs anticlockwise") {
  Run run;
  constexpr int count = 20'000;
  constexpr double radius = 40, pi = 3.14159265358979;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * pi * 7919 * i / count;
    run.pulse(0, 1e-4 * i, {500'000 + radius * std::cos(angle), 5'400'000 + radius * std::sin(angle), 100}, {100});
  }
  const std::string file = geojson(run);
  CHECK(std::stod(between(file, "\"area\":", "}")) == doctest::Approx(pi * radius * radius).epsilon(1e-4));
  const std::string ring = ring_of(file);
  CHECK(ring.substr(0, ring.find("],")) + "]" == ring.substr(ring.rfind('[')));
}

TEST_CASE("without close there is no file") {
  const TemporaryFolder folder;
  {
    GeoJsonWriter writer(folder / "a.geojson");
    writer(Run().pulse(0, 0, {0, 0, 0}).batch());
  }
  CHECK(folder.empty());
}

TEST_CASE("settings out of range are refused") {
  const TemporaryFolder folder;
  const auto refused = [&](const GeoJsonSettings& settings) {
    return refused_field([&] { GeoJsonWriter(folder / "a", settings); });
  };
  CHECK(refused({.epsg = -1}) == "GeoJsonSettings::epsg");
  CHECK(refused({.epsg = 32'767}) == "GeoJsonSettings::epsg");
  CHECK(refused({.epsg = 32'766}).empty());
  CHECK(refused({.interval = 0}) == "GeoJsonSettings::interval");
  CHECK(refused({.unit = 0}) == "GeoJsonSettings::unit");
  CHECK(refused({.vertical_unit = infinite}) == "GeoJsonSettings::unit");
  CHECK(refused({.interval = infinite}) == "GeoJsonSettings::interval");
  CHECK(refused({.footprint_interval = -1}) == "GeoJsonSettings::footprint_interval");
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::io
