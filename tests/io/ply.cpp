// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/ply.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/scan_splitter.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/every_column.hpp"
#include "support/random_pulses.hpp"
#include "support/refused_field.hpp"
#include "support/size_limit.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::RandomPulses;
using support::refused_field;
using support::TemporaryFolder;

/// Echoes at 10 m and 20 m to the east of a place.
struct TwoEchoes {
  std::array<Shot, 1> shots{
      {{.tick = {3, 0.25}, .origin = {1, 2, 3}, .direction = axis::right, .channel = 5, .echoes = 2}}};
  std::array<Echo, 2> echoes{{{.range = 10, .reflectance = 0.5, .object = 70'000, .classification = 600},
                              {.range = 20, .reflectance = 0.25, .number = 2, .velocity = -3.5}}};

  [[nodiscard]] EchoBatch batch() const { return {.shots = shots, .echoes = echoes, .samples = {}}; }
};

std::string ply(const EchoBatch& batch, const PlySettings& settings = {}) {
  const TemporaryFolder folder;
  PlyWriter writer(folder / "a.ply", settings);
  writer(batch);
  writer.close();
  return content(folder / "a.ply");
}

/// Bytes behind the header.
std::string records(const std::string& file) {
  const std::string end = "end_header\n";
  const std::size_t at = file.find(end);
  REQUIRE(at != std::string::npos);
  return file.substr(at + end.size());
}

/// Header of a vertex with these properties.
std::string header(const std::string& count, const std::string& properties) {
  return "ply\nformat binary_little_endian 1.0\ncomment written by pulsecast" + std::string(20 - count.size(), ' ') +
         "\nelement vertex " + count + "\n" + properties + "end_header\n";
}

TEST_CASE("every column of the table is a property, of 64-bit integers as a double") {
  const support::EveryColumn all;
  const PlySettings settings{.layout = PointLayout::packed(all.fields), .points = all.settings};
  CHECK(records(ply(all.batch(), settings)) == all.bytes(all.records(false)));
  const TemporaryFolder folder;
  PlyWriter writer(folder / "a.ply", settings);
  writer.add(all.records());
  writer.close();
  CHECK(content(folder / "a.ply") == ply(all.batch(), settings));
}

TEST_CASE("colours and attributes are properties, colours by the names and in the type that readers know") {
  std::vector<Scene<TriangleMesh<>>::Part> trees(1);
  trees[0].object = 70'000;
  trees[0].attributes = pulsecast::attributes({{"age", 80.5}, {"leaf", 1}});
  const ObjectAttributes attributes{std::span(std::as_const(trees))};
  const auto colour = [](const EchoBatch&, const Shot&, const Echo& echo) {
    return PointColour{static_cast<std::uint16_t>(257 * echo.number), 65535, 0};
  };
  const PlySettings settings{.layout = PointLayout::packed(layouts::xyz_float())
                                           .with(layouts::colours())
                                           .with(layouts::attributes(attributes.names(), NumberType::float32)),
                             .points = {.colours = colour, .attributes = attributes}};
  const std::string file = ply(TwoEchoes().batch(), settings);
  const std::string head =
      header("2",
             "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
             "property uchar blue\nproperty float age\nproperty float leaf\n");
  REQUIRE(file.size() == head.size() + 2 * 23);
  CHECK(file.substr(0, head.size()) == head);
  const auto float_at = [&](std::size_t offset) {
    float number = 0;
    std::memcpy(&number, file.data() + head.size() + offset, sizeof number);
    return number;
  };
  CHECK((file.substr(head.size() + 12, 3) == std::string("\1\xFF\0", 3) && float_at(15) == 80.5F && float_at(19) == 1));
  CHECK((file.substr(head.size() + 35, 3) == std::string("\2\xFF\0", 3) && std::isnan(float_at(38)) &&
         std::isnan(float_at(42))));
}

TEST_CASE("a header names the properties and the number of vertices, and the records follow it") {
  const std::string file = ply(TwoEchoes().batch());
  const std::string head =
      header("2",
             "property double x\nproperty double y\nproperty double z\nproperty float reflectance\n"
             "property double time\nproperty ushort channel\nproperty uchar return_number\n"
             "property uchar returns\nproperty ushort classification\nproperty uint object\n");
  REQUIRE(file.size() == head.size() + 2 * 46);
  CHECK(file.substr(0, head.size()) == head);
  const char* const first = file.data() + head.size();
  const auto is = [&](std::size_t offset, auto expected) {
    decltype(expected) number;
    std::memcpy(&number, first + offset, sizeof number);
    return number == expected;
  };
  CHECK((is(0, 11.0) && is(8, 2.0) && is(16, 3.0) && is(24, 0.5F) && is(28, 3.25)));
  CHECK((is(36, std::uint16_t{5}) && is(38, std::uint8_t{1}) && is(39, std::uint8_t{2})));
  CHECK((is(40, std::uint16_t{600}) && is(42, std::uint32_t{70'000})));
  CHECK((is(46, 21.0) && is(46 + 24, 0.25F) && is(46 + 38, std::uint8_t{2}) && is(46 + 42, std::uint32_t{0})));
}

TEST_CASE("each number type has its name") {
  const PointLayout layout = PointLayout::packed({{"a", NumberType::int8},
                                                  {"b", NumberType::uint8},
                                                  {"c", NumberType::int16},
                                                  {"d", NumberType::uint16},
                                                  {"e", NumberType::int32},
                                                  {"f", NumberType::uint32},
                                                  {"g", NumberType::float32},
                                                  {"h", NumberType::float64}});
  CHECK(ply({}, {.layout = layout}) ==
        header("0",
               "property char a\nproperty uchar b\nproperty short c\nproperty ushort d\nproperty int e\n"
               "property uint f\nproperty float g\nproperty double h\n"));
}

TEST_CASE("records are those of a buffer, and the header is right for any number of them") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    const RandomPulses pulses(1 + 10 * seed * seed, seed);
    PointBuffer points(layouts::map());
    points(pulses.batch());
    const std::string file = ply(pulses.batch());
    const std::span<const std::byte> expected = points.records();
    CHECK(records(file) == std::string(reinterpret_cast<const char*>(expected.data()), expected.size()));
    CHECK(file.find("\nelement vertex " + std::to_string(points.size()) + "\n") != std::string::npos);
  }
}

TEST_CASE("scans that are added one by one are one cloud, and padding is left out") {
  const RandomPulses pulses(3000, 1);
  const TemporaryFolder folder;
  const PointLayout packed = PointLayout::packed(layouts::ouster().fields);
  PlyWriter padded_writer(folder / "a.ply", {.layout = layouts::ouster()}),
      packed_writer(folder / "b.ply", {.layout = packed});
  ScanSplitter padded(PointBuffer(layouts::ouster()), 1, [&](const PointBuffer& scan) { padded_writer.add(scan); });
  ScanSplitter without_gaps(PointBuffer(packed), 1, [&](const PointBuffer& scan) { packed_writer.add(scan); });
  for (ScanSplitter* splitter : {&padded, &without_gaps}) {
    (*splitter)(pulses.batch());
    splitter->close();
  }
  padded_writer.close();
  packed_writer.close();
  CHECK(records(content(folder / "a.ply")).size() == pulses.echoes.size() * 30);
  CHECK(content(folder / "a.ply") == content(folder / "b.ply"));
}

TEST_CASE("without close there is no file, and a full disk is an error that leaves none") {
  const TemporaryFolder folder;
  {
    PlyWriter writer(folder / "a.ply");
    writer(TwoEchoes().batch());
  }
  CHECK(folder.empty());
  {
    const support::SizeLimit limit(10'000);
    PlyWriter writer(folder / "a.ply");
    writer(RandomPulses(1000, 1).batch());
    CHECK_THROWS_AS(writer.close(), FileError);
  }
  CHECK(folder.empty());
}

TEST_CASE("settings and buffers that do not fit are refused") {
  const TemporaryFolder folder;
  const auto refused = [&](const PlySettings& settings) {
    return refused_field([&] { PlyWriter(folder / "a.ply", settings); });
  };
  CHECK(refused({.layout = {}}) == "PointLayout::size");
  CHECK(refused({.layout = PointLayout::packed({{"a b", NumberType::float32}})}) ==
        "PointField::name (character code)");
  CHECK(refused({.points = {.start_time = std::numeric_limits<double>::infinity()}}) == "PointSettings::start_time");
  PlyWriter writer(folder / "a.ply");
  CHECK(refused_field([&] { writer.add(PointBuffer(layouts::xyzi())); }) == "PointBuffer::layout (index of a field)");
}

}  // namespace
}  // namespace pulsecast::io
