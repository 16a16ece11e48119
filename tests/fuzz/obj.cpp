// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/obj.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

/// The input is an OBJ file that may name itself, and `a.mtl`, which is the same text again.
FUZZ_TARGET(obj) {
  (void)fuzz::file(data, size, "a.mtl");
  const std::filesystem::path path = fuzz::file(data, size, "a.obj");
  fuzz::may_refuse([&] {
    const ObjModel model = read_obj(path, {.up = UpAxis::y});
    const MeshData& mesh = model.mesh;
    fuzz::expect(mesh.materials.size() == mesh.triangles.size());
    for (const Vec3& vertex : mesh.vertices) fuzz::expect(max_norm(vertex) <= 1e12);
    for (const auto& corners : mesh.triangles)
      for (const std::uint32_t corner : corners) fuzz::expect(corner < mesh.vertices.size());
    for (const std::uint32_t material : mesh.materials) fuzz::expect(material < model.materials.size());
    for (const Material& material : model.materials) material.validate();
  });
}
