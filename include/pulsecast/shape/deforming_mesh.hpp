// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DEFORMING_MESH_HPP
#define PULSECAST_SHAPE_DEFORMING_MESH_HPP

#include <pulsecast/accel/refit.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

namespace PULSECAST_NAMESPACE {

/// Mesh whose vertices move: a sail, a swaying tree, a water surface. `refit` makes a
/// `TriangleMesh` of the same triangles with other vertices: it keeps the topology of the index,
/// recomputes its boxes, and builds it anew where their SAH cost exceeds `BvhRefit::max_growth`
/// times that of the last build. The meshes are immutable. Takes 4 bytes a corner of a block beside
/// the mesh, some 3 to 12 a triangle; after the second refit a second mesh's vertices and nodes.
template <class MeshType = TriangleMesh<>>
class DeformingMesh {
 public:
  using Mesh = MeshType;  ///< type of the meshes: a `TriangleMesh` or a `MaskedMesh`

  /// `workers` build the index; the mesh is the same for any. @throws SettingError as the mesh
  explicit DeformingMesh(const MeshData& data, const Workers& workers = {})
      : materials_(data.materials), vertices_(data.vertices.size()) {
    build(data, workers);
  }

  /// Mesh with the vertices last set.
  [[nodiscard]] std::shared_ptr<const Mesh> mesh() const noexcept { return frames_[now_].mesh; }

  /// Moves the vertices to new positions [m], by number as in `MeshData`, and returns the mesh, in
  /// the memory of the mesh before the current one if no one else holds it. A refit takes the
  /// caller's thread; `workers` build an index anew. @throws SettingError for another number of
  /// vertices, or one in use beyond 1e18 m from the origin; the current mesh then stays
  std::shared_ptr<const Mesh> refit(std::span<const Vec3> vertices, const Workers& workers = {}) {
    require_within("DeformingMesh::vertices (number)", vertices.size(), vertices_, vertices_);
    const Frame& now = frames_[now_];
    Frame& next = frames_[1 - now_];
    if (next.mesh.use_count() != 1) next.mesh = std::make_shared<Mesh>(*now.mesh);
    next.mesh->corners_ = {};
    if (next.corners.size() != sources_.size() || next.corners.memory().use_count() != 1)
      next.corners = SharedBuffer<Vec3>(sources_.size());
    static_cast<void>(SharedBuffer<Vec3>(next.corners));  // as in `BvhRefit`
    Box bounds;
    Vec3 sum{};  // keeps every NaN and infinity
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      const Vec3& vertex = vertices[sources_[i]];
      sum = sum + vertex;
      bounds.extend(vertex);
      next.corners[i] = vertex;
    }
    const double reach = std::max(max_norm(bounds.min), max_norm(bounds.max));
    if (!finite(sum) || !(reach <= detail::max_coordinate)) refuse(vertices);
    next.mesh->corners_ = next.corners;
    const Mesh& moved = *next.mesh;
    const PrimitiveIndex* const first = now.mesh->index_.order().data();
    const auto box_of = [&](std::span<const PrimitiveIndex> primitives) noexcept {
      const auto place = static_cast<std::size_t>(primitives.data() - first);
      const Vec3* const corners = moved.block_corners(place);
      Box box;
      for (std::size_t n = 0; n < primitives.size(); ++n)
        for (const std::uint16_t corner : moved.triangles_[place + n]) box.extend(corners[corner]);
      return box;
    };
    if (next.refit.refit(now.mesh->index_, now.refit, bounds, box_of, next.mesh->index_))
      now_ = 1 - now_;
    else
      build(data(vertices), workers);
    return mesh();
  }

 private:
  /// Mesh, and the memory that it shares with this object.
  struct Frame {
    std::shared_ptr<Mesh> mesh;
    SharedBuffer<Vec3> corners;
    BvhRefit<float> refit;
  };

  /// Refuses the first vertex in use that is out of range.
  void refuse(std::span<const Vec3> vertices) const {
    for (const std::uint32_t number : sources_)
      for (int k = 0; k < 3; ++k)
        if (const double at = vertices[number][k]; !(std::fabs(at) <= detail::max_coordinate))
          throw_setting_error("DeformingMesh::vertices", at, "m",
                              "finite and within 1e18 m of the origin; see vertex " + std::to_string(number));
  }

  /// Builds the index over new data, and numbers the corners of each block by vertex: vertices at
  /// one place, which a `TriangleMesh` merges, may part.
  void build(const MeshData& data, const Workers& workers) {
    auto mesh = std::make_shared<Mesh>(data, workers);
    const auto order = mesh->index_.order();
    struct Last {
      std::uint32_t block = 0xFFFFFFFF;  // none
      std::uint16_t corner = 0;
    };
    std::vector<Last> last(data.vertices.size());
    std::vector<std::uint32_t> sources;
    const SharedBuffer<std::uint64_t> first_corners(mesh->first_corners_.size());
    const SharedBuffer<typename Mesh::Corners> triangles(order.size());
    for (std::size_t place = 0; place < order.size(); ++place) {
      const std::size_t block = place / detail::chunk_size;
      if (place % detail::chunk_size == 0) first_corners[block] = sources.size();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = data.triangles[order[place]][k];
        if (last[vertex].block != block) {
          last[vertex] = {static_cast<std::uint32_t>(block),
                          static_cast<std::uint16_t>(sources.size() - first_corners[block])};
          sources.push_back(vertex);
        }
        triangles[place][k] = last[vertex].corner;
      }
    }
    const SharedBuffer<Vec3> corners(sources.size());
    for (std::size_t i = 0; i < sources.size(); ++i) corners[i] = data.vertices[sources[i]];
    mesh->corners_ = corners;
    mesh->first_corners_ = first_corners;
    mesh->triangles_ = triangles;
    sources_ = std::move(sources);
    if (const auto& before = frames_[now_].mesh) {  // what does not move is not among the data
      mesh->texture_ = before->texture_;
      mesh->masks_ = before->masks_;
    }
    frames_ = {};
    frames_[now_] = {std::move(mesh), corners, {}};
  }

  [[nodiscard]] MeshData data(std::span<const Vec3> vertices) const {
    const Mesh& mesh = *frames_[now_].mesh;
    MeshData data{.vertices = {vertices.begin(), vertices.end()}, .materials = materials_};
    data.triangles.resize(mesh.size());
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const std::size_t place = mesh.places_[i];
      const std::uint32_t* const block = &sources_[mesh.first_corners_[place / detail::chunk_size]];
      for (std::size_t k = 0; k < 3; ++k) data.triangles[i][k] = block[mesh.triangles_[place][k]];
    }
    return data;
  }

  std::vector<std::uint32_t> materials_;
  std::size_t vertices_;                ///< number of vertices
  std::vector<std::uint32_t> sources_;  ///< vertex of each corner of the blocks
  std::array<Frame, 2> frames_;
  std::size_t now_ = 0;  ///< frame of the current mesh
};

}  // namespace PULSECAST_NAMESPACE

#endif
