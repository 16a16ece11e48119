// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Mesh files from file to scene, by the time that assimp takes alone. Usage: bench_mesh_file [triangles, default
// 10000000] [rounds]
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>
#include <pulsecast/io/mesh_file.hpp>
#include <pulsecast/scene/scene.hpp>

using namespace pulsecast;

namespace {

struct Grid {
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Hilly ground of about `triangles` triangles.
Grid grid_of(std::size_t triangles) {
  const auto side = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 2));
  Grid grid;
  for (std::uint32_t y = 0; y <= side; ++y)
    for (std::uint32_t x = 0; x <= side; ++x) {
      const double at_x = 0.1 * x, at_y = 0.1 * y;
      grid.vertices.push_back(
          {static_cast<float>(at_x), static_cast<float>(at_y), static_cast<float>(std::sin(at_x) + std::cos(at_y))});
    }
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = y * (side + 1) + x, b = a + 1, c = a + side + 1, d = c + 1;
      grid.triangles.push_back({a, b, d});
      grid.triangles.push_back({a, d, c});
    }
  return grid;
}

void put(std::ofstream& file, const void* data, std::size_t size) {
  file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
}

void write_ply(const std::filesystem::path& path, const Grid& grid) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << grid.vertices.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << grid.triangles.size()
       << "\nproperty list uchar uint vertex_indices\nend_header\n";
  put(file, grid.vertices.data(), grid.vertices.size() * 12);
  for (const auto& triangle : grid.triangles) {
    file.put(3);
    put(file, triangle.data(), 12);
  }
}

void write_glb(const std::filesystem::path& path, const Grid& grid) {
  const std::size_t vertices = grid.vertices.size(), triangles = grid.triangles.size();
  const auto s = [](std::size_t number) { return std::to_string(number); };
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"ground"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"buffers":[{"byteLength":)" +
      s(12 * (vertices + triangles)) + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + s(12 * vertices) +
      R"(},{"buffer":0,"byteOffset":)" + s(12 * vertices) + R"(,"byteLength":)" + s(12 * triangles) +
      R"(}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" + s(vertices) +
      R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" + s(3 * triangles) + "}]}";
  while (json.size() % 4 != 0) json += ' ';
  const auto binary = static_cast<std::uint32_t>(12 * (vertices + triangles)),
             text = static_cast<std::uint32_t>(json.size());
  const std::array<std::uint32_t, 5> head{0x46546C67, 2, 28 + text + binary, text, 0x4E4F534A};
  const std::array<std::uint32_t, 2> chunk{binary, 0x004E4942};
  std::ofstream file(path, std::ios::binary);
  put(file, head.data(), sizeof head);
  file << json;
  put(file, chunk.data(), sizeof chunk);
  put(file, grid.vertices.data(), vertices * 12);
  put(file, grid.triangles.data(), triangles * 12);
}

template <class Work>
double seconds(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

int main(int count, char** words) {
  const auto triangles = static_cast<std::size_t>(count > 1 ? std::atoll(words[1]) : 10'000'000);
  const int rounds = count > 2 ? std::atoi(words[2]) : 3;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("bench_mesh_file_" + std::to_string(triangles));
  std::filesystem::create_directories(folder);
  std::size_t size = 0;
  {
    const Grid grid = grid_of(triangles);
    size = grid.triangles.size();
    write_ply(folder / "ground.ply", grid);
    write_glb(folder / "ground.glb", grid);
  }
  for (const char* name : {"ground.ply", "ground.glb"}) {
    double assimp = 1e9, reading = 1e9, apart = 1e9, scene = 1e9;  // the least of all rounds
    for (int round = 0; round < rounds; ++round) {
      assimp = std::min(assimp, seconds([&] {
                          Assimp::Importer importer;
                          if (!importer.ReadFile((folder / name).string(), aiProcess_Triangulate)) std::exit(1);
                        }));
      io::MeshFile file;
      reading = std::min(reading, seconds([&] { file = io::read_mesh_file(folder / name); }));
      scene = std::min(scene, seconds([&] {
                         const Scene<MaskedMesh<>> made(io::parts_of(std::move(file)));
                         if (made.memory() == 0) std::exit(1);
                       }));
      file = {};
      apart = std::min(apart, seconds([&] { file = io::read_mesh_file(folder / name, {.isolated = true}); }));
    }
    std::printf(
        "%s, %.3g million triangles: assimp %.2f s, read %.2f s (%.2f of it), in a child %.2f s (%.2f), and to a scene "
        "%.2f s: "
        "%.2f million triangles a second\n",
        name, static_cast<double>(size) / 1e6, assimp, reading, reading / assimp, apart, apart / assimp,
        reading + scene, static_cast<double>(size) / 1e6 / (reading + scene));
  }
  std::filesystem::remove_all(folder);
}
