// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

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
  const Vec3 edges[3] = {b - a, c - b, a - c};
  const Vec3 sums[3] = {a + b, b + c, c + a};
  Vec3 planes[3];
  double doubt[3];
  for (int k = 0; k < 3; ++k) {
    planes[k] = cross(edges[k], sums[k]);
    doubt[k] = 32 * unit * max_norm(edges[k]) * max_norm(sums[k]) * rays.direction_length;
  }
  const Vec3 normal = cross(edges[0], edges[2]);
  const double offset = dot(normal, a);
  const double grazing = 1e-12 * 1e-12 * dot(normal, normal) * rays.direction_length * rays.direction_length;
  const Vec3 least = min(a, min(b, c)), most = max(a, max(b, c));
  const Vec3 margin = Vec3(8 * unit * max_norm(max(most, -least)));
  const Vec3 low = least - margin, high = most + margin;
  const std::uint64_t id = nearest.part | primitive;

  for (std::size_t j = 0; j < rays.size; j += lane_count) {
    const Lanes x = load<Lanes>(rays.x[j]), y = load<Lanes>(rays.y[j]), z = load<Lanes>(rays.z[j]);
    const Lanes u = x * planes[0].x + y * planes[0].y + z * planes[0].z;
    const Lanes v = x * planes[1].x + y * planes[1].y + z * planes[1].z;
    const Lanes w = x * planes[2].x + y * planes[2].y + z * planes[2].z;
    const Lanes slope = x * normal.x + y * normal.y + z * normal.z;
    const LaneMask on_left = (u >= -doubt[0]) & (v >= -doubt[1]) & (w >= -doubt[2]);
    const LaneMask on_right = (u <= doubt[0]) & (v <= doubt[1]) & (w <= doubt[2]);
    const LaneMask inside = (on_left | on_right) & (slope * slope > grazing);
    if (!any(inside)) continue;

    // a direction of zero becomes so small a one that the walls which it never reaches lie at infinity
    const Lanes zero = {}, tiny = zero + 1e-300;
    const Lanes per_x = 1 / (x * x > zero ? x : tiny), per_y = 1 / (y * y > zero ? y : tiny), per_z = 1 / (z * z > zero ? z : tiny);
    const Lanes x0 = low.x * per_x, y0 = low.y * per_y, z0 = low.z * per_z;
    const Lanes x1 = high.x * per_x, y1 = high.y * per_y, z1 = high.z * per_z;
    const Lanes in_x = x0 < x1 ? x0 : x1, in_y = y0 < y1 ? y0 : y1, in_z = z0 < z1 ? z0 : z1;
    const Lanes out_x = x0 < x1 ? x1 : x0, out_y = y0 < y1 ? y1 : y0, out_z = z0 < z1 ? z1 : z0;
    const Lanes in_xy = in_x > in_y ? in_x : in_y, entry = in_xy > in_z ? in_xy : in_z;
    const Lanes out_xy = out_x < out_y ? out_x : out_y, exit = out_xy < out_z ? out_xy : out_z;
    const Lanes crossing = offset / slope;
    const Lanes after_entry = crossing < entry ? entry : crossing;
    const Lanes at = after_entry > exit ? exit : after_entry;

    const Lanes best = load<Lanes>(nearest.range[j]);
    const LaneIds best_id = load<LaneIds>(nearest.id[j]), own_id = LaneIds{} + id;
    const LaneMask nearer = (at < best) | ((at == best) & (own_id < best_id));
    const LaneMask hit = inside & (entry <= exit) & (at > rays.near) & nearer;
    const Lanes range = hit ? at : best;
    const LaneIds ids = hit ? own_id : best_id;
    store(range, nearest.range[j]);
    store(ids, nearest.id[j]);
  }
}

}  // namespace pulsecast
