// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/picture.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <stb/stb_image_write.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/io/obj.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/file_errors.hpp"
#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

using namespace pulsecast;
using namespace pulsecast::io;
using support::contains;

namespace {

using Samples = std::vector<std::uint8_t>;

std::filesystem::path png(const std::filesystem::path& path, int width, int height, int channels,
                          const Samples& samples) {
  REQUIRE(stbi_write_png(path.c_str(), width, height, channels, samples.data(), width * channels) != 0);
  return path;
}

/// A square of 2 m about the origin with a picture on it, of a material "leaf".
const std::string leaf_obj =
    "mtllib leaf.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl leaf\nf 1/1 2/2 "
    "3/3 4/4\n";

}  // namespace

TEST_CASE("pictures of one to four channels are read as they were written") {
  const support::TemporaryFolder folder;
  for (const int channels : {1, 2, 3, 4}) {
    Samples samples;
    for (int i = 0; i < 3 * 2 * channels; ++i) samples.push_back(static_cast<std::uint8_t>(10 * i));
    const auto path = png(folder / "a.png", 3, 2, channels, samples);
    const Image image = read_picture({path});
    CHECK(image.width == 3);
    CHECK(image.height == 2);
    CHECK(image.channels == static_cast<std::uint32_t>(channels));
    CHECK(Samples(image.samples.begin(), image.samples.end()) == samples);

    const std::string bytes = support::content(path);
    std::vector<std::byte> embedded(bytes.size());
    for (std::size_t i = 0; i < bytes.size(); ++i) embedded[i] = static_cast<std::byte>(bytes[i]);
    const Image again = read_picture({"inside.glb", std::make_shared<const std::vector<std::byte>>(embedded)});
    CHECK(Samples(again.samples.begin(), again.samples.end()) == samples);

    const Image apart = read_picture({path}, {.isolated = true});
    CHECK(apart.width == 3);
    CHECK(apart.height == 2);
    CHECK(Samples(apart.samples.begin(), apart.samples.end()) == samples);
  }
}

TEST_CASE("a picture that cannot be read is explained") {
  const support::TemporaryFolder folder;
  const auto error = [&](const std::string& name, std::size_t most = 1 << 20) {
    return support::file_error([&] { (void)read_picture({folder / name}, {.max_pixels = most}); });
  };
  CHECK(contains(error("none.png").what(), "does not exist"));
  folder.write("text.png", "no picture at all");
  CHECK(contains(error("text.png").what(), "expected PNG, JPEG"));
  png(folder / "a.png", 3, 2, 1, Samples(6));
  CHECK(contains(error("a.png", 5).what(), "has 3 x 2 pixels, expected at most 5"));
  const FileError apart = support::file_error([&] { (void)read_picture({folder / "text.png"}, {.isolated = true}); });
  CHECK(apart.path() == (folder / "text.png").string());
  CHECK(contains(apart.problem(), "expected PNG, JPEG"));
}

TEST_CASE("damaged pictures are explained or read") {
  const support::TemporaryFolder folder;
  support::Generator random(7);
  Samples samples;
  for (int i = 0; i < 16 * 16 * 4; ++i) samples.push_back(static_cast<std::uint8_t>(random.uniform(0, 256)));
  const std::string whole = support::content(png(folder / "a.png", 16, 16, 4, samples));
  std::size_t explained = 0, read = 0;
  const auto attempt = [&](const std::string& bytes) {
    folder.write("damaged.png", bytes);
    try {
      read_picture({folder / "damaged.png"}, {.isolated = (read + explained) % 8 == 0}).validate();
      ++read;
    } catch (const FileError&) {
      ++explained;
    }
  };
  for (std::size_t end = 1; end < whole.size(); end += 7) attempt(whole.substr(0, end));
  for (int n = 0; n < 300; ++n) {
    std::string spoilt = whole;
    for (int k = 0; k < 3; ++k)
      spoilt[static_cast<std::size_t>(random.uniform(0, double(whole.size())))] =
          static_cast<char>(static_cast<std::uint8_t>(random.uniform(0, 256)));
    attempt(spoilt);
  }
  for (const char size :
       {'\x7f', '\x00', '\x01'}) {  // widths of two thousand million, none, and sixteen million pixels
    std::string lying = whole;
    lying[16] = size;
    if (size == 0) lying[19] = 0;
    attempt(lying);
  }
  INFO("seed 7");
  CHECK(explained > 100);
  CHECK(read > 10);
}

TEST_CASE("an OBJ file brings its pictures: colour, outline and reflectance") {
  const support::TemporaryFolder folder;
  folder.write("leaf.obj", leaf_obj);
  folder.write("leaf.mtl",
               "newmtl leaf\nKd 1 1 1\nmap_Kd colour.png\nmap_d -clamp on outline.png\npulsecast_reflectanceMap "
               "pattern colour.png\n"
               "newmtl leaf\nmap_Kd other.png\n");
  png(folder / "colour.png", 1, 2, 3, {255, 0, 0, 0, 0, 255});  // red above blue
  png(folder / "outline.png", 2, 1, 1, {255, 0});               // solid on the left
  ObjModel model = read_obj(folder / "leaf.obj");
  REQUIRE(model.pictures.size() == 1);
  CHECK(model.pictures[0].colour.file == folder / "colour.png");
  CHECK(model.pictures[0].opacity.file == folder / "outline.png");
  CHECK(model.pictures[0].reflectance_pattern);
  REQUIRE(model.mesh.texture.size() == 2);
  add_pictures(model.mesh, model.materials, model.pictures, model.warnings);
  REQUIRE(model.warnings.size() == 1);
  CHECK(contains(model.warnings[0], "'map_d -clamp on outline.png' has options, which have no effect"));
  REQUIRE(model.materials[0].picture);
  CHECK(model.materials[0].picture->colour({0.5, 0.75}) == Vec3{1, 0, 0});
  CHECK(model.materials[0].picture->colour({0.5, 0.25}) == Vec3{0, 0, 1});
  CHECK(model.materials[0].reflectance_map);
  const Scene<MaskedMesh<>> scene(
      {{.geometry = std::make_shared<const MaskedMesh<>>(model.mesh), .materials = material_table(model.materials)}});
  CHECK(scene.closest_hit(Ray{.origin = {-0.5, 0.3, 5}, .direction = -axis::up}));
  CHECK_FALSE(scene.closest_hit(Ray{.origin = {0.5, 0.3, 5}, .direction = -axis::up}));
}

TEST_CASE("a missing picture, and a mesh without texture coordinates, are warnings") {
  const support::TemporaryFolder folder;
  folder.write("leaf.obj", leaf_obj);
  folder.write("leaf.mtl", "newmtl leaf\nmap_Kd none.png\nmap_d none.png\n");
  ObjModel model = read_obj(folder / "leaf.obj");
  add_pictures(model.mesh, model.materials, model.pictures, model.warnings);
  REQUIRE(model.warnings.size() == 1);  // each file is read once
  CHECK(contains(model.warnings[0], "none.png: does not exist; it is left out"));
  CHECK_FALSE(model.materials[0].picture);
  CHECK(model.mesh.masks.empty());

  folder.write("leaf.obj", "mtllib leaf.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nusemtl leaf\nf 1 2 3\n");
  model = read_obj(folder / "leaf.obj");
  REQUIRE(model.warnings.size() == 1);
  CHECK(contains(model.warnings[0], "3 corners of material 'leaf' have no texture coordinates: 0, 0 is assumed"));
  model.mesh.texture.clear();
  model.warnings.clear();
  add_pictures(model.mesh, model.materials, model.pictures, model.warnings);
  REQUIRE(model.warnings.size() == 1);
  CHECK(contains(model.warnings[0], "no texture coordinates"));
}

TEST_CASE("the outline of a picture by its own opacity, and none where all is solid") {
  const support::TemporaryFolder folder;
  png(folder / "leaf.png", 2, 1, 4, {0, 255, 0, 255, 0, 255, 0, 100});
  MeshData mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  mesh.texture = {{{{0, 0}, {1, 0}, {0, 1}}}};
  std::vector<Material> materials(3);
  std::vector<std::string> warnings;
  MaterialPictures plain{.colour = {folder / "leaf.png"}}, outlined = plain, solid = plain;
  outlined.outlined_by_colour = solid.outlined_by_colour = true;
  solid.cutoff = 0.3;
  add_pictures(mesh, materials, std::vector{plain, outlined, solid}, warnings);
  REQUIRE(mesh.masks.size() == 2);
  CHECK(mesh.masks[0].width == 0);
  CHECK(mesh.masks[1].bits == std::vector<std::uint64_t>{1});
  CHECK(materials[2].picture == materials[0].picture);  // shared
}
