// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/detail/mesh_file/mesh_rules.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <assimp/scene.h>
#include <doctest/doctest.h>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>

#include <pulsecast/io/mesh_file.hpp>

#include "support/fbx.hpp"
#include "support/format_cases.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

namespace {

/// A triangle, in inches, x up, with these elements in its places.
std::string dae(const std::string& of_asset, const std::string& of_node = "", const std::string& of_mesh = "",
                const std::string& of_file = "") {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
         of_asset + "</asset>" + of_file + R"(<library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="a" count="9">0 0 0 4 0 0 4 2 0</float_array><technique_common><accessor source="#a" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
</source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>)" +
         of_mesh +
         R"(</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">)" +
         of_node + R"(<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string replaced(std::string text, const std::string& part, const std::string& other) {
  return text.replace(text.find(part), part.size(), other);
}

/// The triangle as assimp's exporter writes it, with a comment.
std::string fbx(const support::TemporaryFolder& folder, const std::string& comment) {
  Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFile(folder.write("b.dae", dae("")).string(), 0);
  REQUIRE(scene != nullptr);
  REQUIRE(Assimp::Exporter().Export(scene, "fbxa", (folder / "b.fbx").string()) == aiReturn_SUCCESS);
  return support::content(folder / "b.fbx") + "; " + comment + "\n";
}

}  // namespace

TEST_CASE("each element of DAE and FBX files that changes a mesh is read, noted or refused by its rule") {
  const support::TemporaryFolder folder;
  const auto height = [&](const std::string& name, const std::string& text) {
    const MeshFile file = read_mesh_file(folder.write(name, text));
    double top = 0;
    for (const Vec3& vertex : file.meshes.at(0).mesh.vertices)
      top = std::fmax(top, file.placements.at(0).placement.point(vertex).z);
    return top;
  };
  const auto of_dae = [&](const std::string& asset, const std::string& node = "", const std::string& file = "") {
    return [=, &folder] { return read_mesh_file(folder.write("a.dae", dae(asset, node, "", file))).warnings; };
  };
  const auto of_fbx = [&](const std::string& comment) {
    return [=, &folder] { return read_mesh_file(folder.write("a.fbx", fbx(folder, comment))).warnings; };
  };
  const std::vector<test::FormatCase> cases{
      {"<unit",
       [&] {
         CHECK(height("a.dae", dae(R"(<unit meter="0.5"/>)")) == doctest::Approx(1));
         return std::vector<std::string>{};
       }},
      {"<up_axis",
       [&] {
         CHECK(height("a.dae", dae("<up_axis>X_UP</up_axis>")) == doctest::Approx(4));
         return std::vector<std::string>{};
       }},
      {"UnitScaleFactor", of_fbx("")},
      {"UpAxis", of_fbx("")},
      {"<ph>", of_dae("", "<ph>")},
      {"<lookat", of_dae("", "<lookat>1 2 3 0 0 0 0 0 1</lookat>")},
      {"params of other names",
       [&] {
         const auto read = [&](const std::string& part, const std::string& other) {
           return read_mesh_file(folder.write("a.dae", replaced(dae(""), part, other))).warnings;
         };
         for (const char* name : {"", "name=\"z\"", "name=\"W\""})
           CHECK_THROWS_AS((void)read("name=\"Z\"", name), FileError);
         CHECK(read("<source", R"(<source id="t"><float_array id="b" count="2">0 1</float_array><technique_common>
<accessor source="#b" count="1" stride="2"><param name="S"/><param name='T' type="float"/></accessor>
</technique_common></source><source)")
                   .empty());
         return read("<param name=\"Z\" type=\"float\"/>", "");
       }},
      {"<visibility>0",
       of_dae("", "<extra><technique profile=\"FCOLLADA\"><visibility>0</visibility></technique></extra>")},
      {"<skew", of_dae("", "<skew>45 0 1 0 1 0 0</skew>")},
      {"<animation", of_dae("", "", R"(<library_animations><animation id="x"/></library_animations>)")},
      {"<spline", of_dae("", "", "<library_geometries><geometry id=\"h\"><spline/></geometry></library_geometries>")},
      {"<convex_mesh",
       of_dae("", "", "<library_geometries><geometry id=\"h\"><convex_mesh/></geometry></library_geometries>")},
      {".dae#", of_dae("", R"(<instance_node url="other.dae#n"/>)")},
      {"<geographic_location", of_dae("<coverage><geographic_location/></coverage>")},
      {"AnimationCurve", of_fbx("AnimationCurve")},
      {"LodGroup", of_fbx("LodGroup")},
      {"NurbsSurface", of_fbx("NurbsSurface")}};
  test::check_rules(io::detail::mesh_rules, cases);
}
