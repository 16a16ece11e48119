// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_DETAIL_LINE_TEST_HPP
#define PULSECAST_SHAPE_DETAIL_LINE_TEST_HPP

#include <pulsecast/geometry/triangle.hpp>

namespace PULSECAST_NAMESPACE {

/// Conservative test of triangles against the line through a single ray, in a third of the
/// operations of `intersect`, which decides about those left. The line is on one side of the three
/// edges of a triangle that it hits, by the sign of a volume. One bound on the roundings, here and
/// in `intersect`, holds for all triangles. Infinite and tiny coordinates pass. Source: volume test
/// of Amanatides & Choi 1997, with products of corners shared by edges; bounds: Higham 2002, ch. 3.
class LineTest {
 public:
  LineTest() noexcept {}
  /// Line through the only ray of a bundle, for triangles within `bounds` [m].
  LineTest(const auto& ray, const Box& bounds) noexcept : origin_(ray.origin), direction_(ray.direction(0)) {
    // `intersect` lets a side be in doubt by 17 roundings of 4 reach^2 times the direction's
    // length, and this test adds 12 of its 1-norm
    using Axes = simd::Vec4<double>;
    const auto axes = [](const Vec3& v) noexcept { return Axes(v.x, v.y, v.z); };
    const Axes from = axes(origin_);
    const Axes to_min = magnitude(axes(bounds.min) - from), to_max = magnitude(axes(bounds.max) - from);
    const Axes reaches = simd::max(to_min, to_max), speeds = magnitude(axes(direction_));
    const double reach = reaches[0] + reaches[1] + reaches[2],
                 speed = ray.direction_length + speeds[0] + speeds[1] + speeds[2];
    doubt_ = 32 * std::numeric_limits<double>::epsilon() * reach * reach * speed + tiny;
    if (!(doubt_ < huge)) doubt_ = detail::infinity;
  }

  /// Bit mask of the triangles that the line may hit, idle lanes included.
  [[nodiscard, gnu::always_inline]] unsigned may_meet(const TrianglePacket& triangles) const noexcept {
    using Corner = TrianglePacket::Corner;
    const auto from_origin = [&](const Corner& p) noexcept -> Corner {
      return {p.x - origin_.x, p.y - origin_.y, p.z - origin_.z};
    };
    const auto across = [&](const Corner& p) noexcept -> Corner {
      return {p.y * direction_.z - p.z * direction_.y, p.z * direction_.x - p.x * direction_.z,
              p.x * direction_.y - p.y * direction_.x};
    };
    const auto product = [](const Corner& p, const Corner& q) noexcept {
      return simd::Doubles(p.x * q.x + p.y * q.y + p.z * q.z);
    };
    const Corner a = from_origin(triangles.a), b = from_origin(triangles.b), c = from_origin(triangles.c);
    const simd::Doubles u = product(b, across(a)), v = product(c, across(b)), w = product(a, across(c));
    const simd::Mask apart = (simd::min(u, simd::min(v, w)) < -doubt_) & (simd::max(u, simd::max(v, w)) > doubt_);
    return ~simd::bits(apart) & ((1U << simd::lane_count) - 1);
  }

 private:
  static constexpr double tiny = 1e-290;  ///< far above what underflow loses
  static constexpr double huge = 1e280;   ///< volumes below do not overflow

  Vec3 origin_, direction_;
  double doubt_;  ///< volume below which a side is in doubt [m^2 times that of directions]
};

}  // namespace PULSECAST_NAMESPACE

#endif
