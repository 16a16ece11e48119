// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/mesh_file/ply.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <assimp/scene.h>
#include <doctest/doctest.h>
#include <assimp/Importer.hpp>

#include <pulsecast/io/mesh_file.hpp>

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
using Rows = std::vector<std::vector<double>>;

MeshFile read(const std::string& bytes, const MeshFileSettings& settings = {}) {
  const support::TemporaryFolder folder;
  return read_mesh_file(folder.write("a.ply", bytes), settings);
}
FileError error(const std::string& bytes) {
  return support::file_error([&] { (void)read(bytes); });
}

/// Corners of all triangles.
std::vector<Vec3> corners(const MeshFile& file) {
  std::vector<Vec3> all;
  for (const FileMesh& one : file.meshes)
    for (const auto& triangle : one.mesh.triangles)
      for (const std::uint32_t corner : triangle) all.push_back(one.mesh.vertices[corner]);
  return all;
}

double area(const MeshFile& file) {
  double sum = 0;
  const std::vector<Vec3> c = corners(file);
  for (std::size_t k = 0; k < c.size(); k += 3) sum += cross(c[k + 1] - c[k], c[k + 2] - c[k]).z / 2;
  return sum;
}

const std::vector<Vec3> triangle{{0, 0, 5}, {3, 0, 5}, {0, 2, 5}};
const std::array<std::string, 3> formats{"ascii", "binary_little_endian", "binary_big_endian"};

TEST_CASE("a triangle of a PLY file is the same in all formats, types of numbers and names of types") {
  for (const std::string& format : formats)
    for (const char* type : {"char", "int8", "uchar", "uint8", "short", "int16", "ushort", "uint16", "int", "int32",
                             "uint", "uint32", "float", "float32", "double", "float64"})
      for (const char* list : {"uchar int", "int uint", "uint8 int32", "float double", "short uchar"}) {
        CAPTURE(format);
        CAPTURE(type);
        CAPTURE(list);
        PlyBuilder ply = ply_triangle(type);
        ply.elements[1].properties = {std::string("list ") + list + " vertex_index"};
        const MeshFile file = read(ply.bytes(format));
        CHECK(corners(file) == triangle);
        CHECK(file.warnings.empty());
      }
}

TEST_CASE("doubles at the coordinates of UTM keep a micrometre, in a text whatever the type") {
  constexpr std::uint64_t seed = 4;
  CAPTURE(seed);
  support::Generator random(seed);
  for (const std::string& format : formats) {
    PlyBuilder ply = ply_triangle(format == "ascii" ? "float" : "double");
    ply.elements[0].rows.clear();
    ply.elements[1].rows.clear();
    std::vector<Vec3> places;
    for (int k = 0; k < 300; ++k) {
      const Vec3 p = Vec3(500'000, 5'400'000, 100) + random.point(500);
      places.push_back(p);
      ply.elements[0].rows.push_back({p.x, p.y, p.z});
      const auto at = static_cast<double>(k);
      if (k % 3 == 2) ply.elements[1].rows.push_back({3, at - 2, at - 1, at});
    }
    const MeshFile file = read(ply.bytes(format));
    const std::vector<Vec3> found = corners(file);
    REQUIRE(found.size() == places.size());
    double most = 0;
    for (std::size_t k = 0; k < found.size(); ++k) most = std::fmax(most, max_norm(found[k] - places[k]));
    CHECK(most < 1e-9);
    CHECK(file.warnings.empty());
  }
}

TEST_CASE("polygons, strips and faces of few corners") {
  PlyBuilder ply = ply_triangle();
  ply.elements[0].rows = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}, {9, 9, 9}};
  ply.elements[1].rows = {{5, 0, 1, 2, 3, 4}, {2, 0, 1}, {0}, {1, 5}};
  for (const std::string& format : formats) {
    const MeshFile notched = read(ply.bytes(format));
    CHECK(area(notched) == doctest::Approx(10));
    REQUIRE(notched.warnings.size() == 1);
    CHECK(contains(notched.warnings[0], "points and lines are left out: 3 in all"));
  }
  PlyBuilder strips = ply_triangle();
  strips.elements[0].rows = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {2, 1, 0}};
  strips.elements[1] = {"tristrips", {"list int int vertex_indices"}, {{12, 0, 2, 1, 3, -1, 2, 4, 3, 3, 3, 5, -1}}};
  strips.elements[1].rows[0] = {13, 0, 2, 1, 3, -1, 2, 4, 3, 5, 5, -1, 0, 2};
  for (const std::string& format : formats) {
    const MeshFile file = read(strips.bytes(format));
    CHECK(file.triangle_count() == 4);
    CHECK(area(file) == doctest::Approx(2));
    CHECK(file.warnings.empty());
    const std::vector<Vec3> c = corners(file);
    for (std::size_t k = 0; k < c.size(); k += 3) CHECK(cross(c[k + 1] - c[k], c[k + 2] - c[k]).z > 0);
  }
}

TEST_CASE("texture coordinates are those of vertices, or of the corners of faces") {
  PlyBuilder ply = ply_triangle();
  ply.elements[0].properties.insert(ply.elements[0].properties.end(), {"float s", "float t"});
  for (std::size_t k = 0; k < 3; ++k)
    ply.elements[0].rows[k].insert(ply.elements[0].rows[k].end(), {0.5 * static_cast<double>(k), 0.25});
  using Places = std::array<Vec2, 3>;
  const auto texture = [](const MeshFile& file) {
    Places all;
    for (std::size_t k = 0; k < 3; ++k) all[k] = file.meshes.at(0).mesh.texture.at(0)[k];
    return all;
  };
  CHECK(texture(read(ply.bytes(), {.texture = true})) == Places{Vec2(0, 0.25), Vec2(0.5, 0.25), Vec2(1, 0.25)});
  CHECK(read(ply.bytes()).meshes.at(0).mesh.texture.empty());
  ply.elements[1].properties.push_back("list uchar float texcoord");
  ply.elements[1].rows = {{3, 0, 1, 2, 6, 0, 0, 1, 0, 0.75, 0.125}, {3, 2, 1, 0, 0}};
  const MeshFile file = read(ply.bytes("binary_big_endian"), {.texture = true});
  CHECK(texture(file) == Places{Vec2(0, 0), Vec2(1, 0), Vec2(0.75, 0.125)});
  CHECK(file.meshes[0].mesh.texture[1][0] == Vec2(1, 0.25));
  CHECK(corners(file) == std::vector<Vec3>{{0, 0, 5}, {3, 0, 5}, {0, 2, 5}, {0, 2, 5}, {3, 0, 5}, {0, 0, 5}});
}

TEST_CASE("random PLY files are read as assimp reads them") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const support::TemporaryFolder folder;
    PlyBuilder ply = ply_triangle();
    ply.format = formats[seed % 3];
    ply.elements[0].properties.push_back("uchar quality");
    ply.elements[0].rows.clear();
    ply.elements[1].rows.clear();
    for (int k = 0; k < 60; ++k) {
      const Vec3 p = random.point(50);
      const auto single = [](double x) { return static_cast<double>(static_cast<float>(x)); };
      ply.elements[0].rows.push_back({single(p.x), single(p.y), single(p.z), 7});
    }
    for (int k = 0; k < 40; ++k) {
      std::vector<double> face{3};
      while (face.size() < 4) face.push_back(static_cast<double>(random.whole(60)));
      ply.elements[1].rows.push_back(face);
    }
    const auto path = folder.write("a.ply", ply.bytes());
    const std::vector<Vec3> found = corners(read_mesh_file(path));
    Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile(path.string(), 0);
    REQUIRE(scene != nullptr);
    std::vector<Vec3> expected;
    for (unsigned f = 0; f < scene->mMeshes[0]->mNumFaces; ++f) {
      std::array<Vec3, 3> t;
      for (unsigned k = 0; k < 3; ++k) {
        const aiVector3D& v = scene->mMeshes[0]->mVertices[scene->mMeshes[0]->mFaces[f].mIndices[k]];
        t[k] = Vec3(v.x, v.y, v.z);
      }
      if (cross(t[1] - t[0], t[2] - t[0]) != Vec3{}) expected.insert(expected.end(), t.begin(), t.end());
    }
    REQUIRE(found.size() == expected.size());
    double most = 0;
    for (std::size_t k = 0; k < found.size(); ++k) most = std::fmax(most, max_norm(found[k] - expected[k]));
    CHECK(most < (ply.format == "ascii" ? 2e-5 : 1e-12));  // assimp rounds texts less well
  }
}

TEST_CASE("each row of the rules for meshes of PLY files is kept") {
  using Element = PlyBuilder::Element;
  const auto with_element = [](const Element& one) {
    return [one] {
      PlyBuilder ply = ply_triangle();
      ply.elements.push_back(one);
      return read(ply.bytes()).warnings;
    };
  };
  const auto with_property = [](std::size_t element, const std::vector<std::string>& names) {
    return [=] {
      PlyBuilder ply = ply_triangle();
      for (const std::string& name : names) {
        ply.elements[element].properties.push_back("uchar " + name);
        for (auto& row : ply.elements[element].rows) row.push_back(1);
      }
      const MeshFile file = read(ply.bytes("binary_little_endian"), {.texture = true});
      CHECK(corners(file) == triangle);
      if (names[0] == "u") CHECK(file.meshes[0].mesh.texture.at(0)[0] == Vec2(1, 1));
      return file.warnings;
    };
  };
  const auto with_remark = [](const std::string& remark) {
    return [=] {
      PlyBuilder ply = ply_triangle();
      ply.remarks = remark + "\n";
      return read(ply.bytes()).warnings;
    };
  };
  const test::FormatCase places{"vertex", [] {
                                  const MeshFile file = read(ply_triangle().bytes());
                                  CHECK(corners(file) == triangle);
                                  return file.warnings;
                                }};
  const test::FormatCase face{"face", [] {
                                PlyBuilder ply = ply_triangle();
                                ply.elements[1].rows.push_back({3, 2, 1, 0});
                                const MeshFile file = read(ply.bytes());
                                CHECK(file.triangle_count() == 2);
                                return file.warnings;
                              }};
  const test::FormatCase texcoord{
      "face texcoord", [] {
        PlyBuilder ply = ply_triangle();
        ply.elements[1].properties.push_back("list uchar float texcoord");
        ply.elements[1].rows[0].insert(ply.elements[1].rows[0].end(), {6, 0, 0, 1, 0, 1, 1});
        const MeshFile file = read(ply.bytes(), {.texture = true});
        CHECK(file.meshes.at(0).mesh.texture.at(0)[2] == Vec2(1, 1));
        return file.warnings;
      }};
  const test::FormatCase strips{"tristrips", [] {
                                  PlyBuilder ply = ply_triangle();
                                  ply.elements[1] = {"tristrips", {"list int int vertex_indices"}, {{3, 0, 1, 2}}};
                                  const MeshFile file = read(ply.bytes());
                                  CHECK(corners(file) == triangle);
                                  return file.warnings;
                                }};
  const test::FormatCase picture{"comment texturefile", [] {
                                   PlyBuilder ply = ply_triangle();
                                   ply.remarks = "comment TextureFile my wood.png\n";
                                   const MeshFile file = read(ply.bytes());
                                   REQUIRE(file.files.size() >= 1);
                                   CHECK(file.files[0].filename() == "my wood.png");
                                   return file.warnings;
                                 }};
  const std::vector<test::FormatCase> cases{
      places,
      {"vertex u", with_property(0, {"u", "v"})},
      {"vertex red", with_property(0, {"red", "green", "blue", "alpha"})},
      {"vertex classification", with_property(0, {"label"})},
      face,
      texcoord,
      {"face red", with_property(1, {"red"})},
      {"face classification", with_property(1, {"class"})},
      {"face material_index", with_property(1, {"material_index"})},
      strips,
      {"range_grid", with_element({"range_grid", {"list uchar int vertex_indices"}, {{1, 0}, {0}}})},
      {"edge", with_element({"edge", {"int vertex1", "int vertex2"}, {{0, 1}}})},
      {"camera", with_element({"camera", {"float view_px"}, {{5}}})},
      picture,
      {"comment texturefile 2", with_remark("comment TextureFile a.png\ncomment TextureFile b.png")},
      {"comment offset", with_remark("obj_info Global Shift: 500000 5400000 0")},
      {"comment transform*", with_remark("comment Transformation 1 0 0 0")},
      {"comment scale*", with_remark("obj_info scale 0.001")},
      {"comment up", with_remark("comment up axis: Y")},
      {"comment up_axis", with_remark("comment up_axis Y")},
      {"comment unit*", with_remark("comment File units = inches")},
      {"comment crs", with_remark("comment crs: EPSG:4326")},
      {"comment epsg*", with_remark("comment EPSG:4326")},
      {"comment srs", with_remark("comment srs WGS 84")},
      {"vertex alpha", with_property(0, {"alpha"})},
      {"face alpha", with_property(1, {"alpha"})},
      {"*", with_element({"flower", {"float petals"}, {{5}}})}};
  test::check_rules(detail::ply_mesh_rules, cases);
}

TEST_CASE("other properties, remarks and elements without rows do not count") {
  PlyBuilder ply = ply_triangle();
  ply.remarks = "comment made by hand\nobj_info num_cols 5\n\n";
  ply.elements[0].properties.insert(ply.elements[0].properties.begin(), {"float nx", "list uchar float weights"});
  for (auto& row : ply.elements[0].rows) row.insert(row.begin(), {1, 2, 0.5, 0.5});
  ply.elements.push_back({"edge", {"int vertex1"}, {}});
  for (const std::string& format : formats) {
    const MeshFile file = read(ply.bytes(format));
    CHECK(corners(file) == triangle);
    CHECK(file.warnings.empty());
  }
  CHECK(corners(read(ply.bytes(), {.isolated = true})) == triangle);
}

TEST_CASE("meshes that cannot be are refused, and single precision far from the origin is noted") {
  PlyBuilder ply = ply_triangle();
  ply.elements[1].rows[0][3] = 3;
  CHECK(error(ply.bytes()).problem() == "face 0: has the vertex 3, expected less than the number of vertices, 3");
  CHECK(error(ply.bytes()).place() == "line 13");
  const std::string binary = ply.bytes("binary_little_endian");
  CHECK(error(binary).place() == "byte " + std::to_string(binary.size() - 13));
  ply.elements[1].rows.clear();
  CHECK(error(ply.bytes()).problem() ==
        "has no faces: expected a mesh; xyzloader (read_point_cloud) reads the points of a cloud");
  ply = ply_triangle();
  std::swap(ply.elements[0], ply.elements[1]);
  CHECK(contains(error(ply.bytes()).problem(), "expected less than the number of vertices, 0"));
  ply = ply_triangle();
  ply.elements[0].properties[1] = "float why";
  CHECK(contains(error(ply.bytes()).problem(), "expected fewer than 2^32, with properties x, y and z"));
  ply = ply_triangle();
  ply.elements[1].properties = {"list uchar int corners"};
  CHECK(contains(error(ply.bytes()).problem(), "has no list vertex_indices of the element face"));
  ply = ply_triangle();
  for (auto& row : ply.elements[0].rows) row = {7, 7, 7};
  CHECK(contains(error(ply.bytes()).problem(), "has triangles, and none with an area"));
  ply = ply_triangle();
  ply.elements[0].rows[0][0] = 5.4e6;
  CHECK(contains(read(ply.bytes("binary_little_endian")).warnings.at(0),
                 "has coordinates up to 5400000 of single precision: expected properties of the type double"));
}

}  // namespace
}  // namespace pulsecast::io
