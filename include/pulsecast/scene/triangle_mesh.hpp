// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/accel/bvh.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/geometry/triangle.hpp>

namespace pulsecast {

/// What a triangle mesh is made from.
struct MeshData {
  std::vector<Vec3> vertices{};                           ///< [m]
  std::vector<std::array<std::uint32_t, 3>> triangles{};  ///< numbers of their corners, from 0
  std::vector<std::uint32_t> materials{};                 ///< one a triangle: index into the part's table; empty if all are 0

  void validate() const {
    const auto refuse = [](const char* field, double value, const char* unit, std::string allowed) {
      throw SettingError(field, value, unit, std::move(allowed));
    };
    if (triangles.empty()) refuse("MeshData::triangles", 0, "", "at least one in number");
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      for (int k = 0; k < 3; ++k)
        if (!std::isfinite(vertices[i][k])) refuse("MeshData::vertices", vertices[i][k], "m", "finite; see vertex " + std::to_string(i));
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (const std::uint32_t corner : triangles[i])
        if (corner >= vertices.size())
          refuse("MeshData::triangles", corner, "",
                 "less than the number of vertices, " + std::to_string(vertices.size()) + "; see triangle " + std::to_string(i));
    }
    if (!materials.empty() && materials.size() != triangles.size())
      refuse("MeshData::materials", static_cast<double>(materials.size()), "",
             "as many as triangles, " + std::to_string(triangles.size()) + ", or none");
  }

  /// The triangle of a number [m].
  [[nodiscard]] Triangle triangle(std::size_t i) const noexcept {
    const auto& corners = triangles[i];
    return {vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]};
  }
};

/// Triangles that share their corners. Both sides count; a triangle without area is never met.
template <template <class> class Index = Bvh, std::floating_point Real = float>
requires Accelerator<Index<Real>>
class TriangleMesh {
 public:
  explicit TriangleMesh(MeshData data) : data_(validated(std::move(data))), index_(boxes(data_)) {
    for (const std::uint32_t m : data_.materials) material_count_ = std::max<std::size_t>(material_count_, std::size_t{m} + 1);
  }

  [[nodiscard]] std::size_t size() const noexcept { return data_.triangles.size(); }
  [[nodiscard]] Triangle triangle(PrimitiveIndex i) const noexcept { return data_.triangle(i); }
  [[nodiscard]] const MeshData& data() const noexcept { return data_; }
  [[nodiscard]] const Index<Real>& index() const noexcept { return index_; }
  [[nodiscard]] std::size_t material_count() const noexcept { return material_count_; }
  [[nodiscard]] const Box& bounds() const noexcept { return index_.bounds(); }
  [[nodiscard]] std::size_t memory() const noexcept {
    return index_.memory() + data_.vertices.capacity() * sizeof(Vec3) + data_.triangles.capacity() * sizeof(data_.triangles[0]) +
           data_.materials.capacity() * sizeof(data_.materials[0]);
  }

  void closest(const RayBundle& rays, Nearest& nearest) const noexcept {
    const auto test = [&](std::span<const PrimitiveIndex> primitives) noexcept {
      for (const PrimitiveIndex i : primitives) intersect(data_.triangle(i), i, rays, nearest);
    };
    index_.closest(rays, test, nearest);
  }

  [[nodiscard]] Surface surface(PrimitiveIndex i, const RayBundle&, std::size_t) const noexcept {
    const Vec3 normal = data_.triangle(i).normal();
    return {finite(normal) ? normal : Vec3{}, data_.materials.empty() ? 0 : data_.materials[i]};
  }

 private:
  static std::vector<Box> boxes(const MeshData& data) {
    std::vector<Box> all;
    all.reserve(data.triangles.size());
    for (std::size_t i = 0; i < data.triangles.size(); ++i) all.push_back(data.triangle(i).bounds());
    return all;
  }

  MeshData data_;
  Index<Real> index_;
  std::size_t material_count_ = 1;
};

static_assert(Geometry<TriangleMesh<>>);

}  // namespace pulsecast
