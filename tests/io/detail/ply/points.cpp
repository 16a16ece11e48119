// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/ply/points.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/detail/text/points.hpp>

#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/ply_builder.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::contains;
using support::ply_triangle;
using support::PlyBuilder;

struct Read {
  std::vector<Vec3> positions, normals, colours;
  std::vector<std::uint32_t> classes, objects;
  double max_colour = 0;
  std::vector<std::string> warnings;
};

template <class Points>
Read all_of(Points points) {
  Read result;
  while (points.next()) {
    result.positions.push_back(points.position());
    if (points.has_normals()) result.normals.push_back(points.normal());
    if (points.has_colours()) result.colours.push_back(points.colour());
    if (points.has_class()) result.classes.push_back(points.classification());
    if (points.has_object()) result.objects.push_back(points.object());
  }
  result.max_colour = points.max_colour;
  result.warnings = points.warnings();
  return result;
}

Read read(const std::string& bytes) {
  const support::TemporaryFolder folder;
  return all_of(PlyPoints(InputFile(folder.write("a.ply", bytes), "a point cloud")));
}
FileError error(const std::string& bytes) {
  return support::file_error([&] { (void)read(bytes); });
}

/// A file of points with these properties.
PlyBuilder points_of(const std::vector<std::string>& properties, const std::vector<std::vector<double>>& rows) {
  return {.elements = {{"vertex", properties, rows}}};
}
const std::array<std::string, 3> formats{"ascii", "binary_little_endian", "binary_big_endian"};

TEST_CASE("a normal with a component that is no number is no normal") {
  for (const char* const row : {"nan 0 1", "0 nan 1", "0 0 nan", "inf 0 0", "0 1e13 0"}) {
    const Read all = read(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float nx\nproperty float ny\n"
        "property float nz\nproperty float x\nproperty float y\nproperty float z\nend_header\n" +
        std::string(row) + " 1 2 3\n");
    CHECK_MESSAGE(all.normals == std::vector<Vec3>{Vec3{}}, row);
  }
}

TEST_CASE("points of a PLY file have normals, colours, classes and objects by the names of properties") {
  for (const std::string& format : formats) {
    CAPTURE(format);
    const Read all =
        read(points_of({"uchar scalar_Classification", "float nx", "float ny", "float nz", "uchar red", "uchar green",
                        "uchar blue", "double x", "double y", "double z", "list uchar int near", "int object"},
                       {{6, 0, 0, 1, 255, 128, 0, 500'000.125, 5'400'000.25, 7, 0, 42},
                        {2, 1, 0, 0, 1, 2, 3, 500'001.125, 5'400'001.25, 8, 2, 5, 6, 43}})
                 .bytes(format));
    CHECK(all.positions == std::vector<Vec3>{{500'000.125, 5'400'000.25, 7}, {500'001.125, 5'400'001.25, 8}});
    CHECK(all.normals == std::vector<Vec3>{{0, 0, 1}, {1, 0, 0}});
    CHECK(all.colours == std::vector<Vec3>{{255, 128, 0}, {1, 2, 3}});
    CHECK(all.classes == std::vector<std::uint32_t>{6, 2});
    CHECK(all.objects == std::vector<std::uint32_t>{42, 43});
    CHECK(all.max_colour == 255);
    CHECK(all.warnings.empty());
  }
}

TEST_CASE("the largest colour is that of the type, classes that are none are 0, and invalid points are left out") {
  const auto colour_of = [](const std::string& type) {
    return read(points_of({"float x", "float y", "float z", type + " r", type + " g", type + " b", "float class"},
                          {{1, 2, 3, 1, 0, 1, -1}})
                    .bytes("binary_big_endian"));
  };
  CHECK(colour_of("ushort").max_colour == 65535);
  CHECK(colour_of("float").max_colour == 1);
  CHECK(colour_of("float").classes == std::vector<std::uint32_t>{0});
  const double nan = std::nan("");
  for (const std::string& format : formats) {
    const Read some = read(
        points_of({"float x", "float y", "float z"}, {{nan, nan, nan}, {1, 2, 3}, {1, INFINITY, 1}}).bytes(format));
    CHECK(some.positions == std::vector<Vec3>{{1, 2, 3}});
    REQUIRE(some.warnings.size() == 1);
    CHECK(some.warnings[0].ends_with("a.ply: 2 points that are not finite are left out"));
  }
  CHECK(contains(error(points_of({"double x", "double y", "double z"}, {{1e13, 0, 0}}).bytes()).problem(),
                 "beyond 1e12"));
}

TEST_CASE("files without points are explained") {
  PlyBuilder ply = ply_triangle();
  ply.elements.erase(ply.elements.begin());
  CHECK(error(ply.bytes()).problem() == "has no element vertex: expected the points of a cloud");
  CHECK(
      contains(error(points_of({"float x", "float y"}, {{1, 2}}).bytes()).problem(), "has vertices without x, y or z"));
  CHECK(error("ply\nformat ascii 1.0\nend_header\n").problem() ==
        "has no element vertex: expected the points of a cloud");
}

TEST_CASE("each row of the rules for points of PLY files is kept") {
  const auto with_element = [](const PlyBuilder::Element& one, bool first = false) {
    return [=] {
      PlyBuilder ply = ply_triangle();
      ply.elements.pop_back();
      ply.elements.insert(first ? ply.elements.begin() : ply.elements.end(), one);
      const Read all = read(ply.bytes("binary_little_endian"));
      CHECK(all.positions.size() == 3);
      return all.warnings;
    };
  };
  const auto with_remark = [](const std::string& remark) {
    return [=] {
      PlyBuilder ply = ply_triangle();
      ply.elements.pop_back();
      ply.remarks = remark + "\n";
      return read(ply.bytes()).warnings;
    };
  };
  const std::vector<test::FormatCase> cases{
      {"vertex", with_remark("comment by hand")},
      {"face", with_element({"face", {"list uchar int vertex_indices"}, {{3, 0, 1, 2}}}, true)},
      {"tristrips", with_element({"tristrips", {"list int int vertex_indices"}, {{3, 0, 1, 2}}})},
      {"range_grid", with_element({"range_grid", {"list uchar int vertex_indices"}, {{1, 0}, {0}}}, true)},
      {"camera", with_element({"camera", {"float view_px"}, {{5}}})},
      {"comment offset", with_remark("comment offset 1 2 3")},
      {"comment transform*", with_remark("obj_info transform 1 2 3")},
      {"comment scale*", with_remark("obj_info scale 0.001")},
      {"comment up", with_remark("comment up axis: Y")},
      {"comment up_axis", with_remark("comment up_axis Y")},
      {"comment unit*", with_remark("comment Units: feet")},
      {"comment crs", with_remark("comment crs: EPSG:4326")},
      {"comment epsg*", with_remark("comment EPSG:4326")},
      {"comment srs", with_remark("comment srs WGS 84")},
      {"*", with_element({"flower", {"float petals"}, {{5}}}, true)}};
  test::check_rules(detail::ply_cloud_rules, cases);
}

TEST_CASE("each column of points has an effect in PLY files and in texts with a row of names, by all its names") {
  const std::vector<std::vector<std::string>> names{{"x"},
                                                    {"y"},
                                                    {"z"},
                                                    {"nx", "normal_x"},
                                                    {"ny", "normal_y"},
                                                    {"nz", "normal_z"},
                                                    {"red", "r", "diffuse_red"},
                                                    {"green", "g", "diffuse_green"},
                                                    {"blue", "b", "diffuse_blue"},
                                                    {"classification", "class", "label", "scalar_Classification"},
                                                    {"object", "object_id", "instance"}};
  std::vector<test::FormatCase> cases;
  for (std::size_t row = 0; row < names.size(); ++row)
    cases.push_back(
        {names[row][0], [&, row] {
           for (const std::string& name : names[row]) {
             // all columns in reverse order, with the number of their rows
             PlyBuilder ply = points_of({}, {{}});
             std::string text;
             for (std::size_t k = names.size(); k-- > 0;) {
               ply.elements[0].properties.push_back("float " + (k == row ? name : names[k][0]));
               ply.elements[0].rows[0].push_back(static_cast<double>(k));
               text += (text.empty() ? "" : ";") + (k == row ? name : names[k][0]);
             }
             text += "\n10;9;8;7;6;5;4;3;2;1;0\n";
             const support::TemporaryFolder folder;
             const InputFile file(folder.write("a.txt", text), "a point cloud");
             for (const Read& all :
                  {read(ply.bytes()), all_of(TextPoints(InputFile(folder / "a.txt", "a point cloud"), {}))}) {
               CHECK(all.positions == std::vector<Vec3>{{0, 1, 2}});
               CHECK(all.normals == std::vector<Vec3>{{3, 4, 5}});
               CHECK(all.colours == std::vector<Vec3>{{6, 7, 8}});
               CHECK(all.classes == std::vector<std::uint32_t>{9});
               CHECK(all.objects == std::vector<std::uint32_t>{10});
             }
           }
           return std::vector<std::string>{};
         }});
  for (const char* degrees : {"lat*", "lon*"})
    cases.push_back(
        {degrees, [=] {
           PlyBuilder ply = points_of({}, {{1, 2, 3}});
           ply.elements[0].properties = {"float " + std::string(degrees, 3) + "itude", "float y", "float z"};
           return read(ply.bytes()).warnings;
         }});
  test::check_rules(detail::point_rules, cases);
}

}  // namespace
}  // namespace pulsecast::io
