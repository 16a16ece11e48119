// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <pulsecast/base/lanes.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/geometry/bundle.hpp>

namespace pulsecast {

/// Three corners [m]; both sides count.
struct Triangle {
  Vec3 a{}, b{}, c{};

  [[nodiscard]] Box bounds() const noexcept {
    Box box;
    box.extend(a), box.extend(b), box.extend(c);
    return box;
  }

  /// Unit normal, right-handed about a, b, c; NaN if the triangle has no area.
  [[nodiscard]] Vec3 normal() const noexcept { return normalize(cross(b - a, c - a)); }
};

/// Tests a triangle against every ray of a bundle. This is the test that decides, always in double precision.
///
/// Inside means on the same side of the three planes through the origin and an edge; the planes depend on the bundle alone, so a ray
/// costs three dot products. A ray counts as inside if rounding leaves it in doubt: no ray slips between two triangles that share
/// an edge or a corner. A hit lies in the triangle's own box, widened by a few roundings, so that no box of an accelerator hides it.
/// A ray within 1e-12 rad of the triangle's plane misses.
/// Never inlined, so that every accelerator gets the same bits.
/// Source: the volume test of Amanatides & Choi 1997 in the edge-symmetric form of Shevtsov, Soupikov & Kapustin 2007; the stretch inside
/// the box: Kay & Kajiya 1986; bounds: Higham 2002, ch. 3.
[[gnu::noinline]] inline void intersect(const Triangle& triangle, PrimitiveIndex primitive, const RayBundle& rays,
                                        Nearest& nearest) noexcept {
  static_assert(RayBundle::lanes % lane_count == 0);
  constexpr double unit = std::numeric_limits<double>::epsilon();
  const Vec3 a = triangle.a - rays.origin, b = triangle.b - rays.origin, c = triangle.c - rays.origin;

  // the planes through the origin and an edge, and for how long their side is in doubt: |e||s| in the 1-norm bounds each of the sums of
  // products, and seven roundings stand between them and the true ones
  struct Plane {
    double x, y, z, doubt;
    Plane(const Vec3& from, const Vec3& to, double tolerance) noexcept {
      const double ex = to.x - from.x, ey = to.y - from.y, ez = to.z - from.z;
      const double sx = to.x + from.x, sy = to.y + from.y, sz = to.z + from.z;
      x = ey * sz - ez * sy, y = ez * sx - ex * sz, z = ex * sy - ey * sx;
      doubt = (std::fabs(ex) + std::fabs(ey) + std::fabs(ez)) * (std::fabs(sx) + std::fabs(sy) + std::fabs(sz)) * tolerance;
    }
  };
  const double tolerance = 4 * unit * rays.direction_length;
  const Plane ab(a, b, tolerance), bc(b, c, tolerance), ca(c, a, tolerance);

  bool prepared = false;
  Vec3 normal, low, high;
  double offset = 0, grazing = 0;
  for (std::size_t j = 0; j < rays.size; j += lane_count) {
    const Lanes x = load<Lanes>(rays.x[j]), y = load<Lanes>(rays.y[j]), z = load<Lanes>(rays.z[j]);
    const Lanes u = x * ab.x + y * ab.y + z * ab.z;
    const Lanes v = x * bc.x + y * bc.y + z * bc.z;
    const Lanes w = x * ca.x + y * ca.y + z * ca.z;
    const LaneMask on_left = (u >= -ab.doubt) & (v >= -bc.doubt) & (w >= -ca.doubt);
    const LaneMask on_right = (u <= ab.doubt) & (v <= bc.doubt) & (w <= ca.doubt);
    const LaneMask between = on_left | on_right;
    if (bits(between) == 0) continue;

    if (!prepared) {  // most triangles are done with before this
      prepared = true;
      normal = cross(b - a, a - c);
      offset = dot(normal, a);
      grazing = 1e-12 * 1e-12 * dot(normal, normal) * rays.direction_length * rays.direction_length;
      const Vec3 least = min(a, min(b, c)), most = max(a, max(b, c));
      const Vec3 margin = Vec3(8 * unit * max_norm(max(most, -least)));
      low = least - margin, high = most + margin;
    }
    const Lanes slope = x * normal.x + y * normal.y + z * normal.z;
    const LaneMask inside = between & (slope * slope > grazing);

    // a direction of zero becomes so small a one that the walls which it never reaches lie at infinity
    const Lanes zero = {}, tiny = zero + 1e-300;
    const Lanes per_x = 1 / (x * x > zero ? x : tiny), per_y = 1 / (y * y > zero ? y : tiny), per_z = 1 / (z * z > zero ? z : tiny);
    const Lanes to_low_x = low.x * per_x, to_low_y = low.y * per_y, to_low_z = low.z * per_z;
    const Lanes to_high_x = high.x * per_x, to_high_y = high.y * per_y, to_high_z = high.z * per_z;
    const LaneMask rising_x = to_low_x < to_high_x, rising_y = to_low_y < to_high_y, rising_z = to_low_z < to_high_z;
    const Lanes in_x = rising_x ? to_low_x : to_high_x, in_y = rising_y ? to_low_y : to_high_y, in_z = rising_z ? to_low_z : to_high_z;
    const Lanes out_x = rising_x ? to_high_x : to_low_x, out_y = rising_y ? to_high_y : to_low_y, out_z = rising_z ? to_high_z : to_low_z;
    const Lanes in_xy = in_x > in_y ? in_x : in_y, entry = in_xy > in_z ? in_xy : in_z;
    const Lanes out_xy = out_x < out_y ? out_x : out_y, exit = out_xy < out_z ? out_xy : out_z;
    const Lanes crossing = offset / slope;
    const Lanes after_entry = crossing < entry ? entry : crossing;
    const Lanes at = after_entry > exit ? exit : after_entry;

    const Lanes best = load<Lanes>(nearest.range[j]);
    const LaneIds best_id = load<LaneIds>(nearest.id[j]), own_id = LaneIds{} + (nearest.part | primitive);
    const LaneMask nearer = (at < best) | ((at == best) & (own_id < best_id));
    const LaneMask hit = inside & (entry <= exit) & (at > rays.near) & nearer;
    const Lanes range = hit ? at : best;
    const LaneIds ids = hit ? own_id : best_id;
    store(range, nearest.range[j]);
    store(ids, nearest.id[j]);
  }
}

}  // namespace pulsecast
