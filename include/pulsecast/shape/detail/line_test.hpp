// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_LINE_TEST_HPP
#define PULSECAST_SHAPE_DETAIL_LINE_TEST_HPP

#include <pulsecast/geometry/triangle.hpp>

namespace PULSECAST_NAMESPACE {

/// Conservative test of triangles against the line through a ray, in a third of the
/// operations of `intersect`, which decides about those left. The line is on one side of the three
/// edges of a triangle that it hits, by the sign of a volume. One bound on the roundings, here and
/// in `intersect`, holds for all triangles. Infinite and tiny coordinates pass. Source: volume test
/// of Amanatides & Choi 1997, with products of corners shared by edges; bounds: Higham 2002, ch. 3.
template <class Rays>
class LineTest {
 public:
  /// Bit masks of triangles, idle lanes included.
  struct Met {
    unsigned possible;  ///< those that the line may hit
    unsigned certain;   ///< those of them that it passes on one side of all edges, whatever the roundings
  };

  /// Lines through a ray, or through those of a sheaf, for triangles within `bounds` [m]; both outlive it.
  LineTest(const Rays& rays, const Box& bounds) noexcept : rays_(rays), bounds_(bounds) {}

  [[nodiscard, gnu::always_inline]] Met meet(const TrianglePacket& triangles,
                                             const SingleRayPacket& ray) const noexcept {
    if (doubt_ == 0) doubt_ = doubt();
    const Vec3 origin = ray.origin, direction = ray.toward;
    using Corner = TrianglePacket::Corner;
    const auto from_origin = [&](const Corner& p) noexcept -> Corner {
      return {p.x - origin.x, p.y - origin.y, p.z - origin.z};
    };
    const auto across = [&](const Corner& p) noexcept -> Corner {
      return {p.y * direction.z - p.z * direction.y, p.z * direction.x - p.x * direction.z,
              p.x * direction.y - p.y * direction.x};
    };
    const auto product = [](const Corner& p, const Corner& q) noexcept {
      return simd::Doubles(p.x * q.x + p.y * q.y + p.z * q.z);
    };
    const Corner a = from_origin(triangles.a), b = from_origin(triangles.b), c = from_origin(triangles.c);
    const simd::Doubles u = product(b, across(a)), v = product(c, across(b)), w = product(a, across(c));
    const simd::Doubles least = simd::min(u, simd::min(v, w)), most = simd::max(u, simd::max(v, w));
    const unsigned apart = simd::bits((least < -doubt_) & (most > doubt_));
    return {~apart & all, simd::bits((least > doubt_) | (most < -doubt_))};
  }

 private:
  static constexpr unsigned all = (1U << simd::lane_count) - 1;
  static constexpr double tiny = 1e-290;  ///< far above what underflow loses
  static constexpr double huge = 1e280;   ///< volumes below do not overflow

  [[nodiscard, gnu::noinline]] double doubt() const noexcept {
    // `intersect` lets a side be in doubt by 17 roundings of 4 reach^2 times the direction's
    // length, and this test adds 12 of its 1-norm
    using Axes = simd::Vec4<double>;
    const auto axes = [](const Vec3& v) noexcept { return Axes(v.x, v.y, v.z); };
    const auto sum = [](const Axes& v) noexcept { return v[0] + v[1] + v[2]; };
    const Axes origin = axes(rays_.origin);
    Axes reaches = max(magnitude(axes(bounds_.min) - origin), magnitude(axes(bounds_.max) - origin)), speeds(0);
    double speed = 0;
    if constexpr (Rays::capacity > 1) {
      reaches = reaches + axes(rays_.origin_reach);
      speeds = max(magnitude(axes(rays_.low)), magnitude(axes(rays_.high)));
      speed = rays_.rays[0].direction_length;
    } else {
      speeds = magnitude(axes(rays_.toward));
      speed = rays_.direction_length;
    }
    const double reach = sum(reaches);
    speed += sum(speeds);
    const double doubt = 32 * std::numeric_limits<double>::epsilon() * reach * reach * speed + tiny;
    return doubt < huge ? doubt : detail::infinity;
  }

  const Rays& rays_;
  const Box& bounds_;
  mutable double doubt_ =
      0;  ///< volume below which a side is in doubt [m^2 times that of directions]; 0 before the first use
};

}  // namespace PULSECAST_NAMESPACE

#endif
