// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_MESH_MAKER_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_MESH_MAKER_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/io/detail/mesh_file/raw_scene.hpp>
#include <pulsecast/shape/mesh_data.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Joins the meshes of a node to one, with a material each.
class MeshMaker {
 public:
  MeshMaker(std::string path, const RawScene& scene, const Workers& workers)
      : path_(std::move(path)), scene_(scene), workers_(workers) {}

  /// Mesh of meshes by number, each with its place in a table of materials, mapped by `shape`.
  [[nodiscard]] MeshData operator()(std::span<const std::uint32_t> meshes, std::span<const std::uint32_t> materials,
                                    const Matrix3& shape) {
    MeshData made;
    std::size_t vertices = 0, triangles = 0;
    bool textured = false, several = false;
    for (std::size_t k = 0; k < meshes.size(); ++k) {
      const RawMesh& from = scene_.meshes[meshes[k]];
      vertices += from.vertex_count();
      triangles += from.triangles.size();
      textured = textured || !from.texture.empty();
      several = several || materials[k] != 0;
    }
    if (triangles == 0) return made;
    MeshData::validate_counts(vertices, triangles);
    made.vertices.resize(vertices);
    made.triangles.resize(triangles);
    if (several) made.materials.resize(triangles);
    if (textured) made.texture.resize(triangles);
    const bool mirrors = dot(shape[0], cross(shape[1], shape[2])) < 0;
    std::size_t vertex = 0, triangle = 0;
    for (std::size_t k = 0; k < meshes.size(); ++k) {
      const RawMesh& from = scene_.meshes[meshes[k]];
      place(from, shape, made.vertices.data() + vertex);
      index(from, static_cast<std::uint32_t>(vertex), triangle, made, mirrors);
      if (several) std::fill_n(made.materials.data() + triangle, from.triangles.size(), materials[k]);
      vertex += from.vertex_count();
      triangle += from.triangles.size();
    }
    drop_flat(made);
    return made;
  }

  /// Number of triangles left out so far, as they have no area.
  [[nodiscard]] std::uint64_t flat() const noexcept { return flat_; }

 private:
  static constexpr std::size_t chunk = std::size_t{1} << 16;

  template <class Work>
  void each(std::size_t count, const Work& work) const {
    for_each_index((count + chunk - 1) / chunk, workers_, [&](std::size_t c) {
      const std::size_t end = std::min((c + 1) * chunk, count);
      for (std::size_t i = c * chunk; i < end; ++i) work(i);
    });
  }

  void place(const RawMesh& from, const Matrix3& shape, Vec3* to) const {
    const bool moved = shape != Matrix3(1);
    const auto vertex = [&](std::size_t i) {
      if (!from.precise.empty()) return from.precise[i];
      const Float3& v = from.vertices[i];
      return Vec3(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
    };
    each(from.vertex_count(), [&](std::size_t i) {
      const Vec3 at = vertex(i);
      if (!is_within(at, 1e12))
        detail::fail(path_, "mesh '", from.name, "': vertex ", i, " is not finite, or beyond 1e12: expected a place");
      to[i] = moved ? shape * at : at;
    });
  }

  /// Triangles and texture coordinates, from a vertex and a triangle of the mesh on.
  void index(const RawMesh& from, std::uint32_t vertex, std::size_t triangle, MeshData& to, bool turned) const {
    const auto at = [&](std::uint32_t corner) {
      const Float3& t = from.texture[corner];
      const Vec2 place(static_cast<double>(t.x), static_cast<double>(t.y));
      if (!(std::fabs(place.x) <= 1e30 && std::fabs(place.y) <= 1e30))
        detail::fail(path_, "mesh '", from.name, "': a texture coordinate of vertex ", corner, " is not finite");
      return place;
    };
    each(from.triangles.size(), [&](std::size_t i) {
      Corners3 c = from.triangles[i];
      if (turned) std::swap(c[1], c[2]);
      to.triangles[triangle + i] = {c[0] + vertex, c[1] + vertex, c[2] + vertex};
      if (!from.texture.empty()) to.texture[triangle + i] = {at(c[0]), at(c[1]), at(c[2])};
    });
  }

  void drop_flat(MeshData& mesh) {
    const auto is_flat = [&](std::size_t i) {
      const Triangle t = mesh.triangle(i);
      return cross(t.b - t.a, t.c - t.a) == Vec3{};
    };
    std::vector<unsigned char> has_flat((mesh.triangles.size() + chunk - 1) / chunk, 0);  // by chunk
    each(mesh.triangles.size(), [&](std::size_t i) {
      if (is_flat(i)) has_flat[i / chunk] = 1;
    });
    if (std::find(has_flat.begin(), has_flat.end(), 1) == has_flat.end()) return;
    std::size_t kept = 0;
    const std::size_t all = mesh.triangles.size();
    for (std::size_t i = 0; i < all; ++i) {
      if (is_flat(i)) continue;
      if (!mesh.materials.empty()) mesh.materials[kept] = mesh.materials[i];
      if (!mesh.texture.empty()) mesh.texture[kept] = mesh.texture[i];
      mesh.triangles[kept++] = mesh.triangles[i];
    }
    mesh.triangles.resize(kept);
    if (!mesh.materials.empty()) mesh.materials.resize(kept);
    if (!mesh.texture.empty()) mesh.texture.resize(kept);
    flat_ += all - kept;
  }

  std::string path_;
  const RawScene& scene_;
  Workers workers_;
  std::uint64_t flat_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
