// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

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
/// an edge or a corner. A hit always lies in the triangle's own box, widened by a few roundings, so that no box hides it.
/// A ray within 1e-12 rad of the triangle's plane misses.
/// Never inlined, so that every accelerator gets the same bits.
/// Source: the volume test of Amanatides & Choi 1997 in the edge-symmetric form of Shevtsov, Soupikov & Kapustin 2007; the stretch inside
/// the box: Kay & Kajiya 1986; bounds: Higham 2002, ch. 3.
[[gnu::noinline]] inline void intersect(const Triangle& triangle, PrimitiveIndex primitive, const RayBundle& rays,
                                        Nearest& nearest) noexcept {
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
  const double margin = 8 * unit * std::fmax(max_norm(a), std::fmax(max_norm(b), max_norm(c)));
  const Vec3 low = min(a, min(b, c)) - Vec3(margin), high = max(a, max(b, c)) + Vec3(margin);
  const std::uint64_t id = nearest.part | primitive;

  for (std::size_t block = 0; block < rays.padded_size(); block += RayBundle::lanes) {
    alignas(64) double slopes[RayBundle::lanes];  // NaN where the ray passes by
    double any = -1;
    for (std::size_t lane = 0; lane < RayBundle::lanes; ++lane) {
      const double x = rays.x[block + lane], y = rays.y[block + lane], z = rays.z[block + lane];
      const double u = x * planes[0].x + y * planes[0].y + z * planes[0].z;
      const double v = x * planes[1].x + y * planes[1].y + z * planes[1].z;
      const double w = x * planes[2].x + y * planes[2].y + z * planes[2].z;
      const double slope = x * normal.x + y * normal.y + z * normal.z;
      const bool on_left = (u >= -doubt[0]) & (v >= -doubt[1]) & (w >= -doubt[2]);
      const bool on_right = (u <= doubt[0]) & (v <= doubt[1]) & (w <= doubt[2]);
      const bool inside = (on_left | on_right) & (slope * slope > grazing);
      slopes[lane] = inside ? slope : 0;
    }
    for (std::size_t lane = 0; lane < RayBundle::lanes; ++lane) any = slopes[lane] != 0 ? 1 : any;
    if (any < 0) continue;
    for (std::size_t lane = 0; lane < RayBundle::lanes; ++lane) {
      const std::size_t j = block + lane;
      // a direction of zero becomes so small a one that the walls it never reaches lie at infinity
      const double x = rays.x[j], y = rays.y[j], z = rays.z[j];
      const double per_x = 1 / (std::fabs(x) < 1e-300 ? 1e-300 : x);
      const double per_y = 1 / (std::fabs(y) < 1e-300 ? 1e-300 : y);
      const double per_z = 1 / (std::fabs(z) < 1e-300 ? 1e-300 : z);
      const double x0 = low.x * per_x, x1 = high.x * per_x;
      const double y0 = low.y * per_y, y1 = high.y * per_y;
      const double z0 = low.z * per_z, z1 = high.z * per_z;
      const double in_x = x0 < x1 ? x0 : x1, in_y = y0 < y1 ? y0 : y1, in_z = z0 < z1 ? z0 : z1;
      const double out_x = x0 < x1 ? x1 : x0, out_y = y0 < y1 ? y1 : y0, out_z = z0 < z1 ? z1 : z0;
      const double in_xy = in_x > in_y ? in_x : in_y, entry = in_xy > in_z ? in_xy : in_z;
      const double out_xy = out_x < out_y ? out_x : out_y, exit = out_xy < out_z ? out_xy : out_z;
      const double crossing = offset / slopes[lane];
      const double after_entry = crossing < entry ? entry : crossing;
      const double at = after_entry > exit ? exit : after_entry;
      const double best = nearest.range[j];
      const std::uint64_t best_id = nearest.id[j];
      const bool tie_won = (at == best) & (id < best_id);
      const bool nearer = (at < best) | tie_won;
      const bool hit = (slopes[lane] != 0) & (entry <= exit) & (at > rays.near) & nearer;
      nearest.range[j] = hit ? at : best;
      nearest.id[j] = hit ? id : best_id;
    }
  }
}

}  // namespace pulsecast
