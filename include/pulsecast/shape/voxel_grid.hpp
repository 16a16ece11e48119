// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_VOXEL_GRID_HPP
#define PULSECAST_SHAPE_VOXEL_GRID_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/geometry/detail/bundle_interval.hpp>
#include <pulsecast/shape/detail/voxel_index_builder.hpp>
#include <pulsecast/shape/transmissive_voxels.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Intersection of a ray's walk with solid cubes, as with a mesh of them without walls between two.
/// A ray that begins inside a cube meets its far side, or the cube that touches it there.
template <class Columns, class Hits>
class SolidMeeting {
 public:
  SolidMeeting(const Columns& columns, const LatticeRay& ray, double near, std::size_t j, Hits& nearest) noexcept
      : columns_(columns), ray_(ray), begin_{near, Crossing::begin}, j_(j), nearest_(nearest) {}

  double operator()(std::uint32_t number, const LatticeCell& cell, const Crossing& in, const Crossing& out) noexcept {
    const LatticeRay::Passage cube = columns_.passage(ray_, number, cell, in, out);
    if (!cube.in.before(cube.out) || !begin_.before(cube.out)) return far_side_;
    if (cube.in.before(begin_) || cube.in.axis == Crossing::begin) {
      far_side_ = cube.out.range;
      around_ = number;
      return far_side_;
    }
    if (cube.in.range <= far_side_) {
      far_side_ = infinity;
      nearest_.offer(j_, cube.in.range, number);
    }
    return -infinity;
  }

  void finish() noexcept {
    if (far_side_ < infinity) nearest_.offer(j_, far_side_, around_);
  }

 private:
  const Columns& columns_;
  const LatticeRay& ray_;
  Crossing begin_;
  std::size_t j_;
  Hits& nearest_;
  double far_side_ = infinity;  ///< far side of the cube around the ray's start [m]
  std::uint32_t around_ = 0;    ///< number of that cube
};

/// Normal of the face at which a ray meets a cube; that of the far side if the ray begins inside.
[[nodiscard]] inline Vec3 face_normal(const LatticeRay& ray, const LatticeRay::Passage& cube, double near) noexcept {
  const bool from_inside = cube.in.before({near, Crossing::begin});
  const int axis = from_inside ? cube.out.axis : cube.in.axis;
  Vec3 normal{};
  normal[axis] = ray.sense(axis) > 0 ? -1 : 1;
  return normal;
}

}  // namespace detail

/// Surface direction of a voxel.
enum class Incidence : std::uint8_t {
  normal,         ///< the voxel's normal, or its face's
  face,           ///< normal of the face of the cube that the ray hits
  perpendicular,  ///< always towards the scanner
};

/// Opaque cubes as large as their cells: of a point cloud. From inside, rays hit the far side.
struct OpaqueVoxels {
  Incidence incidence = Incidence::normal;  ///< surface direction of all voxels

  void archive(auto& a) { a(incidence); }

  class Columns {
   public:
    explicit Columns(DeserializeTag) {}
    /// The columns of `data` in the order of the numbers. @throws SettingError for a missing one
    Columns(const VoxelData& data, std::span<const std::uint32_t> order)
        : normals_(detail::reordered<detail::PackedVector>(data.normals, order)) {}

    [[nodiscard]] std::size_t memory() const noexcept { return normals_.memory(); }

    [[nodiscard]] LatticeRay::Passage passage(const LatticeRay&, std::uint32_t, const LatticeCell&, const Crossing& in,
                                              const Crossing& out) const noexcept {
      return {in, out};
    }

    [[nodiscard]] auto meeting(const OpaqueVoxels&, const LatticeRay& ray, const auto& rays, std::size_t j,
                               auto& nearest) const noexcept {
      return detail::SolidMeeting(*this, ray, rays.near, j, nearest);
    }

    [[nodiscard]] Vec3 normal(const OpaqueVoxels& settings, std::uint32_t number, const VoxelIndex& index,
                              const auto& rays, std::size_t j) const noexcept {
      if (settings.incidence == Incidence::perpendicular) return {};
      if (settings.incidence == Incidence::normal && !normals_.empty()) {
        const Vec3 kept = normals_[number].unpacked();
        if (kept != Vec3{}) return normalize(kept);
      }
      const LatticeRay ray = index.ray(rays, j);
      return detail::face_normal(ray, ray.through(index.cell(number)), rays.near);
    }

    void archive(auto& a) { a(normals_); }

   private:
    SharedArray<detail::PackedVector> normals_;
  };
};

/// Opaque cubes inside their cells, each with its own size and shift: a plant model from known
/// density. Source: Weiser et al. 2021. Requires scales; `Incidence::normal` means the face.
struct ScaledVoxels {
  Incidence incidence = Incidence::face;  ///< surface direction of all voxels

  void archive(auto& a) { a(incidence); }

  class Columns {
   public:
    explicit Columns(DeserializeTag) {}
    /// The columns of `data` in the order of the numbers. @throws SettingError for a missing one
    Columns(const VoxelData& data, std::span<const std::uint32_t> order)
        : scales_(detail::reordered<float>(data.scales, order)),
          shifts_(detail::reordered<detail::PackedVector>(data.shifts, order)) {
      if (scales_.empty())
        throw SettingError("VoxelData::scales", 0, "",
                           "as many as cells, " + std::to_string(data.cells.size()) + ", for scaled voxels");
    }

    [[nodiscard]] std::size_t memory() const noexcept { return scales_.memory() + shifts_.memory(); }

    [[nodiscard]] LatticeRay::Passage passage(const LatticeRay& ray, std::uint32_t number, const LatticeCell& cell,
                                              const Crossing&, const Crossing&) const noexcept {
      const double half = static_cast<double>(scales_[number]) / 2;
      const Vec3 shift = shifts_.empty() ? Vec3{} : shifts_[number].unpacked();
      std::array<double, 3> low, high;
      for (std::size_t k = 0; k < 3; ++k) {
        const double centre = 0.5 + shift[static_cast<int>(k)];
        low[k] = cell[k] + std::max(centre - half, 0.0);
        high[k] = cell[k] + std::min(centre + half, 1.0);
      }
      return ray.through(low, high);
    }

    [[nodiscard]] auto meeting(const ScaledVoxels&, const LatticeRay& ray, const auto& rays, std::size_t j,
                               auto& nearest) const noexcept {
      return detail::SolidMeeting(*this, ray, rays.near, j, nearest);
    }

    [[nodiscard]] Vec3 normal(const ScaledVoxels& settings, std::uint32_t number, const VoxelIndex& index,
                              const auto& rays, std::size_t j) const noexcept {
      if (settings.incidence == Incidence::perpendicular) return {};
      const LatticeRay ray = index.ray(rays, j);
      return detail::face_normal(ray, passage(ray, number, index.cell(number), {}, {}), rays.near);
    }

    void archive(auto& a) { a(scales_, shifts_); }

   private:
    SharedArray<float> scales_;
    SharedArray<detail::PackedVector> shifts_;
  };
};

/// Sparse grid of voxels; each ray is traversed cell by cell. Primitives are numbered by position,
/// not as in the data. Takes at most 40 bytes per voxel plus 16. `Filling`: `OpaqueVoxels`,
/// `ScaledVoxels` or `TransmissiveVoxels`, with the settings of all voxels.
template <class Filling = OpaqueVoxels>
class VoxelGrid {
 public:
  /// True if its surfaces are foliage.
  static constexpr bool of_leaves = std::same_as<Filling, TransmissiveVoxels>;
  static constexpr bool deterministic = !of_leaves;  ///< as DeterministicGeometry describes

  explicit VoxelGrid(DeserializeTag tag) : index_(tag), columns_(tag) {}

  /// @throws SettingError as `VoxelData::validate`, `VoxelIndex`, or for a missing column
  explicit VoxelGrid(const VoxelData& data, Filling filling = {}) : VoxelGrid(data, std::move(filling), {}) {}

  [[nodiscard]] std::size_t size() const noexcept { return index_.size(); }
  [[nodiscard]] const Box& bounds() const noexcept { return index_.bounds(); }
  [[nodiscard]] std::size_t material_count() const noexcept { return material_count_; }

  /// Memory held [byte], without the table of leaf angles, which grids may share.
  [[nodiscard]] std::size_t memory() const noexcept {
    return index_.memory() + columns_.memory() + materials_.memory();
  }

  /// Cell of a voxel, which contains its hits [m].
  [[nodiscard]] Box cell(PrimitiveIndex i) const noexcept {
    const LatticeCell c = index_.cell(i);
    const Vec3 low = bounds().min + index_.edge() * Vec3(c[0], c[1], c[2]);
    return {low, low + Vec3(index_.edge())};
  }

  template <class Rays, HitsOf<Rays> Hits>
  void closest(const Rays& rays, Hits& nearest) const noexcept {
    const Vec3 centre = bounds().centre();
    const auto box = BoundingBox<double>::around(bounds(), centre);
    const auto span = BundleInterval<double>(rays, bounds(), centre).inside(box);
    if (span.empty() || span.entry > nearest.limit(rays)) return;
    for (std::size_t j = 0; j < rays.size; ++j) {
      const LatticeRay ray = index_.ray(rays, j);
      auto meeting = columns_.meeting(filling_, ray, rays, j, nearest);
      const auto meet = [&meeting](auto... crossed) noexcept { return meeting(crossed...); };
      index_.walk(ray, rays.near, nearest.limit_of(j), meet);
      meeting.finish();
    }
  }

  /// All hits of a ray with solid voxels: the closest from each on. Light ends at its first leaf.
  void closest(const SingleRayPacket& ray, AllHits& hits) const noexcept {
    const auto next = [this](const SingleRayPacket& from, ClosestHit& hit) noexcept { closest(from, hit); };
    of_leaves ? hits.offer_first(ray, next) : hits.offer_chain(ray, next);
  }

  [[nodiscard]] SurfaceInteraction surface(PrimitiveIndex i, const auto& rays, std::size_t j) const noexcept {
    const std::uint32_t material = materials_.empty() ? 0U : materials_[i];
    return {columns_.normal(filling_, i, index_, rays, j), material, of_leaves};
  }

  void archive(auto& a) {
    index_.archive(a);
    filling_.archive(a);
    columns_.archive(a);
    a(materials_, material_count_);
  }

 private:
  VoxelGrid(const VoxelData& data, Filling filling, std::vector<std::uint32_t> order)
      : filling_(validated(std::move(filling))),
        index_(validated_data(data), order),
        columns_(data, order),
        materials_(detail::reordered<std::uint16_t>(data.materials, order)) {
    for (const std::uint16_t m : materials_)
      material_count_ = std::max<std::uint64_t>(material_count_, std::uint64_t{m} + 1);
  }

  static const VoxelData& validated_data(const VoxelData& data) {
    data.validate();
    return data;
  }

  Filling filling_{};
  VoxelIndex index_;
  typename Filling::Columns columns_;
  SharedArray<std::uint16_t> materials_;
  std::uint64_t material_count_ = 1;
};

}  // namespace PULSECAST_NAMESPACE

#endif
