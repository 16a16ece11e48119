// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_TRANSFER_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_TRANSFER_HPP

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <pulsecast/io/detail/child_process.hpp>
#include <pulsecast/io/detail/mesh_file/model.hpp>
#include <pulsecast/io/detail/mesh_file/raw_scene.hpp>

/// Transfer of the data read by a child process to its parent.
namespace PULSECAST_NAMESPACE::io::detail {

inline void hand_over(ChildOutput& to, const RawPicture& picture) {
  to.text(picture.name);
  to.value(picture.embedded);
}

inline void hand_over(ChildOutput& to, const RawScene& scene) {
  to.value(std::uint64_t{scene.meshes.size()});
  for (const RawMesh& mesh : scene.meshes) {
    to.text(mesh.name);
    to.value(mesh.material);
    to.array(mesh.vertices);
    to.array(mesh.precise);
    to.array(mesh.triangles);
    to.array(mesh.texture);
  }
  to.value(std::uint64_t{scene.nodes.size()});
  for (const RawNode& node : scene.nodes) {
    to.text(node.name);
    to.value(node.place);
    to.array(std::span<const std::uint32_t>(node.meshes));
  }
  to.value(std::uint64_t{scene.materials.size()});
  for (const RawMaterial& material : scene.materials) {
    to.text(material.name);
    to.value(material.optics);
    hand_over(to, material.colour);
    hand_over(to, material.opacity);
  }
  to.value(std::uint64_t{scene.embedded.size()});
  for (const auto& picture : scene.embedded) to.array(std::span<const std::byte>(*picture));
  for (const auto* const texts : {&scene.warnings, &scene.files}) {
    to.value(std::uint64_t{texts->size()});
    for (const std::string& text : *texts) to.text(text);
  }
  to.value(scene.unit);
  to.value(scene.applied_unit);
  to.value(scene.upright);
  to.text(scene.reference);
}

[[nodiscard]] inline RawPicture taken_picture(ChildResult& from) {
  RawPicture picture{.name = from.text()};
  picture.embedded = from.value<std::int64_t>();
  return picture;
}

/// Mesh whose indices are right.
[[nodiscard]] inline RawMesh taken_mesh(ChildResult& from) {
  RawMesh mesh{.name = from.text()};
  mesh.material = from.value<std::uint32_t>();
  mesh.vertices = from.array<Float3>();
  mesh.precise = from.array<Vec3>();
  mesh.triangles = from.array<Corners3>();
  mesh.texture = from.array<Float3>();
  if (!mesh.texture.empty() && mesh.texture.size() != mesh.vertex_count()) from.fail();
  for (const Corners3& corners : mesh.triangles)
    for (const std::uint32_t corner : corners)
      if (corner >= mesh.vertex_count()) from.fail();
  return mesh;
}

[[nodiscard]] inline RawScene taken_over(ChildResult from) {
  RawScene scene;
  for (auto left = from.count(); left > 0; --left) scene.meshes.push_back(taken_mesh(from));
  for (auto left = from.count(); left > 0; --left) {
    RawNode& node = scene.nodes.emplace_back();
    node.name = from.text();
    node.place = from.value<Affine>();
    const auto meshes = from.array<std::uint32_t>();
    node.meshes.assign(meshes.begin(), meshes.end());
    for (const std::uint32_t mesh : node.meshes)
      if (mesh >= scene.meshes.size()) from.fail();
    if (node.meshes.empty()) from.fail();
  }
  for (auto left = from.count(); left > 0; --left) {
    RawMaterial& material = scene.materials.emplace_back();
    material.name = from.text();
    material.optics = from.value<RawOptics>();
    material.colour = taken_picture(from);
    material.opacity = taken_picture(from);
  }
  for (const RawMesh& mesh : scene.meshes)
    if (mesh.material >= scene.materials.size()) from.fail();
  for (auto left = from.count(); left > 0; --left) {
    const auto bytes = from.array<std::byte>();
    scene.embedded.push_back(std::make_shared<const std::vector<std::byte>>(bytes.begin(), bytes.end()));
  }
  for (auto* const texts : {&scene.warnings, &scene.files})
    for (auto left = from.count(); left > 0; --left) texts->push_back(from.text());
  scene.unit = from.value<double>();
  scene.applied_unit = from.value<double>();
  scene.upright = from.value<Matrix3>();
  scene.reference = from.text();
  scene.owner = from.owner();
  return scene;
}

/// Result of an import of a file in a child process. It takes a function to call with the size of each further file
/// [byte].
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
                                         [&](ChildOutput& output) { hand_over(output, import(opened)); }));
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
