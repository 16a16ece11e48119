// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_LEAF_COLUMNS_HPP
#define PULSECAST_SHAPE_DETAIL_LEAF_COLUMNS_HPP

#include <cmath>
#include <cstdint>
#include <limits>

#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Name of a column of leaves.
struct LeafColumn {
  std::uint64_t layer = 0;  ///< number of its layer
  std::uint32_t place = 0;  ///< place in the layer, mixed
};

/// Columns of space of a leaf's area across the ray, along the axis that a ray is nearest to, in layers of a few
/// leaves' width that are shifted against each other. Rays in the same column of a layer hit the same leaf.
class LeafColumns {
 public:
  /// Layer along a ray.
  struct Layer {
    double end = std::numeric_limits<double>::infinity();  ///< range at which the ray leaves it; infinite for a layer
                                                           ///< without an end [m]
    LeafColumn column{};                                   ///< the ray's column in it
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

  /// Layer at a range [m].
  [[nodiscard]] Layer at(double range) const noexcept {
    const double start = origin_[along_], slope = direction_[along_], step = slope > 0 ? 1 : -1;
    double layer = std::floor((start + range * slope) / thickness_);
    const auto end_of_layer = [&] { return ((slope > 0 ? layer + 1 : layer) * thickness_ - start) / slope; };
    if (!(end_of_layer() > range)) layer += step;  // rounding left it in the layer before
    const double end = end_of_layer(), middle = ((layer + 0.5) * thickness_ - start) / slope;
    // shifts of layers are even in the plane. Source: Roberts 2018, powers of the plastic number
    const auto place = [&](int axis, double shift) {
      const double shifted =
          (origin_[axis] + middle * direction_[axis]) / width_ + layer * shift - std::floor(layer * shift);
      return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(shifted)));
    };
    std::uint32_t mixed =
        place((along_ + 1) % 3, 0.7548776662466927) * 0x9E3779B1U + place((along_ + 2) % 3, 0.5698402909980532);
    mixed = (mixed ^ (mixed >> 15)) * 0x85EBCA77U + static_cast<std::uint32_t>(along_);
    return {end > range ? end : std::nextafter(range, std::numeric_limits<double>::infinity()),
            {static_cast<std::uint64_t>(static_cast<std::int64_t>(layer)), mixed}};
  }

 private:
  Vec3 origin_{}, direction_{};
  int along_ = 2;                     // axis of the columns
  double thickness_ = 1, width_ = 1;  // of a layer, of a column [m]
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
