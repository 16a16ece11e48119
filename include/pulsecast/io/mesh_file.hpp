// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_MESH_FILE_HPP
#define PULSECAST_IO_MESH_FILE_HPP

#include <filesystem>
#include <vector>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/parallel.hpp>
#include <pulsecast/io/detail/mesh_file/model.hpp>
#include <pulsecast/scene/part.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

/// Meshes of PLY, glTF, GLB, STL, DAE and FBX files, by assimp. OBJ files are read by `read_obj`. Other formats of
/// assimp are untested.
namespace PULSECAST_NAMESPACE::io {

/// Reads a mesh file. Nodes that show the same mesh share it, where their transforms differ by rotation, uniform scale
/// and translation, within 1e-6; others share one with their shear or reflection applied, with a warning. Polygons are
/// triangulated; points, lines and triangles without area are left out, with a warning. Animations are not played.
/// Materials: colour and opacity by the base colour; a reflectance of 0.5; opacity and transmission those of glass with
/// the index of the file; specular colour as `read_mtl`; metals of a roughness up to 0.1 are mirrors, other surfaces of
/// glTF have facets of that roughness. Throws a `FileError` for a file that is missing or damaged, or has a coordinate
/// beyond 1e12; a `SettingError` for settings out of range. Limits: nodes are nested at most 1000 deep. A file is
/// refused that has strips (PLY), or requires an extension of glTF other than those for materials, lights, transforms
/// of texture coordinates and Draco. Warnings report other extensions that move meshes, bones and morph targets, and
/// coordinates that single precision rounds by more than a millimetre.
[[nodiscard]] MeshFile read_mesh_file(const std::filesystem::path& path, const MeshFileSettings& settings = {},
                                      const Workers& workers = {});

/// Parts of a scene: one a placement, named as it, with object ids from `first_object` on. Parts of one mesh share
/// geometry and materials.
/// @throws SettingError as `TriangleMesh`
[[nodiscard]] std::vector<Part<TriangleMesh<>>> parts_of(MeshFile file, ObjectId first_object = 0,
                                                         const Workers& workers = {});

/// True for a name that `read_mesh_file` is for: OBJ, PLY, glTF, GLB, STL, DAE and FBX, by the ending.
[[nodiscard]] bool is_mesh_file(const std::filesystem::path& path);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINITIONS
#include <pulsecast/io/detail/mesh_file/reader.hpp>
#endif

#endif
