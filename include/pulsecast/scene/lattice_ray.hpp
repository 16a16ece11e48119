// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <pulsecast/geometry/bundle.hpp>

namespace pulsecast {

/// A cell of a lattice, along x, y and z.
using LatticeCell = std::array<std::int32_t, 3>;

/// Where a ray crosses a plane of a lattice. Crossings are in order of range; at exactly equal range x comes before y before z, as for a
/// ray that is moved aside by next to nothing. So a ray through an edge or a corner still goes from a cell to its neighbour by a face.
struct Crossing {
  static constexpr int begin = 3;  ///< in place of an axis: where the ray begins to count, after all that it crosses at that range

  double range = 0;  ///< [m]
  int axis = begin;  ///< that the plane is across

  [[nodiscard]] bool before(const Crossing& other) const noexcept {
    return range < other.range || (range == other.range && axis < other.axis);
  }
};

/// A ray among the planes of a lattice of cubes. A plane of one number is crossed at one range, to the last bit, whichever of the cells
/// at its sides asks: neighbours leave no gap. A cell owns the least of its faces, for rays that go along them.
class LatticeRay {
 public:
  /// `corner` is where the planes 0 meet.
  LatticeRay(const Vec3& corner, double edge, const RayBundle& rays, std::size_t j) noexcept : edge_(edge), per_edge_(1 / edge) {
    const Vec3 direction = rays.direction(j);
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      start_[axis] = corner[k] - rays.origin[k];
      speed_[axis] = direction[k], per_speed_[axis] = 1 / direction[k];
      sense_[axis] = !std::isfinite(per_speed_[axis]) ? 0 : direction[k] > 0 ? 1 : -1;
    }
    valid_ = finite(rays.origin) && finite(direction) && (sense_[0] != 0 || sense_[1] != 0 || sense_[2] != 0);
  }

  /// Whether it goes anywhere.
  [[nodiscard]] bool valid() const noexcept { return valid_; }

  /// +1 or -1, or 0 if the ray stays between two planes.
  [[nodiscard]] int sense(int k) const noexcept { return sense_[static_cast<std::size_t>(k)]; }

  /// Of the plane of a number, whole or not, across an axis along which the ray goes.
  [[nodiscard]] Crossing crossing(int k, double plane) const noexcept {
    const auto axis = static_cast<std::size_t>(k);
    return {(start_[axis] + edge_ * plane) * per_speed_[axis], k};
  }

  /// Whether a ray that does not go along the axis stays at or above a plane.
  [[nodiscard]] bool above(int k, double plane) const noexcept { return start_[static_cast<std::size_t>(k)] + edge_ * plane <= 0; }

  /// Position along an axis, in edges, give or take rounding.
  [[nodiscard]] double position(int k, double range) const noexcept {
    const auto axis = static_cast<std::size_t>(k);
    return (range * speed_[axis] - start_[axis]) * per_edge_;
  }

  /// Where the ray enters and leaves a box, in edges; nothing of it is inside unless one is before the other.
  struct Passage {
    Crossing in{-std::numeric_limits<double>::infinity(), 0}, out{std::numeric_limits<double>::infinity(), 0};
  };
  [[nodiscard]] Passage through(const std::array<double, 3>& low, const std::array<double, 3>& high) const noexcept {
    Passage p;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      if (sense(k) == 0) {
        if (!above(k, low[axis]) || above(k, high[axis])) return {.in = Passage{}.out, .out = Passage{}.in};
        continue;
      }
      const Crossing in = crossing(k, sense(k) > 0 ? low[axis] : high[axis]), out = crossing(k, sense(k) > 0 ? high[axis] : low[axis]);
      if (p.in.before(in)) p.in = in;
      if (out.before(p.out)) p.out = out;
    }
    return p;
  }

 private:
  double edge_, per_edge_;
  std::array<double, 3> start_, speed_, per_speed_;
  std::array<int, 3> sense_;
  bool valid_;
};

}  // namespace pulsecast
