// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_LATTICE_RAY_HPP
#define PULSECAST_SHAPE_DETAIL_LATTICE_RAY_HPP

#include <pulsecast/geometry/bundle.hpp>

namespace PULSECAST_NAMESPACE {

/// Cell of a lattice, along x, y and z.
using LatticeCell = std::array<std::int32_t, 3>;

/// Crossing of a ray and a lattice plane, ordered by range, then x before y before z (symbolic
/// perturbation): a ray through an edge or a corner passes to a neighbour through a face.
struct Crossing {
  static constexpr int begin = 3;  ///< in place of an axis: start of the ray, after all crossings there

  double range = 0;  ///< range of the crossing [m]
  int axis = begin;  ///< normal axis of the plane

  /// True if this crossing comes first.
  [[nodiscard]] bool before(const Crossing& other) const noexcept {
    return range < other.range || (range == other.range && axis < other.axis);
  }
};

/// Ray among the planes of a lattice of cubes. The range of a plane's crossing is the same bit by
/// bit on both sides: no gaps. A cell owns its lower faces, for rays along them.
class LatticeRay {
 public:
  /// `corner`: meeting point of the planes 0 [m]; `edge`: edge of a cell [m].
  LatticeRay(const Vec3& corner, double edge, const auto& rays, std::size_t j) noexcept
      : edge_(edge), per_edge_(1 / edge) {
    const Vec3 direction = rays.direction(j);
    for (int k = 0; k < 3; ++k) {
      start_[k] = corner[k] - rays.origin[k];
      speed_[k] = direction[k];
      per_speed_[k] = 1 / direction[k];
      sense_[k] = !std::isfinite(per_speed_[k]) ? 0 : direction[k] > 0 ? 1 : -1;
    }
    valid_ = finite(rays.origin) && finite(direction) && (sense_[0] != 0 || sense_[1] != 0 || sense_[2] != 0);
  }

  /// True if origin and direction are finite and the ray moves along at least one axis.
  [[nodiscard]] bool valid() const noexcept { return valid_; }

  /// Sign of the direction, +1 or -1; 0 if the ray stays between two planes.
  [[nodiscard]] int sense(int k) const noexcept { return sense_[k]; }

  /// Crossing with a plane by its number, whole or not. Requires sense(k) != 0.
  [[nodiscard]] Crossing crossing(int k, double plane) const noexcept {
    return {(start_[k] + edge_ * plane) * per_speed_[k], k};
  }

  /// True if a ray with sense(k) = 0 is at or above a plane.
  [[nodiscard]] bool above(int k, double plane) const noexcept { return start_[k] + edge_ * plane <= 0; }

  /// Position along an axis at a range [m], up to rounding [edges].
  [[nodiscard]] double position(int k, double range) const noexcept {
    return (range * speed_[k] - start_[k]) * per_edge_;
  }

  /// Entry into and exit from a box [edges]. The ray misses the box unless `in` is before `out`.
  struct Passage {
    Crossing in{-detail::infinity, 0};  ///< entry
    Crossing out{detail::infinity, 0};  ///< exit
  };
  using Corner = std::array<double, 3>;  ///< corner of a box [edges]

  /// Passage through a cell.
  [[nodiscard]] Passage through(const LatticeCell& cell) const noexcept {
    Corner low, high;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = cell[k];
      high[k] = cell[k] + 1;
    }
    return through(low, high);
  }
  /// Passage through the box between two corners [edges].
  [[nodiscard]] Passage through(const Corner& low, const Corner& high) const noexcept {
    Passage p;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      if (sense(k) == 0) {
        if (!above(k, low[axis]) || above(k, high[axis])) return {Passage{}.out, Passage{}.in};
        continue;
      }
      const Crossing in = crossing(k, sense(k) > 0 ? low[axis] : high[axis]),
                     out = crossing(k, sense(k) > 0 ? high[axis] : low[axis]);
      if (p.in.before(in)) p.in = in;
      if (out.before(p.out)) p.out = out;
    }
    return p;
  }

 private:
  double edge_, per_edge_;
  double start_[3], speed_[3], per_speed_[3];
  int sense_[3];
  bool valid_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
