// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_MESH_FILE_HPP
#define PULSECAST_IO_MESH_FILE_HPP

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/detail/mesh_file/model.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

/// Meshes of PLY and OBJ files, and of glTF, GLB, STL, DAE, FBX files by assimp (others: untested).
namespace PULSECAST_NAMESPACE::io {

/// Reads a mesh file. Nodes whose transforms differ by a similarity, within 1e-6, share a mesh; others
/// share one with their shear or reflection applied. Polygons are triangulated; points, lines and triangles
/// without area are left out; animations are not played. Reflectance is 0.5; opacity and transmission are as of glass
/// with the index of the file; specular colour as `read_mtl`; metals of a roughness up to 0.1 are mirrors, other
/// surfaces of glTF have facets of that roughness. Limits: nodes are nested at most 1000 deep; what
/// `docs/formats.md` says is refused. Warnings report what is left out or changed, and
/// rounding by over 1 mm. @throws SettingError @throws FileError for a file that is missing or damaged, has more than
/// four vertices all at one place, or a coordinate beyond 1e12
[[nodiscard]] MeshFile read_mesh_file(const std::filesystem::path& path, const MeshFileSettings& settings = {},
                                      const Workers& workers = {});

/// Parts of a scene: one a placement, named as it, with object ids from `first_object` on. Those of
/// one mesh share geometry and materials. @throws SettingError as `TriangleMesh`
[[nodiscard]] std::vector<Part<MaskedMesh<>>> parts_of(MeshFile file, ObjectId first_object = 0,
                                                       const Workers& workers = {});

/// True for a name that `read_mesh_file` is for, by its ending: OBJ, PLY, glTF, GLB, STL, DAE, FBX.
[[nodiscard]] bool is_mesh_file(const std::filesystem::path& path);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_MESH_FILE)
#include <algorithm>

#include <pulsecast/io/detail/mesh_file/file_maker.hpp>
#include <pulsecast/io/detail/mesh_file/importer.hpp>
#include <pulsecast/io/detail/mesh_file/ply.hpp>
#include <pulsecast/io/obj.hpp>
#include <pulsecast/io/picture.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

[[nodiscard]] inline MeshFile file_of(const std::filesystem::path& path, const MeshFileSettings& settings,
                                      const Workers& workers) {
  const UpAxis up = settings.up.value_or(UpAxis::z);
  ObjModel model = read_obj(path, {.up = up, .spectra = settings.spectra, .texture = settings.texture}, workers);
  MeshFile file{.materials = std::move(model.materials),
                .pictures = std::move(model.pictures),
                .warnings = std::move(model.warnings),
                .files = std::move(model.files)};
  for (const MaterialPictures& pictures : file.pictures) pictures.append_to(file.files);
  file.pictures.resize(file.materials.size());
  if (model.mesh.triangles.empty()) return file;
  FileMesh& one = file.meshes.emplace_back();
  one.mesh = std::move(model.mesh);
  for (std::uint32_t i = 0; i < file.materials.size(); ++i) one.materials.push_back(i);
  file.placements.push_back({0, {.scale = settings.unit.value_or(1)}, path.stem().string()});
  return file;
}

/// Reads the pictures of a file, each once, into its materials and the masks of its meshes.
inline void read_pictures(MeshFile& file, bool isolated) {
  MeshData table{.texture = {{}}};  // whose masks are those of the file's materials
  add_pictures(table, file.materials, file.pictures, file.warnings, {.isolated = isolated});
  for (FileMesh& one : file.meshes) {
    if (one.mesh.texture.empty()) continue;
    for (std::size_t i = 0; i < one.materials.size(); ++i) {
      const std::uint32_t number = one.materials[i];
      if (number >= table.masks.size() || table.masks[number].width == 0) continue;
      one.mesh.masks.resize(i + 1);
      one.mesh.masks[i] = table.masks[number];
    }
  }
}

}  // namespace detail

PULSECAST_INLINE bool is_mesh_file(const std::filesystem::path& path) {
  const std::string ending = text::lower(path.extension().string());
  return std::ranges::any_of(std::array{".obj", ".ply", ".gltf", ".glb", ".stl", ".dae", ".fbx"},
                             [&](const char* one) { return ending == one; });
}

PULSECAST_INLINE MeshFile read_mesh_file(const std::filesystem::path& path, const MeshFileSettings& settings,
                                         const Workers& workers) {
  settings.validate();
  return reading(path, [&] {
    MeshFile file;
    if (text::lower(path.extension().string()) == ".obj") {
      file = detail::file_of(path, settings, workers);
    } else {
      InputFile begin(path, "a mesh file");
      const bool is_ply = detail::PlyFile::is_ply(begin);
      const auto ply = [&](const auto&) { return detail::PlyMesh(path, settings).read(); };
      const auto scene = !is_ply             ? detail::foreign_scene(path, settings)
                         : settings.isolated ? detail::imported_apart(path, settings.limits, ply)
                                             : ply(nullptr);
      file = detail::MeshFileMaker(path, scene, settings, workers).make();
    }
    detail::replace_materials(file, settings);
    if (settings.pictures) detail::read_pictures(file, settings.isolated);
    return file;
  });
}

PULSECAST_INLINE std::vector<Part<MaskedMesh<>>> parts_of(MeshFile file, ObjectId first_object,
                                                          const Workers& workers) {
  struct Shared {
    std::shared_ptr<const MaskedMesh<>> geometry;
    MaterialTable materials;
  };
  std::vector<Shared> shared;
  for (FileMesh& one : file.meshes) {
    std::vector<Material> table;
    for (const std::uint32_t number : one.materials) table.push_back(file.materials[number]);
    auto mesh = std::make_shared<const MaskedMesh<>>(std::exchange(one.mesh, {}), workers);
    shared.push_back({std::move(mesh), material_table(std::move(table))});
  }
  std::vector<Part<MaskedMesh<>>> parts;
  parts.reserve(file.placements.size());
  for (MeshPlacement& one : file.placements)
    parts.push_back({.geometry = shared[one.mesh].geometry,
                     .materials = shared[one.mesh].materials,
                     .placement = one.placement,
                     .object = first_object++,
                     .name = std::move(one.name)});
  return parts;
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
