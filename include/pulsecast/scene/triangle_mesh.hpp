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

/// Triangles that share their corners. Both sides count; a triangle without area is never met. They keep their numbers, but stand in
/// memory as the index meets them, and so do the corners.
template <template <class> class Index = Bvh, std::floating_point Real = float>
requires Accelerator<Index<Real>>
class TriangleMesh {
 public:
  static constexpr bool flat = true;

  /// `threads` to build it on; 0 for as many as the machine runs.
  explicit TriangleMesh(MeshData data, unsigned threads = 0) : index_(built(data, threads)) {
    for (const std::uint32_t m : data.materials) material_count_ = std::max<std::size_t>(material_count_, std::size_t{m} + 1);
    materials_ = std::move(data.materials);
    arrange(std::move(data));
  }

  explicit TriangleMesh(Unfilled unfilled) requires std::constructible_from<Index<Real>, Unfilled> : index_(unfilled) {}
  template <class Archive>
  void archive(Archive& a) {
    a(corners_, triangles_, places_, materials_, index_, material_count_);
  }
  [[nodiscard]] bool sound() const {
    const auto has_corners = [&](const std::array<std::uint32_t, 3>& t) { return std::max({t[0], t[1], t[2]}) < corners_.size(); };
    if (!std::all_of(triangles_.begin(), triangles_.end(), has_corners)) return false;
    if (triangles_.size() != index_.order().size()) return false;
    if (!std::all_of(places_.begin(), places_.end(), [&](std::uint32_t place) { return place < triangles_.size(); })) return false;
    if (material_count_ == 0 || (!materials_.empty() && materials_.size() != size())) return false;
    if (!std::all_of(materials_.begin(), materials_.end(), [&](std::uint32_t m) { return m < material_count_; })) return false;
    if constexpr (requires { index_.sound(size()); }) return index_.sound(size());
    return true;
  }

  [[nodiscard]] std::size_t size() const noexcept { return places_.size(); }
  [[nodiscard]] Triangle triangle(PrimitiveIndex i) const noexcept { return triangle_of(triangles_[places_[i]]); }
  [[nodiscard]] const Index<Real>& index() const noexcept { return index_; }
  [[nodiscard]] std::size_t material_count() const noexcept { return material_count_; }
  [[nodiscard]] const Box& bounds() const noexcept { return index_.bounds(); }
  [[nodiscard]] std::size_t memory() const noexcept {
    return index_.memory() + corners_.memory() + triangles_.memory() + places_.memory() + materials_.memory();
  }

  void closest(const RayBundle& rays, Nearest& nearest) const noexcept {
    index_.closest(rays, Test{*this, rays, nearest}, nearest);
  }

  [[nodiscard]] Surface surface(PrimitiveIndex i, const RayBundle&, std::size_t) const noexcept {
    const Vec3 normal = triangle(i).normal();
    return {finite(normal) ? normal : Vec3{}, materials_.empty() ? 0 : materials_[i]};
  }

 private:
  /// What the index does with the triangles that it finds.
  struct Test {
    const TriangleMesh& mesh;
    const RayBundle& rays;
    Nearest& nearest;

    void operator()(std::span<const PrimitiveIndex> primitives) const noexcept {
      const auto* const triangles = found(primitives);
      intersect(primitives, [&](std::size_t n) noexcept { return mesh.triangle_of(triangles[n]); }, rays, nearest);
    }
    void soon(std::span<const PrimitiveIndex> primitives) const noexcept { prefetch(primitives.data()), prefetch(found(primitives)); }

    [[nodiscard]] const std::array<std::uint32_t, 3>* found(std::span<const PrimitiveIndex> primitives) const noexcept {
      return mesh.triangles_.data() + (primitives.data() - mesh.index_.order().data());
    }
  };

  [[nodiscard]] Triangle triangle_of(const std::array<std::uint32_t, 3>& corners) const noexcept {
    return {corners_[corners[0]], corners_[corners[1]], corners_[corners[2]]};
  }

  static Index<Real> built(const MeshData& data, unsigned threads) {
    const std::vector<Box> all = boxes(data);
    if constexpr (std::constructible_from<Index<Real>, std::span<const Box>, unsigned>)
      return Index<Real>(all, threads);
    else
      return Index<Real>(all);
  }

  /// Puts triangles and corners where the index meets them.
  void arrange(MeshData data) {
    constexpr std::uint32_t nowhere = 0xFFFFFFFF;
    const auto order = index_.order();
    std::vector<std::uint32_t> moved(data.vertices.size(), nowhere);
    auto places = room_for<std::uint32_t>(data.triangles.size());
    places.resize(data.triangles.size());
    auto triangles = room_for<std::array<std::uint32_t, 3>>(order.size());
    triangles.resize(order.size());
    auto corners = room_for<Vec3>(data.vertices.size());
    for (std::size_t place = 0; place < order.size(); ++place) {
      places[order[place]] = static_cast<std::uint32_t>(place);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t corner = data.triangles[order[place]][k];
        if (moved[corner] == nowhere) moved[corner] = static_cast<std::uint32_t>(corners.size()), corners.push_back(data.vertices[corner]);
        triangles[place][k] = moved[corner];
      }
    }
    corners_ = std::move(corners), triangles_ = std::move(triangles), places_ = std::move(places);
  }

  static std::vector<Box> boxes(const MeshData& data) {
    data.validate();
    std::vector<Box> all;
    all.reserve(data.triangles.size());
    for (std::size_t i = 0; i < data.triangles.size(); ++i) all.push_back(data.triangle(i).bounds());
    return all;
  }

  Frozen<Vec3> corners_;
  Frozen<std::array<std::uint32_t, 3>> triangles_;  ///< the corners' numbers, in the order of the index
  Frozen<std::uint32_t> places_;                    ///< of each triangle, in that order
  Frozen<std::uint32_t> materials_;  ///< empty if all are 0
  Index<Real> index_;
  std::size_t material_count_ = 1;
};

static_assert(Geometry<TriangleMesh<>>);

}  // namespace pulsecast
