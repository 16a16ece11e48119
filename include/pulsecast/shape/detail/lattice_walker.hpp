// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_LATTICE_WALKER_HPP
#define PULSECAST_SHAPE_DETAIL_LATTICE_WALKER_HPP

#include <array>
#include <limits>

#include <pulsecast/shape/detail/voxel_keys.hpp>
#include <pulsecast/shape/lattice_ray.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// State of a ray's traversal of a lattice, cell by cell or in leaps over empty cubes.
struct LatticeWalker {
  const LatticeRay& ray;
  LatticeCell cell{};
  Crossing in;                 ///< crossing into the cell
  std::array<double, 3> next;  ///< range of the exit plane along each axis
  bool inside = false;

  LatticeWalker(const LatticeRay& r, double near, const LatticeCell& extent) noexcept
      : ray(r), in{near, Crossing::begin} {
    if (!ray.valid()) return;
    for (int k = 0; k < 3; ++k) {
      if (ray.sense(k) == 0) continue;
      const Crossing wall = ray.crossing(k, ray.sense(k) > 0 ? 0 : extent[static_cast<std::size_t>(k)]);
      if (wall.range > in.range || (wall.range == in.range && in.axis != Crossing::begin)) in = wall;
    }
    if (!(in.range < std::numeric_limits<double>::infinity())) return;
    for (int k = 0; k < 3; ++k)
      if (!find(k, 0, extent[static_cast<std::size_t>(k)] - 1)) return;
    inside = true;
  }

  /// Sets the cell along an axis to that of the ray at `in`; false if it is not between `low` and `high`.
  bool find(int k, std::int32_t low, std::int32_t high) noexcept {
    const auto axis = static_cast<std::size_t>(k);
    const int sense = ray.sense(k);
    const double guess = ray.position(k, in.range);  // `low` is not negative, so truncation gives the cell
    std::int32_t c = guess > low ? guess < high ? static_cast<std::int32_t>(guess) : high : low;
    if (sense == 0) {
      while (c < high && ray.above(k, c + 1)) ++c;
      while (c > low && !ray.above(k, c)) --c;
      cell[axis] = c;
      next[axis] = std::numeric_limits<double>::infinity();
      return ray.above(k, c) && !ray.above(k, c + 1);
    }
    const std::int32_t first = sense > 0 ? low : high, last = sense > 0 ? high : low, front = sense > 0 ? 1 : 0,
                       back = 1 - front;
    while (c != last && !in.before(ray.crossing(k, c + front))) c += sense;
    while (c != first && in.before(ray.crossing(k, c + back))) c -= sense;
    cell[axis] = c;
    next[axis] = ray.crossing(k, c + front).range;
    return in.before({next[axis], k});
  }

  /// Axis of the first crossing.
  static int first_of(const std::array<double, 3>& ranges) noexcept {
    const int xy = ranges[0] <= ranges[1] ? 0 : 1;
    return ranges[static_cast<std::size_t>(xy)] <= ranges[2] ? xy : 2;
  }

  /// True if two coordinates along an axis are in the same group of four.
  static bool neighbours(std::int32_t a, std::int32_t b) noexcept { return a >> 2 == b >> 2; }

  /// Steps to the next cell; false if it is in another brick.
  bool step(int k) noexcept {
    const auto axis = static_cast<std::size_t>(k);
    const int sense = ray.sense(k);
    in = {next[axis], k};
    const std::int32_t from = cell[axis];
    cell[axis] = from + sense;
    next[axis] = ray.crossing(k, cell[axis] + (sense > 0 ? 1 : 0)).range;
    return neighbours(from, cell[axis]);
  }

  /// Leaps over empty cubes of edge 2^shift cells, from the one around the cell. Stops at a cube that is occupied by
  /// the mask `occupied`, or outside of its 4 x 4 x 4. False if the ray never leaves.
  bool leap(int shift, std::uint64_t occupied) noexcept {
    LatticeCell at;
    std::array<double, 3> exit;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      at[axis] = cell[axis] >> shift;
      exit[axis] = ray.sense(k) == 0 ? std::numeric_limits<double>::infinity()
                                     : ray.crossing(k, (at[axis] + (ray.sense(k) > 0 ? 1 : 0)) << shift).range;
    }
    for (;;) {
      const int k = first_of(exit);
      const auto axis = static_cast<std::size_t>(k);
      if (!(exit[axis] < std::numeric_limits<double>::infinity())) return false;
      in = {exit[axis], k};
      const std::int32_t from = at[axis];
      at[axis] += ray.sense(k);
      if (!neighbours(from, at[axis]) || (occupied >> cell_bit(at, 0) & 1)) break;
      exit[axis] = ray.crossing(k, (at[axis] + (ray.sense(k) > 0 ? 1 : 0)) << shift).range;
    }
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const std::int32_t low = at[axis] << shift, high = low | ((1 << shift) - 1);
      if (k == in.axis) {
        cell[axis] = ray.sense(k) > 0 ? low : high;
        next[axis] = ray.crossing(k, cell[axis] + (ray.sense(k) > 0 ? 1 : 0)).range;
      } else if (ray.sense(k) != 0) {
        find(k, low, high);
      }
    }
    return true;
  }
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
