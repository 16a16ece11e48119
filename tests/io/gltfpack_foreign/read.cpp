// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Prints the corners of the triangles of mesh files in their own frame, a triangle a line, and a blank line after each
// file.

#include <cstdio>
#include <span>

#include <pulsecast/io/mesh_file.hpp>

int main(int count, char** arguments) {
  using namespace pulsecast;
  for (const char* const path : std::span(arguments, static_cast<std::size_t>(count)).subspan(1)) {
    const io::MeshFile file = io::read_mesh_file(path, {.up = io::UpAxis::z});
    for (const std::string& warning : file.warnings) std::fprintf(stderr, "%s\n", warning.c_str());
    for (const io::MeshPlacement& one : file.placements)
      for (const auto& triangle : file.meshes[one.mesh].mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
          const Vec3 at = one.placement.point(file.meshes[one.mesh].mesh.vertices[corner]);
          std::printf("%.17g %.17g %.17g ", at.x, at.y, at.z);
        }
        std::printf("\n");
      }
    std::printf("\n");
  }
  return 0;
}
