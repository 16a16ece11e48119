// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_TRANSFER_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_TRANSFER_HPP

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include <pulsecast/io/detail/child_process.hpp>
#include <pulsecast/io/detail/mesh_file/model.hpp>
#include <pulsecast/io/detail/mesh_file/raw_scene.hpp>

/// Transfer of the data read by a child process to its parent.
namespace PULSECAST_NAMESPACE::io::detail {

/// Writes a picture to a `ChildOutput`, or reads it from a `ChildResult`.
template <class Io>
void hand_over(Io& io, RawPicture& picture) {
  io.text(picture.name);
  io.value(picture.embedded);
}

/// As above, a scene.
template <class Io>
void hand_over(Io& io, RawScene& scene) {
  io.items(scene.meshes, [&](RawMesh& mesh) {
    io.text(mesh.name);
    io.value(mesh.material);
    io.array(mesh.vertices);
    io.array(mesh.precise);
    io.array(mesh.triangles);
    io.array(mesh.texture);
  });
  io.items(scene.nodes, [&](RawNode& node) {
    io.text(node.name);
    io.value(node.place);
    io.items(node.meshes, [&](std::uint32_t& mesh) { io.value(mesh); });
  });
  io.items(scene.materials, [&](RawMaterial& material) {
    io.text(material.name);
    io.value(material.optics);
    hand_over(io, material.colour);
    hand_over(io, material.opacity);
  });
  io.items(scene.embedded, [&](std::shared_ptr<const std::vector<std::byte>>& picture) {
    std::span<const std::byte> bytes;
    if (picture) bytes = *picture;
    io.array(bytes);
    if (!picture) picture = std::make_shared<const std::vector<std::byte>>(bytes.begin(), bytes.end());
  });
  for (auto* const texts : {&scene.warnings, &scene.files}) io.items(*texts, [&](std::string& text) { io.text(text); });
  io.value(scene.unit);
  io.value(scene.applied_unit);
  io.value(scene.upright);
  io.text(scene.reference);
}

/// Scene from a child, whose indices are right.
[[nodiscard]] inline RawScene taken_over(ChildResult from) {
  RawScene scene;
  hand_over(from, scene);
  for (const RawMesh& mesh : scene.meshes) {
    if (!mesh.texture.empty() && mesh.texture.size() != mesh.vertex_count()) from.fail();
    if (mesh.material >= scene.materials.size()) from.fail();
    for (const Corners3& corners : mesh.triangles)
      for (const std::uint32_t corner : corners)
        if (corner >= mesh.vertex_count()) from.fail();
  }
  for (const RawNode& node : scene.nodes) {
    if (node.meshes.empty()) from.fail();
    for (const std::uint32_t mesh : node.meshes)
      if (mesh >= scene.meshes.size()) from.fail();
  }
  scene.owner = from.owner();
  return scene;
}

/// Result of an import in a child process. It takes a function to call with the size of each further file [byte].
template <class Import>
[[nodiscard]] RawScene imported_apart(const std::filesystem::path& path, const ImportLimits& limits,
                                      const Import& import) {
  std::error_code ignored;
  const auto size = static_cast<double>(std::filesystem::file_size(path, ignored));
  const auto opened = [&](std::uint64_t bytes) {
    ChildOutput::allow(limits.memory_per_byte * static_cast<double>(bytes));
  };
  return taken_over(ChildProcess::result(path.string(),
                                         {.memory = limits.memory + (ignored ? 0 : limits.memory_per_byte * size),
                                          .time = limits.time + (ignored ? 0 : limits.time_per_byte * size)},
                                         [&](ChildOutput& output) {
                                           RawScene scene = import(opened);
                                           hand_over(output, scene);
                                         }));
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
