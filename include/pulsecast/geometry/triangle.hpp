// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include <pulsecast/base/lanes.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/geometry/bundle.hpp>

namespace pulsecast {

/// Triangle with corners a, b, c [m]; both sides count.
struct Triangle {
  Vec3 a{}, b{}, c{};

  [[nodiscard]] Box bounds() const noexcept {
    Box box;
    box.extend(a), box.extend(b), box.extend(c);
    return box;
  }

  /// Unit normal, right-handed about a, b, c; NaN without area.
  [[nodiscard]] Vec3 normal() const noexcept { return normalize(cross(b - a, c - a)); }
};

/// Triangles tested together, one a lane; idle lanes repeat the last one.
struct TrianglePacket {
  struct Corner {
    Lanes x, y, z;  ///< [m]
  };
  Corner a, b, c;
  std::array<PrimitiveIndex, lane_count> primitives;
  std::size_t size;  ///< lanes in use, at least one

  /// `triangle_of(n)` returns the triangle of the n-th of these primitives.
  template <class TriangleOf>
  TrianglePacket(std::span<const PrimitiveIndex> of, const TriangleOf& triangle_of) noexcept : size(of.size()) {
    const auto in_use = [&](std::size_t lane) noexcept { return std::min(lane, size - 1); };
    for (std::size_t lane = 0; lane < lane_count; ++lane) primitives[lane] = of[in_use(lane)];
    const auto triangles = [&]<std::size_t... lane>(std::index_sequence<lane...>) noexcept {
      return std::array{triangle_of(in_use(lane))...};
    }
    (std::make_index_sequence<lane_count>());
    const auto corner = [&](Vec3 Triangle::*which) noexcept {
      const auto coordinate = [&](double Vec3::*axis) noexcept {
        return lanes_of([&](std::size_t lane) { return triangles[lane].*which.*axis; });
      };
      return Corner{coordinate(&Vec3::x), coordinate(&Vec3::y), coordinate(&Vec3::z)};
    };
    a = corner(&Triangle::a), b = corner(&Triangle::b), c = corner(&Triangle::c);
  }
};

/// Intersects triangles with every ray of a bundle: the deciding test, always in double precision.
///
/// A ray is inside if it is on the same side of the three planes through the origin and an edge. The planes depend on the bundle alone, so
/// a ray costs three dot products, and none where the whole bundle passes a plane on one side.
/// If rounding leaves it in doubt, a ray counts as inside, so none slips between two triangles that share an edge or a corner.
/// A hit lies in the triangle's own box, widened by a few roundings, so that no box of an accelerator hides it. Beside an edge it lies by
/// at most 32 roundings of the distance, divided by the sine of the angle between ray and plane. Its range errs by that much, times one
/// more than the triangle's aspect.
/// A ray within 1e-12 rad of the triangle's plane misses. So does every ray if two edges are parallel to within 8 roundings (no area).
/// Never inlined, so that every accelerator gets the same bits.
/// Source: volume test of Amanatides & Choi 1997 in the edge-symmetric form of Shevtsov, Soupikov & Kapustin 2007; interval inside the box:
/// Kay & Kajiya 1986; bounds: Higham 2002, ch. 3.
[[gnu::noinline]] inline void intersect(const TrianglePacket& triangles, const RayBundle& rays, ClosestHits& nearest) noexcept {
  static_assert(RayBundle::lanes % lane_count == 0);
  constexpr double unit = std::numeric_limits<double>::epsilon();
  using Corner = TrianglePacket::Corner;
  const auto magnitude = [](const Lanes& v) noexcept { return Lanes(LaneIds(v) & 0x7FFF'FFFF'FFFF'FFFF); };
  const auto from_origin = [&](const Corner& p) noexcept -> Corner {
    return {p.x - rays.origin.x, p.y - rays.origin.y, p.z - rays.origin.z};
  };
  const Corner a = from_origin(triangles.a), b = from_origin(triangles.b), c = from_origin(triangles.c);

  // planes through the origin and an edge, and the bound within which their side is in doubt: |e||s| in the 1-norm bounds each sum of
  // products, which is at most seven roundings from the true one
  struct Planes {
    Lanes x, y, z, doubt;
  };
  const Lanes tolerance = Lanes{} + 4 * unit * rays.direction_length;
  const auto planes = [&](const Corner& from, const Corner& to) noexcept -> Planes {
    const Lanes ex = to.x - from.x, ey = to.y - from.y, ez = to.z - from.z;
    const Lanes sx = to.x + from.x, sy = to.y + from.y, sz = to.z + from.z;
    return {ey * sz - ez * sy, ez * sx - ex * sz, ex * sy - ey * sx,
            (magnitude(ex) + magnitude(ey) + magnitude(ez)) * (magnitude(sx) + magnitude(sy) + magnitude(sz)) * tolerance};
  };
  const Planes ab = planes(a, b), bc = planes(b, c), ca = planes(c, a);

  // a whole bundle misses if one plane has all rays on its right and one has all on its left; rounding may come in once more here
  LaneMask may_meet;
  const auto most = [&](const Planes& p) noexcept {
    return greater(p.x * rays.least.x, p.x * rays.most.x) + greater(p.y * rays.least.y, p.y * rays.most.y) +
           greater(p.z * rays.least.z, p.z * rays.most.z);
  };
  const auto least = [&](const Planes& p) noexcept {
    return smaller(p.x * rays.least.x, p.x * rays.most.x) + smaller(p.y * rays.least.y, p.y * rays.most.y) +
           smaller(p.z * rays.least.z, p.z * rays.most.z);
  };
  if (rays.size == 1) {
    const auto side = [&](const Planes& p) noexcept { return p.x * rays.x[0] + p.y * rays.y[0] + p.z * rays.z[0]; };
    const Lanes u = side(ab), v = side(bc), w = side(ca), doubt = 4 * greater(ab.doubt, greater(bc.doubt, ca.doubt));
    may_meet = (smaller(u, smaller(v, w)) >= -doubt) | (greater(u, greater(v, w)) <= doubt);
  } else {
    may_meet = ((most(ab) >= -4 * ab.doubt) & (most(bc) >= -4 * bc.doubt) & (most(ca) >= -4 * ca.doubt)) |
               ((least(ab) <= 4 * ab.doubt) & (least(bc) <= 4 * bc.doubt) & (least(ca) <= 4 * ca.doubt));
  }
  unsigned candidates = bits(may_meet) & ((1U << triangles.size) - 1);
  if (candidates == 0) return;

  // planes and boxes of the triangles, the boxes widened by the roundings of a hit
  const auto cross_of = [](const Corner& u, const Corner& v) noexcept -> Corner {
    return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  };
  const auto minus = [](const Corner& u, const Corner& v) noexcept -> Corner { return {u.x - v.x, u.y - v.y, u.z - v.z}; };
  const auto square = [](const Corner& v) noexcept { return v.x * v.x + v.y * v.y + v.z * v.z; };
  const Corner from_a = minus(triangles.b, triangles.a), to_a = minus(triangles.a, triangles.c);  // unaffected by the distance
  const Corner normals = cross_of(from_a, to_a);
  const Lanes offsets = normals.x * a.x + normals.y * a.y + normals.z * a.z, area = square(normals);
  const LaneMask flat = area <= 8 * unit * square(from_a) * (8 * unit * square(to_a));  // an angle within rounding of zero
  const Lanes grazing =
      flat ? Lanes{} + std::numeric_limits<double>::infinity() : 1e-12 * 1e-12 * rays.direction_length * rays.direction_length * area;
  const Corner lowest{smaller(a.x, smaller(b.x, c.x)), smaller(a.y, smaller(b.y, c.y)), smaller(a.z, smaller(b.z, c.z))};
  const Corner highest{greater(a.x, greater(b.x, c.x)), greater(a.y, greater(b.y, c.y)), greater(a.z, greater(b.z, c.z))};
  const Lanes extent =
      greater(greater(greater(magnitude(lowest.x), magnitude(highest.x)), greater(magnitude(lowest.y), magnitude(highest.y))),
              greater(magnitude(lowest.z), magnitude(highest.z)));
  const Lanes margin = 8 * unit * extent;

  for (; candidates != 0; candidates &= candidates - 1) {
    const auto t = static_cast<std::size_t>(std::countr_zero(candidates));
    const PrimitiveIndex primitive = triangles.primitives[t];
    for (std::size_t j = 0; j < rays.size; j += lane_count) {
      const Lanes x = load<Lanes>(rays.x[j]), y = load<Lanes>(rays.y[j]), z = load<Lanes>(rays.z[j]);
      const Lanes u = x * ab.x[t] + y * ab.y[t] + z * ab.z[t];
      const Lanes v = x * bc.x[t] + y * bc.y[t] + z * bc.z[t];
      const Lanes w = x * ca.x[t] + y * ca.y[t] + z * ca.z[t];
      const LaneMask on_left = (u >= -ab.doubt[t]) & (v >= -bc.doubt[t]) & (w >= -ca.doubt[t]);
      const LaneMask on_right = (u <= ab.doubt[t]) & (v <= bc.doubt[t]) & (w <= ca.doubt[t]);
      const LaneMask between = on_left | on_right;
      if (bits(between) == 0) continue;

      const Lanes slope = x * normals.x[t] + y * normals.y[t] + z * normals.z[t];
      const LaneMask inside = between & (slope * slope > grazing[t]);

      // interval inside the box; a zero direction is made so small that walls it never reaches lie at infinity
      const Lanes tiny = Lanes{} + 1e-300;
      Lanes entry = Lanes{} - std::numeric_limits<double>::infinity(), exit = -entry;
      const auto between_walls = [&](const Lanes& direction, double low, double high) noexcept {
        const Lanes per = 1 / (direction * direction > 0 ? direction : tiny);
        const Lanes to_low = low * per, to_high = high * per;
        entry = greater(smaller(to_low, to_high), entry), exit = smaller(greater(to_low, to_high), exit);
      };
      between_walls(x, lowest.x[t] - margin[t], highest.x[t] + margin[t]);
      between_walls(y, lowest.y[t] - margin[t], highest.y[t] + margin[t]);
      between_walls(z, lowest.z[t] - margin[t], highest.z[t] + margin[t]);
      const Lanes crossing = offsets[t] / slope;
      const Lanes after_entry = crossing < entry ? entry : crossing;
      const Lanes at = after_entry > exit ? exit : after_entry;

      const Lanes best = load<Lanes>(nearest.range[j]);
      const LaneIds best_id = load<LaneIds>(nearest.id[j]), own_id = LaneIds{} + (nearest.part | primitive);
      const LaneMask nearer = (at < best) | ((at == best) & (own_id < best_id));
      const LaneMask hit = inside & (entry <= exit) & (at > rays.near) & nearer;
      store(hit ? at : best, nearest.range[j]);
      store(hit ? own_id : best_id, nearest.id[j]);
    }
  }
}

/// Intersects as many triangles as there are primitives; `triangle_of(n)` returns the n-th.
template <class TriangleOf>
void intersect(std::span<const PrimitiveIndex> primitives, const TriangleOf& triangle_of, const RayBundle& rays,
               ClosestHits& nearest) noexcept {
  for (std::size_t first = 0; first < primitives.size(); first += lane_count)
    intersect({primitives.subspan(first, std::min(lane_count, primitives.size() - first)),
               [&](std::size_t n) noexcept { return triangle_of(first + n); }},
              rays, nearest);
}

/// Intersects one triangle.
inline void intersect(const Triangle& triangle, PrimitiveIndex primitive, const RayBundle& rays, ClosestHits& nearest) noexcept {
  intersect(
      std::span(&primitive, 1), [&](std::size_t) noexcept { return triangle; }, rays, nearest);
}

}  // namespace pulsecast
