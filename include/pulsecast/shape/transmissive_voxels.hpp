// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_TRANSMISSIVE_VOXELS_HPP
#define PULSECAST_SHAPE_TRANSMISSIVE_VOXELS_HPP

#include <pulsecast/base/random.hpp>
#include <pulsecast/shape/detail/voxel_index.hpp>
#include <pulsecast/shape/leaf_angles.hpp>
#include <pulsecast/shape/voxel_data.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Name of a column of leaves.
struct LeafColumn {
  std::uint64_t layer = 0;  ///< number of its layer
  std::uint32_t place = 0;  ///< place in the layer, mixed
};

/// Columns of space of a leaf's area across the ray, along the axis that it is nearest to, in
/// shifted layers of a few leaves' width. Rays in the same column of a layer meet the same leaf.
class LeafColumns {
 public:
  struct Layer {
    double end = detail::infinity;  ///< range at which the ray leaves it [m]
    LeafColumn column{};            ///< the ray's column in it
  };

  LeafColumns() = default;
  /// Columns of a ray, for leaves of an area [m^2].
  LeafColumns(const Vec3& origin, const Vec3& direction, double area) noexcept
      : origin_(origin), direction_(direction) {
    const Vec3 size{std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)};
    along_ = size.z >= size.x && size.z >= size.y ? 2 : size.y >= size.x ? 1 : 0;
    thickness_ = 4 * std::sqrt(area);
    width_ = std::sqrt(area * length(direction) / size[along_]);
  }

  [[nodiscard]] Layer at(double range) const noexcept {
    const double start = origin_[along_], slope = direction_[along_], step = slope > 0 ? 1 : -1;
    double layer = std::floor((start + range * slope) / thickness_);
    const auto end_of_layer = [&] { return ((slope > 0 ? layer + 1 : layer) * thickness_ - start) / slope; };
    if (!(end_of_layer() > range)) layer += step;  // rounding left it in the layer before
    const double end = end_of_layer(), middle = ((layer + 0.5) * thickness_ - start) / slope;
    // shifts of layers are even in the plane. Source: Roberts 2018, powers of the plastic number
    const auto place = [&](int axis, double shift) {
      const double at = (origin_[axis] + middle * direction_[axis]) / width_;
      const double shifted = at + layer * shift - std::floor(layer * shift);
      return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(shifted)));
    };
    std::uint32_t mixed = place((along_ + 1) % 3, 0.7548776662466927) * 0x9E3779B1U;
    mixed += place((along_ + 2) % 3, 0.5698402909980532);
    mixed = (mixed ^ (mixed >> 15)) * 0x85EBCA77U + static_cast<std::uint32_t>(along_);
    return {end > range ? end : std::nextafter(range, detail::infinity),
            {static_cast<std::uint64_t>(static_cast<std::int64_t>(layer)), mixed}};
  }

 private:
  Vec3 origin_{}, direction_{};
  int along_ = 2;                     // axis of the columns
  double thickness_ = 1, width_ = 1;  // of a layer, of a column [m]
};

}  // namespace detail

/// Turbid medium of randomly placed leaves: light passes until it meets one. Requires densities.
/// Transmittance along a path of length s is exp(-PAD G s clumping). Each ray draws its optical
/// depth once per part and consumes it from voxel to voxel: as the law is memoryless, this equals a
/// draw per voxel, of any size. Draws are independent between parts. A ray that begins inside
/// counts its path from there. Density, paths and G are of the part's own frame, z being vertical:
/// scaling a plant keeps its transmittance. Leaves send back as tilted surfaces: the cosine of
/// incidence is their mean squared cosine by their mean cosine.
/// Leaves without an area are as small as the subrays: each ray draws for itself, and echoes depend
/// on their number. With an area, rays as close to each other as a leaf is wide share their draws;
/// echoes and their deviation are those of such facets, and leaves stay from pulse to pulse, each
/// with its own incidence. Source: North 1996; Ross 1981; Nilson 1971 for clumping.
struct TransmissiveVoxels {
  LeafAngles leaf_angles{};   ///< inclinations of all leaves
  bool tilted_leaves = true;  ///< false: as if all leaves were across the light, as in HELIOS++
  double leaf_area = 0;       ///< one-sided, of a leaf or shoot, at most 100; 0: no size [m^2]
  double clumping = 1;        ///< of the extinction, 0.01 to 10: below 1 as needles in shoots

  void validate() const {
    require_within("TransmissiveVoxels::leaf_area", leaf_area, 0, 100, "m^2");
    require_within("TransmissiveVoxels::clumping", clumping, 0.01, 10, "");
  }

  void archive(auto& a) {
    leaf_angles.archive(a);
    a(tilted_leaves, leaf_area, clumping);
  }

  class Columns {
   public:
    explicit Columns(DeserializeTag) {}
    /// The columns of `data` in the order of the numbers. @throws SettingError for a missing one
    Columns(const VoxelData& data, std::span<const std::uint32_t> order)
        : densities_(detail::reordered<float>(data.densities, order)) {
      if (densities_.empty())
        throw SettingError("VoxelData::densities", 0, "",
                           "as many as cells, " + std::to_string(data.cells.size()) + ", for transmissive voxels");
    }

    [[nodiscard]] std::size_t memory() const noexcept { return densities_.memory(); }

    /// Visitor of the voxels along a ray, which consumes its optical depth.
    template <class Rays, class Hits>
    class Meeting {
     public:
      /// Ray j of a bundle; `nearest` gets its hit.
      Meeting(const Columns& columns, const TransmissiveVoxels& leaves, const Rays& rays, std::size_t j,
              Hits& nearest) noexcept
          : columns_(columns), leaves_(leaves), rays_(rays), j_(j), nearest_(nearest) {}

      /// Passes a voxel; returns the range limit of the walk [m].
      double operator()(std::uint32_t number, const auto&, const Crossing& in, const Crossing& out) noexcept {
        if (per_density_ == 0) begin(in.range);
        const double extinction = static_cast<double>(columns_.densities_[number]) * per_density_;
        for (double from = in.range;;) {
          if (from >= layer_.end) draw(from);
          const double to = std::min(out.range, layer_.end), depth = extinction * (to - from);
          if (depth > 0 && depth >= left_) return meet(std::min(from + left_ / extinction, to), number);
          left_ -= depth;
          if (to == out.range) return detail::infinity;
          from = to;
        }
      }

      /// Ends the walk.
      void finish() noexcept {}

     private:
      double meet(double at, std::uint32_t number) noexcept {
        if (!(at > rays_.near)) at = std::nextafter(rays_.near, detail::infinity);
        nearest_.offer(j_, at, number);
        return -detail::infinity;
      }

      void begin(double range) noexcept {
        const Vec3 direction = rays_.direction(j_);
        const double projection = leaves_.leaf_angles.projection(direction);
        per_density_ = leaves_.clumping * projection * rays_.direction_length;
        if (!(per_density_ > 0)) per_density_ = std::numeric_limits<double>::min();  // edge-on
        if (leaves_.leaf_area > 0) columns_of_leaves_ = {rays_.origin, direction, leaves_.leaf_area};
        draw(range);
      }

      /// Draws the optical depth for the layer at a range, endless without a leaf size.
      void draw(double range) noexcept {
        const auto subray = rays_.first_subray + static_cast<std::uint32_t>(j_);
        const auto part = static_cast<std::uint32_t>(nearest_.part >> 32);
        RandomKey key{rays_.seed, rays_.pulse, subray, Purpose::free_path, part};
        if (leaves_.leaf_area > 0) {
          layer_ = columns_of_leaves_.at(range);
          key.pulse = layer_.column.layer;
          key.subray = layer_.column.place;
        }
        left_ = -std::log(uniform(key));
      }

      const Columns& columns_;
      const TransmissiveVoxels& leaves_;
      const Rays& rays_;
      std::size_t j_;
      Hits& nearest_;
      detail::LeafColumns columns_of_leaves_{};
      detail::LeafColumns::Layer layer_{};
      double left_ = 0;         ///< optical depth left to the ray
      double per_density_ = 0;  ///< optical depth per range and density; 0 before the draw
    };

    template <class Rays, class Hits>
    [[nodiscard]] Meeting<Rays, Hits> meeting(const TransmissiveVoxels& settings, const LatticeRay&, const Rays& rays,
                                              std::size_t j, Hits& nearest) const noexcept {
      return {*this, settings, rays, j, nearest};
    }

    [[nodiscard]] Vec3 normal(const TransmissiveVoxels& settings, std::uint32_t number, const VoxelIndex& index,
                              const auto& rays, std::size_t j) const noexcept {
      if (!settings.tilted_leaves) return {};
      const Vec3 direction = rays.direction(j), along = pulsecast::normalize(direction);
      double cosine = settings.leaf_angles.incidence_cosine(along);
      if (settings.leaf_area > 0) {  // a leaf's own, of that mean; its square is uniform if 2/3, as of spherical leaves
        const LatticeRay::Passage passage = index.ray(rays, j).through(index.cell(number));
        const detail::LeafColumns columns(rays.origin, direction, settings.leaf_area);
        const auto [layer, place] = columns.at(0.5 * (passage.in.range + passage.out.range)).column;
        cosine = std::pow(uniform({rays.seed, layer, place, Purpose::leaf_tilt, 0}), 1 / cosine - 1);
      }
      const Vec3 other = std::fabs(along.x) < 0.5 ? axis::right : axis::up;  // any direction
      const Vec3 aside = pulsecast::normalize(cross(along, other));
      return -cosine * along + std::sqrt(1 - cosine * cosine) * aside;
    }

    void archive(auto& a) { a(densities_); }

   private:
    SharedArray<float> densities_;
  };
};

}  // namespace PULSECAST_NAMESPACE

#endif
