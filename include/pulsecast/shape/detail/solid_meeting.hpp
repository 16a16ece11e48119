// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_SOLID_MEETING_HPP
#define PULSECAST_SHAPE_DETAIL_SOLID_MEETING_HPP

#include <cstddef>
#include <cstdint>
#include <limits>

#include <pulsecast/geometry/bundle.hpp>
#include <pulsecast/shape/lattice_ray.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Intersection of a ray's walk with solid cubes, equal to that with a mesh of them without walls between two. A ray
/// that begins inside a cube hits its far side, or the cube that touches it there.
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
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  const Columns& columns_;
  const LatticeRay& ray_;
  Crossing begin_;
  std::size_t j_;
  Hits& nearest_;
  double far_side_ = infinity;  ///< far side of the cube around the ray's start [m]
  std::uint32_t around_ = 0;    ///< number of that cube
};

/// Normal of the face at which a ray hits a cube; that of the far side if the ray begins inside.
[[nodiscard]] inline Vec3 face_normal(const LatticeRay& ray, const LatticeRay::Passage& cube, double near) noexcept {
  const bool from_inside = cube.in.before({near, Crossing::begin});
  const int axis = from_inside ? cube.out.axis : cube.in.axis;
  Vec3 normal{};
  normal[axis] = ray.sense(axis) > 0 ? -1 : 1;
  return normal;
}

}  // namespace PULSECAST_NAMESPACE::detail

#endif
