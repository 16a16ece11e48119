// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Damaged mesh files, imported by child processes: each is read or explained.
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <assimp/scene.h>
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>

#include <pulsecast/io/mesh_file.hpp>

#include "support/fbx.hpp"
#include "support/file_errors.hpp"
#include "support/generators.hpp"
#include "support/gltf.hpp"
#include "support/sanitized.hpp"
#include "support/spoilt_text.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using support::Gltf;

namespace {

/// What became of files.
struct Tally {
  int read = 0, explained = 0;
  std::string problems{};

  void operator()(const std::filesystem::path& path, double time = 0.5) {
    try {
      const MeshFile file = read_mesh_file(path, {.isolated = true, .limits = {.memory = 5e8, .time = time}});
      for (const FileMesh& one : file.meshes) one.mesh.validate();
      for (const MeshPlacement& one : file.placements) {
        one.placement.validate();
        CHECK(one.mesh < file.meshes.size());
      }
      for (const Material& one : file.materials) one.validate();
      ++read;
    } catch (const FileError& error) {
      CHECK(error.path() == path.string());
      ++explained;
      problems += error.problem() + '\n';
    } catch (const SettingError&) {
      ++explained;
    }
  }
};

std::filesystem::path written(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// A ground of 30 triangles in two objects and materials, in a format of assimp's exporter.
std::string sound_file(const std::filesystem::path& folder, const std::string& format, const std::string& ending) {
  std::string text = "mtllib a.mtl\no a\nusemtl red\n";
  for (int i = 0; i < 34; ++i)
    text += "v " + std::to_string(i % 5) + " " + std::to_string(i / 5) + " " + std::to_string(i % 3) + "\n";
  for (int i = 1; i <= 30; ++i) {
    if (i == 15) text += "o b\nusemtl blue\n";
    text += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 4) + "\n";
  }
  written(folder / "a.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nd 0.5\n");
  Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFile(written(folder / "a.obj", text).string(), 0);
  REQUIRE(scene != nullptr);
  const auto path = folder / ("a." + ending);
  REQUIRE(Assimp::Exporter().Export(scene, format, path.string()) == aiReturn_SUCCESS);
  const std::string bytes = support::content(path);
  return format == "fbx" ? support::FbxLists::ended(bytes) : bytes;
}

}  // namespace

TEST_CASE("mesh files that are cut off or spoilt are read or explained") {
  struct Format {
    std::string name, ending;
  };
  const std::vector<Format> formats{{"ply", "ply"},     {"plyb", "ply"}, {"gltf2", "gltf"},
                                    {"glb2", "glb"},    {"stl", "stl"},  {"stlb", "stl"},
                                    {"collada", "dae"}, {"fbxa", "fbx"}, {"fbx", "fbx"}};
  const std::array<const char*, 16> words{
      "4294967295", "-1",  "99999999999999999999", "nan", "1e999",   "inf", "\xFF\xFF\xFF\xFF", "0", "{", "]", "\"",
      "</",         "<a>", "../../etc/passwd",     "\n",  "00000000"};
  for (std::size_t f = 0; f < formats.size(); ++f) {
    const support::TemporaryFolder folder;
    const Format& format = formats[f];
    CAPTURE(format.name);
    const std::string sound = sound_file(folder.path(), format.name, format.ending);
    Tally tally;
    tally(written(folder / ("sound." + format.ending), sound), 20);
    CHECK(tally.read == 1);
    const auto path = folder / ("spoilt." + format.ending);
    for (std::size_t part = 1; part < 12; ++part) tally(written(path, sound.substr(0, sound.size() * part / 12)));
    for (std::uint64_t seed = 0; seed < 16; ++seed) {
      CAPTURE(seed);
      support::Generator random(100 * f + seed);
      tally(written(path, support::spoilt(sound, 1 + seed / 4, words, random)));
    }
    CHECK(tally.read + tally.explained == 28);
  }
  rusage used{};
  REQUIRE(::getrusage(RUSAGE_CHILDREN, &used) == 0);
  CHECK(used.ru_maxrss < 2'000'000);  // [KiB]
}

TEST_CASE("glTF files that lie are read or explained") {
  const support::TemporaryFolder folder;
  Gltf gltf;
  gltf.primitive({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, R"(,"material":0)");
  gltf.mesh("m");
  gltf.material(R"("name":"x")");
  gltf.node(R"("mesh":0,"children":[1],"translation":[0,0,0])");
  gltf.node(R"("mesh":0)");
  const std::string sound = gltf.text();
  const std::vector<std::pair<std::string, std::string>> lies{
      {R"("mesh":0})", R"("mesh":0,"children":[0]})"},  // a cycle
      {R"("mesh":0})", R"("mesh":0,"children":[1]})"},
      {R"("children":[1])", R"("children":[1,1,1])"},
      {R"("children":[1])", R"("children":[9])"},
      {R"("children":[1])", R"("children":[-1])"},
      {R"("mesh":0})", R"("mesh":7})"},
      {R"("nodes":[0])", R"("nodes":[5])"},
      {R"("material":0)", R"("material":3)"},
      {R"("count":3)", R"("count":4294967295)"},
      {R"("count":3)", R"("count":-1)"},
      {R"("count":3)", R"("count":4)"},
      {R"("count":3)", R"("count":0)"},
      {R"("count":3)", R"("count":1e30)"},
      {R"("byteLength":36)", R"("byteLength":1000000)"},
      {R"("byteLength":36)", R"("byteLength":18446744073709551615)"},
      {R"("byteOffset":0)", R"("byteOffset":18446744073709551600)"},
      {R"("byteOffset":36)", R"("byteOffset":47)"},
      {R"("buffer":0)", R"("buffer":1)"},
      {R"("bufferView":0)", R"("bufferView":4)"},
      {R"("componentType":5126)", R"("componentType":5120)"},
      {R"("componentType":5125)", R"("componentType":5126)"},
      {R"("componentType":5125)", R"("componentType":0)"},
      {R"("VEC3")", R"("MAT4")"},
      {R"("VEC3")", R"("SCALAR")"},
      {R"("POSITION":0)", R"("POSITION":1)"},
      {R"("POSITION":0)", R"("POSITION":100)"},
      {R"("POSITION":0)", R"("NORMAL":0)"},
      {R"("indices":1)", R"("indices":0)"},
      {R"("indices":1)", R"("indices":77)"},
      {R"("translation":[0,0,0])", R"("translation":[1e39,0,0])"},
      {R"("translation":[0,0,0])", R"("translation":[0])"},
      {R"("translation":[0,0,0])", R"("matrix":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0])"},
      {R"("translation":[0,0,0])", R"("scale":[1e-30,1e30,1])"},
      {R"("translation":[0,0,0])", R"("rotation":[0,0,0,0])"},
      {R"("byteLength":48,"uri":"data:)", R"("byteLength":48,"uri":"../../../../etc/passwd","x":"data:)"},
      {R"("byteLength":48,"uri":"data:)", R"("byteLength":48,"uri":"/dev/zero","x":"data:)"},
      {R"("byteLength":48,"uri":"data:)", R"("byteLength":48,"uri":"lies.gltf","x":"data:)"},
      {R"("byteLength":48,"uri":"data:)", R"("byteLength":48,"uri":"","x":"data:)"},
      {R"(;base64,)", R"(;base64,!!!!)"},
      {R"("version":"2.0")", R"("version":"1.0")"},
      {R"("version":"2.0")", R"("version":2)"},
      {R"("asset")", R"("images":[{"uri":"../../../etc/passwd"}],"textures":[{"source":0}],"asset")"}};
  Tally tally;
  for (const auto& lie : lies) {
    const auto& [from, to] = lie;
    CAPTURE(lie.second);
    REQUIRE(sound.find(from) != std::string::npos);
    std::string text = sound;
    text.replace(text.find(from), from.size(), to);
    tally(written(folder / "lies.gltf", text));
  }
  CHECK(lies.size() >= 40);
  CHECK(tally.explained >= 20);

  Gltf doubling;  // each node shows the next twice: 2^60 nodes
  doubling.primitive({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  doubling.mesh("m");
  for (int i = 0; i < 60; ++i)
    doubling.node("\"children\":[" + std::to_string(i + 1) + "," + std::to_string(i + 1) + "]");
  doubling.node("\"mesh\":0");
  Gltf deep;
  deep.primitive({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  deep.mesh("m");
  for (int i = 0; i < 2000; ++i) deep.node("\"children\":[" + std::to_string(i + 1) + "]");
  deep.node("\"mesh\":0");
  Tally bombs;
  bombs(written(folder / "doubling.gltf", doubling.text()), 20);
  bombs(written(folder / "deep.gltf", deep.text()), 20);
  CHECK(bombs.explained == 2);
#if !defined(PULSECAST_TEST_SANITIZED)  // whose own memory fails otherwise
  CHECK(support::contains(bombs.problems, "more memory than is allowed"));
#endif
  CHECK(support::contains(bombs.problems, "nested more than 1000 deep"));
}
