// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Features of glTF that assimp does not apply: each is applied, noted or refused.
#include <pulsecast/io/detail/mesh_file/gltf_document.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <pulsecast/io/mesh_file.hpp>

#include "support/data_folder.hpp"
#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/gltf.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using support::contains;
using support::Gltf;

namespace {

using Folder = support::TemporaryFolder;

const std::vector<Gltf::Place> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// Corners of the triangles of all placements in the frame of the file, y up.
std::vector<Vec3> places(const MeshFile& file) {
  std::vector<Vec3> all;
  for (const MeshPlacement& one : file.placements)
    for (const auto& triangle : file.meshes[one.mesh].mesh.triangles)
      for (const std::uint32_t corner : triangle) {
        const Vec3 at = one.placement.point(file.meshes[one.mesh].mesh.vertices[corner]);
        all.emplace_back(at.x, at.z, -at.y);
      }
  return all;
}

bool near(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double tolerance = 1e-6) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(length(a[i] - b[i]) <= tolerance)) return false;
  return true;
}

const std::string quantized =
    R"("extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"],)";

/// One triangle whose numbers are of a type, in a file that requires their extension.
template <class T>
Gltf quantized_file(const std::vector<T>& positions, int type, const std::string& members = "",
                    const std::string& of_view = "", const std::string& node = "") {
  Gltf gltf;
  gltf.primitive("\"POSITION\":" + gltf.accessor(positions, type, "VEC3", 3, members, of_view), "");
  gltf.mesh("m");
  gltf.node("\"mesh\":0" + node);
  gltf.more = quantized;
  return gltf;
}

/// A triangle with these members of its node, of the file, of its part and of its material.
struct Members {
  std::string node{}, file{}, part{}, material{};
};
Gltf triangle(const Members& members) {
  Gltf gltf;
  gltf.primitive(corners, {{0, 1, 2}}, R"(,"material":0)" + members.part, {{0, 0}, {1, 0}, {0, 1}});
  gltf.mesh("m");
  gltf.node(R"("name":"a","mesh":0)" + members.node);
  gltf.node(R"("name":"b","mesh":0,"translation":[0,0,5])");
  gltf.material(R"("name":"m")" + members.material);
  gltf.more = members.file;
  gltf.roots = "0,1";
  return gltf;
}

}  // namespace

TEST_CASE("quantized positions are numbers or shares of a type, at any stride, in text and binary files") {
  const Folder folder;
  const auto read = [&](const Gltf& gltf) {
    folder.write("a.bin", gltf.buffer());
    const std::vector<Vec3> at = places(read_mesh_file(folder.write("a.gltf", gltf.text())));
    for (const bool isolated : {false, true}) {
      CHECK(places(read_mesh_file(folder.write("a.glb", gltf.binary()), {.isolated = isolated})) == at);
      const MeshFile apart = read_mesh_file(folder.write("b.gltf", gltf.text("a.bin")), {.isolated = isolated});
      CHECK(places(apart) == at);
      CHECK(apart.files == std::vector<std::filesystem::path>{folder / "a.bin"});
      CHECK(std::ranges::none_of(apart.warnings, [](const auto& one) { return contains(one, "glTF"); }));
    }
    return at;
  };
  const std::vector<std::uint16_t> words{0, 0, 0, 0, 65535, 0, 7, 0, 0, 40000, 9, 0};
  CHECK(near(read(quantized_file(words, 5123, "", R"(,"byteStride":8)")), {{0, 0, 0}, {65535, 0, 7}, {0, 40000, 9}}));
  CHECK(near(read(quantized_file(words, 5123, R"(,"normalized":true)", R"(,"byteStride":8)",
                                 R"(,"scale":[2,2,2],"translation":[1,0,0])")),
             {{1, 0, 0}, {3, 0, 14 / 65535.0}, {1, 80000 / 65535.0, 18 / 65535.0}}));
  CHECK(near(read(quantized_file<std::int16_t>({-5, 0, 0, 99, 32767, 0, 7, 99, 0, -32768, 9, 99}, 5122, "",
                                               R"(,"byteStride":8)")),
             {{-5, 0, 0}, {32767, 0, 7}, {0, -32768, 9}}));
  CHECK(near(read(quantized_file<std::int8_t>({-127, 0, 0, 1, 127, 0, 0, 1, 0, -128, 0, 1}, 5120,
                                              R"(,"normalized":true)", R"(,"byteStride":4)")),
             {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}}));
  CHECK(near(read(quantized_file<std::uint8_t>({1, 2, 3, 255, 0, 0, 0, 9, 0}, 5121)),
             {{1, 2, 3}, {255, 0, 0}, {0, 9, 0}}));
}

TEST_CASE("random triangles are the same quantized and as floating-point numbers, to the quantum") {
  const Folder folder;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const double size = std::pow(10, 4 * random.uniform() - 2), quantum = size / 65535;
    std::vector<Gltf::Place> exact;
    std::vector<std::uint16_t> words;
    std::vector<Gltf::Corners> triangles;
    for (std::uint32_t i = 0; i < 300; ++i) {
      const Vec3 at = (random.point(1) + Vec3(1)) * 0.5;
      exact.push_back(
          {static_cast<float>(at.x * size), static_cast<float>(at.y * size), static_cast<float>(at.z * size)});
      for (int k = 0; k < 3; ++k) words.push_back(static_cast<std::uint16_t>(std::lround(at[k] * 65535)));
      words.push_back(0);
      if (i % 3 == 2) triangles.push_back({i - 2, i - 1, i});
    }
    Gltf plain, packed;
    plain.primitive(exact, triangles);
    packed.primitive("\"POSITION\":" + packed.accessor(words, 5123, "VEC3", 300, "", R"(,"byteStride":8)"),
                     ",\"indices\":" + packed.accessor(triangles, 5125, "SCALAR", 300));
    const std::string scale = std::to_string(quantum * 1e6) + "e-6";
    plain.mesh("m");
    plain.node("\"mesh\":0");
    packed.mesh("m");
    packed.node("\"mesh\":0,\"scale\":[" + scale + "," + scale + "," + scale + "]");
    packed.more = quantized;
    const auto a = places(read_mesh_file(folder.write("a.gltf", plain.text())));
    const auto b = places(read_mesh_file(folder.write("b.gltf", packed.text())));
    CHECK(a.size() == 300);
    CHECK(near(a, b, quantum));
  }
}

TEST_CASE("instances are parts, placed in the frame of their node, with rotations of any type") {
  const Folder folder;
  const auto file_of = [&](bool whole) {
    Gltf gltf;
    gltf.primitive(corners, {{0, 1, 2}});
    gltf.mesh("tree");
    const std::string shifts = gltf.accessor(std::vector<Gltf::Place>{{10, 0, 0}, {0, 0, 3}}, 5126, "VEC3", 2);
    const std::string turns = whole ? gltf.accessor(std::vector<std::int16_t>{0, 32767, 0, 0, 0, 0, 0, 32767}, 5122,
                                                    "VEC4", 2, R"(,"normalized":true)")
                                    : gltf.accessor(std::vector<float>{0, 2, 0, 0, 0, 0, 0, 1}, 5126, "VEC4", 2);
    const std::string scales = gltf.accessor(std::vector<Gltf::Place>{{2, 2, 2}, {1, 1, 1}}, 5126, "VEC3", 2);
    gltf.node(R"("name":"wood","mesh":0,"children":[1],"translation":[0,100,0],"extensions":{"EXT_mesh_gpu_instancing":
        {"attributes":{"TRANSLATION":)" +
              shifts + ",\"ROTATION\":" + turns + ",\"SCALE\":" + scales + "}}}");
    gltf.node(R"("name":"hut","mesh":0)");
    gltf.more = R"("extensionsUsed":["EXT_mesh_gpu_instancing"],"extensionsRequired":["EXT_mesh_gpu_instancing"],)";
    return gltf;
  };
  for (const bool whole : {false, true}) {
    const MeshFile file = read_mesh_file(folder.write("a.glb", file_of(whole).binary()));
    CHECK(file.meshes.size() == 1);
    CHECK(file.warnings.empty());
    REQUIRE(file.placements.size() == 3);
    CHECK(file.placements[0].name == "wood/hut");
    CHECK(file.placements[1].name == "wood/0");
    CHECK(file.placements[2].name == "wood/1");
    CHECK(near(places(file),
               {{0, 100, 0},
                {1, 100, 0},
                {0, 101, 0},
                {10, 100, 0},
                {8, 100, 0},
                {10, 102, 0},
                {0, 100, 3},
                {1, 100, 3},
                {0, 101, 3}},
               1e-5));
  }
}

TEST_CASE("what gltfpack packs are the trees that it was given, to the quantum") {
  // tests/data/gltfpack.glb: three trees of four triangles, packed by gltfpack 1.3 with -mi
  const std::vector<Vec3> tree{{0, 4, 0}, {1, 0, 1}, {-1, 0, 1}, {0, 0, -1.5}};
  const MeshFile file = read_mesh_file(support::data_folder / "gltfpack.glb");
  CHECK(file.warnings.empty());
  CHECK(file.placements.size() == 3);
  const std::vector<Vec3> found = places(file);
  CHECK(found.size() == 36);
  for (int i = 0; i < 3; ++i) {
    const double angle = 0.8 * i, scale = 1 + 0.5 * i, c = std::cos(angle), s = std::sin(angle);
    for (const Vec3& v : tree) {
      const Vec3 at = Vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x) * scale + Vec3(10 * i, 0, 5);
      double nearest = 1;
      for (const Vec3& one : found) nearest = std::fmin(nearest, length(one - at));
      CHECK(nearest < 5e-4);  // 4 m in 16383 steps, and rotations of 16 bits
    }
  }
}

TEST_CASE("coordinates of another shape are refused, and colours and shares beyond 1 are noted") {
  const Folder folder;
  const auto read = [&](const std::string& shape, const std::string& material) {
    Gltf gltf;
    gltf.primitive("\"POSITION\":" + gltf.accessor(corners, 5126, shape, 3), ",\"material\":0");
    gltf.mesh("m");
    gltf.node("\"mesh\":0");
    gltf.more = R"("materials":[{"pbrMetallicRoughness":{)" + material + "}}],";
    return read_mesh_file(folder.write("a.gltf", gltf.text())).warnings;
  };
  CHECK(contains(support::file_error([&] { (void)read("VEC2", ""); }).problem(), "of the type VEC2 (accessor 0)"));
  CHECK(read("VEC3", R"("baseColorFactor":[1,0.5,0,1],"metallicFactor":1)").empty());
  for (const char* material : {R"("baseColorFactor":[2,0.5,0,1])", R"("metallicFactor":1.5)"}) {
    REQUIRE(read("VEC3", material).size() == 1);
    CHECK(contains(read("VEC3", material)[0], "has a number beyond 0 to 1"));
  }
}

TEST_CASE("texture coordinates are shares of whole numbers, and transformed as their picture is") {
  const Folder folder;
  const auto coordinates = [&](const std::string& transform, const std::string& more = "") {
    Gltf gltf;
    const std::string at = gltf.accessor(corners, 5126, "VEC3", 3);
    const std::string first = gltf.accessor(std::vector<std::uint8_t>{0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0}, 5121,
                                            "VEC2", 3, R"(,"normalized":true)", R"(,"byteStride":4)");
    const std::string second = gltf.accessor(std::vector<float>{5, 5, 6, 5, 5, 6}, 5126, "VEC2", 3);
    gltf.primitive("\"POSITION\":" + at + ",\"TEXCOORD_0\":" + first + ",\"TEXCOORD_1\":" + second, R"(,"material":0)");
    gltf.mesh("m");
    gltf.node("\"mesh\":0");
    gltf.material(R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0)" + more +
                  (transform.empty() ? "" : R"(,"extensions":{"KHR_texture_transform":{)" + transform + "}}") + "}}");
    gltf.more = R"("images":[{"uri":"a.png"}],"textures":[{"source":0}],)";
    folder.write("a.png", "no picture is read");
    const MeshFile file = read_mesh_file(folder.write("a.gltf", gltf.text()), {.texture = true, .pictures = false});
    CHECK(file.warnings.empty());
    std::vector<Vec3> all;
    for (const Vec2& one : file.meshes.at(0).mesh.texture.at(0))
      all.emplace_back(one.x, 1 - one.y, 0);  // as in the file
    return all;
  };
  CHECK(near(coordinates(""), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  CHECK(near(coordinates(R"("offset":[0.25,0.5],"scale":[2,3])"), {{0.25, 0.5, 0}, {2.25, 0.5, 0}, {0.25, 3.5, 0}}));
  // The example of KHR_texture_transform: the lower left quarter, turned
  CHECK(near(coordinates(R"("offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.5])"),
             {{0, 1, 0}, {0, 0.5, 0}, {0.5, 1, 0}}));
  CHECK(near(coordinates(R"("texCoord":1,"offset":[1,0])"), {{6, 5, 0}, {7, 5, 0}, {6, 6, 0}}));
  CHECK(near(coordinates(R"("texCoord":0,"offset":[1,0])", R"(,"texCoord":1)"), {{1, 0, 0}, {2, 0, 0}, {1, 1, 0}}));
}

TEST_CASE("each feature of glTF is read, noted or refused by its rule") {
  const Folder folder;
  const auto read = [&](const Gltf& gltf) {
    return read_mesh_file(folder.write("a.gltf", gltf.text()), {.texture = true, .pictures = false});
  };
  const auto warnings = [&](const Gltf& gltf) { return read(gltf).warnings; };
  const auto used = [&](const std::string& name, bool required = false) {
    const std::string list = "\":[\"" + name + "\"],";
    return warnings(triangle({.file = "\"extensionsUsed" + list + (required ? "\"extensionsRequired" + list : "")}));
  };
  const auto is_read = [&](const std::string& name) { return [=] { return used(name, true); }; };
  folder.write("a.png", "no picture is read");
  const std::string sparse = R"({"count":1,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":1}})";
  const std::vector<test::FormatCase> cases{
      {"KHR_draco_mesh_compression", is_read("KHR_draco_mesh_compression")},
      {"KHR_mesh_quantization",
       [&] {
         const MeshFile file = read(quantized_file<std::uint8_t>({1, 2, 3, 255, 0, 0, 0, 9, 0}, 5121));
         CHECK(places(file)[1].x == 255);
         return file.warnings;
       }},
      {"EXT_mesh_gpu_instancing",
       [&] {
         Gltf gltf = triangle({});
         gltf.node(R"("mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}})");
         gltf.roots = "2";
         const MeshFile file = read(gltf);
         CHECK(file.placements.size() == 3);
         return file.warnings;
       }},
      {"KHR_texture_transform",
       [&] {
         const MeshFile file = read(triangle({.file = R"("images":[{"uri":"a.png"}],"textures":[{"source":0}],)",
                                              .material = R"(,"pbrMetallicRoughness":{"baseColorTexture":{"index":0,
                                "extensions":{"KHR_texture_transform":{"offset":[0.5,0]}}}})"}));
         CHECK(file.meshes.at(0).mesh.texture.at(0)[0].x == doctest::Approx(0.5));
         return file.warnings;
       }},
      {"KHR_node_visibility",
       [&] {
         const MeshFile file = read(triangle({.node = R"(,"extensions":{"KHR_node_visibility":{"visible":false}})"}));
         CHECK(file.placements.size() == 1);
         return file.warnings;
       }},
      {"sparse",
       [&] {
         Gltf gltf;
         const std::string place = gltf.view("\1\0\0\0", 4), value = gltf.view("\0\0\0\x41\0\0\0\0\0\0\0\0", 12);
         CHECK(place + value == "01");
         gltf.primitive("\"POSITION\":" + gltf.accessor(corners, 5126, "VEC3", 3, ",\"sparse\":" + sparse), "");
         gltf.mesh("m");
         gltf.node("\"mesh\":0");
         const MeshFile file = read(gltf);
         CHECK(places(file)[1] == Vec3(8, 0, 0));
         return file.warnings;
       }},
      {"mode",
       [&] {
         std::size_t triangles = 0;
         for (const char* mode : {"5", "6"}) {
           Gltf gltf;
           const std::vector<Gltf::Place> strip{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
           gltf.primitive("\"POSITION\":" + gltf.accessor(strip, 5126, "VEC3", 4), std::string(",\"mode\":") + mode);
           gltf.mesh("m");
           gltf.node("\"mesh\":0");
           triangles += read(gltf).triangle_count();
         }
         CHECK(triangles == 4);
         return std::vector<std::string>{};
       }},
      {"MSFT_lod",
       [&] {
         Gltf gltf = triangle({.node = R"(,"extensions":{"MSFT_lod":{"ids":[1]}})"});
         gltf.roots = "0";
         CHECK(read(gltf).placements.size() == 1);
         return warnings(gltf);
       }},
      {"KHR_materials_transmission", is_read("KHR_materials_transmission")},
      {"KHR_materials_ior", is_read("KHR_materials_ior")},
      {"KHR_materials_unlit", is_read("KHR_materials_unlit")},
      {"KHR_materials_emissive_strength", is_read("KHR_materials_emissive_strength")},
      {"KHR_lights_*", is_read("KHR_lights_punctual")},
      {"EXT_lights_*", is_read("EXT_lights_ies")},
      {"KHR_xmp*", is_read("KHR_xmp_json_ld")},
      {"EXT_structural_metadata", is_read("EXT_structural_metadata")},
      {"EXT_mesh_features", is_read("EXT_mesh_features")},
      {"EXT_instance_features", is_read("EXT_instance_features")},
      {"KHR_materials_pbrSpecularGlossiness",
       [&] { return warnings(triangle({.material = R"(,"extensions":{"KHR_materials_pbrSpecularGlossiness":{}})"})); }},
      {"KHR_materials_variants", is_read("KHR_materials_variants")},
      {"KHR_materials_*", is_read("KHR_materials_clearcoat")},
      {"KHR_texture_basisu", is_read("KHR_texture_basisu")},
      {"EXT_texture_*", is_read("EXT_texture_webp")},
      {"MSFT_texture_dds", is_read("MSFT_texture_dds")},
      {"COLOR_0",
       [&] {
         Gltf gltf;
         gltf.primitive("\"POSITION\":" + gltf.accessor(corners, 5126, "VEC3", 3) +
                            ",\"COLOR_0\":" + gltf.accessor(corners, 5126, "VEC3", 3),
                        "");
         gltf.mesh("m");
         gltf.node("\"mesh\":0");
         return warnings(gltf);
       }},
      {"CESIUM_RTC",
       [&] { return warnings(triangle({.file = R"("extensions":{"CESIUM_RTC":{"center":[1,2,3]}},)"})); }},
      {"normalTexture",
       [&] {
         return warnings(triangle({.file = R"("textures":[{"source":0}],"images":[{"uri":"a.png"}],)",
                                   .material = R"(,"normalTexture":{"index":0})"}));
       }},
      {"animations", [&] { return warnings(triangle({.file = R"("animations":[{"channels":[],"samplers":[]}],)"})); }},
      {"skins", [&] { return warnings(triangle({.node = R"(,"skin":0)", .file = R"("skins":[{"joints":[0]}],)"})); }},
      {"weights", [&] { return warnings(triangle({.node = R"(,"weights":[0,0.5])"})); }},
      {"scenes",
       [&] {
         std::string text = triangle({}).text();
         text.replace(text.find("\"scenes\":["), 10, R"("scenes":[{"nodes":[1]},)");
         const MeshFile file = read_mesh_file(folder.write("a.gltf", text));
         CHECK(file.placements.size() == 1);
         return file.warnings;
       }},
      {"EXT_meshopt_compression", is_read("EXT_meshopt_compression")},
      {"KHR_meshopt_compression", is_read("KHR_meshopt_compression")},
      {"WEB3D_quantized_attributes", is_read("WEB3D_quantized_attributes")},
      {"minVersion",
       [&] {
         std::string text = triangle({}).text();
         text.replace(text.find("\"version\""), 9, R"("minVersion":"2.1","version")");
         return read_mesh_file(folder.write("a.gltf", text)).warnings;
       }},
      {"*", [&] { return used("SOME_thing"); }}};
  test::check_rules(io::detail::gltf_rules, cases);

  // what a file declares without effect, requires and is unknown, or has without a declaration
  CHECK(warnings(triangle({.node = R"(,"weights":[0,0],"extras":{"weights":[1],"extensions":{"A_b":1}})",
                           .file = R"("animations":[],)"}))
            .empty());
  CHECK(warnings(triangle({.node = R"(,"extensions":{"SOME_thing":{}})"})).size() == 1);
  CHECK(used("EXT_meshopt_compression").size() == 1);
  for (const char* name : {"SOME_thing", "\\u0053OME_thing"})
    CHECK(contains(support::file_error([&] { (void)used(name, true); }).problem(),
                   "has the glTF feature 'SOME_thing', which is unknown: expected a file without it"));
  CHECK(contains(support::file_error([&] {
                   (void)warnings(triangle({.file = R"("extensions\u0052equired":["SOME_thing"],)"}));
                 }).problem(),
                 "SOME_thing"));
}

TEST_CASE("a hidden node hides those below it, and no other") {
  const Folder folder;
  Gltf gltf;
  gltf.primitive(corners, {{0, 1, 2}});
  gltf.mesh("m");
  gltf.node(R"("mesh":0,"children":[1],"extensions":{"KHR_node_visibility":{"visible":false}})");
  gltf.node(R"("mesh":0)");
  gltf.node(R"("name":"shown","mesh":0,"extensions":{"KHR_node_visibility":{"visible":true}})");
  gltf.roots = "0,2";
  const MeshFile file = read_mesh_file(folder.write("a.gltf", gltf.text()));
  REQUIRE(file.placements.size() == 1);
  CHECK(file.placements[0].name == "shown");
}

TEST_CASE("a mesh of many vertices at one place is refused, as is a file of one quad without an area") {
  const Folder folder;
  const auto file = [&](std::size_t count) {
    Gltf gltf;
    gltf.primitive(std::vector<Gltf::Place>(count, {3, 4, 5}), {{0, 1, 2}, {1, 2, 3}});
    gltf.mesh("shed");
    gltf.node("\"mesh\":0");
    return folder.write("a.gltf", gltf.text());
  };
  CHECK(contains(support::file_error([&] { (void)read_mesh_file(file(4)); }).problem(),
                 "has triangles, and none with an area"));
  CHECK(contains(support::file_error([&] { (void)read_mesh_file(file(5)); }).problem(),
                 "has the mesh 'shed' of 5 vertices, all at one place"));
  std::string stl = "solid a\n";
  for (int i = 0; i < 3; ++i)
    stl += "facet normal 0 0 1\nouter loop\nvertex 1 1 1\nvertex 1 1 1\nvertex 1 1 1\nendloop\nendfacet\n";
  CHECK(contains(
      support::file_error([&] { (void)read_mesh_file(folder.write("a.stl", stl + "endsolid a\n")); }).problem(),
      "all at one place"));
}

TEST_CASE("a face of a vertex that is not there, and whole numbers compressed by Draco are refused") {
  const Folder folder;
  const auto problem = [&](const auto& indices, int type, const std::string& members, int component = 5126) {
    Gltf gltf;
    const std::string number = gltf.accessor(indices, type, "SCALAR", indices.size());
    const std::string place = gltf.accessor(corners, component, "VEC3", 3);
    gltf.primitive("\"POSITION\":" + place, ",\"indices\":" + number + members);
    gltf.mesh("m");
    gltf.node("\"mesh\":0");
    gltf.more = R"("extensionsUsed":["KHR_mesh_quantization"],)";
    return support::file_error([&] { (void)read_mesh_file(folder.write("a.gltf", gltf.text())); }).problem();
  };
  CHECK(contains(problem(std::vector<std::uint16_t>{0, 1, 2, 0}, 5123, ""), "has triangles of 4 corners"));
  CHECK(
      contains(problem(std::vector<std::uint16_t>{0, 1, 2, 0, 1}, 5123, ",\"mode\":4"), "has triangles of 5 corners"));
  for (const char* members : {"", ",\"mode\":5"}) {
    CHECK(problem(std::vector<std::uint16_t>{0, 1, 2}, 5123, members) == "no error");
    CHECK(contains(problem(std::vector<std::uint8_t>{0, 1, 2, 0, 1, 3}, 5121, members),
                   "has a face of the vertex 3: expected less than their number, 3"));
    CHECK(contains(problem(std::vector<std::uint16_t>{0, 1, 2, 0, 1, 65535}, 5123, members), "of the vertex 65535"));
    CHECK(contains(problem(std::vector<std::uint32_t>{0, 1, 4294967295}, 5125, members), "of the vertex 4294967295"));
  }
  CHECK(contains(
      problem(std::vector<std::uint16_t>{0, 1, 2}, 5123,
              R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})", 5122),
      "has compression by Draco and quantized positions: expected"));
}

TEST_CASE("names of buffers may have escapes of JSON and of URIs, and stay in the folder") {
  const Folder folder;
  const Gltf gltf = quantized_file<std::uint8_t>({1, 2, 3, 255, 0, 0, 0, 9, 0}, 5121);
  std::filesystem::create_directory(folder / "inner");
  folder.write("a.bin", gltf.buffer());
  folder.write("inner/my sc\xC3\xA4ne.bin", gltf.buffer());
  for (const bool isolated : {false, true}) {
    for (const char* name : {"my sc\\u00e4ne.bin", "my%20sc\\u00E4ne.bin", "my%20sc%C3%A4ne.bin",
                             "my\\u0020sc\xC3\xA4ne.bin", "my\\u002520sc\\u00e4ne.bin"}) {
      CAPTURE(name);
      const MeshFile file = read_mesh_file(folder.write("inner/a.gltf", gltf.text(name)), {.isolated = isolated});
      CHECK(places(file)[1].x == 255);
      CHECK(std::ranges::any_of(file.files, [](const auto& one) { return one.filename() == "my sc\xC3\xA4ne.bin"; }));
    }
    for (const char* name : {"../a.bin", "%2E%2E/a.bin", "\\u002e\\u002e/a.bin", "%2e%2e%2Fa.bin", "..\\/a.bin"}) {
      CAPTURE(name);
      const auto path = folder.write("inner/b.gltf", gltf.text(name));
      CHECK(contains(support::file_error([&] { (void)read_mesh_file(path, {.isolated = isolated}); }).problem(),
                     "expected files in its own folder"));
      CHECK(places(read_mesh_file(path, {.files_elsewhere = true, .isolated = isolated}))[1].x == 255);
    }
  }
}

TEST_CASE("documents that lie about quantized positions and instances are explained") {
  const Folder folder;
  const Gltf gltf = [&] {
    Gltf made = quantized_file<std::uint16_t>({1, 2, 3, 0, 255, 0, 0, 0, 0, 9, 0, 0}, 5123, R"(,"normalized":false)",
                                              R"(,"byteStride":8)", R"(,"children":[1])");
    const std::string shifts = made.accessor(corners, 5126, "VEC3", 3);
    const std::string turns = made.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, 5126, "VEC4", 3);
    made.node(R"("mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" + shifts +
              R"(,"ROTATION":)" + turns + "}}}");
    return made;
  }();
  const std::string sound = gltf.text(), sound_binary = gltf.binary();
  const auto problem = [&](const std::string& text) {
    return support::file_error([&] {
             const MeshFile file =
                 read_mesh_file(folder.write("a.gltf", text), {.isolated = true, .limits = {.memory = 5e8}});
             for (const FileMesh& one : file.meshes) one.mesh.validate();
             for (const MeshPlacement& one : file.placements) one.placement.validate();
           })
        .problem();
  };
  REQUIRE(problem(sound) == "no error");
  struct Lie {
    std::string from, to, expected;  // empty: read or explained
  };
  const std::vector<Lie> lies{
      {R"("count":3)", R"("count":4)", "expected them in a buffer"},
      {R"("count":3)", R"("count":4000000000)", "expected them in a buffer"},
      {R"("count":3)", R"("count":9007199254740991)", "expected them in a buffer"},
      {R"("count":3)", R"("count":18446744073709551615)", "has no right count"},
      {R"("count":3)", R"("count":0)", "of 0 elements"},
      {R"("count":3)", R"("count":-3)", "has no right count"},
      {R"("count":3)", R"("count":3.5)", "has no right count"},
      {R"("count":3)", R"("count":"3")", "has no right count"},
      {R"("count":3)", R"("count":null)", "has no right count"},
      {R"("count":3)", R"("n":3)", "has no right count"},
      {R"("count":3)", R"("count":4,"count":3)", "expected them in a buffer"},
      {R"("byteStride":8)", R"("byteStride":0)", "expected them in a buffer"},
      {R"("byteStride":8)", R"("byteStride":5)", "expected them in a buffer"},
      {R"("byteStride":8)", R"("byteStride":255)", "expected them in a buffer"},
      {R"("byteStride":8)", R"("byteStride":9007199254740991)", "expected them in a buffer"},
      {R"("byteLength":24)", R"("byteLength":23)", ""},
      {R"("byteLength":24)", R"("byteLength":12)", "expected them in a buffer"},
      {R"("byteLength":24)", R"("byteLength":1000000)", "expected them in a buffer"},
      {R"("byteOffset":0)", R"("byteOffset":1000000)", "expected them in a buffer"},
      {R"("byteOffset":0)", R"("byteOffset":9007199254740991)", "expected them in a buffer"},
      {R"("componentType":5123)", R"("componentType":5125)", "component type 5125"},
      {R"("componentType":5123)", R"("componentType":0)", ""},
      {R"("componentType":5123)", R"("componentType":5124)", "component type 5124"},
      {R"("type":"VEC3")", R"("type":"VEC2")", "expected VEC3"},
      {R"("type":"VEC3")", R"("type":3)", "expected VEC3"},
      {R"("normalized":false)", R"("sparse":{})", "not sparse"},
      {R"("bufferView":0)", R"("bufferView":9)", "has no number 9 of its bufferViews"},
      {R"("bufferView":0)", R"("bufferView":null)", "has no right bufferView"},
      {R"("buffer":0)", R"("buffer":1)", "has no number 1 of its buffers"},
      {R"("POSITION":0)", R"("POSITION":77)", "has no number 77 of its accessors"},
      {R"("POSITION":0)", R"("POSITION":[])", "has no right POSITION"},
      {R"("TRANSLATION":1)", R"("TRANSLATION":0)", ""},
      {R"("TRANSLATION":1)", R"("TRANSLATION":2)", "expected VEC3"},
      {R"("TRANSLATION":1)", R"("TRANSLATION":8)", "has no number 8 of its accessors"},
      {R"("ROTATION":2)", R"("ROTATION":1)", "expected VEC4"},
      {R"("TRANSLATION":1,"ROTATION":2)", R"("_ID":0)", "instances without TRANSLATION"},
      {R"("type":"VEC4","count":3)", R"("type":"VEC4","count":2)", "not as many ROTATION as others"},
      {R"("type":"VEC4","count":3)", R"("type":"VEC4","count":1000000000)", "expected them in a buffer"},
      {R"("children":[1])", R"("children":[0])", ""},
      {R"("children":[1])",
       R"("children":{},"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1}}})",
       "children that are no list"},
      {R"("mesh":0,"children")", R"("mesh":"0","children")", "has no right mesh"},
      {R"("bufferViews":[)", R"("bufferViews":7,"x":[)", "of its bufferViews"},
      {R"("accessors":[)", R"("accessors":{},"x":[)", "of its accessors"},
      {R"("nodes":[{)", R"("nodes":[7,null,[],{)", ""},
      {R"("asset":)", R"("asset":)" + std::string(100'000, '[') + std::string(100'000, ']') + R"(,"a":)",
       "is nested more than 200 deep"},
      {R"("asset":)", R"("extras":)" + std::string(100'000, '{'), "is nested more than 200 deep"},
      {R"("asset":)", "\"\xFF\xC0\x80\":\"\xED\xA0\x80\",\"asset\":", ""},
      {R"("asset":)", R"("\ud800":1,"asset":)", "is no right JSON"},
      {R"("asset":)", R"("a":NaN,"asset":)", "is no right JSON"},
      {R"("asset":)", R"("a":1e999,"asset":)", "is no right JSON"},
      {R"("name":"m")", R"("name":"\u00010")", ""},
      {R"("uri":"data:application/octet-stream;base64,)", R"("uri":"data:)", "expected them in a buffer"},
      {R"("uri":"data:application/octet-stream;base64,)", R"("uri":"<document>.gltf","x":")", ""},
      {R"("uri":"data:application/octet-stream;base64,)", R"("uri":"/dev/zero","x":")", ""},
      {R"("uri":"data:application/octet-stream;base64,)", R"("uri":"a.gltf","x":")", ""},
      {R"("uri":"data:application/octet-stream;base64,)", R"("uri":"none.bin","x":")",
       "could not open referenced file 'none.bin'"}};
  CHECK(lies.size() >= 40);
  for (const Lie& lie : lies) {
    const std::string name = lie.to.substr(0, 200);
    CAPTURE(name);
    REQUIRE(sound.find(lie.from) != sound.npos);
    std::string text = sound;
    text.replace(text.find(lie.from), lie.from.size(), lie.to);
    const std::string found = problem(text);
    CAPTURE(found);
    CHECK(contains(found, lie.expected));
  }
  CHECK(contains(problem("[]"), "expected a JSON object"));
  CHECK(contains(problem(std::string(40'000'000, '[')), "is nested more than 200 deep"));
  CHECK(contains(problem("{\"asset\":\"" + std::string(40'000'000, 'x')), "is no right JSON"));
  REQUIRE(problem(sound_binary) == "no error");
  for (std::size_t size = 4; size < sound_binary.size(); size += 1 + size / 8) {
    CAPTURE(size);
    CHECK(contains(problem(sound_binary.substr(0, size)), "ends within its"));
  }
  for (const std::size_t at : {std::size_t{12}, sound_binary.find("BIN") - 4}) {
    std::string longer = sound_binary;
    longer.replace(at, 4, "\xFF\xFF\xFF\x7F");
    CHECK(contains(problem(longer), "ends within its chunk of 2147483647 bytes"));
  }
  rusage used{};
  REQUIRE(::getrusage(RUSAGE_CHILDREN, &used) == 0);
  CHECK(used.ru_maxrss < 2'000'000);  // [KiB]
}

TEST_CASE("bones and whole numbers without their extension are refused") {
  const Folder folder;
  Gltf gltf = quantized_file<std::uint8_t>({1, 2, 3, 255, 0, 0, 0, 9, 0}, 5121, "", "", R"(,"skin":0)");
  const auto problem = [&] {
    return support::file_error([&] { (void)read_mesh_file(folder.write("a.gltf", gltf.text())); }).problem();
  };
  CHECK(contains(problem(), "has bones and quantized positions: expected a file as gltfpack makes with -noq"));
  gltf.more.clear();
  CHECK(contains(problem(), "has positions of the component type 5121 (accessor 0)"));
}
