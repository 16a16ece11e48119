// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/mesh_file.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <assimp/scene.h>
#include <doctest/doctest.h>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>

#include <pulsecast/io/detail/mesh_file/file_maker.hpp>
#include <pulsecast/io/detail/mesh_file/raw_scene.hpp>
#include <pulsecast/pulsecast.hpp>

#include "support/fbx.hpp"
#include "support/file_errors.hpp"
#include "support/generators.hpp"
#include "support/gltf.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using namespace pulsecast::literals;
using support::contains;
using support::Gltf;

namespace {

using Folder = support::TemporaryFolder;

const std::vector<Gltf::Place> corners{{1, 2, 3}, {2, 2, 3}, {1, 4, 3}};
const std::vector<Gltf::Corners> one_triangle{{0, 1, 2}};

/// A file of one triangle and these members of its node.
Gltf triangle_file(const std::string& node = "", const std::string& primitive = "") {
  Gltf gltf;
  gltf.primitive(corners, one_triangle, primitive);
  gltf.mesh("triangle");
  gltf.node("\"mesh\":0" + node);
  return gltf;
}

/// Corners of the triangles of all placements, in the world.
std::vector<Vec3> world_corners(const MeshFile& file) {
  std::vector<Vec3> all;
  for (const MeshPlacement& one : file.placements)
    for (const auto& triangle : file.meshes[one.mesh].mesh.triangles)
      for (const std::uint32_t corner : triangle)
        all.push_back(one.placement.point(file.meshes[one.mesh].mesh.vertices[corner]));
  return all;
}

double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::fmax(most, length(a[i] - b[i]));
  return most;
}

bool warns(const MeshFile& file, const std::string& text) {
  return std::any_of(file.warnings.begin(), file.warnings.end(),
                     [&](const std::string& one) { return contains(one, text); });
}

/// A scene of random blobs in a room of 8 m, y up, as an OBJ file.
std::string blobs(std::uint64_t seed) {
  support::Generator random(seed);
  std::string text =
      "o room\nv -4 -4 -4\nv 4 -4 -4\nv -4 4 -4\nv 4 4 -4\nv -4 -4 4\nv 4 -4 4\nv -4 4 4\nv 4 4 4\n"
      "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n";
  int vertices = 8;
  for (int blob = 0; blob < 6; ++blob) {
    text += "o blob" + std::to_string(blob) + "\n";
    const Vec3 centre = random.point(3);
    for (int face = 0; face < 40; ++face) {
      for (int k = 0; k < 3; ++k) {
        const Vec3 at = centre + random.point(0.5);
        text += "v " + std::to_string(at.x) + " " + std::to_string(at.y) + " " + std::to_string(at.z) + "\n";
      }
      text += "f " + std::to_string(vertices + 1) + " " + std::to_string(vertices + 2) + " " +
              std::to_string(vertices + 3) + "\n";
      vertices += 3;
    }
  }
  return text;
}

/// A file by assimp's own exporter.
std::filesystem::path exported(const std::filesystem::path& from, const std::filesystem::path& to,
                               const std::string& format) {
  Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFile(from.string(), 0);
  REQUIRE(scene != nullptr);
  REQUIRE(Assimp::Exporter().Export(scene, format, to.string()) == aiReturn_SUCCESS);
  if (format != "fbx") return to;
  const std::string bytes = support::FbxLists::ended(support::content(to));
  std::filesystem::remove(to);
  std::ofstream(to, std::ios::binary) << bytes;
  return to;
}

Cloud scan(std::vector<Part<MaskedMesh<>>> parts) {
  const Scene<MaskedMesh<>> scene(std::move(parts));
  const Deflector sweeping{PolygonMirror{.line_rate = 200_Hz}, Scanner{.pulse_rate = 20_kHz, .pulses = 20'000}};
  const Platform platform{Tripod{.position = {0, 0, 0}}, Mount{},
                          Deflector{RotatingHead{.angular_rate = 360_deg}, sweeping}};
  const Survey survey{platform, SingleRay{}, scene, Receiver{}, FirstHit{}, 7};
  Cloud cloud;
  run(survey, {}, cloud);
  return cloud;
}

}  // namespace

TEST_CASE("a triangle of a glTF file stands z up, in metres, with the names of its nodes") {
  const Folder folder;
  Gltf gltf = triangle_file(",\"name\":\"leaf\"");
  gltf.node(R"("name":"tree","children":[0])");
  gltf.roots = "1";
  for (const auto& path : {folder.write("a.gltf", gltf.text()), folder.write("b.glb", gltf.binary())}) {
    const MeshFile file = read_mesh_file(path);
    REQUIRE(file.placements.size() == 1);
    CHECK(file.warnings.empty());
    CHECK(file.placements[0].name == "tree/leaf");
    CHECK(distance(world_corners(file), {{1, -3, 2}, {2, -3, 2}, {1, -3, 4}}) < 1e-14);
    CHECK(distance(world_corners(read_mesh_file(path, {.up = UpAxis::z, .unit = 0.5})),
                   {{0.5, 1, 1.5}, {1, 1, 1.5}, {0.5, 2, 1.5}}) < 1e-14);
  }
}

TEST_CASE("one model in all formats gives the same points") {
  const Folder folder;
  const auto obj = folder.write("a.obj", blobs(3));
  const auto parts = [](const std::filesystem::path& path, const MeshFileSettings& settings) {
    const MeshFile file = read_mesh_file(path, settings);
    CAPTURE(path.string());
    CHECK(file.triangle_count() == 12 + 6 * 40);
    return parts_of(file);
  };
  const Cloud cloud = scan(parts(obj, {.up = UpAxis::y}));
  CHECK(cloud.size() == 20'000);
  struct Format {
    std::string name, ending;
    MeshFileSettings settings;
    double tolerance;  ///< of a point, as coordinates of 4 m are good to 2.4e-7 m in single precision [m]
  };
  const std::vector<Format> formats{{"obj", "a2.obj", {.up = UpAxis::y}, 2e-6},
                                    {"ply", "a.ply", {.up = UpAxis::y}, 2e-6},
                                    {"plyb", "b.ply", {.up = UpAxis::y}, 2e-6},
                                    {"gltf2", "a.gltf", {}, 2e-6},
                                    {"glb2", "a.glb", {}, 2e-6},
                                    {"stl", "a.stl", {.up = UpAxis::y}, 2e-6},
                                    {"stlb", "b.stl", {.up = UpAxis::y}, 2e-6},
                                    {"collada", "a.dae", {}, 2e-6},
                                    {"fbxa", "a.fbx", {.unit = 1}, 2e-6},
                                    {"fbx", "b.fbx", {.unit = 1}, 2e-6}};
  for (const Format& format : formats) {
    CAPTURE(format.name);
    const auto path = exported(obj, folder / format.ending, format.name);
    const auto from_file = parts(path, format.settings);
    if (contains(format.name, "stl") || contains(format.name, "ply") || contains(format.name, "obj")) {
      CHECK(from_file.size() == 1);
    } else {
      REQUIRE(from_file.size() == 7);
      CHECK(from_file[0].name.ends_with("room"));
      CHECK(from_file[6].name.ends_with("blob5"));
      CHECK(from_file[6].object == 6);
    }
    const Cloud other = scan(from_file);
    REQUIRE(other.size() == cloud.size());
    double most = 0;
    std::size_t elsewhere = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const double off = length(cloud.points[i] - other.points[i]);
      if (off > 0.01)
        ++elsewhere;  // a ray at the edge of a triangle
      else
        most = std::fmax(most, off);
    }
    CHECK(elsewhere <= 2);
    CHECK(most <= format.tolerance);
  }
}

TEST_CASE("instances share a mesh: a thousand trees take the memory of one") {
  const Folder folder;
  support::Generator random(11);
  const auto forest = [&](std::size_t trees) {
    Gltf gltf;
    std::vector<Gltf::Place> vertices;
    std::vector<Gltf::Corners> triangles;
    for (std::uint32_t i = 0; i < 3000; ++i) {
      const Vec3 at = random.point(2);
      vertices.push_back({static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)});
      if (i % 3 == 2) triangles.push_back({i - 2, i - 1, i});
    }
    gltf.primitive(vertices, triangles);
    gltf.mesh("tree");
    gltf.roots.clear();
    for (std::size_t i = 0; i < trees; ++i) {
      const Rotation turn = random.rotation();
      const auto text = [](double number) { return text::to_text(number); };
      gltf.node("\"mesh\":0,\"name\":\"tree_" + std::to_string(i) + "\",\"translation\":[" +
                text(random.uniform(-100, 100)) + ",0," + text(random.uniform(-100, 100)) + "],\"rotation\":[" +
                text(turn.x) + "," + text(turn.y) + "," + text(turn.z) + "," + text(turn.w) + "],\"scale\":[" +
                (i % 2 == 0 ? "2.3,2.3,2.3" : "0.7,0.7,0.7") + "]");
      gltf.roots += (i > 0 ? "," : "") + std::to_string(i);
    }
    return read_mesh_file(folder.write("forest" + std::to_string(trees) + ".gltf", gltf.text()));
  };
  MeshFile one = forest(1), thousand = forest(1000);
  CHECK(thousand.warnings.empty());
  CHECK(thousand.meshes.size() == 1);
  REQUIRE(thousand.placements.size() == 1000);
  CHECK(thousand.placements[999].name == "tree_999");
  CHECK(thousand.triangle_count() == 1'000'000);
  const Scene<MaskedMesh<>> small(parts_of(std::move(one))), large(parts_of(std::move(thousand), 5));
  CHECK(large.parts()[999].object == 1004);
  CHECK(large.parts()[0].geometry == large.parts()[999].geometry);
  CHECK(large.parts()[0].materials == large.parts()[999].materials);
  CHECK(large.memory() - small.memory() < 999 * (sizeof(large.parts()[0]) + 200));  // placement, box, name and index
  CHECK(large.memory() < 20 * small.memory());
}

TEST_CASE("random nodes place meshes as their matrices do, to single precision") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const Folder folder;
    const auto list = [](const std::vector<double>& numbers) {
      std::string text;
      for (const double number : numbers) text += (text.empty() ? "[" : ",") + text::to_text(number);
      return text + "]";
    };
    std::array<io::detail::Affine, 2> place;
    std::array<std::string, 2> node;
    const bool similar = seed % 2 == 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const Rotation turn = random.rotation();
      const double scale = random.log_uniform(0.1, 10);
      const Vec3 sizes =
          similar ? Vec3(scale)
                  : Vec3(scale, random.log_uniform(0.1, 10) * (random.coin() ? 1 : -1), random.log_uniform(0.1, 10));
      const Vec3 shift = random.point(30);
      const Matrix3 m = matrix_of(turn);
      place[i] = {Matrix3(m[0] * sizes.x, m[1] * sizes.y, m[2] * sizes.z), shift};
      node[i] = "\"rotation\":" + list({turn.x, turn.y, turn.z, turn.w}) +
                ",\"scale\":" + list({sizes.x, sizes.y, sizes.z}) +
                ",\"translation\":" + list({shift.x, shift.y, shift.z});
    }
    Gltf gltf = triangle_file("," + node[0]);
    gltf.node(node[1] + ",\"children\":[0]");
    gltf.roots = "1";
    const MeshFile file = read_mesh_file(folder.write("a.gltf", gltf.text()));
    const io::detail::Affine all = place[1] * place[0];
    std::vector<Vec3> expected;
    for (const Gltf::Place& c : corners) {
      const Vec3 p =
          all.linear * Vec3(static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])) +
          all.shift;
      expected.push_back({p.x, -p.z, p.y});
    }
    const bool mirrored = dot(all.linear[0], cross(all.linear[1], all.linear[2])) < 0;
    if (mirrored) std::swap(expected[1], expected[2]);  // so that the side in front stays so
    CHECK(distance(world_corners(file), expected) < 1e-6 * 2000);
    CHECK(warns(file, "shear, mirror or stretch") == !similar);
  }
}

TEST_CASE("a mirrored node turns its triangles over, and shares its mesh with others of the same shape") {
  const Folder folder;
  Gltf gltf = triangle_file();
  gltf.node(R"("mesh":0,"scale":[-1,1,1])");
  gltf.node(R"("mesh":0,"scale":[-3,3,3],"rotation":[0,0.6,0,0.8],"translation":[5,0,0])");
  gltf.node(R"("mesh":0,"scale":[1,1.5,1])");
  gltf.node(R"("mesh":0,"scale":[0,1,1])");
  gltf.roots = "0,1,2,3,4";
  const MeshFile file = read_mesh_file(folder.write("a.gltf", gltf.text()));
  REQUIRE(file.placements.size() == 4);
  CHECK(file.meshes.size() == 3);
  CHECK(file.placements[1].mesh == file.placements[2].mesh);
  CHECK(warns(file, "3 nodes shear, mirror or stretch their meshes, which become 2 meshes"));
  CHECK(warns(file, "1 nodes whose transforms flatten"));
  const std::vector<Vec3> all = world_corners(file);
  const auto normal = [&](std::size_t i) { return Triangle{all[3 * i], all[3 * i + 1], all[3 * i + 2]}.normal(); };
  CHECK(length(normal(0) - Vec3(0, -1, 0)) < 1e-12);  // +z of the file
  CHECK(length(normal(1) - normal(0)) < 1e-12);
  CHECK(length(all[3] - Vec3(-1, -3, 2)) < 1e-12);
}

TEST_CASE("parts of a mesh in several materials are one object") {
  const Folder folder;
  Gltf gltf;
  gltf.primitive(corners, one_triangle, R"(,"material":1)");
  gltf.primitive(corners, {{0, 2, 1}, {0, 1, 2}}, R"(,"material":0)");
  gltf.primitive(corners, {{0, 1, 2}, {0, 1, 1}}, R"(,"material":1)");
  gltf.primitive(corners, {{0, 1, 2}}, R"(,"mode":1)");
  gltf.mesh("house");
  gltf.material(R"("name":"roof")");
  gltf.material(R"("name":"wall")");
  gltf.node(R"("mesh":0,"name":"house")");
  const MeshFile file = read_mesh_file(folder.write("a.gltf", gltf.text()));
  REQUIRE(file.meshes.size() == 1);
  CHECK(file.meshes[0].mesh.materials == std::vector<std::uint32_t>{0, 1, 1, 0});
  REQUIRE(file.materials.size() == 2);
  CHECK(file.materials[0].name == "wall");
  CHECK(file.materials[1].name == "roof");
  CHECK(file.meshes[0].materials == std::vector<std::uint32_t>{0, 1});
  CHECK(warns(file, "1 triangles without area"));
  CHECK(warns(file, "points and lines are left out"));
}

TEST_CASE("materials of glTF: colour, glass, mirrors, facets, and a reflectance by colour on request") {
  const auto material = [](const std::string& members, const MeshFileSettings& settings = {}) {
    const Folder folder;
    Gltf gltf = triangle_file("", R"(,"material":0)");
    gltf.material("\"name\":\"m\"" + members);
    gltf.more = R"("extensionsUsed":["KHR_materials_transmission","KHR_materials_ior"],)";
    const MeshFile file = read_mesh_file(folder.write("a.gltf", gltf.text()), settings);
    REQUIRE(file.materials.size() == 1);
    CHECK(file.materials[0].name == "m");
    file.materials[0].validate();
    return file.materials[0];
  };
  const auto pbr = [](const std::string& members) { return ",\"pbrMetallicRoughness\":{" + members + "}"; };
  const Material plain = material(pbr(R"("baseColorFactor":[1,0.5,0,1],"metallicFactor":0)"));
  CHECK(plain.reflectance == 0.5);
  CHECK(plain.law.get<Lambert>());
  CHECK_FALSE(plain.smooth.passes_light());
  CHECK(plain.colour.x == doctest::Approx(1));
  CHECK(plain.colour.y == doctest::Approx(0.735357).epsilon(1e-5));  // sRGB of 0.5
  CHECK(plain.colour.z == 0);
  CHECK(material(pbr(R"("baseColorFactor":[1,0.5,0,1])"), {.reflectance_of_colour = true}).reflectance ==
        doctest::Approx(0.2126 + 0.5 * 0.7152).epsilon(1e-6));

  const Material rough = material(pbr(R"("metallicFactor":0,"roughnessFactor":0.5)"));
  CHECK(rough.law.get<Microfacet>());
  CHECK(rough.law.get<Microfacet>()->slope == doctest::Approx(0.25));

  const Material chrome = material(pbr(R"("metallicFactor":1,"roughnessFactor":0.05)"));
  CHECK(chrome.smooth.kind == InterfaceKind::mirror);
  CHECK(chrome.smooth.reflectance == doctest::Approx(0.5));  // the rest of the light
  CHECK_FALSE(material(pbr(R"("metallicFactor":1,"roughnessFactor":0.6)")).smooth.passes_light());

  const Material pane =
      material(pbr(R"("baseColorFactor":[1,1,1,0.25],"metallicFactor":0)") + R"(,"alphaMode":"BLEND")");
  CHECK(pane.smooth.kind == InterfaceKind::dielectric);
  CHECK(pane.smooth.inside.index == SmoothInterface::glass().inside.index);
  CHECK(pane.reflectance == doctest::Approx(0.125));
  CHECK_FALSE(material(pbr(R"("baseColorFactor":[1,1,1,0.25],"metallicFactor":0)"))
                  .smooth.passes_light());  // opaque by the mode
  const Material hidden =
      material(pbr(R"("baseColorFactor":[1,1,1,0.25],"metallicFactor":0)") + R"(,"alphaMode":"MASK")");
  CHECK(hidden.reflectance == 0);  // below the cutoff, with any picture
  CHECK(hidden.smooth.passes_light());
  CHECK_FALSE(material(pbr(R"("baseColorFactor":[1,1,1,0.75],"metallicFactor":0)") + R"(,"alphaMode":"MASK")")
                  .smooth.passes_light());
  const Material glass = material(pbr(R"("metallicFactor":0)") +
                                  R"(,"extensions":{"KHR_materials_transmission":{"transmissionFactor":1}})");
  CHECK(glass.smooth.kind == InterfaceKind::dielectric);
  CHECK(glass.reflectance == 0);
}

TEST_CASE("materials of an MTL file take the place of those of the same name") {
  const Folder folder;
  Gltf gltf = triangle_file("", R"(,"material":0)");
  gltf.material(R"("name":"grass","pbrMetallicRoughness":{"baseColorFactor":[0,1,0,1]})");
  const auto table = folder.write(
      "table.mtl", "newmtl grass\nKd 1 1 1\nhelios_reflectance 0.3\nhelios_classification 2\nhelios_isGround true\n");
  const MeshFile file = read_mesh_file(folder.write("a.gltf", gltf.text()), {.materials = table});
  CHECK(file.materials[0].reflectance == 0.3);
  CHECK(file.materials[0].classification == 2);
  CHECK(file.materials[0].ground);
  CHECK(length(file.materials[0].colour - Vec3(0, 1, 0)) < 1e-12);
}

TEST_CASE("a picture inside a file colours its points, and its opacity makes holes") {
  const Folder folder;
  std::string targa(18, '\0');  // two pixels, red with opacity 0 and blue with 255, uncompressed with rows from the top
  targa[2] = 2;
  targa[12] = 2;
  targa[14] = 1;
  targa[16] = 32;
  targa[17] = 0x28;
  targa += std::string("\0\0\xFF\0\xFF\0\0\xFF", 8);
  const auto file_of = [&](const std::string& mode, bool outside) {
    Gltf gltf;
    gltf.primitive(corners, one_triangle, R"(,"material":0)", {{0.1F, 0.2F}, {0.9F, 0.2F}, {0.1F, 0.7F}});
    gltf.mesh("leaf");
    gltf.node("\"mesh\":0");
    gltf.material(R"("name":"leaf","pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"alphaMode":")" + mode +
                  "\"");
    const std::string view = gltf.view(targa.data(), targa.size());
    gltf.more = R"("textures":[{"source":0}],"images":[{)" +
                (outside ? R"("uri":"leaf%20one.tga")" : R"("mimeType":"image/png","bufferView":)" + view) + "}],";
    if (outside) folder.write("leaf one.tga", targa);
    return read_mesh_file(folder.write("a.glb", gltf.binary()));
  };
  for (const bool outside : {false, true}) {
    CAPTURE(outside);
    const MeshFile masked = file_of("MASK", outside);
    CHECK(masked.warnings.empty());
    REQUIRE(masked.materials[0].picture);
    CHECK(masked.materials[0].picture->width == 2);
    REQUIRE(masked.meshes[0].mesh.texture.size() == 1);
    CHECK(length(masked.meshes[0].mesh.texture[0][0] - Vec2(0.1, 0.8)) < 1e-7);  // upward from the lower left
    REQUIRE(masked.meshes[0].mesh.masks.size() == 1);
    CHECK(masked.meshes[0].mesh.masks[0].solid_share() == 0.5);
    CHECK(file_of("OPAQUE", outside).meshes[0].mesh.masks.empty());
    CHECK(file_of("BLEND", outside).meshes[0].mesh.masks.size() == 1);
  }
}

TEST_CASE("axes and units are those of the file, or of the settings") {
  const Folder folder;
  const auto obj = folder.write("a.obj", "v 1 2 3\nv 2 2 3\nv 1 4 3\nf 1 2 3\n");
  const auto replaced = [&](std::string text, const std::vector<std::pair<std::string, std::string>>& all) {
    for (const auto& [from, to] : all) {
      REQUIRE(contains(text, from));
      text.replace(text.find(from), from.size(), to);
    }
    return text;
  };
  const auto first = [&](const std::string& name, const std::string& text, const MeshFileSettings& settings = {}) {
    std::filesystem::remove(folder / name);
    return world_corners(read_mesh_file(folder.write(name, text), settings)).at(0);
  };
  const auto near = [](const Vec3& a, const Vec3& b) { return length(a - b) < 1e-6 * length(b); };

  const std::string dae = support::content(exported(obj, folder / "a.dae", "collada"));
  CHECK(near(first("b.dae", dae), {1, -3, 2}));
  const auto z_up = replaced(dae, {{"Y_UP", "Z_UP"}, {"meter=\"1\"", "meter=\"0.01\""}});
  CHECK(near(first("b.dae", z_up), {0.01, 0.02, 0.03}));
  CHECK(near(first("b.dae", z_up, {.unit = 2}), {2, 4, 6}));
  CHECK(near(first("b.dae", replaced(z_up, {{"meter=\"0.01\"", "meter='0.01'"}}), {.unit = 2}), {2, 4, 6}));
  CHECK(near(first("b.dae", replaced(z_up, {{"<asset>", "<!-- <unit meter=\"7\"/> --><asset>"}}), {.unit = 2}),
             {2, 4, 6}));
  CHECK(near(first("b.dae", z_up, {.up = UpAxis::y}), {0.01, -0.03, 0.02}));
  CHECK(near(first("b.dae", replaced(dae, {{"Y_UP", "X_UP"}})), {-2, -3, 1}));

  const std::string fbx = support::content(exported(obj, folder / "a.fbx", "fbxa"));
  const std::string up = "P: \"UpAxis\", \"int\", \"Integer\", \"\", ",
                    front = "P: \"FrontAxis\", \"int\", \"Integer\", \"\", ",
                    sign = "P: \"FrontAxisSign\", \"int\", \"Integer\", \"\", ",
                    unit = "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\", ";
  CHECK(near(first("b.fbx", fbx), {0.01, -0.03, 0.02}));
  const auto z_up_fbx = replaced(
      fbx, {{up + "1", up + "2"}, {front + "2", front + "1"}, {sign + "1", sign + "-1"}, {unit + "1", unit + "100"}});
  CHECK(near(first("b.fbx", z_up_fbx), {1, 2, 3}));
  CHECK(near(first("b.fbx", z_up_fbx, {.up = UpAxis::y, .unit = 3}), {3, -9, 6}));

  const std::string stl = support::content(exported(obj, folder / "a.stl", "stl")),
                    ply = support::content(exported(obj, folder / "a.ply", "ply"));
  CHECK(near(first("b.stl", stl), {1, 2, 3}));
  CHECK(near(first("b.ply", ply, {.up = UpAxis::y, .unit = 1e-3}), {1e-3, -3e-3, 2e-3}));
}

TEST_CASE("files outside the folder of a mesh are refused, unless allowed") {
  const Folder folder;
  std::filesystem::create_directory(folder / "inner");
  Gltf gltf = triangle_file();
  folder.write("a.bin", gltf.buffer());
  folder.write("inner/a.bin", gltf.buffer());
  for (const bool isolated : {false, true}) {
    CHECK(read_mesh_file(folder.write("inner/a.gltf", gltf.text("a.bin")), {.isolated = isolated}).triangle_count() ==
          1);
    for (const std::string& name : {std::string("../a.bin"), std::string("x/../../a.bin")}) {
      CAPTURE(name);
      const auto path = folder.write("inner/b.gltf", gltf.text(name));
      if (name == "x/../../a.bin") std::filesystem::create_directory(folder / "inner/x");
      CHECK(contains(support::file_error([&] { (void)read_mesh_file(path, {.isolated = isolated}); }).problem(),
                     "expected files in its own folder"));
      CHECK(read_mesh_file(path, {.files_elsewhere = true, .isolated = isolated}).triangle_count() == 1);
    }
  }
}

TEST_CASE("a mesh compressed by Draco is read, where assimp can") {
  const Folder folder;
  const std::string code =
      "445241434f02020100000001030100010201010009030000000000803f00000040000040400000004000000040000040400000803f000080"
      "4000004040";
  std::string bytes;
  for (std::size_t i = 0; i < code.size(); i += 2)
    bytes += static_cast<char>(std::stoi(code.substr(i, 2), nullptr, 16));
  folder.write("a.bin", bytes);
  const auto path =
      folder.write("a.gltf", R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_draco_mesh_compression"],
    "extensionsRequired":["KHR_draco_mesh_compression"],"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[
    {"attributes":{"POSITION":0},"indices":1,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}]}],
    "accessors":[{"componentType":5126,"type":"VEC3","count":3},{"componentType":5123,"type":"SCALAR","count":3}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":61}],"buffers":[{"byteLength":61,"uri":"a.bin"}]})");
  try {
    CHECK(distance(world_corners(read_mesh_file(path)), {{1, -3, 2}, {2, -3, 2}, {1, -3, 4}}) < 1e-14);
  } catch (const FileError& refused) {
    CHECK(contains(refused.problem(), "raco"));  // built without it
  }
}

TEST_CASE("positions that are whole numbers, and files of meshes without an area are refused") {
  const Folder folder;
  std::string whole = triangle_file().text();
  whole.replace(whole.find("5126"), 4, "5125");
  CHECK(contains(support::file_error([&] { (void)read_mesh_file(folder.write("a.gltf", whole)); }).problem(),
                 "has positions of the component type 5125 (accessor 0)"));
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string points = head +
                             "element face 2\nproperty list uchar int vertex_indices\nend_header\n5 5 5\n5 5 5\n5 5 "
                             "5\n5 5 5\n3 0 1 2\n3 1 2 3\n";
  CHECK(contains(support::file_error([&] { (void)read_mesh_file(folder.write("a.ply", points)); }).problem(),
                 "has triangles, and none with an area"));
}

TEST_CASE("polygons of any corner first fill what they enclose") {
  const Folder folder;
  const std::vector<std::array<double, 2>> notched{{-5, -5}, {5, -5}, {5, 5}, {0, 0}, {-5, 5}},
      arrow{{0, 0}, {4, -4}, {0, 4}, {-4, -4}}, square{{0, 0}, {3, 0}, {3, 2}, {0, 2}},
      bow{{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  struct Case {
    std::vector<std::array<double, 2>> outline;
    double area;
    bool crosses = false;
  };
  for (const Case& c : {Case{notched, 75}, {arrow, 16}, {square, 6}, {bow, 0, true}})
    for (std::size_t first = 0; first < c.outline.size(); ++first) {
      CAPTURE(first);
      const std::string count = std::to_string(c.outline.size());
      std::string text = "ply\nformat ascii 1.0\nelement vertex " + count +
                         "\nproperty float x\nproperty float y\nproperty float z\n" +
                         "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
      for (const auto& [x, y] : c.outline) text += std::to_string(x) + " " + std::to_string(y) + " 7\n";
      text += count;
      for (std::size_t k = 0; k < c.outline.size(); ++k) text += " " + std::to_string((first + k) % c.outline.size());
      const MeshFile file = read_mesh_file(folder.write("a.ply", text + "\n"));
      CHECK(warns(file, "1 polygons cross themselves") == c.crosses);
      if (c.crosses) continue;
      CHECK(file.warnings.empty());
      const std::vector<Vec3> all = world_corners(file);
      double area = 0, turned = 0;
      for (std::size_t k = 0; k + 2 < all.size(); k += 3) {
        const double one = cross(all[k + 1] - all[k], all[k + 2] - all[k]).z / 2;
        area += one;
        turned += one < 0 ? 1 : 0;
      }
      CHECK(area == doctest::Approx(c.area));
      CHECK(turned == 0);
    }
}

TEST_CASE("coordinates that single precision rounds by more than a millimetre are noted") {
  const Folder folder;
  const auto notes = [&](double x, double unit = 1) {
    Gltf gltf = triangle_file(",\"translation\":[" + std::to_string(x) + ",0,0]");
    return warns(read_mesh_file(folder.write("a.gltf", gltf.text()), {.unit = unit}),
                 "are read in single precision, to");
  };
  CHECK(notes(500000.13));
  CHECK(notes(-5.4e6));
  CHECK(notes(17000));
  CHECK_FALSE(notes(16000));
  CHECK_FALSE(notes(500000, 0.001));
  CHECK(notes(16000, 2));
  Gltf far = triangle_file(",\"translation\":[500000,0,0]");
  CHECK(warns(read_mesh_file(folder.write("a.gltf", far.text())),
              "coordinates up to 500004 m, which are read in single precision, to 0.03 m"));
  const auto precise = folder.write("a.obj", "v 500000.13 0 0\nv 500009 0 0\nv 500000 9 0\nf 1 2 3\n");
  CHECK(read_mesh_file(precise).warnings.empty());
}

TEST_CASE("names of files in glTF may have percent codes, and stay in the folder") {
  const Folder folder;
  Gltf gltf = triangle_file();
  std::filesystem::create_directory(folder / "inner");
  folder.write("inner/my sc\xC3\xA4ne.bin", gltf.buffer());
  folder.write("inner/50%25.bin", gltf.buffer());
  folder.write("a.bin", gltf.buffer());
  for (const bool isolated : {false, true}) {
    for (const char* name : {"my%20sc%C3%A4ne.bin", "my%20sc%c3%a4ne.bin", "my sc\xC3\xA4ne.bin", "50%25.bin"})
      CHECK(read_mesh_file(folder.write("inner/a.gltf", gltf.text(name)), {.isolated = isolated}).triangle_count() ==
            1);
    const auto outside = folder.write("inner/b.gltf", gltf.text("%2E%2E/a.bin"));
    CHECK(contains(support::file_error([&] { (void)read_mesh_file(outside, {.isolated = isolated}); }).problem(),
                   "expected files in its own folder"));
  }
}

TEST_CASE("a mesh file that is missing, empty or unknown is explained, and so are settings") {
  const Folder folder;
  const auto error = [&](const std::filesystem::path& path) {
    return support::file_error([&] { (void)read_mesh_file(path); });
  };
  CHECK(contains(error(folder / "none.ply").problem(), "does not exist"));
  const std::string begin = "ply\nformat ascii 1.0\n";
  std::string comments;
  while (comments.size() < 3'300'000) comments += "comment so it goes on\n";
  for (const std::string& rest :
       {comments, std::string(40'000'000, 'x'), "element vertex 3" + std::string(70'000, '\n') + "end_header\n"})
    CHECK(contains(error(folder.write("a.ply", begin + rest)).problem(),
                   "its PLY header has no end_header within 64 KiB"));
  CHECK(contains(error(folder.write("a.ply", "")).problem(), "is empty"));
  CHECK(contains(error(folder.write("a.xyz", "hello")).problem(), "no mesh file that can be read"));
  CHECK(error(folder.write("b.ply", "ply\nformat")).path() == (folder / "b.ply").string());
  CHECK_THROWS_AS((void)read_mesh_file(folder / "none.ply", {.unit = -1}), SettingError);
  CHECK_THROWS_AS((void)read_mesh_file(folder / "none.ply", {.limits = {.time = 0}}), SettingError);
  CHECK(contains(error(folder.write("c.ply",
                                    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float "
                                    "y\nproperty float z\nend_header\n1 2 3\n4 5 6\n"))
                     .problem(),
                 "xyzloader (read_point_cloud) reads the points of a cloud"));
  CHECK(is_mesh_file("a/B.GLB"));
  CHECK_FALSE(is_mesh_file("a.tif"));
}
