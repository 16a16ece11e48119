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
#include <pulsecast/base/frozen.hpp>
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
  explicit TriangleMesh(MeshData data) : index_(boxes(data)) {
    for (const std::uint32_t m : data.materials) material_count_ = std::max<std::size_t>(material_count_, std::size_t{m} + 1);
    vertices_ = std::move(data.vertices), triangles_ = std::move(data.triangles), materials_ = std::move(data.materials);
  }

  explicit TriangleMesh(Unfilled unfilled) requires std::constructible_from<Index<Real>, Unfilled> : index_(unfilled) {}
  template <class Archive>
  void archive(Archive& a) {
    a(vertices_, triangles_, materials_, index_, material_count_);
  }
  [[nodiscard]] bool sound() const {
    const auto has_corners = [&](const std::array<std::uint32_t, 3>& t) { return std::max({t[0], t[1], t[2]}) < vertices_.size(); };
    if (!std::all_of(triangles_.begin(), triangles_.end(), has_corners)) return false;
    if (material_count_ == 0 || (!materials_.empty() && materials_.size() != size())) return false;
    if (!std::all_of(materials_.begin(), materials_.end(), [&](std::uint32_t m) { return m < material_count_; })) return false;
    if constexpr (requires { index_.sound(size()); }) return index_.sound(size());
    return true;
  }

  [[nodiscard]] std::size_t size() const noexcept { return triangles_.size(); }
  [[nodiscard]] Triangle triangle(PrimitiveIndex i) const noexcept {
    const auto& corners = triangles_[i];
    return {vertices_[corners[0]], vertices_[corners[1]], vertices_[corners[2]]};
  }
  [[nodiscard]] const Index<Real>& index() const noexcept { return index_; }
  [[nodiscard]] std::size_t material_count() const noexcept { return material_count_; }
  [[nodiscard]] const Box& bounds() const noexcept { return index_.bounds(); }
  [[nodiscard]] std::size_t memory() const noexcept {
    return index_.memory() + vertices_.memory() + triangles_.memory() + materials_.memory();
  }

  void closest(const RayBundle& rays, Nearest& nearest) const noexcept {
    const auto test = [&](std::span<const PrimitiveIndex> primitives) noexcept {
      for (const PrimitiveIndex i : primitives) intersect(triangle(i), i, rays, nearest);
    };
    index_.closest(rays, test, nearest);
  }

  [[nodiscard]] Surface surface(PrimitiveIndex i, const RayBundle&, std::size_t) const noexcept {
    const Vec3 normal = triangle(i).normal();
    return {finite(normal) ? normal : Vec3{}, materials_.empty() ? 0 : materials_[i]};
  }

 private:
  static std::vector<Box> boxes(const MeshData& data) {
    data.validate();
    std::vector<Box> all;
    all.reserve(data.triangles.size());
    for (std::size_t i = 0; i < data.triangles.size(); ++i) all.push_back(data.triangle(i).bounds());
    return all;
  }

  Frozen<Vec3> vertices_;
  Frozen<std::array<std::uint32_t, 3>> triangles_;
  Frozen<std::uint32_t> materials_;  ///< empty if all are 0
  Index<Real> index_;
  std::size_t material_count_ = 1;
};

static_assert(Geometry<TriangleMesh<>>);

}  // namespace pulsecast
