// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_TRANSFER_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_TRANSFER_HPP

#include <filesystem>
#include <system_error>

#include <pulsecast/io/detail/child_process.hpp>
#include <pulsecast/io/detail/mesh_file/model.hpp>
#include <pulsecast/io/detail/mesh_file/raw_scene.hpp>

/// Transfer of the data read by a child process to its parent.
namespace PULSECAST_NAMESPACE::io::detail {

/// Lists the members of what a mesh file holds.
template <class Archive>
void list_members(Archive& a, RawMesh& mesh) {
  a(mesh.name, mesh.material, mesh.vertices, mesh.precise, mesh.triangles, mesh.texture);
}
template <class Archive>
void list_members(Archive& a, RawNode& node) {
  a(node.name, node.place, node.meshes);
}
template <class Archive>
void list_members(Archive& a, RawPicture& picture) {
  a(picture.name, picture.embedded);
}
template <class Archive>
void list_members(Archive& a, RawMaterial& material) {
  a(material.name, material.optics, material.colour, material.opacity);
}
template <class Archive>
void list_members(Archive& a, RawScene& scene) {
  a(scene.meshes, scene.nodes, scene.materials, scene.embedded, scene.warnings, scene.files, scene.unit,
    scene.applied_unit, scene.upright, scene.reference);
}

/// Result of an import in a child process. It takes a function to call with the size of each further file [byte].
template <class Import>
[[nodiscard]] RawScene imported_apart(const std::filesystem::path& path, const ImportLimits& limits,
                                      const Import& import) {
  std::error_code ignored;
  const auto size = static_cast<double>(std::filesystem::file_size(path, ignored));
  const auto opened = [&](std::uint64_t bytes) {
    ChildProcess::allow(limits.memory_per_byte * static_cast<double>(bytes));
  };
  return ChildProcess::result(path.string(),
                              {.memory = limits.memory + (ignored ? 0 : limits.memory_per_byte * size),
                               .time = limits.time + (ignored ? 0 : limits.time_per_byte * size)},
                              [&] { return import(opened); });
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
