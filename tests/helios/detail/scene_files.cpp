// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/scene_files.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/temporary_folder.hpp"

namespace pulsecast::helios {
namespace {

using support::TemporaryFolder;

struct Folder : TemporaryFolder {
  explicit Folder(const std::vector<std::string>& names) {
    for (const std::string& name : names) put(name, "something\n");
  }
  void put(const std::string& name, const std::string& text) const { std::ofstream(*this / name, std::ios::binary) << text; }

  [[nodiscard]] std::vector<std::string> files(const PartSource& source) const {
    SceneSettings scene;
    scene.parts.push_back({.source = source});
    return names(scene_files(scene));
  }
  [[nodiscard]] static std::vector<std::string> names(const std::vector<std::filesystem::path>& paths) {
    std::vector<std::string> all;
    for (const std::filesystem::path& path : paths) all.push_back(path.filename().string());
    return all;
  }
};

using Names = std::vector<std::string>;

TEST_CASE("an OBJ file brings the materials that it names, as one name and as several") {
  const Folder folder({"a.mtl", "b.mtl", "c d.mtl", "e.mtl", "f.mtl", "not me.mtl"});
  folder.put("x.obj", "# mtllib\nmtllib a.mtl b.mtl\r\n  mtllib c d.mtl\nv 0 0 0\nmtllib .\\a.mtl missing.mtl \\\n e.mtl\nmtllib f.mtl");
  const Names found = folder.files(ObjSource{{folder / "x.obj"}});
  for (const char* name : {"x.obj", "a.mtl", "b.mtl", "c d.mtl", "e.mtl", "f.mtl"})
    CHECK_MESSAGE(std::find(found.begin(), found.end(), name) != found.end(), name);
  CHECK(std::find(found.begin(), found.end(), "not me.mtl") == found.end());
  CHECK(std::find(found.begin(), found.end(), "missing.mtl") == found.end());
}

TEST_CASE("an MTL file brings the pictures that it names") {
  const Folder folder({"leaf.png", "bark.jpg"});
  folder.put("a.mtl", "newmtl a\nmap_Kd .\\leaf.png\nmap_d missing.png\nnewmtl b\npulsecast_reflectanceMap bark.jpg\n");
  folder.put("x.obj", "mtllib a.mtl\n");
  CHECK(folder.files(ObjSource{{folder / "x.obj"}}) == Names{"x.obj", "a.mtl", "leaf.png", "bark.jpg"});
}

TEST_CASE("a mesh file brings the buffers and pictures that it names, in text and in binary, and its table of materials") {
  const Folder folder({"a.bin", "leaf one.png", "bark.JPG", "sky.png", "t.mtl", "b.mtl"});
  folder.put("a.gltf", R"({"buffers":[{"uri":"a.bin"}],"images":[{"uri":"leaf%20one.png"},{"uri":"none.png"}]})");
  folder.put("b.fbx", std::string("S\x15\0\0\0", 5) + "C:\\old\\folder\\bark.JPG" + std::string(3, '\0'));
  folder.put("c.dae", "<init_from>./sky.png</init_from>");
  CHECK(folder.files(MeshSource{.files = {folder / "a.gltf"}, .materials = folder / "t.mtl"}) ==
        Names{"a.gltf", "t.mtl", "a.bin", "leaf one.png"});
  CHECK(folder.files(MeshSource{.files = {folder / "b.fbx", folder / "c.dae"}}) == Names{"b.fbx", "c.dae", "bark.JPG", "sky.png"});
  folder.put("d.obj", "mtllib b.mtl\n");
  CHECK(folder.files(MeshSource{.files = {folder / "d.obj"}}) == Names{"d.obj", "b.mtl"});
}

TEST_CASE("a scene has ground if any of its MTL files says so") {
  const Folder folder({"p.xyz", "v.vox"});
  folder.put("a.mtl", "newmtl a\nKd 1 1 1\n# helios_isGround true\nhelios_isGround false\n");
  folder.put("b.mtl", "newmtl b\n  helios_isGround TRUE\r\n");
  folder.put("a.obj", "mtllib a.mtl\nv 0 0 0\n");
  folder.put("ab.obj", "mtllib a.mtl b.mtl\nv 0 0 0\n");
  const auto ground = [](const PartSource& source) {
    SceneSettings scene;
    scene.parts.push_back({.source = ObjSource{}});
    scene.parts[0].swaps.push_back({.source = source});
    return has_ground(scene);
  };
  CHECK_FALSE(ground(ObjSource{{folder / "a.obj"}}));
  CHECK(ground(ObjSource{{folder / "ab.obj"}}));
  CHECK_FALSE(ground(XyzSource{.files = {folder / "p.xyz"}, .material = {.file = folder / "a.mtl"}}));
  CHECK(ground(XyzSource{.files = {folder / "p.xyz"}, .material = {.file = folder / "b.mtl"}}));
  CHECK_FALSE(ground(XyzSource{.files = {folder / "b.mtl"}}));  // not as a material
  CHECK_FALSE(has_ground({}));
  folder.put("c.mtl", "newmtl c\nNs -1\n");  // cannot be read: its error is that of the builder
  CHECK(ground(XyzSource{.files = {folder / "p.xyz"}, .material = {.file = folder / "c.mtl"}}));
}

TEST_CASE("other sources bring the files that their settings name; each counts once, and those that are not there do not") {
  const Folder folder({"a.tif", "b.tif", "c.asc", "m.mtl", "v.vox", "l.txt", "p.xyz", "y.obj"});
  CHECK(folder.files(GeoTiffSource{{folder / "a.tif", folder / "b.tif"}, {folder / "m.mtl", {}}}) == Names{"a.tif", "b.tif", "m.mtl"});
  CHECK(folder.files(GeoTiffSource{.files = {folder / "a.tif"}, .classes = folder / "c.asc"}) == Names{"a.tif", "c.asc"});
  CHECK(folder.files(XyzSource{.files = {folder / "p.xyz", folder / "q.xyz"}}) == Names{"p.xyz"});
  CHECK(folder.files(VoxelSource{.files = {folder / "v.vox"}, .leaf_angles = folder / "l.txt"}) == Names{"v.vox", "l.txt"});
  SceneSettings scene;
  scene.parts.resize(3, {.source = ObjSource{{folder / "y.obj"}}});
  scene.parts[1].source = XyzSource{.files = {folder / "p.xyz"}};
  scene.parts[1].swaps = {{.source = GeoTiffSource{{folder / "a.tif"}, {}}}, {.removes = true}};
  CHECK(Folder::names(scene_files(scene)) == Names{"y.obj", "p.xyz", "a.tif"});
  CHECK(scene_files({}).empty());
}

}  // namespace
}  // namespace pulsecast::helios
