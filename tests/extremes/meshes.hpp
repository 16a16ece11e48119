// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/accel/bvh.hpp>
#include <pulsecast/accel/kd_tree.hpp>
#include <pulsecast/accel/linear.hpp>
#include <pulsecast/base/error.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "extremes/row.hpp"
#include "support/double_double.hpp"
#include "support/scenes.hpp"

namespace pulsecast::extremes {

/// How far beside an edge a ray may still meet its triangle: some roundings of the distance to the farthest corner, the
/// more the nearer the ray comes to the triangle's plane [m].
[[nodiscard]] inline double edge_bound(const support::ExactCrossing& crossing) noexcept {
  return 32 * std::numeric_limits<double>::epsilon() * crossing.distance / crossing.sine;
}

/// What a range may err by: as much, and times the aspect where the triangle is a needle, at whose tip an edge is
/// passed late [m].
[[nodiscard]] inline double range_bound(const support::ExactCrossing& crossing) noexcept {
  return (1 + crossing.aspect) * edge_bound(crossing);
}

/// How answers stand against exact ones.
struct Verdict {
  std::uint64_t rays = 0, met = 0;
  std::uint64_t wrong = 0;  ///< met where nothing is, missed what is there, or at a range that errs by more than it may
  double worst = 0;         ///< error of a range [m]
};

/// Tests every triangle in double-double arithmetic. One whose plane a ray is in, within 1e-12 rad, need not be met.
template <Geometry G>
void judge(const G& shape, const MeshData& data, const RayBundle& rays, Verdict& verdict) {
  ClosestHits nearest(rays);
  shape.closest(rays, nearest);
  for (std::size_t j = 0; j < rays.size; ++j) {
    const Ray ray = rays.ray(j);
    double sure = std::numeric_limits<double>::infinity();  // what is met beyond this range is met too late
    for (std::size_t i = 0; i < data.triangles.size(); ++i) {
      const support::ExactCrossing crossing = support::exact_crossing(data.triangle(i), ray);
      const double range = static_cast<double>(crossing.range), bound = range_bound(crossing);
      if (crossing.sine > 1.001e-12 && crossing.inside > edge_bound(crossing) && range > ray.near + bound &&
          range < ray.far - bound)
        sure = std::min(sure, range + bound);
    }
    ++verdict.rays;
    if (!nearest.met(j)) {
      verdict.wrong += sure < std::numeric_limits<double>::infinity() ? 1 : 0;
      continue;
    }
    ++verdict.met;
    const double found = nearest.range[j];
    const support::ExactCrossing crossing = support::exact_crossing(data.triangle(nearest.primitive_of(j)), ray);
    const double error = std::fabs(static_cast<double>(crossing.range - found));
    verdict.worst = std::max(verdict.worst, error);
    verdict.wrong +=
        error <= range_bound(crossing) && crossing.inside >= -edge_bound(crossing) && found <= sure ? 0 : 1;
  }
}

/// The same triangles under every accelerator; the first tests all, the others must answer as it does, to the last bit.
struct Meshes {
  explicit Meshes(const MeshData& data)
      : linear(data), bvh(data), exact_bvh(data), kd_tree(data), exact_kd_tree(data) {}

  void compare(const RayBundle& rays, support::Comparison& result) const {
    support::compare(linear, bvh, "Bvh<float>", rays, result);
    support::compare(linear, exact_bvh, "Bvh<double>", rays, result);
    support::compare(linear, kd_tree, "KdTree<float>", rays, result);
    support::compare(linear, exact_kd_tree, "KdTree<double>", rays, result);
  }

  TriangleMesh<Linear<>> linear;
  TriangleMesh<Bvh<>> bvh;
  TriangleMesh<Bvh<double>> exact_bvh;
  TriangleMesh<KdTree<>> kd_tree;
  TriangleMesh<KdTree<double>> exact_kd_tree;
};

/// Checks that an attempt is refused for the right reason, which the message says, and prints it as a row of the table.
template <class Attempt>
void refused_as(const std::string& axis, const std::string& what, const std::string& reason, const Attempt& attempt) {
  CAPTURE(what);
  try {
    static_cast<void>(attempt());
  } catch (const SettingError& error) {
    CHECK(std::string(error.what()).find(reason) != std::string::npos);
    return refused(axis, what, error);
  }
  FAIL_CHECK("is not refused");
}

/// Whether all accelerators agree and no answer is wrong.
inline void check(const Verdict& verdict, const support::Comparison& others) {
  CHECK(verdict.wrong == 0);
  CHECK(verdict.met > 0);
  INFO(others.first);
  CHECK(others.different == 0);
}

}  // namespace pulsecast::extremes
