// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/copc.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/las.hpp>

#include "support/copc_reader.hpp"
#include "support/every_column.hpp"
#include "support/generators.hpp"
#include "support/las_reader.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::CopcFile;
using support::Generator;
using support::read_copc;
using support::TemporaryFolder;

using Points = std::vector<Vec3>;
using Writer = detail::LasFileWriter<detail::CopcRecords>;

/// Sizes at which a few thousand points take many runs, blocks and pages.
constexpr detail::CopcSizes small{
    .leaf_points = 100, .block_points = 1000, .run_bytes = 30'000, .most_cells = 300, .page_nodes = 4};

/// Writes a pulse straight down to each point, one after another in time, with what `look` makes of its echo.
template <class Sink>
void write(Sink writer, const Points& points, std::size_t at_once = 1000, const std::function<void(Echo&)>& look = {}) {
  std::vector<Shot> shots;
  std::vector<Echo> echoes;
  for (std::size_t i = 0; i < points.size(); ++i) {
    shots.push_back({.index = i,
                     .tick = Tick::of(i, 1e4),
                     .origin = points[i],
                     .direction = {0, 0, -1},
                     .leg = static_cast<std::uint16_t>(i / 1000),
                     .channel = static_cast<std::uint8_t>(i % 5),
                     .first_echo = static_cast<std::uint32_t>(echoes.size()),
                     .echoes = 1});
    echoes.push_back({.range = 0,
                      .amplitude = 1e-9 * static_cast<double>(1 + i % 1000),
                      .reflectance = 0.3,
                      .object = ObjectId(i % 50),
                      .number = 1});
    if (look) look(echoes.back());
    if (shots.size() < at_once && i + 1 < points.size()) continue;
    writer(EchoBatch{shots, echoes, {}, 0});
    shots.clear();
    echoes.clear();
  }
  writer.close();
}

/// Reads a file of these points, and checks that it holds what the LAS file does, every point once, in even samples.
CopcFile checked(const Points& points, const LasSettings& settings = {}, const detail::CopcSizes& sizes = small) {
  const TemporaryFolder folder;
  write(Writer(folder / "points.copc.laz", settings, detail::CopcRecords(2, sizes)), points);
  write(LasWriter(folder / "points.las", settings), points);
  CHECK(std::distance(std::filesystem::directory_iterator(folder / "."), {}) == 2);
  CopcFile file = read_copc(content(folder / "points.copc.laz"));
  support::check_even_samples(file, sizes.leaf_points);

  const std::string las = content(folder / "points.las");
  std::vector<std::string> found = file.records(), expected;
  const support::LasFile las_file = support::read_las(folder / "points.las");
  for (const support::LasPoint& point : las_file.points) expected.push_back(point.bytes);
  std::sort(found.begin(), found.end());
  std::sort(expected.begin(), expected.end());
  CHECK(found.size() == points.size());
  CHECK(found == expected);
  CHECK(file.las.substr(0, las_file.points_at) == las.substr(0, las_file.points_at));  // header and other records
  return file;
}

Points random_points(std::uint64_t seed) {
  Generator random(seed);
  const std::size_t count = random.whole(4000) + 500;
  const Vec3 middle = random.point(1e4);
  const double reach = random.log_uniform(0.1, 1000);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    Vec3 p = random.point(1);
    switch (seed % 5) {
      case 0:
        break;  // in a volume
      case 1:
        p.z = 0.1 * std::sin(5 * p.x);
        break;  // on a surface
      case 2:
        p = random.unit() * random.log_uniform(1e-7, 1);
        break;  // denser towards the middle, at all scales
      case 3:
        p = {p.x, 0, 0};
        break;  // on a line
      default:
        p = p * 1e-4 + Vec3(random.coin() ? 1 : 0, 0, 0);  // in two places
    }
    points.push_back(middle + p * reach);
  }
  return points;
}

/// A number of a point, of four bytes at some offset.
std::int32_t whole(const support::CopcReadNode& node, std::size_t i, const CopcFile& file, std::size_t at) {
  return static_cast<std::int32_t>(support::detail::laz_whole(node.records, i * file.record + at, 4));
}

TEST_CASE("of a square grid with four points in each cell, the root has one of each, and the next level all others") {
  Points points;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) points.emplace_back(8 * x, 8 * y, 5);
  const CopcFile file = checked(points, {.scale = 1, .offset = Vec3{0, 0, 0}}, {.leaf_points = 20'000});
  REQUIRE(file.nodes.size() == 5);
  CHECK(file.pages == 1);
  CHECK(file.half == 1024);
  CHECK(file.spacing == 16);
  CHECK(file.centre == std::array{1023.5, 1023.5, 1023.5});
  for (const auto& [name, node] : file.nodes) {
    CHECK(name.level == (node.is_leaf ? 1 : 0));
    CHECK(node.points == (node.is_leaf ? 128 * 128 * 3 / 4 : 128 * 128));
    CHECK(name.z == 0);
    std::size_t nearest = 0;  // cells are 16 steps long: 8 is nearer to their middle than 0 and 16 are
    for (std::size_t i = 0; i < node.points; ++i)
      if (whole(node, i, file, 0) % 16 == 8 && whole(node, i, file, 4) % 16 == 8) ++nearest;
    CHECK(nearest == (node.is_leaf ? 0 : node.points));
  }
}

/// GPS times of the points of a node.
std::vector<double> times(const support::CopcReadNode& node, std::size_t record) {
  std::vector<double> all;
  for (std::size_t i = 0; i < node.points; ++i)
    all.push_back(std::bit_cast<double>(support::detail::laz_whole(node.records, i * record + 22, 8)));
  return all;
}

TEST_CASE("points of a node are in order of their times, as they compress best") {
  for (const std::uint64_t seed : {0U, 2U}) {
    const CopcFile file = checked(random_points(seed), {.start_time = -0.1});  // some times are below 0
    for (const auto& [name, node] : file.nodes) {
      const std::vector<double> all = times(node, file.record);
      CHECK(std::is_sorted(all.begin(), all.end()));
    }
  }
}

TEST_CASE("few points are one node; the root's cube is about them, its spacing a 128th") {
  const CopcFile file = checked({{1, 2, 3}, {2, 3, 4}, {5, 6, 7}}, {.wkt = "LOCAL_CS[]", .start_time = 77});
  CHECK(file.nodes.size() == 1);
  CHECK(file.first_time == 77);
  CHECK(file.last_time == 77 + 2e-4);
  CHECK(file.half >= 2);
  CHECK(file.half < 8);
  CHECK(std::fabs(file.centre[0] - 3) < file.half);
}

TEST_CASE("clouds of all shapes keep every point once, each in its node, and all levels are even samples") {
  for (std::uint64_t seed = 0; seed < 15; ++seed) {
    CAPTURE(seed);
    const CopcFile file = checked(random_points(seed));
    if (seed % 5 == 2) CHECK(file.levels() > 5);
    if (seed % 5 == 4) CHECK(file.levels() > 3);
  }
}

TEST_CASE("a large hierarchy is in pages, all of which are reached") {
  Generator random(3);
  Points points;
  for (int cluster = 0; cluster < 300; ++cluster) {
    const Vec3 middle = random.point(500);
    for (int i = 0; i < 30; ++i) points.push_back(middle + random.point(1e-2));
  }
  detail::CopcSizes sizes = small;
  sizes.leaf_points = 5;
  const CopcFile file = checked(points, {}, sizes);
  CHECK(file.pages > 20);
  CHECK(file.levels() > 9);
}

TEST_CASE("a file without points has a root without points") {
  const CopcFile file = checked({}, {.epsg = 25832});
  REQUIRE(file.nodes.size() == 1);
  CHECK(file.nodes.begin()->second.points == 0);
  CHECK(file.pages == 1);
  CHECK((file.first_time == 0 && file.last_time == 0));
}

TEST_CASE("one point is a file, wherever it is") {
  for (const Vec3& point : {Vec3(0, 0, 0), Vec3(-1e5, 2e5, 3), Vec3(4e5, 5.6e6, 200)})
    CHECK(checked({point}).nodes.size() == 1);
}

TEST_CASE("any number of points in one place is divided down to nodes of 128 steps, where a leaf takes the rest") {
  const CopcFile file = checked(Points(700, Vec3{1, 2, 3}));
  CHECK(file.levels() == 5);  // nodes of 2048, 1024, 512, 256, 128 steps
  for (const auto& [name, node] : file.nodes) CHECK(node.points == (node.is_leaf ? 699 : name.level == 0 ? 1 : 0));
  Points two(2000, Vec3{1, 2, 3});
  for (std::size_t i = 0; i < two.size(); i += 2) two[i] = {1e5, -1e5, 3};
  CHECK(checked(two).levels() > 15);
}

TEST_CASE("a node that has given all its points to the one above is still listed, for the leaves below it") {
  Generator random(9);
  Points points;
  for (int place = 0; place < 40; ++place) {
    const Vec3 middle = random.point(2);
    for (int i = 0; i < 80; ++i) points.push_back(middle);
  }
  detail::CopcSizes sizes = small;
  sizes.block_points = 150;
  const CopcFile file = checked(points, {}, sizes);
  std::size_t empty = 0;
  for (const auto& [name, node] : file.nodes) empty += node.points == 0 ? 1 : 0;
  CHECK(empty > 5);
}

TEST_CASE("a dense place in a wide cloud is divided by cells of its own") {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    Points points;
    for (int i = 0; i < 2000; ++i) points.push_back(random.point(500));
    const Vec3 dense = random.point(400);
    for (int i = 0; i < 8000; ++i) points.push_back(dense + random.point(1) * random.log_uniform(0.01, 1));
    CHECK(checked(points).levels() > 10);
  }
}

TEST_CASE("points on the borders of nodes are in one of them") {
  Points points;
  for (int x = -8; x <= 8; ++x)
    for (int y = -8; y <= 8; ++y)
      for (int z = -8; z <= 8; ++z) points.emplace_back(x * 256, y * 256, z * 256);
  for (const double scale : {1.0, 0.1, 1e-3}) {
    for (Vec3& p : points) p *= scale;
    checked(points, {.scale = scale, .offset = Vec3{0, 0, 0}});
    for (Vec3& p : points) p /= scale;
  }
}

TEST_CASE("coordinates may use all of 32 bits, and offsets may be large") {
  constexpr double most = std::numeric_limits<std::int32_t>::max(), least = std::numeric_limits<std::int32_t>::min();
  Points points{{most, most, most}, {least, least, least}, {most, least, 0}};
  for (int i = 0; i < 500; ++i) points.emplace_back(i % 20, i / 20, most - i);
  const CopcFile file = checked(points, {.scale = 1, .offset = Vec3{0, 0, 0}});
  CHECK(file.half == 2147483648.0);
  Generator random(1);
  Points far;
  for (int i = 0; i < 1000; ++i) far.push_back(Vec3{6e7, 5.4e8, -3e6} + random.point(10));
  checked(far, {.scale = 1e-3, .offset = Vec3{6e7, 5.4e8, -3e6}});
}

TEST_CASE("the bytes are the same for any number of threads, and however the points came") {
  const TemporaryFolder folder;
  const Points points = random_points(7);
  write(Writer(folder / "1", {}, detail::CopcRecords(1, small)), points);
  const std::string one = content(folder / "1");
  for (const unsigned threads : {2U, 3U, 8U}) {
    CAPTURE(threads);
    write(Writer(folder / "n", {}, detail::CopcRecords(threads, small)), points, 1 + 77 * threads);
    CHECK(content(folder / "n") == one);
  }
  write(CopcWriter(folder / "one", {}, 1), points);
  write(CopcWriter(folder / "eight", {}, 8), points);
  CHECK(content(folder / "one") == content(folder / "eight"));
}

TEST_CASE("colours, near infrared, attributes and kinds of light are those of the LAS file") {
  struct Tree {
    ObjectId object = 7;
    Attributes attributes = pulsecast::attributes({{"age", 80}});
  } tree;
  LasSettings settings{.light_kinds = true,
                       .attributes = std::make_shared<const ObjectAttributes>(std::span<const Tree>(&tree, 1))};
  settings.colours = [](const EchoBatch&, const Shot& shot, const Echo&) -> std::optional<PointColour> {
    if (shot.index % 7 == 0) return std::nullopt;
    return PointColour{static_cast<std::uint16_t>(shot.index * 3), static_cast<std::uint16_t>(shot.index), 9, 500};
  };
  CHECK(checked(random_points(1), settings).record == 36 + 33 + 8);
  settings.near_infrared = true;
  CHECK(checked(random_points(1), settings).record == 38 + 33 + 8);
}

TEST_CASE("every column of the table is that of the LAS file") {
  const support::EveryColumn all;
  checked(random_points(2), {.columns = all.fields, .points = all.settings});
}

TEST_CASE("intensities that are scaled to the greatest amplitude are those of the LAS file") {
  checked(random_points(6), {.intensity = LasIntensity::amplitude});
  checked({}, {.intensity = LasIntensity::amplitude});
}

TEST_CASE("formats that are not compressed, and waveforms, are refused before there is a file") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH_AS(CopcWriter(folder / "a", {.format = LasFormat::las_1_4_legacy}),
                       doctest::Contains("LasSettings::format"), SettingError);
  CHECK_THROWS_WITH_AS(CopcWriter(folder / "a", {.waveforms = true}), doctest::Contains("LasSettings::waveforms"),
                       SettingError);
  CHECK(folder.empty());
}

TEST_CASE("a point without a place is an error; a writer that failed, or is not closed, leaves nothing behind") {
  const TemporaryFolder folder;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& bad : {Vec3(nan, 0, 0), Vec3(0, 0, 1e9)}) {
    CopcWriter writer(folder / "points.laz");
    const std::vector<Echo> echoes(2);
    const std::vector<Shot> shots{{.direction = {0, 0, 1}, .echoes = 1},
                                  {.origin = bad, .direction = {0, 0, 1}, .first_echo = 1, .echoes = 1}};
    CHECK_THROWS_WITH_AS(writer(EchoBatch{shots, echoes, {}, 0}), doctest::Contains("point 2"), FileError);
    CHECK_THROWS_AS(writer.close(), FileError);
  }
  CHECK(folder.empty());
  {
    CopcWriter writer(folder / "points.laz");
    const std::vector<Echo> echoes(1);
    const std::vector<Shot> shots{{.direction = {0, 0, 1}, .echoes = 1}};
    writer(EchoBatch{shots, echoes, {}, 0});
    CHECK(std::filesystem::exists(folder / "points.laz.part"));
    CHECK_FALSE(std::filesystem::exists(folder / "points.laz.points.part"));  // has no name that others could take
    CHECK_FALSE(std::filesystem::exists(folder / "points.laz"));
  }
  CHECK(folder.empty());
}

TEST_CASE("a writer may be moved half-way") {
  const TemporaryFolder folder;
  const Points points = random_points(2);
  write(CopcWriter(folder / "a"), points);
  std::optional<CopcWriter> first(std::in_place, folder / "b");
  CopcWriter second(std::move(*first));
  first.reset();
  write(std::move(second), points);
  CHECK(content(folder / "a") == content(folder / "b"));
}

TEST_CASE("the reader of the tests notices what is not by the rules") {
  const TemporaryFolder folder;
  detail::CopcSizes sizes = small;
  write(Writer(folder / "a", {}, detail::CopcRecords(1, sizes)), random_points(2));
  const std::string good = content(folder / "a");
  CHECK_NOTHROW(static_cast<void>(read_copc(good)));
  const std::size_t extended = support::detail::laz_whole(good, 235, 8);
  for (const std::size_t at :
       {std::size_t{375 + 54 + 7}, std::size_t{375 + 54 + 45}, std::size_t{375 + 54 + 60}, std::size_t{375 + 54 + 100},
        std::size_t{250}, extended + 60 + 4, extended + 60 + 28, extended + 60 + 24, good.size() - 32 + 16}) {
    CAPTURE(at);
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x40);
    CHECK_THROWS(static_cast<void>(read_copc(bad)));
  }
}

}  // namespace
}  // namespace pulsecast::io
