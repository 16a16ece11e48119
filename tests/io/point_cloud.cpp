// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/point_cloud.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <Eigen/SVD>

#include <pulsecast/io/copc.hpp>
#include <pulsecast/io/detail/point_cloud_reader.hpp>
#include <pulsecast/io/las.hpp>
#include <pulsecast/io/laz.hpp>

#include "support/file_errors.hpp"
#include "support/generators.hpp"
#include "support/las_builder.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::LasBuilder;
using support::TemporaryFolder;
using Cell = std::array<std::uint32_t, 3>;

std::filesystem::path put(const TemporaryFolder& folder, const std::string& text, const char* name = "a.xyz") {
  std::filesystem::remove(folder / name);
  std::ofstream(folder / name, std::ios::binary) << text;
  return folder / name;
}

PointCloud read(const std::string& text, const PointCloudSettings& settings = {}) {
  const TemporaryFolder folder;
  return read_point_cloud(put(folder, text), settings);
}

FileError error(const std::string& text, const PointCloudSettings& settings = {}) {
  return support::file_error([&] { (void)read(text, settings); });
}

std::string text_of(const std::vector<Vec3>& points, const std::vector<Vec3>& normals = {},
                    const std::vector<Vec3>& colours = {}) {
  std::string text;
  const auto add = [&](const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) {
      char number[40];
      std::snprintf(number, sizeof number, "%.17g ", v[axis]);
      text += number;
    }
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    add(points[i]);
    if (!normals.empty()) add(normals[i]);
    if (!colours.empty()) add(colours[i]);
    text += '\n';
  }
  return text;
}

Vec3 vector(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

/// Of two directions of unit length.
bool same(const std::array<float, 3>& found, const Vec3& expected) { return length(vector(found) - expected) < 2e-7; }

TEST_CASE("points on a lattice stand in known cells") {
  const PointCloud cloud = read("10 20 30\n10.9 20 30\n11 20.5 30\n13 21.5 30.5\n10.5 20.5 30.25\n");
  CHECK(cloud.points == 5);
  CHECK(cloud.voxels.edge == 1);
  CHECK(cloud.voxels.corner == Vec3{10, 20, 30});
  CHECK(cloud.voxels.cells ==
        std::vector<Cell>{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}});  // the greatest x is a face of the last cell
  CHECK(cloud.voxels.normals.empty());
  CHECK(cloud.colours.empty());
  CHECK(cloud.warnings.empty());
}

TEST_CASE("a lattice at multiples begins at one, and holds every point from its lesser face on") {
  const PointCloud cloud =
      read("-0.1 5.2 7\n3 5.4 7.5\n3.5 5.25 7\n", {.voxel_size = 0.5, .lattice = VoxelLattice::at_multiples});
  CHECK(cloud.voxels.corner == Vec3{-0.5, 5, 7});
  CHECK(cloud.voxels.cells == std::vector<Cell>{{0, 0, 0}, {7, 0, 1}, {8, 0, 0}});
}

TEST_CASE("clouds beside each other share a lattice at multiples") {
  constexpr std::uint64_t seed = 5;
  CAPTURE(seed);
  support::Generator random(seed);
  for (int i = 0; i < 20; ++i) {
    const double edge = random.log_uniform(1e-2, 10);
    const Vec3 place{477000, 5429000, 100};
    std::vector<Vec3> left, right;
    for (int k = 0; k < 50; ++k) {
      left.push_back(place + random.point(20));
      right.push_back(place + random.point(20));
    }
    std::vector<Vec3> all = left;
    all.insert(all.end(), right.begin(), right.end());
    const PointCloudSettings settings{.voxel_size = edge, .lattice = VoxelLattice::at_multiples};
    const auto places = [&](const VoxelData& voxels, std::map<std::array<std::int64_t, 3>, int>& seen) {
      for (const Cell& cell : voxels.cells) {
        std::array<std::int64_t, 3> at{};
        for (std::size_t axis = 0; axis < 3; ++axis)
          at[axis] = std::llround(voxels.corner[static_cast<int>(axis)] / edge) + std::int64_t{cell[axis]};
        seen[at] = 1;
      }
    };
    std::map<std::array<std::int64_t, 3>, int> apart, together;
    places(read(text_of(left), settings).voxels, apart);
    places(read(text_of(right), settings).voxels, apart);
    places(read(text_of(all), settings).voxels, together);
    CHECK(apart == together);
  }
}

TEST_CASE("a flat cloud keeps its place: its voxels are centred on it") {
  const PointCloud cloud = read("0 0 5\n3 2 5\n", {.voxel_size = 0.5});
  CHECK(cloud.voxels.corner == Vec3{0, 0, 4.75});
  CHECK(cloud.voxels.cells == std::vector<Cell>{{0, 0, 0}, {5, 3, 0}});
}

TEST_CASE("a cloud of one point is a voxel around it") {
  const PointCloud cloud = read("477123.5 5429000.25 -3\n", {.voxel_size = 0.5, .normals = VoxelNormals::fitted});
  CHECK(cloud.voxels.corner == Vec3{477123.25, 5429000, -3.25});
  CHECK(cloud.voxels.cells == std::vector<Cell>{{0, 0, 0}});
  CHECK(cloud.voxels.normals == std::vector<std::array<float, 3>>{{0, 0, 0}});
  CHECK(cloud.warnings ==
        std::vector<std::string>{"1 of 1 voxels have no normal: their points are fewer than three, or on one line"});
}

TEST_CASE("the normal of a tilted plane is found to 1e-9") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const Vec3 normal = random.unit() * 1.0, u = normalize(cross(normal, random.unit())), v = cross(normal, u);
    const double size = random.log_uniform(1e-3, 1e3);
    const Vec3 offset = random.point(size);
    const std::uint64_t points = 3 + random.whole(100);
    Vec3 sum{};
    std::array<double, 6> products{};
    for (std::uint64_t i = 0; i < points; ++i) {
      // Three corners of a triangle that is no sliver, then any points.
      const double a = i == 0   ? 1
                       : i == 1 ? -1
                       : i == 2 ? 0
                                : random.uniform(-1, 1),
                   b = i == 2  ? 1
                       : i < 2 ? 0
                               : random.uniform(-1, 1);
      const Vec3 d = offset + u * (a * size) + v * (b * size);
      sum += d;
      products[0] += d.x * d.x;
      products[1] += d.x * d.y;
      products[2] += d.x * d.z;
      products[3] += d.y * d.y;
      products[4] += d.y * d.z;
      products[5] += d.z * d.z;
    }
    const std::optional<Vec3> found = detail::plane_normal(static_cast<double>(points), sum, products);
    REQUIRE(found);
    CHECK(length(*found - (normal.z < 0 ? -normal : normal)) < 1e-9);
    CHECK(found->z >= 0);
  }
}

TEST_CASE("fitted normals of planes along the axes point up, north or east") {
  CHECK(*detail::plane_normal(4, {0, 0, 0}, {4, 0, 0, 4, 0, 0}) == Vec3{0, 0, 1});
  CHECK(*detail::plane_normal(4, {0, 0, 0}, {4, 0, 0, 0, 0, 4}) == Vec3{0, 1, 0});
  CHECK(*detail::plane_normal(4, {0, 0, 0}, {0, 0, 0, 4, 0, 4}) == Vec3{1, 0, 0});
}

TEST_CASE("no plane is fitted through points on one line or in one place") {
  CHECK_FALSE(detail::plane_normal(2, {1, 1, 0}, {1, 0, 0, 1, 0, 0}));
  CHECK_FALSE(detail::plane_normal(3, {0, 0, 0}, {}));
  CHECK_FALSE(detail::plane_normal(5, {5, 10, 15}, {5, 10, 15, 20, 30, 45}));  // five times (1, 2, 3)
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const Vec3 start = random.point(1), along = random.unit();
    std::vector<Vec3> line;
    for (int i = 0; i < 20; ++i) line.push_back(start + along * random.uniform(-1, 1));
    const PointCloud cloud = read(text_of(line), {.voxel_size = 100, .normals = VoxelNormals::fitted});
    CHECK(cloud.voxels.normals == std::vector<std::array<float, 3>>{{0, 0, 0}});
  }
}

TEST_CASE("normals of the file are averaged as directions") {
  const std::string text =
      "0 0 0 0 0 2\n0.5 0.5 0.5 1e-9 0 0\n2 0 0 0 3 0\n2.5 0 0 0 -1e300 0\n4 4 4 0 0 0\n4.5 4 4 0 -1 0\n";
  const FileError e = error(text, {.normals = VoxelNormals::mean});
  CHECK(e.place() == "line 4, column 5");  // beyond 1e12
  const PointCloud cloud =
      read("0 0 0 0 0 2\n0.5 0.5 0.5 1e-9 0 0\n2 0 0 0 3 0\n2.5 0 0 0 -1e11 0\n4 4 4 0 0 0\n4.5 4 4 0 -1 0\n",
           {.normals = VoxelNormals::mean});
  REQUIRE(cloud.voxels.normals.size() == 3);
  CHECK(same(cloud.voxels.normals[0], normalize(Vec3{1, 0, 1})));
  CHECK(cloud.voxels.normals[1] == std::array<float, 3>{0, 0, 0});  // they oppose each other
  CHECK(same(cloud.voxels.normals[2], {0, -1, 0}));                 // a zero does not count
  REQUIRE(cloud.warnings.size() == 2);
  CHECK(cloud.warnings[0].find("has a normal of length 2 in the columns from 4 on: expected about 1") !=
        std::string::npos);
  CHECK(cloud.warnings[1] == "1 of 3 voxels have no normal: the normals of their points are zero, or cancel");
}

TEST_CASE("the normal may be that of the point nearest to the centre, of those that have one") {
  const PointCloud cloud = read("0 0 0 1 0 0\n0.5 0.5 0.5 0 0 0\n0.6 0.5 0.5 0 -5 0\n0.9 0.5 0.5 0 0 1\n2 2 2 0 0 1\n",
                                {.normals = VoxelNormals::nearest});
  REQUIRE(cloud.voxels.normals.size() == 2);
  CHECK(same(cloud.voxels.normals[0], {0, -1, 0}));
  CHECK(same(cloud.voxels.normals[1], {0, 0, 1}));
}

TEST_CASE("a file without normals or colours gives none, with a warning, or the default") {
  const PointCloud bare = read("0 0 0\n2 2 2\n", {.normals = VoxelNormals::mean, .colours = true});
  CHECK(bare.voxels.normals.empty());
  CHECK(bare.colours.empty());
  REQUIRE(bare.warnings.size() == 2);
  CHECK(bare.warnings[0].ends_with("a.xyz: has no normals: no voxel gets one from a file"));
  CHECK(bare.warnings[1].ends_with("a.xyz: has no colours: no voxel gets one"));
  const PointCloud otherwise = read("0 0 0\n2 2 2\n", {.normals = VoxelNormals::mean, .default_normal = Vec3{0, 3, 4}});
  REQUIRE(otherwise.voxels.normals.size() == 2);
  CHECK(same(otherwise.voxels.normals[1], {0, 0.6, 0.8}));
}

TEST_CASE("colours are averaged as squares") {
  const PointCloud cloud =
      read("0 0 0 0 0 1 255 0 51\n0.5 0 0 0 0 1 0 0 51\n2 0 0 0 0 1 102 255 0\n", {.colours = true});
  REQUIRE(cloud.colours.size() == 2);
  CHECK(cloud.colours[0][0] == doctest::Approx(std::sqrt(0.5)));
  CHECK(cloud.colours[0][1] == 0);
  CHECK(cloud.colours[0][2] == 0.2f);
  CHECK(cloud.colours[1] == std::array<float, 3>{0.4f, 1, 0});
  CHECK(read("0 0 0 0.5 1 0.25\n",
             {.colours = true, .colour_max = 1, .columns = {.colour = TextPointColumns::Columns{3, 4, 5}}})
            .colours == std::vector<std::array<float, 3>>{{0.5f, 1, 0.25f}});
  CHECK(error("0 0 0 0 0 1 0 0 0\n0 0 0 0 0 1 256 0 0\n", {.colours = true}).place() == "line 2");
  CHECK(error("0 0 0 0 0 1 0 -1 0\n", {.colours = true}).problem() == "has the colour -1: expected one from 0 to 255");
}

TEST_CASE("a LAS file is recognised as it begins, and gives the same voxels as its text") {
  LasBuilder las{.minor = 2, .format = 2, .scale = {0.25, 0.25, 0.25}, .offset = {100, 0, 0}};
  las.points = {{{0, 0, 0}, {65535, 0, 0}}, {{2, 2, 2}, {0, 0, 65535}}, {{10, 10, 10}, {13107, 0, 0}}};
  const PointCloud cloud = read(las.bytes(), {.colours = true});
  const PointCloud text = read("100 0 0\n100.5 .5 .5\n102.5 2.5 2.5\n");
  CHECK(cloud.points == 3);
  CHECK(cloud.voxels.corner == text.voxels.corner);
  CHECK(cloud.voxels.cells == text.voxels.cells);
  REQUIRE(cloud.colours.size() == 2);
  CHECK(cloud.colours[1] == std::array<float, 3>{0.2f, 0, 0});
  CHECK(cloud.warnings.empty());
  for (auto& point : las.points)
    for (auto& channel : point.colour) channel = static_cast<std::uint16_t>(channel / 257);
  CHECK(read(las.bytes(), {.colours = true}).warnings ==
        std::vector<std::string>{"no colour exceeds 255 of 65535: for colours up to 255, the maximum should be 255"});
  CHECK(read("x,y,z,r,g,b\n0,0,0,0.5,0.25,1\n", {.colours = true}).warnings ==
        std::vector<std::string>{"no colour exceeds 1 of 255: for colours up to 1, the maximum should be 1"});
  const PointCloud bytes = read(las.bytes(), {.colours = true, .colour_max = 255});
  CHECK(bytes.colours == cloud.colours);
  CHECK(bytes.warnings.empty());
  las.format = 1;
  CHECK(read(las.bytes(), {.normals = VoxelNormals::nearest, .colours = true}).warnings.size() == 2);
  CHECK(error(las.bytes().substr(0, 250)).place() == "byte 107");
}

TEST_CASE("a voxel has the most frequent class and object of its points, or the lowest of these") {
  LasBuilder las{.minor = 4, .format = 6, .scale = {1, 1, 1}, .extra = 2};
  las.more = {{"LASF_Spec", 4, LasBuilder::descriptor("ObjectId", 3)}};
  const auto add = [&](std::int32_t x, unsigned kind, const char* object) {
    las.points.push_back({.stored = {x, 0, 0}, .kind = kind, .extra = std::string(object, 1) + '\0'});
  };
  add(0, 5, "b");
  add(0, 2, "a");
  add(0, 5, "a");
  add(9, 3, "d");
  add(9, 2, "c");
  const PointCloudSettings settings{.classes = true, .objects = true};
  const PointCloud cloud = read(las.bytes(), settings);
  CHECK(cloud.classes == std::vector<std::uint32_t>{5, 2});
  CHECK(cloud.objects == std::vector<std::uint32_t>{'a', 'c'});
  CHECK(read(las.bytes()).classes.empty());
  las.more.clear();
  CHECK(read(las.bytes(), settings).objects.empty());
  const PointCloud text = read("0 0 0\n", settings);
  CHECK(text.classes.empty());
  CHECK(text.warnings.empty());
}

TEST_CASE("LAS, LAZ and COPC files of ours give the same voxels") {
  constexpr std::uint64_t seed = 11;
  CAPTURE(seed);
  support::Generator random(seed);
  std::vector<Shot> shots;
  std::vector<Echo> echoes;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    shots.push_back({.index = i,
                     .tick = Tick::of(i, 1e4),
                     .origin = Vec3{477000, 5429000, 100} + random.point(5),
                     .direction = {0, 0, -1},
                     .first_echo = i,
                     .echoes = 1});
    echoes.push_back({.range = 0,
                      .amplitude = 1e-9,
                      .reflectance = 0.3,
                      .object = ObjectId(random.whole(5)),
                      .classification = static_cast<std::uint16_t>(random.whole(4)),
                      .number = 1});
  }
  const TemporaryFolder folder;
  const auto write = [&](auto writer) {
    writer(EchoBatch{shots, echoes, {}, 0});
    writer.close();
  };
  write(LasWriter(folder / "a.las"));
  write(LazWriter(folder / "a.laz"));
  write(CopcWriter(folder / "a.copc.laz"));
  write(LasWriter(folder / "old.las", {.format = LasFormat::las_1_0}));
  const auto voxels = [&](const char* name) {
    const PointCloud cloud = read_point_cloud(folder / name, {.classes = true, .objects = true});
    CHECK(cloud.points == 3000);
    CHECK(cloud.warnings.empty());
    std::map<Cell, std::array<std::uint32_t, 2>> all;
    for (std::size_t i = 0; i < cloud.voxels.cells.size(); ++i)
      all[cloud.voxels.cells[i]] = {cloud.classes[i], cloud.objects[i]};
    return std::pair(cloud.voxels.corner, all);
  };
  const auto expected = voxels("a.las");
  CHECK(expected.second.size() > 900);
  CHECK(voxels("a.laz") == expected);
  CHECK(voxels("a.copc.laz") == expected);
  CHECK(voxels("old.las") == expected);
}

TEST_CASE("PLY, PTX and texts with a row of names are recognised, and give the same voxels as a plain text") {
  const PointCloud plain = read("100 0 0 0 0 1 255 0 0\n100.5 .5 .5 0 0 1 0 0 51\n102.5 2.5 2.5 0 0 1 51 0 0\n",
                                {.normals = VoxelNormals::mean, .colours = true});
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "end_header\n255 0 0 100 0 0 0 0 1\n0 0 51 100.5 .5 .5 0 0 1\n51 0 0 102.5 2.5 2.5 0 0 1\n";
  const std::string named =
      "z;y;x;B;G;R;normal_x;normal_y;normal_z\n0;0;100;0;0;255;0;0;1\n.5;.5;100.5;51;0;0;0;0;1\n"
      "2.5;2.5;102.5;0;0;51;0;0;1\n";
  const std::string ptx =
      "2\n2\n100 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n100 0 0 1\n0.00001 0 0 1 255 0 0\n0 0 0 1 9 9 9\n"
      ".5 .5 .5 1 0 0 51\n2.5 2.5 2.5 1 51 0 0\n";
  for (const std::string& text : {ply, named, ptx}) {
    CAPTURE(text);
    const bool has_normals = text != ptx;
    const PointCloud cloud =
        read(text, {.normals = has_normals ? VoxelNormals::mean : VoxelNormals::none, .colours = true});
    CHECK(cloud.points == 3);
    CHECK(cloud.voxels.cells == plain.voxels.cells);
    CHECK(cloud.colours == plain.colours);
    CHECK((!has_normals || cloud.voxels.normals == plain.voxels.normals));
    CHECK(cloud.warnings.empty());
  }
}

TEST_CASE("several files make one cloud") {
  const TemporaryFolder folder;
  const auto a = put(folder, "0 0 0 0 0 1\n", "a.xyz"), b = put(folder, "5 5 5 1 0 0\n0.5 0 0 1 0 0\n", "b.xyz");
  const PointCloud cloud = read_point_cloud(std::vector{a, b}, {.normals = VoxelNormals::mean});
  CHECK(cloud.points == 3);
  CHECK(cloud.voxels.cells == std::vector<Cell>{{0, 0, 0}, {4, 4, 4}});
  CHECK(same(cloud.voxels.normals[0], normalize(Vec3{1, 0, 1})));
  const auto c = put(folder, LasBuilder{.format = 0, .points = {{.stored = {1000, 0, 0}}}}.bytes(), "c.las");
  const PointCloud mixed = read_point_cloud(std::vector{a, c});
  CHECK(mixed.voxels.cells == std::vector<Cell>{{0, 0, 0}, {9, 0, 0}});
  CHECK_THROWS_AS((void)read_point_cloud(std::vector<std::filesystem::path>{}), SettingError);
  CHECK_THROWS_WITH_AS((void)read_point_cloud(std::vector{a, folder / "none"}),
                       doctest::Contains("none: does not exist: expected a point cloud"), FileError);
}

/// The same from a cloud that is held: points by cell.
std::map<Cell, std::vector<std::size_t>> by_cell(const std::vector<Vec3>& points, double edge, const Vec3& least,
                                                 const Vec3& most) {
  std::map<Cell, std::vector<std::size_t>> cells;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
      const double n = std::max(1.0, std::ceil((most[axis] - least[axis]) / edge));
      cell[static_cast<std::size_t>(axis)] =
          static_cast<std::uint32_t>(std::min(std::floor((points[i][axis] - least[axis]) / edge), n - 1));
    }
    cells[cell].push_back(i);
  }
  return cells;
}

TEST_CASE("random clouds give what a cloud in memory gives") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const double reach = random.log_uniform(1e-2, 1e4), edge = reach * random.log_uniform(0.05, 3);
    const Vec3 place = random.coin() ? Vec3{477000, 5429000, 100} : Vec3{0, 0, 0};
    std::vector<Vec3> points, normals, colours;
    Vec3 least(1e300), most(-1e300);
    for (std::uint64_t i = 0; i < 500; ++i) {
      points.push_back(place + random.point(reach));
      normals.push_back(random.unit() * random.log_uniform(1e-3, 1e3));
      colours.push_back({random.uniform(0, 255), random.uniform(0, 255), double(random.whole(256))});
      least = min(least, points.back());
      most = max(most, points.back());
    }
    const auto expected = by_cell(points, edge, least, most);
    const std::string text = text_of(points, normals, colours);
    const auto number_of = [&](const PointCloud& cloud) {
      std::map<Cell, std::size_t> numbers;
      for (std::size_t i = 0; i < cloud.voxels.cells.size(); ++i) numbers[cloud.voxels.cells[i]] = i;
      return numbers;
    };

    const PointCloud mean = read(text, {.voxel_size = edge, .normals = VoxelNormals::mean, .colours = true});
    const PointCloud nearest = read(text, {.voxel_size = edge, .normals = VoxelNormals::nearest});
    const PointCloud fitted =
        read(text, {.voxel_size = edge, .normals = VoxelNormals::fitted, .default_normal = Vec3{1, 0, 0}});
    CHECK(mean.voxels.corner == least);
    const auto numbers = number_of(mean);
    REQUIRE(numbers.size() == expected.size());
    REQUIRE(mean.voxels.cells.size() == expected.size());
    REQUIRE(nearest.voxels.cells == mean.voxels.cells);
    REQUIRE(fitted.voxels.cells == mean.voxels.cells);
    std::size_t wrong = 0;
    for (const auto& [cell, members] : expected) {
      const auto found = numbers.find(cell);
      REQUIRE(found != numbers.end());
      const Vec3 centre = least + (Vec3{double(cell[0]), double(cell[1]), double(cell[2])} + 0.5) * edge;
      Vec3 sum{}, squares{}, closest{};
      double distance = 1e300;
      Eigen::Matrix3Xd matrix(3, members.size());
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (std::size_t k = 0; k < members.size(); ++k) {
        const std::size_t i = members[k];
        sum += normalize(normals[i]);
        squares += colours[i] * colours[i] / (255.0 * 255.0);
        if (length(points[i] - centre) < distance) {
          distance = length(points[i] - centre);
          closest = normalize(normals[i]);
        }
        const Vec3 d = points[i] - least;
        matrix.col(static_cast<Eigen::Index>(k)) = Eigen::Vector3d(d.x, d.y, d.z);
        middle += matrix.col(static_cast<Eigen::Index>(k)) / static_cast<double>(members.size());
      }
      wrong += !same(mean.voxels.normals[found->second], normalize(sum));
      wrong += !same(nearest.voxels.normals[found->second], closest);
      for (std::size_t k = 0; k < 3; ++k) {
        const double colour = std::sqrt(squares[static_cast<int>(k)] / static_cast<double>(members.size()));
        wrong += std::fabs(mean.colours[found->second][k] - colour) > 1e-7;
      }
      const Vec3 fit = vector(fitted.voxels.normals[found->second]);
      if (members.size() < 3) {
        wrong += fit != Vec3{1, 0, 0};
        continue;
      }
      matrix.colwise() -= middle;
      const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(matrix, Eigen::ComputeFullU);
      const Eigen::Vector3d least_vector = svd.matrixU().col(2);
      const double second = svd.singularValues()[1], third = members.size() > 3 ? svd.singularValues()[2] : 0;
      if (second - third < 1e-2 * second) continue;  // any of many planes fits as well
      wrong += 1 - std::fabs(fit.x * least_vector.x() + fit.y * least_vector.y() + fit.z * least_vector.z()) > 1e-7;
      wrong += fit.z < 0;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("a cloud is read in blocks without a seam") {
  constexpr std::uint64_t seed = 9;
  CAPTURE(seed);
  support::Generator random(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < 40000; ++i) points.push_back(random.point(10));
  const std::string text = text_of(points);
  REQUIRE(text.size() > 2 * InputFile::block_size);
  Vec3 least(1e300), most(-1e300);
  for (const Vec3& p : points) {
    least = min(least, p);
    most = max(most, p);
  }
  const PointCloud cloud = read(text, {.voxel_size = 0.75});
  CHECK(cloud.points == points.size());
  CHECK(cloud.voxels.cells.size() == by_cell(points, 0.75, least, most).size());
}

TEST_CASE("clouds that cannot be are refused") {
  CHECK(error("ply\nformat ascii 1.0\n").problem().ends_with("its PLY header has no end_header within 64 KiB"));
  CHECK(error("# .PCD v0.7\nVERSION 0.7\n").problem().starts_with("is a PCD file"));
  CHECK(error("").problem() == "is empty: expected a point cloud");
  CHECK(error("# x y z\n").problem() == "holds no point: expected at least one");
  CHECK(error("1 2 3\n1 nan 3\n").place() == "line 2, column 2");
  CHECK(error("1 2 3\n1 nan 3\n").path().ends_with("a.xyz"));
  const FileError far = error("0 0 0\n0 1e12 0\n", {.voxel_size = 0.125});
  CHECK(far.problem() ==
        "the cloud extends over 1e+12 m along y, which is 8e+12 voxels: expected no more than 2^32; voxels are 0.125 m "
        "large");
  CHECK(error("0 0 0\n1 0 0\n", {.voxel_size = 1e-320}).problem() != "no error");
  CHECK(error("1 0 0\n1 0 0\n", {.voxel_size = 1e-320, .lattice = VoxelLattice::at_multiples}).problem() != "no error");
  CHECK(error(LasBuilder{.format = 0, .points = {{.withheld = true}}}.bytes()).problem() ==
        "holds no point: expected at least one");
}

TEST_CASE("as many voxels as there can be along an axis fit, one more does not") {
  const PointCloud cloud = read("0 0 0\n4294967296 0 0\n");
  CHECK(cloud.voxels.cells == std::vector<Cell>{{0, 0, 0}, {4294967295, 0, 0}});
  CHECK(error("0 0 0\n4294967296.5 0 0\n").problem().starts_with("the cloud extends over 4294967296.5 m along x"));
  CHECK(error("0 0 0\n4294967296 0 0\n", {.lattice = VoxelLattice::at_multiples})
            .problem()
            .starts_with("the cloud extends over"));
}

TEST_CASE("voxels that are small against the rounding of coordinates are an error of the file") {
  const std::string far =
      "\xEF\xBB\xBF"
      "1;2;-1e12\n";
  CHECK(error(far, {.voxel_size = 1e-6})
            .problem()
            .starts_with("the cloud begins 1e+12 m from the origin, where voxels of 1e-06 m"));
  CHECK(read(far, {.voxel_size = 1e-3}).voxels.cells.size() == 1);
}

TEST_CASE("settings that cannot be are refused") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const PointCloudSettings& settings : {PointCloudSettings{.voxel_size = 0},
                                             {.voxel_size = -1},
                                             {.voxel_size = nan},
                                             {.voxel_size = 2e12},
                                             {.default_normal = Vec3{0, 0, 0}},
                                             {.default_normal = Vec3{0, nan, 0}},
                                             {.default_normal = Vec3{nan, 0, 1}},
                                             {.colour_max = 0},
                                             {.columns = {.separators = "e"}},
                                             {.columns = {.position = {0, 1, 5000}}}})
    CHECK_THROWS_AS((void)read("0 0 0\n", settings), SettingError);
}

}  // namespace
}  // namespace pulsecast::io
