// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/scene_files.hpp>

#include <filesystem>
#include <fstream>
#include <set>
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
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(*this / name, std::ios::binary) << text;
  }

  [[nodiscard]] std::set<std::string> files(const PartSource& source) const {
    SceneSettings scene;
    scene.parts.push_back({.source = source});
    return names(scene_files(scene));
  }
  [[nodiscard]] static std::set<std::string> names(const std::set<std::filesystem::path>& paths) {
    std::set<std::string> all;
    for (const std::filesystem::path& path : paths) all.insert(path.filename().string());
    return all;
  }
};

using Names = std::set<std::string>;

TEST_CASE("an OBJ file has ground if one of the MTL files that it names has, as one name and as several") {
  const std::string text =
      "# mtllib\nmtllib a.mtl b.mtl\r\n  mtllib c d.mtl\nv 0 0 0\nmtllib .\\g.mtl missing.mtl \\\n e.mtl\nmtllib f.mtl";
  for (const std::string name : {"a.mtl", "b.mtl", "c d.mtl", "e.mtl", "f.mtl", "g.mtl", "not me.mtl"}) {
    CAPTURE(name);
    const Folder folder({});
    folder.put("x.obj", text);
    folder.put(name, "newmtl a\nKd 1 1 1\nhelios_isGround true\n");
    SceneSettings scene;
    scene.parts.push_back({.source = ObjSource{{folder / "x.obj"}}});
    CHECK(has_ground(scene) == (name != "not me.mtl"));
    scene.parts[0].source = MeshSource{.files = {folder / "x.obj"}};
    CHECK(has_ground(scene) == (name != "not me.mtl"));
  }
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
  folder.put("c.mtl", "newmtl\n");  // cannot be read: its error is that of the builder
  CHECK(ground(XyzSource{.files = {folder / "p.xyz"}, .material = {.file = folder / "c.mtl"}}));
}

TEST_CASE("sources bring the files that their settings name, there or not, each once") {
  const Folder folder({"a.tif", "b.tif", "c.asc", "m.mtl", "v.vox", "l.txt", "p.xyz", "y.obj"});
  CHECK(folder.files(GeoTiffSource{{folder / "a.tif", folder / "b.tif"}, {folder / "m.mtl", {}}}) ==
        Names{"a.tif", "b.tif", "m.mtl"});
  CHECK(folder.files(GeoTiffSource{.files = {folder / "a.tif"}, .classes = folder / "c.asc"}) ==
        Names{"a.tif", "c.asc"});
  CHECK(folder.files(XyzSource{.files = {folder / "p.xyz", folder / "q.xyz"}}) == Names{"p.xyz", "q.xyz"});
  CHECK(folder.files(VoxelSource{.files = {folder / "v.vox"}, .leaf_angles = folder / "l.txt"}) ==
        Names{"v.vox", "l.txt"});
  CHECK(folder.files(MeshSource{.files = {folder / "a.gltf"}, .materials = folder / "m.mtl"}) ==
        Names{"a.gltf", "m.mtl"});
  SceneSettings scene;
  scene.parts.resize(3, {.source = ObjSource{{folder / "y.obj"}}});
  scene.parts[1].source = XyzSource{.files = {folder / "p.xyz"}};
  scene.parts[1].swaps = {{.source = GeoTiffSource{{folder / "a.tif"}, {}}}, {.removes = true}};
  CHECK(Folder::names(scene_files(scene)) == Names{"y.obj", "p.xyz", "a.tif"});
  CHECK(scene_files({}).empty());
}

}  // namespace
}  // namespace pulsecast::helios
