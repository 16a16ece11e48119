// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/shape/voxel_data.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

/// The same object by other means: in double precision, with fewer triangles, of voxels.
namespace tradeoff {

using namespace pulsecast;

using Mesh = TriangleMesh<>;
using ExactMesh = TriangleMesh<Bvh<double>>;
using Solid = VoxelGrid<OpaqueVoxels>;
using Foliage = VoxelGrid<TransmissiveVoxels>;

/// Source data of a mesh, but for corners that triangles share.
template <class AnyMesh>
[[nodiscard]] MeshData data_of(const AnyMesh& mesh) {
  MeshData data;
  for (PrimitiveIndex i = 0; i < mesh.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    const auto first = static_cast<std::uint32_t>(data.vertices.size());
    data.vertices.insert(data.vertices.end(), {t.a, t.b, t.c});
    data.triangles.push_back({first, first + 1, first + 2});
    data.materials.push_back(mesh.surface(i, RayBundle{}, 0).material_index);
  }
  return data;
}

/// A scene of the same parts, whose meshes are what a function makes of the data of each.
template <class Other, class Function>
[[nodiscard]] Scene<Other> remade(const Scene<Mesh>& scene, Function function) {
  std::map<const void*, std::shared_ptr<const Other>> made;
  std::vector<typename Scene<Other>::Part> parts;
  for (const auto& part : scene.parts()) {
    const auto& mesh = part.geometry;
    auto& other = made[mesh.get()];
    if (!other) other = std::make_shared<const Other>(function(data_of(*mesh)));
    parts.push_back({other, part.materials, part.placement, part.object});
  }
  return Scene<Other>(std::move(parts));
}

[[nodiscard]] inline Scene<ExactMesh> in_double(const Scene<Mesh>& scene) {
  return remade<ExactMesh>(scene, [](MeshData data) { return data; });
}

/// One in n of the leaves, which are pairs of triangles, enlarged n times: their area is the same. Source: Cook et al.
/// 2007, "Stochastic simplification of aggregate detail".
template <class IsLeaf>
[[nodiscard]] MeshData with_fewer_leaves(const MeshData& data, std::size_t one_in, IsLeaf is_leaf) {
  MeshData fewer;
  std::size_t leaves = 0;
  const auto keep = [&](std::size_t i, const Vec3& middle, double scale) {
    const Triangle t = data.triangle(i);
    const auto first = static_cast<std::uint32_t>(fewer.vertices.size());
    for (const Vec3& corner : {t.a, t.b, t.c}) fewer.vertices.push_back(middle + scale * (corner - middle));
    fewer.triangles.push_back({first, first + 1, first + 2});
    fewer.materials.push_back(data.materials[i]);
  };
  for (std::size_t i = 0; i < data.triangles.size(); ++i) {
    if (!is_leaf(data.materials[i])) {
      keep(i, {}, 1);
      continue;
    }
    if (leaves++ % one_in == 0) {
      const Triangle t = data.triangle(i);
      const Vec3 middle = 0.5 * (t.a + t.c);  // of the midrib, which the two have in common
      keep(i, middle, std::sqrt(static_cast<double>(one_in)));
      keep(i + 1, middle, std::sqrt(static_cast<double>(one_in)));
    }
    ++i;
  }
  return fewer;
}

/// The cells of a lattice that surfaces pass, with the area and the mean normal inside, and the material of most of it.
/// Surfaces are taken as points, three to an edge.
[[nodiscard]] inline VoxelData voxels_of(const MeshData& data, double edge) {
  struct Cell {
    double area = 0, largest = 0;
    Vec3 normal{};
    std::uint32_t material = 0;
  };
  Box box;
  for (const Vec3& vertex : data.vertices) box.extend(vertex);
  std::map<std::array<std::uint32_t, 3>, Cell> cells;
  for (std::size_t i = 0; i < data.triangles.size(); ++i) {
    const Triangle t = data.triangle(i);
    const Vec3 ab = t.b - t.a, ac = t.c - t.a, across = cross(ab, ac);
    const double area = 0.5 * length(across);
    if (!(area > 0)) continue;
    const double longest = std::max({length(ab), length(ac), length(t.c - t.b)});
    const int steps = static_cast<int>(std::ceil(3 * longest / edge));
    const double each = area / (steps * steps);
    for (int u = 0; u < steps; ++u)
      for (int v = 0; v < steps; ++v) {  // a parallelogram of points, the far half of it folded back
        double p = (u + 0.5) / steps, q = (v + 0.5) / steps;
        if (p + q > 1) {
          p = 1 - p;
          q = 1 - q;
        }
        const Vec3 at = (t.a + p * ab + q * ac - box.min) / edge;
        Cell& cell = cells[{static_cast<std::uint32_t>(at.x), static_cast<std::uint32_t>(at.y),
                            static_cast<std::uint32_t>(at.z)}];
        const Vec3 normal = each * normalize(across);
        cell.normal += dot(cell.normal, normal) < 0 ? -normal : normal;
        cell.area += each;
        if (area > cell.largest) {
          cell.largest = area;
          cell.material = data.materials.empty() ? 0 : data.materials[i];
        }
      }
  }
  VoxelData voxels{.corner = box.min, .edge = edge};
  for (const auto& [place, cell] : cells) {
    const double norm = length(cell.normal);
    const Vec3 n = norm > 0 ? cell.normal / norm : Vec3{};
    voxels.cells.push_back(place);
    voxels.normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
    voxels.densities.push_back(static_cast<float>(cell.area / (edge * edge * edge)));
    voxels.materials.push_back(static_cast<std::uint16_t>(cell.material));
  }
  return voxels;
}

/// The triangles of some materials.
template <class Wanted>
[[nodiscard]] MeshData those_of(const MeshData& data, Wanted wanted) {
  MeshData some;
  for (std::size_t i = 0; i < data.triangles.size(); ++i) {
    if (!wanted(data.materials[i])) continue;
    const Triangle t = data.triangle(i);
    const auto first = static_cast<std::uint32_t>(some.vertices.size());
    some.vertices.insert(some.vertices.end(), {t.a, t.b, t.c});
    some.triangles.push_back({first, first + 1, first + 2});
    some.materials.push_back(data.materials[i]);
  }
  return some;
}

}  // namespace tradeoff
