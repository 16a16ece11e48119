// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/obj.hpp>

#include <clocale>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <locale>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/random.hpp>
#include <pulsecast/io/detail/obj/reader.hpp>
#include "support/allocations.hpp"
#include "support/data_folder.hpp"
#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/sanitized.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using support::contains;

namespace {

/// A folder for the files of one test.
class Folder : public support::TemporaryFolder {
 public:
  ObjModel obj(const std::string& text, const ObjSettings& settings = {}) const {
    return read_obj(write("a.obj", text), settings);
  }

  /// The error of an OBJ file with this text.
  FileError error(const std::string& text) const {
    return support::file_error([&] { (void)obj(text); });
  }
};

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

double area(const MeshData& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += 0.5 * length(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]));
  return sum;
}

/// Twice the area with the sense of the outline: a triangulation without overlaps has the outline's own.
Vec3 vector_area(const MeshData& mesh) {
  Vec3 sum{};
  for (const auto& [a, b, c] : mesh.triangles)
    sum += cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
  return sum;
}

std::string polygon(const std::vector<Vec3>& outline) {
  std::string vertices, face = "f";
  for (std::size_t i = 0; i < outline.size(); ++i) {
    char line[128];
    std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", outline[i].x, outline[i].y, outline[i].z);
    vertices += line;
    face.append(" ").append(std::to_string(i + 1));
  }
  return vertices + face + "\n";
}

}  // namespace

TEST_CASE("statements of an OBJ file are read, noted and refused by the rules") {
  const Folder folder;
  const std::string faces = corners + "f 1 2 3\n";
  const auto with = [&](const std::string& more, std::size_t notes = 0, std::size_t triangles = 2) {
    return test::FormatCase{"", [=, &folder] {
                              const ObjModel model = folder.obj(faces + more + "\nf 1 2 3\n");
                              CHECK(model.mesh.triangles.size() == triangles);
                              CHECK(model.warnings.size() == notes);
                              return model.warnings;
                            }};
  };
  std::vector<test::FormatCase> cases{{"usemtl", with("usemtl a", 1).warnings_of},
                                      {"mtllib", with("mtllib none.mtl", 1).warnings_of},
                                      {"f", with("f 1 2 3 4", 0, 4).warnings_of}};
  for (const std::string_view name : {"vn", "vt", "o", "g", "s"})
    cases.push_back({name, with(std::string(name) + " 1 0 0").warnings_of});
  for (const std::string_view name :
       {"fo", "l", "p", "surf", "lod", "shadow_obj", "trace_obj", "maplib", "usemap", "call", "csh"})
    cases.push_back({name, with(std::string(name) + " 1 2 3", 1).warnings_of});
  const std::initializer_list<std::pair<std::string_view, const char*>> others{
      {"v", "v 0 0 0 1"},
      {"v x y z r g b", "v 0 0 0 0.1 0.2"},
      {"v x y z w", "v 0 0 0 0.5"},
      {"curv*", "curv2 1 2"},
      {"f without area", "f 1 1 2"},
      {"f that crosses itself", "f 1 3 2 4"},
      {"# unit", "# File units = inches"},
      {"# offset", "# Global shift: -500000 0 0"},
      {"*", "cstype bezier"}};
  for (const auto& [name, line] : others)
    cases.push_back({name, with(line, name == "v" ? 0 : 1, name.starts_with("f that") ? 4 : 2).warnings_of});
  cases.push_back({"cut line", [&] { return folder.obj(corners + "f 1 2 3").warnings; }});
  test::check_rules(io::detail::obj_rules, cases);
  CHECK(with("# This file uses centimeters as units for non-parametric coordinates.", 1).warnings_of().size() == 1);
  CHECK(
      with("# File units = meters\n# 3 vertices, no shift\n# a unit\nv 0 0 0 1 0.1 0.2 0.3", 1).warnings_of().size() ==
      1);
  CHECK(contains(folder.obj(faces + "l 1 2\np 1\nl 2 3\n").warnings.at(0),
                 "line 6: 'l 1 2': lines, points and curves have no area and are left out, the first of 3"));
}

TEST_CASE("lines that end in CR alone are told, in OBJ and in MTL files") {
  CHECK(contains(Folder().error("v 0 0 0\rv 1 0 0\rv 1 1 0\rf 1 2 3\r").problem(), "lines that end in CR alone"));
  CHECK(contains(Folder().error("# a\rv 0 0 0\r\nf 1 2 3\n").problem(), "lines that end in CR alone"));
  CHECK(Folder().obj(corners + "f 1 2 3\r\r\nf 1 2 4\r").mesh.triangles.size() == 2);
  const Folder folder;
  folder.write("a.mtl", "newmtl a\rKd 1 1 1\r");
  CHECK(contains(folder.error("mtllib a.mtl\n" + corners + "f 1 2 3\n").problem(), "lines that end in CR alone"));
}

TEST_CASE("a triangle is read as it stands") {
  const ObjModel model = Folder().obj("v 1.5 -2 3e1\nv +4 5 6\nv 7 8 9.25\nf 1 2 3\n");
  REQUIRE(model.mesh.triangles.size() == 1);
  CHECK(model.mesh.vertices == std::vector<Vec3>{{1.5, -2, 30}, {4, 5, 6}, {7, 8, 9.25}});
  CHECK(model.mesh.triangles[0] == std::array<std::uint32_t, 3>{0, 1, 2});
  CHECK(model.mesh.materials == std::vector<std::uint32_t>{0});
  CHECK(model.warnings.empty());
}

TEST_CASE("UTM coordinates keep every digit") {
  const ObjModel model =
      Folder().obj("v 477123.456789 5429000.1234567 101.5\nv 477124 5429000 101\nv 477123 5429001 101\nf 1 2 3\n");
  CHECK(length(model.mesh.vertices[0] - Vec3{477123.456789, 5429000.1234567, 101.5}) < 1e-8);
}

TEST_CASE("a number is all of its word") {
  const Folder folder;
  for (const char* word : {"+1.5e-1", "-.5", "+.5", "5.", "5.e2", "1E3", "-0", "0001", "123456789.123456789", "1e-300",
                           "12345678901234567e-5"}) {
    CAPTURE(word);
    CHECK(folder.obj("v " + std::string(word) + " 0 0\n" + corners + "f 2 3 4\n").mesh.vertices[0].x ==
          doctest::Approx(std::strtod(word, nullptr)).epsilon(1e-14));
  }
  for (const std::string& word :
       {std::string("+"), std::string("-"), std::string("."), std::string("1,5"), std::string("1.5x"),
        std::string("0x10"), std::string("1e"), std::string("e5"), std::string("1e999"), std::string("--1"),
        std::string("+-1"), std::string("1e5e5"), '1' + std::string(400, '0') + "e-500"}) {
    CAPTURE(word);
    CHECK(folder.error("v 0 " + word + " 0\n" + corners + "f 2 3 4\n").place() == "line 1");
  }
}

TEST_CASE("random numbers are read as the standard library reads them") {
  const Folder folder;
  std::string text;
  std::vector<double> expected;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    const double magnitude = std::pow(10, -12 + 24 * uniform({.seed = seed})),
                 sign = uniform({.seed = seed, .pulse = 1}) < 0.5 ? -1 : 1;
    char word[64];
    std::snprintf(word, sizeof word, seed % 2 == 0 ? "%.*g" : "%.*f", 1 + static_cast<int>(seed % 17),
                  sign * magnitude);
    expected.push_back(std::strtod(word, nullptr));
    text += "v " + std::string(word) + " 0 0\n";
  }
  const ObjModel model = folder.obj(text + corners + "f -4 -3 -2\n");
  for (std::size_t seed = 0; seed < expected.size(); ++seed) {
    CAPTURE(seed);
    CHECK(std::fabs(model.mesh.vertices[seed].x - expected[seed]) <= 1e-14 * std::fabs(expected[seed]));
  }
}

TEST_CASE("numbers are the same in every locale") {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const Folder folder;
  folder.write("m.mtl",
               "newmtl a\nKd 0.25 0.25 0.25\nKs 0.75 0.75 0.75\nNs 12.5\nhelios_reflectance "
               "0.125\nhelios_classification 1234\n");
  const std::string text = "mtllib m.mtl\nusemtl a\nv 1.5 2.25 1000.5\nv 4 5 6\nv 7 8 9.25\nf 1 2 3\n";
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // where it is installed, numbers have commas
  ObjModel model;
  CHECK_NOTHROW(model = folder.obj(text));
  std::setlocale(LC_ALL, "C");
  std::locale::global(before);
  REQUIRE(model.materials.size() == 1);
  CHECK(model.mesh.vertices[0] == Vec3{1.5, 2.25, 1000.5});
  CHECK(model.materials[0].law.get<Phong>()->share == 0.75);
  CHECK(model.materials[0].law.get<Phong>()->exponent == 12.5);
  CHECK(model.materials[0].reflectance == 0.125);
  CHECK(model.materials[0].classification == 1234);
}

TEST_CASE("y up is turned to z up") {
  const std::string text = "v 1 2 3\nv 4 5 6\nv 7 8 10\nf 1 2 3\n";
  const ObjModel model = Folder().obj(text, {.up = UpAxis::y});
  CHECK(model.mesh.vertices[0] == Vec3{1, -3, 2});
  // a rotation keeps the sense of triangles
  const Vec3 before = vector_area(Folder().obj(text).mesh);
  CHECK(vector_area(model.mesh) == Vec3{before.x, -before.z, before.y});
}

TEST_CASE("corners may be given in every form, and counted backwards") {
  for (const char* face : {"f 1 2 3", "f 1/7 2/8 3/9", "f 1//7 2//8 3//9", "f 1/7/4 2/8/5 3/9/6", "f -4 -3 -2",
                           "f -4/-1/-1 -3/-1/-1 -2/-1/-1", "  f\t1  2 3 ", "f 1 2 3 # a comment", "f 1 \\\n2 3",
                           "f 1 \\\r\n2 \\ \n3\\\n", "# c:\\\nf 1 2 3", "\\\nf 1 2 3", "f +1 2 3"}) {
    CAPTURE(face);
    const ObjModel model = Folder().obj("\xEF\xBB\xBF# a comment\n\nvn 0 0 1\nvt 0 0\n" + corners + face + "\r\n");
    REQUIRE(model.mesh.triangles.size() == 1);
    CHECK(model.mesh.triangles[0] == std::array<std::uint32_t, 3>{0, 1, 2});
    CHECK(model.warnings.empty());
  }
}

TEST_CASE("a convex polygon becomes the fan about its first corner") {
  const ObjModel quad = Folder().obj(corners + "f 1 2 3 4\n");
  CHECK(quad.mesh.triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}});
  std::vector<Vec3> octagon;
  for (int k = 0; k < 8; ++k)
    octagon.push_back({std::cos(k * std::numbers::pi / 4), 0.5, -std::sin(k * std::numbers::pi / 4)});
  const ObjModel model = Folder().obj(polygon(octagon));
  REQUIRE(model.mesh.triangles.size() == 6);
  for (std::uint32_t k = 0; k < 6; ++k) CHECK(model.mesh.triangles[k] == std::array<std::uint32_t, 3>{0, k + 1, k + 2});
  CHECK(area(model.mesh) == doctest::Approx(2 * std::numbers::sqrt2));
}

TEST_CASE("a concave polygon is covered once, wherever it lies and however it is turned") {
  const std::vector<Vec3> letter_l{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};  // area 3
  const std::vector<Vec3> arrow{{0, 0, 0}, {4, -2, 0}, {1, 0, 0}, {4, 2, 0}};                          // area 2, a quad
  const std::vector<Vec3> comb{{0, 0, 0}, {5, 0, 0}, {5, 2, 0}, {4, 2, 0}, {4, 1, 0}, {3, 1, 0},
                               {3, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};  // area 8
  const std::vector<Vec3> straight{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                   {2, 2, 0}, {0, 2, 0}, {0, 1, 0}};  // area 4, corners on edges
  struct Shape {
    std::vector<Vec3> outline;
    double area;
  };
  for (const Shape& shape : {Shape{letter_l, 3}, {arrow, 2}, {comb, 8}, {straight, 4}})
    for (const Vec3& offset : {Vec3{0, 0, 0}, Vec3{-5, 7, 0}, Vec3{5, -7, 3}, Vec3{477000, 5429000, 100}})
      for (const Rotation& turn : {no_rotation, rotation_about({1, 2, 3}, 1.1), rotation_about({1, 0, 0}, pi / 2),
                                   rotation_about({0, 1, 0}, 3)})
        for (std::size_t first = 0; first < shape.outline.size(); ++first) {
          CAPTURE(shape.area);
          CAPTURE(first);
          std::vector<Vec3> moved;
          for (std::size_t k = 0; k < shape.outline.size(); ++k)
            moved.push_back(turn * shape.outline[(first + k) % shape.outline.size()] + offset);
          const ObjModel model = Folder().obj(polygon(moved));
          CHECK(model.mesh.triangles.size() <= shape.outline.size() - 2);
          CHECK(area(model.mesh) == doctest::Approx(shape.area).epsilon(1e-8));
          CHECK(length(vector_area(model.mesh) - turn * Vec3{0, 0, 2 * shape.area}) < 1e-7);
        }
}

TEST_CASE("a random star-shaped polygon is covered once") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    std::vector<Vec3> outline;
    const std::size_t n = 5 + seed;
    double expected = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double radius = 0.2 + uniform({.seed = seed, .pulse = k}), angle = 2 * pi * double(k) / double(n);
      outline.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    for (std::size_t k = 0; k < n; ++k) expected += 0.5 * cross(outline[k], outline[(k + 1) % n]).z;
    const ObjModel model = Folder().obj(polygon(outline));
    CHECK(model.mesh.triangles.size() == n - 2);
    CHECK(area(model.mesh) == doctest::Approx(expected));
    CHECK(model.warnings.empty());
  }
}

TEST_CASE("a polygon that crosses itself becomes a fan, with a warning") {
  const ObjModel model = Folder().obj("v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 1 0\nv -1 0.5 0\nf 1 2 3 4 5\n");
  CHECK(model.mesh.triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
  REQUIRE(model.warnings.size() == 1);
  CHECK(contains(model.warnings[0], "line 6"));
}

TEST_CASE("faces without area, or of fewer than three corners, are left out, with one warning") {
  for (const char* flat : {"f 1 2 2\nf 1 1 1\n", "f 1 2\nf 1 1 1\n", "f 1 2 2\nf\n"}) {
    const ObjModel model = Folder().obj(corners + flat + "f 1 2 3\n");
    CHECK(model.mesh.triangles.size() == 1);
    REQUIRE(model.warnings.size() == 1);
    CHECK(contains(model.warnings[0], "line 5: a face without area is left out, the first of 2"));
  }
}

TEST_CASE("a file without a face that has an area is read, with a warning") {
  for (const char* faces : {"", "f 1 1 2\n", "f 1\n"}) {
    const ObjModel model = Folder().obj(corners + faces);
    CHECK(model.mesh.triangles.empty());
    CHECK(model.mesh.vertices.size() == 4);
    CHECK(contains(model.warnings.back(), "a.obj: holds no face with an area"));
  }
}

TEST_CASE("a file without a vertex is no OBJ file") {
  for (const char* text : {"# nothing\n", "{\n \"asset\": {\"version\": \"2.0\"}\n}\n"})
    CHECK_THROWS_WITH_AS((void)Folder().obj(text), doctest::Contains("a.obj: holds no vertex: expected an OBJ file"),
                         FileError);
}

TEST_CASE("a material or library without a name is told, and the faces are there") {
  const ObjModel model = Folder().obj("mtllib\n" + corners + "usemtl\nf 1 2 3\n");
  CHECK(model.mesh.triangles.size() == 1);
  CHECK(model.materials.at(0).name == "default");
  REQUIRE(model.warnings.size() == 2);
  CHECK(contains(model.warnings[0], "line 1: 'mtllib': other statements are left out"));
  CHECK(contains(model.warnings[1], "line 6: no MTL file describes the material 'default'"));
}

TEST_CASE("an MTL file gives reflectance, class, ground and angular law") {
  const ObjModel model = read_obj(support::data_folder / "materials.obj");
  CHECK(model.warnings.empty());
  REQUIRE(model.materials.size() == 4);
  const Material &ground = model.materials[0], &wall = model.materials[1], &shiny = model.materials[2],
                 &leaves = model.materials[3];
  CHECK(ground.name == "ground");
  CHECK(ground.reflectance == 0.5);
  CHECK(ground.ground);
  CHECK(ground.classification == 2);
  CHECK(ground.law.get<Lambert>());
  CHECK(wall.name == "wall");
  CHECK(wall.reflectance == 0.3);
  CHECK_FALSE(wall.ground);
  CHECK(wall.classification == 6);
  CHECK(shiny.name == "shiny");
  CHECK(shiny.law.get<Phong>());
  CHECK(shiny.law.get<Phong>()->share == 0.5);
  CHECK(shiny.law.get<Phong>()->exponent == 20);
  CHECK(leaves.name == "leaves");
  CHECK_FALSE(leaves.law.get<Phong>());
  CHECK(model.mesh.materials == std::vector<std::uint32_t>{0, 0, 1, 2, 2, 1, 3});
}

TEST_CASE("a material that no MTL file describes is a default one, with one warning") {
  const ObjModel model =
      Folder().obj(corners + "f 1 2 3\nusemtl nowhere\nf 1 2 3\nusemtl unused\nusemtl nowhere\nf 2 3 4\n");
  REQUIRE(model.materials.size() == 2);
  CHECK(model.materials[0].name == "default");
  CHECK(model.materials[1].name == "nowhere");
  for (const Material& m : model.materials) {
    CHECK(m.reflectance == 0.5);
    CHECK(m.law.get<DirectionIndependent>());
  }
  REQUIRE(model.warnings.size() == 1);
  CHECK(contains(model.warnings[0], "nowhere"));
  CHECK(contains(model.warnings[0], "line 6"));
}

TEST_CASE("several MTL files may be named, with blanks and with backslashes; of one name the first definition counts") {
  Folder folder;
  std::filesystem::create_directory(folder.path() / "sub");
  folder.write("two words.mtl", "newmtl a\nhelios_reflectance 0.1\n");
  folder.write("sub/m.mtl", "newmtl a\nhelios_reflectance 0.2\nnewmtl b\nhelios_reflectance 0.3\n");
  folder.write("n.mtl", "newmtl c\nhelios_reflectance 0.4\n");
  const ObjModel model = folder.obj("mtllib two words.mtl\nmtllib sub\\m.mtl n.mtl\n" + corners +
                                    "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n");
  REQUIRE(model.materials.size() == 3);
  CHECK(model.materials[0].reflectance == 0.1);
  CHECK(model.materials[1].reflectance == 0.3);
  CHECK(model.materials[2].reflectance == 0.4);
}

TEST_CASE("objects and groups are passed over; what has no area, or is unknown, is told") {
  const ObjModel model = Folder().obj("o one\ng a b\ns off\n" + corners + "f 1 2 3\no two\nl 1 2\np 1\nf 2 3 4\n");
  CHECK(model.mesh.triangles.size() == 2);
  CHECK(model.warnings.size() == 1);
  const ObjModel odd = Folder().obj(corners + "f 1 2 3\nfoo 1\nbar 2\n");
  REQUIRE(odd.warnings.size() == 1);
  CHECK(contains(odd.warnings[0], "line 6"));
  CHECK(contains(odd.warnings[0], "foo"));
}

TEST_CASE("materials whose names have blanks and signs of comments are kept apart") {
  const Folder folder;
  folder.write("m.mtl", "newmtl Material #25\nhelios_reflectance 0.1\nnewmtl Material #26\nhelios_reflectance 0.2\n");
  const ObjModel model =
      folder.obj("mtllib m.mtl # both\n" + corners + "usemtl Material #26 \nf 1 2 3\nusemtl  Material #25\nf 2 3 4\n");
  REQUIRE(model.materials.size() == 2);
  CHECK(model.materials[0].reflectance == 0.2);
  CHECK(model.materials[1].reflectance == 0.1);
  CHECK(model.warnings.empty());
}

TEST_CASE("a damaged OBJ file gives one error with its line") {
  const Folder folder;
  const struct {
    std::string text, place;
  } cases[] = {
      {"", ""},
      {"v 0 0 0\nv 1 0", "line 2"},              // cut short
      {"v 0 0 0\nv", "line 2"},                  //
      {corners + "f 1 2 3\nf 1 2", "line 6"},    //
      {corners + "f 1/1/1 2/2/2 3/", "line 5"},  //
      {corners + "f", "line 5"},                 //
      {corners + "f 0 1 2\n", "line 5"},         //
      {corners + "f 1 2 5\n", "line 5"},         //
      {corners + "f 1 2 -5\n", "line 5"},        //
      {"f 1 2 3\n" + corners, "line 1"},         //
      {corners + "f 1 2 99999999999999999999\n", "line 5"},
      {corners + "f 1 2 3x\n", "line 5"},       //
      {corners + "f 1 2 3/x\n", "line 5"},      //
      {corners + "f 1/1/1/1 2 3\n", "line 5"},  //
      {corners + "f 1 2 3 4.5\n", "line 5"},    //
      {"v nan 0 0\n", "line 1"},                //
      {"v 0 0 0\nv 0 -inf 0\n", "line 2"},      //
      {"v 0 0 0\nv 0 1e400 0\n", "line 2"},     //
      {"v 0 0 0\nv 0 1.1e12 0\n", "line 2"},    //
      {"v 0 0 \x1b 0\n", "line 1"},             //
      {"v 0 0 0\nv 0 1,5 0\n", "line 2"},       //
      {"v 0 0 0\n\n# x\nv a b c\n", "line 4"},  //
      {"v 0 0 0\\\n\nv 0 0 x\n", "line 3"},     // after a line that goes on
      {corners + std::string("f 1\0 2 3\n", 10), "line 5"},
      {std::string("\x7f"
                   "ELF\x02\x01\0\0\0",
                   9),
       "line 1"},
      {corners + "f 1 2 \\\n\\\n9\n", "line 5"},  // over three lines
  };
  for (const auto& c : cases) {
    CAPTURE(c.text);
    const FileError error = folder.error(c.text);
    CAPTURE(error.what());
    CHECK(error.path() == (folder.path() / "a.obj").string());
    CHECK(error.place() == c.place);
    CHECK_FALSE(error.problem().empty());
  }
}

TEST_CASE("a last line without an end is read, with a warning that the file may have been cut") {
  const ObjModel model = Folder().obj(corners + "f 1 2 3");
  REQUIRE(model.warnings.size() == 1);
  CHECK(contains(model.warnings[0], "line 5"));
}

TEST_CASE("a face of more corners than the limit is refused") {
  const Folder folder;
  std::string text, face = "f";
  for (int k = 1; k <= 4096; ++k) {
    text += "v " + std::to_string(k) + " " + std::to_string(k * k) + " 0\n";
    face += " " + std::to_string(k);
  }
  CHECK(folder.obj(text + face + "\n").mesh.triangles.size() == 4094);
  CHECK(folder.error(text + face + " 1\n").place() == "line 4097");
}

TEST_CASE("a file that is not there, or is a folder, is an error that names it") {
  const Folder folder;
  CHECK_THROWS_WITH_AS((void)read_obj(folder.path() / "no.obj"), doctest::Contains("no.obj: does not exist"),
                       FileError);
  CHECK_THROWS_WITH_AS((void)read_obj(folder.path()), doctest::Contains("directory"), FileError);
}

TEST_CASE("a damaged MTL file is an error with its own path and line") {
  const Folder folder;
  folder.write("m.mtl", "newmtl a\nhelios_reflectance many\n");
  const FileError error = folder.error("mtllib m.mtl\n" + corners + "f 1 2 3\n");
  CHECK(error.path() == (folder.path() / "m.mtl").string());
  CHECK(error.place() == "line 2");
  CHECK(folder.error(corners + "f 1 2 5\nmtllib m.mtl\n").place() == "line 5");  // the first error counts
}

TEST_CASE(
    "an MTL file that is not there is a warning with the line that names it, and its materials are not described") {
  const Folder folder;
  folder.write("m.mtl", "newmtl b\nhelios_reflectance 0.3\n");
  const ObjModel model =
      folder.obj("# x\nmtllib gone.mtl m.mtl\n" + corners + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");
  REQUIRE(model.warnings.size() == 2);
  CHECK(model.warnings[0] == (folder.path() / "a.obj").string() +
                                 ", line 2: 'mtllib gone.mtl m.mtl': expected an MTL file at " +
                                 (folder.path() / "gone.mtl").string() + ", but there is none");
  CHECK(contains(model.warnings[1], "line 7: no MTL file describes the material 'a'"));
  REQUIRE(model.materials.size() == 2);
  CHECK(model.materials[0].name == "a");
  CHECK(model.materials[0].law.get<DirectionIndependent>());
  CHECK(model.materials[0].reflectance == undescribed("a").reflectance);
  CHECK(model.materials[1].reflectance == 0.3);
}

/// All that comes of reading a file, in words.
std::string told(const std::filesystem::path& path, unsigned threads, std::size_t piece_bytes) {
  std::ostringstream all;
  try {
    const ObjModel model = io::detail::ObjReader(path, {.up = UpAxis::y}, threads, piece_bytes).read();
    for (const Vec3& v : model.mesh.vertices) all << v.x << ' ' << v.y << ' ' << v.z << '\n';
    for (std::size_t i = 0; i < model.mesh.triangles.size(); ++i) {
      for (const std::uint32_t corner : model.mesh.triangles[i]) all << corner << ' ';
      all << model.materials[model.mesh.materials[i]].name << '\n';
    }
    for (const Material& material : model.materials) all << material.name << ' ' << material.reflectance << '\n';
    for (const std::string& warning : model.warnings) all << warning << '\n';
  } catch (const FileError& error) {
    all << error.what();
  }
  return all.str();
}

TEST_CASE("a file gives the same, or the same error, in pieces of any size and on any number of threads") {
  const Folder folder;
  folder.write("m.mtl", "newmtl a\nhelios_reflectance 20\nnewmtl b c\nhelios_reflectance 0.3\nhelios_spectra none\n");
  const std::vector<std::string> statements{"v 0 0 0",
                                            "v 1 0 0",
                                            "v 1 1 0.5",
                                            "v \\\r\n0 1 \\\n0",
                                            "v 2 2 2  # a corner",
                                            "v 0 0 0",
                                            "f 1 2 3",
                                            "f -1 -2 -3",
                                            "f -4 -3 -2 -1",
                                            "f 4/1 3/1 2/1 1",
                                            "f -1 -3 \\\n\\\n-2",
                                            "usemtl a",
                                            "usemtl b c",
                                            "usemtl d",
                                            "mtllib m.mtl",
                                            "# nothing \\",
                                            "",
                                            " \\",
                                            "what is this",
                                            "vt 0 0\nvn 1 0 0",
                                            "g x y\t",
                                            "o z",
                                            "f 1 3 2 4 \\\r\n ",
                                            "\tv 1e1 -2 .5 ",
                                            "s off",
                                            "f 2 2 3"};
  const std::vector<std::string> wrong{
      "f 1 2 99", "f 1 2 -99", "v 1 2 x", "mtllib gone.mtl", "f 1 2", std::string("v \0", 3), "v 1 2 1e13"};
  const std::vector<std::string> ends{"\n", "\n", "\r\n", " \n"};
  int whole = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    std::string text = random.coin() ? "\xEF\xBB\xBF" : "";
    for (const char* corner : {"v 0 0 1\n", "v 3 0 1\n", "v 3 3 1\n", "v 0 3 1\n"}) text += corner;
    for (std::uint64_t k = random.whole(60); k-- > 0;) {
      const auto& from = seed % 2 == 0 || random.uniform() < 0.97 ? statements : wrong;
      text += from[random.whole(from.size())] + ends[random.whole(ends.size())];
    }
    if (random.coin()) text += "f 1 2 3";
    const auto path = folder.write("pieces.obj", text);
    const std::string expected = told(path, 1, std::size_t{1} << 20);
    whole += !contains(expected, "expected");
    for (const std::size_t bytes : std::initializer_list<std::size_t>{1, 7, 50, 300}) {
      CAPTURE(bytes);
      for (const unsigned threads : {1U, 3U}) CHECK(told(path, threads, bytes) == expected);
    }
  }
  CHECK(whole > 60);
}

#ifndef PULSECAST_TEST_SANITIZED
TEST_CASE("an OBJ file for which there is no memory is explained, whichever allocation fails") {
  const Folder folder;
  const auto mtl = folder.write("a.mtl", "newmtl a name that is too long for a short string\nKd 1 1 1\n");
  const auto path = folder.write(
      "a.obj", "mtllib a.mtl\nusemtl a name that is too long for a short string\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  std::size_t explained = 0;
  for (std::size_t n = 1; n < 10'000; ++n) {
    CAPTURE(n);
    try {
      support::allocations_left = n;
      const ObjModel model = read_obj(path);
      if (support::allocations_left > 0) break;
    } catch (const FileError& error) {
      explained += contains(error.problem(), "memory") ? 1 : 0;
      CHECK((error.path() == path.string() || error.path() == mtl.string()));
    }
  }
  support::allocations_left = 0;
  CHECK(explained > 50);
}
#endif
